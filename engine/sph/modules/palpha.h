/* Pores far below the resolution as one number per particle, the distention alpha (material/palpha.h has the law and
 * its equations).
 *
 *   material.porosity.*        the crush curve and the elastic branch; curve: none and distention 1 are a solid
 *   fidelity.distention_step   largest change of alpha in a step
 *
 * It sets the pressure. It publishes the density of the solid between the pores and the effective 2 mu f/alpha; it
 * turns the yield limit of the solid into that of the body, Y/alpha; it adds damage by closed pores to damage by flaws.
 *
 * P-alpha over a range: (alpha, P), sound speed, f, the deviator's change with alpha, damage by compaction.
 *
 * Nearly all particles are on their elastic branch in cold or compressed matter, and alpha moves little in a step. Two
 * Newton steps from the last alpha are made for all particles, without branches, so that they vectorise. The other
 * particles (crushing, hot, far off) are computed again by sph_palpha_update. An elastic particle is accepted when the
 * error before the second step is below 1e-9, as in sph_palpha_update. */

MODULE(palpha)
MODULE_HOOKS(palpha)
MODULE_MATERIAL(palpha)
MODULE_INPUTS(palpha)
MODULE_RESULTS(palpha)
MODULE_REPORT(palpha)

#ifdef SPH_MODULE_STRUCTS
struct sph_palpha_material {
  enum {
    SPH_CRUSH_NONE,
    SPH_CRUSH_QUADRATIC,
    SPH_CRUSH_TWO_POWER,
    SPH_CRUSHES
  } curve;           /* none: no other member is used */
  double distention; /* alpha_0; 1: no pores, the solid itself */
  double fraction; /* porosity 1 - 1/alpha_0: another way to give it in a document, made to agree; not used elsewhere */
  bool by_fraction;        /* the document gave the fraction: messages speak of it */
  double elastic_pressure; /* Pa, P_e: plastic crushing begins */
  double solid_pressure;   /* Pa, P_s: all pores are closed */
  double sound_speed;      /* m/s, c_e of the porous matter at alpha_0; NaN: no elastic change of alpha */
  /* two-power curve */
  double elastic_distention, transition_distention; /* alpha_e, alpha_t */
  double transition_pressure;                       /* Pa, P_t */
  double exponent_low, exponent_high;               /* n1, n2 */
};
struct sph_palpha_inputs {
  double distention_step; /* 1 */
};
struct sph_palpha_results {
  double mean_distention;
  struct {
    double mass_fraction, volume, depth, reach;
  } compaction;
  double shock, shock_exact, precursor, precursor_exact; /* distention behind these fronts */
};
#endif

COLUMN(distention)      /* alpha now */
COLUMN(rest_distention) /* alpha after unloading to P = 0 (material/palpha.h) */
COLUMN(shear_factor)    /* f of the last evaluation */
COLUMN(wave_speed)      /* m/s, of the wave that acts, for the viscosity: also in bodies without pores */
COLUMN(compaction)      /* D^(1/3) by closed pores */

PARTICLE_ARRAYS(DISTENTION, distention)
PARTICLE_COLUMN(DISTENTION, distention, 1, "1", "distention: density of the matrix over density")
PARTICLE_COLUMN(DISTENTION, rest_distention, 1, "1",
                "distention at zero pressure; below the distention at the start, pores are closed for good")
PROFILE_COLUMN(distention, rest_distention, distention, 1, "1",
               "impact: mean at rest (P = 0) over retained particles within 1.5 spacings of the axis; plate: mean of "
               "the layer as it is")

TIME_STEP_LIMIT(DISTENTION, distention, "the closing of pores")

#ifdef SPH_MODULE_LOOPS

struct palpha_try {
  double next, miss, pressure, slope;   /* bulk P at `next` (by its slope); dalpha/dP of the branch */
  double by_density, by_energy, sound2; /* of the solid */
};

RANGE_INLINE double palpha_within(double x, double low, double high) {
  return range_smaller(range_larger(x, low), high);
}

/* One Newton step for alpha - elastic(P(alpha)) = 0; see engine/sph/material/palpha.c. */
struct palpha_constants { /* of a body, in registers */
  double A, B, a, b, E0, inverse0, K, top, q;
};

RANGE_INLINE struct palpha_try palpha_step(const struct palpha_constants t, double rest, double alpha, double rho,
                                           double u) {
  const double top = t.top, q = t.q, K = t.K, inverse0 = t.inverse0;
  const double rho_s = alpha * rho, inverse_alpha = 1 / alpha;
  const double eta = rho_s * inverse0, mu = eta - 1, B = mu < 0 ? 0 : t.B;
  const double e = t.E0 * eta * eta, v = 1 / (u + e), w = t.b * e * v;
  const double p_s = (t.a + w) * rho_s * u + (t.A + B * mu) * mu;
  struct palpha_try r;
  r.by_density = (t.a + w) * u + 2 * w * v * u * u + (t.A + 2 * B * mu) * inverse0;
  r.by_energy = rho_s * (t.a + w - w * v * u);
  r.sound2 = r.by_density + p_s / (rho_s * rho_s) * r.by_energy;
  const double p = p_s * inverse_alpha;
  const double by_alpha = range_larger((rho * r.by_density - p) * inverse_alpha, 0);
  const double h0 = 1 / (1 - q * (rest - 1)), g0 = rest * rest * (1 - h0 * h0) * K;
  const double h1 = 1 / (1 - q * (alpha - 1)), s1 = (1 - h1 * h1) * K, g1 = alpha * alpha * s1;
  const double d1 = 2 * alpha * (s1 - alpha * q * h1 * h1 * h1 * K);
  const double half = palpha_within((rest + alpha) * 0.5 + p * 0.125 * (g0 - g1), 1, top);
  const double h2 = 1 / (1 - q * (half - 1)), s2 = (1 - h2 * h2) * K, g2 = half * half * s2;
  const double d2 = 2 * half * (s2 - half * q * h2 * h2 * h2 * K);
  const double mean = (g0 + 4 * g2 + g1) * (1.0 / 6), target = rest + p * mean;
  const double rise = 1 - p * (1.0 / 6) * (d1 + d2 * (2 - 0.5 * p * d1)) -
                      (mean + p * (1.0 / 12) * d2 * (g0 - g1)) * by_alpha;
  r.miss = alpha - range_smaller(target, top);
  r.next = palpha_within(alpha - r.miss / range_larger(rise, 0.1), 1, top);
  r.pressure = p + by_alpha * (r.next - alpha);
  r.slope = target < top ? g1 : 0;
  return r;
}

/* f from dalpha/dP on the particle's branch; as at the end of sph_palpha_update. */
RANGE_INLINE double palpha_shear_factor(const struct palpha_try *t, double rho) {
  const double below = range_larger(t->next + t->slope * (t->pressure - rho * t->by_density), t->next);
  const double adiabatic = t->slope / below * (t->next * t->by_density + t->pressure / (rho * rho) * t->by_energy);
  return palpha_within(1 + adiabatic * rho / t->next, 0, 1);
}

RANGE_INLINE void palpha_respond(struct sph_system *s, const struct sph_solid *body, struct sph_block *b, double *was) {
  const struct sph_palpha_law *law = body->prepared[SPH_MODULE_palpha];
  const struct sph_tillotson_material *solid = &law->solid;
  const struct palpha_constants constants = {solid->A,
                                             solid->B,
                                             solid->a,
                                             solid->b,
                                             solid->E0,
                                             1 / law->solid_density,
                                             1 / solid->A,
                                             law->given.distention,
                                             law->stiffness_slope};
  const double top = law->given.distention, low_pressure = law->given.elastic_pressure,
               high_pressure = law->given.solid_pressure;
  const double c_e = law->given.sound_speed, share = isnan(c_e) ? 0 : 1 / (top - 1), start = isnan(c_e) ? 0 : c_e;
  const double floor2 = law->solid.A / (4 * law->solid_density), E_iv = law->solid.E_iv,
               solid_density = law->solid_density;
  const bool quadratic = law->given.curve == SPH_CRUSH_QUADRATIC;
  const double range = 1 / (high_pressure - low_pressure);
  /* two-power: sph_palpha_update computes all particles above P_e that have pores */
  const double pores = quadratic ? law->elastic_distention - 1 : 0, never = quadratic ? 0 : -1;
  const double *density = s->c.density, *energy = s->c.energy;
  double *alpha = s->c.distention, *rest = s->c.rest_distention, *f = s->c.shear_factor;
  double *pressure = s->c.pressure, *sound_speed = s->c.sound_speed, *wave = s->c.wave_speed;
  int64_t hard[SPH_BLOCK], any = 0;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double rho = density[i], u = range_larger(energy[i], 0), r = rest[i];
    was[k] = alpha[i];
    const struct palpha_try first = palpha_step(constants, r, palpha_within(alpha[i], 1, top), rho, u);
    const struct palpha_try t = palpha_step(constants, r, first.next, rho, u);
    const double left = palpha_within((high_pressure - t.pressure) * range, 0, 1);
    const double bound = 1 + pores * left * left + (r > 1 ? never : 0); /* crush curve */
    const double c = sqrt(range_larger(t.sound2, floor2));
    pressure[i] = t.pressure;
    sound_speed[i] = wave[i] = c + (start - c) * (t.next - 1) * share;
    f[i] = palpha_shear_factor(&t, rho);
    alpha[i] = t.next;
    const int64_t crush = -(int64_t)(t.pressure > low_pressure) & -(int64_t)(t.next > bound);
    const int64_t hot = -(int64_t)(rho * t.next < solid_density) & -(int64_t)(u > E_iv);
    hard[k] = crush | hot | -(int64_t)(fabs(t.miss) >= 1e-9);
    any |= hard[k];
  }
  for (size_t k = 0; any && k < n; k++) {
    if (!hard[k])
      continue;
    const size_t i = low + k;
    const struct sph_palpha_state now = sph_palpha_update(law, rest[i], was[k], density[i], energy[i]);
    alpha[i] = now.distention;
    pressure[i] = now.pressure;
    sound_speed[i] = now.sound_speed;
    wave[i] = now.wave_speed;
    f[i] = now.shear_factor;
    if (now.rest < rest[i] && sph_solid_has(body, SPH_COLUMN(compaction)))
      s->c.compaction[i] = sph_palpha_damage_cbrt(law, now.rest);
    rest[i] = now.rest;
  }
}

/* The stored deviator is the bulk one, S_s/alpha: alpha S holds while alpha changes, dS/dt = ... - (S/alpha) dalpha/dt.
 */
RANGE_HOOK void palpha_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  double was[SPH_BLOCK];
  palpha_respond(s, body, b, was);
  if (!body->physics.strength)
    return;
  const size_t low = b->low, n = b->high - b->low;
  const double *alpha = s->c.distention;
  for (int c = 0; c < 5; c++) {
    double *stress = s->c.stress[c];
    RANGE_LOOP
    for (size_t k = 0; k < n; k++)
      stress[low + k] *= was[k] / alpha[low + k];
  }
}

/* For other modules: the density of the solid between the pores, and the effective shear modulus, 2 mu/alpha, times f
 * where the deviator grows [JBM08: always]. Where it falls, f would keep it: on the crush curve f is nearly 0, so that
 * the deviator would give back more work than it took, without end, and the internal energy would fall below zero. (The
 * share of alpha's change in dS/dt is in palpha_range.) */
RANGE_HOOK void palpha_publish(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double *alpha = s->c.distention, *density = s->c.density;
  double *solid_density = b->terms->published, *two_mu = s->c.two_mu;
  const double solid_two_mu = 2 * body->physics.material.elastic.shear_modulus;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    solid_density[k] = alpha[low + k] * density[low + k];
  b->terms->solid_density = solid_density;
  if (!sph_solid_has(body, SPH_COLUMN(two_mu)))
    return;
  RANGE_LOOP
  for (size_t i = low; i < low + n; i++)
    two_mu[i] = solid_two_mu / alpha[i];
}

/* The stored S is that of the body: |S| <= Y/alpha. */
RANGE_HOOK void palpha_yield(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const double *alpha = s->c.distention + b->low;
  double *limit = b->terms->yield_limit;
  const size_t n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    limit[k] /= alpha[k];
}

/* D = min(1, D by flaws + D by compaction). */
RANGE_HOOK void palpha_damage(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  if (!body->physics.strength)
    return;
  const double *flaws = sph_solid_has(body, SPH_COLUMN(flaw_damage)) ? s->c.flaw_damage : NULL;
  for (size_t i = b->low; i < b->high; i++) {
    const double closed = s->c.compaction[i], open = flaws ? flaws[i] : 0;
    if (closed == 0)
      s->c.damage[i] = open;
    else
      s->c.damage[i] = range_smaller(1, cbrt(closed * closed * closed + open * open * open));
  }
}

/* |dalpha| <= distention_step in a step, by dalpha/dt = (f - 1) (alpha/rho) drho/dt. Matter that a Courant step may
 * bring onto the crush curve counts as crushing already (f = 0). In a shock the rate grows by up to a quarter within a
 * step, so that the limit uses three quarters of distention_step. */
RANGE_HOOK void palpha_limit(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double *xx = b->sums->gradient[0], *yy = b->sums->gradient[4], *zz = b->sums->gradient[8];
  const double *alpha = s->c.distention, *rest = s->c.rest_distention, *f = s->c.shear_factor, *density = s->c.density;
  const double *pressure = s->c.pressure, *sound_speed = s->c.sound_speed, *h = s->c.h;
  const struct sph_palpha_law *law = body->prepared[SPH_MODULE_palpha];
  const double edge = law->given.elastic_pressure, cfl = s->in.fidelity.cfl;
  double inverse[SPH_BLOCK];
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double squeeze = -(xx[k] + yy[k] + zz[k]);
    const double soon = pressure[i] + density[i] * sound_speed[i] * cfl * h[i] * squeeze;
    const double share = squeeze > 0 && soon > edge && rest[i] > 1 ? 1 : 1 - f[i];
    inverse[k] = share * alpha[i] * fabs(squeeze);
  }
  b->worst[SPH_LIMIT_DISTENTION] = range_largest(inverse, n) / (0.75 * s->in.palpha.distention_step);
}

static const sph_hook palpha_hooks[SPH_STAGES] = {[SPH_RESPOND] = palpha_range,
                                                  [SPH_PUBLISH] = palpha_publish,
                                                  [SPH_YIELD_OF_BODY] = palpha_yield,
                                                  [SPH_DAMAGE] = palpha_damage,
                                                  [SPH_RATES] = palpha_limit};

#endif

#ifdef SPH_MODULE_REPORT

/* Of the target, by mass. */
static double palpha_mean_distention(const struct sph_run *run) {
  const struct sph_particles *p = run->now;
  double mass = 0, distention = 0;
  for (size_t i = 0; i < run->targets; i++) {
    mass += p->mass[i];
    distention += p->mass[i] * p->rest_distention[i];
  }
  return mass > 0 ? sph_results_finite(distention / mass) : (double)NAN;
}

static void palpha_report_fronts(const struct sph_run *run, struct sph_results *r) {
  struct sph_plate_regions regions = sph_plate_regions(run);
  if (run->exact.has_shock) {
    r->palpha.shock = sph_plate_mean(run, run->now->distention, regions.shock);
    r->palpha.shock_exact = run->exact.shock.distention;
  }
  if (run->exact.has_precursor) {
    r->palpha.precursor = sph_plate_mean(run, run->now->distention, regions.precursor);
    r->palpha.precursor_exact = run->exact.precursor.distention;
  }
}

static void palpha_report(const struct sph_run *run, struct sph_results *results) {
  const struct sph_material *target = &run->inputs.target.material;
  results->palpha.mean_distention = palpha_mean_distention(run);
  if (run->inputs.kind == SPH_PISTON)
    palpha_report_fronts(run, results);
  const struct sph_crater_options crater = sph_report_crater_options(run);
  if (run->inputs.kind == SPH_IMPACT && crater.count && crater.spacing > 0 && sph_material_solid_ratio(target) > 1)
    sph_crater_compaction(run->start, run->now, &crater, sph_material_solid_ratio(target), results);
}

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool palpha_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->material.palpha.curve != SPH_CRUSH_NONE && body->material.palpha.distention != 1;
}

/* Distention and fraction agree (they do unless both were given), and the values make a crush curve. */
static status palpha_check_material(const struct sph_material *m, struct error *error) {
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
static void palpha_complete_material(struct sph_material *m, const bool *given) {
  const size_t distention = sph_materials_row(offsetof(struct sph_material, palpha.distention)),
               fraction = sph_materials_row(offsetof(struct sph_material, palpha.fraction));
  m->palpha.by_fraction = given[fraction] && !given[distention];
  if (m->palpha.by_fraction)
    m->palpha.distention = 1 / (1 - m->palpha.fraction);
  else if (!given[fraction])
    m->palpha.fraction = 1 - 1 / m->palpha.distention;
}

static bool palpha_with_strength(const struct sph_body_physics *body) {
  return body->strength;
}

static bool palpha_with_flaws(const struct sph_body_physics *body) {
  return body->strength && body->flaws;
}

static status palpha_check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                           size_t last, struct error *error) {
  const double top = body->material.palpha.distention;
  for (size_t i = first; particles->distention && i < last; i++)
    if (!(particles->distention[i] >= 1 && particles->distention[i] <= top))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu has distention %g; it must lie between 1 and its body's %g", i,
                         particles->distention[i], top);
  return STATUS_OK;
}

static void palpha_set_up(const struct sph_body_physics *body, struct sph_particles *particles, size_t first,
                          size_t last) {
  for (size_t i = first; i < last; i++)
    particles->distention[i] = body->material.palpha.distention;
}

static status palpha_prepare(const struct sph_inputs *inputs, const struct sph_particles *particles,
                             struct sph_solid *body, struct error *error) {
  struct sph_palpha_law *law = memory_small(1, sizeof *law);
  (void)inputs, (void)particles;
  body->prepared[SPH_MODULE_palpha] = law;
  return sph_palpha_prepare(&body->physics.material.palpha, &body->physics.material, law, error);
}

/* Distention as the particles have it (or alpha_0), at its pressure. Their damage is that of all causes. */
static void palpha_fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
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

static const struct sph_column_need palpha_columns[] = {{SPH_COLUMNS_OF(distention), 1, NULL},
                                                        {SPH_COLUMNS_OF(rest_distention), 1, NULL},
                                                        {SPH_COLUMNS_OF(shear_factor), 1, NULL},
                                                        {SPH_COLUMNS_OF(wave_speed), 0, NULL},
                                                        {SPH_COLUMNS_OF(two_mu), 0, palpha_with_strength},
                                                        {SPH_COLUMNS_OF(damage), 0, palpha_with_strength},
                                                        {SPH_COLUMNS_OF(compaction), 0, palpha_with_strength},
                                                        {SPH_COLUMNS_OF(flaw_damage), 0, palpha_with_flaws},
                                                        {0}};

static const struct sph_module palpha_module = {
    .name = "palpha",
    .doc = "Pores below the resolution: distention alpha follows a crush curve under load and an elastic branch when "
           "unloaded; it acts on pressure, deviator, yield stress, sound speed and damage.",
    .source = "Herrmann 1969; Jutzi, Benz & Michel 2008",
    .when = "a body with porosity (distention above 1)",
    .on = palpha_on,
    .sets = SPH_SETS_PRESSURE,
    .columns = palpha_columns,
    .check_material = palpha_check_material,
    .check = palpha_check,
    .set_up = palpha_set_up,
    .prepare = palpha_prepare,
    .free_prepared = free,
    .fill = palpha_fill,
    .complete_material = palpha_complete_material,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_REAL(fidelity.distention_step, palpha.distention_step, "1", 0.01, 1e-6, 1,
           .when = "target.material.porosity.curve=quadratic|two-power",
           .doc = "Largest change of a porous particle's distention in a time step.",
           .source = "Jutzi, Benz & Michel 2008"),
#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
#define PORES(member, unit, low, high, ...)                                                                            \
  MATERIAL_REAL(porosity.member, palpha.member, unit, NAN, low, high, .when = "porosity.curve=quadratic|two-power",    \
                __VA_ARGS__)
#define TWO_POWER(member, unit, low, high, flags_, ...)                                                                \
  MATERIAL_REAL(porosity.member, palpha.member, unit, NAN, low, high, .when = "porosity.curve=two-power",              \
                .flags = FIELD_REQUIRED | (flags_), __VA_ARGS__)
    MATERIAL_CHOICE(
        porosity.curve, palpha.curve,
        FIELD_WORDS_HERE(SPH_CRUSHES, [SPH_CRUSH_NONE] = "none", [SPH_CRUSH_QUADRATIC] = "quadratic",
                         [SPH_CRUSH_TWO_POWER] = "two-power"),
        .label = "crush curve",
        .choice_docs = "no pores\nalpha = 1 + (alpha_e - 1)((P_s - P)/(P_s - P_e))^2\n"
                       "a steep law up to P_t and a second one up to P_s, for very porous matter such as pumice",
        .doc = "Crush curve: how pores far below the resolution close under pressure (P-alpha). The "
               "material's density and yield_stress are then those of the solid between the pores, and the "
               "porous body yields at Y_0/alpha. tension_limit is that of the porous body, as strengths "
               "are measured (our choice); of the solid's value give that over alpha_0. A material's file takes "
               "the whole curve of a porous one with `like: pumice`.",
        .source = "Herrmann 1969; Jutzi, Benz & Michel 2008"),
    PORES(distention, "1", 1, 100, .flags = FIELD_REQUIRED,
          .doc = "alpha_0: density of the solid over that of the porous body. 1: no pores, the solid itself to the "
                 "bit. In a scene porosity.fraction may be given instead.",
          .source = "Herrmann 1969"),
    PORES(fraction, "1", 0, 0.99, .flags = FIELD_MAY_BE_OFF,
          .doc = "Porosity, 1 - 1/alpha_0: give it or porosity.distention, not both; the other follows."),
    PORES(elastic_pressure, "Pa", 0, 1e15, .flags = FIELD_REQUIRED,
          .doc = "P_e: above this pressure pores close and stay closed. With fewer pores than the curve begins with "
                 "(alpha_0 below alpha_e) they close from a higher one on, which clast explain SCENE prints.",
          .source = "Jutzi, Benz & Michel 2008"),
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
#endif

#ifdef SPH_MODULE_RESULT_ROWS
    RESULT_REAL(mean_distention, palpha.mean_distention, "1", 1,
                .doc = "Mean distention of the target at the end, weighted by mass, at zero pressure. 1 is solid; off "
                       "without pores.",
                .source = "Jutzi, Benz & Michel 2008"),
    RESULT_SHARE(compaction.mass_fraction, palpha.compaction.mass_fraction,
                 .label = "compacted share of the target's mass",
                 .doc = "Impact: mass share of the target that was compacted: its distention at zero pressure fell "
                        "from 1.01 or more to below 1.01. Off without pores.",
                 .source = "Jutzi & Benz, figure 2"),
    RESULT_REAL(compaction.volume, palpha.compaction.volume, "m^3", 0,
                .doc = "Impact: volume that the retained matter lost as its pores closed; off without pores."),
    RESULT_REAL(
        compaction.depth, palpha.compaction.depth, "m", 0,
        .doc = "Impact: depth at the start of the deepest compacted particle near the axis; off without pores."),
    RESULT_REAL(compaction.reach, palpha.compaction.reach, "m", 0,
                .doc = "Impact: largest distance from the point of impact at which matter lost a hundredth of its "
                       "pores; off without pores."),
    RESULT_REAL(shock.distention, palpha.shock, "1", 1,
                .doc = "Piston: mean distention behind the shock, in the same region; off without pores."),
    RESULT_REAL(shock.distention_exact, palpha.shock_exact, "1", 1,
                .doc = "Piston: distention behind the shock by the jump conditions and the crush curve."),
    RESULT_REAL(precursor.distention, palpha.precursor, "1", 1,
                .doc = "Piston: mean distention between precursor and shock."),
    RESULT_REAL(precursor.distention_exact, palpha.precursor_exact, "1", 1,
                .doc = "Piston: distention behind the precursor on the elastic branch."),
#endif
