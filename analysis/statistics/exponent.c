/* Exponents of one sample, by method. */
#include "analysis/statistics/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

FIELD_WORDS(exponent_method_names, EXPONENT_METHODS, [EXPONENT_LEAST_SQUARES] = "least_squares",
            [EXPONENT_MASSES] = "masses", [EXPONENT_UPPER_CUTOFF] = "cutoff");

struct exponent exponent_unknown(enum exponent_method method, struct exponent_window window) {
  return (struct exponent){.method = (int)method,
                           .lower = window.lower,
                           .upper = window.upper,
                           .beta = NAN,
                           .standard_error = NAN,
                           .cutoff_mass = NAN,
                           .ks_distance = NAN,
                           .log_likelihood = NAN};
}

struct exponent_window exponent_window_from(enum exponent_method method, double lower, double largest) {
  return (struct exponent_window){lower, method == EXPONENT_LEAST_SQUARES ? 10 * lower : largest};
}

void exponent_bins_inside(struct exponent_window window, int *first, int *end) {
  *first = spectrum_bin(window.lower);
  if (spectrum_edge(*first) < window.lower)
    (*first)++;
  *end = isinf(window.upper) ? INT32_MAX : spectrum_bin(window.upper);
}

enum { FINEST = 1000, PAIRS = 50 }; /* steps below lower / FINEST change no distance */

static bool is_multiple(double mass, double step, double lower) {
  return fabs(mass - step * round(mass / step)) < 1e-6 / FINEST * lower + 1e-9 * mass;
}

/* The greatest mass that both masses are multiples of (Euclid), or 0. */
static double common_divisor(double a, double b, double lower) {
  while (b > lower / FINEST) {
    if (is_multiple(a, b, lower))
      return b;
    const double rest = fmod(a, b);
    a = b;
    b = rest;
  }
  return 0;
}

double exponent_step(size_t n, const double *masses, size_t begin, size_t end, double lower) {
  double best = 0;
  for (size_t i = 0, pairs = 0; i + 1 < n && pairs < PAIRS; i++) {
    const double heavier = masses[i], lighter = masses[i + 1];
    if (is_multiple(heavier, lighter, lower) && heavier < 1.5 * lighter)
      continue; /* equal */
    pairs++;
    const double step = common_divisor(heavier, lighter, lower);
    size_t multiples = 0;
    for (size_t k = begin; step > best && k < end; k++)
      multiples += is_multiple(masses[k], step, lower);
    if (step > best && 5 * multiples >= 4 * (end - begin))
      best = step;
  }
  return best;
}

/* The part of a bin that counts, and log10 of its middle: the whole bin, or from half an element below its first whole
 * number of elements to half an element above its last one. False: it holds none; the whole bin, as other masses may be
 * in it. */
static bool bin_part(int bin, double element, double *low, double *high, double *middle) {
  const double rounding = 1 - 1e-9; /* of a step that is the rest of a division */
  *low = spectrum_edge(bin);
  *high = spectrum_edge(bin + 1);
  *middle = (bin + 0.5) / SPECTRUM_BINS_PER_DECADE;
  if (!(element > 0))
    return true;
  const double from = ceil(*low / element * rounding), to = ceil(*high / element * rounding);
  if (!(to > from))
    return false;
  *low = element * (from - 0.5);
  *high = element * (to - 0.5);
  *middle = 0.5 * (log10(*low) + log10(*high));
  return true;
}

bool exponent_bin_may_be_empty(int bin, double element) {
  double low, high, middle;
  return !bin_part(bin, element, &low, &high, &middle);
}

/* Kun & Herrmann (1999) section 3.3: a straight line through log10 of each bin's density (count over width) against
 * log10 of its middle. Every non-empty bin has the same weight. The standard error is that of a slope, from the scatter
 * of the bins about the line. */
static void least_squares(size_t n, const struct spectrum_bin_row *bins, double element, int first, int end,
                          struct exponent *out) {
  double points = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
  for (size_t i = 0; i < n; i++) {
    if (bins[i].bin < first || bins[i].bin >= end || bins[i].count <= 0)
      continue;
    double low, high, x;
    bin_part(bins[i].bin, element, &low, &high, &x);
    double y = log10((double)bins[i].count / (high - low));
    points++; /* Welford's update avoids cancellation */
    double dx = x - mean_x, dy = y - mean_y;
    mean_x += dx / points;
    mean_y += dy / points;
    xx += dx * (x - mean_x);
    xy += dx * (y - mean_y);
    yy += dy * (y - mean_y);
  }
  if (points < EXPONENT_LEAST_BINS)
    return;
  double slope = xy / xx;
  out->beta = -slope;
  out->standard_error = sqrt(fmax(yy - slope * xy, 0) / (points - 2) / xx);
}

static status check(enum exponent_method method, struct exponent_window window, struct exponent *out,
                    struct error *error) {
  *out = exponent_unknown(method, window);
  if (method < 0 || method >= EXPONENT_METHODS)
    return status_fail(error, STATUS_USAGE, "exponent: there is no method number %d", (int)method);
  if (!(window.lower > 0) || !isfinite(window.lower) || !(window.upper > window.lower))
    return status_fail(error, STATUS_USAGE, "exponent: window [%g, %g) kg: expected 0 < lower < upper", window.lower,
                       window.upper);
  return STATUS_OK;
}

status exponent_fit_bins(size_t n, const struct spectrum_bin_row *bins, double element, struct exponent_window window,
                         struct exponent *out, struct error *error) {
  TRY(check(EXPONENT_LEAST_SQUARES, window, out, error));
  int first, end;
  exponent_bins_inside(window, &first, &end);
  out->lower = spectrum_edge(first);
  if (end != INT32_MAX)
    out->upper = spectrum_edge(end);
  for (size_t i = 0; i < n; i++)
    if (bins[i].bin >= first && bins[i].bin < end)
      out->n += bins[i].count;
  least_squares(n, bins, element, first, end, out);
  return STATUS_OK;
}

/* masses: descending, in the window. */
static status fit_by_bins(size_t n, const double *masses, struct exponent_window window, struct exponent *out,
                          struct error *error) {
  const double element = exponent_step(n, masses, 0, n, window.lower);
  struct spectrum_bin_row few[256]; /* 256 bins are 25 decades: enough without an allocation */
  const size_t count = spectrum_fill(n, masses, few, 256);
  if (count <= 256)
    return exponent_fit_bins(count, few, element, window, out, error);
  OWNED struct spectrum_bin_row *rows = NULL;
  TRY(memory_array(&rows, count, sizeof *rows, "the bins of an exponent", error));
  spectrum_fill(n, masses, rows, count);
  return exponent_fit_bins(count, rows, element, window, out, error);
}

/* Copies the masses in the window to `inside`, descending; returns their number. */
static size_t select_sorted(size_t n, const double *masses, struct exponent_window window, double *inside) {
  size_t m = 0;
  bool sorted = true;
  for (size_t i = 0; i < n; i++) {
    if (!(masses[i] >= window.lower && masses[i] < window.upper) || isinf(masses[i]))
      continue;
    inside[m] = masses[i];
    sorted = sorted && !(m && inside[m] > inside[m - 1]);
    m++;
  }
  if (!sorted)
    qsort(inside, m, sizeof *inside, sample_descending);
  return m;
}

bool exponent_masses_differ(size_t n, const double *masses, size_t *count, double seen[EXPONENT_LEAST_FRAGMENTS]) {
  const double alike = 1e-6; /* share of a mass: rounding, far below the mass of a particle or grain */
  for (size_t i = 0; i < n && *count < EXPONENT_LEAST_FRAGMENTS; i++) {
    bool is_new = true;
    for (size_t k = 0; k < *count && is_new; k++)
      is_new = fabs(masses[i] - seen[k]) > alike * seen[k];
    if (is_new)
      seen[(*count)++] = masses[i];
  }
  return *count == EXPONENT_LEAST_FRAGMENTS;
}

/* Fits the pure power law on the window of *out; masses: descending. */
static void fit_pure(size_t n, const double *masses, double upper, struct exponent *out) {
  const struct power_law_group group = power_law_group_of(POWER_LAW_PURE, n, masses, out->lower, upper);
  const struct power_law fit = power_law_fit(1, &group);
  out->beta = fit.beta;
  out->standard_error = fit.standard_error;
  out->log_likelihood = fit.log_likelihood;
  if (!isfinite(fit.beta))
    return;
  double distance = 0;
  for (size_t i = 0; i < n; i++) { /* i fragments are heavier than masses[i] */
    double below = power_law_below(fit.beta, log(masses[i] / out->lower), group.span), number = (double)n;
    distance = fmax(distance, fmax(fabs((double)(n - i) / number - below), fabs((double)(n - 1 - i) / number - below)));
  }
  out->ks_distance = distance;
}

static void fit_with_cutoff(size_t n, const double *masses, double upper, struct exponent *out) {
  const struct power_law_group group = power_law_group_of(POWER_LAW_CUTOFF, n, masses, out->lower, upper);
  const struct power_law_rival fit = power_law_rival_fit(POWER_LAW_CUTOFF, 1, &group);
  if (!(fabs(fit.beta - 1) < POWER_LAW_STEEPEST))
    return;
  out->beta = fit.beta;
  out->standard_error = fit.standard_error;
  out->log_likelihood = fit.log_likelihood;
  out->cutoff_mass = fit.rate > 0 ? out->lower / fit.rate : HUGE_VAL;
}

status exponent_fit(enum exponent_method method, size_t n, const double *masses, struct exponent_window window,
                    struct exponent *out, struct error *error) {
  TRY(check(method, window, out, error));
  OWNED double *inside = NULL;
  TRY(memory_array(&inside, n, sizeof *inside, "the masses of an exponent", error));
  const size_t count = select_sorted(n, masses, window, inside);
  if (method == EXPONENT_LEAST_SQUARES)
    return fit_by_bins(count, inside, window, out, error);
  out->n = (int64_t)count;
  double seen[EXPONENT_LEAST_FRAGMENTS];
  size_t different = 0;
  if (!exponent_masses_differ(count, inside, &different, seen))
    return STATUS_OK;
  if (method == EXPONENT_MASSES)
    fit_pure(count, inside, window.upper, out);
  else
    fit_with_cutoff(count, inside, window.upper, out);
  return STATUS_OK;
}
