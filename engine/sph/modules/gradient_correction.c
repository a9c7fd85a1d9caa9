#include "engine/sph/modules/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->method.gradient_correction;
}

const struct sph_module sph_gradient_correction_module = {
    .name = "gradient_correction",
    .doc = "Velocity gradients are exact for linear fields, also at surfaces, and forces are conjugate to them: a "
           "rigid rotation "
           "strains nothing, energy and angular momentum keep, free sides are as stiff as the inside.",
    .source = "Randles & Libersky 1996; Bonet & Lok 1999 (Comput. Methods Appl. Mech. Eng. 180, 97)",
    .when = "gradient_correction is asked for",
    .on = on,
    .bytes = (6 + 5) * sizeof(double), /* B, and wider records of what foreign particles get (pairs.c) */
    .hook = {0},
};
