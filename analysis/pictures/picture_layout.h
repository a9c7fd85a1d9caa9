/* Fragments side by side in a picture: none hides another. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_LAYOUT_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_LAYOUT_H

#include "analysis/pictures/picture_cloud.h"

struct picture_layout_disc {
  double x, y, radius, depth; /* m; discs are drawn by ascending depth */
  uint32_t id;                /* of its particle */
};

/* Moves the discs of each fragment together. The heaviest stays; the others, by descending mass, go away from its
 * centre in the direction in which they are, as far as they must to stand free. Every disc's particle has a fragment.
 * STATUS_MEMORY. */
status picture_layout_apart(const struct picture_cloud *cloud, size_t count, struct picture_layout_disc *discs);

/* Which share of each fragment's outline can be seen when all discs are drawn in their order: visible[f] for fragments
 * 0 .. fragments - 1; 1 for one that has no disc. STATUS_MEMORY. */
status picture_layout_visible(const struct picture_cloud *cloud, size_t count, const struct picture_layout_disc *discs,
                              size_t fragments, double *visible);

#endif
