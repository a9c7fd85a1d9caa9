/* Tools of all loops over particles; and, where RANGES_TABLE is set, the loops of all modules and their table, for one
 * CPU class. These are plain loops that GCC vectorises. The result of a particle depends on no other
 * particle of the loop, so that the width of the vectors changes bits only through contraction to FMA. */
#pragma once

#include <math.h>
#include <string.h>

#include "engine/sph/material/palpha.h"
#include "engine/sph/step/system.h"

#ifdef __clang__
#define RANGE_LOOP _Pragma("clang loop vectorize(assume_safety)")
#else
#define RANGE_LOOP _Pragma("GCC ivdep") /* columns do not overlap */
#endif
#define RANGE_INLINE static inline __attribute__((always_inline, unused))
#define RANGE_HOOK   static __attribute__((unused))

RANGE_INLINE double range_larger(double a, double b) {
  return a > b ? a : b;
}
RANGE_INLINE double range_smaller(double a, double b) {
  return a < b ? a : b;
}

/* D^(1/3) that scales the deviator: all damage, unless a module publishes another. */
RANGE_INLINE const double *range_shear_damage(const struct sph_system *s, const struct sph_solid *body) {
  return sph_solid_has(body, SPH_COLUMN(shear_damage)) ? s->c.shear_damage : s->c.damage;
}

/* Largest of n values that are not negative (n <= SPH_BLOCK); eight running maxima, so that it vectorises. */
RANGE_INLINE double range_largest(const double *value, size_t n) {
  double most[8] = {0};
  size_t k = 0;
  for (; k + 8 <= n; k += 8)
    for (int lane = 0; lane < 8; lane++)
      most[lane] = range_larger(value[k + (size_t)lane], most[lane]);
  for (; k < n; k++)
    most[0] = range_larger(value[k], most[0]);
  for (int lane = 1; lane < 8; lane++)
    most[0] = range_larger(most[lane], most[0]);
  return most[0];
}

#ifdef RANGES_TABLE

#define SPH_MODULE_LOOPS
#include "engine/sph/modules/declarations.h"

const struct sph_ranges RANGES_TABLE = {
    .module =
        {
#define MODULE_HOOKS(name) [SPH_MODULE_##name] = name##_hooks,
#include "engine/sph/modules/declarations.h"
        },
    .predict = motion_predict,
    .output_fluid = motion_output_fluid,
    .output_whole = motion_output_whole,
    .output_damaged = motion_output_damaged,
    .hold = motion_hold,
    .fluid_rates = motion_fluid_rates,
    .correct_fluid = motion_correct_fluid,
    .correct_whole = motion_correct_whole,
    .correct_damaged = motion_correct_damaged,
};

#endif
