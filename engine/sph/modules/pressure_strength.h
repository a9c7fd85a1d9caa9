/* Yield limit of rock under pressure (Collins, Melosh & Ivanov 2004; Jutzi 2015), a bound of sqrt(J2):
 *
 *   Y_i = Y_0 + mu_i P/(1 + mu_i P/(Y_M - Y_0))      intact (Lundborg 1968)
 *   Y_d = Y_d0 + mu_d P, at most Y_i                 broken
 *   Y = ((1-D) Y_i + D Y_d) (1 - u/u_melt)           0 beyond u_melt
 *
 * P < 0 counts as 0. The limit in the terms is that of the solid and bounds sqrt(3 J2): sqrt(3) Y at the pressure of
 * the solid matter, P rho_s/rho. D is that of the predicted state, or 0 where nothing damages the body. */

MATERIAL_MEMBERS(struct sph_pressure_strength {
  enum { SPH_PRESSURE_STRENGTH_NONE, SPH_PRESSURE_STRENGTH_LUNDBORG } law; /* none: no other member is used */
  double intact_cohesion, intact_friction, intact_limit;                   /* Pa, 1, Pa: Y_0, mu_i, Y_M */
  double broken_cohesion, broken_friction;                                 /* Pa, 1: Y_d0, mu_d */
} pressure_strength;)

#define PRESSURE_STRENGTH_ON "pressure_strength.law=lundborg"
MATERIAL_CHOICE(pressure_strength.law, SPH_CHOICES("none", "lundborg"), "none", STRENGTH, "yield law",
                "yield_stress at any pressure, and (1 - D) of the deviator acts\n"
                "intact rock follows Lundborg, broken rock keeps friction, and damage acts on the deviator through the "
                "yield stress alone; yield_stress is not used, melt_energy is",
                "Yield stress under pressure.", "Collins, Melosh & Ivanov 2004; Jutzi 2015")
MATERIAL_CHOICE_VALUE(pressure_strength.intact_cohesion, "Pa", 90e6, 0, 1e15, 0, PRESSURE_STRENGTH_ON,
                      "Y_0: bound of sqrt(J2) of intact rock at P = 0.",
                      "Collins, Melosh & Ivanov 2004; 90 MPa: granite, Jutzi 2015")
MATERIAL_CHOICE_VALUE(pressure_strength.intact_friction, "1", 2, 0, 100, 0, PRESSURE_STRENGTH_ON,
                      "mu_i: internal friction of intact rock.", "Lundborg 1968; Collins, Melosh & Ivanov 2004")
MATERIAL_CHOICE_VALUE(pressure_strength.intact_limit, "Pa", 1.5e9, 0, 1e15, SPH_MATERIAL_ABOVE, PRESSURE_STRENGTH_ON,
                      "Y_M: bound of sqrt(J2) of intact rock at high pressure, above intact_cohesion.",
                      "Lundborg 1968; 1.5 GPa: granite, Jutzi 2015")
MATERIAL_CHOICE_VALUE(pressure_strength.broken_cohesion, "Pa", 0, 0, 1e15, 0, PRESSURE_STRENGTH_ON,
                      "Y_d0: bound of sqrt(J2) of broken rock at P = 0.", "Collins, Melosh & Ivanov 2004")
MATERIAL_CHOICE_VALUE(pressure_strength.broken_friction, "1", 0.8, 0, 100, 0, PRESSURE_STRENGTH_ON,
                      "mu_d: friction of broken rock. 0, with broken_cohesion 0: broken rock bears no shear.",
                      "Collins, Melosh & Ivanov 2004; 0.8: Jutzi 2015")
#undef PRESSURE_STRENGTH_ON

COLUMN(shear_damage) /* D^(1/3) that scales the deviator, where modules publish it; elsewhere `damage` does */

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/range_tools.h"

RANGE_INLINE void pressure_strength_loop(struct sph_system *s, const struct sph_solid *body, struct sph_block *b,
                                         bool damaged) {
  const struct sph_pressure_strength *m = &body->physics.material.pressure_strength;
  const double melt = body->physics.material.melt_energy, softening = melt > 0 ? 1 / melt : 0; /* NaN: none */
  const double intact_cohesion = m->intact_cohesion, intact_friction = m->intact_friction;
  const double broken_cohesion = m->broken_cohesion, broken_friction = m->broken_friction;
  const double inverse_rise = 1 / (m->intact_limit - intact_cohesion), root3 = 1.7320508075688772;
  const double *pressure = s->c.pressure, *density = s->c.density, *energy = s->c.energy, *d = s->c.damage;
  const double *solid_density = b->terms->solid_density;
  double *limit = b->terms->yield_limit;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double p = range_larger(pressure[i], 0) * (solid_density[k] / density[i]);
    const double friction = intact_friction * p;
    const double intact = intact_cohesion + friction / (1 + friction * inverse_rise);
    const double broken = range_smaller(broken_cohesion + broken_friction * p, intact);
    const double share = damaged ? range_smaller(d[i] * d[i] * d[i], 1) : 0;
    const double cold = (1 - share) * intact + share * broken;
    limit[k] = root3 * range_larger(cold * (1 - energy[i] * softening), 0);
  }
}

RANGE_HOOK void pressure_strength_limit(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  if (sph_solid_has(body, SPH_COLUMN(damage)))
    pressure_strength_loop(s, body, b, true);
  else
    pressure_strength_loop(s, body, b, false);
}

static const sph_hook pressure_strength_hooks[SPH_STAGES] = {[SPH_YIELD] = pressure_strength_limit};

#endif
