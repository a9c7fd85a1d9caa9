/* The designs of Saltelli (2002) and Morris (1991). */
#include "campaign/design/design.h"

#include <stdlib.h>

#include "engine/random.h"
#include "schemas/memory.h"

enum { LEVELS = 4 };
#define SHIFTS_MARK (UINT64_C(1) << 60)
#define MORRIS_MARK (UINT64_C(1) << 61) /* keep the random numbers of these designs apart from those of others */

struct design_sensitivity {
  enum design_sensitivity_kind kind;
  size_t inputs, blocks;
  uint64_t seed;
  double *pairs; /* Saltelli: for every block the coordinates of A, then of B */
};

uint32_t design_sensitivity_group(size_t blocks, size_t block) {
  enum { GROUPS = 8 };
  return (uint32_t)(blocks < 2 * GROUPS ? block : block * GROUPS / blocks);
}

static status fill_pairs(struct design_sensitivity *design, struct error *error) {
  const size_t width = 2 * design->inputs;
  struct design_sobol *sobol = NULL;
  TRY(memory_array(&design->pairs, design->blocks * width, sizeof *design->pairs, "a design", error));
  for (size_t b = 0; b < design->blocks; b++) {
    const uint32_t group = design_sensitivity_group(design->blocks, b);
    if (b == 0 || group != design_sensitivity_group(design->blocks, b - 1)) {
      uint64_t shift[4];
      random_bits(design->seed, RANDOM_DESIGN, SHIFTS_MARK | group, 0, shift);
      design_sobol_free(sobol);
      TRY(design_sobol_create(width, shift[0], &sobol, error));
    }
    design_sobol_next(sobol, design->pairs + b * width);
  }
  design_sobol_free(sobol);
  return STATUS_OK;
}

status design_sensitivity_create(enum design_sensitivity_kind kind, size_t inputs, size_t blocks, uint64_t seed,
                                 struct design_sensitivity **out, struct error *error) {
  enum { MOST_INPUTS = 20, MOST_BLOCKS = 1 << 20 };
  *out = NULL;
  if (inputs < 1 || inputs > MOST_INPUTS || blocks < 1 || blocks > MOST_BLOCKS)
    return status_fail(error, STATUS_CONTENT, "%zu inputs and %zu blocks: expected 1 to %d inputs, 1 to %d blocks",
                       inputs, blocks, MOST_INPUTS, MOST_BLOCKS);
  struct design_sensitivity *design = memory_small(1, sizeof *design);
  *design = (struct design_sensitivity){.kind = kind, .inputs = inputs, .blocks = blocks, .seed = seed};
  const status code = kind == DESIGN_SENSITIVITY_SALTELLI ? fill_pairs(design, error) : STATUS_OK;
  if (code) {
    design_sensitivity_free(design);
    return code;
  }
  *out = design;
  return STATUS_OK;
}

void design_sensitivity_free(struct design_sensitivity *design) {
  if (design)
    free(design->pairs);
  free(design);
}

static size_t points_of_block(const struct design_sensitivity *design) {
  return design->inputs + (design->kind == DESIGN_SENSITIVITY_SALTELLI ? 2 : 1);
}

size_t design_sensitivity_rows(const struct design_sensitivity *design) {
  return design->blocks * points_of_block(design);
}

/* A number from 0 to n - 1. */
static size_t draw(const struct design_sensitivity *design, size_t block, size_t number, size_t n) {
  return (size_t)(random_draw(design->seed, RANDOM_DESIGN, MORRIS_MARK | block, number) * (double)n);
}

/* The order in which a trajectory changes its inputs (Fisher and Yates), and their first levels. */
static void walk(const struct design_sensitivity *design, size_t block, size_t *order, size_t *level) {
  for (size_t i = 0; i < design->inputs; i++) {
    order[i] = i;
    level[i] = draw(design, block, 2 * i, LEVELS);
  }
  for (size_t i = design->inputs - 1; i > 0; i--) {
    const size_t j = draw(design, block, 2 * i + 1, i + 1), kept = order[i];
    order[i] = order[j];
    order[j] = kept;
  }
}

/* Middles of the levels: no coordinate is 0 or 1, where an unbounded law has no quantile. */
static double coordinate(size_t level) {
  return ((double)level + 0.5) / LEVELS;
}

static size_t moved(size_t level) {
  return (level + LEVELS / 2) % LEVELS;
}

void design_sensitivity_row(const struct design_sensitivity *design, size_t row, double *coordinates) {
  const size_t n = design->inputs, block = row / points_of_block(design), point = row % points_of_block(design);
  if (design->kind == DESIGN_SENSITIVITY_SALTELLI) {
    const double *a = design->pairs + block * 2 * n, *b = a + n;
    for (size_t i = 0; i < n; i++)
      coordinates[i] = point == 1 || point == 2 + i ? b[i] : a[i];
    return;
  }
  size_t order[64], level[64];
  walk(design, block, order, level);
  for (size_t k = 0; k < n; k++)
    coordinates[order[k]] = coordinate(k < point ? moved(level[order[k]]) : level[order[k]]);
}
