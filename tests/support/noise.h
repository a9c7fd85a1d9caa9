/* Numbers for tests, by splitmix64: the same on every machine. */
#pragma once

#include <stdint.h>

static inline double noise(uint64_t *state) { /* -1/2..1/2 */
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return (double)((z ^ z >> 31) >> 11) * 0x1p-53 - 0.5;
}
