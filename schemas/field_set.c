#include "schemas/field.h"

#include <math.h>
#include <string.h>

enum { QUOTE = 60 };

static void copy_text(char to[FIELD_TEXT_SIZE], const char *from) {
  memset(to, 0, FIELD_TEXT_SIZE);
  memcpy(to, from, strnlen(from, FIELD_TEXT_SIZE - 1));
}

void field_set_unchecked(const struct field *row, void *object, const struct field_value *value) {
  void *to = (char *)object + row->offset;
  switch (row->kind) {
  case FIELD_REAL: memcpy(to, &value->number, sizeof value->number); break;
  case FIELD_INTEGER: memcpy(to, &value->integer, sizeof value->integer); break;
  case FIELD_BOOLEAN: {
    bool truth = value->number != 0;
    memcpy(to, &truth, sizeof truth);
    break;
  }
  case FIELD_CHOICE: {
    int index = (int)value->number;
    memcpy(to, &index, sizeof index);
    break;
  }
  case FIELD_TEXT: copy_text(to, value->text); break;
  }
}

static status check_range(const struct field *row, double number, const struct field_value *value,
                          struct error *error) {
  bool low = row->flags & FIELD_ABOVE_MINIMUM ? number > row->minimum : number >= row->minimum;
  bool high = row->flags & FIELD_BELOW_MAXIMUM ? number < row->maximum : number <= row->maximum;
  if (low && high && isfinite(number))
    return STATUS_OK;
  char range[160], came[FIELD_TEXT_SIZE];
  field_describe_range(row, range, sizeof range);
  field_print(row, value, came, sizeof came);
  return status_fail(error, STATUS_CONTENT, "%s: expected %s%s, got %s", row->path, range,
                     row->flags & FIELD_MAY_BE_OFF ? ", or off" : "",
                     isfinite(number) ? came : "a number that is not finite");
}

static status unknown_choice(const struct field *row, const char *text, struct error *error) {
  char list[600] = "";
  size_t used = 0;
  struct text_guess guess = text_guess(text);
  for (size_t i = 0; row->choices[i]; i++) {
    int n = snprintf(list + used, sizeof list - used, "%s%s", i ? (row->choices[i + 1] ? ", " : " or ") : "",
                     row->choices[i]);
    if (n > 0 && (size_t)n < sizeof list - used)
      used += (size_t)n;
    text_guess_offer(&guess, row->choices[i]);
  }
  return status_fail(error, STATUS_CONTENT, "%s: expected %s, got '%.*s'%s%s%s", row->path, list, QUOTE, text,
                     guess.nearest ? "; did you mean '" : "", guess.nearest ? guess.nearest : "",
                     guess.nearest ? "'?" : "");
}

/* Bring a value to the row's own kind, in range. */
status field_set_value(const struct field *row, const struct field_value *value, struct field_value *out,
                       struct error *error) {
  memset(out, 0, sizeof *out);
  out->kind = row->kind;
  switch (row->kind) {
  case FIELD_REAL:
    if (value->kind != FIELD_REAL && value->kind != FIELD_INTEGER)
      break;
    out->number = value->kind == FIELD_REAL ? value->number + 0.0 : (double)value->integer; /* -0 becomes 0 */
    if (isnan(out->number) && row->flags & FIELD_MAY_BE_OFF)
      return out->number = (double)NAN, STATUS_OK; /* one bit pattern */
    return check_range(row, out->number, out, error);
  case FIELD_INTEGER:
    if (value->kind != FIELD_REAL && value->kind != FIELD_INTEGER)
      break;
    if (value->kind == FIELD_REAL) {
      if (!(fabs(value->number) <= 9007199254740992.0) || value->number != floor(value->number)) {
        char came[32];
        field_print_number(value->number, came);
        return status_fail(error, STATUS_CONTENT, "%s: expected a whole number, got %s", row->path, came);
      }
      out->integer = (int64_t)value->number;
    } else {
      out->integer = value->integer;
    }
    return check_range(row, (double)out->integer, out, error);
  case FIELD_BOOLEAN:
    if (value->kind != FIELD_BOOLEAN)
      break;
    out->number = value->number != 0;
    return STATUS_OK;
  case FIELD_CHOICE:
    if (value->kind != FIELD_CHOICE && value->kind != FIELD_TEXT)
      break;
    if (value->kind == FIELD_CHOICE && !value->text[0]) {
      if (!(value->number >= 0 && value->number < (double)field_choice_count(row)))
        return status_fail(error, STATUS_CONTENT, "%s: there is no choice number %g", row->path, value->number);
      out->number = floor(value->number);
      copy_text(out->text, row->choices[(size_t)value->number]);
      return STATUS_OK;
    }
    for (size_t i = 0; row->choices[i]; i++)
      if (strcmp(row->choices[i], value->text) == 0) {
        out->number = (double)i;
        copy_text(out->text, value->text);
        return STATUS_OK;
      }
    return unknown_choice(row, value->text, error);
  case FIELD_TEXT:
    if (value->kind != FIELD_TEXT && value->kind != FIELD_CHOICE)
      break;
    copy_text(out->text, value->text);
    return STATUS_OK;
  }
  static const char *const kinds[] = {"a number", "a whole number", "true or false", "a choice", "text"};
  return status_fail(error, STATUS_CONTENT, "%s: expected %s, got %s", row->path, kinds[row->kind], kinds[value->kind]);
}

status field_set(const struct field *row, void *object, const struct field_value *value, struct error *error) {
  struct field_value settled;
  status code = field_set_value(row, value, &settled, error);
  if (!code)
    field_set_unchecked(row, object, &settled);
  return code;
}
