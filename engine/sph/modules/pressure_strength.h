/* Yield stress of rock under pressure: intact rock by Lundborg's law, broken rock by friction (equations
 * below).
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
 * that scales the deviator: it is 0 everywhere.
 *
 * Yield limit of rock under pressure (Collins, Melosh & Ivanov 2004; Jutzi 2015), a bound of sqrt(J2):
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

#ifdef SPH_MODULE_DESCRIPTORS

static bool pressure_strength_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength && body->material.pressure_strength.law == SPH_PRESSURE_STRENGTH_LUNDBORG;
}

static status pressure_strength_check_material(const struct sph_material *m, struct error *error) {
  const struct sph_pressure_strength_material *p = &m->pressure_strength;
  if (p->law == SPH_PRESSURE_STRENGTH_NONE || p->intact_limit > p->intact_cohesion)
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "pressure_strength.intact_limit is %.4g Pa, not above intact_cohesion %.4g Pa: raise it, as "
                     "strength grows with pressure",
                     p->intact_limit, p->intact_cohesion);
}

static const struct sph_column_need pressure_strength_columns[] = {{SPH_COLUMNS_OF(shear_damage), 0, NULL}, {0}};

static const struct sph_module pressure_strength_module = {
    .name = "pressure_strength",
    .doc = "Rock under pressure: sqrt(J2) is at most Y = (1-D) Y_i + D Y_d, with Y_i = Y_0 + mu_i P/(1 + mu_i P/(Y_M - "
           "Y_0)) of intact and Y_d = Y_d0 + mu_d P, at most Y_i, of broken rock, times 1 - u/u_melt. Damage acts on "
           "the deviator through Y alone.",
    .source = "Lundborg 1968; Collins, Melosh & Ivanov 2004; Jutzi 2015",
    .when = "a body with strength whose pressure_strength.law is lundborg",
    .on = pressure_strength_on,
    .sets = SPH_SETS_YIELD_LIMIT,
    .columns = pressure_strength_columns,
    .check_material = pressure_strength_check_material,
};

#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
#define OF_LAW(member, unit, default, ...)                                                                             \
  MATERIAL_REAL(pressure_strength.member, pressure_strength.member, unit, default, __VA_ARGS__,                        \
                .when = "pressure_strength.law=lundborg")
MATERIAL_CHOICE(
    pressure_strength.law, pressure_strength.law,
    FIELD_WORDS_HERE(
        SPH_PRESSURE_STRENGTHS, [SPH_PRESSURE_STRENGTH_NONE] = "none", [SPH_PRESSURE_STRENGTH_LUNDBORG] = "lundborg"),
    .absent = "none", .when = "../strength=true", .label = "yield law",
    .choice_docs = "yield_stress at any pressure, and (1 - D) of the deviator acts\n"
                   "intact rock follows Lundborg, broken rock keeps friction, and damage acts on the deviator through "
                   "the yield stress alone; yield_stress is not used, melt_energy is",
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
#endif
