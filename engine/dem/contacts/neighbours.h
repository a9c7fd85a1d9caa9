/* Finds pairs that can come into contact soon: a hashed cell grid, and lists that stay valid until a grain has left its
 * skin. Also the outlines of grains and their overlap, as the general overlap (overlap.h) takes and gives them. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H
#define CLAST_ENGINE_DEM_CONTACTS_NEIGHBOURS_H

#include "engine/dem/step/system_layout.h"

/* A convex outline: vertices counter-clockwise, about any origin. The entries from `count` to its next multiple of
 * eight, and one more, repeat the first vertex. */
struct dem_ring {
  size_t count;
  double x[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED, y[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED;
};

/* The last entry in use. */
static inline size_t dem_overlap_last(const struct dem_ring *ring) {
  return (ring->count + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
}

struct dem_overlap {
  bool apart;                /* a side separates the two; then only that side and `gap` are set */
  double gap;                /* m, along the best separating side; negative: penetration */
  int owner;                 /* whose side it is: 0 or 1 */
  size_t side, vertex;       /* that side, and the vertex of the other that is nearest to it */
  double origin_x, origin_y; /* of the sums */
  double twice_area, chord_x, chord_y, moment, xx, xy, yy; /* see contact_force.h */
};

/* Makes the near list and repacks the bond blocks, from the present positions. Every pair whose gap is less than the
 * sum of its two skins is in one of them afterwards. A skin grows with its grain's speed, so that a few fast grains do
 * not force a new list all the time. False: no memory; the list is then incomplete. */
bool dem_neighbours_make(struct dem_system *system);

/* Writes the outline of a grain, in its present orientation and shifted by (dx, dy) from its own centre. */
void dem_neighbours_ring(const struct dem_system *system, uint32_t grain, double dx, double dy, struct dem_ring *ring);

/* Stores the side that keeps a near pair apart. */
void dem_neighbours_cache_side(struct dem_system *system, uint32_t near, const struct dem_overlap *overlap);

#endif
