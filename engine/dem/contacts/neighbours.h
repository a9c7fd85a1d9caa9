/* Which pairs can touch soon: a hashed cell grid, and lists that hold until some grain has moved out of its skin. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H
#define CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H

#include "engine/dem/contacts/overlap_types.h"
#include "engine/dem/step/system_layout.h"

/* Make the near list and repack the bond blocks, from the positions now. Every pair whose gap is less than the sum of
 * its two skins is in one of them afterwards. A skin grows with its grain's speed, so that a few fast grains do not
 * force the whole list to be made again all the time. False: out of memory (nothing is lost but the list). */
bool dem_neighbours_make(struct dem_system *system);

/* Outline of a grain, turned as it is now, shifted by (dx, dy) from its own centre. */
void dem_neighbours_ring(const struct dem_system *system, uint32_t grain, double dx, double dy, struct dem_ring *ring);

/* Remember the side that keeps a near pair apart. */
void dem_neighbours_cache_side(struct dem_system *system, uint32_t near, const struct dem_overlap *overlap);

#endif
