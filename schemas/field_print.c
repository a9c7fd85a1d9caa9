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

/* The number times 10^ten: its own shortest digits, with the point elsewhere. */
static void print_shifted(double number, long ten, char text[32]) {
  if (isnan(number)) {
    strcpy(text, "off");
    return;
  }
  if (isinf(number)) {
    strcpy(text, number > 0 ? "inf" : "-inf");
    return;
  }

  /* The fewest digits that read back as the same double, as d.ddde±x. */
  char digits[32];
  for (int precision = 0; precision < 17; precision++) {
    snprintf(digits, sizeof digits, "%.*e", precision, number);
    if (strtod(digits, NULL) == number)
      break;
  }
  char mantissa[24];
  size_t count = 0, i = digits[0] == '-';
  for (; digits[i] != 'e'; i++)
    if (digits[i] != '.')
      mantissa[count++] = digits[i];
  const long exponent = strtol(digits + i + 1, NULL, 10) + (number == 0 ? 0 : ten);

  char *to = text;
  if (digits[0] == '-')
    *to++ = '-';
  if (exponent >= -5 && exponent < 0)
    print_small(to, mantissa, count, exponent);
  else if (exponent >= 0 && (exponent < 6 || (exponent < 9 && count > 4))) /* 5000, but 5e8 */
    print_plain(to, mantissa, count, exponent);
  else if (count == 1)
    sprintf(to, "%ce%ld", mantissa[0], exponent);
  else
    sprintf(to, "%c.%.*se%ld", mantissa[0], (int)count - 1, mantissa + 1, exponent);
}

void field_print_number(double number, char text[32]) {
  print_shifted(number, 0, text);
}

int field_print(const struct field *row, const struct field_value *value, char *buffer, size_t size) {
  const bool percent = row->flags & FIELD_PERCENT;
  const char *unit = percent ? "%" : row->unit && strcmp(row->unit, "1") ? row->unit : "";
  const char *space = *unit ? " " : "";
  char number[32];
  switch (row->kind) {
  case FIELD_REAL:
    print_shifted(value->number, percent ? 2 : 0, number); /* decimal shifts are exact in unit_read, too */
    if (isnan(value->number))
      return snprintf(buffer, size, "%s", number);
    return snprintf(buffer, size, "%s%s%s", number, space, unit);
  case FIELD_INTEGER: return snprintf(buffer, size, "%" PRId64 "%s%s", value->integer, space, unit);
  case FIELD_BOOLEAN: return snprintf(buffer, size, "%s", value->number != 0 ? "true" : "false");
  case FIELD_CHOICE: {
    if (value->text[0])
      return snprintf(buffer, size, "%s", value->text);
    size_t index = value->number >= 0 ? (size_t)value->number : 0;
    return snprintf(buffer, size, "%s", index < field_choice_count(row) ? row->choices[index] : "?");
  }
  case FIELD_TEXT: return snprintf(buffer, size, "%s", value->text);
  }
  return 0;
}
