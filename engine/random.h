/* Counter-based random numbers (Random123 Philox4x64-10): a draw depends on (seed, purpose, item, draw) alone, never on
 * order, threads or restarts. A test compares known-answer vectors. */
#pragma once

#include <stdint.h>

enum random_purpose { /* values never change: they are part of the meaning of a seed */
                      RANDOM_LATTICE = 1,
                      RANDOM_THRESHOLD = 2,
                      RANDOM_FLAW_STRENGTH = 3,
                      RANDOM_FLAW_PLACE = 4,
                      RANDOM_DESIGN = 5,
                      RANDOM_SEED = 6,
                      RANDOM_RESAMPLE = 7,
                      RANDOM_CELL = 8,
                      RANDOM_INFERENCE = 9,
};

void random_bits(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw, uint64_t bits[4]);
/* Uniform in [0, 1) with 53 bits, from `bits` of the call above. */
double random_uniform(uint64_t bits);
/* One uniform in [0,1): first word of (seed, purpose, item, draw). */
double random_draw(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw);
/* Uniform over rotations [Shoemake 1992]. */
void random_rotation(uint64_t seed, uint64_t purpose, uint64_t item, uint64_t draw, double matrix[3][3]);
