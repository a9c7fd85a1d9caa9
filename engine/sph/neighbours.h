/* Pairs of particles within reach of each other, found in hashed cells, so that memory depends on n alone and never on the
 * extent. Particles of very different reach stand in cells of their own size: each looks among its equals and its betters. */
#ifndef CLAST_ENGINE_SPH_NEIGHBOURS_H
#define CLAST_ENGINE_SPH_NEIGHBOURS_H

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/pairs_kernels.h"
#include "schemas/status.h"

/* Neighbours j > i of particle i are j[start[i]] .. j[start[i] + count[i] - 1], in an order that depends on nothing but the
 * arguments. */
struct sph_neighbours {
  size_t n, used, capacity;
  size_t *start;
  uint32_t *count, *j;
};

/* All pairs with r < reach_i + reach_j; nearest image along axes whose `periodic` length is not NaN. Grows `lists`.
 * STATUS_MEMORY, STATUS_CONTENT (a periodic box that is too thin for its particles). */
status sph_neighbours_find(size_t n, const double *x, const double *y, const double *z, const double *reach,
                           const double periodic[3], const struct sph_pair_kernels *kernels, struct sph_neighbours *lists,
                           struct error *error);
void sph_neighbours_clear(struct sph_neighbours *lists);

#endif
