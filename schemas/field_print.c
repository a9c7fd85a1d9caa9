/* Numbers and values as the shortest text that reads back the same. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/text.h"

enum { NUMBER = 32 }; /* bytes of a number as text; the longest has 25 */

/* 0.00012 */
static void print_small(char text[NUMBER], const char *mantissa, long exponent) {
  text_append(text, NUMBER, "0.%.*s%s", (int)(-exponent - 1), "00000", mantissa);
}

/* 5000, 12.5 */
static void print_plain(char text[NUMBER], const char *mantissa, size_t count, long exponent) {
  const int whole = (int)exponent + 1, missing = whole > (int)count ? whole - (int)count : 0;
  text_append(text, NUMBER, "%.*s%.*s", whole, mantissa, missing, "000000000");
  if ((int)count > whole)
    text_append(text, NUMBER, ".%s", mantissa + whole);
}

/* The fewest digits that read back as the same double. */
struct digits {
  char mantissa[24]; /* without sign and point */
  size_t count;
  long exponent; /* decimal exponent of the first digit */
};

static struct digits shortest_digits(double number) {
  char text[32];
  for (int precision = 0; precision < 17; precision++) {
    snprintf(text, sizeof text, "%.*e", precision, number);
    if (strtod(text, NULL) == number)
      break;
  }
  struct digits d = {0};
  const char *at = text;
  for (; *at != 'e'; at++)
    if (*at >= '0' && *at <= '9')
      d.mantissa[d.count++] = *at;
  d.exponent = strtol(at + 1, NULL, 10);
  return d;
}

/* Is the number written without an exponent? 5000 and 1234567 are, 5e8 is not. */
static bool is_plain(const struct digits *d) {
  const long most = d->count > 4 ? 9 : 6;
  return d->exponent >= 0 && d->exponent < most;
}

/* Prints the number times 10^ten: its own shortest digits, with the decimal point moved. */
static void print_shifted(double number, long ten, char text[NUMBER]) {
  text[0] = '\0';
  text_append(text, NUMBER, "%s", isnan(number) ? "off" : signbit(number) ? "-" : "");
  if (isinf(number))
    text_append(text, NUMBER, "inf");
  if (!isfinite(number))
    return;

  struct digits d = shortest_digits(number);
  if (number != 0)
    d.exponent += ten;
  if (d.exponent >= -5 && d.exponent < 0)
    print_small(text, d.mantissa, d.exponent);
  else if (is_plain(&d))
    print_plain(text, d.mantissa, d.count, d.exponent);
  else if (d.count == 1)
    text_append(text, NUMBER, "%ce%ld", d.mantissa[0], d.exponent);
  else
    text_append(text, NUMBER, "%c.%se%ld", d.mantissa[0], d.mantissa + 1, d.exponent);
}

void field_print_number(double number, char text[NUMBER]) {
  print_shifted(number, 0, text);
}

static void print_real(const struct field *row, double number, char *buffer, size_t size) {
  char text[NUMBER];
  print_shifted(number, row->flags & FIELD_PERCENT ? 2 : 0, text); /* decimal shifts are also exact in unit_read */
  const char *unit = isnan(number) ? "" : field_shown_unit(row);
  snprintf(buffer, size, "%s%s%s", text, *unit ? " " : "", unit);
}

static void print_integer(const struct field *row, int64_t integer, char *buffer, size_t size) {
  const char *unit = field_shown_unit(row);
  snprintf(buffer, size, "%" PRId64 "%s%s", integer, *unit ? " " : "", unit);
}

static const char *choice_name(const struct field *row, const struct field_value *value) {
  if (value->text[0])
    return value->text;
  const size_t index = value->number >= 0 ? (size_t)value->number : 0;
  return index < field_choice_count(row) ? row->choices[index] : "?";
}

void field_print(const struct field *row, const struct field_value *value, char *buffer, size_t size) {
  switch (row->kind) {
  case FIELD_REAL: print_real(row, value->number, buffer, size); return;
  case FIELD_INTEGER: print_integer(row, value->integer, buffer, size); return;
  case FIELD_BOOLEAN: snprintf(buffer, size, "%s", value->number != 0 ? "true" : "false"); return;
  case FIELD_CHOICE: snprintf(buffer, size, "%s", choice_name(row, value)); return;
  case FIELD_TEXT: snprintf(buffer, size, "%s", value->text); return;
  }
}
