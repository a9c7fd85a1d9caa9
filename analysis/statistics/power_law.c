/* The likelihood equation of a power law and its root; its rivals by Newton's method on quadrature. */
#include "analysis/statistics/statistics.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

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

static double slope_of_likelihood(size_t count, const struct power_law_group *groups, double y, double *information) {
  double slope = 0;
  *information = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    /* Mean and variance of u at y. Without an upper bound, L G(L y) -> 1/y and L^2 V(L y) -> 1/y^2. */
    const double span = groups[g].span, mean = isinf(span) ? 1 / y : span * cut_mean(span * y);
    const double variance = isinf(span) ? 1 / (y * y) : span * span * cut_variance(span * y);
    slope += groups[g].weight * (mean - groups[g].mean);
    *information += groups[g].weight * variance;
  }
  return slope;
}

/* ln of the integral of e^(-yu) over [0, span], (1 - e^(-span y)) / y. */
static double log_integral(double y, double span) {
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
      fit.log_likelihood -= groups[g].weight * (k * groups[g].mean + log_integral(k, groups[g].span));
  return fabs(k) < POWER_LAW_STEEPEST && isfinite(fit.standard_error) ? fit : none;
}

/* ---- Without a part of the groups ---- */

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
  OWNED struct power_law_group *rest = malloc((count + 1) * sizeof *rest);
  OWNED double(*slopes)[NODES] = malloc((parts + 1) * sizeof *slopes);
  double nodes[NODES], all[NODES] = {0};
  if (!rest || !slopes)
    return false;

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
    if (isnan(betas[p])) {
      const size_t begin = p * each, end = p + 1 < parts ? begin + each : count;
      memcpy(rest, groups, begin * sizeof *rest);
      memcpy(rest + begin, groups + end, (count - end) * sizeof *rest);
      betas[p] = power_law_fit(count - (end - begin), rest).beta;
    }
  }
  return true;
}

double power_law_below(double beta, double u, double span) {
  double k = beta - 1;
  if (isinf(span))
    return -expm1(-k * u);
  return fabs(k * span) < 1e-12 ? u / span : expm1(-k * u) / expm1(-k * span);
}

/* ---- The rivals ---- */

/* 16-point Gauss-Legendre on [-1, 1], positive half (Abramowitz & Stegun table 25.4). */
enum { HALF_NODES = 8 };
static const double node[HALF_NODES] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                        0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                                        0.9445750230732325761, 0.9894009349916499326};
static const double node_weight[HALF_NODES] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                                               0.1495959888165767321, 0.1246289712555338720, 0.0951585116824927848,
                                               0.0622535239386478929, 0.0271524594117540949};

static double factor(enum power_law_kind kind, double u) {
  return kind == POWER_LAW_CUTOFF ? expm1(u) : u * u;
}

static double exponent_at(enum power_law_kind kind, double k, double s, double u) {
  return s > 0 ? -k * u - s * factor(kind, u) : -k * u;
}

/* Where the exponent is largest on [0, span): at 0, at the end, or where its derivative -k - s h'(u) vanishes. */
static double place_of_maximum(enum power_law_kind kind, double k, double s, double span) {
  double top = 0;
  if (k < 0) {
    if (s > 0)
      top = kind == POWER_LAW_CUTOFF ? log(fmax(-k / s, 1)) : -k / (2 * s);
    else
      top = span;
  }
  return fmin(top, span);
}

/* The u beyond which the integrand is below e^-42 of its maximum and falls at least exponentially: the rest is below a
 * double's precision. */
static double reach(enum power_law_kind kind, double k, double s, double span) {
  double top = place_of_maximum(kind, k, s, span);
  double low = top, peak = exponent_at(kind, k, s, top), step = 1;
  while (low + step < span && exponent_at(kind, k, s, low + step) > peak - 42) {
    low += step;
    step *= 2;
  }
  for (double high = fmin(low + step, span); high - low > 0.25;) {
    double middle = (low + high) / 2;
    if (exponent_at(kind, k, s, middle) > peak - 42)
      low = middle;
    else
      high = middle;
    if (high - low <= 0.25)
      return high;
  }
  return fmin(low + step, span);
}

double power_law_log_normalisation(enum power_law_kind kind, double k, double s, double span, double mean[2],
                                   double covariance[3]) {
  const double top = place_of_maximum(kind, k, s, span), top_h = factor(kind, top), peak = exponent_at(kind, k, s, top);
  double end = reach(kind, k, s, span);
  /* Panels are short compared with the scale of u (about 1/|k|, and 1 for e^u): the error of 16 points is then below
   * 1e-12 (tested). */
  double length = 2 / (1 + fabs(k) / 4);
  int panels = (int)fmin(fmax(ceil(end / length), 1), 400);
  length = end / panels;
  double sum[6] = {0};
  for (int p = 0; p < panels; p++) {
    for (int i = 0; i < 2 * HALF_NODES; i++) {
      int j = i / 2;
      double u = (p + 0.5 * (1 + (i % 2 ? node[j] : -node[j]))) * length, h = factor(kind, u);
      double f = node_weight[j] * exp(-k * u - s * h - peak);
      u -= top; /* deviations from the maximum, so that the covariances do not cancel */
      h -= top_h;
      sum[0] += f;
      sum[1] += f * u;
      sum[2] += f * h;
      sum[3] += f * u * u;
      sum[4] += f * u * h;
      sum[5] += f * h * h;
    }
  }
  if (mean) {
    const double off = sum[1] / sum[0], off_h = sum[2] / sum[0];
    mean[0] = top + off;
    mean[1] = top_h + off_h;
    if (covariance) {
      covariance[0] = sum[3] / sum[0] - off * off;
      covariance[1] = sum[4] / sum[0] - off * off_h;
      covariance[2] = sum[5] / sum[0] - off_h * off_h;
    }
  }
  return peak + log(sum[0] * length / 2);
}

struct power_law_group power_law_group_of(enum power_law_kind kind, size_t n, const double *masses, double lower,
                                          double upper) {
  struct power_law_group group = {.weight = (double)n, .span = isinf(upper) ? HUGE_VAL : log(upper / lower)};
  for (size_t i = 0; i < n; i++) {
    const double u = log(masses[i] / lower);
    group.mean += u;
    if (kind != POWER_LAW_PURE)
      group.mean_h += factor(kind, u);
  }
  group.mean /= group.weight;
  group.mean_h /= group.weight;
  return group;
}

/* The cost -ln L of all groups per fragment, with its slopes and curvatures in (k, s). */
struct cost {
  double value, slope_k, slope_s, kk, ks, ss;
};

static struct cost cost_at(enum power_law_kind kind, size_t count, const struct power_law_group *groups, double weight,
                           double k, double s) {
  struct cost cost = {0};
  double mean[2], covariance[3], log_z = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    log_z = power_law_log_normalisation(kind, k, s, groups[g].span, mean, covariance);
    double share = groups[g].weight / weight;
    cost.value += share * (k * groups[g].mean + s * groups[g].mean_h + log_z);
    cost.slope_k += share * (groups[g].mean - mean[0]);
    cost.slope_s += share * (groups[g].mean_h - mean[1]);
    cost.kk += share * covariance[0];
    cost.ks += share * covariance[1];
    cost.ss += share * covariance[2];
  }
  return cost;
}

/* Is s = 0 the maximum? The log-likelihood is concave, so s = 0 is the maximum when the likelihood falls from there
 * towards s > 0: when the samples' mean of h is at least that of the pure law. */
static bool pure_is_best(enum power_law_kind kind, size_t count, const struct power_law_group *groups, double k) {
  double excess = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    double mean[2] = {0, HUGE_VAL};
    if (!isinf(groups[g].span))
      power_law_log_normalisation(kind, k, 0, groups[g].span, mean, NULL);
    else if (kind == POWER_LAW_LOGNORMAL)
      mean[1] = 2 / (k * k);
    else if (k > 1)
      mean[1] = 1 / (k - 1);
    excess += groups[g].weight * (groups[g].mean_h - mean[1]);
  }
  return excess >= 0;
}

/* Newton's method on a convex cost from (*k, *s); halves steps that leave s > 0 or do not lower the cost. */
static struct cost minimise(enum power_law_kind kind, size_t count, const struct power_law_group *groups, double weight,
                            double *k, double *s) {
  struct cost here = cost_at(kind, count, groups, weight, *k, *s);
  for (int step = 0; step < 100; step++) {
    double determinant = here.kk * here.ss - here.ks * here.ks;
    if (!(determinant > 1e-14 * here.kk * here.ss))
      break;
    double dk = -(here.ss * here.slope_k - here.ks * here.slope_s) / determinant;
    double ds = -(here.kk * here.slope_s - here.ks * here.slope_k) / determinant;
    double decrement = -(here.slope_k * dk + here.slope_s * ds); /* twice the possible gain per fragment */
    if (!(decrement > 0))
      break;

    double length = *s + ds > 0 ? 1 : -0.9 * *s / ds;
    struct cost next = here;
    for (; length > 1e-9; length /= 2) {
      next = cost_at(kind, count, groups, weight, *k + length * dk, *s + length * ds);
      if (next.value < here.value + 1e-15 * fabs(here.value))
        break;
    }
    if (!(length > 1e-9))
      break;
    *k += length * dk;
    *s += length * ds;
    here = next;
    if (decrement < 1e-13)
      break; /* the next step would move beta by some 1e-7 of its standard error */
  }
  return here;
}

struct power_law_rival power_law_rival_fit(enum power_law_kind kind, size_t count,
                                           const struct power_law_group *groups) {
  const struct power_law_rival none = {NAN, NAN, NAN, NAN};
  double weight = 0, mean_h = 0;
  for (size_t g = 0; g < count; g++)
    if (groups[g].weight > 0) {
      weight += groups[g].weight;
      mean_h += groups[g].weight * groups[g].mean_h;
    }
  mean_h /= weight;
  const struct power_law pure = power_law_fit(count, groups);
  if (!isfinite(pure.beta) || !isfinite(mean_h))
    return none;
  double k = pure.beta - 1, s = 0.1 / mean_h;
  if (pure_is_best(kind, count, groups, k))
    return (struct power_law_rival){pure.beta, pure.standard_error, 0, pure.log_likelihood};

  struct cost here = minimise(kind, count, groups, weight, &k, &s);
  double determinant = here.kk * here.ss - here.ks * here.ks;
  if (!(determinant > 0))
    return none;
  return (struct power_law_rival){.beta = k + 1,
                                  .standard_error = sqrt(here.ss / determinant / weight),
                                  .rate = s,
                                  .log_likelihood = -here.value * weight};
}

double power_law_rival_ratio(const struct power_law_rival *fit, double pure_log_likelihood) {
  const double ratio = 2 * (fit->log_likelihood - pure_log_likelihood);
  return ratio < 0 ? 0 : ratio; /* NaN: no fit */
}

double power_law_rival_p_value(double ratio) {
  return ratio <= 0 ? 1 : 0.5 * erfc(sqrt(ratio / 2)); /* P(chi2_1 > x) = erfc(sqrt(x/2)) */
}
