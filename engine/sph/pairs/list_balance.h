/* Whole batches. A list is summed so many neighbours at a time, and what its last batch has less is worked out for
 * nothing: one lane in six where two particles share a list (16 at a time), one in nine where none do (8). But whether
 * a pair stands in the list of the one or the other is all the same to the sums: so each list hands to later ones what
 * it has beyond whole batches of SPH_LIST_ALIGN, and whatever is shorter there. */
#ifndef CLAST_ENGINE_SPH_PAIRS_LIST_BALANCE_H
#define CLAST_ENGINE_SPH_PAIRS_LIST_BALANCE_H

#include <stdbool.h>
#include <stddef.h>

#include "engine/sph/pairs/neighbours.h"

/* Of a chunk of `own` particles, lists shared by `share`, one or two, as sph_neighbours_list made them; afterwards
 * particles before a list's first may stand in it, in front of the others; every pair is still met once, and entries
 * are numbers alone. lists->j is another array then. False without memory. */
bool sph_list_balance(size_t own, size_t share, struct sph_neighbour_lists *lists);

#endif
