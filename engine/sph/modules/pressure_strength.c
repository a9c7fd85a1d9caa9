/* Yield stress of rock under pressure: intact rock by Lundborg's law, broken rock by friction (pressure_strength.h
 * has the equations).
 *
 *   material.pressure_strength.law               lundborg turns the module on; yield_stress is not used then
 *   material.pressure_strength.intact_cohesion   Y_0
 *   material.pressure_strength.intact_friction   mu_i
 *   material.pressure_strength.intact_limit      Y_M
 *   material.pressure_strength.broken_cohesion   Y_d0
 *   material.pressure_strength.broken_friction   mu_d
 *   material.melt_energy                         u_melt; off: the limit does not depend on the energy
 *
 * Y bounds sqrt(J2), as in Collins, Melosh & Ivanov 2004, where Y is a shear strength (tau = Y_0 + mu P) and 90 MPa,
 * 2.0 and 1.5 GPa are values for it. The program's yield limit bounds sqrt(3 J2), so the loop publishes sqrt(3) Y.
 *
 * Damage acts on the deviator through Y and not as a factor. The module publishes the column shear_damage, the D^(1/3)
 * that scales the deviator: it is 0 everywhere. */
#include <math.h>

#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_pressure_strength_material
#define OF_LAW(member, unit, default, ...)                                                                             \
  MATERIAL_REAL(pressure_strength.member, member, unit, default, __VA_ARGS__, .when = "pressure_strength.law=lundborg")

static const struct field material_rows[] = {
    MATERIAL_CHOICE(pressure_strength.law, law,
                    FIELD_WORDS_HERE(SPH_PRESSURE_STRENGTHS, [SPH_PRESSURE_STRENGTH_NONE] = "none",
                                     [SPH_PRESSURE_STRENGTH_LUNDBORG] = "lundborg"),
                    .absent = "none", .when = "../strength=true", .label = "yield law",
                    .choice_docs =
                        "yield_stress at any pressure, and (1 - D) of the deviator acts\n"
                        "intact rock follows Lundborg, broken rock keeps friction, and damage acts on the deviator "
                        "through the yield stress alone; yield_stress is not used, melt_energy is",
                    .doc = "Yield stress under pressure.", .source = "Collins, Melosh & Ivanov 2004; Jutzi 2015"),
    OF_LAW(intact_cohesion, "Pa", 90e6, 0, 1e15, .doc = "Y_0: bound of sqrt(J2) of intact rock at P = 0.",
           .source = "Collins, Melosh & Ivanov 2004; 90 MPa: granite, Jutzi 2015"),
    OF_LAW(intact_friction, "1", 2, 0, 100, .doc = "mu_i: internal friction of intact rock.",
           .source = "Lundborg 1968; Collins, Melosh & Ivanov 2004"),
    OF_LAW(intact_limit, "Pa", 1.5e9, 0, 1e15, .flags = FIELD_ABOVE_MINIMUM,
           .doc = "Y_M: bound of sqrt(J2) of intact rock at high pressure, above intact_cohesion.",
           .source = "Lundborg 1968; 1.5 GPa: granite, Jutzi 2015"),
    OF_LAW(broken_cohesion, "Pa", 0, 0, 1e15, .doc = "Y_d0: bound of sqrt(J2) of broken rock at P = 0.",
           .source = "Collins, Melosh & Ivanov 2004"),
    OF_LAW(broken_friction, "1", 0.8, 0, 100,
           .doc = "mu_d: friction of broken rock. 0, with broken_cohesion 0: broken rock bears no shear.",
           .source = "Collins, Melosh & Ivanov 2004; 0.8: Jutzi 2015"),
};
const struct field_table sph_pressure_strength_material = SPH_MODULE_TABLE(sph_pressure_strength_material,
                                                                           material_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength && body->material.pressure_strength.law == SPH_PRESSURE_STRENGTH_LUNDBORG;
}

static status check_material(const struct sph_material *m, struct error *error) {
  const struct sph_pressure_strength_material *p = &m->pressure_strength;
  if (p->law == SPH_PRESSURE_STRENGTH_NONE || p->intact_limit > p->intact_cohesion)
    return STATUS_OK;
  return status_fail(
      error, STATUS_CONTENT,
      "pressure_strength.intact_limit is %.4g Pa, not above intact_cohesion %.4g Pa: raise it, as strength "
      "grows with pressure",
      p->intact_limit, p->intact_cohesion);
}

static const struct sph_column_need columns[] = {{SPH_COLUMNS_OF(shear_damage), 0, NULL}, {0}};

const struct sph_module sph_pressure_strength_module = {
    .name = "pressure_strength",
    .doc = "Rock under pressure: sqrt(J2) is at most Y = (1-D) Y_i + D Y_d, with Y_i = Y_0 + mu_i P/(1 + mu_i P/(Y_M - "
           "Y_0)) of intact and Y_d = Y_d0 + mu_d P, at most Y_i, of broken rock, times 1 - u/u_melt. Damage acts on "
           "the deviator through Y alone.",
    .source = "Lundborg 1968; Collins, Melosh & Ivanov 2004; Jutzi 2015",
    .when = "a body with strength whose pressure_strength.law is lundborg",
    .on = on,
    .sets = SPH_SETS_YIELD_LIMIT,
    .columns = columns,
    .check_material = check_material,
};
