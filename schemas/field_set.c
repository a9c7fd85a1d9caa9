/* A value from the text that a user types, converted to a row's kind, checked and stored. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/file.h"
#include "schemas/unit.h"

enum { QUOTE = 60 };

void field_set_unchecked(const struct field *row, void *object, const struct field_value *value) {
  void *to = (char *)object + row->offset;
  const bool truth = value->number != 0;
  const int index = row->kind == FIELD_CHOICE ? (int)value->number : 0;
  switch (row->kind) {
  case FIELD_REAL: memcpy(to, &value->number, sizeof value->number); break;
  case FIELD_INTEGER: memcpy(to, &value->integer, sizeof value->integer); break;
  case FIELD_BOOLEAN: memcpy(to, &truth, sizeof truth); break;
  case FIELD_CHOICE: memcpy(to, &index, sizeof index); break;
  case FIELD_TEXT: field_copy_text(to, value->text); break;
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
  if (row->kind == FIELD_REAL && row->unit && strcmp(row->unit, "1") == 0 && row->maximum <= 1 &&
      number > row->maximum && number <= 100 * row->maximum && number >= 100 * row->minimum)
    return status_fail(error, STATUS_CONTENT, "%s: expected %s%s, got %s; '%.6g %%' is %.6g", row->path, range,
                       row->flags & FIELD_MAY_BE_OFF ? ", or off" : "", came, number, number / 100);
  return status_fail(error, STATUS_CONTENT, "%s: expected %s%s, got %s", row->path, range,
                     row->flags & FIELD_MAY_BE_OFF ? ", or off" : "",
                     isfinite(number) ? came : "a number that is not finite");
}

static status set_real(const struct field *row, const struct field_value *value, struct field_value *out,
                       struct error *error) {
  out->number = value->kind == FIELD_REAL ? value->number + 0.0 : (double)value->integer; /* -0 becomes 0 */
  if (isnan(out->number) && row->flags & FIELD_MAY_BE_OFF) {
    out->number = (double)NAN; /* every NaN gets the same bits */
    return STATUS_OK;
  }
  return check_range(row, out->number, out, error);
}

static status set_integer(const struct field *row, const struct field_value *value, struct field_value *out,
                          struct error *error) {
  const double largest_exact = 9007199254740992.0; /* 2^53 */
  out->integer = value->integer;
  if (value->kind == FIELD_REAL) {
    if (!(fabs(value->number) <= largest_exact) || value->number != floor(value->number)) {
      char came[32];
      field_print_number(value->number, came);
      return status_fail(error, STATUS_CONTENT, "%s: expected a whole number, got %s", row->path, came);
    }
    out->integer = (int64_t)value->number;
  }
  return check_range(row, (double)out->integer, out, error);
}

static status unknown_choice(const struct field *row, const char *text, struct error *error) {
  char list[700];
  struct text_guess guess = text_guess(text);
  for (size_t i = 0; row->choices[i]; i++)
    text_guess_offer(&guess, row->choices[i]);

  field_describe_choices(row, list, sizeof list);
  if (row->kind == FIELD_TEXT && *text && strlen(text) <= QUOTE && !strpbrk(text, "/ ")) /* it may name a document */
    text_append(list, sizeof list, ", or a file such as ./%s.yaml", text);
  if (!guess.nearest)
    return status_fail(error, STATUS_CONTENT, "%s: expected %s, got '%.*s'", row->path, list, QUOTE, text);
  return status_fail(error, STATUS_CONTENT, "%s: expected %s, got '%.*s'; did you mean '%s'?", row->path, list, QUOTE,
                     text, guess.nearest);
}

/* Reads a choice by name, or by index when the name is empty. */
static status set_choice(const struct field *row, const struct field_value *value, struct field_value *out,
                         struct error *error) {
  const size_t count = field_choice_count(row);
  const bool by_index = value->kind == FIELD_CHOICE && !value->text[0];
  if (by_index && !(value->number >= 0 && value->number < (double)count))
    return status_fail(error, STATUS_CONTENT, "%s: there is no choice number %g", row->path, value->number);
  size_t index = by_index ? (size_t)value->number : 0;
  while (!by_index && index < count && strcmp(row->choices[index], value->text) != 0)
    index++;
  if (index == count)
    return unknown_choice(row, value->text, error);
  out->number = (double)index;
  field_copy_text(out->text, row->choices[index]);
  return STATUS_OK;
}

/* Can a value of this kind be converted to the row's kind? */
static bool suits(enum field_kind row, enum field_kind value) {
  switch (row) {
  case FIELD_REAL:
  case FIELD_INTEGER: return value == FIELD_REAL || value == FIELD_INTEGER;
  case FIELD_CHOICE:
  case FIELD_TEXT: return value == FIELD_TEXT || value == FIELD_CHOICE;
  case FIELD_BOOLEAN: break;
  }
  return value == FIELD_BOOLEAN;
}

status field_set_value(const struct field *row, const struct field_value *value, struct field_value *out,
                       struct error *error) {
  static const char *const kinds[] = {"a number", "a whole number", "true or false", "a choice", "text"};
  memset(out, 0, sizeof *out);
  out->kind = row->kind;
  if (!suits(row->kind, value->kind))
    return status_fail(error, STATUS_CONTENT, "%s: expected %s, got %s", row->path, kinds[row->kind],
                       kinds[value->kind]);
  switch (row->kind) {
  case FIELD_REAL: return set_real(row, value, out, error);
  case FIELD_INTEGER: return set_integer(row, value, out, error);
  case FIELD_CHOICE: return set_choice(row, value, out, error);
  case FIELD_BOOLEAN: out->number = value->number != 0; break;
  case FIELD_TEXT:
    if (row->choices && !field_is_choice(row, value->text) && !file_name_is_document(value->text))
      return unknown_choice(row, value->text, error);
    field_copy_text(out->text, value->text);
    break;
  }
  return STATUS_OK;
}

status field_set(const struct field *row, void *object, const struct field_value *value, struct error *error) {
  struct field_value settled;
  TRY(field_set_value(row, value, &settled, error));
  field_set_unchecked(row, object, &settled);
  return STATUS_OK;
}

/* ---- a value from the text that a user types ---- */

static status parse_real(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  const bool may_be_off = row->flags & FIELD_MAY_BE_OFF;
  if (strcmp(text, "off") == 0) {
    came->number = (double)NAN;
    return may_be_off ? STATUS_OK : status_fail(error, STATUS_CONTENT, "%s: cannot be switched off", row->path);
  }
  struct error inner;
  struct unit written;
  status code = unit_read(text, row->unit ? row->unit : "1", &came->number, &inner);
  if (code && row->flags & FIELD_ANY_UNIT && unit_parse(unit_of(text), &written, NULL) == STATUS_OK) {
    came->number = strtod(text, NULL) * written.factor;
    return STATUS_OK;
  }
  const char *got = code && may_be_off ? strstr(inner.message, ", got ") : NULL;
  if (got)
    return status_fail(error, code, "%s: %.*s, or off%s", row->path, (int)(got - inner.message), inner.message, got);
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

static status parse_text(const struct field *row, const char *text, struct field_value *came, struct error *error) {
  if (strlen(text) >= FIELD_TEXT_SIZE)
    return status_fail(error, STATUS_CONTENT, "%s: expected at most %d bytes of text, got %zu", row->path,
                       FIELD_TEXT_SIZE - 1, strlen(text));
  if (row->flags & FIELD_REQUIRED && !*text)
    return status_fail(error, STATUS_CONTENT, "%s: expected text, got an empty one", row->path);
  field_copy_text(came->text, text);
  return STATUS_OK;
}

/* The number of so many digits: with 15 without the residue of a conversion. */
static double of_digits(int digits, double number) {
  char text[32];
  snprintf(text, sizeof text, "%.*g", digits, number);
  return strtod(text, NULL);
}

/* Without this check "threshold.angle=4" would be 229 degrees: a user who leaves out the unit may mean any. */
static status check_unit(const struct field *row, const char *text, struct error *error) {
  if (!field_needs_unit(row) || !unit_is_bare(text) || strtod(text, NULL) == 0)
    return STATUS_OK;

  const char *unit = row->unit ? row->unit : "1", *usual = unit_usual(unit);
  text += strspn(text, " ");
  const int length = (int)strcspn(text, " ") < QUOTE ? (int)strcspn(text, " ") : QUOTE;
  if (strcmp(unit, "1") == 0) {
    char percent[32];
    field_print_number(of_digits(15, 100 * strtod(text, NULL)), percent);
    return status_fail(error, STATUS_CONTENT, "%s: %.*s is a percentage or a fraction; write '%.*s %%' or '%s %%'",
                       row->path, length, text, length, text, percent);
  }
  if (usual) {
    const bool large = fabs(strtod(text, NULL)) >= 1e4; /* 3e8 are pascals, not gigapascals */
    return status_fail(error, STATUS_CONTENT, "%s: %.*s has no unit; write '%.*s %s' or '%.*s %s'", row->path, length,
                       text, length, text, large ? unit : usual, length, text, large ? usual : unit);
  }
  return status_fail(error, STATUS_CONTENT, "%s: %.*s has no unit; write '%.*s %s'", row->path, length, text, length,
                     text, unit);
}

/* Tells the range of a number in the unit of its text: "below 90 deg, got 90 deg". */
static status check_range_of_text(const struct field *row, const char *text, const struct field_value *came,
                                  struct error *error) {
  const char *unit = unit_of(text);
  struct field_value ignored, told = *came;
  struct unit written;
  if (row->kind != FIELD_REAL || !*unit || strcmp(unit, field_shown_unit(row)) == 0 ||
      unit_parse(unit, &written, NULL) != STATUS_OK || field_set_value(row, came, &ignored, NULL) == STATUS_OK)
    return STATUS_OK;
  struct field in_unit = *row;
  in_unit.unit = unit;
  in_unit.flags &= ~(unsigned)FIELD_PERCENT;
  in_unit.minimum = of_digits(6, row->minimum / written.factor);
  in_unit.maximum = of_digits(6, row->maximum / written.factor);
  told.number = of_digits(15, came->number / written.factor);
  return field_set_value(&in_unit, &told, &ignored, error); /* or the message in SI, if this one can be accepted */
}

status field_parse_si(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  struct field_value came = {.kind = row->kind};
  switch (row->kind) {
  case FIELD_REAL: TRY(parse_real(row, text, &came, error)); break;
  case FIELD_INTEGER: TRY(parse_integer(row, text, &came, error)); break;
  case FIELD_BOOLEAN:
    came.number = strcmp(text, "true") == 0;
    if (came.number == 0 && strcmp(text, "false") != 0)
      return status_fail(error, STATUS_CONTENT, "%s: expected true or false, got '%.*s'", row->path, QUOTE, text);
    break;
  case FIELD_TEXT: TRY(parse_text(row, text, &came, error)); break;
  case FIELD_CHOICE: /* any text is accepted here: field_set_value reports unknown choices */
    came.kind = FIELD_TEXT;
    field_copy_text(came.text, text);
    break;
  }
  TRY(check_range_of_text(row, text, &came, error));
  return field_set_value(row, &came, value, error);
}

status field_parse(const struct field *row, const char *text, struct field_value *value, struct error *error) {
  TRY(check_unit(row, text, error));
  return field_parse_si(row, text, value, error);
}
