#include "engine/sph/modules/modules.h"

/* The order, and why. Stages come first (modules.h); within a stage:
 *   pressure before the tension limit that cuts it;
 *   equations of state first: distention changes P, the stored deviator, the yield stress and damage;
 *   yield before the flaws: the stress that opens flaws is one that the solid can bear;
 *   flaws before the damaged stress, which every body's own output loop makes last: D of this step acts in this step;
 *   the pair loop's own options (viscosity, artificial stress, gradient correction) have no hooks: they are in it. */
static const struct sph_module *const list[] = {
    &sph_elastic_module,
    &sph_tillotson_module,
    &sph_palpha_module,
    &sph_tension_limit_module,
    &sph_yield_module,
    &sph_weibull_module,
    &sph_fracture_module,
    &sph_viscosity_module,
    &sph_artificial_stress_module,
    &sph_gradient_correction_module,
};

size_t sph_modules_count(void) {
  return sizeof list / sizeof *list;
}

const struct sph_module *sph_modules_at(size_t index) {
  return list[index];
}
