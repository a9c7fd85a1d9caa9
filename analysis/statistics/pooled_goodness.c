/* Does a power law fit at all? The bootstrap of Clauset, Shalizi & Newman (2009, doi 10.1137/070710111, section 4) in
 * the given window, which is not optimised: it begins at the complete mass or above. Draws are distributed over all
 * cores; the result does not depend on which core makes a draw. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/pooled.h"
#include "analysis/statistics/power_law.h"
#include "engine/random.h"

enum { BATCH = 100, ENOUGH = 100 }; /* stop after this many larger distances: p is then known to a tenth */

/* Numbers of fragments and windows of the runs, and the same for one draw. */
struct windows {
  size_t count, fragments;
  struct power_law_group *groups;
};

struct draw {
  struct power_law_group *groups;
  double *u; /* ln(m/lower), then the distribution function there */
};

static status make_draw(const struct windows *windows, struct draw *draw) {
  draw->groups = malloc((windows->count + 1) * sizeof *draw->groups);
  draw->u = malloc((windows->fragments + 1) * sizeof *draw->u);
  return draw->groups && draw->u ? STATUS_OK : STATUS_MEMORY;
}

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

/* Draws the same numbers of fragments in the same windows from the fitted law. */
static void fill_draw(const struct windows *windows, double beta, uint64_t number, struct draw *draw) {
  const double k = beta - 1;
  size_t i = 0;
  for (size_t r = 0; r < windows->count; r++) {
    struct power_law_group *group = &draw->groups[r];
    *group = windows->groups[r];
    const double span = group->span, whole = -expm1(-k * span);
    double sum = 0;
    for (size_t j = 0; j < (size_t)group->weight; j++, i++) {
      const double p = random_draw(windows->fragments, RANDOM_RESAMPLE, number, i);
      draw->u[i] = fabs(k * span) < 1e-9 ? p * span : -log1p(-p * whole) / k;
      sum += draw->u[i];
    }
    group->mean = group->weight > 0 ? sum / group->weight : 0;
  }
}

/* Counts the draws from .. to - 1 that are at least as far from their fits. */
static size_t count_larger(const struct windows *windows, double beta, double distance, size_t from, size_t to,
                           bool *failed) {
  size_t larger = 0;
#pragma omp parallel reduction(+ : larger)
  {
    struct draw draw;
    double ignored;
    if (make_draw(windows, &draw)) {
#pragma omp atomic write
      *failed = true;
    } else {
#pragma omp for schedule(dynamic)
      for (size_t d = from; d < to; d++) {
        fill_draw(windows, beta, d, &draw);
        larger += distance_of(windows, &draw, &ignored) >= distance;
      }
    }
    free_draw(&draw);
  }
  return larger;
}

static void bootstrap(const struct windows *windows, double beta, size_t draws, struct pooled_goodness *out,
                      bool *failed) {
  size_t larger = 0;
  while (out->draws < draws && larger < ENOUGH && !*failed) {
    const size_t to = out->draws + BATCH < draws ? out->draws + BATCH : draws;
    larger += count_larger(windows, beta, out->distance, out->draws, to, failed);
    out->draws = to;
  }
  out->p = ((double)larger + 1) / ((double)out->draws + 1);
}

/* Computes the windows of the runs, and puts the fragments in them into `found`. */
static void take_runs(const struct pooled_runs *runs, double lower, struct windows *windows, struct draw *found) {
  size_t i = 0;
  for (size_t r = 0; r < runs->count; r++) {
    const size_t first = runs->first[r], end = runs->first[r + 1];
    const double largest = first < end ? runs->masses[first] : 0;
    struct power_law_group group = {0};
    for (size_t k = first; k < end && runs->masses[k] >= lower; k++) {
      if (runs->masses[k] == largest)
        continue;
      found->u[i] = log(runs->masses[k] / lower);
      group.mean += found->u[i++];
      group.weight++;
    }
    group.span = largest > lower ? log(largest / lower) : 0;
    group.mean = group.weight > 0 ? group.mean / group.weight : 0;
    windows->groups[r] = found->groups[r] = group;
  }
  windows->fragments = i;
}

status pooled_goodness(const struct pooled_runs *runs, double lower, size_t draws, struct pooled_goodness *out,
                       struct error *error) {
  *out = (struct pooled_goodness){0, NAN, NAN, 0};
  if (!(lower > 0) || isinf(lower))
    return status_fail(error, STATUS_USAGE, "exponent: a window from %g kg: expected a positive mass", lower);
  struct windows windows = {.count = runs->count, .fragments = runs->count ? runs->first[runs->count] : 0};
  windows.groups = malloc((windows.count + 1) * sizeof *windows.groups);
  struct draw found;
  double beta;
  bool failed = make_draw(&windows, &found) != STATUS_OK || !windows.groups;
  if (!failed) {
    take_runs(runs, lower, &windows, &found);
    out->n = windows.fragments;
    if (windows.fragments >= EXPONENT_LEAST_FRAGMENTS)
      out->distance = distance_of(&windows, &found, &beta);
    if (isfinite(out->distance))
      bootstrap(&windows, beta, draws, out, &failed);
  }
  free_draw(&found);
  free(windows.groups);
  return failed ? status_fail(error, STATUS_MEMORY, "exponent: no memory for %zu runs", runs->count) : STATUS_OK;
}
