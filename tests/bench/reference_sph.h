/* The pair loop in plain C: the frozen reference of bench_sph, with which unit tests compare the fast kernels. It is no
 * part of the program. */
#pragma once

#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"

/* Neighbours j > i of i: j[start[i]] .. j[start[i] + count[i] - 1], ascending. */
struct reference_sph_lists {
  size_t *start;
  uint32_t *count, *j;
};

/* Makes those lists from the result of sph_neighbours_list for chunks of `chunk` particles; arguments as for
 * sph_neighbours_find. Lists that break the rules of pairs/lists.h are an error. */
status reference_sph_lists_make(size_t n, size_t chunk, const double *const at[3], const double *reach,
                                const double periodic[3], int threads, struct reference_sph_lists *out,
                                struct error *error);
void reference_sph_lists_free(struct reference_sph_lists *lists);

/* No correction of the gradient. `stress` and `artificial` are six columns of n: the acting part of the deviator over
 * rho^2 (read with strength only), and R, which may be NULL. */
void reference_sph_sum(size_t n, const size_t *start, const uint32_t *count, const uint32_t *j,
                       const struct sph_pair_options *options, const struct sph_pair_fields *fields,
                       const double *const *stress, const double *const *artificial, const struct sph_pair_sums *sums);

/* Monaghan's artificial stress of one particle: -epsilon times the tensile part of a stress (xx xy xz yy yz zz). */
void reference_sph_opposed(double epsilon, const double stress[6], double artificial[6]);
