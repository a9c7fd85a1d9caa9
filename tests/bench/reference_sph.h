/* The pair loop in plain C: the frozen yardstick of bench_sph, and what the unit tests hold the fast kernels to. It takes no
 * part in the program. */
#ifndef CLAST_TESTS_BENCH_REFERENCE_SPH_H
#define CLAST_TESTS_BENCH_REFERENCE_SPH_H

#include "engine/sph/pairs.h"

/* Neighbours j > i of i: j[start[i]] .. j[start[i] + count[i] - 1]. No correction of the gradient. `artificial` (six columns of
 * n) may be NULL. */
void reference_sph_sum(size_t n, const size_t *start, const uint32_t *count, const uint32_t *j,
                       const struct sph_pair_options *options, const struct sph_pair_fields *fields,
                       const double *const *artificial, const struct sph_pair_sums *sums);

#endif
