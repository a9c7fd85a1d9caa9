/* Rows and values as text: for people, as JSON, on the axes of charts, and for `clast explain`. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"

enum { NUMBER = 32 }; /* bytes of a number as text; the longest has 25 */

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
    text_append(text, NUMBER, "0.%.*s%s", (int)(-d.exponent - 1), "00000", d.mantissa); /* 0.00012 */
  else if (d.exponent >= 0 && d.exponent < (d.count > 4 ? 9 : 6)) { /* 5000, 12.5 and 1234567, but not 5e8 */
    const int whole = (int)d.exponent + 1, missing = whole > (int)d.count ? whole - (int)d.count : 0;
    text_append(text, NUMBER, "%.*s%.*s%s%s", whole, d.mantissa, missing, "000000000", (int)d.count > whole ? "." : "",
                (int)d.count > whole ? d.mantissa + whole : "");
  } else if (d.count == 1)
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

static const char *choice_name(const struct field *row, const struct field_value *value) {
  if (value->text[0])
    return value->text;
  const size_t index = value->number >= 0 ? (size_t)value->number : 0;
  return index < field_choice_count(row) ? row->choices[index] : "?";
}

void field_print(const struct field *row, const struct field_value *value, char *buffer, size_t size) {
  const char *unit = field_shown_unit(row);
  switch (row->kind) {
  case FIELD_REAL: print_real(row, value->number, buffer, size); return;
  case FIELD_INTEGER: snprintf(buffer, size, "%" PRId64 "%s%s", value->integer, *unit ? " " : "", unit); return;
  case FIELD_BOOLEAN: snprintf(buffer, size, "%s", value->number != 0 ? "true" : "false"); return;
  case FIELD_CHOICE: snprintf(buffer, size, "%s", choice_name(row, value)); return;
  case FIELD_TEXT: snprintf(buffer, size, "%s", value->text); return;
  }
}

static double six_digits(double number) {
  char text[NUMBER];
  snprintf(text, sizeof text, "%.6g", number);
  return strtod(text, NULL);
}

/* A row whose angles are in degrees. */
static struct field in_degrees(const struct field *row) {
  struct field shown = *row;
  if (!row->unit || strcmp(row->unit, "rad") != 0)
    return shown;
  shown.unit = "deg";
  shown.minimum = six_digits(row->minimum * 180 / M_PI);
  shown.maximum = six_digits(row->maximum * 180 / M_PI);
  return shown;
}

void field_show(const struct field *row, const struct field_value *value, char *buffer, size_t size) {
  const struct field shown = in_degrees(row);
  struct field_value rounded = *value;
  if (row->kind == FIELD_REAL && isfinite(value->number))
    rounded.number = six_digits(shown.unit == row->unit ? value->number : value->number * 180 / M_PI);
  field_print(&shown, &rounded, buffer, size);
}

/* ---- conditions, choices and ranges of rows, in words ---- */

void field_describe_inactive(const struct field_table *table, const struct field *row, const void *object, char *text,
                             size_t size) {
  const struct field *other, *link = field_unmet(table, row, object, &other);
  *text = 0;
  if (!link || !other)
    return;
  char *wanted = NULL, came[FIELD_TEXT_SIZE];
  FILE *words = text_open(&wanted);
  field_describe_condition(link, words);
  text_close_small(words, &wanted);

  struct field_value value;
  field_get(other, object, &value);
  field_print(other, &value, came, sizeof came);
  snprintf(text, size, "used only when %s is %s; here it is %s", other->path, wanted, came);
  free(wanted);
}

void field_describe_condition(const struct field *row, FILE *out) {
  const char *equals = strchr(row->when, '=');
  for (const char *at = equals ? equals + 1 : ""; *at; at++) {
    if (*at == '|')
      fputs(" or ", out);
    else
      fputc(*at, out);
  }
}

void field_describe_choices(const struct field *row, char *text, size_t size) {
  *text = 0;
  for (size_t i = 0; row->choices[i]; i++) {
    const char *between = row->choices[i + 1] ? ", " : " or ";
    text_append(text, size, "%s%s", i ? between : "", row->choices[i]);
  }
}

/* A bound as a user would write it: "0", or "1e-7" for a row in percent. */
static void print_bound(const struct field *row, double bound, char text[64]) {
  struct field bare = *row;
  bare.kind = FIELD_REAL;
  bare.unit = "1";
  const struct field_value value = {.kind = FIELD_REAL, .number = bound};
  field_print(&bare, &value, text, 64);
  text[strcspn(text, " ")] = 0;
}

void field_describe_range(const struct field *row, char *text, size_t size) {
  char low[64], high[64];
  const char *unit = field_shown_unit(row), *space = *unit ? " " : "";
  print_bound(row, row->minimum, low);
  print_bound(row, row->maximum, high);
  bool has_low = row->minimum > -HUGE_VAL,
       has_high = row->maximum < (row->kind == FIELD_INTEGER ? 0x1p53 : HUGE_VAL); /* 2^53: no bound of its own */
  const char *from = row->flags & FIELD_ABOVE_MINIMUM ? "above" : "at least";
  const char *to = row->flags & FIELD_BELOW_MAXIMUM ? "below" : "at most";
  if (has_low && has_high)
    snprintf(text, size, "%s %s and %s %s%s%s", from, low, to, high, space, unit);
  else if (has_low)
    snprintf(text, size, "%s %s%s%s", from, low, space, unit);
  else if (has_high)
    snprintf(text, size, "%s %s%s%s", to, high, space, unit);
  else
    snprintf(text, size, "a number%s%s", *unit ? " in " : "", unit);
}

/* ---- `clast explain` ---- */

enum { WIDTH = 100, INDENT = 4 };

static void explain_choices(const struct field *row, FILE *out) {
  const char *doc = row->choice_docs;
  for (size_t i = 0; row->choices[i]; i++) {
    size_t length = doc ? strcspn(doc, "\n") : 0;
    fprintf(out, "%*s%s%s%.*s\n", INDENT + 2, "", row->choices[i], length ? ": " : "", (int)length, doc ? doc : "");
    if (doc)
      doc += length + (doc[length] == '\n');
  }
}

/* " in m, above 0 m, or off"; of a result " in m, above 0 m, or no value" */
static void explain_range(const struct field *row, bool result, FILE *out) {
  char range[160], unit[64];
  struct field shown = in_degrees(row);
  text_unit(shown.unit, unit, sizeof unit);
  if (*unit)
    shown.unit = unit;
  field_describe_range(&shown, range, sizeof range);
  if (row->unit && strcmp(row->unit, "1"))
    fprintf(out, " in %s", shown.unit);
  if (row->flags & FIELD_PERCENT)
    fputs(" in percent", out);
  if (strncmp(range, "a number", 8) != 0)
    fprintf(out, ", %s", range);
  if (row->flags & FIELD_MAY_BE_OFF)
    fputs(result ? ", or no value" : ", or off", out);
}

static void explain_default(const struct field *row, FILE *out) {
  struct field_value value;
  char text[FIELD_TEXT_SIZE + 64];
  if (row->flags & FIELD_REQUIRED) {
    fputs("; required\n", out);
    return;
  }
  if (row->flags & FIELD_DERIVED) {
    fputs("; default follows from other inputs\n", out);
    return;
  }
  field_default(row, &value);
  field_show(row, &value, text, sizeof text);
  fprintf(out, row->kind == FIELD_TEXT ? "; default \"%s\"\n" : "; default %s\n", text);
}

static void explain_row(const struct field *row, bool result, FILE *out) {
  static const char *const kinds[] = {"real", "integer", "true or false", "choice", "text"};
  fprintf(out, "%s: %s", row->path, kinds[row->kind]);
  if (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER)
    explain_range(row, result, out);
  if (result)
    fputc('\n', out);
  else
    explain_default(row, out);
  if (row->doc && *row->doc)
    text_wrap(row->doc, 0, INDENT, WIDTH, out);
  if (row->kind == FIELD_CHOICE)
    explain_choices(row, out);
  if (row->when) {
    fprintf(out, "%*sOnly when %.*s is ", INDENT, "", (int)strcspn(row->when, "="), row->when);
    field_describe_condition(row, out);
    fputc('\n', out);
  }
  if (row->source)
    fprintf(out, "%*sSource: %s\n", INDENT, "", row->source);
}

size_t field_explain(const struct field_table *table, const char *prefix, bool results, FILE *out) {
  size_t length = strlen(prefix), count = 0;
  char *text = NULL;
  FILE *rows = text_open(&text);
  while (length && prefix[length - 1] == '.')
    length--;
  for (size_t i = 0; i < table->count; i++) {
    const char *path = table->rows[i].path;
    if (strncmp(path, prefix, length) != 0 || (length && path[length] != 0 && path[length] != '.'))
      continue;
    explain_row(&table->rows[i], results, rows);
    count++;
  }
  text_close_small(rows, &text);
  text_wrap_lines(text, WIDTH, out);
  free(text);
  return count;
}

/* ---- names and units on the axes of charts ---- */

/* Bodies have the same inputs: those of the projectile are called so, and target.material.name is "material name". */
static size_t label_body(const char *path, char *label, size_t size) {
  const size_t length = strcspn(path, ".");
  const bool other = length == 10 && strncmp(path, "projectile", length) == 0 && strchr(path + length + 1, '.');
  return other && size > length + 1 ? (size_t)snprintf(label, size, "%.*s ", (int)length, path) : 0;
}

void field_label_path(const char *path, char *label, size_t size) {
  const char *from = strrchr(path, '.'); /* the last two parts of the path */
  while (from && from > path && from[-1] != '.')
    from--;
  if (!from)
    from = path;
  size_t used = label_body(path, label, size);
  for (; *from && used + 1 < size; from++)
    label[used++] = *from == '.' || *from == '_' ? ' ' : *from;
  if (size)
    label[used] = '\0';
}

void field_label(const struct field *row, char *label, size_t size) {
  if (row->label) {
    label[label_body(row->path, label, size)] = '\0';
    text_append(label, size, "%s", row->label);
  } else {
    field_label_path(row->path, label, size);
  }
}

void field_label_unit(const char *unit, char *text, size_t size) {
  char shown[64];
  text_unit(unit, shown, sizeof shown);
  text_raise(shown, text, size);
}

/* ---- an object as nested JSON ---- */

void field_json_value(const struct field *row, const struct field_value *value, FILE *out) {
  char number[32];
  switch (row->kind) {
  case FIELD_REAL:
    field_print_number(value->number, number);
    if (isnan(value->number))
      fputs("\"off\"", out);
    else
      fputs(isinf(value->number) ? "null" : number, out); /* JSON has no infinity */
    break;
  case FIELD_INTEGER: fprintf(out, "%" PRId64, value->integer); break;
  case FIELD_BOOLEAN: fputs(value->number != 0 ? "true" : "false", out); break;
  case FIELD_CHOICE:
  case FIELD_TEXT: text_json_string(value->text, out); break;
  }
}

/* Rows that share their first word become one object. They need not be neighbours in the table: a section is opened
 * once, at its first active row, and includes all later rows of the section. */
static void write_level(const struct field_table *table, const void *object, const char *prefix, size_t length,
                        FILE *out) {
  bool first = true;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    if (strncmp(row->path, prefix, length) != 0 || !field_is_active(table, row, object))
      continue;
    const char *word = row->path + length;
    size_t word_length = strcspn(word, "."), whole = length + word_length + 1;
    bool section = word[word_length] == '.', seen = false;
    for (size_t j = 0; section && j < i && !seen; j++)
      seen = strncmp(table->rows[j].path, row->path, whole) == 0 && field_is_active(table, &table->rows[j], object);
    if (seen)
      continue;
    fprintf(out, "%s\"%.*s\":", first ? "" : ",", (int)word_length, word);
    first = false;
    if (section) {
      fputc('{', out);
      write_level(table, object, row->path, whole, out);
      fputc('}', out);
    } else {
      struct field_value value;
      field_get(row, object, &value);
      field_json_value(row, &value, out);
    }
  }
}

char *field_json(const struct field_table *table, const void *object) {
  char *text = NULL;
  FILE *out = text_open(&text);
  fputc('{', out);
  field_json_members(table, object, out);
  fputc('}', out);
  return text_close_small(out, &text);
}

void field_json_members(const struct field_table *table, const void *object, FILE *out) {
  write_level(table, object, "", 0, out);
}
