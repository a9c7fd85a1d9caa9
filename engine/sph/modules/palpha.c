/* Pores far below the resolution as one number per particle, the distention alpha (material/palpha.h has the law and
 * its equations, modules/palpha.h the loops, palpha_results.c the results).
 *
 *   material.porosity.*        the crush curve and the elastic branch; curve: none and distention 1 are a solid
 *   fidelity.distention_step   largest change of alpha in a step
 *
 * It sets the pressure. It publishes the density of the solid between the pores and the effective 2 mu f/alpha; it
 * turns the yield limit of the solid into that of the body, Y/alpha; it adds damage by closed pores to damage by flaws.
 */
#include <math.h>
#include <stdlib.h>

#include "engine/sph/material/materials.h"
#include "engine/sph/material/palpha.h"
#include "engine/sph/material/tillotson.h"
#include "engine/sph/modules/palpha_results.h"
#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_palpha_material
#define INPUTS   sph_palpha_inputs
#define PORES(member, unit, low, high, ...)                                                                            \
  MATERIAL_REAL(porosity.member, member, unit, NAN, low, high, .when = "porosity.curve=quadratic|two-power",           \
                __VA_ARGS__)
#define TWO_POWER(member, unit, low, high, flags_, ...)                                                                \
  MATERIAL_REAL(porosity.member, member, unit, NAN, low, high, .when = "porosity.curve=two-power",                     \
                .flags = FIELD_REQUIRED | (flags_), __VA_ARGS__)

static const struct field material_rows[] = {
    MATERIAL_CHOICE(
        porosity.curve, curve,
        FIELD_WORDS_HERE(SPH_CRUSHES, [SPH_CRUSH_NONE] = "none", [SPH_CRUSH_QUADRATIC] = "quadratic",
                         [SPH_CRUSH_TWO_POWER] = "two-power"),
        .label = "crush curve",
        .choice_docs = "no pores\nalpha = 1 + (alpha_e - 1)((P_s - P)/(P_s - P_e))^2\n"
                       "a steep law up to P_t and a second one up to P_s, for very porous matter such as pumice",
        .doc = "Crush curve: how pores far below the resolution close under pressure (P-alpha). The material's density "
               "and yield_stress are then those of the solid between the pores, and the porous body yields at "
               "Y_0/alpha. tension_limit is that of the porous body, as strengths are measured (our choice); of the "
               "solid's value give that over alpha_0.",
        .source = "Herrmann 1969; Jutzi, Benz & Michel 2008"),
    PORES(distention, "1", 1, 100, .flags = FIELD_REQUIRED,
          .doc = "alpha_0: density of the solid over that of the porous body. 1: no pores, the solid itself to the "
                 "bit. In a scene porosity.fraction may be given instead.",
          .source = "Herrmann 1969"),
    PORES(fraction, "1", 0, 0.99, .flags = FIELD_MAY_BE_OFF,
          .doc = "Porosity, 1 - 1/alpha_0: give it or porosity.distention, not both; the other follows."),
    PORES(elastic_pressure, "Pa", 0, 1e15, .flags = FIELD_REQUIRED,
          .doc = "P_e: above this pressure pores close and stay closed.", .source = "Jutzi, Benz & Michel 2008"),
    PORES(solid_pressure, "Pa", 0, 1e15, .flags = FIELD_REQUIRED | FIELD_ABOVE_MINIMUM,
          .doc = "P_s: above this pressure all pores are closed.", .source = "Jutzi, Benz & Michel 2008"),
    PORES(sound_speed, "m/s", 0, 1e6, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
          .doc = "c_e: bulk sound speed of the porous body, not above the solid's. off: pores do not give way "
                 "elastically, and the solid's speed is taken.",
          .source = "Herrmann 1969; Jutzi, Benz & Michel 2008"),
    TWO_POWER(elastic_distention, "1", 1, 100, FIELD_ABOVE_MINIMUM,
              .doc = "alpha_e: distention at the beginning of the crush curve, at P_e. A body of lower alpha_0 keeps "
                     "it until it meets the curve.",
              .source = "Jutzi et al. 2009"),
    TWO_POWER(transition_distention, "1", 1, 100, 0,
              .doc = "alpha_t: distention at the end of the first power law, at P_t.", .source = "Jutzi et al. 2009"),
    TWO_POWER(transition_pressure, "Pa", 0, 1e15, FIELD_ABOVE_MINIMUM,
              .doc = "P_t: pressure at the end of the first power law.", .source = "Jutzi et al. 2009"),
    TWO_POWER(exponent_low, "1", 1, 100, 0, .doc = "n1: exponent of the law between P_e and P_t.",
              .source = "Jutzi et al. 2009"),
    TWO_POWER(exponent_high, "1", 1, 100, 0, .doc = "n2: exponent of the law up to P_s.",
              .source = "Jutzi et al. 2009"),
};
const struct field_table sph_palpha_material = SPH_MODULE_TABLE(sph_palpha_material, material_rows);

static const struct field input_rows[] = {
    INPUT_REAL(fidelity.distention_step, distention_step, "1", 0.01, 1e-6, 1,
               .when = "target.material.porosity.curve=quadratic|two-power",
               .doc = "Largest change of a porous particle's distention in a time step.",
               .source = "Jutzi, Benz & Michel 2008"),
};
const struct field_table sph_palpha_inputs = SPH_MODULE_TABLE(sph_palpha_inputs, input_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->material.palpha.curve != SPH_CRUSH_NONE && body->material.palpha.distention != 1;
}

/* Distention and fraction agree (they do unless both were given), and the values make a crush curve. */
static status check_material(const struct sph_material *m, struct error *error) {
  const struct sph_palpha_material *p = &m->palpha;
  struct sph_palpha_law law;
  if (p->curve == SPH_CRUSH_NONE)
    return STATUS_OK;
  if (!(fabs(p->fraction - (1 - 1 / p->distention)) < 1e-9))
    return status_fail(error, STATUS_CONTENT,
                       "porosity: distention %.9g is a fraction of %.9g, but fraction is %.9g: give one of the two",
                       p->distention, 1 - 1 / p->distention, p->fraction);
  return p->distention > 1 ? sph_palpha_prepare(p, m, &law, error) : STATUS_OK;
}

/* Takes the porosity by the name that was given (of two), else the material's own distention. */
static void complete_material(struct sph_material *m, const bool *given) {
  const size_t distention = sph_materials_row(offsetof(struct sph_material, palpha.distention)),
               fraction = sph_materials_row(offsetof(struct sph_material, palpha.fraction));
  if (given[fraction] && !given[distention])
    m->palpha.distention = 1 / (1 - m->palpha.fraction);
  else if (!given[fraction])
    m->palpha.fraction = 1 - 1 / m->palpha.distention;
}

static bool with_strength(const struct sph_body_physics *body) {
  return body->strength;
}

static bool with_flaws(const struct sph_body_physics *body) {
  return body->strength && body->flaws;
}

static status check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                    size_t last, struct error *error) {
  const double top = body->material.palpha.distention;
  for (size_t i = first; particles->distention && i < last; i++)
    if (!(particles->distention[i] >= 1 && particles->distention[i] <= top))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu has distention %g; it must lie between 1 and its body's %g", i,
                         particles->distention[i], top);
  return STATUS_OK;
}

static void set_up(const struct sph_body_physics *body, struct sph_particles *particles, size_t first, size_t last) {
  for (size_t i = first; i < last; i++)
    particles->distention[i] = body->material.palpha.distention;
}

static status prepare(const struct sph_inputs *inputs, const struct sph_particles *particles, struct sph_solid *body,
                      struct error *error) {
  struct sph_palpha_law *law = malloc(sizeof *law);
  (void)inputs, (void)particles;
  if (!law)
    return status_fail(error, STATUS_MEMORY, "no memory for a crush curve");
  body->prepared[SPH_MODULE_palpha] = law;
  return sph_palpha_prepare(&body->physics.material.palpha, &body->physics.material, law, error);
}

static size_t bytes_prepared(const void *prepared) {
  (void)prepared;
  return sizeof(struct sph_palpha_law);
}

/* Distention as the particles have it (or alpha_0), at its pressure. Their damage is that of all causes. */
static void fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  const struct sph_palpha_law *law = body->prepared[SPH_MODULE_palpha];
  for (size_t i = body->first; i < body->last; i++) {
    const double alpha = p->distention ? p->distention[i] : law->given.distention;
    const struct sph_pressure solid = sph_tillotson(&law->solid, law->solid_density, alpha * p->density[i],
                                                    p->energy[i]);
    const double rest = sph_palpha_rest(law, alpha, solid.pressure / alpha);
    s->c.distention[i] = alpha;
    s->c.rest_distention[i] = rest;
    if (!sph_solid_has(body, SPH_COLUMN(compaction)))
      continue;
    s->c.compaction[i] = s->c.damage[i] = sph_palpha_damage_cbrt(law, rest);
    if (sph_solid_has(body, SPH_COLUMN(flaw_damage)) && p->damage_cbrt)
      s->c.flaw_damage[i] = cbrt(fmax(0, pow(p->damage_cbrt[i], 3) - pow(s->c.compaction[i], 3)));
  }
}

static const struct sph_column_need columns[] = {{SPH_COLUMNS_OF(distention), 1, NULL},
                                                 {SPH_COLUMNS_OF(rest_distention), 1, NULL},
                                                 {SPH_COLUMNS_OF(shear_factor), 1, NULL},
                                                 {SPH_COLUMNS_OF(two_mu), 0, with_strength},
                                                 {SPH_COLUMNS_OF(damage), 0, with_strength},
                                                 {SPH_COLUMNS_OF(compaction), 0, with_strength},
                                                 {SPH_COLUMNS_OF(flaw_damage), 0, with_flaws},
                                                 {0}};

const struct sph_module sph_palpha_module = {
    .name = "palpha",
    .doc = "Pores below the resolution: distention alpha follows a crush curve under load and an elastic branch when "
           "unloaded; it acts on pressure, deviator, yield stress, sound speed and damage.",
    .source = "Herrmann 1969; Jutzi, Benz & Michel 2008",
    .when = "a body with porosity (distention above 1)",
    .on = on,
    .sets = SPH_SETS_PRESSURE,
    .columns = columns,
    .check_material = check_material,
    .check = check,
    .set_up = set_up,
    .prepare = prepare,
    .free_prepared = free,
    .bytes_prepared = bytes_prepared,
    .fill = fill,
    .complete_material = complete_material,
    .report = sph_palpha_results_report,
};
