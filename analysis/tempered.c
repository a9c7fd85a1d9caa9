#include "analysis/tempered.h"

#include <math.h>

#include "analysis/power_law.h"

/* 16-point Gauss-Legendre on [-1, 1], positive half (Abramowitz & Stegun table 25.4). */
enum { HALF_NODES = 8 };
static const double node[HALF_NODES] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                        0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                                        0.9445750230732325761, 0.9894009349916499326};
static const double node_weight[HALF_NODES] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382,
                                               0.1495959888165767321, 0.1246289712555338720, 0.0951585116824927848,
                                               0.0622535239386478929, 0.0271524594117540949};

static double factor(enum tempered_kind kind, double u) { return kind == TEMPERED_CUTOFF ? expm1(u) : u * u; }

static double exponent_at(enum tempered_kind kind, double k, double s, double u) {
  return s > 0 ? -k * u - s * factor(kind, u) : -k * u;
}

/* Where the exponent is largest on [0, span): at 0, at the end, or where its derivative -k - s h'(u) vanishes. */
static double place_of_maximum(enum tempered_kind kind, double k, double s, double span) {
  double top = 0;
  if (k < 0) {
    if (s > 0) top = kind == TEMPERED_CUTOFF ? log(fmax(-k / s, 1)) : -k / (2 * s);
    else top = span;
  }
  return fmin(top, span);
}

/* Beyond this u the integrand is below e^-42 of its maximum and falls at least exponentially: nothing left for a double. */
static double reach(enum tempered_kind kind, double k, double s, double span) {
  double top = place_of_maximum(kind, k, s, span);
  double low = top, peak = exponent_at(kind, k, s, top), step = 1;
  while (low + step < span && exponent_at(kind, k, s, low + step) > peak - 42) {
    low += step;
    step *= 2;
  }
  for (double high = fmin(low + step, span); high - low > 0.25;) {
    double middle = (low + high) / 2;
    if (exponent_at(kind, k, s, middle) > peak - 42) low = middle;
    else high = middle;
    if (high - low <= 0.25) return high;
  }
  return fmin(low + step, span);
}

double tempered_log_normalisation(enum tempered_kind kind, double k, double s, double span, double mean[2],
                                  double covariance[3]) {
  double end = reach(kind, k, s, span), peak = exponent_at(kind, k, s, place_of_maximum(kind, k, s, span));
  /* Panels short against the scale of u (about 1/|k|, and 1 for e^u): 16 points then leave less than 1e-12 (tested). */
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

double tempered_log_density(enum tempered_kind kind, double k, double s, double log_normalisation, double u) {
  return exponent_at(kind, k, s, u) - log_normalisation;
}

/* Is s = 0 the maximum? Concave: yes when the likelihood falls into s > 0 there, that is when the sample's mean of h is at
 * least the pure law's. */
static bool pure_is_best(enum tempered_kind kind, double k, double span, double mean_h) {
  if (isinf(span)) {
    if (!(k > 0)) return false;
    if (kind == TEMPERED_LOGNORMAL) return mean_h >= 2 / (k * k);
    return k > 1 && mean_h >= 1 / (k - 1);
  }
  double mean[2];
  tempered_log_normalisation(kind, k, 0, span, mean, NULL);
  return mean_h >= mean[1];
}

struct tempered tempered_fit(enum tempered_kind kind, size_t n, const double *u, double span) {
  struct tempered fit = {NAN, NAN, NAN, NAN, NAN};
  double mean_u = 0, mean_h = 0, number = (double)n;
  for (size_t i = 0; i < n; i++) {
    mean_u += u[i];
    mean_h += factor(kind, u[i]);
  }
  mean_u /= number;
  mean_h /= number;
  struct power_law pure = power_law_fit(1, &(struct power_law_group){number, mean_u, span}, 0);
  if (!isfinite(pure.beta) || !isfinite(mean_h)) return fit;
  double k = pure.beta - 1;
  if (pure_is_best(kind, k, span, mean_h))
    return (struct tempered){pure.beta, pure.standard_error, 0, NAN, pure.log_likelihood};

  /* Newton on cost(k, s) = k <u> + s <h> + ln Z(k, s), halving steps that leave s > 0 or do not lower the cost. */
  double s = 0.1 / (mean_h > 0 ? mean_h : 1), mean[2], c[3];
  double cost = k * mean_u + s * mean_h + tempered_log_normalisation(kind, k, s, span, mean, c);
  for (int step = 0; step < 100; step++) {
    double slope_k = mean_u - mean[0], slope_s = mean_h - mean[1], determinant = c[0] * c[2] - c[1] * c[1];
    if (!(determinant > 1e-14 * c[0] * c[2])) break;
    double dk = -(c[2] * slope_k - c[1] * slope_s) / determinant, ds = -(c[0] * slope_s - c[1] * slope_k) / determinant;
    double decrement = -(slope_k * dk + slope_s * ds); /* twice the gain to be had, in log-likelihood per fragment */
    if (!(decrement > 0)) break;
    double length = 1, next_cost = NAN, next_mean[2], next_c[3];
    if (s + ds <= 0) length = -0.9 * s / ds;
    for (; length > 1e-9; length /= 2) {
      next_cost = k * mean_u + length * dk * mean_u + (s + length * ds) * mean_h +
                  tempered_log_normalisation(kind, k + length * dk, s + length * ds, span, next_mean, next_c);
      if (next_cost < cost + 1e-15 * fabs(cost)) break;
    }
    if (!(length > 1e-9)) break;
    k += length * dk;
    s += length * ds;
    cost = next_cost;
    for (int i = 0; i < 2; i++) mean[i] = next_mean[i];
    for (int i = 0; i < 3; i++) c[i] = next_c[i];
    if (decrement < 1e-13) break; /* the next step would move beta by some 1e-7 of its standard error */
  }
  double determinant = c[0] * c[2] - c[1] * c[1];
  if (!(determinant > 0)) return fit;
  return (struct tempered){.beta = k + 1,
                           .standard_error = sqrt(c[2] / determinant / number),
                           .rate = s,
                           .rate_error = sqrt(c[0] / determinant / number),
                           .log_likelihood = -cost * number};
}
