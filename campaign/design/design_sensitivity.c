/* The design of Saltelli (2002). */
#include "campaign/design/design.h"

#include <stdlib.h>

#include "engine/random.h"
#include "schemas/memory.h"

#define SHIFTS_MARK (UINT64_C(1) << 60) /* keeps the random numbers of this design apart from those of others */

struct design_sensitivity {
  size_t inputs, blocks;
  uint64_t seed;
  double *pairs; /* for every block the coordinates of A, then of B */
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

status design_sensitivity_create(size_t inputs, size_t blocks, uint64_t seed, struct design_sensitivity **out,
                                 struct error *error) {
  enum { MOST_INPUTS = 20, MOST_BLOCKS = 1 << 20 };
  *out = NULL;
  if (inputs < 1 || inputs > MOST_INPUTS || blocks < 1 || blocks > MOST_BLOCKS)
    return status_fail(error, STATUS_CONTENT, "%zu inputs and %zu blocks: expected 1 to %d inputs, 1 to %d blocks",
                       inputs, blocks, MOST_INPUTS, MOST_BLOCKS);
  struct design_sensitivity *design = memory_small(1, sizeof *design);
  *design = (struct design_sensitivity){.inputs = inputs, .blocks = blocks, .seed = seed};
  const status code = fill_pairs(design, error);
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

size_t design_sensitivity_rows(const struct design_sensitivity *design) {
  return design->blocks * (design->inputs + 2);
}

void design_sensitivity_row(const struct design_sensitivity *design, size_t row, double *coordinates) {
  const size_t n = design->inputs, block = row / (n + 2), point = row % (n + 2);
  const double *a = design->pairs + block * 2 * n, *b = a + n;
  for (size_t i = 0; i < n; i++)
    coordinates[i] = point == 1 || point == 2 + i ? b[i] : a[i];
}
