/* Von Mises' yield limit, Y0 (1 - u/u_melt) and 0 beyond (yield.h).
 *
 *   material.yield_stress   Y0; off: the body never yields
 *   material.melt_energy    u_melt; off: the limit does not depend on the energy
 *
 * Another yield law is a module like this one: its loop of the stage SPH_YIELD writes the terms' yield_limit, a bound
 * of sqrt(3 J2) of the solid's stress in Pa, and its descriptor sets SPH_SETS_YIELD_LIMIT. In list.h it comes after
 * this one and before tension_limit; where it is on, this one is off. It may read pressure (of the body), density,
 * energy and, where sph_solid_has(body, SPH_COLUMN(damage)), the predicted D^(1/3). */
#include <math.h>

#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_yield_material

static const struct field material_rows[] = {
    MATERIAL_REAL(yield_stress, stress, "Pa", NAN, 0, 1e15, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
                  .when = "../strength=true",
                  .doc = "Y_0: von Mises yield stress of cold solid matter. off: elastic at any stress.",
                  .source = "Benz & Asphaug 1995, eq. 9"),
};
const struct field_table sph_yield_material = SPH_MODULE_TABLE(sph_yield_material, material_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength && isfinite(body->material.yield.stress);
}

const struct sph_module sph_yield_module = {
    .name = "yield",
    .doc = "Von Mises: the deviator returns radially to sqrt(3 J2) = Y, with Y = Y0 (1 - u/u_melt) and 0 beyond.",
    .source = "Benz & Asphaug 1995, eqs. 8-10, with the square root that eq. 9 lacks",
    .when = "a body with strength whose yield_stress is finite",
    .on = on,
    .sets = SPH_SETS_YIELD_LIMIT,
};
