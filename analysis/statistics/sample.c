/* Means, scatters, intervals, the jackknife and the stopping rule. */
#include "analysis/statistics/sample.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

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

/* The interval of what leaving out one group after another has given: theta[g] is the statistic without group g, which
 * has size[g] of the `runs` runs (Busing, Meijer & van der Leeden 1999, equations 4 to 6). */
static void interval_of_groups(size_t runs, size_t groups, const double *theta, const double *size, double level,
                               struct sample_interval *interval) {
  double centre = 0, variance = 0;
  for (size_t g = 0; g < groups; g++) {
    const double share = size[g] / (double)runs;
    centre += interval->estimate - (1 - share) * theta[g];
  }
  for (size_t g = 0; g < groups; g++) {
    const double h = (double)runs / size[g];
    const double deviation = h * interval->estimate - (h - 1) * theta[g] - centre;
    variance += deviation * deviation / (h - 1) / (double)groups;
  }
  interval->standard_error = sqrt(variance);
  interval->half_width = sample_student(groups, level) * interval->standard_error;
}

struct sample_interval sample_jackknife(size_t runs, double level, sample_statistic statistic, void *context) {
  struct sample_interval interval = {NAN, NAN, NAN};
  if (runs == 0 || runs > UINT32_MAX)
    return interval;
  const size_t each = (runs + SAMPLE_GROUPS - 1) / SAMPLE_GROUPS, groups = (runs + each - 1) / each;
  double theta[SAMPLE_GROUPS], size[SAMPLE_GROUPS];
  uint32_t *kept = malloc(runs * sizeof *kept);
  if (!kept)
    return interval;

  for (size_t i = 0; i < runs; i++)
    kept[i] = (uint32_t)i;
  interval.estimate = statistic(runs, kept, context);
  bool known = groups > 1 && isfinite(interval.estimate);
  for (size_t g = 0; g < groups && known; g++) {
    size_t count = 0;
    for (size_t i = 0; i < runs; i++)
      if (i / each != g)
        kept[count++] = (uint32_t)i;
    theta[g] = statistic(count, kept, context);
    size[g] = (double)(runs - count);
    known = isfinite(theta[g]);
  }
  free(kept);
  if (known)
    interval_of_groups(runs, groups, theta, size, level, &interval);
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
