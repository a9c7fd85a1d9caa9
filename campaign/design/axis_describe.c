/* An axis as people read it: its values or its law, each number with its unit. */
#include "campaign/design/axis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SHOWN = 12, VALUE_SIZE = FIELD_TEXT_SIZE + 64 };

/* "0.0698132 rad (4 deg)": degrees are easier to read than radians. Six digits: levels of a range carry rounding
 * errors. */
static void print_value(const struct field *row, const struct field_value *value, FILE *out) {
  char text[VALUE_SIZE], digits[32];
  struct field_value shown = *value;
  snprintf(digits, sizeof digits, "%.6g", value->number);
  if (row->kind == FIELD_REAL)
    shown.number = strtod(digits, NULL);
  field_print(row, &shown, text, sizeof text);
  fputs(text, out);
  if (row->kind == FIELD_REAL && row->unit && strcmp(row->unit, "rad") == 0 && !isnan(value->number))
    fprintf(out, " (%.4g deg)", value->number * 180 / M_PI);
}

static void print_number(const struct field *row, double number, FILE *out) {
  struct field real = *row; /* the mean of an integer's law need not be an integer */
  real.kind = FIELD_REAL;
  print_value(&real, &(struct field_value){.kind = FIELD_REAL, .number = number}, out);
}

static void print_levels(const struct design_axis *axis, FILE *out) {
  const size_t n = axis->level_count, shown = n > SHOWN ? SHOWN - 1 : n;
  for (size_t i = 0; i < shown; i++) {
    fputs(i ? ", " : "", out);
    print_value(axis->row, &axis->levels[i], out);
  }
  if (shown == n)
    return;
  fputs(" ... ", out);
  print_value(axis->row, &axis->levels[n - 1], out);
  fprintf(out, ": %zu values", n);
}

static void print_pair(const struct field *row, const char *before, double a, const char *between, double b,
                       FILE *out) {
  fputs(before, out);
  print_number(row, a, out);
  fputs(between, out);
  print_number(row, b, out);
}

static void print_linked(const struct design_axis *axis, const struct design_axis *other, FILE *out) {
  fprintf(out, "follows %s: ", other->row->path);
  if (axis->level_count) {
    print_levels(axis, out);
    return;
  }
  fprintf(out, "%g times it", axis->a);
  if (axis->b == 0)
    return;
  fputs(" plus ", out);
  print_number(axis->row, axis->b, out);
}

static void print_cut(const struct design_axis *axis, FILE *out) {
  const bool low = axis->lower > axis->row->minimum, high = axis->upper < axis->row->maximum;
  fputs(low ? ", not below " : "", out);
  if (low)
    print_number(axis->row, axis->lower, out);
  fputs(high ? ", not above " : "", out);
  if (high)
    print_number(axis->row, axis->upper, out);
}

void design_axis_describe(const struct design_axis *axes, size_t index, FILE *out) {
  const struct design_axis *axis = &axes[index];
  switch ((enum design_axis_kind)axis->kind) {
  case DESIGN_AXIS_LEVELS: print_levels(axis, out); break;
  case DESIGN_AXIS_UNIFORM: print_pair(axis->row, "uniform from ", axis->a, " to ", axis->b, out); break;
  case DESIGN_AXIS_LOG_UNIFORM:
    print_pair(axis->row, "uniform in the logarithm from ", axis->a, " to ", axis->b, out);
    break;
  case DESIGN_AXIS_NORMAL:
    print_pair(axis->row, "normal, mean ", axis->a, ", standard deviation ", axis->b, out);
    print_cut(axis, out);
    break;
  case DESIGN_AXIS_LOGNORMAL:
    fputs("lognormal, median ", out);
    print_number(axis->row, axis->a, out);
    fprintf(out, ", sigma of the natural logarithm %g", axis->b);
    print_cut(axis, out);
    break;
  case DESIGN_AXIS_LINKED: print_linked(axis, &axes[axis->linked], out); break;
  }
}
