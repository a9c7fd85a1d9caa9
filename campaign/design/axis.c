/* Quantiles of every kind of axis. */
#include "campaign/design/axis.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

void design_axis_free_all(struct design_axis *axes, size_t count) {
  for (size_t i = 0; axes && i < count; i++)
    free(axes[i].levels);
  free(axes);
}

double design_axis_spaced(double from, double to, size_t n, bool logarithmic, size_t i) {
  if (i == 0 || n < 2)
    return from;
  if (i == n - 1)
    return to;
  double share = (double)i / (double)(n - 1);
  if (logarithmic)
    return exp(log(from) + share * (log(to) - log(from)));
  return from + share * (to - from);
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
    x = axis->a + axis->b * truncated_normal((axis->lower - axis->a) / axis->b, (axis->upper - axis->a) / axis->b, u);
    break;
  case DESIGN_AXIS_LOGNORMAL: {
    double lower = axis->lower > 0 ? log(axis->lower / axis->a) / axis->b : -HUGE_VAL;
    double upper = log(axis->upper / axis->a) / axis->b;
    x = axis->a * exp(axis->b * truncated_normal(lower, upper, u));
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
    share = truncated_share((axis->lower - axis->a) / axis->b, (axis->upper - axis->a) / axis->b,
                            (x - axis->a) / axis->b);
    break;
  case DESIGN_AXIS_LOGNORMAL:
    share = truncated_share(axis->lower > 0 ? log(axis->lower / axis->a) / axis->b : -HUGE_VAL,
                            log(axis->upper / axis->a) / axis->b, log(x / axis->a) / axis->b);
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
  double x = followed->kind == FIELD_INTEGER ? (double)followed->integer : followed->number;
  set_number(axis->row, axis->a * x + axis->b, value);
}
