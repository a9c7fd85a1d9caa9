/* Sorts particles along Hilbert's curve: particles that are near in space are then near in memory, and consecutive
 * particles fill a compact region. Deterministic: ties are sorted by id. */
#ifndef CLAST_ENGINE_SPH_BODY_HILBERT_H
#define CLAST_ENGINE_SPH_BODY_HILBERT_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* order[k] is the index of the particle at place k. Distant particles cost nothing extra, because there is no grid.
 * STATUS_MEMORY. */
status sph_hilbert_find(size_t n, const double *x, const double *y, const double *z, uint32_t *order,
                        struct error *error);

#endif
