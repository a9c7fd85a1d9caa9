/* Places fragments side by side in a picture, so that none hides another. */
#pragma once

#include "analysis/pictures/picture.h"

struct picture_layout_disc {
  double x, y, radius, depth; /* m; discs are drawn by ascending depth */
  uint32_t id;                /* of its particle */
};

/* Moves the discs of each fragment together. The heaviest fragment stays. The others, by descending mass, move away
 * from its centre in their own direction until they do not overlap. Every disc's particle must belong to a fragment.
 * STATUS_MEMORY. */
status picture_layout_apart(const struct picture_cloud *cloud, size_t count, struct picture_layout_disc *discs);
