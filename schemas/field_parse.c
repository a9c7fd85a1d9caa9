/* A value from the text that a user types. */
#include "schemas/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/unit.h"

enum { QUOTE = 60 };

static status parse_real(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  const bool may_be_off = row->flags & FIELD_MAY_BE_OFF;
  if (strcmp(text, "off") == 0) {
    came->number = (double)NAN;
    return may_be_off ? STATUS_OK : status_fail(error, STATUS_CONTENT, "%s: cannot be switched off", row->path);
  }
  struct error inner;
  status code = unit_read(text, row->unit ? row->unit : "1", &came->number, &inner);
  if (code)
    return status_fail(error, code, "%s: %s%s", row->path, inner.message, may_be_off ? " (or off)" : "");
  return STATUS_OK;
}

/* Digits alone, or with the row's own unit, keep all 64 bits; other numbers ("1e6", "2 GiB") go through a double. */
static status parse_integer(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  char *end;
  came->integer = strtoll(text, &end, 10);
  if (row->unit && *end == ' ' && strcmp(end + 1, row->unit) == 0)
    end += strlen(end);
  if (end != text && *end == 0 && came->integer != INT64_MAX && came->integer != INT64_MIN && *text != ' ')
    return STATUS_OK;

  struct error inner;
  came->kind = FIELD_REAL;
  status code = unit_read(text, row->unit ? row->unit : "1", &came->number, &inner);
  if (code)
    return status_fail(error, code, "%s: %s", row->path, inner.message);
  return STATUS_OK;
}

static status parse_boolean(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  came->number = strcmp(text, "true") == 0;
  if (came->number == 0 && strcmp(text, "false") != 0)
    return status_fail(error, STATUS_CONTENT, "%s: expected true or false, got '%.*s'", row->path, QUOTE, text);
  return STATUS_OK;
}

static status parse_text(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  if (strlen(text) >= FIELD_TEXT_SIZE)
    return status_fail(error, STATUS_CONTENT, "%s: expected at most %d bytes of text, got %zu", row->path,
                       FIELD_TEXT_SIZE - 1, strlen(text));
  if (row->flags & FIELD_REQUIRED && !*text)
    return status_fail(error, STATUS_CONTENT, "%s: expected text, got an empty one", row->path);
  field_copy_text(came->text, text);
  return STATUS_OK;
}

static status percent_missing(const struct field *row, const char *text, int length, struct error *error) {
  char percent[32];
  field_print_number(100 * strtod(text, NULL), percent);
  return status_fail(error, STATUS_CONTENT, "%s: %.*s is a percentage or a fraction; write '%.*s %%' or '%s %%'",
                     row->path, length, text, length, text, percent);
}

/* Without this check "threshold.angle=4" would be 229 degrees: a user who leaves out the unit may mean any. */
static status check_unit(const struct field *row, const char *text, struct error *error) {
  if (!field_needs_unit(row) || !unit_is_bare(text) || strtod(text, NULL) == 0)
    return STATUS_OK;

  const char *unit = row->unit ? row->unit : "1", *usual = unit_usual(unit);
  text += strspn(text, " ");
  const int length = (int)strcspn(text, " ") < QUOTE ? (int)strcspn(text, " ") : QUOTE;
  if (strcmp(unit, "1") == 0)
    return percent_missing(row, text, length, error);
  if (usual)
    return status_fail(error, STATUS_CONTENT, "%s: %.*s has no unit; write '%.*s %s' or '%.*s %s'", row->path, length,
                       text, length, text, usual, length, text, unit);
  return status_fail(error, STATUS_CONTENT, "%s: %.*s has no unit; write '%.*s %s'", row->path, length, text, length,
                     text, unit);
}

static status parse(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  struct field_value came = {.kind = row->kind};
  status code = STATUS_OK;
  switch (row->kind) {
  case FIELD_REAL: code = parse_real(row, text, &came, error); break;
  case FIELD_INTEGER: code = parse_integer(row, text, &came, error); break;
  case FIELD_BOOLEAN: code = parse_boolean(row, text, &came, error); break;
  case FIELD_TEXT: code = parse_text(row, text, &came, error); break;
  case FIELD_CHOICE: /* any text is accepted here: field_set_value reports unknown choices */
    came.kind = FIELD_TEXT;
    field_copy_text(came.text, text);
    break;
  }
  return code ? code : field_set_value(row, &came, value, error);
}

status field_parse_si(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  return parse(row, text, value, error);
}

status field_parse(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  const status code = check_unit(row, text, error);
  return code ? code : parse(row, text, value, error);
}
