/* Artificial viscosity: a term of the pair loop (pairs/pairs_kernels_sum.h).
 *
 *   viscosity.alpha, viscosity.beta   linear and quadratic; both 0: none */
#include "engine/sph/modules/ranges.h"

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->viscosity.alpha > 0 || inputs->viscosity.beta > 0;
}

const struct sph_module sph_viscosity_module = {
    .name = "viscosity",
    .doc = "Monaghan's artificial viscosity on approaching pairs, damaged ones included, and its heating.",
    .source = "Monaghan 1992; Benz & Asphaug 1995, section 4.1",
    .when = "viscosity alpha or beta above 0",
    .on = on,
};
