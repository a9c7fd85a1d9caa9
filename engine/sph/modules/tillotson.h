/* Tillotson's equation of state (material/tillotson.h). Every body has it, directly or behind a
 * module that sets the pressure of the body from that of its solid matter.
 *
 *   material.density, material.tillotson.*   all needed
 *
 * Tillotson pressure and sound speed over a range. Nearly all matter is cold or compressed. That branch, which has no
 * transcendental function, is computed for all particles; the few hot, expanded ones are computed again by the general
 * form. */

MODULE(tillotson)
MODULE_HOOKS(tillotson)
MODULE_MATERIAL(tillotson)

#ifdef SPH_MODULE_STRUCTS
/* Tillotson 1962; Melosh 1989, appendix II. */
struct sph_tillotson_material {
  double A, B;           /* Pa: bulk modulus and its non-linear companion */
  double a, b;           /* 1 */
  double alpha, beta;    /* 1: decay in hot expansion (not the exponent of a spectrum) */
  double E0, E_iv, E_cv; /* J/kg: reference, incipient and complete vaporisation */
};
#endif

#ifdef SPH_MODULE_LOOPS

RANGE_HOOK void tillotson_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const struct sph_tillotson_material t = body->physics.material.tillotson;
  const double density0 = body->physics.material.density, inverse0 = 1 / density0, floor2 = t.A / (4 * density0);
  const double *density = s->c.density, *energy = s->c.energy;
  double *pressure = s->c.pressure, *sound_speed = s->c.sound_speed;
  int64_t hot = 0;
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++) {
    const double rho = density[i], u = range_larger(energy[i], 0);
    const double eta = rho * inverse0, mu = eta - 1, B = mu < 0 ? 0 : t.B;
    const double e = t.E0 * eta * eta, q = 1 / (u + e), w = t.b * e * q; /* w = b/(u/e + 1) */
    const double p = (t.a + w) * rho * u + (t.A + B * mu) * mu;
    const double by_density = (t.a + w) * u + 2 * w * q * u * u + (t.A + 2 * B * mu) * inverse0;
    const double by_energy = rho * (t.a + w - w * q * u);
    const double c2 = by_density + p / (rho * rho) * by_energy;
    pressure[i] = p;
    sound_speed[i] = sqrt(range_larger(c2, floor2));
    hot |= -(int64_t)(rho < density0) & -(int64_t)(u > t.E_iv);
  }
  for (size_t i = b->low; hot && i < b->high; i++)
    if (density[i] < density0 && energy[i] > t.E_iv) {
      const struct sph_pressure r = sph_tillotson(&t, density0, density[i], energy[i]);
      pressure[i] = r.pressure;
      sound_speed[i] = r.sound_speed;
    }
  if (s->c.wave_speed) /* another body has pores */
    memcpy(s->c.wave_speed + b->low, sound_speed + b->low, (b->high - b->low) * sizeof *sound_speed);
}

static const sph_hook tillotson_hooks[SPH_STAGES] = {[SPH_RESPOND] = tillotson_range};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool tillotson_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return true;
}

static status tillotson_check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                              size_t last, struct error *error) {
  const struct sph_material *m = &body->material;
  const struct {
    const char *name;
    double value;
    bool may_be_zero;
  } needs[] = {
      {"density", m->density, false},
      {"tillotson.A", m->tillotson.A, false},
      {"tillotson.B", m->tillotson.B, true},
      {"tillotson.a", m->tillotson.a, true},
      {"tillotson.b", m->tillotson.b, true},
      {"tillotson.alpha", m->tillotson.alpha, true},
      {"tillotson.beta", m->tillotson.beta, true},
      {"tillotson.E0", m->tillotson.E0, false},
      {"tillotson.E_iv", m->tillotson.E_iv, false},
      {"tillotson.E_cv", m->tillotson.E_cv, false},
  };
  (void)particles, (void)first, (void)last;
  for (size_t k = 0; k < sizeof needs / sizeof *needs; k++) {
    const double v = needs[k].value;
    if (!(isfinite(v) && (v > 0 || (needs[k].may_be_zero && v == 0))))
      return status_fail(error, STATUS_CONTENT, "%s is %g; its physics needs a number %s", needs[k].name, v,
                         needs[k].may_be_zero ? "not below 0" : "above 0");
  }
  return STATUS_OK;
}

static const struct sph_module tillotson_module = {
    .name = "tillotson",
    .doc = "Pressure and sound speed of rock, ice or metal from the cold solid to its vapour; no pressure-squared term "
           "in tension.",
    .source = "Tillotson 1962; Melosh 1989, appendix II",
    .when = "every body but those whose pressure another module makes from that of the solid",
    .on = tillotson_on,
    .sets = SPH_SETS_PRESSURE,
    .check = tillotson_check,
};

#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
#define REQUIRED(member, unit, low, high, doc_, source_)                                                               \
  MATERIAL_REAL(tillotson.member, tillotson.member, unit, NAN, low, high, .flags = FIELD_REQUIRED, .doc = doc_,        \
                .source = source_ "Melosh 1989, appendix II")
REQUIRED(A, "Pa", 1, 1e15, "Tillotson's A: bulk modulus at rest.", "Tillotson 1962; "),
    REQUIRED(B, "Pa", 0, 1e15, "Tillotson's B: quadratic term in compression.", ""),
    REQUIRED(a, "1", 0, 100,
             "Tillotson's a: Grueneisen coefficient of hot matter. 0, with b 0: pressure does not depend on energy.",
             ""),
    REQUIRED(b, "1", 0, 100, "Tillotson's b: a + b is the Grueneisen coefficient at rest.", ""),
    REQUIRED(alpha, "1", 0, 1e3, "Tillotson's alpha: decay in hot expansion.", ""),
    REQUIRED(beta, "1", 0, 1e3, "Tillotson's beta: decay in hot expansion.", ""),
    REQUIRED(E0, "J/kg", 1e-3, 1e15, "Tillotson's reference energy.", ""),
    REQUIRED(E_iv, "J/kg", 1e-3, 1e15, "Energy of incipient vaporisation.", ""),
    REQUIRED(E_cv, "J/kg", 1e-3, 1e15, "Energy of complete vaporisation, above E_iv.", ""),
#endif
