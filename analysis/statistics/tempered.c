/* The rivals of the pure power law, fitted by Newton's method on quadrature. */
#include "analysis/statistics/tempered.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/power_law.h"

/* 16-point Gauss-Legendre on [-1, 1], positive half (Abramowitz & Stegun table 25.4). */
enum { HALF_NODES = 8 };
static const double node[HALF_NODES] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                        0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                                        0.9445750230732325761, 0.9894009349916499326};
static const double node_weight[HALF_NODES] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                                               0.1495959888165767321, 0.1246289712555338720, 0.0951585116824927848,
                                               0.0622535239386478929, 0.0271524594117540949};

static double factor(enum tempered_kind kind, double u) {
  return kind == TEMPERED_CUTOFF ? expm1(u) : u * u;
}

static double exponent_at(enum tempered_kind kind, double k, double s, double u) {
  return s > 0 ? -k * u - s * factor(kind, u) : -k * u;
}

/* Where the exponent is largest on [0, span): at 0, at the end, or where its derivative -k - s h'(u) vanishes. */
static double place_of_maximum(enum tempered_kind kind, double k, double s, double span) {
  double top = 0;
  if (k < 0) {
    if (s > 0)
      top = kind == TEMPERED_CUTOFF ? log(fmax(-k / s, 1)) : -k / (2 * s);
    else
      top = span;
  }
  return fmin(top, span);
}

/* The u beyond which the integrand is below e^-42 of its maximum and falls at least exponentially: the rest is below a
 * double's precision. */
static double reach(enum tempered_kind kind, double k, double s, double span) {
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

double tempered_log_normalisation(enum tempered_kind kind, double k, double s, double span, double mean[2],
                                  double covariance[3]) {
  double end = reach(kind, k, s, span), peak = exponent_at(kind, k, s, place_of_maximum(kind, k, s, span));
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
      sum[0] += f;
      sum[1] += f * u;
      sum[2] += f * h;
      sum[3] += f * u * u;
      sum[4] += f * u * h;
      sum[5] += f * h * h;
    }
  }
  if (mean) {
    mean[0] = sum[1] / sum[0];
    mean[1] = sum[2] / sum[0];
    if (covariance) {
      covariance[0] = sum[3] / sum[0] - mean[0] * mean[0];
      covariance[1] = sum[4] / sum[0] - mean[0] * mean[1];
      covariance[2] = sum[5] / sum[0] - mean[1] * mean[1];
    }
  }
  return peak + log(sum[0] * length / 2);
}

struct tempered_group tempered_group(enum tempered_kind kind, size_t n, const double *u, double span) {
  struct tempered_group group = {.weight = (double)n, .span = span};
  for (size_t i = 0; i < n; i++) {
    group.mean_u += u[i];
    group.mean_h += factor(kind, u[i]);
  }
  group.mean_u /= group.weight;
  group.mean_h /= group.weight;
  return group;
}

/* The cost -ln L of all groups per fragment, with its slopes and curvatures in (k, s). */
struct cost {
  double value, slope_k, slope_s, kk, ks, ss;
};

static struct cost cost_at(enum tempered_kind kind, size_t count, const struct tempered_group *groups, double weight,
                           double k, double s) {
  struct cost cost = {0};
  double mean[2], covariance[3], log_z = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    log_z = tempered_log_normalisation(kind, k, s, groups[g].span, mean, covariance);
    double share = groups[g].weight / weight;
    cost.value += share * (k * groups[g].mean_u + s * groups[g].mean_h + log_z);
    cost.slope_k += share * (groups[g].mean_u - mean[0]);
    cost.slope_s += share * (groups[g].mean_h - mean[1]);
    cost.kk += share * covariance[0];
    cost.ks += share * covariance[1];
    cost.ss += share * covariance[2];
  }
  return cost;
}

/* Is s = 0 the maximum? The log-likelihood is concave, so s = 0 is the maximum when the likelihood falls from there
 * towards s > 0: when the samples' mean of h is at least that of the pure law. */
static bool pure_is_best(enum tempered_kind kind, size_t count, const struct tempered_group *groups, double k) {
  double excess = 0;
  for (size_t g = 0; g < count; g++) {
    if (!(groups[g].weight > 0))
      continue;
    double mean[2] = {0, HUGE_VAL};
    if (!isinf(groups[g].span))
      tempered_log_normalisation(kind, k, 0, groups[g].span, mean, NULL);
    else if (kind == TEMPERED_LOGNORMAL)
      mean[1] = 2 / (k * k);
    else if (k > 1)
      mean[1] = 1 / (k - 1);
    excess += groups[g].weight * (groups[g].mean_h - mean[1]);
  }
  return excess >= 0;
}

/* The pure law fitted to the groups; NaN when memory ran out. *mean_h, *weight: mean of h and number of the fragments.
 */
static struct power_law fit_pure(size_t count, const struct tempered_group *groups, double *mean_h, double *weight) {
  struct power_law_group *plain = malloc((count ? count : 1) * sizeof *plain);
  *weight = *mean_h = 0;
  if (!plain)
    return (struct power_law){NAN, NAN, NAN};
  for (size_t g = 0; g < count; g++) {
    plain[g] = (struct power_law_group){groups[g].weight, groups[g].mean_u, groups[g].span};
    if (!(groups[g].weight > 0))
      continue;
    *weight += groups[g].weight;
    *mean_h += groups[g].weight * groups[g].mean_h;
  }
  struct power_law pure = power_law_fit(count, plain);
  free(plain);
  *mean_h /= *weight;
  return pure;
}

/* Newton's method on a convex cost from (*k, *s); halves steps that leave s > 0 or do not lower the cost. */
static struct cost minimise(enum tempered_kind kind, size_t count, const struct tempered_group *groups, double weight,
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

struct tempered tempered_fit(enum tempered_kind kind, size_t count, const struct tempered_group *groups) {
  const struct tempered none = {NAN, NAN, NAN, NAN};
  double weight, mean_h;
  struct power_law pure = fit_pure(count, groups, &mean_h, &weight);
  if (!isfinite(pure.beta) || !isfinite(mean_h))
    return none;
  double k = pure.beta - 1, s = 0.1 / mean_h;
  if (pure_is_best(kind, count, groups, k))
    return (struct tempered){pure.beta, pure.standard_error, 0, pure.log_likelihood};

  struct cost here = minimise(kind, count, groups, weight, &k, &s);
  double determinant = here.kk * here.ss - here.ks * here.ks;
  if (!(determinant > 0))
    return none;
  return (struct tempered){.beta = k + 1,
                           .standard_error = sqrt(here.ss / determinant / weight),
                           .rate = s,
                           .log_likelihood = -here.value * weight};
}

double tempered_ratio(const struct tempered *fit, double pure_log_likelihood) {
  return fmax(2 * (fit->log_likelihood - pure_log_likelihood), 0);
}

double tempered_p_value(double ratio) {
  return ratio > 0 ? 0.5 * erfc(sqrt(ratio / 2)) : 1; /* P(chi2_1 > x) = erfc(sqrt(x/2)) */
}
