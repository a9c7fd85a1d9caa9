/* Irregular points: thrown at random with a wanted spacing s(x), then pushed apart until the density sum is uniform. */
#ifndef CLAST_ENGINE_SPH_RELAX_H
#define CLAST_ENGINE_SPH_RELAX_H

#include "engine/sph/lattice.h"

/* `n` points into *points (allocated by the caller: x, y, z, and share when graded), deterministic by the lattice's seed
 * and body. STATUS_MEMORY. */
status sph_relax_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                      struct error *error);

#endif
