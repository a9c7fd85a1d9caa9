/* Philox counters behind the random numbers of all engines. */
#include "engine/random.h"

#include <math.h>
#include <string.h>

/* Random123's headers raise -Wconversion warnings. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

/* Philox4x64-10 (Salmon, Moraes, Dror & Shaw 2011): key = (seed, 0), counter = (draw, item, purpose, 0). */
void random_bits(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw, uint64_t bits[4]) {
  philox4x64_ctr_t counter = {{draw, item, purpose, 0}};
  philox4x64_key_t key = {{seed, 0}};
  philox4x64_ctr_t out = philox4x64(counter, key);
  for (int i = 0; i < 4; i++)
    bits[i] = out.v[i];
}

double random_uniform(uint64_t bits) {
  return (double)(bits >> 11) * 0x1p-53;
}

double random_draw(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw) {
  uint64_t bits[4];
  random_bits(seed, purpose, item, draw, bits);
  return random_uniform(bits[0]);
}

void random_rotation(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw, double matrix[3][3]) {
  uint64_t bits[4];
  random_bits(seed, purpose, item, draw, bits);
  const double u = random_uniform(bits[0]);
  const double a = 2 * M_PI * random_uniform(bits[1]), b = 2 * M_PI * random_uniform(bits[2]);
  const double x = sqrt(1 - u) * sin(a), y = sqrt(1 - u) * cos(a), z = sqrt(u) * sin(b), w = sqrt(u) * cos(b);
  const double of_quaternion[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  memcpy(matrix, of_quaternion, sizeof of_quaternion);
}
