/* Pairs of particles within reach: hashed cells, so that memory depends on n alone, never on the extent. */
#ifndef CLAST_ENGINE_SPH_NEIGHBOURS_H
#define CLAST_ENGINE_SPH_NEIGHBOURS_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Neighbours j > i of particle i are j[first[i]] .. j[first[i+1]-1], ascending. */
struct sph_neighbours {
  size_t n, count, capacity;
  size_t *first;
  uint32_t *j;
};

/* All pairs with r < (h_i + h_j) (1 + skin); minimum image along axes whose `periodic` length is not NaN (at least twice
 * the largest reach). Grows `lists`. STATUS_MEMORY, STATUS_CONTENT (a periodic box that is too thin). */
status sph_neighbours_find(size_t n, const double *x, const double *y, const double *z, const double *h, double skin,
                           const double periodic[3], struct sph_neighbours *lists, struct error *error);
void sph_neighbours_clear(struct sph_neighbours *lists);

#endif
