/* Independent draws: coordinate d of point i is a counter-based random number, so that point i is the same whatever the
 * number of points, and a longer design contains the shorter one. */
#include "engine/random.h"
#include "campaign/design/design.h"

double design_random_coordinate(uint64_t seed, uint64_t i, size_t dimension) {
  return random_draw(seed, RANDOM_DESIGN, i, dimension);
}
