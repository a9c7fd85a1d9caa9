/* The likelihood equation of a power law and its root. */
#include "analysis/statistics/power_law.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
static void expected(double y, double span, double *mean, double *variance) {
  bool open = isinf(span);
  *mean = open ? 1 / y : span * cut_mean(span * y);
  *variance = open ? 1 / (y * y) : span * span * cut_variance(span * y);
}

static double slope_of_likelihood(size_t count, const struct power_law_group *groups, double y, double *information) {
  double slope = 0;
  *information = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    double mean, variance;
    expected(y, groups[g].span, &mean, &variance);
    slope += groups[g].weight * (mean - groups[g].mean);
    *information += groups[g].weight * variance;
  }
  return slope;
}

/* ln of the integral of e^(-yu) over [0, span], (1 - e^(-span y)) / y. */
static double log_normalisation(double y, double span) {
  if (isinf(span))
    return -log(y);
  if (fabs(span * y) < 1e-8)
    return log(span) - span * y / 2;
  return y > 0 ? log(-expm1(-span * y) / y) : log(expm1(-span * y) / -y);
}

/* Data of all groups for the root search. */
struct totals {
  double weight, sum; /* sums over the fragments: their number, and their statistic */
  double widest;      /* largest finite span */
  bool open;          /* a group has no upper bound */
  bool solvable;      /* the values are not all at one end of their windows; there, beta would be infinite */
};

static struct totals totals_of(size_t count, const struct power_law_group *groups) {
  struct totals totals = {0};
  bool above = false, below = false;
  for (size_t g = 0; g < count; g++) {
    const struct power_law_group *group = &groups[g];
    if (!(group->weight > 0))
      continue;
    if (!(group->mean >= 0) || !(group->span > 0))
      return (struct totals){0};
    above = above || group->mean > 0;
    below = below || group->mean < group->span;
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

/* Used when Newton's step leaves the bracket: halves the bracket, or widens it while one side is open. */
static double step_inside(double low, double high, double widest) {
  if (isinf(high))
    return fmax(2 * low, low + 1 / fmax(widest, 1));
  if (isinf(low))
    return fmin(2 * high, high - 1 / fmax(widest, 1));
  return (low + high) / 2;
}

/* The root of the slope of the likelihood, by Newton's method in a bracket. With an open window the root is above 0.
 * The start value is the exact answer for open windows. */
static double root(size_t count, const struct power_law_group *groups, const struct totals *totals) {
  double low = totals->open ? 0 : -HUGE_VAL, high = HUGE_VAL, information = 0;
  double y = totals->weight / totals->sum;
  if (!totals->open && y * totals->widest < 4)
    y = 0;
  for (int step = 0; step < 200; step++) {
    double slope = slope_of_likelihood(count, groups, y, &information);
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

struct power_law power_law_fit(size_t count, const struct power_law_group *groups) {
  const struct power_law none = {NAN, NAN, NAN};
  const struct totals totals = totals_of(count, groups);
  if (!totals.solvable)
    return none;

  double k = root(count, groups, &totals), information = 0;
  slope_of_likelihood(count, groups, k, &information);
  struct power_law fit = {.beta = 1 + k, .standard_error = 1 / sqrt(information)};
  for (size_t g = 0; g < count; g++)
    if (groups[g].weight > 0)
      fit.log_likelihood -= groups[g].weight * (k * groups[g].mean + log_normalisation(k, groups[g].span));
  return isfinite(fit.beta) && isfinite(fit.standard_error) ? fit : none;
}

/* ---- Without a part of the groups ---- */

static double fit_without(size_t count, const struct power_law_group *groups, size_t begin, size_t end,
                          struct power_law_group *rest) {
  memcpy(rest, groups, begin * sizeof *rest);
  memcpy(rest + begin, groups + end, (count - end) * sizeof *rest);
  return power_law_fit(count - (end - begin), rest).beta;
}

enum { NODES = 8 };

/* The y at which x falls through 0, from NODES pairs, by inverse interpolation with Neville's scheme. NaN when x does
 * not fall through 0 between the nodes, or when the last node still changes the result: the caller then solves the
 * equation. */
static double zero_between(const double x[NODES], const double y[NODES]) {
  double column[NODES], before = NAN;
  for (int i = 0; i + 1 < NODES; i++)
    if (!(x[i] > x[i + 1]))
      return NAN;
  if (!(x[0] > 0 && x[NODES - 1] < 0))
    return NAN;
  for (int i = 0; i < NODES; i++) {
    column[i] = y[i];
    for (int k = i - 1; k >= 0; k--)
      column[k] = (x[k] * column[k + 1] - x[i] * column[k]) / (x[k] - x[i]);
    if (i == NODES - 2)
      before = column[0];
  }
  return fabs(column[0] - before) <= 1e-12 * (1 + fabs(column[0])) ? column[0] : (double)NAN;
}

/* Places the nodes near the roots without one part, from one Newton step for each part. */
static void place_nodes(size_t count, const struct power_law_group *groups, size_t each, double y,
                        double nodes[NODES]) {
  double information,
      furthest = 1e-6 * (1 + fabs(y)); /* if all parts are equal: a width above the rounding error of the slope */
  const double slope = slope_of_likelihood(count, groups, y, &information);
  for (size_t begin = 0; begin < count; begin += each) {
    double part_information;
    const size_t n = count - begin < each ? count - begin : each;
    const double part = slope_of_likelihood(n, groups + begin, y, &part_information);
    furthest = fmax(furthest, fabs((slope - part) / (information - part_information)));
  }
  for (int i = 0; i < NODES; i++)
    nodes[i] = y - 1.5 * furthest * cos(M_PI * (i + 0.5) / NODES);
}

bool power_law_leave_out(size_t count, const struct power_law_group *groups, size_t each, double *betas) {
  const size_t parts = (count + each - 1) / each;
  struct power_law_group *rest = malloc((count + 1) * sizeof *rest);
  double(*slopes)[NODES] = malloc((parts + 1) * sizeof *slopes), nodes[NODES], all[NODES] = {0};
  if (!rest || !slopes) {
    free(rest);
    free(slopes);
    return false;
  }

  const double y = power_law_fit(count, groups).beta - 1;
  place_nodes(count, groups, each, y, nodes);
  for (size_t p = 0; p < parts; p++)
    for (int i = 0; i < NODES; i++) {
      double unused;
      const size_t n = count - p * each < each ? count - p * each : each;
      slopes[p][i] = slope_of_likelihood(n, groups + p * each, nodes[i], &unused);
      all[i] += slopes[p][i];
    }
  for (size_t p = 0; p < parts; p++) {
    double x[NODES];
    for (int i = 0; i < NODES; i++)
      x[i] = all[i] - slopes[p][i];
    betas[p] = 1 + zero_between(x, nodes);
    if (isnan(betas[p]))
      betas[p] = fit_without(count, groups, p * each, p + 1 < parts ? (p + 1) * each : count, rest);
  }
  free(rest);
  free(slopes);
  return true;
}

double power_law_below(double beta, double u, double span) {
  double k = beta - 1;
  if (isinf(span))
    return -expm1(-k * u);
  return fabs(k * span) < 1e-12 ? u / span : expm1(-k * u) / expm1(-k * span);
}
