#include "analysis/statistics/power_law.h"

#include <float.h>
#include <math.h>

/* G(y) = 1/y - 1/(e^y - 1): the mean of an exponential of rate y cut at 1; falls from 1 (y -> -inf) through 1/2 to 0.
 * Near zero the two terms cancel: series to y^7 there, error below 1e-15 for |y| < 0.3. */
static double cut_mean(double y) {
  if (fabs(y) < 0.3) {
    double z = y * y;
    return 0.5 - y * (1.0 / 12 - z * (1.0 / 720 - z * (1.0 / 30240 - z * (1.0 / 1209600 - z / 47900160))));
  }
  return 1 / y - 1 / expm1(y);
}

/* -G'(y) = 1/y^2 - 1/(4 sinh^2(y/2)): the variance of the same. */
static double cut_variance(double y) {
  if (fabs(y) < 0.3) {
    double z = y * y;
    return 1.0 / 12 - z * (1.0 / 240 - z * (1.0 / 6048 - z * (1.0 / 172800 - z / 5322240)));
  }
  double s = 2 * sinh(y / 2);
  return 1 / (y * y) - 1 / (s * s);
}

/* Mean and variance of a group's statistic at y; with no upper bound S G(S y) -> 1/y and S^2 V(S y) -> 1/y^2. */
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

/* ln of the integral of e^(-yu) over [0, span], or of the sum of e^(-yj) over j < span. */
static double log_normalisation(double y, double span, bool binned) {
  double reach;
  if (isinf(span))
    reach = -log(y);
  else if (fabs(span * y) < 1e-8)
    reach = log(span) - span * y / 2;
  else
    reach = y > 0 ? log(-expm1(-span * y) / y) : log(expm1(-span * y) / -y);
  if (!binned)
    return reach;
  return reach - (fabs(y) < 1e-8 ? -y / 2 : y > 0 ? log(-expm1(-y) / y) : log(expm1(-y) / -y));
}

struct power_law power_law_fit(size_t count, const struct power_law_group *groups, double bin_width) {
  const struct power_law none = {NAN, NAN, NAN};
  bool binned = bin_width > 0, open = false, above = false, below = false;
  double weight = 0, sum = 0, widest = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    double top = binned ? groups[g].span - 1 : groups[g].span; /* the largest value the statistic can have */
    if (!(groups[g].mean >= 0) || !(top > 0))
      return none;
    if (groups[g].mean > 0)
      above = true;
    if (groups[g].mean < top)
      below = true;
    if (isinf(groups[g].span))
      open = true;
    else
      widest = fmax(widest, groups[g].span);
    weight += groups[g].weight;
    sum += groups[g].weight * groups[g].mean;
  }
  if (!above || !below)
    return none; /* everything at one end of its window: beta would be infinite */

  /* The root lies between low and high; with an open window y > 0. Start from the answer of open windows. */
  double y = binned ? log1p(weight / sum) : weight / sum;
  double low = open ? 0 : -HUGE_VAL, high = HUGE_VAL;
  if (!open && y * widest < 4)
    y = 0;
  double information = 0;
  for (int step = 0; step < 200; step++) {
    double slope = slope_of_likelihood(count, groups, binned, y, &information);
    if (slope > 0)
      low = y;
    else
      high = y;
    double next = y + slope / information;
    if (!(next > low && next < high)) { /* Newton left the bracket: halve it, or widen while one side is open */
      if (isinf(high))
        next = fmax(2 * low, low + 1 / fmax(widest, 1));
      else if (isinf(low))
        next = fmin(2 * high, high - 1 / fmax(widest, 1));
      else
        next = (low + high) / 2;
    }
    if (fabs(next - y) <= 4 * DBL_EPSILON * (1 + fabs(y)) || next == low || next == high) {
      y = next;
      break;
    }
    y = next;
  }
  slope_of_likelihood(count, groups, binned, y, &information);
  double scale = binned ? bin_width : 1;
  struct power_law fit = {.beta = 1 + y / scale,
                          .standard_error = 1 / (scale * sqrt(information)),
                          .log_likelihood = 0};
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
