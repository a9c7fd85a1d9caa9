/* A spall strength for matter without flaws, and torn matter (tension_limit.h).
 *
 *   material.tension_limit   Pa; off: no limit
 *
 * It reads the density of the solid matter that the equation of state publishes; it bounds the pressure and lowers the
 * yield limit. */
#include <math.h>

#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_tension_limit_material

static const struct field material_rows[] = {
    MATERIAL_REAL(tension_limit, pressure, "Pa", NAN, 0, 1e15, .flags = FIELD_MAY_BE_OFF,
                  .doc = "Largest tension of a body without flaws (its lowest pressure is minus this). It falls with "
                         "expansion, to none at 0.9 of the density, so that cold matter reaches 1/(1 + 10 "
                         "tension_limit/A) of it. off: no limit, down to -A and beyond."),
};
const struct field_table sph_tension_limit_material = SPH_MODULE_TABLE(sph_tension_limit_material, material_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return !body->flaws && body->material.tension_limit.pressure >= 0 && isfinite(body->material.tension_limit.pressure);
}

const struct sph_module sph_tension_limit_module = {
    .name = "tension_limit",
    .doc =
        "Pressure is not below -tension_limit: a spall strength for matter without flaws. It falls with expansion "
        "and is gone at "
        "0.9 of the density: torn matter does not pull (nor shear), or P/rho^2 of thin debris would grow without "
        "bound. "
        "It is that of the body as it is, whatever the density of its solid matter: so tensile and spall strengths are "
        "measured.",
    .source = "Asphaug & Melosh 1993; the fall with expansion, and that it is the strength of the body as it is, are "
              "our choices",
    .when = "a material with a tension_limit in a body without flaws",
    .on = on,
};
