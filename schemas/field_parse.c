#include "schemas/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/unit.h"

enum { QUOTE = 60 };

static void copy_text(char to[FIELD_TEXT_SIZE], const char *from) {
  memset(to, 0, FIELD_TEXT_SIZE);
  memcpy(to, from, strnlen(from, FIELD_TEXT_SIZE - 1));
}

status field_parse(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  struct field_value came = {.kind = row->kind};
  struct error inner;
  char *end;
  switch (row->kind) {
  case FIELD_REAL:
    if (row->flags & FIELD_MAY_BE_OFF && strcmp(text, "off") == 0) {
      came.number = (double)NAN;
      break;
    }
    if (strcmp(text, "off") == 0)
      return status_fail(error, STATUS_CONTENT, "%s: cannot be switched off", row->path);
    if (unit_read(text, row->unit ? row->unit : "1", &came.number, &inner))
      return status_fail(error, inner.status, "%s: %s%s", row->path, inner.message,
                         row->flags & FIELD_MAY_BE_OFF ? " (or off)" : "");
    break;
  case FIELD_INTEGER:
    came.integer = strtoll(text, &end, 10);
    /* Digits alone, or with the row's own unit, keep all 64 bits; all else goes through a double. */
    if (row->unit && *end == ' ' && strcmp(end + 1, row->unit) == 0)
      end += strlen(end);
    if (end != text && *end == 0 && came.integer != INT64_MAX && came.integer != INT64_MIN && *text != ' ')
      break;
    came.kind = FIELD_REAL; /* "1e6", "2 GiB" */
    if (unit_read(text, row->unit ? row->unit : "1", &came.number, &inner))
      return status_fail(error, inner.status, "%s: %s", row->path, inner.message);
    break;
  case FIELD_BOOLEAN:
    came.number = strcmp(text, "true") == 0;
    if (came.number == 0 && strcmp(text, "false") != 0)
      return status_fail(error, STATUS_CONTENT, "%s: expected true or false, got '%.*s'", row->path, QUOTE, text);
    break;
  case FIELD_CHOICE: /* any text: field_set_value names the choices */
    came.kind = FIELD_TEXT;
    copy_text(came.text, text);
    break;
  case FIELD_TEXT:
    if (strlen(text) >= FIELD_TEXT_SIZE)
      return status_fail(error, STATUS_CONTENT, "%s: expected at most %d bytes of text, got %zu", row->path,
                         FIELD_TEXT_SIZE - 1, strlen(text));
    copy_text(came.text, text);
    break;
  }
  return field_set_value(row, &came, value, error);
}
