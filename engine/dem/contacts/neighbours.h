/* Finds pairs that can come into contact soon: a hashed cell grid, and lists that stay valid until a grain has left its
 * skin. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H
#define CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H

#include "engine/dem/step/system_layout.h"

/* Makes the near list and repacks the bond blocks, from the present positions. Every pair whose gap is less than the
 * sum of its two skins is in one of them afterwards. A skin grows with its grain's speed, so that a few fast grains do
 * not force a new list all the time. False: no memory; the list is then incomplete. */
bool dem_neighbours_make(struct dem_system *system);

/* Stores the side that keeps a near pair apart. */
void dem_neighbours_cache_side(struct dem_system *system, uint32_t near, const struct dem_overlap *overlap);

#endif
