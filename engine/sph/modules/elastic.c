#include "engine/sph/modules/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return body->strength;
}

const struct sph_module sph_elastic_module = {
    .name = "elastic",
    .doc = "Deviatoric stress by Hooke's law in the particle's turning frame: dS/dt = 2 mu dev(eps) + R S - S R "
           "(Jaumann).",
    .source =
        "Benz & Asphaug 1995, eqs. 6-7, with the sign of the rotation terms that keeps a rigidly turning body's stress",
    .when = "a body with strength",
    .on = on,
    .bytes = (5 + 5 + 1) * (int)sizeof(double),
    .hook = {[SPH_PREDICT] = offsetof(struct sph_ranges, elastic_predict),
             [SPH_RATES] = offsetof(struct sph_ranges, elastic_rates)},
};
