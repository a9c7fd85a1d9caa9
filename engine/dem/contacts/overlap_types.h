/* Two convex outlines and their overlap. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_OVERLAP_TYPES_H
#define CLAST_ENGINE_DEM_CONTACTS_OVERLAP_TYPES_H

#include "engine/dem/step/system_layout.h"

/* Vertices counter-clockwise, about any origin; entries from `count` to its next multiple of eight, and one more,
 * repeat the first. */
struct dem_ring {
  size_t count;
  double x[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED, y[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED;
};

/* Last entry in use: the vertices, padded to a whole number of blocks, and one more. */
static inline size_t dem_overlap_last(const struct dem_ring *ring) {
  return (ring->count + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
}

struct dem_overlap {
  bool apart;                /* separated by a side; then only the axis below and `gap` are set */
  double gap;                /* m, along the best separating side; negative: penetration */
  int owner;                 /* whose side it is: 0 or 1 */
  size_t side, vertex;       /* that side, and the other's nearest vertex to it */
  double origin_x, origin_y; /* of the sums */
  double twice_area, chord_x, chord_y, moment, xx, xy, yy; /* see contact_law.h */
};

#endif
