/* Sobol indices and elementary effects with their intervals. */
#include "analysis/statistics/statistics.h"

#include <math.h>

#include "schemas/memory.h"

/* Computes one index over a subset of blocks and seeds. */
struct asking {
  const struct sensitivity_table *table;
  const double *centred; /* values minus their mean: this reduces the rounding errors of the products */
  size_t input;          /* index of the input; `inputs`: the seed */
  bool total;
  size_t blocks, seeds; /* of the subset */
  const uint32_t *block, *seed;
  uint32_t *in_groups; /* space for the blocks of some groups */
};

static double at(const struct asking *a, size_t b, size_t point, size_t r) {
  const struct sensitivity_table *t = a->table;
  return a->centred[(a->block[b] * (t->inputs + 2) + point) * t->seeds + a->seed[r]];
}

/* Variance between the points A and B of the subset for one seed, averaged over the seeds. */
static double between_points(const struct asking *a) {
  double mean = 0;
  for (size_t r = 0; r < a->seeds; r++) {
    struct sample_moments moments = {0};
    for (size_t b = 0; b < a->blocks; b++) {
      sample_add(&moments, at(a, b, 0, r));
      sample_add(&moments, at(a, b, 1, r));
    }
    mean += moments.squares / (double)(moments.n - 1) / (double)a->seeds;
  }
  return mean;
}

/* Mean variance over the seeds at a point. `alike`: covariance of the same seeds at two points. */
static double of_seeds(const struct asking *a, bool alike) {
  const double points = 2 * (double)a->blocks;
  double own = 0;
  struct sample_moments together = {0};
  for (size_t b = 0; b < a->blocks; b++)
    for (size_t point = 0; point < 2; point++) {
      struct sample_moments moments = {0};
      for (size_t r = 0; r < a->seeds; r++)
        sample_add(&moments, at(a, b, point, r));
      own += moments.squares / (double)(a->seeds - 1) / points;
    }
  if (!alike)
    return own;
  for (size_t r = 0; r < a->seeds; r++) {
    double mean = 0;
    for (size_t b = 0; b < a->blocks; b++)
      mean += (at(a, b, 0, r) + at(a, b, 1, r)) / points;
    sample_add(&together, mean);
  }
  return (points * together.squares / (double)(a->seeds - 1) - own) / (points - 1);
}

/* Mean over blocks and pairs of different seeds of f(r) g(s), from sums over the seeds; with one seed: of f g. */
struct product {
  double sum;
  size_t seeds;
};

static void add_product(struct product *p, double f, double g, double fg) {
  const double n = (double)p->seeds;
  p->sum += p->seeds > 1 ? (f * g - fg) / (n * (n - 1)) : fg;
}

static double first_order(const struct asking *a) {
  struct product product = {0, a->seeds};
  for (size_t b = 0; b < a->blocks; b++) {
    double f = 0, g = 0, fg = 0;
    for (size_t r = 0; r < a->seeds; r++) {
      const double y = at(a, b, 1, r), change = at(a, b, 2 + a->input, r) - at(a, b, 0, r);
      f += y;
      g += change;
      fg += y * change;
    }
    add_product(&product, f, g, fg);
  }
  return product.sum / (double)a->blocks;
}

static double total_effect(const struct asking *a) {
  double same = 0;
  struct product different = {0, a->seeds};
  for (size_t b = 0; b < a->blocks; b++) {
    double f = 0, ff = 0;
    for (size_t r = 0; r < a->seeds; r++) {
      const double change = at(a, b, 0, r) - at(a, b, 2 + a->input, r);
      f += change;
      ff += change * change;
    }
    same += ff / (double)a->seeds;
    add_product(&different, f, f, ff);
  }
  return (a->table->same_seeds ? same : different.sum) / (2 * (double)a->blocks);
}

static double index_of(const struct asking *a) {
  const bool seed = a->input == a->table->inputs;
  if (a->blocks < 2 || a->seeds < 1 || ((seed || a->total) && a->seeds < 2))
    return NAN; /* one seed: the noise of the runs cannot be told from the effect of an input */
  /* The whole variance: between points with one seed, plus the effect of a seed that is the same at all points. */
  const double alike = a->seeds > 1 ? of_seeds(a, true) : 0, whole = between_points(a) + alike;
  if (seed)
    return (a->total ? of_seeds(a, false) : alike) / whole;
  return (a->total ? total_effect(a) : first_order(a)) / whole;
}

static bool same_group(const struct sensitivity_table *t, size_t a, size_t b) {
  return t->group && t->group[a] == t->group[b];
}

static double over_groups(size_t n, const uint32_t *chosen, void *context) {
  struct asking a = *(const struct asking *)context;
  a.blocks = 0;
  for (uint32_t b = 0, group = 0, k = 0; b < a.table->blocks && k < n; b++) {
    group += b > 0 && !same_group(a.table, b, b - 1);
    k += group > chosen[k];
    if (k < n && group == chosen[k])
      a.in_groups[a.blocks++] = b;
  }
  a.block = a.in_groups;
  return index_of(&a);
}

static double over_seeds(size_t n, const uint32_t *chosen, void *context) {
  struct asking a = *(const struct asking *)context;
  a.seeds = n;
  a.seed = chosen;
  return index_of(&a);
}

static struct sample_interval interval_of(struct asking *a) {
  size_t groups = 1;
  for (size_t b = 1; b < a->table->blocks; b++)
    groups += !same_group(a->table, b, b - 1);
  const bool seed = a->input == a->table->inputs;
  struct sample_interval interval = sample_jackknife(groups, 0.95, over_groups, a), seeds = {NAN, 0, NAN};
  if (seed && !a->total && a->seeds < 3) { /* a covariance of two seeds: more blocks do not tell how far off */
    interval.standard_error = interval.half_width = NAN;
    return interval;
  }
  if (a->seeds > 2)
    seeds = sample_jackknife(a->seeds, 0.95, over_seeds, a);
  if (a->seeds > 1 && a->table->same_seeds) {
    const double alike = of_seeds(a, true);
    const struct sample_alike variance = {a->seeds, 2 * (double)a->blocks, of_seeds(a, false), alike,
                                          between_points(a) + alike};
    seeds.half_width = fmax(seeds.half_width, sample_alike_half(&variance, interval.estimate, seed));
  }
  interval.standard_error = hypot(interval.standard_error, seeds.standard_error);
  if (!isnan(seeds.half_width)) /* NaN: no seed moves the index */
    interval.half_width = hypot(interval.half_width, seeds.half_width);
  return interval;
}

status sensitivity_sobol(const struct sensitivity_table *t, struct sensitivity_index *index, struct error *error) {
  const size_t n = t->blocks * (t->inputs + 2) * t->seeds, most = t->blocks > t->seeds ? t->blocks : t->seeds;
  if (t->blocks < 2 || t->seeds < 1 || t->inputs < 1)
    return status_fail(error, STATUS_USAGE, "Sobol indices need at least two blocks of points with a result, not %zu",
                       t->blocks);
  OWNED double *centred = NULL;
  OWNED uint32_t *all = NULL, *in_groups = NULL;
  TRY(sample_about_mean(n, t->value, &centred, error));
  TRY(memory_array(&in_groups, t->blocks, sizeof *in_groups, "the indices", error));
  TRY(memory_array(&all, most, sizeof *all, "the indices", error));
  for (size_t i = 0; i < most; i++)
    all[i] = (uint32_t)i;
  struct asking a = {.table = t,
                     .centred = centred,
                     .blocks = t->blocks,
                     .seeds = t->seeds,
                     .block = all,
                     .seed = all,
                     .in_groups = in_groups};
  for (a.input = 0; a.input <= t->inputs; a.input++) {
    a.total = false;
    index[a.input].first = interval_of(&a);
    a.total = true;
    index[a.input].total = interval_of(&a);
  }
  return STATUS_OK;
}
