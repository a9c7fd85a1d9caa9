/* Deviatoric stress of a solid: Hooke's law in a turning frame, up to the yield limit (elastic.h).
 *
 *   material.shear_modulus   mu: needed
 *   material.yield_stress    needed, may be off (the body never yields); the laws of yield read it
 *
 * It reads two_mu where a module publishes an effective one, and the terms' yield_limit where a yield law sets one. */
#include <math.h>

#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_elastic_material

static const struct field material_rows[] = {
    MATERIAL_REAL(bulk_modulus, bulk_modulus, "Pa", NAN, 1, 1e15, .flags = FIELD_MAY_BE_OFF, .when = "../strength=true",
                  .doc = "K where Young's modulus and the speed of cracks are made from it. off: tillotson.A.",
                  .source = "Benz & Asphaug 1995, eq. 21"),
    MATERIAL_REAL(shear_modulus, shear_modulus, "Pa", NAN, 1, 1e15, .flags = FIELD_MAY_BE_OFF,
                  .when = "../strength=true", .doc = "mu: shear modulus.", .source = "Benz & Asphaug 1995, eq. 6"),
};
const struct field_table sph_elastic_material = SPH_MODULE_TABLE(sph_elastic_material, material_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength;
}

static status check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                    size_t last, struct error *error) {
  const struct sph_material *m = &body->material;
  (void)particles, (void)first, (void)last;
  if (!(isfinite(m->elastic.shear_modulus) && m->elastic.shear_modulus >= 0))
    return status_fail(error, STATUS_CONTENT, "shear_modulus is %g; a body with strength needs a number not below 0",
                       m->elastic.shear_modulus);
  if (!(m->yield.stress >= 0)) /* infinite: never yields */
    return status_fail(error, STATUS_CONTENT, "yield_stress is %g; a body with strength needs one", m->yield.stress);
  return STATUS_OK;
}

/* The particles' stress without its trace. */
static void fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  for (size_t i = body->first; p->stress[0] && i < body->last; i++) {
    const double third = (p->stress[0][i] + p->stress[3][i] + p->stress[5][i]) / 3;
    for (int k = 0; k < 5; k++)
      s->c.stress[k][i] = p->stress[k][i] - (k == 0 || k == 3 ? third : 0);
  }
}

static const struct sph_column_need columns[] = {{SPH_COLUMNS_OF(stress), 0, NULL},
                                                 {SPH_COLUMNS_OF(stress_rate), 0, NULL},
                                                 {SPH_COLUMNS_OF(stress_factor), 0, NULL},
                                                 {0}};

const struct sph_module sph_elastic_module = {
    .name = "elastic",
    .doc = "Deviatoric stress by Hooke's law in the particle's turning frame: dS/dt = 2 mu dev(eps) + R S - S R "
           "(Jaumann).",
    .source =
        "Benz & Asphaug 1995, eqs. 6-7, with the sign of the rotation terms that keeps a rigidly turning body's stress",
    .when = "a body with strength",
    .on = on,
    .columns = columns,
    .check = check,
    .fill = fill,
};
