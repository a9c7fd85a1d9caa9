/* Exponents of a point from all its runs, with the jackknife over runs. */
#include "analysis/statistics/pooled.h"

#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/power_law.h"
#include "analysis/statistics/tempered.h"

/* Data of every run for the fits. */
struct prepared {
  enum exponent_method method;
  size_t runs;
  struct power_law_group *groups; /* MASSES */
  struct exponent_window window;  /* LEAST_SQUARES: the same for all runs */
  int first_bin;                  /* LEAST_SQUARES: counts[run * bins + j] of bin first_bin + j */
  size_t bins;
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

/* The window of run r: fragments [*begin, *end), below its largest fragment, whose mass is returned. Fragments of the
 * same mass as the largest are also left out. */
static double window_of(const struct pooled_runs *runs, size_t r, double lower, size_t *begin, size_t *end) {
  *begin = runs->first[r];
  *end = window_end(runs, r, lower);
  if (*begin == runs->first[r + 1])
    return NAN;
  double largest = runs->masses[*begin];
  while (*begin < *end && runs->masses[*begin] == largest)
    (*begin)++;
  return largest;
}

static struct power_law_group plain_group(const struct pooled_runs *runs, size_t r, double lower) {
  size_t begin, end;
  double largest = window_of(runs, r, lower, &begin, &end);
  struct power_law_group group = {0};
  if (!(largest > lower) || begin >= end)
    return group;
  group.weight = (double)(end - begin);
  group.span = log(largest / lower);
  for (size_t i = begin; i < end; i++)
    group.mean += log(runs->masses[i] / lower);
  group.mean /= group.weight;
  return group;
}

static status tempered_group_of(const struct pooled_runs *runs, size_t r, double lower, enum tempered_kind kind,
                                struct tempered_group *group) {
  size_t begin, end;
  double largest = window_of(runs, r, lower, &begin, &end);
  *group = (struct tempered_group){0};
  if (!(largest > lower) || begin >= end)
    return STATUS_OK;
  double *u = malloc((end - begin) * sizeof *u);
  if (!u)
    return STATUS_MEMORY;
  for (size_t i = begin; i < end; i++)
    u[i - begin] = log(runs->masses[i] / lower);
  *group = tempered_group(kind, end - begin, u, log(largest / lower));
  free(u);
  return STATUS_OK;
}

static status count_bins(struct prepared *p, const struct pooled_runs *runs) {
  int end;
  exponent_bins_inside(p->window, &p->first_bin, &end);
  p->bins = (size_t)(end - p->first_bin);
  p->counts = calloc(runs->count * p->bins + 1, sizeof *p->counts);
  p->total = calloc(p->bins + 1, sizeof *p->total);
  p->rows = calloc(p->bins + 1, sizeof *p->rows);
  if (!p->counts || !p->total || !p->rows)
    return STATUS_MEMORY;
  const double lower = spectrum_edge(p->first_bin), upper = spectrum_edge(end);
  for (size_t r = 0; r < runs->count; r++) {
    const size_t stop = window_end(runs, r, lower);
    for (size_t i = window_end(runs, r, upper); i < stop; i++)
      p->counts[r * p->bins + (size_t)(spectrum_bin(runs->masses[i]) - p->first_bin)]++;
  }
  for (size_t j = 0; j < p->bins; j++) {
    p->total[j].bin = p->first_bin + (int)j;
    for (size_t r = 0; r < runs->count; r++)
      p->total[j].count += p->counts[r * p->bins + j];
  }
  return STATUS_OK;
}

static status prepare(struct prepared *p, const struct pooled_runs *runs, double lower) {
  if (p->method == EXPONENT_LEAST_SQUARES) {
    p->window = exponent_window_from(p->method, lower, NAN);
    return count_bins(p, runs);
  }
  p->groups = calloc(runs->count + 1, sizeof *p->groups);
  if (!p->groups)
    return STATUS_MEMORY;
  for (size_t r = 0; r < runs->count; r++)
    p->groups[r] = plain_group(runs, r, lower);
  return STATUS_OK;
}

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
    filled = filled && p->rows[j].count > 0;
  }
  exponent_fit_bins(p->bins, p->rows, p->window, fit, NULL);
  if (!filled)
    fit->beta = fit->standard_error = NAN;
}

static void fit_groups(const struct prepared *p, struct exponent *fit) {
  const double weight = total_weight(p->runs, p->groups);
  fit->n = (int64_t)weight;
  if (weight < EXPONENT_LEAST_FRAGMENTS)
    return;
  const struct power_law plain = power_law_fit(p->runs, p->groups);
  fit->beta = plain.beta;
  fit->standard_error = plain.standard_error;
  fit->log_likelihood = plain.log_likelihood;
}

/* theta[g]: beta without the g-th group of `each` runs; there are `groups` of them. */
static status leave_out(struct prepared *p, size_t groups, size_t each, double *theta) {
  if (p->groups && !power_law_leave_out(p->runs, p->groups, each, theta))
    return STATUS_MEMORY;
  const double weight = total_weight(p->groups ? p->runs : 0, p->groups);
  for (size_t g = 0; g < groups; g++) {
    const size_t begin = g * each, end = g + 1 < groups ? begin + each : p->runs;
    if (p->groups) {
      if (weight - total_weight(end - begin, p->groups + begin) < EXPONENT_LEAST_FRAGMENTS)
        theta[g] = NAN;
      continue;
    }
    struct exponent fit = {0};
    fit_bins(p, begin, end, &fit);
    theta[g] = fit.beta;
  }
  return STATUS_OK;
}

static status no_memory(const struct pooled_runs *runs, struct error *error) {
  return status_fail(error, STATUS_MEMORY, "exponent: no memory for %zu runs", runs->count);
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
    double largest = window_of(runs, r, lower, &begin, &end), inside = 0;
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

static status check_method(enum exponent_method method, struct error *error) {
  if (method == EXPONENT_LEAST_SQUARES || method == EXPONENT_MASSES)
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "exponent: method number %d does not pool runs", (int)method);
}

/* Checks the arguments, fits all runs, and then all runs except one group at a time: theta, if there is a beta. After
 * an error p is empty. */
static status fit_all(struct prepared *p, const struct pooled_runs *runs, enum exponent_method method, double lower,
                      size_t groups, size_t each, struct exponent *fit, double *theta, struct error *error) {
  *p = (struct prepared){.method = method, .runs = runs->count};
  *fit = exponent_unknown(method, (struct exponent_window){lower, HUGE_VAL});
  status code = check_method(method, error);
  if (code)
    return code;
  code = check(runs, lower, error);
  if (code)
    return code;
  code = prepare(p, runs, lower);
  if (!code) {
    if (p->groups)
      fit_groups(p, fit);
    else
      fit_bins(p, 0, 0, fit);
  }
  if (!code && isfinite(fit->beta))
    code = leave_out(p, groups, each, theta);
  if (!code)
    return STATUS_OK;
  forget(p);
  return no_memory(runs, error);
}

status pooled_exponent(const struct pooled_runs *runs, enum exponent_method method, double lower, double level,
                       struct pooled_exponent *out, struct error *error) {
  struct prepared p;
  double theta[SAMPLE_GROUPS], upper;
  size_t each;
  const size_t groups = sample_groups(runs->count, &each);
  *out = (struct pooled_exponent){.interval = {NAN, NAN, NAN}};
  const status code = fit_all(&p, runs, method, lower, groups, each, &out->fit, theta, error);
  if (code)
    return code;
  out->runs = count_runs(&p, runs, lower, &upper);
  if (upper > 0 && method != EXPONENT_LEAST_SQUARES)
    out->fit.upper = upper;
  out->interval = sample_jackknife_of(runs->count, level, out->fit.beta, theta);
  forget(&p);
  return STATUS_OK;
}

/* The values of pooled_exponent_of_runs() from beta and from theta[r], beta without run r. Both arrays have n
 * elements. */
static void values_of_runs(size_t n, double beta, const double *theta, double *values) {
  double mean = 0;
  for (size_t r = 0; r < n; r++)
    mean += theta[r] / (double)n; /* NaN when one is NaN: too few runs */
  for (size_t r = 0; r < n; r++)
    values[r] = isfinite(mean) && n > 1 ? beta + (double)(n - 1) * (mean - theta[r]) : (double)NAN;
}

status pooled_exponent_of_runs(const struct pooled_runs *runs, enum exponent_method method, double lower,
                               double *values, struct error *error) {
  struct prepared p;
  struct exponent fit;
  double *theta = malloc((runs->count + 1) * sizeof *theta);
  if (!theta)
    return no_memory(runs, error);
  for (size_t r = 0; r < runs->count; r++)
    theta[r] = NAN;
  const status code = fit_all(&p, runs, method, lower, runs->count, 1, &fit, theta, error);
  if (!code) {
    values_of_runs(runs->count, fit.beta, theta, values);
    forget(&p);
  }
  free(theta);
  return code;
}

/* Fits a rival of the pure power law to all runs. STATUS_MEMORY. */
static status fit_rival(const struct pooled_runs *runs, double lower, enum tempered_kind kind,
                        struct tempered_group *groups, struct tempered *fit) {
  for (size_t r = 0; r < runs->count; r++)
    if (tempered_group_of(runs, r, lower, kind, &groups[r]))
      return STATUS_MEMORY;
  *fit = tempered_fit(kind, runs->count, groups);
  return STATUS_OK;
}

static status fit_rivals(const struct pooled_runs *runs, double lower, double log_likelihood,
                         struct tempered_group *groups, struct pooled_rivals *out) {
  struct tempered cutoff, lognormal;
  if (fit_rival(runs, lower, TEMPERED_CUTOFF, groups, &cutoff) ||
      fit_rival(runs, lower, TEMPERED_LOGNORMAL, groups, &lognormal))
    return STATUS_MEMORY;
  out->cutoff_beta = cutoff.beta;
  out->cutoff_mass = cutoff.rate > 0 ? lower / cutoff.rate : HUGE_VAL;
  out->cutoff_ratio = tempered_ratio(&cutoff, log_likelihood);
  out->cutoff_p = tempered_p_value(out->cutoff_ratio);
  out->lognormal_ratio = tempered_ratio(&lognormal, log_likelihood);
  out->lognormal_p = tempered_p_value(out->lognormal_ratio);
  return STATUS_OK;
}

status pooled_rivals(const struct pooled_runs *runs, double lower, struct pooled_rivals *out, struct error *error) {
  *out = (struct pooled_rivals){0, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  status code = check(runs, lower, error);
  if (code)
    return code;
  struct power_law_group *plain = malloc((runs->count + 1) * sizeof *plain);
  struct tempered_group *groups = malloc((runs->count + 1) * sizeof *groups);
  if (!plain || !groups) {
    code = no_memory(runs, error);
    goto cleanup;
  }
  for (size_t r = 0; r < runs->count; r++)
    plain[r] = plain_group(runs, r, lower);
  out->n = (int64_t)total_weight(runs->count, plain);
  if (out->n < EXPONENT_LEAST_FRAGMENTS)
    goto cleanup;
  const struct power_law pure = power_law_fit(runs->count, plain);
  out->beta = pure.beta;
  if (isfinite(pure.beta) && fit_rivals(runs, lower, pure.log_likelihood, groups, out))
    code = no_memory(runs, error);
cleanup:
  free(plain);
  free(groups);
  return code;
}
