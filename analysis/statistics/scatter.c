/* Moments, quantiles, modes and a histogram of a sample. */
#include "analysis/statistics/scatter.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/dip.h"

const double scatter_shares[SCATTER_QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};

static double third_moment(size_t n, const uint32_t *chosen, void *context) {
  const double *values = context;
  double mean = 0, two = 0, three = 0;
  for (size_t i = 0; i < n; i++)
    mean += values[chosen[i]] / (double)n;
  for (size_t i = 0; i < n; i++) {
    const double d = values[chosen[i]] - mean;
    two += d * d / (double)n;
    three += d * d * d / (double)n;
  }
  return n > 2 && two > 0 ? three / pow(two, 1.5) : (double)NAN;
}

static double deviation(size_t n, const uint32_t *chosen, void *context) {
  const double *values = context;
  struct sample_moments moments = {0};
  for (size_t i = 0; i < n; i++)
    sample_add(&moments, values[chosen[i]]);
  return n > 1 ? sqrt(moments.squares / (double)(n - 1)) : (double)NAN;
}

/* The interval is from the low-th to the high-th value, counted from 1. The probability that at most low - 1 values are
 * below the quantile is at most 0.025, and likewise above. */
static struct scatter_quantile quantile(size_t n, const double *sorted, double share) {
  struct scatter_quantile q = {NAN, NAN, NAN};
  if (n == 0)
    return q;
  const double place = share * (double)(n - 1);
  const size_t below = (size_t)place;
  q.value = sorted[below];
  if (below + 1 < n)
    q.value += (place - (double)below) * (sorted[below + 1] - sorted[below]);
  size_t low = 0, high = n;
  if (n > 1000000)
    return q;
  while (low < n && gsl_cdf_binomial_P((unsigned)low, share, (unsigned)n) <= 0.025)
    low++;
  while (high > 0 && gsl_cdf_binomial_Q((unsigned)(high - 1), share, (unsigned)n) <= 0.025)
    high--;
  if (low > 0)
    q.low = sorted[low - 1];
  if (high < n)
    q.high = sorted[high];
  return q;
}

/* In a bell-shaped sample of whole numbers, the largest step contains a share of 0.4 / deviation of the values, which
 * adds half of that to the dip. Chance alone reaches 0.47 / sqrt(n). The bound leaves a factor of five between both. */
bool scatter_in_steps(size_t n, const double *sorted) {
  struct sample_moments moments = {0};
  for (size_t i = 0; i < n; i++) {
    if (floor(sorted[i]) < sorted[i])
      return false;
    sample_add(&moments, sorted[i]);
  }
  return n > 1 && moments.squares / (double)(n - 1) < 4 * (double)n;
}

/* Splits the ascending values into two classes with the smallest sum of squares within them. */
void scatter_find_modes(struct scatter *s) {
  double sum = 0, whole = 0, best = -1;
  size_t lower = 0;
  for (size_t i = 0; i < s->n; i++)
    whole += s->sorted[i] - s->sorted[0]; /* relative to the smallest value: no cancellation */
  for (size_t i = 1; i < s->n; i++) {
    sum += s->sorted[i - 1] - s->sorted[0];
    const double a = sum / (double)i, b = (whole - sum) / (double)(s->n - i);
    const double between = (double)i * (double)(s->n - i) * (b - a) * (b - a);
    if (between <= best)
      continue;
    best = between;
    lower = i;
    s->lower_mode = s->sorted[0] + a;
    s->upper_mode = s->sorted[0] + b;
  }
  s->between = (s->sorted[lower - 1] + s->sorted[lower]) / 2;
  const double n = (double)s->n, p = (n - (double)lower) / n, z = gsl_cdf_ugaussian_Pinv(0.975);
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  s->upper_share = p;
  s->upper_low = centre - half;
  s->upper_high = centre + half;
}

status scatter_make(size_t n, const double *values, struct scatter *out, struct error *error) {
  *out = (struct scatter){.lower_mode = NAN,
                          .upper_mode = NAN,
                          .between = NAN,
                          .upper_share = NAN,
                          .upper_low = NAN,
                          .upper_high = NAN};
  out->sorted = malloc((n + 1) * sizeof *out->sorted);
  if (!out->sorted)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu values", n);
  for (size_t i = 0; i < n; i++)
    if (isfinite(values[i]))
      out->sorted[out->n++] = values[i];
  double *kept = out->sorted; /* in the order of the runs, because the jackknife leaves out consecutive runs */
  out->mean = sample_summarise(out->n, kept, 0.95);
  out->deviation = sample_jackknife(out->n, 0.95, deviation, kept);
  out->skewness = sample_jackknife(out->n, 0.95, third_moment, kept);
  qsort(out->sorted, out->n, sizeof *out->sorted, sample_ascending);
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    out->quantile[q] = quantile(out->n, out->sorted, scatter_shares[q]);
  out->dip = dip_of(out->n, out->sorted);
  out->dip_share = scatter_in_steps(out->n, out->sorted) ? (double)NAN : dip_share(out->n, out->dip);
  if (out->dip_share < 0.05)
    scatter_find_modes(out);
  return STATUS_OK;
}

void scatter_release(struct scatter *scatter) {
  free(scatter->sorted);
  *scatter = (struct scatter){0};
}

size_t scatter_runs_needed(double standard_deviation, double half_width) {
  if (!(standard_deviation >= 0) || !(half_width > 0) || isinf(standard_deviation))
    return 0;
  const double most = 1e9, ratio = standard_deviation / half_width;
  if (!(ratio * ratio < most / 10))
    return 0;
  size_t low = 1, high = 2;
  while (sample_student(high, 0.95) * ratio > sqrt((double)high)) {
    low = high;
    high *= 2;
  }
  while (high - low > 1) { /* invariant: `low` runs are too few, `high` are enough */
    const size_t middle = low + (high - low) / 2;
    if (sample_student(middle, 0.95) * ratio > sqrt((double)middle))
      low = middle;
    else
      high = middle;
  }
  return high;
}

struct scatter_histogram scatter_histogram_of(const struct scatter *s) {
  struct scatter_histogram h = {0};
  if (s->n == 0)
    return h;
  const double least = s->sorted[0], range = s->sorted[s->n - 1] - least;
  double width = 2 * (s->quantile[3].value - s->quantile[1].value) / cbrt((double)s->n);
  if (!(width > range / (SCATTER_BINS - 2)))
    width = range / (SCATTER_BINS - 2);
  if (!(width > 0)) /* all values are equal */
    width = fabs(least) > 0 ? fabs(least) / 10 : 1;
  const double power = pow(10, floor(log10(width))), rest = width / power;
  h.width = power * (rest <= 1 ? 1 : rest <= 2 ? 2 : rest <= 5 ? 5 : 10);
  h.from = floor(least / h.width) * h.width;
  for (size_t i = 0; i < s->n; i++) {
    double bin = floor((s->sorted[i] - h.from) / h.width);
    bin = fmin(fmax(bin, 0), SCATTER_BINS - 1);
    h.count[(size_t)bin]++;
    if ((size_t)bin + 1 > h.bins)
      h.bins = (size_t)bin + 1;
  }
  return h;
}
