/* The variance over points and runs, split into inputs and seeds. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/scatter.h"

/* Variance between the means of levels, weighted by their number of points, over a subset of the runs, without the
 * error of the means from the seeds: the sum over runs r != s of w_l m_l(r) m_l(s), minus the same for the whole mean.
 * m: work space of levels. level NULL: every point is a level. */
struct split {
  const struct scatter_table *table;
  size_t axis; /* `axes`: all inputs together */
  size_t levels;
  double *sum, *product, *weight; /* by level */
  int part;                       /* parts after the axes: enum in scatter.h */
};

static size_t level_of(const struct split *s, size_t p) {
  return s->axis < s->table->axes ? s->table->level[p * s->table->axes + s->axis] : p;
}

static double between(struct split *s, size_t n, const uint32_t *runs) {
  const struct scatter_table *t = s->table;
  double whole = 0, whole_squares = 0, variance = 0;
  for (size_t l = 0; l < s->levels; l++)
    s->product[l] = s->weight[l] = 0;
  double *total = s->sum + s->levels; /* sums over runs, by level */
  for (size_t l = 0; l < s->levels; l++)
    total[l] = 0;
  for (size_t k = 0; k < n; k++) {
    double mean = 0;
    for (size_t l = 0; l < s->levels; l++)
      s->sum[l] = s->weight[l] = 0;
    for (size_t p = 0; p < t->points; p++) {
      const double y = t->value[p * t->runs + runs[k]];
      s->sum[level_of(s, p)] += y;
      s->weight[level_of(s, p)]++;
      mean += y / (double)t->points;
    }
    for (size_t l = 0; l < s->levels; l++) {
      const double m = s->weight[l] > 0 ? s->sum[l] / s->weight[l] : 0;
      total[l] += m;
      s->product[l] += m * m;
    }
    whole += mean;
    whole_squares += mean * mean;
  }
  const double pairs = (double)n * (double)(n - 1);
  for (size_t l = 0; l < s->levels; l++)
    variance += s->weight[l] / (double)t->points * (total[l] * total[l] - s->product[l]) / pairs;
  return variance - (whole * whole - whole_squares) / pairs;
}

/* Mean variance over the runs of a point. `alike`: covariance of the same runs at two points, which is the variance of
 * the mean of all points without the points' own part. */
static double seeds(const struct scatter_table *t, size_t n, const uint32_t *runs, bool alike) {
  double own = 0;
  struct sample_moments together = {0};
  for (size_t p = 0; p < t->points; p++) {
    struct sample_moments moments = {0};
    for (size_t k = 0; k < n; k++)
      sample_add(&moments, t->value[p * t->runs + runs[k]]);
    own += moments.squares / (double)(n - 1) / (double)t->points;
  }
  if (!alike)
    return own;
  for (size_t k = 0; k < n; k++) {
    double mean = 0;
    for (size_t p = 0; p < t->points; p++)
      mean += t->value[p * t->runs + runs[k]] / (double)t->points;
    sample_add(&together, mean);
  }
  const double points = (double)t->points;
  return (points * together.squares / (double)(n - 1) - own) / (points - 1);
}

static double variance_of(struct split *s, size_t n, const uint32_t *runs) {
  if (s->part == SCATTER_SEEDS || s->part == SCATTER_SEEDS_ALIKE)
    return seeds(s->table, n, runs, s->part == SCATTER_SEEDS_ALIKE);
  return between(s, n, runs);
}

static double share_of(size_t n, const uint32_t *runs, void *context) {
  struct split *s = context, whole = *s;
  if (n < 2)
    return NAN;
  whole.axis = s->table->axes;
  whole.levels = s->table->points;
  whole.part = SCATTER_INPUTS;
  const double all = between(&whole, n, runs) + seeds(s->table, n, runs, false);
  return variance_of(s, n, runs) / all;
}

static size_t count_levels(const struct scatter_table *t, size_t axis) {
  size_t levels = 0;
  for (size_t p = 0; p < t->points; p++)
    if (t->level[p * t->axes + axis] >= levels)
      levels = t->level[p * t->axes + axis] + 1;
  return levels;
}

/* Does every combination of the values of the axes occur exactly once? Only then the means over the others isolate one
 * axis. */
static bool is_grid(const struct scatter_table *t) {
  double points = 1;
  for (size_t a = 0; a < t->axes; a++)
    points *= (double)count_levels(t, a);
  return points == (double)t->points;
}

static struct scatter_part part_of(struct split *s, const uint32_t *all) {
  const struct sample_interval share = sample_jackknife(s->table->runs, 0.95, share_of, s);
  return (struct scatter_part){variance_of(s, s->table->runs, all), share.estimate, share.half_width};
}

/* Sets the part of each axis alone. */
static void fill_axes(struct split *s, const uint32_t *all, struct scatter_part *parts) {
  const bool grid = is_grid(s->table);
  s->part = SCATTER_INPUTS;
  for (size_t a = 0; a < s->table->axes; a++) {
    parts[a] = (struct scatter_part){NAN, NAN, NAN};
    s->axis = a;
    s->levels = count_levels(s->table, a);
    if (grid)
      parts[a] = part_of(s, all);
  }
}

/* Sets the parts of all inputs and of the seeds; the whole is their sum. */
static void fill_parts(struct split *s, const uint32_t *all, struct scatter_part parts[SCATTER_PARTS]) {
  s->axis = s->table->axes;
  s->levels = s->table->points;
  for (s->part = 0; s->part < SCATTER_PARTS; s->part++)
    if (s->part != SCATTER_WHOLE)
      parts[s->part] = part_of(s, all);
  parts[SCATTER_WHOLE] = (struct scatter_part){parts[SCATTER_INPUTS].variance + parts[SCATTER_SEEDS].variance, 1, NAN};
}

status scatter_split(const struct scatter_table *t, struct scatter_part *parts, struct error *error) {
  if (t->points < 2 || t->runs < 2)
    return status_fail(error, STATUS_USAGE,
                       "splitting a variance needs at least two points with two runs each, not %zu points with %zu",
                       t->points, t->runs);
  double *room = malloc(4 * t->points * sizeof *room);
  uint32_t *all = malloc(t->runs * sizeof *all);
  if (!room || !all) {
    free(room);
    free(all);
    return status_fail(error, STATUS_MEMORY, "no memory to split a variance");
  }
  for (size_t r = 0; r < t->runs; r++)
    all[r] = (uint32_t)r;
  struct split s = {.table = t, .sum = room, .product = room + 2 * t->points, .weight = room + 3 * t->points};
  fill_axes(&s, all, parts);
  fill_parts(&s, all, parts + t->axes);
  free(room);
  free(all);
  return STATUS_OK;
}
