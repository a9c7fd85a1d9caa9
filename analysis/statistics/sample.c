/* Means, scatters, intervals, the jackknife, the stopping rule, and differences of means. */
#include "analysis/statistics/statistics.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

#include "schemas/memory.h"

int sample_ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int sample_descending(const void *a, const void *b) {
  return sample_ascending(b, a);
}

double sample_student(size_t n, double level) {
  return sample_student_of((double)n - 1, level);
}

double sample_student_of(double freedom, double level) {
  if (!(freedom > 0 && level > 0 && level < 1))
    return NAN;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, freedom);
}

double sample_scale(double largest) {
  const double size = fabs(largest);
  int power;
  if (!(size > 0) || isinf(size) || (size > 1e-60 && size < 1e60))
    return 1;
  (void)frexp(size, &power);
  return power > -1000 ? ldexp(1, -power) : 0x1p1000;
}

status sample_squares_fit(size_t n, const double *values, struct error *error) {
  double largest = 0;
  for (size_t i = 0; i < n; i++)
    largest = fmax(largest, fabs(values[i]));
  if (largest > 0 && fabs(sample_scale(largest) - 1) > 0)
    return status_fail(error, STATUS_USAGE,
                       "values of %.3g have a variance that no double-precision number holds: take a unit in which "
                       "they are between 1e-60 and 1e60",
                       largest);
  return STATUS_OK;
}

status sample_about_mean(size_t n, const double *values, double **about, struct error *error) {
  double mean = 0;
  TRY(sample_squares_fit(n, values, error));
  TRY(memory_array(about, n, sizeof **about, "the parts of a variance", error));
  for (size_t i = 0; i < n; i++)
    mean += values[i] / (double)n;
  for (size_t i = 0; i < n; i++)
    (*about)[i] = values[i] - mean;
  return STATUS_OK;
}

void sample_add(struct sample_moments *moments, double value) {
  if (isnan(value))
    return;
  const double scale = sample_scale(value);
  if (moments->n == 0 || !(fabs(moments->mean) > 0 || moments->squares > 0)) /* zeros fit every scale */
    moments->scale = scale;
  if (scale < moments->scale) {
    moments->squares *= scale / moments->scale * (scale / moments->scale);
    moments->scale = scale;
  }
  const double scaled = value * moments->scale, deviation = scaled - moments->mean * moments->scale;
  moments->n++;
  moments->mean += deviation / (double)moments->n / moments->scale;
  moments->squares += deviation * (scaled - moments->mean * moments->scale);
}

struct sample_summary sample_summarise_moments(const struct sample_moments *moments, double level) {
  struct sample_summary summary = {moments->n, NAN, NAN, NAN, NAN, NAN, NAN, false};
  if (summary.n > 0)
    summary.mean = moments->mean;
  if (summary.n < 2 || isnan(moments->squares)) /* NaN: a value is infinite */
    return summary;
  double n = (double)summary.n;
  summary.standard_deviation = sqrt(fmax(moments->squares, 0) / (n - 1)) / moments->scale;
  summary.standard_error = summary.standard_deviation / sqrt(n);
  if (!(summary.standard_deviation > SAMPLE_ROUNDING * fabs(summary.mean)))
    return summary;
  summary.half_width = sample_student(summary.n, level) * summary.standard_error;
  summary.low = summary.mean - summary.half_width;
  summary.high = summary.mean + summary.half_width;
  return summary;
}

/* db/store/views.c has the same rule in SQL, analysis/report/statistics.js in JavaScript. */
void sample_of_share(struct sample_summary *summary, double level) {
  const double n = (double)summary->n, mean = summary->mean, deviation = summary->standard_deviation;
  if (summary->n < 2 || isnan(deviation))
    return;
  if (isnan(summary->half_width)) {
    const double seen = pow(1 - level, 1 / n);
    summary->low = mean * seen;
    summary->high = 1 - (1 - mean) * seen;
    return;
  }
  const double near = fmin(mean, 1 - mean), far = fmax(mean, 1 - mean);
  const double skew = fmin(sqrt(n), deviation / fmax(near, 1e-300)) * fmin(1, sqrt(SAMPLE_SKEW_RUNS / n));
  summary->half_width *= 1 + SAMPLE_SKEW * skew;
  summary->low = fmax(mean - summary->half_width, 0);
  summary->high = fmin(mean + summary->half_width, 1);
  summary->weak = (summary->n < SAMPLE_NARROW_RUNS && deviation < SAMPLE_NARROW * far) ||
                  (summary->n < SAMPLE_EDGE_RUNS && deviation < SAMPLE_EDGE * far &&
                   deviation > SAMPLE_EDGE_SKEW * near);
}

static int by_seed(const void *a, const void *b) {
  const struct sample_of_seed *x = a, *y = b;
  if (x->seed != y->seed)
    return x->seed > y->seed ? 1 : -1;
  return sample_ascending(&x->value, &y->value); /* one order of sums, whatever the sort does */
}

bool sample_crossed(size_t points, const size_t *first, const struct sample_of_seed *values,
                    struct sample_crossed *out) {
  struct sample_moments means = {.n = 0};
  OWNED struct sample_of_seed *parts = malloc((first[points] + 1) * sizeof *parts);
  size_t n = 0;
  *out = (struct sample_crossed){NAN, NAN};
  if (!parts)
    return false;
  for (size_t p = 0; p < points; p++) {
    const double runs = (double)(first[p + 1] - first[p]);
    double mean = 0;
    for (size_t i = first[p]; i < first[p + 1]; i++)
      mean += values[i].value;
    mean /= runs;
    sample_add(&means, mean);
    for (size_t i = first[p]; runs > 1 && i < first[p + 1]; i++)
      parts[n++] = (struct sample_of_seed){values[i].seed, (values[i].value - mean) / sqrt(runs * (runs - 1))};
  }
  const struct sample_summary summary = sample_summarise_moments(&means, 0.95);
  const double count = (double)points, deviation = summary.standard_deviation;
  if (points < 2 || isnan(deviation))
    return true;
  double largest = 0, together = 0, pairs = 0, seeds = 0;
  for (size_t i = 0; i < n; i++)
    largest = fmax(largest, fabs(parts[i].value));
  qsort(parts, n, sizeof *parts, by_seed);
  for (size_t i = 0, next; i < n && largest > 0; i = next) {
    double sum = 0, squares = 0;
    for (next = i; next < n && parts[next].seed == parts[i].seed; next++) {
      sum += parts[next].value / largest;
      squares += parts[next].value / largest * (parts[next].value / largest);
    }
    together += sum * sum;
    pairs += next > i + 1 ? sum * sum - squares : 0;
    seeds += next > i + 1;
  }
  *out = (struct sample_crossed){count, deviation};
  if (!(pairs > SAMPLE_ROUNDING * together))
    return true;
  const double of_points = deviation / largest * (deviation / largest) / count, of_seeds = together / (count * count);
  const double variance = of_points + pairs / (count * (count - 1));
  const double freedom = variance * variance /
                         (of_points * of_points / (count - 1) + of_seeds * of_seeds / fmax(1, seeds - 1));
  *out = (struct sample_crossed){freedom + 1, largest * sqrt(variance * (freedom + 1))};
  return true;
}

status sample_crossed_half_width(size_t points, const size_t *first, const uint64_t *seed, const double *values,
                                 double *half_width, struct error *error) {
  static const char what[] = "the interval of a mean over points";
  OWNED struct sample_of_seed *of_seeds = NULL;
  struct sample_crossed crossed;
  double largest = 0;
  TRY(memory_array(&of_seeds, first[points], sizeof *of_seeds, what, error));
  for (size_t i = 0; i < first[points]; i++) {
    of_seeds[i] = (struct sample_of_seed){(int64_t)seed[i], values[i]};
    largest = fmax(largest, fabs(values[i]));
  }
  if (!sample_crossed(points, first, of_seeds, &crossed))
    return status_fail(error, STATUS_MEMORY, "no memory for %s", what);
  const bool differ = crossed.deviation > SAMPLE_ROUNDING * largest;
  *half_width = differ ? sample_student_of(crossed.units - 1, 0.95) * crossed.deviation / sqrt(crossed.units)
                       : (double)NAN;
  return STATUS_OK;
}

double sample_deviation_factor(double freedom) {
  return sqrt(freedom / gsl_cdf_chisq_Pinv(0.05, freedom));
}

double sample_share_half_width(size_t n, double mean, double deviation, double level) {
  struct sample_summary of = {.n = n, .mean = mean, .standard_deviation = deviation, .half_width = NAN};
  if (!(n > 1 && deviation > SAMPLE_ROUNDING * fabs(mean)))
    return NAN;
  of.half_width = sample_student(n, level) * deviation / sqrt((double)n);
  sample_of_share(&of, level);
  return of.half_width;
}

struct sample_range sample_range(const struct field *row) {
  if (!row || !field_is_number(row))
    return (struct sample_range){-HUGE_VAL, HUGE_VAL, false};
  return (struct sample_range){row->minimum, row->maximum, field_is_share(row)};
}

void sample_in_range(struct sample_summary *summary, const struct sample_range *range, double level) {
  if (range->share) {
    sample_of_share(summary, level);
    return;
  }
  if (isnan(summary->half_width))
    return;
  summary->low = fmax(summary->low, range->least);
  summary->high = fmin(summary->high, range->most);
}

/* Computes the mean first, then the deviations from it. */
static struct sample_moments moments_in_two_passes(size_t n, const double *values) {
  struct sample_moments moments = {0};
  double largest = 0, sum = 0, rest = 0;
  for (size_t i = 0; i < n; i++)
    largest = fmax(largest, fabs(values[i])); /* leaves out NaN */
  const double scale = moments.scale = sample_scale(largest);
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    moments.n++;
    sum += values[i] * scale;
  }
  if (moments.n == 0)
    return moments;

  double number = (double)moments.n, mean = sum / number;
  moments.mean = mean / scale;
  for (size_t i = 0; i < n; i++) {
    if (isnan(values[i]))
      continue;
    double deviation = values[i] * scale - mean;
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
  if (interval.standard_error > SAMPLE_FIT_ROUNDING * fabs(estimate)) /* else the runs are equal */
    interval.half_width = sample_student(groups, level) * interval.standard_error;
  return interval;
}

struct sample_interval sample_jackknife(size_t runs, double level, sample_statistic statistic, void *context) {
  const struct sample_interval none = {NAN, NAN, NAN};
  double theta[SAMPLE_GROUPS];
  size_t each;
  const size_t groups = sample_groups(runs, &each);
  OWNED uint32_t *kept = runs > 0 && runs <= UINT32_MAX ? malloc(runs * sizeof *kept) : NULL;
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
    if (!isfinite(theta[g]))
      return (struct sample_interval){estimate, NAN, NAN};
  }
  return sample_jackknife_of(runs, level, estimate, theta);
}

/* share = (rest + alike)/(whole of the rest + alike), or the same without `alike` above: it has its ends where `alike`
 * has. The variance over seeds of the mean of all points contains 1/points of what differs between points. */
double sample_alike_half(const struct sample_alike *v, double share, bool of_seeds) {
  const double differs = (v->own - v->alike) / v->points, of_means = v->alike + differs;
  const double freedom = (double)v->seeds - 1;
  double half = 0;
  for (int end = 0; end < 2; end++) {
    const double law = gsl_cdf_chisq_Pinv(end ? 0.025 : 0.975, freedom) / freedom;
    const double change = fmax(of_means / law - differs, 0) - v->alike;
    half = fmax(half, fabs((share * v->whole + (of_seeds ? change : 0)) / (v->whole + change) - share));
  }
  return half;
}

bool sample_may_stop_with(size_t n, double deviation, double half_width, double level) {
  /* t^2 (s^2 + (SAMPLE_GUARD half_width)^2 / n) / n <= half_width^2 */
  double number = (double)n, t = sample_student(n, level), guard = SAMPLE_GUARD * half_width;
  double variance = deviation * deviation + guard * guard / number;
  return t * t * variance <= half_width * half_width * number;
}

double sample_rule_half_width(size_t n, double deviation, double half_width, double level) {
  const double number = (double)n, guard = SAMPLE_GUARD * half_width;
  return n < 2 ? (double)NAN
               : sample_student(n, level) * sqrt((deviation * deviation + guard * guard / number) / number);
}

bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0) {
  if (n < n0 || !(half_width > 0))
    return false;
  struct sample_moments moments = moments_in_two_passes(n, values);
  if (moments.n < n0 || moments.n < 2)
    return false; /* failed runs do not count */
  /* Scaled, so that no square leaves the range of double. */
  const double deviation = sample_summarise_moments(&moments, level).standard_deviation * moments.scale;
  return sample_may_stop_with(moments.n, deviation, half_width * moments.scale, level);
}

bool sample_could_stop(size_t n, double level) {
  return n >= 2 && SAMPLE_GUARD * sample_student(n, level) <= (double)n;
}

/* ---- Paired and independent differences of means. ---- */

/* Student's t with the degrees of freedom of Welch and Satterthwaite. */
static double welch(const struct sample_moments side[2], double level) {
  const double scale = fmin(side[0].scale, side[1].scale);
  double share[2], degrees = 0;
  for (int k = 0; k < 2; k++) {
    if (side[k].n < 2)
      return NAN;
    const double freedom = (double)side[k].n - 1, less = scale / side[k].scale;
    share[k] = side[k].squares * less * less / freedom / (double)side[k].n;
    degrees += share[k] * share[k] / freedom;
  }
  const double variance = share[0] + share[1];
  if (!(degrees > 0)) /* neither sample varies */
    return NAN;
  return gsl_cdf_tdist_Pinv(0.5 + level / 2, variance * variance / degrees) * sqrt(variance) / scale;
}

/* Moments of the differences of values with a seed that both sides have, in order of seeds. */
static struct sample_moments moments_of_pairs(size_t first_count, const struct difference_value *first,
                                              size_t second_count, const struct difference_value *second) {
  struct sample_moments differences = {0};
  for (size_t i = 0, j = 0; i < first_count && j < second_count;) {
    const int64_t a = first[i].seed, b = second[j].seed;
    if (a == b)
      sample_add(&differences, second[j].value - first[i].value);
    i += a <= b;
    j += b <= a;
  }
  return differences;
}

static struct sample_moments moments_of(size_t count, const struct difference_value *values) {
  struct sample_moments moments = {0};
  for (size_t i = 0; i < count; i++)
    sample_add(&moments, values[i].value);
  return moments;
}

struct difference sample_difference(size_t first_count, const struct difference_value *first, size_t second_count,
                                    const struct difference_value *second, double level) {
  const struct sample_moments pairs = moments_of_pairs(first_count, first, second_count, second);
  const struct sample_moments all[2] = {moments_of(first_count, first), moments_of(second_count, second)};
  const size_t most = first_count > second_count ? first_count : second_count;
  struct difference out = {
      .side = {sample_summarise_moments(&all[0], level), sample_summarise_moments(&all[1], level)}};
  if (pairs.n >= 2 && 2 * pairs.n >= most) {
    out.pairs = pairs.n;
    out.difference = pairs.mean;
    out.half_width = sample_summarise_moments(&pairs, level).half_width;
    return out;
  }
  out.difference = out.side[1].mean - out.side[0].mean;
  out.half_width = welch(all, level);
  return out;
}
