/* An order of particles along Hilbert's curve, so that neighbours are near in memory, and that any stretch of it has a
 * small surface. Deterministic: ties by id. */
#ifndef CLAST_ENGINE_SPH_BODY_HILBERT_H
#define CLAST_ENGINE_SPH_BODY_HILBERT_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* order[k] = index of the particle that stands at place k. Far-flung particles cost nothing: no grid is allocated.
 * STATUS_MEMORY. */
status sph_hilbert_find(size_t n, const double *x, const double *y, const double *z, uint32_t *order,
                        struct error *error);

#endif
