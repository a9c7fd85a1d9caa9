#include "engine/sph/modules/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return body->strength && isfinite(body->material.yield_stress);
}

const struct sph_module sph_yield_module = {
    .name = "yield",
    .doc = "Von Mises: the deviator returns radially to sqrt(3 J2) = Y, with Y = Y0 (1 - u/u_melt) and 0 beyond.",
    .source = "Benz & Asphaug 1995, eqs. 8-10, with the square root that eq. 9 lacks",
    .when = "a body with strength whose yield_stress is finite",
    .on = on,
    .bytes = 0,
    .hook = {[SPH_RESPOND] = offsetof(struct sph_ranges, yield)},
};
