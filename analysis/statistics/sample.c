/* Means, scatters, intervals, the bootstrap and the stopping rule. */
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

double sample_student(size_t n, double level) {
  if (n < 2 || !(level > 0 && level < 1))
    return NAN;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, (double)(n - 1));
}

void sample_add(struct sample_moments *moments, double value) {
  if (isnan(value))
    return;
  double deviation = value - moments->mean;
  moments->n++;
  moments->mean += deviation / (double)moments->n;
  moments->squares += deviation * (value - moments->mean);
}

struct sample_summary sample_summarise_moments(const struct sample_moments *moments, double level) {
  struct sample_summary summary = {moments->n, NAN, NAN, NAN, NAN};
  if (summary.n > 0)
    summary.mean = moments->mean;
  if (summary.n < 2)
    return summary;
  double n = (double)summary.n;
  summary.standard_deviation = sqrt(fmax(moments->squares, 0) / (n - 1));
  summary.standard_error = summary.standard_deviation / sqrt(n);
  summary.half_width = sample_student(summary.n, level) * summary.standard_error;
  return summary;
}

/* Mean first, deviations from it second. */
static struct sample_moments moments_in_two_passes(size_t n, const double *values) {
  struct sample_moments moments = {0};
  double sum = 0, rest = 0;
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    moments.n++;
    sum += values[i];
  }
  if (moments.n == 0)
    return moments;

  double number = (double)moments.n;
  moments.mean = sum / number;
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    double deviation = values[i] - moments.mean;
    moments.squares += deviation * deviation;
    rest += deviation; /* zero but for the rounding of the mean */
  }
  moments.squares -= rest * rest / number; /* corrects that rounding (Chan, Golub & LeVeque 1983) */
  return moments;
}

struct sample_summary sample_summarise(size_t n, const double *values, double level) {
  const struct sample_moments moments = moments_in_two_passes(n, values);
  return sample_summarise_moments(&moments, level);
}

/* Percentile by linear interpolation between order statistics. */
static double percentile(size_t n, const double *sorted, double share) {
  double place = share * (double)(n - 1), whole = floor(place);
  size_t i = (size_t)whole;
  return i + 1 < n ? sorted[i] + (place - whole) * (sorted[i + 1] - sorted[i]) : sorted[n - 1];
}

/* Run indices of resample b, with replacement. One block of random bits gives four of them. */
static void draw_runs(size_t runs, uint64_t seed, uint64_t b, uint32_t *drawn) {
  uint64_t bits[4];
  for (size_t i = 0; i < runs; i++) {
    if (i % 4 == 0)
      random_bits(seed, RANDOM_RESAMPLE, b, i / 4, bits);
    drawn[i] = (uint32_t)(random_uniform(bits[i % 4]) * (double)runs);
  }
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
    draw_runs(runs, seed, b, drawn);
    double value = statistic(runs, drawn, context);
    if (isfinite(value))
      values[interval.resamples++] = value;
  }
  if (interval.resamples < 2 || interval.resamples < resamples / 2)
    goto cleanup;

  struct sample_moments moments = moments_in_two_passes(interval.resamples, values);
  interval.standard_error = sample_summarise_moments(&moments, level).standard_deviation;
  qsort(values, interval.resamples, sizeof *values, sample_ascending);
  interval.lower = percentile(interval.resamples, values, 0.5 - level / 2);
  interval.upper = percentile(interval.resamples, values, 0.5 + level / 2);
cleanup:
  free(drawn);
  free(values);
  return interval;
}

bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0) {
  if (n < n0 || !(half_width > 0))
    return false;
  struct sample_moments moments = moments_in_two_passes(n, values);
  if (moments.n < n0 || moments.n < 2)
    return false; /* failed runs do not count */

  /* t^2 (s^2 + (SAMPLE_GUARD half_width)^2 / n) / n <= half_width^2 */
  double number = (double)moments.n, t = sample_student(moments.n, level), guard = SAMPLE_GUARD * half_width;
  double deviation = sample_summarise_moments(&moments, level).standard_deviation;
  double variance = deviation * deviation + guard * guard / number;
  return t * t * variance <= half_width * half_width * number;
}
