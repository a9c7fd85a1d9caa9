#include "analysis/statistics/sample.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "engine/random.h"

int sample_ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int sample_descending(const void *a, const void *b) {
  return sample_ascending(b, a);
}

/* Two-sided Student t: the half width of a mean's interval is this times its standard error. NaN for n < 2. */
static double student(size_t n, double level) {
  if (n < 2 || !(level > 0 && level < 1))
    return NAN;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, (double)(n - 1));
}

struct sample_summary sample_summarise(size_t n, const double *values, double level) {
  struct sample_summary summary = {0, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  double sum = 0;
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    summary.n++;
    sum += values[i];
  }
  if (summary.n == 0)
    return summary;
  double number = (double)summary.n, squares = 0, rest = 0;
  summary.mean = sum / number;
  summary.minimum = HUGE_VAL;
  summary.maximum = -HUGE_VAL;
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    double deviation = values[i] - summary.mean;
    squares += deviation * deviation;
    rest += deviation; /* the rounding of the mean, corrected below (Chan, Golub & LeVeque 1983) */
    summary.minimum = fmin(summary.minimum, values[i]);
    summary.maximum = fmax(summary.maximum, values[i]);
  }
  double *sorted = malloc(summary.n * sizeof *sorted);
  if (sorted) {
    size_t m = 0;
    for (size_t i = 0; i < n; i++)
      if (!isnan(values[i]))
        sorted[m++] = values[i];
    qsort(sorted, m, sizeof *sorted, sample_ascending);
    summary.median = m % 2 ? sorted[m / 2] : sorted[m / 2 - 1] / 2 + sorted[m / 2] / 2;
    free(sorted);
  }
  if (summary.n < 2)
    return summary;
  summary.standard_deviation = sqrt(fmax(squares - rest * rest / number, 0) / (number - 1));
  summary.standard_error = summary.standard_deviation / sqrt(number);
  summary.half_width = student(summary.n, level) * summary.standard_error;
  return summary;
}

/* Percentile by linear interpolation between order statistics. */
static double percentile(size_t n, const double *sorted, double share) {
  double place = share * (double)(n - 1), whole = floor(place);
  size_t i = (size_t)whole;
  return i + 1 < n ? sorted[i] + (place - whole) * (sorted[i + 1] - sorted[i]) : sorted[n - 1];
}

struct sample_interval sample_bootstrap(size_t runs, size_t resamples, uint64_t seed, double level,
                                        sample_statistic statistic, void *context) {
  struct sample_interval interval = {NAN, NAN, NAN, NAN, 0};
  if (runs == 0 || runs > UINT32_MAX)
    return interval;
  uint32_t *drawn = malloc(runs * sizeof *drawn);
  double *values = malloc((resamples ? resamples : 1) * sizeof *values);
  if (!drawn || !values)
    goto cleanup;
  for (size_t i = 0; i < runs; i++)
    drawn[i] = (uint32_t)i;
  interval.estimate = statistic(runs, drawn, context);
  for (size_t b = 0; b < resamples; b++) {
    uint64_t bits[4];
    for (size_t i = 0; i < runs; i++) { /* four draws to a block of random bits */
      if (i % 4 == 0)
        random_bits(seed, RANDOM_RESAMPLE, b, i / 4, bits);
      drawn[i] = (uint32_t)(random_uniform(bits[i % 4]) * (double)runs);
    }
    double value = statistic(runs, drawn, context);
    if (isfinite(value))
      values[interval.resamples++] = value;
  }
  if (interval.resamples < 2 || interval.resamples < resamples / 2)
    goto cleanup;
  interval.standard_error = sample_summarise(interval.resamples, values, level).standard_deviation;
  qsort(values, interval.resamples, sizeof *values, sample_ascending);
  interval.lower = percentile(interval.resamples, values, 0.5 - level / 2);
  interval.upper = percentile(interval.resamples, values, 0.5 + level / 2);
cleanup:
  free(drawn);
  free(values);
  return interval;
}

/* t^2 (s^2 + (20 d)^2/n) / n <= d^2 */
static bool narrow(double n, double squares, double half_width, double level) {
  if (!(n >= 2) || !(half_width > 0))
    return false;
  double t = student((size_t)n, level), guard = SAMPLE_GUARD * half_width;
  double variance = squares / (n - 1) + guard * guard / n;
  return t * t * variance <= half_width * half_width * n;
}

bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0) {
  if (n < n0)
    return false;
  struct sample_summary summary = sample_summarise(n, values, level);
  double number = (double)summary.n;
  if (summary.n < n0)
    return false; /* failed runs do not count */
  return narrow(number, summary.standard_deviation * summary.standard_deviation * (number - 1), half_width, level);
}

size_t sample_stopping_prefix(size_t n, const double *values, double half_width, double level, size_t n0) {
  double number = 0, mean = 0, squares = 0; /* Welford's running moments: one pass whatever the number of batches */
  for (size_t r = 0; r < n; r++) {
    if (!isnan(values[r])) {
      number++;
      double delta = values[r] - mean;
      mean += delta / number;
      squares += delta * (values[r] - mean);
    }
    size_t length = r + 1;
    if (length < n0 || (length - n0) % SAMPLE_BATCH != 0 || number < (double)n0)
      continue;
    if (narrow(number, squares, half_width, level))
      return length;
  }
  return 0;
}
