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

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->material.porosity.curve != SPH_CRUSH_NONE && body->material.porosity.distention != 1;
}

/* Distention and fraction agree (they do unless both were given), and the values make a crush curve. */
static status check_material(const struct sph_material *m, struct error *error) {
  const struct sph_palpha *p = &m->porosity;
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
  const size_t distention = sph_materials_row(offsetof(struct sph_material, porosity.distention)),
               fraction = sph_materials_row(offsetof(struct sph_material, porosity.fraction));
  if (given[fraction] && !given[distention])
    m->porosity.distention = 1 / (1 - m->porosity.fraction);
  else if (!given[fraction])
    m->porosity.fraction = 1 - 1 / m->porosity.distention;
}

static bool with_strength(const struct sph_body_physics *body) {
  return body->strength;
}

static bool with_flaws(const struct sph_body_physics *body) {
  return body->strength && body->flaws;
}

static status check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                    size_t last, struct error *error) {
  const double top = body->material.porosity.distention;
  for (size_t i = first; particles->distention && i < last; i++)
    if (!(particles->distention[i] >= 1 && particles->distention[i] <= top))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu has distention %g; it must lie between 1 and its body's %g", i,
                         particles->distention[i], top);
  return STATUS_OK;
}

static void set_up(const struct sph_body_physics *body, struct sph_particles *particles, size_t first, size_t last) {
  for (size_t i = first; i < last; i++)
    particles->distention[i] = body->material.porosity.distention;
}

static status prepare(const struct sph_inputs *inputs, const struct sph_particles *particles, struct sph_solid *body,
                      struct error *error) {
  struct sph_palpha_law *law = malloc(sizeof *law);
  (void)inputs, (void)particles;
  if (!law)
    return status_fail(error, STATUS_MEMORY, "no memory for a crush curve");
  body->prepared[SPH_MODULE_palpha] = law;
  return sph_palpha_prepare(&body->physics.material.porosity, &body->physics.material, law, error);
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
    .report = sph_palpha_results,
};
