/* Yield limit of rock under pressure (Collins, Melosh & Ivanov 2004; Jutzi 2015), a bound of sqrt(J2):
 *
 *   Y_i = Y_0 + mu_i P/(1 + mu_i P/(Y_M - Y_0))      intact (Lundborg 1968)
 *   Y_d = Y_d0 + mu_d P, at most Y_i                 broken
 *   Y = ((1-D) Y_i + D Y_d) (1 - u/u_melt)           0 beyond u_melt
 *
 * P < 0 counts as 0. The limit in the terms is that of the solid and bounds sqrt(3 J2): sqrt(3) Y at the pressure of
 * the solid matter, P rho_s/rho. D is that of the predicted state, or 0 where nothing damages the body. */

MODULE(pressure_strength)
MODULE_HOOKS(pressure_strength)
MODULE_MATERIAL(pressure_strength)

#ifdef SPH_MODULE_STRUCTS
struct sph_pressure_strength_material {
  enum {
    SPH_PRESSURE_STRENGTH_NONE,
    SPH_PRESSURE_STRENGTH_LUNDBORG,
    SPH_PRESSURE_STRENGTHS
  } law;                                                 /* none: no other member is used */
  double intact_cohesion, intact_friction, intact_limit; /* Pa, 1, Pa: Y_0, mu_i, Y_M */
  double broken_cohesion, broken_friction;               /* Pa, 1: Y_d0, mu_d */
};
#endif

COLUMN(shear_damage) /* D^(1/3) that scales the deviator, where modules publish it; elsewhere `damage` does */

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/range_tools.h"

RANGE_INLINE void pressure_strength_loop(struct sph_system *s, const struct sph_solid *body, struct sph_block *b,
                                         bool damaged) {
  const struct sph_pressure_strength_material *m = &body->physics.material.pressure_strength;
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
