/* Sums of the pair loop in arrays of all particles, for tests and benchmarks: engine/sph/pairs/pairs.h delivers them
 * piece by piece. */
#pragma once

#include <string.h>

#include "engine/sph/pairs/pairs.h"

static inline void pair_sums_copy(double *to, size_t first, size_t count, const double *from) {
  if (to && from)
    memcpy(to + first, from, count * sizeof *to);
}

/* A sph_pairs_take; `context` is a struct sph_pair_sums with the complete arrays. */
static inline void pair_sums_keep(void *context, size_t first, size_t count, const struct sph_pair_sums *sums) {
  struct sph_pair_sums *all = context;
  pair_sums_copy(all->ax, first, count, sums->ax);
  pair_sums_copy(all->ay, first, count, sums->ay);
  pair_sums_copy(all->az, first, count, sums->az);
  pair_sums_copy(all->heating, first, count, sums->heating);
  pair_sums_copy(all->signal, first, count, sums->signal);
  pair_sums_copy(all->power, first, count, sums->power);
  for (int k = 0; k < 9; k++)
    pair_sums_copy(all->gradient[k], first, count, sums->gradient[k]);
  for (int k = 0; k < 6; k++)
    pair_sums_copy(all->correction[k], first, count, sums->correction[k]);
  pair_sums_copy(all->correction_share[0], first, count, sums->correction_share[0]);
}
