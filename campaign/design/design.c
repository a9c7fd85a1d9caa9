/* Walks the points of every kind of design, and judges when a point is finished. */
#include "campaign/design/design.h"

#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "schemas/memory.h"

struct design {
  enum design_kind kind;
  const struct design_axis *axes;
  size_t axis_count, free_count; /* free: not linked */
  uint64_t points, seed, next;
  struct design_sobol *sobol;
  size_t *levels; /* of the current point, by axis */
  double *coordinates;
};

#define MOST_POINTS (UINT64_C(1) << 53) /* the number of points must be exact in a double, in SQL and in JSON */

static status count_grid(struct design *design, struct error *error) {
  design->points = 1;
  for (size_t i = 0; i < design->axis_count; i++) {
    const struct design_axis *axis = &design->axes[i];
    if (axis->kind == DESIGN_AXIS_LINKED)
      continue;
    if (axis->kind != DESIGN_AXIS_LEVELS)
      return status_fail(error, STATUS_CONTENT,
                         "vary.%s: a distribution has no grid; give levels ([a, b, c] or {from, to, n}), or use design "
                         "{kind: random | latin_hypercube | sobol, points: n}",
                         axis->row->path);
    if (axis->level_count > MOST_POINTS / design->points)
      return status_fail(error, STATUS_CONTENT, "design grid: more than 2^53 points; vary fewer inputs");
    design->points *= axis->level_count;
  }
  return STATUS_OK;
}

static status count_list(struct design *design, struct error *error) {
  const struct design_axis *longest = NULL;
  for (size_t i = 0; i < design->axis_count; i++) {
    const struct design_axis *axis = &design->axes[i];
    if (axis->kind == DESIGN_AXIS_LINKED)
      continue;
    if (axis->kind != DESIGN_AXIS_LEVELS)
      return status_fail(error, STATUS_CONTENT, "vary.%s: design list needs values, not a distribution",
                         axis->row->path);
    if (longest && longest->level_count != axis->level_count)
      return status_fail(error, STATUS_CONTENT,
                         "vary.%s: %zu values, but vary.%s has %zu; design list takes the i-th value of every input "
                         "for point i, so the lists must be equally long (or use design grid)",
                         axis->row->path, axis->level_count, longest->row->path, longest->level_count);
    longest = axis;
  }
  design->points = longest ? longest->level_count : 1;
  return STATUS_OK;
}

static status count_sample(struct design *design, uint64_t points, struct error *error) {
  if (points < 1)
    return status_fail(error, STATUS_CONTENT, "design: say how many points, e.g. {kind: sobol, points: 64}");
  if (points > MOST_POINTS || (design->kind == DESIGN_SOBOL && points > (UINT64_C(1) << DESIGN_SOBOL_BITS)))
    return status_fail(error, STATUS_CONTENT, "design.points: %llu is more than this design has",
                       (unsigned long long)points);
  if (design->free_count == 0)
    return status_fail(error, STATUS_CONTENT, "vary: no input varies, so a sampling design has nothing to sample");
  design->points = points;
  return STATUS_OK;
}

status design_create(enum design_kind kind, const struct design_axis *axes, size_t axis_count, uint64_t points,
                     uint64_t seed, struct design **out, struct error *error) {
  *out = NULL;
  struct design *design = memory_small(1, sizeof *design);
  *design = (struct design){.kind = kind, .axes = axes, .axis_count = axis_count, .seed = seed};
  for (size_t i = 0; i < axis_count; i++)
    design->free_count += axes[i].kind != DESIGN_AXIS_LINKED;
  design->levels = memory_small(axis_count + 1, sizeof *design->levels);
  design->coordinates = memory_small(axis_count + 1, sizeof *design->coordinates);
  status code = STATUS_OK;
  if (kind == DESIGN_GRID)
    code = count_grid(design, error);
  else if (kind == DESIGN_LIST)
    code = count_list(design, error);
  else
    code = count_sample(design, points, error);
  if (code == STATUS_OK && kind == DESIGN_SOBOL)
    code = design_sobol_create(design->free_count, seed, &design->sobol, error);
  if (code != STATUS_OK) {
    design_free(design);
    return code;
  }
  *out = design;
  return STATUS_OK;
}

void design_free(struct design *design) {
  if (!design)
    return;
  design_sobol_free(design->sobol);
  free(design->levels);
  free(design->coordinates);
  free(design);
}

uint64_t design_points(const struct design *design) {
  return design->points;
}

/* Levels of point i of a grid (the last axis varies fastest) or a list. */
static void walk_levels(struct design *design, uint64_t i) {
  for (size_t a = design->axis_count; a-- > 0;) {
    const struct design_axis *axis = &design->axes[a];
    if (axis->kind == DESIGN_AXIS_LINKED)
      continue;
    if (design->kind == DESIGN_LIST) {
      design->levels[a] = (size_t)i;
    } else {
      design->levels[a] = (size_t)(i % axis->level_count);
      i /= axis->level_count;
    }
  }
}

static void sample(struct design *design, uint64_t i) {
  if (design->kind == DESIGN_SOBOL)
    design_sobol_next(design->sobol, design->coordinates);
  for (size_t d = 0; d < design->free_count; d++) {
    if (design->kind == DESIGN_RANDOM)
      design->coordinates[d] = design_random_coordinate(design->seed, i, d);
    else if (design->kind == DESIGN_LATIN_HYPERCUBE)
      design->coordinates[d] = design_latin_coordinate(design->seed, design->points, i, d);
  }
}

/* Counter-based random numbers: point i is the same for any number of points, and a longer design contains the
 * shorter one. */
double design_random_coordinate(uint64_t seed, uint64_t i, size_t dimension) {
  return random_draw(seed, RANDOM_DESIGN, i, dimension);
}

bool design_next(struct design *design, struct field_value *values) {
  if (design->next >= design->points)
    return false;
  uint64_t i = design->next++;
  bool levels = design->kind == DESIGN_GRID || design->kind == DESIGN_LIST;
  if (levels)
    walk_levels(design, i);
  else
    sample(design, i);
  size_t dimension = 0;
  for (size_t a = 0; a < design->axis_count; a++) {
    const struct design_axis *axis = &design->axes[a];
    if (axis->kind == DESIGN_AXIS_LINKED)
      continue;
    if (levels) {
      values[a] = axis->levels[design->levels[a]];
      continue;
    }
    double u = design->coordinates[dimension++];
    design->levels[a] = axis->kind == DESIGN_AXIS_LEVELS ? design_axis_level(axis, u) : 0;
    design_axis_quantile(axis, u, &values[a]);
  }
  for (size_t a = 0; a < design->axis_count; a++) {
    const struct design_axis *axis = &design->axes[a];
    if (axis->kind == DESIGN_AXIS_LINKED)
      design_axis_follow(axis, &values[axis->linked], design->levels[axis->linked], &values[a]);
  }
  return true;
}

/* Latin hypercube (McKay, Beckman & Conover 1979): each dimension is cut into as many strata as there are points, and
 * each stratum holds one point. The strata's order is a pseudo-random permutation per dimension that needs no table: a
 * Feistel network over the next power of four, walked along its cycle until it lands inside (Black & Rogaway 2002), so
 * that a design of a million points needs no memory and point i is computed directly. */

enum {
  ROUNDS = 8
}; /* Luby & Rackoff 1988 prove that 4 give a strong permutation; doubled for the small domains here */
#define PERMUTATION_MARK (UINT64_C(1) << 63) /* differs from the draws within strata, which count items from 0 */

uint64_t design_latin_permute(uint64_t seed, size_t dimension, uint64_t points, uint64_t i) {
  if (points < 2)
    return 0;
  unsigned half = 1;
  while (half < 31 && (UINT64_C(1) << (2 * half)) < points)
    half++;
  uint64_t mask = (UINT64_C(1) << half) - 1;
  do {
    uint64_t left = i >> half, right = i & mask;
    for (uint64_t round = 0; round < ROUNDS; round++) {
      uint64_t bits[4];
      random_bits(seed, RANDOM_DESIGN, PERMUTATION_MARK | round << 32 | dimension, right, bits);
      uint64_t next = left ^ (bits[0] & mask);
      left = right;
      right = next;
    }
    i = left << half | right;
  } while (i >= points);
  return i;
}

double design_latin_coordinate(uint64_t seed, uint64_t points, uint64_t i, size_t dimension) {
  double within = random_draw(seed, RANDOM_DESIGN, i, dimension);
  double stratum = (double)design_latin_permute(seed, dimension, points, i);
  /* Rounding must not carry the point over its stratum's upper edge. */
  double upper = nextafter((stratum + 1) / (double)points, 0);
  return fmin((stratum + within) / (double)points, upper);
}

/* Sobol numbers from GSL with two corrections. The origin, which GSL leaves out, is put back: the first 2^k points are
 * a net only with it (Owen 2020, "On dropping the first Sobol' point"). And a digital shift by seed (Cranley &
 * Patterson 1976 for nets; L'Ecuyer & Lemieux 2002) makes the estimate unbiased and lets replicates of the design give
 * an error; half of the last bit is added, so that no coordinate is 0, where an unbounded law has no quantile. */

#define SHIFT_MARK (UINT64_C(1) << 62)
enum { MOST_DIMENSIONS = 64 };

struct design_sobol {
  gsl_qrng *generator;
  size_t dimensions;
  bool begun;
  uint32_t shift[MOST_DIMENSIONS];
};

uint32_t design_sobol_shift(uint64_t seed, size_t dimension) {
  uint64_t bits[4];
  random_bits(seed, RANDOM_DESIGN, SHIFT_MARK | dimension, 0, bits);
  return (uint32_t)(bits[0] >> (64 - DESIGN_SOBOL_BITS));
}

status design_sobol_create(size_t dimensions, uint64_t seed, struct design_sobol **out, struct error *error) {
  *out = NULL;
  size_t most = gsl_qrng_sobol->max_dimension;
  if (most > MOST_DIMENSIONS)
    most = MOST_DIMENSIONS;
  if (dimensions < 1 || dimensions > most)
    return status_fail(error, STATUS_CONTENT,
                       "design sobol: %zu varied inputs, but Sobol numbers are known for 1 to %zu; use "
                       "latin_hypercube or random, or link some inputs",
                       dimensions, most);
  struct design_sobol *sobol = memory_small(1, sizeof *sobol);
  gsl_qrng *generator = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dimensions);
  if (!generator)
    memory_refused();
  *sobol = (struct design_sobol){.generator = generator, .dimensions = dimensions};
  for (size_t d = 0; d < dimensions; d++)
    sobol->shift[d] = design_sobol_shift(seed, d);
  *out = sobol;
  return STATUS_OK;
}

void design_sobol_next(struct design_sobol *sobol, double *coordinates) {
  double x[MOST_DIMENSIONS] = {0};
  if (sobol->begun)
    gsl_qrng_get(sobol->generator, x);
  sobol->begun = true;
  for (size_t d = 0; d < sobol->dimensions; d++) {
    uint32_t digits = (uint32_t)ldexp(x[d], DESIGN_SOBOL_BITS) ^ sobol->shift[d];
    coordinates[d] = ldexp(digits + 0.5, -DESIGN_SOBOL_BITS);
  }
}

void design_sobol_free(struct design_sobol *sobol) {
  if (!sobol)
    return;
  gsl_qrng_free(sobol->generator);
  free(sobol);
}

/* ---- The stopping rule: batches of replicates until the interval is narrow enough ---- */

/* NaN: all values are equal; tables have a bound then, and the rule its own. */
static double table_half_width(const struct design_stopping *rule, const struct sample_summary *mean) {
  return sample_share_half_width(mean->n, mean->mean, mean->standard_deviation, rule->level);
}

double design_stopping_reached(const struct design_stopping *rule, const double *values, int64_t prefix) {
  const struct sample_summary mean = sample_summarise((size_t)prefix, values, rule->level);
  const double one = rule->of_mean ? fabs(mean.mean) : 1;
  if (rule->fixed || mean.n < 2 || !(one > 0))
    return NAN;
  const double of_rule = sample_rule_half_width(mean.n, mean.standard_deviation, one * rule->half_width, rule->level);
  return (rule->share ? fmax(of_rule, table_half_width(rule, &mean)) : of_rule) / one;
}

enum design_verdict design_stopping_judge(const struct design_stopping *rule, const double *values, int64_t *prefix) {
  if (rule->fixed)
    return DESIGN_FIXED;
  const struct sample_summary mean = sample_summarise((size_t)*prefix, values, rule->level);
  const double wanted = (rule->of_mean ? fabs(mean.mean) : 1) * rule->half_width;
  if (sample_may_stop((size_t)*prefix, values, wanted, rule->level, (size_t)rule->minimum) &&
      !(rule->share && table_half_width(rule, &mean) > wanted))
    return DESIGN_INTERVAL_MET;
  if (*prefix >= rule->maximum)
    return DESIGN_CAP_REACHED;
  int64_t room = rule->maximum - *prefix;
  *prefix += rule->batch < room ? rule->batch : room;
  return DESIGN_GROW;
}
