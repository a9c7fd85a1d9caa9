/* Artificial stress against clumping in tension: a term of the pair loop. It makes R from the stress of each particle,
 * and adds f^n (R_i + R_j) to each pair.
 *
 *   method.artificial_stress   Monaghan's epsilon; 0: none
 *
 * The factor f^n belongs to a pair, so that R is conjugate to no velocity gradient and its power is not sigma : eps.
 * The pair loop sums the power pair by pair, and each of the two particles gets half of it as internal energy. Total
 * energy is then conserved. R grows as two particles come close, and it can take more energy than was stored: the
 * internal energy of a particle is then held at zero, and the ledger counts the difference (energy.clamped). */
#include "engine/sph/modules/ranges.h"

#define INPUTS sph_artificial_stress_inputs

static const struct field input_rows[] = {
    INPUT_REAL(method.artificial_stress, epsilon, "1", 0, 0, 1,
               .doc = "Monaghan's epsilon against clumping in tension, for bodies that do not crack. 0: it is absent.",
               .source = "Monaghan 2000; Gray, Monaghan & Swift 2001"),
};
const struct field_table sph_artificial_stress_inputs = SPH_MODULE_TABLE(sph_artificial_stress_inputs, input_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->artificial_stress.epsilon > 0;
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
