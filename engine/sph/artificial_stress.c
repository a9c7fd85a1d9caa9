/* R of the stress before the pair loop, f^n (R_i + R_j) in it: pairs_kernels_tension.h, pairs_kernels_sum.h.
 *
 * Its work is booked nowhere, so that the energy error of a run contains it: with the factor f^n of each pair R is conjugate to no
 * gradient that a particle knows, no stored energy belongs to it, and what it takes on the way apart differs from what it gives
 * back on the way together. To book it the pair loop would have to sum the power of f^n (R_i + R_j) by itself, pair by pair. */
#include "engine/sph/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_parameters *p) {
  (void)body, (void)p;
  return p->artificial_stress > 0;
}

const struct sph_module sph_artificial_stress_module = {
    .name = "artificial_stress",
    .doc = "Repulsion between particles under tension, against their clumping: for elastic bodies that do not crack.",
    .source = "Monaghan 2000; Gray, Monaghan & Swift 2001",
    .when = "artificial_stress above 0",
    .on = on,
    .bytes = 0,
    .hook = {0},
};
