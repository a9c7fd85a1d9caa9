/* Bodies of irregular points: uniform, or finer near a point (sph_grading). */
#ifndef CLAST_ENGINE_SPH_BODY_IRREGULAR_H
#define CLAST_ENGINE_SPH_BODY_IRREGULAR_H

#include "engine/sph/body/lattice.h"

/* `wanted`: number of uniform particles (not used with a grading). Fills *points: x, y, z, n, share when graded.
 * STATUS_MEMORY; STATUS_CONTENT when a grading cannot give the number asked for. */
status sph_irregular_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, double wanted,
                          struct sph_points *points, struct error *error);

#endif
