/* Numbers and values as the shortest text that reads back the same. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"

/* 0.00012 */
static void print_small(char *to, const char *mantissa, size_t count, long exponent) {
  to += sprintf(to, "0.%.*s", (int)(-exponent - 1), "00000");
  memcpy(to, mantissa, count);
  to[count] = 0;
}

/* 5000, 12.5 */
static void print_plain(char *to, const char *mantissa, size_t count, long exponent) {
  const size_t whole = (size_t)exponent + 1;
  for (size_t k = 0; k < count || k < whole; k++) {
    if (k == whole)
      *to++ = '.';
    *to++ = k < count ? mantissa[k] : '0';
  }
  *to = 0;
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
static void print_shifted(double number, long ten, char text[32]) {
  if (isnan(number)) {
    strcpy(text, "off");
    return;
  }
  if (signbit(number))
    *text++ = '-';
  if (isinf(number)) {
    strcpy(text, "inf");
    return;
  }

  struct digits d = shortest_digits(number);
  if (number != 0)
    d.exponent += ten;
  if (d.exponent >= -5 && d.exponent < 0)
    print_small(text, d.mantissa, d.count, d.exponent);
  else if (is_plain(&d))
    print_plain(text, d.mantissa, d.count, d.exponent);
  else if (d.count == 1)
    sprintf(text, "%ce%ld", d.mantissa[0], d.exponent);
  else
    sprintf(text, "%c.%.*se%ld", d.mantissa[0], (int)d.count - 1, d.mantissa + 1, d.exponent);
}

void field_print_number(double number, char text[32]) {
  print_shifted(number, 0, text);
}

static int print_real(const struct field *row, double number, char *buffer, size_t size) {
  char text[32];
  print_shifted(number, row->flags & FIELD_PERCENT ? 2 : 0, text); /* decimal shifts are also exact in unit_read */
  const char *unit = isnan(number) ? "" : field_shown_unit(row);
  return snprintf(buffer, size, "%s%s%s", text, *unit ? " " : "", unit);
}

static int print_integer(const struct field *row, int64_t integer, char *buffer, size_t size) {
  const char *unit = field_shown_unit(row);
  return snprintf(buffer, size, "%" PRId64 "%s%s", integer, *unit ? " " : "", unit);
}

static const char *choice_name(const struct field *row, const struct field_value *value) {
  if (value->text[0])
    return value->text;
  const size_t index = value->number >= 0 ? (size_t)value->number : 0;
  return index < field_choice_count(row) ? row->choices[index] : "?";
}

int field_print(const struct field *row, const struct field_value *value, char *buffer, size_t size) {
  switch (row->kind) {
  case FIELD_REAL: return print_real(row, value->number, buffer, size);
  case FIELD_INTEGER: return print_integer(row, value->integer, buffer, size);
  case FIELD_BOOLEAN: return snprintf(buffer, size, "%s", value->number != 0 ? "true" : "false");
  case FIELD_CHOICE: return snprintf(buffer, size, "%s", choice_name(row, value));
  case FIELD_TEXT: return snprintf(buffer, size, "%s", value->text);
  }
  return 0;
}
