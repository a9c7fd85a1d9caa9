/* Hilbert's curve through the cube around the particles, and the sort along it. */
#include "engine/sph/body/kd_tree.h"

#include <math.h>
#include <stdlib.h>

#include "schemas/memory.h"

struct key {
  uint64_t axis[3];
  uint32_t id;
};

enum { BITS = 62 }; /* bits per coordinate: cells of a millimetre across 1e15 m */

/* Turns coordinates into Hilbert's index: its bits are the bits of axis 0, 1, 2 in turn (Skilling 2004, AIP Conf. Proc.
 * 707, 381). */
static void follow_curve(uint64_t axis[3]) {
  for (uint64_t bit = (uint64_t)1 << (BITS - 1); bit > 1; bit >>= 1)
    for (int d = 0; d < 3; d++) { /* a cell is inverted, or its axes are exchanged */
      const uint64_t below = bit - 1, turn = -(uint64_t)((axis[d] & bit) != 0);
      const uint64_t exchange = (axis[0] ^ axis[d]) & below & ~turn;
      axis[0] ^= (below & turn) ^ exchange;
      axis[d] ^= exchange;
    }
  axis[1] ^= axis[0];
  axis[2] ^= axis[1];
  uint64_t turned = 0;
  for (uint64_t bit = (uint64_t)1 << (BITS - 1); bit > 1; bit >>= 1)
    if (axis[2] & bit)
      turned ^= bit - 1;
  for (int d = 0; d < 3; d++)
    axis[d] ^= turned;
}

/* Is the highest set bit of a below that of b? */
static int lower_bit(uint64_t a, uint64_t b) {
  return a < b && a < (a ^ b);
}

static int compare(const void *left, const void *right) {
  const struct key *a = left, *b = right;
  int axis = 0;
  uint64_t highest = 0;
  for (int d = 0; d < 3; d++) {
    uint64_t difference = a->axis[d] ^ b->axis[d];
    if (lower_bit(highest, difference)) {
      highest = difference;
      axis = d;
    }
  }
  if (a->axis[axis] != b->axis[axis])
    return a->axis[axis] < b->axis[axis] ? -1 : 1;
  return a->id < b->id ? -1 : a->id > b->id;
}

status sph_hilbert_find(size_t n, const double *x, const double *y, const double *z, uint32_t *order,
                        struct error *error) {
  const double *place[3] = {x, y, z};
  OWNED struct key *keys = malloc((n ? n : 1) * sizeof *keys);
  if (!keys)
    return status_fail(error, STATUS_MEMORY, "no memory to sort %zu particles", n);
  double lowest[3], extent = 0;
  for (int d = 0; d < 3; d++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
      low = fmin(low, place[d][i]);
      high = fmax(high, place[d][i]);
    }
    lowest[d] = low;
    extent = fmax(extent, high - low);
  }
  double scale = extent > 0 && isfinite(extent) ? 4.6e18 / extent : 0; /* below 2^BITS */
  for (size_t i = 0; i < n; i++) {
    keys[i].id = (uint32_t)i;
    for (int d = 0; d < 3; d++) {
      double t = (place[d][i] - lowest[d]) * scale;
      keys[i].axis[d] = t > 0 ? (uint64_t)t : 0; /* numbers that are not finite come first; the step fails elsewhere */
    }
    follow_curve(keys[i].axis);
  }
  qsort(keys, n, sizeof *keys, compare);
  for (size_t i = 0; i < n; i++)
    order[i] = keys[i].id;
  return STATUS_OK;
}
