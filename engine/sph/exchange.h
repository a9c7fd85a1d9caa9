/* Whole batches. A list is summed so many neighbours at a time (SPH_LIST_ALIGN), and what its last batch has less is worked out
 * for nothing: one lane in six where two particles share a list. But whether a pair stands in the list of the one or the other is all
 * the same to the sums: so each list hands to later ones what it has beyond whole batches. */
#ifndef CLAST_ENGINE_SPH_EXCHANGE_H
#define CLAST_ENGINE_SPH_EXCHANGE_H

#include <stdbool.h>
#include <stddef.h>

#include "engine/sph/neighbours.h"

/* Where particles stand and how far they reach, from the chunk's first one on; periods: NaN = open. */
struct sph_exchange_places {
  const double *x, *y, *z, *reach, *periodic;
};

/* Of a chunk of `own` particles, lists as sph_neighbours_list made them; afterwards particles before a list's first may stand
 * in it, in front of the others, and every pair is still met once. False without memory. */
bool sph_exchange(const struct sph_exchange_places *places, size_t own, size_t share, struct sph_neighbour_lists *lists);

#endif
