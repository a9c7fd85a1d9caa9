/* Exponents of a point from all its runs, with the jackknife over runs; pooled spectra; the test of a power law. */
#include "analysis/statistics/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/random.h"
#include "engine/threads.h"
#include "schemas/memory.h"

static const char for_runs[] = "the exponent of a point's runs"; /* there was no memory for it */

/* Data of every run for the fits. */
struct prepared {
  enum exponent_method method;
  size_t runs;
  struct power_law_group *groups; /* MASSES */
  struct exponent_window window;  /* LEAST_SQUARES: the same for all runs */
  int first_bin;                  /* LEAST_SQUARES: counts[run * bins + j] of bin first_bin + j */
  size_t bins;
  double element; /* LEAST_SQUARES: kg, masses of the windows are whole numbers of it; 0: they are not */
  int64_t *counts;
  struct spectrum_bin_row *total, *rows; /* bins of all runs; bins of the runs in one fit */
};

/* Index after the last fragment of run r whose mass is at least `lower`. */
static size_t window_end(const struct pooled_runs *runs, size_t r, double lower) {
  size_t low = runs->first[r], high = runs->first[r + 1];
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (runs->masses[middle] >= lower)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

double pooled_window(const struct pooled_runs *runs, size_t r, double lower, size_t *begin, size_t *end) {
  *begin = runs->first[r];
  *end = window_end(runs, r, lower);
  if (*begin == runs->first[r + 1])
    return NAN;
  double largest = runs->masses[*begin];
  while (*begin < *end && runs->masses[*begin] == largest)
    (*begin)++;
  return largest;
}

/* Do the windows of all runs but from .. to - 1 have five different masses? Fewer tell no exponent, however many
 * fragments there are. */
static bool differ(const struct pooled_runs *runs, double lower, size_t from, size_t to) {
  double seen[EXPONENT_LEAST_FRAGMENTS];
  size_t count = 0, begin, end;
  bool enough = false;
  for (size_t r = 0; r < runs->count && !enough; r++) {
    if (r >= from && r < to)
      continue;
    pooled_window(runs, r, lower, &begin, &end);
    enough = exponent_masses_differ(end - begin, runs->masses + begin, &count, seen);
  }
  return enough;
}

/* The statistics of a run in its window; weight 0: no fragment is in it. */
static struct power_law_group group_of(enum power_law_kind kind, const struct pooled_runs *runs, size_t r,
                                       double lower) {
  size_t begin, end;
  const double largest = pooled_window(runs, r, lower, &begin, &end);
  if (!(largest > lower) || begin >= end)
    return (struct power_law_group){0};
  return power_law_group_of(kind, end - begin, runs->masses + begin, lower, largest);
}

static status count_bins(struct prepared *p, const struct pooled_runs *runs, struct error *error) {
  int end;
  exponent_bins_inside(p->window, &p->first_bin, &end);
  p->bins = (size_t)(end - p->first_bin);
  TRY(memory_array(&p->counts, runs->count * p->bins, sizeof *p->counts, for_runs, error));
  TRY(memory_array(&p->total, p->bins, sizeof *p->total, for_runs, error));
  TRY(memory_array(&p->rows, p->bins, sizeof *p->rows, for_runs, error));
  const double lower = spectrum_edge(p->first_bin), upper = spectrum_edge(end);
  size_t most = 0; /* the run with most fragments shows the mass of a particle; it is nearly the same in all runs */
  for (size_t r = 0; r < runs->count; r++) {
    const size_t begin = window_end(runs, r, upper), stop = window_end(runs, r, lower);
    for (size_t i = begin; i < stop; i++)
      p->counts[r * p->bins + (size_t)(spectrum_bin(runs->masses[i]) - p->first_bin)]++;
    if (stop - begin > most) {
      most = stop - begin;
      p->element = exponent_step(most, runs->masses + begin, 0, most, lower);
    }
  }
  for (size_t j = 0; j < p->bins; j++) {
    p->total[j].bin = p->first_bin + (int)j;
    for (size_t r = 0; r < runs->count; r++)
      p->total[j].count += p->counts[r * p->bins + j];
  }
  return STATUS_OK;
}

static status prepare(struct prepared *p, const struct pooled_runs *runs, double lower, struct error *error) {
  if (p->method == EXPONENT_LEAST_SQUARES) {
    p->window = exponent_window_from(p->method, lower, NAN);
    return count_bins(p, runs, error);
  }
  TRY(memory_array(&p->groups, runs->count, sizeof *p->groups, for_runs, error));
  for (size_t r = 0; r < runs->count; r++)
    p->groups[r] = group_of(POWER_LAW_PURE, runs, r, lower);
  return STATUS_OK;
}

#define PREPARED __attribute__((cleanup(forget))) struct prepared
static void forget(struct prepared *p) {
  free(p->groups);
  free(p->counts);
  free(p->total);
  free(p->rows);
}

static double total_weight(size_t n, const struct power_law_group *groups) {
  double weight = 0;
  for (size_t i = 0; i < n; i++)
    weight += groups[i].weight;
  return weight;
}

/* Least squares without the runs begin to end - 1. A bin without a fragment has no logarithm. A line through the others
 * gives a beta up to 1 too low, and no interval over the runs shows it. So there is no fit until the runs fill every
 * bin. */
static void fit_bins(struct prepared *p, size_t begin, size_t end, struct exponent *fit) {
  bool filled = true;
  for (size_t j = 0; j < p->bins; j++) {
    p->rows[j] = p->total[j];
    for (size_t r = begin; r < end; r++)
      p->rows[j].count -= p->counts[r * p->bins + j];
    filled = filled && (p->rows[j].count > 0 || exponent_bin_may_be_empty(p->rows[j].bin, p->element));
  }
  exponent_fit_bins(p->bins, p->rows, p->element, p->window, fit, NULL);
  if (!filled)
    fit->beta = fit->standard_error = NAN;
}

static void fit_groups(const struct prepared *p, const struct pooled_runs *runs, double lower, struct exponent *fit) {
  const double weight = total_weight(p->runs, p->groups);
  fit->n = (int64_t)weight;
  if (weight < EXPONENT_LEAST_FRAGMENTS || !differ(runs, lower, 0, 0))
    return;
  const struct power_law plain = power_law_fit(p->runs, p->groups);
  fit->beta = plain.beta;
  fit->standard_error = plain.standard_error;
  fit->log_likelihood = plain.log_likelihood;
}

/* theta[g]: beta without the g-th group of `each` runs; there are `groups` of them. */
static status leave_out(struct prepared *p, const struct pooled_runs *runs, double lower, size_t groups, size_t each,
                        double *theta, struct error *error) {
  if (p->groups && !power_law_leave_out(p->runs, p->groups, each, theta))
    return status_fail(error, STATUS_MEMORY, "no memory for %s", for_runs);
  const double weight = total_weight(p->groups ? p->runs : 0, p->groups);
  for (size_t g = 0; g < groups; g++) {
    const size_t begin = g * each, end = g + 1 < groups ? begin + each : p->runs;
    if (p->groups) {
      if (weight - total_weight(end - begin, p->groups + begin) < EXPONENT_LEAST_FRAGMENTS ||
          !differ(runs, lower, begin, end))
        theta[g] = NAN;
      continue;
    }
    struct exponent fit = {0};
    fit_bins(p, begin, end, &fit);
    theta[g] = fit.beta;
  }
  return STATUS_OK;
}

static status check(const struct pooled_runs *runs, double lower, struct error *error) {
  if (!(lower > 0) || isinf(lower))
    return status_fail(error, STATUS_USAGE, "exponent: a window from %g kg: expected a positive mass", lower);
  if (runs->count > UINT32_MAX)
    return status_fail(error, STATUS_USAGE, "exponent: %zu runs are too many", runs->count);
  return STATUS_OK;
}

/* Counts runs with fragments in their window. *upper: the largest of these runs' largest fragments (0: none). */
static size_t count_runs(const struct prepared *p, const struct pooled_runs *runs, double lower, double *upper) {
  size_t count = 0;
  *upper = 0;
  for (size_t r = 0; r < runs->count; r++) {
    size_t begin, end;
    double largest = pooled_window(runs, r, lower, &begin, &end), inside = 0;
    for (size_t j = 0; j < p->bins; j++)
      inside += (double)p->counts[r * p->bins + j];
    if (p->groups)
      inside = p->groups[r].weight;
    if (inside > 0) {
      count++;
      *upper = fmax(*upper, largest);
    }
  }
  return count;
}

/* Checks the arguments, fits all runs, and then all runs except one group at a time: theta, if there is a beta. */
static status fit_all(struct prepared *p, const struct pooled_runs *runs, enum exponent_method method, double lower,
                      size_t groups, size_t each, struct exponent *fit, double *theta, struct error *error) {
  *p = (struct prepared){.method = method, .runs = runs->count};
  *fit = exponent_unknown(method, (struct exponent_window){lower, HUGE_VAL});
  if (method != EXPONENT_LEAST_SQUARES && method != EXPONENT_MASSES)
    return status_fail(error, STATUS_USAGE, "exponent: method number %d does not pool runs", (int)method);
  TRY(check(runs, lower, error));
  TRY(prepare(p, runs, lower, error));
  if (p->groups)
    fit_groups(p, runs, lower, fit);
  else
    fit_bins(p, 0, 0, fit);
  return isfinite(fit->beta) ? leave_out(p, runs, lower, groups, each, theta, error) : STATUS_OK;
}

status pooled_exponent(const struct pooled_runs *runs, enum exponent_method method, double lower, double level,
                       struct pooled_exponent *out, struct error *error) {
  PREPARED p = {0};
  double theta[SAMPLE_GROUPS], upper;
  size_t each;
  const size_t groups = sample_groups(runs->count, &each);
  *out = (struct pooled_exponent){.interval = {NAN, NAN, NAN}};
  TRY(fit_all(&p, runs, method, lower, groups, each, &out->fit, theta, error));
  out->runs = count_runs(&p, runs, lower, &upper);
  if (upper > 0 && method != EXPONENT_LEAST_SQUARES)
    out->fit.upper = upper;
  out->interval = sample_jackknife_of(runs->count, level, out->fit.beta, theta);
  return STATUS_OK;
}

const char *pooled_exponent_untold(const struct pooled_exponent *exponent) {
  _Static_assert(EXPONENT_LEAST_FRAGMENTS == 5, "as the reason says");
  const double half = exponent->interval.half_width;
  if (exponent->fit.n < EXPONENT_LEAST_FRAGMENTS)
    return "fewer than 5 fragments";
  if (!isfinite(exponent->fit.beta))
    return exponent->fit.method == EXPONENT_LEAST_SQUARES ? "a bin without a fragment"
                                                          : "fewer than 5 different masses";
  if (isfinite(half))
    return half / 2 < 1 ? NULL : "an interval of \xc2\xb1 2 or wider"; /* half: about two standard errors */
  return exponent->fit.standard_error < 1 ? NULL : "no interval and a standard error of 1 or more";
}

const char *pooled_exponent_no_interval(const struct pooled_exponent *exponent) {
  _Static_assert(EXPONENT_LEAST_FRAGMENTS == 5, "as the reason says");
  if (isfinite(exponent->interval.half_width))
    return NULL;
  if (isfinite(exponent->interval.standard_error))
    return "all runs are equal";
  return exponent->fit.method == EXPONENT_LEAST_SQUARES ? "without one of the runs a bin is empty"
                                                        : "without one of the runs there are fewer than 5 different "
                                                          "masses";
}

int pooled_exponent_decimals(const struct pooled_exponent *exponent) {
  return isfinite(exponent->interval.half_width) || !(exponent->fit.standard_error >= 0.1) ? 2 : 1;
}

void pooled_exponent_tell(const char *reason, char *text, size_t size) {
  if (reason && !strstr(text, reason))
    text_append(text, size, "%s%s", *text ? ", or " : "the exponent is too uncertain to print: ", reason);
}

status pooled_exponent_of_runs(const struct pooled_runs *runs, enum exponent_method method, double lower,
                               double *values, struct error *error) {
  const size_t n = runs->count;
  PREPARED p = {0};
  struct exponent fit;
  double *theta = values, mean = 0; /* beta without each run, then the values */
  for (size_t r = 0; r < n; r++)
    theta[r] = NAN;
  TRY(fit_all(&p, runs, method, lower, n, 1, &fit, theta, error));
  for (size_t r = 0; r < n; r++)
    mean += theta[r] / (double)n; /* NaN when one is NaN: too few runs */
  for (size_t r = 0; r < n; r++)
    values[r] = isfinite(mean) && n > 1 ? fit.beta + (double)(n - 1) * (mean - theta[r]) : (double)NAN;
  return STATUS_OK;
}

/* p of a cut-off in windows without an upper end, with each run's largest fragment. */
static double open_cutoff_p(const struct pooled_runs *runs, double lower, struct power_law_group *groups) {
  struct power_law pure = {.beta = NAN};
  for (int rival = 0; rival < 2; rival++) {
    for (size_t r = 0; r < runs->count; r++) {
      const size_t begin = runs->first[r], count = window_end(runs, r, lower) - begin;
      groups[r] = (struct power_law_group){0};
      if (count > 0)
        groups[r] = power_law_group_of(rival ? POWER_LAW_CUTOFF : POWER_LAW_PURE, count, runs->masses + begin, lower,
                                       HUGE_VAL);
    }
    if (!rival)
      pure = power_law_fit(runs->count, groups);
  }
  if (!isfinite(pure.beta))
    return NAN;
  const struct power_law_rival cutoff = power_law_rival_fit(POWER_LAW_CUTOFF, runs->count, groups);
  return power_law_rival_p_value(power_law_rival_ratio(&cutoff, pure.log_likelihood));
}

/* Fits a rival of the pure power law to all runs. */
static struct power_law_rival fit_rival(const struct pooled_runs *runs, double lower, enum power_law_kind kind,
                                        struct power_law_group *groups) {
  for (size_t r = 0; r < runs->count; r++)
    groups[r] = group_of(kind, runs, r, lower);
  return power_law_rival_fit(kind, runs->count, groups);
}

status pooled_rivals(const struct pooled_runs *runs, double lower, struct pooled_rivals *out, struct error *error) {
  *out = (struct pooled_rivals){0, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  TRY(check(runs, lower, error));
  OWNED struct power_law_group *groups = NULL;
  TRY(memory_array(&groups, runs->count, sizeof *groups, for_runs, error));
  for (size_t r = 0; r < runs->count; r++)
    groups[r] = group_of(POWER_LAW_PURE, runs, r, lower);
  out->n = (int64_t)total_weight(runs->count, groups);
  struct power_law pure = {.beta = NAN};
  if (out->n >= EXPONENT_LEAST_FRAGMENTS && differ(runs, lower, 0, 0))
    pure = power_law_fit(runs->count, groups);
  out->beta = pure.beta;
  if (isfinite(pure.beta)) {
    const struct power_law_rival cutoff = fit_rival(runs, lower, POWER_LAW_CUTOFF, groups);
    const struct power_law_rival lognormal = fit_rival(runs, lower, POWER_LAW_LOGNORMAL, groups);
    out->cutoff_beta = cutoff.beta;
    out->cutoff_mass = cutoff.rate > 0 ? lower / cutoff.rate : HUGE_VAL;
    out->cutoff_ratio = power_law_rival_ratio(&cutoff, pure.log_likelihood);
    out->cutoff_p = power_law_rival_p_value(out->cutoff_ratio);
    out->lognormal_ratio = power_law_rival_ratio(&lognormal, pure.log_likelihood);
    out->lognormal_p = power_law_rival_p_value(out->lognormal_ratio);
    out->open_cutoff_p = open_cutoff_p(runs, lower, groups);
  }
  return STATUS_OK;
}

/* ---- The pooled spectrum: densities or cumulative numbers, with intervals from the scatter of runs or points ---- */

/* Counts that vary by less are equal: rounding of the difference below. */
#define SAME_COUNTS 1e-14

double pooled_spectrum_count_hw95(size_t runs, double count, double squares) {
  if (runs < 2)
    return NAN;
  const double n = (double)runs, spread = squares - count * count / n;
  if (!(spread > SAME_COUNTS * squares))
    return NAN;
  return sample_student(runs, 0.95) * sqrt(spread / (n - 1) / n);
}

static int dimensions_of(const struct pooled_form *form) {
  if (!(form->size.density > 0))
    return 1;
  return form->size.dimensions == 2 ? 2 : 3;
}

double pooled_spectrum_exponent(const struct pooled_form *form, double beta) {
  return dimensions_of(form) * (beta - 1) + (form->cumulative ? 0 : 1);
}

double pooled_spectrum_half_width(const struct pooled_form *form, double half_width) {
  return dimensions_of(form) * half_width;
}

struct sums {
  int64_t count;
  double mass;
};

/* The bins from `low` on. number[j * runs + r]: fragments of run r in the j-th bin. */
struct span {
  size_t bins;
  int low;
  struct sums *sums;
  double *number;
};

/* Finds the lowest and highest non-empty bin. */
static void find_span(const struct pooled_runs *runs, struct span *span) {
  double least = HUGE_VAL, most = 0;
  for (size_t i = runs->count ? runs->first[0] : 0; runs->count && i < runs->first[runs->count]; i++) {
    const double mass = runs->masses[i];
    if (!(mass > 0) || isinf(mass))
      continue;
    least = fmin(least, mass);
    most = fmax(most, mass);
  }
  if (!(most > 0))
    return;
  span->low = spectrum_bin(least);
  span->bins = (size_t)(spectrum_bin(most) - span->low) + 1;
}

/* Masses are mostly in descending order, so the bin of the last fragment is a good guess for the next one. */
static void add_run(const struct pooled_runs *runs, size_t r, struct span *span) {
  int bin = SPECTRUM_NO_BIN;
  double from = HUGE_VAL, to = 0; /* edges of `bin` */
  for (size_t i = runs->first[r]; i < runs->first[r + 1]; i++) {
    const double mass = runs->masses[i];
    if (!(mass > 0) || isinf(mass))
      continue;
    if (!(mass >= from && mass < to)) {
      bin = spectrum_bin(mass);
      from = spectrum_edge(bin);
      to = spectrum_edge(bin + 1);
    }
    const size_t j = (size_t)(bin - span->low);
    span->number[j * runs->count + r]++;
    span->sums[j].count++;
    span->sums[j].mass += mass;
  }
}

status pooled_mean(size_t runs, const struct pooled_form *form, const double *number, double *mean, double *half_width,
                   struct error *error) {
  const size_t units = form->first_run ? form->units : runs;
  double sum = 0, squares = 0;
  for (size_t u = 0; u < units; u++) {
    const size_t from = form->first_run ? form->first_run[u] : u, to = form->first_run ? form->first_run[u + 1] : u + 1;
    double own = 0;
    for (size_t r = from; r < to; r++)
      own += number[r];
    own /= (double)(to - from);
    sum += own;
    squares += own * own;
  }
  *mean = sum / (double)units;
  *half_width = pooled_spectrum_count_hw95(units, sum, squares);
  return form->seed && units > 1
             ? sample_crossed_half_width(units, form->first_run, form->seed, number, half_width, error)
             : STATUS_OK;
}

status pooled_number(const struct pooled_runs *runs, const struct pooled_form *form, double from, double *mean,
                     double *half_width, struct error *error) {
  OWNED double *number = NULL;
  TRY(memory_array(&number, runs->count, sizeof *number, "the fragments of a spectrum", error));
  for (size_t r = 0; r < runs->count; r++)
    number[r] = (double)(window_end(runs, r, from) - runs->first[r]);
  return pooled_mean(runs->count, form, number, mean, half_width, error);
}

static status write_bins(const struct span *span, const struct pooled_form *form, size_t runs, struct pooled_bin *bins,
                         size_t *count, struct error *error) {
  struct pooled_bin above = {0};
  for (size_t j = 0; form->cumulative && j < span->bins; j++) {
    above.count += span->sums[j].count;
    above.mass += span->sums[j].mass;
  }
  for (size_t j = 0; j < span->bins; j++) {
    const struct sums *sums = &span->sums[j];
    if (!sums->count && !form->cumulative)
      continue;
    const int bin = span->low + (int)j;
    struct pooled_bin *out = &bins[(*count)++];
    *out = (struct pooled_bin){.bin = bin,
                               .lower = spectrum_size_of(&form->size, spectrum_edge(bin)),
                               .upper = spectrum_size_of(&form->size, spectrum_edge(bin + 1)),
                               .count = sums->count,
                               .mass = sums->mass};
    const double width = form->cumulative ? 1 : out->upper - out->lower;
    TRY(pooled_mean(runs, form, span->number + j * runs, &out->value, &out->half_width, error));
    out->value /= width;
    out->half_width /= width;
    if (!form->cumulative)
      continue;
    out->count = above.count;
    out->mass = above.mass;
    above.count -= sums->count;
    above.mass -= sums->mass;
  }
  return STATUS_OK;
}

status pooled_spectrum(const struct pooled_runs *runs, const struct pooled_form *form, struct pooled_bin **bins,
                       size_t *count, struct error *error) {
  struct span span = {0};
  OWNED struct sums *sums = NULL;
  OWNED double *number = NULL;
  *count = 0;
  *bins = NULL;
  find_span(runs, &span);
  TRY(memory_array(&sums, span.bins, sizeof *sums, "the bins of a spectrum", error));
  TRY(memory_array(bins, span.bins, sizeof **bins, "the bins of a spectrum", error));
  TRY(memory_array(&number, span.bins * runs->count, sizeof *number, "the bins of a spectrum", error));
  span.sums = sums;
  span.number = number;
  for (size_t r = 0; r < runs->count; r++)
    add_run(runs, r, &span);
  for (size_t i = span.bins ? (span.bins - 1) * runs->count : 0; form->cumulative && i-- > 0;)
    number[i] += number[i + runs->count];
  return write_bins(&span, form, runs->count, *bins, count, error);
}

/* ---- Does a power law fit at all? ----
 *
 * The bootstrap of Clauset, Shalizi & Newman (2009, doi 10.1137/070710111, section 4) in
 * the given window, which is not optimised: it begins at the complete mass or above. Draws are distributed over all
 * cores; the result does not depend on which core makes a draw. */
enum { BATCH = 100, ENOUGH = 100 }; /* stop after this many larger distances: p is then known to a tenth */

/* Numbers of fragments and windows of the runs, and the same for one draw. */
struct windows {
  size_t count, fragments;
  double lower;
  struct power_law_group *groups;
  double *step; /* of each run: the mass that its masses are multiples of; 0: none */
};

struct draw {
  struct power_law_group *groups;
  double *u; /* ln(m/lower), then the distribution function there */
};

static status make_draw(const struct windows *windows, struct draw *draw, struct error *error) {
  TRY(memory_array(&draw->groups, windows->count, sizeof *draw->groups, for_runs, error));
  return memory_array(&draw->u, windows->fragments, sizeof *draw->u, for_runs, error);
}

#define DRAW __attribute__((cleanup(free_draw))) struct draw
static void free_draw(struct draw *draw) {
  free(draw->groups);
  free(draw->u);
}

/* Fits the fragments of a draw and returns their greatest distance from the fit. If the law holds, the distribution
 * function at the fragments, each in the window of its run, is a uniform sample. NaN when there is no fit. */
static double distance_of(const struct windows *windows, struct draw *draw, double *beta) {
  const struct power_law fit = power_law_fit(windows->count, draw->groups);
  const double n = (double)windows->fragments;
  double most = 0;
  *beta = fit.beta;
  if (!isfinite(fit.beta))
    return NAN;
  size_t i = 0;
  for (size_t r = 0; r < windows->count; r++)
    for (size_t k = 0; k < (size_t)draw->groups[r].weight; k++, i++)
      draw->u[i] = power_law_below(fit.beta, draw->u[i], draw->groups[r].span);
  qsort(draw->u, windows->fragments, sizeof *draw->u, sample_ascending);
  for (i = 0; i < windows->fragments; i++)
    most = fmax(most, fmax((double)(i + 1) / n - draw->u[i], draw->u[i] - (double)i / n));
  return most;
}

/* ---- Masses that are whole numbers of a particle's: most fragments of ten particles weigh the same. Such steps are
 * far from any smooth law, so the draws need them, too. ---- */

static double step_of_run(const struct pooled_runs *runs, size_t r, double lower) {
  size_t begin, end;
  const size_t first = runs->first[r];
  pooled_window(runs, r, lower, &begin, &end);
  return exponent_step(runs->first[r + 1] - first, runs->masses + first, begin - first, end - first, lower);
}

/* Few fragments may all be multiples of several particles. The run with most fragments shows the particle's mass; it is
 * nearly the same in all runs of a point. */
static void find_steps(const struct pooled_runs *runs, double lower, struct windows *windows) {
  size_t most = 0;
  for (size_t r = 0; r < windows->count; r++) {
    windows->step[r] = windows->groups[r].weight > 0 ? step_of_run(runs, r, lower) : 0;
    if (windows->groups[r].weight > windows->groups[most].weight)
      most = r;
  }
  for (size_t r = 0; r < windows->count; r++)
    if (windows->step[r] > 0 && windows->step[most] > 0)
      windows->step[r] /= fmax(1, round(windows->step[r] / windows->step[most]));
}

/* u = ln(m/lower) of the nearest mass in steps that is at least `lower`. step: over `lower`. */
static double to_step(double u, double step) {
  const double first = ceil(1 / step - 1e-6);
  return fmax(0, log(step * fmax(round(exp(u) / step), first)));
}

/* Draws the same numbers of fragments in the same windows from the fitted law. A window of masses in steps ends half a
 * step below the largest fragment, so that each step stands for the masses that round to it. */
static void fill_draw(const struct windows *windows, double beta, uint64_t number, struct draw *draw) {
  const double k = beta - 1;
  size_t i = 0;
  for (size_t r = 0; r < windows->count; r++) {
    struct power_law_group *group = &draw->groups[r];
    *group = windows->groups[r];
    const double step = windows->step[r] / windows->lower;
    const double span = step > 0 ? log(exp(group->span) - step / 2) : group->span;
    const double whole = -expm1(-k * span);
    double sum = 0;
    for (size_t j = 0; j < (size_t)group->weight; j++, i++) {
      const double p = random_draw(windows->fragments, RANDOM_RESAMPLE, number, i);
      draw->u[i] = fabs(k * span) < 1e-9 ? p * span : -log1p(-p * whole) / k;
      if (step > 0)
        draw->u[i] = to_step(draw->u[i], step);
      sum += draw->u[i];
    }
    group->mean = group->weight > 0 ? sum / group->weight : 0;
  }
}

/* Counts the draws from .. to - 1 that are at least as far from their fits. */
static size_t count_larger(const struct windows *windows, double beta, double distance, size_t from, size_t to,
                           int threads, bool *failed) {
  (void)threads;
  size_t larger = 0;
#pragma omp parallel num_threads(threads) reduction(+ : larger)
  {
    DRAW draw = {0};
    double ignored;
    if (make_draw(windows, &draw, NULL)) {
#pragma omp atomic write
      *failed = true;
    } else {
#pragma omp for schedule(dynamic)
      for (size_t d = from; d < to; d++) {
        fill_draw(windows, beta, d, &draw);
        larger += distance_of(windows, &draw, &ignored) >= distance;
      }
    }
  }
  return larger;
}

static void bootstrap(const struct windows *windows, double beta, size_t draws, struct pooled_goodness *out,
                      bool *failed) {
  size_t larger = 0;
  const int threads = threads_granted(omp_get_max_threads());
  while (out->draws < draws && larger < ENOUGH && !*failed) {
    const size_t to = out->draws + BATCH < draws ? out->draws + BATCH : draws;
    larger += count_larger(windows, beta, out->distance, out->draws, to, threads, failed);
    out->draws = to;
  }
  out->p = ((double)larger + 1) / ((double)out->draws + 1);
}

/* Computes the windows of the runs, and puts the fragments in them into `found`. */
static void take_runs(const struct pooled_runs *runs, double lower, struct windows *windows, struct draw *found) {
  size_t i = 0;
  for (size_t r = 0; r < runs->count; r++) {
    size_t begin, end;
    pooled_window(runs, r, lower, &begin, &end);
    for (size_t k = begin; k < end; k++)
      found->u[i++] = log(runs->masses[k] / lower);
    windows->groups[r] = found->groups[r] = group_of(POWER_LAW_PURE, runs, r, lower);
  }
  windows->fragments = i;
  find_steps(runs, lower, windows);
}

status pooled_goodness(const struct pooled_runs *runs, double lower, size_t draws, struct pooled_goodness *out,
                       struct error *error) {
  *out = (struct pooled_goodness){0, NAN, NAN, 0};
  TRY(check(runs, lower, error));
  OWNED struct power_law_group *groups = NULL;
  OWNED double *step = NULL;
  DRAW found = {0};
  double beta;
  bool failed = false;
  TRY(memory_array(&groups, runs->count, sizeof *groups, for_runs, error));
  TRY(memory_array(&step, runs->count, sizeof *step, for_runs, error));
  struct windows windows = {runs->count, runs->count ? runs->first[runs->count] : 0, lower, groups, step};
  TRY(make_draw(&windows, &found, error));
  take_runs(runs, lower, &windows, &found);
  out->n = windows.fragments;
  if (windows.fragments >= EXPONENT_LEAST_FRAGMENTS && differ(runs, lower, 0, 0))
    out->distance = distance_of(&windows, &found, &beta);
  if (isfinite(out->distance))
    bootstrap(&windows, beta, draws, out, &failed);
  return failed ? status_fail(error, STATUS_MEMORY, "no memory for %s", for_runs) : STATUS_OK;
}
