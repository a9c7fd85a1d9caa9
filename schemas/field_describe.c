/* Conditions, choices and ranges of rows, in words. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/text.h"

void field_describe_inactive(const struct field_table *table, const struct field *row, const void *object, char *text,
                             size_t size) {
  const struct field *other, *link = field_unmet(table, row, object, &other);
  *text = 0;
  if (!link || !other)
    return;
  char *wanted = NULL, came[FIELD_TEXT_SIZE];
  size_t length = 0;
  FILE *words = text_open(&wanted, &length);
  if (!words)
    return;
  field_describe_condition(link, words);
  fclose(words);

  struct field_value value;
  field_get(other, object, &value);
  field_print(other, &value, came, sizeof came);
  snprintf(text, size, "used only when %s is %s; here it is %s", other->path, wanted ? wanted : "", came);
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
  bool has_low = row->minimum > -HUGE_VAL, has_high = row->maximum < HUGE_VAL;
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
