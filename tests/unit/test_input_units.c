/* Every input of every engine: a number that has a unit is never accepted without it, a value of absence is a value,
 * and a condition names a row and values of it. No engine has an integer input with a unit so far, so a fault that
 * concerns integers only is not seen here; test_field.c has such a row. */

#include "engine/engine.h"
#include "tests/support/check.h"

/* Has the row a unit? Answered from the row itself, not with the reader's own rule. */
static bool has_unit(const struct field *row) {
  const bool number = row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
  return number && (row->flags & FIELD_PERCENT || strcmp(row->unit, "1") != 0);
}

/* "4", "-4", "4e-3" and the row's own limits without the unit: each is refused, and the message names path and unit. */
static void refuses_bare_numbers(const struct field *row) {
  char limits[2][40];
  snprintf(limits[0], sizeof limits[0], "%.17g", row->minimum);
  snprintf(limits[1], sizeof limits[1], "%.17g", row->maximum);
  const char *const bare[] = {"4", "-4", " 4e-3 ", limits[0], limits[1]};
  const char *unit = row->flags & FIELD_PERCENT ? "%" : row->unit;

  for (size_t i = 0; i < sizeof bare / sizeof bare[0]; i++) {
    const double number = strtod(bare[i], NULL);
    if (number == 0 || !isfinite(number))
      continue; /* 0 is 0 in any unit; without a limit there is no number */
    struct field_value value;
    if (field_parse(row, bare[i], &value, &error) != STATUS_CONTENT)
      fail_msg("%s accepts %s without the unit %s", row->path, bare[i], unit);
    char end[60];
    snprintf(end, sizeof end, " %s'", unit);
    if (!strstr(error.message, row->path) || !strstr(error.message, end))
      fail_msg("%s: the message does not name the unit %s: %s", row->path, unit, error.message);
  }
}

TEST(inputs_with_a_unit_refuse_bare_numbers) {
  for (size_t e = 0; e < engine_count(); e++) {
    const struct field_table *inputs = engine_at(e)->inputs;
    size_t tried = 0;
    for (size_t i = 0; i < inputs->count; i++)
      if (has_unit(&inputs->rows[i])) {
        refuses_bare_numbers(&inputs->rows[i]);
        tried++;
      }
    assert_true(tried >= 10 ||
                engine_at(e)->of_scene); /* otherwise the loop tests nothing; scenes name the inputs of a command */
  }
}

/* field.absent is text: the compiler does not see a choice that is not there, or a number out of range. */
TEST(values_of_absence_are_values) {
  size_t tried = 0;
  for (size_t e = 0; e < engine_count(); e++) {
    const struct field_table *const tables[] = {engine_at(e)->inputs, engine_at(e)->results, &outcome_table};
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
      for (size_t i = 0; i < tables[t]->count; i++) {
        const struct field *row = &tables[t]->rows[i];
        struct field_value value;
        if (!row->absent)
          continue;
        tried++;
        if (t > 0)
          fail_msg("%s of the %s: only an input is part of an identity", row->path, tables[t]->name);
        if (field_parse_si(row, row->absent, &value, &error))
          fail_msg("%s: its value of absence is none of its values: %s", row->path, error.message);
      }
  }
  assert_true(tried >= 5); /* fracture.cell and others */
}

/* field.when is text that nests make: a row whose condition names nothing would never be active. */
TEST(conditions_name_rows_and_their_values) {
  size_t tried = 0;
  for (size_t e = 0; e < engine_count(); e++) {
    const struct field_table *inputs = engine_at(e)->inputs;
    for (size_t i = 0; i < inputs->count; i++) {
      const struct field *row = &inputs->rows[i], *controller = field_controller(inputs, row);
      if (!row->when)
        continue;
      if (!controller)
        fail_msg("%s: its condition %s names no row", row->path, row->when);
      for (const char *at = strchr(row->when, '=') + 1;; at++) {
        char word[60];
        struct field_value value;
        const size_t length = strcspn(at, "|");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        if (field_parse_si(controller, word, &value, NULL))
          fail_msg("%s: '%s' in its condition is no value of %s", row->path, word, controller->path);
        tried++;
        at += length;
        if (!*at)
          break;
      }
    }
  }
  assert_true(tried >= 100);
}
