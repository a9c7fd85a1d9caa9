#include "engine/sph/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_parameters *p) {
  (void)body, (void)p;
  return p->gradient_correction;
}

const struct sph_module sph_gradient_correction_module = {
    .name = "gradient_correction",
    .doc = "The velocity gradient is exact for linear fields, also at surfaces: a rigid rotation strains nothing, and "
           "angular momentum keeps. Energy follows the uncorrected gradient, which balances the forces.",
    .source = "Randles & Libersky 1996",
    .when = "gradient_correction is asked for",
    .on = on,
    .bytes = 7 * sizeof(double), /* with the moment of the pair loop */
    .hook = {0},
};
