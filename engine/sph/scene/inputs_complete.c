/* Values of inputs that were not given and follow from other inputs. */
#include <math.h>
#include <string.h>

#include "engine/sph/material/palpha.h"
#include "engine/sph/scene/derived.h"

static size_t row_at(size_t offset) {
  size_t row = 0;
  while (sph_inputs.rows[row].offset != offset)
    row++;
  return row;
}

/* The values of the named material, unless the scene gives them. */
static void complete_material(struct sph_inputs *in, struct sph_body_inputs *body, const char *fallback,
                              const bool *given) {
  struct sph_material material;
  const size_t name = (size_t)((char *)&body->material_name - (char *)in);
  const size_t first = (size_t)((char *)&body->material - (char *)in);
  if (!given[row_at(name)])
    field_copy_text(body->material_name, fallback);
  if (sph_materials_load(body->material_name, &material, NULL))
    field_defaults(&sph_materials_table, &material); /* of the user's own: none */
  bool own[sizeof material / sizeof(int)] = {false}; /* by row of a material: the scene gives it */
  for (size_t i = 0; i < sph_inputs.count; i++) {
    size_t offset = sph_inputs.rows[i].offset;
    if (offset < first || offset >= first + sizeof material)
      continue;
    own[sph_materials_row(offset - first)] = given[i];
    if (!given[i])
      memcpy((char *)in + offset, (char *)&material + (offset - first),
             sph_inputs.rows[i].kind == FIELD_CHOICE ? sizeof(int) : sizeof(double));
  }
  sph_modules_complete_material(&body->material, own);
}

/* Young's modulus times the mean strength of the weakest of kV flaws: Gamma(1 + 1/m) (kV)^(-1/m). */
static double static_strength(const struct sph_inputs *in) {
  if (!sph_derived_cracks(&in->target))
    return NAN;
  struct sph_shape shape = sph_derived_target(in);
  double m = in->target.material.weibull.m;
  double log_strain = lgamma(1 + 1 / m) -
                      (log(in->target.material.weibull.k) +
                       log(sph_shape_volume(&shape) * sph_derived_density(&in->target) / in->target.material.density)) /
                          m; /* solid volume */
  double strength = sph_material_young_modulus(&in->target.material) * exp(log_strain);
  return strength > 0 && strength <= 1e15 ? strength : (double)NAN;
}

/* Time at which the first front of a plate has gone 0.94 of its width, so that no wave has come back; NaN where values
 * are missing. */
static double plate_time(const struct sph_inputs *in) {
  struct sph_plane_shock exact;
  if (sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL))
    return NAN;
  return 0.94 * in->target.width / (exact.has_precursor ? exact.precursor.speed : exact.shock.speed);
}

/* Can a target with strength turn? Damped sides hold it. */
static bool can_turn(const struct sph_inputs *in) {
  return in->target.strength && (in->target.spin != 0 || in->kind == SPH_COLLISION ||
                                 (in->kind == SPH_IMPACT && in->sides.far != SPH_FAR_DAMPED));
}

/* No cracks, no yielding, no pores: what deforms comes back to the energy 0. */
static bool stays_elastic(const struct sph_body_inputs *body) {
  return body->strength && !sph_derived_cracks(body) && field_is_off(body->material.yield.stress) &&
         !(body->material.palpha.distention > 1);
}

/* Time, s, by which few particles may press later than their surfaces meet: that of one spacing. */
static double late(const struct sph_inputs *in) {
  const double speed = in->kind == SPH_COLLISION ? in->collision.speed : in->impact.speed * cos(in->impact.angle);
  return in->contact.rule == SPH_CONTACT_OVERLAP && speed > 0 ? sph_derived_fine_spacing(in) / speed : 0;
}

/* A value that follows from others, unless the scene gives it. */
#define COMPLETE(member, value)                                                                                        \
  do {                                                                                                                 \
    if (!given[row_at(offsetof(struct sph_inputs, member))])                                                           \
      in->member = (value);                                                                                            \
  } while (0)

void sph_inputs_complete(void *inputs, const bool *given) {
  struct sph_inputs *in = inputs;
  complete_material(in, &in->target, "basalt", given);
  complete_material(in, &in->projectile, "nylon", given);
  const bool specimens = in->kind == SPH_IMPACT || in->kind == SPH_STRETCH;
  COMPLETE(target.turned, specimens);
  COMPLETE(projectile.turned, specimens);
  const double spacing = sph_derived_spacing(in), quiet = sph_derived_quiet_time(in);
  COMPLETE(sides.depth, 0.1 * sph_derived_shortest_side(&in->target));
  const bool by_radius = sph_derived_has_projectile(in) && in->fidelity.spacings_per_radius > 0;
  COMPLETE(fidelity.fine_spacing,
           by_radius ? sph_derived_projectile_radius(in) / in->fidelity.spacings_per_radius : 0.5 * spacing);
  COMPLETE(fidelity.fine_radius, 4 * in->fidelity.fine_spacing);
  if (by_radius && in->fidelity.graded) /* the zone keeps its size where too few particles make it coarser */
    COMPLETE(fidelity.fine_spacing, sph_derived_asked_spacing(in));
  COMPLETE(gradient_correction.on, can_turn(in));
  COMPLETE(method.negative_energy,
           stays_elastic(&in->target) && (!sph_derived_has_projectile(in) || stays_elastic(&in->projectile)));
  const double viscous = in->reconstruction.on && in->gradient_correction.on ? 2 : 1;
  COMPLETE(viscosity.alpha, 1.5 * viscous);
  COMPLETE(viscosity.beta, 3 * viscous);
  COMPLETE(contact.rule, sph_derived_approach(in) < SPH_DERIVED_SLOW ? SPH_CONTACT_OVERLAP : SPH_CONTACT_WELDED);
  COMPLETE(impact.gap, sph_derived_fine_spacing(in));
  COMPLETE(collision.gap, 2 * spacing);
  COMPLETE(stretch.grip, fmax(in->target.length / 20, 3 * spacing));
  COMPLETE(stretch.flaw_free, fmax(in->target.length / 10, in->stretch.grip + 2.5 * spacing));
  COMPLETE(fragments.static_strength, static_strength(in));
  COMPLETE(fragments.layer_width, in->crack_cell.width);
  COMPLETE(fragments.dust_mass, 1e-3 * sph_derived_target_mass(in));
  COMPLETE(stop.quiet_time, quiet);
  COMPLETE(stop.end_time, in->kind == SPH_PISTON ? plate_time(in) : 5 * quiet + sph_derived_arrival(in) + late(in));
  COMPLETE(fidelity.cfl, sph_derived_cfl(in));
}
