#include "engine/sph/modules/ranges.h"

#include <math.h>

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
    .bytes = 0,
    .hook = {0},
};
