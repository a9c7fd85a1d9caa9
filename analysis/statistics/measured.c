/* Compares a measured spectrum with simulated ones: Kolmogorov's distance and a likelihood, above the complete mass. */
#include "analysis/statistics/measured.h"

#include <math.h>
#include <stdlib.h>

void measured_release(struct measured *measured) {
  free(measured->mass);
  free(measured->above);
  *measured = (struct measured){0};
}

/* The bin of threshold i: N(>= m) there, or the density up to the next threshold. The last class has no upper end, so
 * it has no density. */
static struct pooled_bin bin_of(const struct measured *measured, const struct pooled_form *form, size_t i) {
  const bool last = i + 1 == measured->n;
  const double above = measured->above[i];
  struct pooled_bin bin = {.lower = spectrum_size_of(&form->size, measured->mass[i]), .half_width = NAN};
  if (form->cumulative || last) {
    bin.count = (int64_t)llround(above);
    bin.upper = form->cumulative ? bin.lower : 0;
    bin.value = form->cumulative ? above : 0;
    return bin;
  }
  const double inside = above - measured->above[i + 1];
  bin.count = (int64_t)llround(inside);
  bin.upper = spectrum_size_of(&form->size, measured->mass[i + 1]);
  bin.value = inside / (bin.upper - bin.lower);
  return bin;
}

/* Single fragments are binned like simulated ones; thresholds are their own bins. */
status measured_bins(const struct measured *measured, const struct pooled_form *form, struct pooled_bin **bins,
                     size_t *count, struct error *error) {
  const struct pooled_form one = {.cumulative = form->cumulative, .size = form->size};
  *count = 0;
  if (measured->single && !form->cumulative) {
    const size_t first[2] = {0, measured->n};
    const struct pooled_runs runs = {1, first, measured->mass};
    return pooled_spectrum(&runs, &one, bins, count, error);
  }
  *bins = calloc(measured->n + 1, sizeof **bins);
  if (!*bins)
    return status_fail(error, STATUS_MEMORY, "no memory for a measured spectrum");
  for (size_t i = 0; i < measured->n; i++) {
    if (i > 0 && measured->mass[i] == measured->mass[i - 1])
      continue; /* equal masses: only the first has the right N(>= m) */
    const struct pooled_bin bin = bin_of(measured, form, i);
    if (bin.value > 0)
      (*bins)[(*count)++] = bin;
  }
  return STATUS_OK;
}

/* Ascending masses, a part of a sorted array. */
struct sorted {
  size_t n;
  const double *mass;
};

/* The number of masses of at least `mass`; with `beyond`, of more than `mass`. */
static double at_least(const struct sorted *sorted, double mass, bool beyond) {
  size_t low = 0, high = sorted->n;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (beyond ? sorted->mass[middle] > mass : sorted->mass[middle] >= mass)
      high = middle;
    else
      low = middle + 1;
  }
  return (double)(sorted->n - low);
}

/* Two shares of fragments above a mass, and their greatest difference so far. `own`: a run that is excluded from the
 * pool, or NULL. */
struct distance {
  const struct sorted *pool, *own;
  double whole, most; /* fragments of the pool */
};

static void look_at(struct distance *d, double mass, bool beyond, double share) {
  const double rest = at_least(d->pool, mass, beyond) - (d->own ? at_least(d->own, mass, beyond) : 0);
  d->most = fmax(d->most, fabs(rest / d->whole - share));
}

/* Distance of a sample of single masses: the shares differ most just before or after one of its masses. */
static double distance_of_sample(const struct sorted *sample, const struct sorted *pool, bool own) {
  struct distance d = {pool, own ? sample : NULL, (double)pool->n - (own ? (double)sample->n : 0), 0};
  for (size_t i = 0; i < sample->n; i++) {
    const double mass = sample->mass[i];
    look_at(&d, mass, false, at_least(sample, mass, false) / (double)sample->n);
    look_at(&d, mass, true, at_least(sample, mass, true) / (double)sample->n);
  }
  return d.most;
}

/* Distance of a run, evaluated at thresholds. */
static double distance_at(const struct measured *at, size_t first, const struct sorted *run,
                          const struct sorted *pool) {
  struct distance d = {pool, run, (double)(pool->n - run->n), 0};
  for (size_t i = first; i < at->n; i++)
    look_at(&d, at->mass[i], false, at_least(run, at->mass[i], false) / (double)run->n);
  return d.most;
}

static double measured_distance(const struct measured *m, size_t first, const struct sorted *pool) {
  if (m->single)
    return distance_of_sample(&(struct sorted){m->n - first, m->mass + first}, pool, false);
  struct distance d = {pool, NULL, (double)pool->n, 0};
  for (size_t i = first; i < m->n; i++)
    look_at(&d, m->mass[i], false, m->above[i] / m->above[first]);
  return d.most;
}

/* A class of masses from low to high, and how many measured fragments it has. */
struct mass_class {
  double low, high, measured;
};

/* Class c of single masses: the bins of the spectrum. The first begins at `from`; the last has no upper end. */
static struct mass_class bin_class(const struct sorted *mine, int bin, double from, bool first, bool last) {
  struct mass_class k = {first ? from : spectrum_edge(bin), last ? HUGE_VAL : spectrum_edge(bin + 1), 0};
  k.measured = at_least(mine, k.low, false) - at_least(mine, k.high, false);
  return k;
}

/* The class from threshold i to the next one. */
static struct mass_class threshold_class(const struct measured *m, size_t i) {
  if (i + 1 == m->n)
    return (struct mass_class){m->mass[i], HUGE_VAL, m->above[i]};
  return (struct mass_class){m->mass[i], m->mass[i + 1], m->above[i] - m->above[i + 1]};
}

/* The contribution of class k to the log-likelihood when the fragments are drawn from the pool. */
static double class_likelihood(struct mass_class k, const struct sorted *pool, double whole) {
  const double there = at_least(pool, k.low, false) - (isinf(k.high) ? 0 : at_least(pool, k.high, false));
  return k.measured * log((there + 0.5) / whole);
}

/* Log-likelihood of the measured fragments of at least `from`, which begin at index `first`. */
static double log_likelihood(const struct measured *m, size_t first, double from, const struct sorted *pool) {
  double sum = 0;
  if (!m->single) {
    const double whole = (double)pool->n + 0.5 * (double)(m->n - first);
    for (size_t i = first; i < m->n; i++)
      sum += class_likelihood(threshold_class(m, i), pool, whole);
    return sum;
  }
  const struct sorted mine = {m->n - first, m->mass + first};
  const int begin = spectrum_bin(from), end = spectrum_bin(m->mass[m->n - 1]);
  const double whole = (double)pool->n + 0.5 * (double)(end - begin + 1);
  for (int bin = begin; bin <= end; bin++)
    sum += class_likelihood(bin_class(&mine, bin, from, bin == begin, bin == end), pool, whole);
  return sum;
}

/* Copies the masses of run r of at least `from` into `room`, ascending. */
static struct sorted sort_run(const struct pooled_runs *runs, size_t r, double from, double *room) {
  size_t n = 0;
  for (size_t i = runs->first[r]; i < runs->first[r + 1]; i++)
    if (runs->masses[i] >= from && isfinite(runs->masses[i]))
      room[n++] = runs->masses[i];
  qsort(room, n, sizeof *room, sample_ascending);
  return (struct sorted){n, room};
}

static void compare_runs(const struct measured *m, size_t first, const struct pooled_runs *runs,
                         const struct sorted *pool, double *room, struct measured_match *out) {
  struct sample_moments moments = {0};
  size_t judged = 0, far = 0;
  for (size_t r = 0; r < runs->count; r++) {
    const struct sorted run = sort_run(runs, r, out->from, room);
    sample_add(&moments, (double)run.n);
    if (run.n == 0 || run.n == pool->n)
      continue;
    judged++;
    far += (m->single ? distance_of_sample(&run, pool, true) : distance_at(m, first, &run, pool)) >= out->distance;
  }
  out->simulated = sample_summarise_moments(&moments, 0.95);
  if (judged >= 3)
    out->share = (double)far / (double)judged;
}

status measured_compare(const struct measured *measured, const struct pooled_runs *runs, double complete,
                        struct measured_match *out, struct error *error) {
  const size_t all = runs->count ? runs->first[runs->count] : 0;
  size_t first = 0;
  complete = fmax(fmax(complete, measured->complete), 0); /* fmax ignores a NaN */
  while (first < measured->n && measured->mass[first] < complete)
    first++;
  *out = (struct measured_match){complete, 0, {0, NAN, NAN, NAN, NAN}, NAN, NAN, NAN};
  if (first == measured->n)
    return STATUS_OK;
  if (!measured->single || !(complete > 0))
    out->from = measured->mass[first];
  out->fragments = measured->above[first];
  double *masses = malloc((2 * all + 1) * sizeof *masses);
  if (!masses)
    return status_fail(error, STATUS_MEMORY, "no memory to compare a measured spectrum");
  const struct pooled_runs together = {1, (const size_t[]){0, all}, runs->masses};
  const struct sorted pool = sort_run(&together, 0, out->from, masses);
  if (pool.n > 0) {
    out->distance = measured_distance(measured, first, &pool);
    out->log_likelihood = log_likelihood(measured, first, out->from, &pool);
  }
  compare_runs(measured, first, runs, &pool, masses + all, out);
  free(masses);
  return STATUS_OK;
}
