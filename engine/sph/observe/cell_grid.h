/* A cell grid: finds all pairs of particles within a multiple of their mean smoothing length. The cells are hashed, on
 * one level per halving of h. Memory grows with n only: neither distant particles (1e9 m away) nor a wide range of
 * sizes cost any. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_CELL_GRID_H
#define CLAST_ENGINE_SPH_OBSERVE_CELL_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum sph_cell_grid_role { SPH_CELL_GRID_ABSENT, SPH_CELL_GRID_ACTIVE, SPH_CELL_GRID_PASSIVE };

struct sph_cell_grid; /* opaque */

/* A grid for the pairs with r <= reach (h_i + h_j)/2. An axis whose `periodic` length (m) is not NaN uses the minimum
 * image. The position and h of a particle that is not absent must be finite, h > 0. The data are copied.
 * STATUS_MEMORY. */
status sph_cell_grid_create(size_t n, const double *x, const double *y, const double *z, const double *h,
                            const uint8_t *role, double reach, const double periodic[3], struct sph_cell_grid **out,
                            struct error *error);
void sph_cell_grid_free(struct sph_cell_grid *grid); /* NULL is fine */

/* `square`: r^2 of the pair, m^2; the same bits for (i, j) and (j, i). */
typedef void (*sph_cell_grid_pair)(void *context, uint32_t i, uint32_t j, double square);
/* Visits the pairs of an active and a passive particle if `passive`, else the pairs of two active ones. A pair may come
 * twice (two cells can share a bucket), and the order of the pairs is arbitrary: the result of `pair` must not depend
 * on either. */
void sph_cell_grid_visit(const struct sph_cell_grid *grid, bool passive, sph_cell_grid_pair pair, void *context);

#endif
