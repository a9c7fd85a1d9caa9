/* Quantiles of every kind of axis, and axes in words. */
#include "campaign/design/design.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/engine.h"
#include "schemas/unit.h"

void design_axis_free_all(struct design_axis *axes, size_t count) {
  for (size_t i = 0; axes && i < count; i++)
    free(axes[i].levels);
  free(axes);
}

/* A quantity as a number in `unit`, with the digits of its text if it has this unit. */
static long double number_in(const char *text, const char *unit, const char *si) {
  struct unit factor;
  char digits[32];
  double value = NAN;
  if (strcmp(unit_of(text), unit) == 0)
    return strtold(text, NULL);
  (void)unit_read(text, si, &value, NULL);
  if (*unit && unit_parse(unit, &factor, NULL) == STATUS_OK)
    value /= factor.factor;
  snprintf(digits, sizeof digits, "%.15g", value);
  return strtold(digits, NULL);
}

double design_axis_spaced(const char *from, const char *to, const char *si, size_t n, bool logarithmic, size_t i) {
  double value = NAN;
  if (i == 0 || i == n - 1) {
    (void)unit_read(i == 0 ? from : to, si, &value, NULL);
    return value;
  }
  const char *unit = *unit_of(from) ? unit_of(from) : unit_of(to); /* the other end may be a bare 0 */
  const long double a = number_in(from, unit, si), b = number_in(to, unit, si), gaps = (long double)(n - 1);
  const long double up = (long double)i, down = (long double)(n - 1 - i);
  const long double level = logarithmic ? a * powl(b / a, up / gaps) : (down * a + up * b) / gaps;
  /* 15 digits of the larger end: near zero a sum has no more */
  const double largest = logarithmic ? (double)fabsl(level) : (double)fmaxl(fabsl(a), fabsl(b));
  const int decimals = 14 - (int)floor(log10(largest));
  char text[512];
  if (decimals >= 0 && decimals <= 300)
    snprintf(text, sizeof text, "%.*Lf %.80s", decimals, level, unit);
  else
    snprintf(text, sizeof text, "%.14Le %.80s", level, unit);
  (void)unit_read(text, si, &value, NULL);
  return value + 0.0; /* -0 becomes 0 */
}

double design_axis_deviations(const struct design_axis *axis, double x) {
  return axis->kind == DESIGN_AXIS_LOGNORMAL ? log(fmax(x, 0) / axis->a) / axis->b : (x - axis->a) / axis->b;
}

/* Quantile of the standard normal law cut to (lower, upper). In the upper half the survival function is used: its small
 * values keep their digits where 1 - p loses them. */
static double truncated_normal(double lower, double upper, double u) {
  if (lower > 0) {
    double from = gsl_cdf_ugaussian_Q(lower), to = gsl_cdf_ugaussian_Q(upper);
    return gsl_cdf_ugaussian_Qinv(from + u * (to - from));
  }
  double from = gsl_cdf_ugaussian_P(lower), to = gsl_cdf_ugaussian_P(upper);
  return gsl_cdf_ugaussian_Pinv(from + u * (to - from));
}

size_t design_axis_level(const struct design_axis *axis, double u) {
  size_t level = (size_t)(u * (double)axis->level_count);
  return level < axis->level_count ? level : axis->level_count - 1;
}

static void set_number(const struct field *row, double x, struct field_value *value) {
  *value = (struct field_value){.kind = row->kind};
  if (row->kind == FIELD_INTEGER)
    value->integer = (int64_t)llround(x);
  else
    value->number = x;
}

void design_axis_quantile(const struct design_axis *axis, double u, struct field_value *value) {
  if (axis->kind == DESIGN_AXIS_LEVELS) {
    *value = axis->levels[design_axis_level(axis, u)];
    return;
  }
  /* Keeps u half a unit of the generator's resolution away from 0 and 1, where an unbounded law has no value. */
  u = fmin(fmax(u, 0x1p-54), 1 - 0x1p-53);
  double x = NAN;
  switch (axis->kind) {
  case DESIGN_AXIS_UNIFORM:
    if (axis->row->kind == FIELD_INTEGER) /* every whole number from a to b has the same share */
      x = floor(axis->a + u * (axis->b - axis->a + 1));
    else
      x = axis->a + u * (axis->b - axis->a);
    break;
  case DESIGN_AXIS_LOG_UNIFORM: x = exp(log(axis->a) + u * (log(axis->b) - log(axis->a))); break;
  case DESIGN_AXIS_NORMAL:
  case DESIGN_AXIS_LOGNORMAL: {
    const double z = truncated_normal(design_axis_deviations(axis, axis->lower),
                                      design_axis_deviations(axis, axis->upper), u);
    x = axis->kind == DESIGN_AXIS_NORMAL ? axis->a + axis->b * z : axis->a * exp(axis->b * z);
    break;
  }
  default: break;
  }
  if (axis->kind == DESIGN_AXIS_UNIFORM || axis->kind == DESIGN_AXIS_LOG_UNIFORM)
    x = fmin(fmax(x, axis->a), axis->b); /* exp(log b) may be rounded to a value beyond b */
  x = fmin(fmax(x, axis->lower), axis->upper);
  set_number(axis->row, x, value);
  if (axis->row->kind == FIELD_INTEGER) { /* rounding must not cross a bound that is not a whole number */
    if ((double)value->integer < axis->lower)
      value->integer = (int64_t)ceil(axis->lower);
    if ((double)value->integer > axis->upper)
      value->integer = (int64_t)floor(axis->upper);
  }
}

/* Share of the standard normal law cut to (lower, upper) below x. */
static double truncated_share(double lower, double upper, double x) {
  if (lower > 0) /* the survival function keeps its digits there */
    return (gsl_cdf_ugaussian_Q(lower) - gsl_cdf_ugaussian_Q(x)) /
           (gsl_cdf_ugaussian_Q(lower) - gsl_cdf_ugaussian_Q(upper));
  return (gsl_cdf_ugaussian_P(x) - gsl_cdf_ugaussian_P(lower)) /
         (gsl_cdf_ugaussian_P(upper) - gsl_cdf_ugaussian_P(lower));
}

double design_axis_share(const struct design_axis *axis, const struct field_value *value) {
  const bool whole = axis->row->kind == FIELD_INTEGER;
  const double x = whole ? (double)value->integer : value->number;
  double share = NAN;
  switch (axis->kind) {
  case DESIGN_AXIS_UNIFORM:
    share = whole ? (x + 0.5 - axis->a) / (axis->b - axis->a + 1) : (x - axis->a) / (axis->b - axis->a);
    break;
  case DESIGN_AXIS_LOG_UNIFORM: share = log(x / axis->a) / log(axis->b / axis->a); break;
  case DESIGN_AXIS_NORMAL:
  case DESIGN_AXIS_LOGNORMAL:
    share = truncated_share(design_axis_deviations(axis, axis->lower), design_axis_deviations(axis, axis->upper),
                            design_axis_deviations(axis, x));
    break;
  default: break;
  }
  return isnan(share) ? share : fmin(fmax(share, 0), 1);
}

void design_axis_follow(const struct design_axis *axis, const struct field_value *followed, size_t level,
                        struct field_value *value) {
  if (axis->level_count) {
    *value = axis->levels[level < axis->level_count ? level : axis->level_count - 1];
    return;
  }
  double x = field_number(followed);
  set_number(axis->row, axis->a * x + axis->b, value);
}

/* ---- An axis as people read it: its values or its law, each number with its unit ---- */

enum { SHOWN = 12, VALUE_SIZE = FIELD_TEXT_SIZE + 64 };

const char *design_axis_show(const struct design_axis *axis, const struct field_value *value, char *text, size_t size) {
  struct unit unit;
  if (value->kind == FIELD_REAL && isfinite(value->number) && *axis->unit &&
      unit_parse(axis->unit, &unit, NULL) == STATUS_OK)
    snprintf(text, size, "%.6g %s", value->number / unit.factor, axis->unit);
  else
    field_show(axis->row, value, text, size);
  return text;
}

const char *design_axis_print(const struct design_axis *axis, const struct field_value *value, char *text,
                              size_t size) {
  struct unit unit;
  struct field_value back;
  struct error error;
  const char *shown = *axis->unit ? axis->unit : axis->row->unit && strcmp(axis->row->unit, "rad") == 0 ? "deg" : "";
  if (value->kind == FIELD_REAL && *shown && unit_parse(shown, &unit, NULL) == STATUS_OK) {
    snprintf(text, size, "%.12g %s", value->number / unit.factor, shown);
    if (field_parse(axis->row, text, &back, &error) == STATUS_OK && back.number == value->number)
      return text;
  }
  field_print(axis->row, value, text, size);
  return text;
}

/* The last word of the axis' path, "material" of "target.material.name", as tables call it. */
static const char *word_of(const struct design_axis *axis, char path[FIELD_TEXT_SIZE]) {
  field_copy_text(path, axis->row->path);
  char *word = strrchr(path, '.');
  if (word && axis->row->kind == FIELD_TEXT && strcmp(word, ".name") == 0) {
    *word = '\0';
    word = strrchr(path, '.');
  }
  return word ? word + 1 : path;
}

/* young_modulus is an input of the beams and a result of a block that is pulled. */
static bool names_result(const char *word) {
  for (size_t e = 0; e < engine_count(); e++)
    for (size_t i = 0; i < engine_at(e)->results->count; i++)
      if (strcmp(engine_at(e)->results->rows[i].path, word) == 0)
        return true;
  return false;
}

const char *design_axis_show_point(size_t count, const struct design_axis *axes, const void *inputs, char *text,
                                   size_t size) {
  *text = '\0';
  for (size_t i = 0; i < count; i++) {
    struct field_value value;
    char shown[VALUE_SIZE], path[FIELD_TEXT_SIZE], other[FIELD_TEXT_SIZE];
    const char *word = word_of(&axes[i], path);
    bool whole = names_result(word);
    for (size_t k = 0; k < count; k++)
      whole |= k != i && strcmp(word, word_of(&axes[k], other)) == 0; /* target.material and projectile.material */
    if (whole)
      word = path;
    field_get(axes[i].row, inputs, &value);
    text_append(text, size, "%s%s %s", i ? ", " : "", word, design_axis_show(&axes[i], &value, shown, sizeof shown));
  }
  text_powers(text, size);
  return text;
}

static const char *value_text(const struct design_axis *axis, const struct field_value *value, char text[VALUE_SIZE]) {
  return design_axis_show(axis, value, text, VALUE_SIZE);
}

/* The mean of an integer's law need not be an integer. */
static const char *number_text(const struct design_axis *axis, double number, char text[VALUE_SIZE]) {
  struct field real = *axis->row;
  struct design_axis of_reals = *axis;
  real.kind = FIELD_REAL;
  of_reals.row = &real;
  return value_text(&of_reals, &(struct field_value){.kind = FIELD_REAL, .number = number}, text);
}

static void print_levels(const struct design_axis *axis, FILE *out) {
  char text[VALUE_SIZE];
  const size_t n = axis->level_count, shown = n > SHOWN ? SHOWN - 1 : n;
  for (size_t i = 0; i < shown; i++)
    fprintf(out, "%s%s", i ? ", " : "", value_text(axis, &axis->levels[i], text));
  if (shown < n)
    fprintf(out, " ... %s: %zu values", value_text(axis, &axis->levels[n - 1], text), n);
}

void design_axis_describe(const struct design_axis *axes, size_t index, FILE *out) {
  const struct design_axis *axis = &axes[index];
  const struct field *row = axis->row;
  char a[VALUE_SIZE], b[VALUE_SIZE];
  if (axis->kind == DESIGN_AXIS_LINKED)
    fprintf(out, "follows %s: ", axes[axis->linked].row->path);
  if (axis->level_count) {
    print_levels(axis, out);
    return;
  }
  number_text(axis, axis->a, a);
  number_text(axis, axis->b, b);
  switch ((enum design_axis_kind)axis->kind) {
  case DESIGN_AXIS_LEVELS: break;
  case DESIGN_AXIS_UNIFORM: fprintf(out, "uniform from %s to %s", a, b); return;
  case DESIGN_AXIS_LOG_UNIFORM: fprintf(out, "uniform in the logarithm from %s to %s", a, b); return;
  case DESIGN_AXIS_LINKED:
    fprintf(out, "%g times it", axis->a);
    if (axis->b != 0)
      fprintf(out, " plus %s", b);
    return;
  case DESIGN_AXIS_NORMAL: fprintf(out, "normal, mean %s, standard deviation %s", a, b); break;
  case DESIGN_AXIS_LOGNORMAL:
    fprintf(out, "lognormal, median %s, sigma of the natural logarithm %g", a, axis->b);
    break;
  }
  if (axis->lower > row->minimum)
    fprintf(out, ", not below %s", number_text(axis, axis->lower, a));
  if (axis->upper < row->maximum)
    fprintf(out, ", not above %s", number_text(axis, axis->upper, b));
}
