/* Latin hypercube (McKay, Beckman & Conover 1979): each dimension is cut into as many strata as there are points, and
 * each stratum holds one point. The strata's order is a pseudo-random permutation per dimension that needs no table: a
 * Feistel network over the next power of four, walked along its cycle until it lands inside (Black & Rogaway 2002), so
 * that a design of a million points needs no memory and point i is computed directly. */
#include <math.h>

#include "campaign/design/design.h"
#include "engine/random.h"

enum {
  ROUNDS = 8
}; /* Luby & Rackoff 1988 prove that 4 give a strong permutation; doubled for the small domains here */
#define PERMUTATION_MARK (UINT64_C(1) << 63) /* differs from the draws within strata, which count items from 0 */

uint64_t design_latin_permute(uint64_t seed, size_t dimension, uint64_t points, uint64_t i) {
  if (points < 2)
    return 0;
  unsigned half = 1;
  while (half < 31 && (UINT64_C(1) << (2 * half)) < points)
    half++;
  uint64_t mask = (UINT64_C(1) << half) - 1;
  do {
    uint64_t left = i >> half, right = i & mask;
    for (uint64_t round = 0; round < ROUNDS; round++) {
      uint64_t bits[4];
      random_bits(seed, RANDOM_DESIGN, PERMUTATION_MARK | round << 32 | dimension, right, bits);
      uint64_t next = left ^ (bits[0] & mask);
      left = right;
      right = next;
    }
    i = left << half | right;
  } while (i >= points);
  return i;
}

double design_latin_coordinate(uint64_t seed, uint64_t points, uint64_t i, size_t dimension) {
  double within = random_draw(seed, RANDOM_DESIGN, i, dimension);
  double stratum = (double)design_latin_permute(seed, dimension, points, i);
  /* Rounding must not carry the point over its stratum's upper edge. */
  double upper = nextafter((stratum + 1) / (double)points, 0);
  return fmin((stratum + within) / (double)points, upper);
}
