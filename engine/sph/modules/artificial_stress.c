/* R of the stress before the pair loop, f^n (R_i + R_j) in it: pairs_kernels_tension.h, pairs_kernels_sum.h.
 *
 * With the factor f^n of each pair R is conjugate to no gradient that a particle knows, so that its power is no sigma :
 * eps: the pair loop sums it pair by pair, and half of it goes to each of the two particles' internal energies, as the
 * work of any other stress does. Total energy is conserved then. R pushes the more the nearer two are, and so it can
 * take more than was stored: a particle whose internal energy would fall below zero is held there, which is booked
 * (energy.clamped). */
#include "engine/sph/modules/ranges.h"

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->method.artificial_stress > 0;
}

const struct sph_module sph_artificial_stress_module = {
    .name = "artificial_stress",
    .doc = "Repulsion between particles under tension, against their clumping: for elastic bodies that do not crack.",
    .source = "Monaghan 2000; Gray, Monaghan & Swift 2001",
    .when = "artificial_stress above 0",
    .on = on,
    .bytes_in_pairs = 6 * sizeof(double), /* R */
    .cost = 70,
};
