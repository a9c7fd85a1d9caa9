/* Artificial viscosity: a term of the pair loop that is always compiled in.
 *
 *   viscosity.alpha, viscosity.beta   linear and quadratic; both 0: none */
#include "engine/sph/modules/ranges.h"

#define INPUTS sph_viscosity_inputs

static const struct field input_rows[] = {
    INPUT_REAL(viscosity.alpha, alpha, "1", 1.5, 0, 100, .doc = "Monaghan's linear artificial viscosity.",
               .source = "Monaghan 1992"),
    INPUT_REAL(viscosity.beta, beta, "1", 3, 0, 100, .doc = "Monaghan's quadratic artificial viscosity.",
               .source = "Monaghan 1992"),
};
const struct field_table sph_viscosity_inputs = SPH_MODULE_TABLE(sph_viscosity_inputs, input_rows);

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
