/* Exponents of a point from all its runs: one fit for a choice of runs, and the bootstrap over choices. */
#include "analysis/statistics/pooled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/power_law.h"
#include "analysis/statistics/tempered.h"

/* What resampling needs of each run: computed once. */
struct prepared {
  enum exponent_method method;
  size_t runs;
  struct power_law_group *plain;   /* MASSES, BINNED */
  struct tempered_group *tempered; /* CUTOFF */
  int first_bin, bins;             /* LEAST_SQUARES: counts[run * bins + j] of bin first_bin + j */
  int64_t *counts;
  const struct pooled_runs *all; /* KS */
  double lower;
  double *masses; /* KS: those of a resample */
  struct power_law_group *resampled_plain;
  struct tempered_group *resampled_tempered;
  struct spectrum_bin_row *rows;
};

/* Index behind the last fragment of run r whose mass is at least `lower`. */
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

/* The window of run r: fragments [*begin, *end), below its largest, whose mass it returns. Fragments as large as the
 * largest are left out with it. */
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

static struct power_law_group binned_group(const struct pooled_runs *runs, size_t r, double lower) {
  size_t begin, end;
  double largest = window_of(runs, r, lower, &begin, &end);
  struct power_law_group group = {0};
  if (!(largest > lower))
    return group;
  int first, stop;
  exponent_bins_inside((struct exponent_window){lower, largest}, &first, &stop);
  for (size_t i = begin; i < end; i++) {
    int bin = spectrum_bin(runs->masses[i]);
    if (bin < first || bin >= stop)
      continue;
    group.weight++;
    group.mean += bin - first;
  }
  if (group.weight > 0)
    group.mean /= group.weight;
  group.span = (double)stop - first;
  if (group.span < 2)
    group.weight = 0; /* one bin has no slope */
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

static status count_bins(struct prepared *p, const struct pooled_runs *runs, double lower) {
  int last = SPECTRUM_NO_BIN, stop;
  exponent_bins_inside((struct exponent_window){lower, HUGE_VAL}, &p->first_bin, &stop);
  size_t begin, end;
  for (size_t r = 0; r < runs->count; r++) {
    window_of(runs, r, lower, &begin, &end);
    if (begin < end && spectrum_bin(runs->masses[begin]) > last)
      last = spectrum_bin(runs->masses[begin]);
  }
  p->bins = last >= p->first_bin ? last - p->first_bin + 1 : 0;
  size_t bins = (size_t)p->bins;
  p->counts = calloc(runs->count * bins + 1, sizeof *p->counts);
  p->rows = calloc(bins + 1, sizeof *p->rows);
  if (!p->counts || !p->rows)
    return STATUS_MEMORY;
  for (size_t r = 0; r < runs->count; r++) {
    window_of(runs, r, lower, &begin, &end);
    for (size_t i = begin; i < end; i++) {
      int bin = spectrum_bin(runs->masses[i]) - p->first_bin;
      if (bin >= 0)
        p->counts[r * bins + (size_t)bin]++;
    }
  }
  return STATUS_OK;
}

static status prepare(struct prepared *p, const struct pooled_runs *runs, double lower) {
  size_t n = runs->count + 1;
  switch (p->method) {
  case EXPONENT_LEAST_SQUARES: return count_bins(p, runs, lower);
  case EXPONENT_BINNED:
  case EXPONENT_MASSES:
    p->plain = calloc(n, sizeof *p->plain);
    p->resampled_plain = calloc(n, sizeof *p->resampled_plain);
    if (!p->plain || !p->resampled_plain)
      return STATUS_MEMORY;
    for (size_t r = 0; r < runs->count; r++)
      p->plain[r] = p->method == EXPONENT_MASSES ? plain_group(runs, r, lower) : binned_group(runs, r, lower);
    return STATUS_OK;
  case EXPONENT_UPPER_CUTOFF:
    p->tempered = calloc(n, sizeof *p->tempered);
    p->resampled_tempered = calloc(n, sizeof *p->resampled_tempered);
    if (!p->tempered || !p->resampled_tempered)
      return STATUS_MEMORY;
    for (size_t r = 0; r < runs->count; r++)
      if (tempered_group_of(runs, r, lower, TEMPERED_CUTOFF, &p->tempered[r]))
        return STATUS_MEMORY;
    return STATUS_OK;
  case EXPONENT_KS: {
    size_t most = 0;
    for (size_t r = 0; r < runs->count; r++) {
      size_t here = runs->first[r + 1] - runs->first[r];
      if (here > most)
        most = here;
    }
    p->masses = malloc((n * most + 1) * sizeof *p->masses);
    p->resampled_plain = calloc(n, sizeof *p->resampled_plain);
    return p->masses && p->resampled_plain ? STATUS_OK : STATUS_MEMORY;
  }
  case EXPONENT_METHODS: break;
  }
  return STATUS_USAGE;
}

static void forget(struct prepared *p) {
  free(p->plain);
  free(p->tempered);
  free(p->counts);
  free(p->masses);
  free(p->resampled_plain);
  free(p->resampled_tempered);
  free(p->rows);
}

static double total_weight(size_t n, const struct power_law_group *groups) {
  double weight = 0;
  for (size_t i = 0; i < n; i++)
    weight += groups[i].weight;
  return weight;
}

static void fit_bins(struct prepared *p, size_t n, const uint32_t *chosen, struct exponent *fit) {
  size_t bins = (size_t)p->bins;
  for (size_t j = 0; j < bins; j++)
    p->rows[j] = (struct spectrum_bin_row){.bin = p->first_bin + (int)j};
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < bins; j++)
      p->rows[j].count += p->counts[chosen[i] * bins + j];
  exponent_fit_bins(p->method, bins, p->rows, (struct exponent_window){p->lower, HUGE_VAL}, fit, NULL);
}

static void fit_upper_cutoff(struct prepared *p, size_t n, const uint32_t *chosen, struct exponent *fit) {
  double weight = 0;
  for (size_t i = 0; i < n; i++) {
    p->resampled_tempered[i] = p->tempered[chosen[i]];
    weight += p->tempered[chosen[i]].weight;
  }
  fit->n = (int64_t)weight;
  if (weight < EXPONENT_LEAST_FRAGMENTS)
    return;
  struct tempered tempered = tempered_fit(TEMPERED_CUTOFF, n, p->resampled_tempered);
  fit->beta = tempered.beta;
  fit->standard_error = tempered.standard_error;
  fit->log_likelihood = tempered.log_likelihood;
  if (isfinite(tempered.beta))
    fit->cutoff_mass = tempered.rate > 0 ? p->lower / tempered.rate : HUGE_VAL;
}

/* The groups of EXPONENT_KS: the lower cut-off is searched anew in all masses of the chosen runs. */
static void group_above_lower_cutoff(struct prepared *p, size_t n, const uint32_t *chosen, struct exponent *fit) {
  size_t count = 0, begin, end;
  for (size_t i = 0; i < n; i++) {
    window_of(p->all, chosen[i], p->lower, &begin, &end);
    for (size_t j = begin; j < end; j++)
      p->masses[count++] = p->all->masses[j];
  }
  double lower = exponent_lower_cutoff(count, p->masses);
  fit->lower = isfinite(lower) ? lower : p->lower;
  for (size_t i = 0; i < n; i++)
    p->resampled_plain[i] = plain_group(p->all, chosen[i], fit->lower);
}

static void fit_plain(struct prepared *p, size_t n, const uint32_t *chosen, struct exponent *fit) {
  if (p->method == EXPONENT_KS)
    group_above_lower_cutoff(p, n, chosen, fit);
  for (size_t i = 0; p->method != EXPONENT_KS && i < n; i++)
    p->resampled_plain[i] = p->plain[chosen[i]];
  double weight = total_weight(n, p->resampled_plain);
  fit->n = (int64_t)weight;
  if (weight < EXPONENT_LEAST_FRAGMENTS)
    return;
  struct power_law plain = power_law_fit(n, p->resampled_plain,
                                         p->method == EXPONENT_BINNED ? log(10) / SPECTRUM_BINS_PER_DECADE : 0);
  fit->beta = plain.beta;
  fit->standard_error = plain.standard_error;
  fit->log_likelihood = plain.log_likelihood;
}

/* Fits the chosen runs and fills in what follows from the choice. */
static void fit_runs(struct prepared *p, size_t n, const uint32_t *chosen, struct exponent *fit) {
  fit->n = 0;
  fit->beta = fit->standard_error = NAN;
  if (p->method == EXPONENT_LEAST_SQUARES)
    fit_bins(p, n, chosen, fit);
  else if (p->method == EXPONENT_UPPER_CUTOFF)
    fit_upper_cutoff(p, n, chosen, fit);
  else
    fit_plain(p, n, chosen, fit);
}

static double beta_of(size_t n, const uint32_t *chosen, void *context) {
  struct exponent fit;
  fit_runs(context, n, chosen, &fit);
  return fit.beta;
}

static status check(const struct pooled_runs *runs, double lower, struct error *error) {
  if (!(lower > 0) || isinf(lower))
    return status_fail(error, STATUS_USAGE, "exponent: a window from %g kg: expected a positive mass", lower);
  if (runs->count > UINT32_MAX)
    return status_fail(error, STATUS_USAGE, "exponent: %zu runs are too many", runs->count);
  return STATUS_OK;
}

status pooled_exponent(const struct pooled_runs *runs, enum exponent_method method, double lower, size_t resamples,
                       double level, uint64_t seed, struct pooled_exponent *out, struct error *error) {
  *out = (struct pooled_exponent){.fit = exponent_unknown(method, (struct exponent_window){lower, HUGE_VAL}),
                                  .interval = {NAN, NAN, NAN, NAN, 0}};
  status code = check(runs, lower, error);
  if (code)
    return code;
  struct prepared p = {.method = method, .runs = runs->count, .all = runs, .lower = lower};
  uint32_t *every = calloc(runs->count + 1, sizeof *every);
  code = every ? prepare(&p, runs, lower) : STATUS_MEMORY;
  if (code == STATUS_USAGE)
    status_fail(error, code, "exponent: there is no method number %d", (int)method);
  else if (code)
    status_fail(error, code, "exponent: no memory for %zu runs", runs->count);
  if (code)
    goto cleanup;
  double upper = 0;
  for (size_t r = 0; r < runs->count; r++) {
    size_t begin, end;
    double largest = window_of(runs, r, lower, &begin, &end);
    every[r] = (uint32_t)r;
    if (begin >= end)
      continue;
    out->runs++;
    upper = fmax(upper, largest);
  }
  fit_runs(&p, runs->count, every, &out->fit);
  if (upper > 0)
    out->fit.upper = upper;
  out->interval.estimate = out->fit.beta;
  if (resamples > 0)
    out->interval = sample_bootstrap(runs->count, resamples, seed, level, beta_of, &p);
cleanup:
  forget(&p);
  free(every);
  return code;
}

status pooled_rivals(const struct pooled_runs *runs, double lower, struct pooled_rivals *out, struct error *error) {
  *out = (struct pooled_rivals){0, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  status code = check(runs, lower, error);
  if (code)
    return code;
  struct power_law_group *plain = malloc((runs->count + 1) * sizeof *plain);
  struct tempered_group *groups = malloc((runs->count + 1) * sizeof *groups);
  if (!plain || !groups) {
    code = status_fail(error, STATUS_MEMORY, "exponent: no memory for %zu runs", runs->count);
    goto cleanup;
  }
  for (size_t r = 0; r < runs->count; r++)
    plain[r] = plain_group(runs, r, lower);
  out->n = (int64_t)total_weight(runs->count, plain);
  if (out->n < EXPONENT_LEAST_FRAGMENTS)
    goto cleanup;
  struct power_law pure = power_law_fit(runs->count, plain, 0);
  out->beta = pure.beta;
  for (int kind = 0; kind < 2 && isfinite(pure.beta); kind++) {
    for (size_t r = 0; r < runs->count && !code; r++)
      code = tempered_group_of(runs, r, lower, (enum tempered_kind)kind, &groups[r]);
    if (code) {
      status_fail(error, code, "exponent: no memory for the masses of a run");
      goto cleanup;
    }
    struct tempered fit = tempered_fit((enum tempered_kind)kind, runs->count, groups);
    double ratio = tempered_ratio(&fit, pure.log_likelihood);
    if (kind == TEMPERED_CUTOFF) {
      out->cutoff_beta = fit.beta;
      out->cutoff_mass = fit.rate > 0 ? lower / fit.rate : HUGE_VAL;
      out->cutoff_ratio = ratio;
      out->cutoff_p = tempered_p_value(ratio);
    } else {
      out->lognormal_ratio = ratio;
      out->lognormal_p = tempered_p_value(ratio);
    }
  }
cleanup:
  free(plain);
  free(groups);
  return code;
}
