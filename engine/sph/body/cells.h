/* Cells of a body that crack as one (modules/crack_cell.c): cubes of a fixed width. The grid of cubes is turned and
 * shifted by the seed. A cube cut by the surface is a smaller cell. */
#ifndef CLAST_ENGINE_SPH_BODY_CELLS_H
#define CLAST_ENGINE_SPH_BODY_CELLS_H

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/body/bodies.h"
#include "schemas/status.h"

struct sph_cells {
  size_t particles, count; /* number of particles; number of cells that have a particle */
  uint32_t *of;            /* by particle of the body: its cell */
};

/* Sorts the particles of a body, at their initial places, into cells of this width (m). Drawn from (seed,
 * RANDOM_CELL, body). STATUS_MEMORY. */
status sph_cells_make(uint64_t seed, uint64_t body, double width, const struct sph_particles *particles,
                      struct sph_range range, struct sph_cells **out, struct error *error);
void sph_cells_free(struct sph_cells *cells); /* NULL is fine */

#endif
