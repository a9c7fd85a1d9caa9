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
  if (summary.n < 2 || isnan(moments->squares)) /* NaN: a value is infinite */
    return summary;
  double n = (double)summary.n;
  summary.standard_deviation = sqrt(fmax(moments->squares, 0) / (n - 1));
  summary.standard_error = summary.standard_deviation / sqrt(n);
  summary.half_width = sample_student(summary.n, level) * summary.standard_error;
  return summary;
}

/* Computes the mean first, then the deviations from it. */
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
    rest += deviation; /* zero except for the rounding of the mean */
  }
  moments.squares -= rest * rest / number; /* corrects that rounding (Chan, Golub & LeVeque 1983) */
  return moments;
}

struct sample_summary sample_summarise(size_t n, const double *values, double level) {
  const struct sample_moments moments = moments_in_two_passes(n, values);
  return sample_summarise_moments(&moments, level);
}

size_t sample_groups(size_t runs, size_t *each) {
  *each = runs ? (runs + SAMPLE_GROUPS - 1) / SAMPLE_GROUPS : 1;
  return (runs + *each - 1) / *each;
}

/* Busing, Meijer & van der Leeden 1999, equations 4 to 6. */
struct sample_interval sample_jackknife_of(size_t runs, double level, double estimate, const double *theta) {
  struct sample_interval interval = {estimate, NAN, NAN};
  size_t each;
  const size_t groups = sample_groups(runs, &each);
  bool known = groups > 1 && isfinite(estimate);
  for (size_t g = 0; g < groups && known; g++)
    known = isfinite(theta[g]);
  if (!known)
    return interval;

  double size[SAMPLE_GROUPS], centre = 0, variance = 0;
  for (size_t g = 0; g < groups; g++) {
    size[g] = (double)(g + 1 < groups ? each : runs - g * each);
    centre += estimate - (1 - size[g] / (double)runs) * theta[g];
  }
  for (size_t g = 0; g < groups; g++) {
    const double h = (double)runs / size[g];
    const double deviation = h * estimate - (h - 1) * theta[g] - centre;
    variance += deviation * deviation / (h - 1) / (double)groups;
  }
  interval.standard_error = sqrt(variance);
  interval.half_width = sample_student(groups, level) * interval.standard_error;
  return interval;
}

struct sample_interval sample_jackknife(size_t runs, double level, sample_statistic statistic, void *context) {
  const struct sample_interval none = {NAN, NAN, NAN};
  double theta[SAMPLE_GROUPS];
  size_t each;
  const size_t groups = sample_groups(runs, &each);
  uint32_t *kept = runs > 0 && runs <= UINT32_MAX ? malloc(runs * sizeof *kept) : NULL;
  if (!kept)
    return none;

  for (size_t i = 0; i < runs; i++)
    kept[i] = (uint32_t)i;
  const double estimate = statistic(runs, kept, context);
  for (size_t g = 0; g < groups && groups > 1 && isfinite(estimate); g++) {
    size_t count = 0;
    for (size_t i = 0; i < runs; i++)
      if (i / each != g)
        kept[count++] = (uint32_t)i;
    theta[g] = statistic(count, kept, context);
    if (!isfinite(theta[g])) {
      free(kept);
      return (struct sample_interval){estimate, NAN, NAN};
    }
  }
  free(kept);
  return sample_jackknife_of(runs, level, estimate, theta);
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
