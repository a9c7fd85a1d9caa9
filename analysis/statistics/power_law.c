/* The likelihood equation of a power law and its root. */
#include "analysis/statistics/power_law.h"

#include <float.h>
#include <math.h>

/* G(y) = 1/y - 1/(e^y - 1): the mean of an exponential distribution of rate y, cut at 1. It falls from 1 (y -> -inf)
 * through 1/2 to 0. Near zero the two terms cancel; the series to y^7 used there has an error below 1e-15 for
 * |y| < 0.3. */
static double cut_mean(double y) {
  if (fabs(y) < 0.3) {
    double z = y * y;
    return 0.5 - y * (1.0 / 12 - z * (1.0 / 720 - z * (1.0 / 30240 - z * (1.0 / 1209600 - z / 47900160))));
  }
  return 1 / y - 1 / expm1(y);
}

/* -G'(y) = 1/y^2 - 1/(4 sinh^2(y/2)): the variance of that distribution. */
static double cut_variance(double y) {
  if (fabs(y) < 0.3) {
    double z = y * y;
    return 1.0 / 12 - z * (1.0 / 240 - z * (1.0 / 6048 - z * (1.0 / 172800 - z / 5322240)));
  }
  double s = 2 * sinh(y / 2);
  return 1 / (y * y) - 1 / (s * s);
}

/* Mean and variance of a group's statistic at y. Without an upper bound, S G(S y) -> 1/y and S^2 V(S y) -> 1/y^2. */
static void expected(double y, double span, bool binned, double *mean, double *variance) {
  bool open = isinf(span);
  *mean = open ? 1 / y : span * cut_mean(span * y);
  *variance = open ? 1 / (y * y) : span * span * cut_variance(span * y);
  if (binned) {
    *mean -= cut_mean(y);
    *variance -= cut_variance(y);
  }
}

static double slope_of_likelihood(size_t count, const struct power_law_group *groups, bool binned, double y,
                                  double *information) {
  double slope = 0;
  *information = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    double mean, variance;
    expected(y, groups[g].span, binned, &mean, &variance);
    slope += groups[g].weight * (mean - groups[g].mean);
    *information += groups[g].weight * variance;
  }
  return slope;
}

/* ln of (1 - e^(-span y)) / y, the integral of e^(-yu) over [0, span]; span 1 serves the sum over bins. */
static double log_integral(double y, double span) {
  if (fabs(span * y) < 1e-8)
    return log(span) - span * y / 2;
  return y > 0 ? log(-expm1(-span * y) / y) : log(expm1(-span * y) / -y);
}

/* ln of the integral of e^(-yu) over [0, span], or of the sum of e^(-yj) over j < span. */
static double log_normalisation(double y, double span, bool binned) {
  double whole = isinf(span) ? -log(y) : log_integral(y, span);
  return binned ? whole - log_integral(y, 1) : whole;
}

/* What the search for the root needs to know of all groups. */
struct totals {
  double weight, sum; /* of the fragments, and of their statistic */
  double widest;      /* largest finite span */
  bool open;          /* a group has no upper bound */
  bool solvable;      /* the values are not all at one end of their windows, where beta would be infinite */
};

static struct totals totals_of(size_t count, const struct power_law_group *groups, bool binned) {
  struct totals totals = {0};
  bool above = false, below = false;
  for (size_t g = 0; g < count; g++) {
    const struct power_law_group *group = &groups[g];
    if (!(group->weight > 0))
      continue;
    double top = binned ? group->span - 1 : group->span; /* the largest value that the statistic can have */
    if (!(group->mean >= 0) || !(top > 0))
      return (struct totals){0};
    above = above || group->mean > 0;
    below = below || group->mean < top;
    if (isinf(group->span))
      totals.open = true;
    else
      totals.widest = fmax(totals.widest, group->span);
    totals.weight += group->weight;
    totals.sum += group->weight * group->mean;
  }
  totals.solvable = above && below;
  return totals;
}

/* When Newton's step leaves the bracket: halve it, or widen it while one side is open. */
static double step_inside(double low, double high, double widest) {
  if (isinf(high))
    return fmax(2 * low, low + 1 / fmax(widest, 1));
  if (isinf(low))
    return fmin(2 * high, high - 1 / fmax(widest, 1));
  return (low + high) / 2;
}

/* The root of the slope of the likelihood, by Newton's method in a bracket; with an open window it is above 0. The
 * start is the answer for open windows. */
static double root(size_t count, const struct power_law_group *groups, bool binned, const struct totals *totals) {
  double low = totals->open ? 0 : -HUGE_VAL, high = HUGE_VAL, information = 0;
  double y = binned ? log1p(totals->weight / totals->sum) : totals->weight / totals->sum;
  if (!totals->open && y * totals->widest < 4)
    y = 0;
  for (int step = 0; step < 200; step++) {
    double slope = slope_of_likelihood(count, groups, binned, y, &information);
    if (slope > 0)
      low = y;
    else
      high = y;
    double next = y + slope / information;
    if (!(next > low && next < high))
      next = step_inside(low, high, totals->widest);
    bool done = fabs(next - y) <= 4 * DBL_EPSILON * (1 + fabs(y)) || next == low || next == high;
    y = next;
    if (done)
      break;
  }
  return y;
}

struct power_law power_law_fit(size_t count, const struct power_law_group *groups, double bin_width) {
  const struct power_law none = {NAN, NAN, NAN};
  const bool binned = bin_width > 0;
  const struct totals totals = totals_of(count, groups, binned);
  if (!totals.solvable)
    return none;

  double y = root(count, groups, binned, &totals), scale = binned ? bin_width : 1, information = 0;
  slope_of_likelihood(count, groups, binned, y, &information);
  struct power_law fit = {.beta = 1 + y / scale, .standard_error = 1 / (scale * sqrt(information))};
  for (size_t g = 0; g < count; g++)
    if (groups[g].weight > 0)
      fit.log_likelihood -= groups[g].weight * (y * groups[g].mean + log_normalisation(y, groups[g].span, binned));
  return isfinite(fit.beta) && isfinite(fit.standard_error) ? fit : none;
}

double power_law_below(double beta, double u, double span) {
  double k = beta - 1;
  if (isinf(span))
    return -expm1(-k * u);
  return fabs(k * span) < 1e-12 ? u / span : expm1(-k * u) / expm1(-k * span);
}
