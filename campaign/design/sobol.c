/* Sobol numbers from GSL with two corrections. The origin, which GSL leaves out, is put back: the first 2^k points are
 * a net only with it (Owen 2020, "On dropping the first Sobol' point"). And a digital shift by seed (Cranley &
 * Patterson 1976 for nets; L'Ecuyer & Lemieux 2002) makes the estimate unbiased and lets replicates of the design give
 * an error; half of the last bit is added, so that no coordinate is 0, where an unbounded law has no quantile. */
#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>

#include "campaign/design/design.h"
#include "engine/random.h"

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
  struct design_sobol *sobol = calloc(1, sizeof *sobol);
  gsl_qrng *generator = sobol ? gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dimensions) : NULL;
  if (!generator) {
    free(sobol);
    return status_fail(error, STATUS_MEMORY, "design sobol: no memory");
  }
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
