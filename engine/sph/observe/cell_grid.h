/* Which particles are within a share of each other's smoothing length? Hashed cells on one level per halving of h:
 * memory in proportion to n, whatever the extent (a particle 1e9 m off allocates nothing) and however much sizes
 * differ. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_CELL_GRID_H
#define CLAST_ENGINE_SPH_OBSERVE_CELL_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum sph_cell_grid_role { SPH_CELL_GRID_ABSENT, SPH_CELL_GRID_ACTIVE, SPH_CELL_GRID_PASSIVE };

struct sph_cell_grid; /* opaque */

/* Pairs with r <= reach (h_i + h_j)/2 (minimum image along axes whose `periodic` length, m, is not NaN). Positions and
 * h of particles that are not absent must be finite, h > 0. All is copied. STATUS_MEMORY. */
status sph_cell_grid_create(size_t n, const double *x, const double *y, const double *z, const double *h,
                            const uint8_t *role, double reach, const double periodic[3], struct sph_cell_grid **out,
                            struct error *error);
void sph_cell_grid_free(struct sph_cell_grid *touching); /* NULL is fine */

/* r^2 of the pair, the same bits for (i, j) and (j, i). */
typedef void (*sph_cell_grid_pair)(void *context, uint32_t i, uint32_t j, double square);
/* Pairs of two active particles, or of an active and a passive one: `passive` says which. Each at least once (now and
 * then twice: two cells may share a place in the table), in an order that means nothing: what a visitor makes of the
 * pairs must not depend on it. */
void sph_cell_grid_visit(const struct sph_cell_grid *touching, bool passive, sph_cell_grid_pair pair, void *context);

#endif
