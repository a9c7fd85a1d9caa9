/* Damage that grows from open flaws (material/material.h has the law, weibull.h the
 * flaws).
 *
 *   fracture.growth, fracture.cap   rate and largest damage with n open flaws
 *   fracture.crack_radius           R_s of the rate c_g/R_s
 *   fidelity.damage_step            largest change of D^(1/3) in a step
 *
 * Which flaws are open, and D^(1/3) that grows with them [BA95 section 4.3].
 *
 * Local strain (eq. 21) of the damaged stress: eps = sigma_t/((1-D) E), with sigma_t the largest principal value of
 * (1-D) S - P (P < 0: (1-D) P). The factors cancel:  E eps = lambda(S) - P                where P < 0,
 *                                                    E eps = lambda(S) - P/(1-D)          elsewhere.
 * D is here the damage that scales the deviator. Where a module publishes 0 for it, damage does not soften the rock in
 * shear: S is 2 mu times an elastic strain at any damage, and E eps = lambda(S) - P, the stress without damage.
 *
 * A step adds dt times the mean of the rates at its two ends, where the stress of the new end is known. Pressure shuts
 * a flaw as D grows: growth ends where (lambda(S) - E eps_1)(1-D) = P, eps_1 the lowest threshold of the particle. D
 * never heals, so a step must not go past that D; if it does, results are first order in dt.
 *
 * Most particles can have no open flaw: the bound lambda(S) <= 2 sqrt(J2/3) shows it without principal axes. For the
 * others lambda = 2 sqrt(J2/3) cos(theta/3), cos(theta) = (27/4)^(1/2) det S / J2^(3/2) (Smith 1961), with cos(theta/3)
 * = cos(2/3 acos(s)), s = sqrt((1 + cos(theta))/2), a smooth function of s: a polynomial of degree 16 is within 2e-15
 * of it. (Where the two larger values are equal, rounding of det S makes the error 1e-8 of |S|, as with acos.) */

MODULE(fracture)
MODULE_HOOKS(fracture)
MODULE_INPUTS(fracture)

#ifdef SPH_MODULE_STRUCTS
/* R_s of a particle: the radius of the sphere of its volume, or 2h. */
enum sph_crack_radius { SPH_CRACK_RADIUS_VOLUME, SPH_CRACK_RADIUS_SUPPORT, SPH_CRACK_RADII };
struct sph_fracture_inputs {
  int growth;         /* enum sph_fracture_growth */
  int cap;            /* enum sph_fracture_cap */
  int crack_radius;   /* enum sph_crack_radius */
  double damage_step; /* 1 */
};
#endif

COLUMN(damage)      /* D^(1/3), of all causes */
COLUMN(flaw_damage) /* D^(1/3) by flaws, where `damage` has other causes, too */
COLUMN(damage_rate) /* 1/s, by flaws; the rate holds until the cap */
COLUMN(damage_cap)
COLUMN(weakest)    /* Young's modulus times the lowest threshold, Pa; infinite once D = 1 */
COLUMN(open_from)  /* while E eps, Pa, lies between this */
COLUMN(open_below) /* and this, */
COLUMN(open_rate)  /* D^(1/3) grows at this rate, 1/s (or is capped) */
COLUMN(crack_rate) /* c_g / R_s, 1/s */

TIME_STEP_LIMIT(DAMAGE, damage, "the growth of damage") /* set in motion.h, which has the rate of the step */

#ifdef SPH_MODULE_LOOPS

/* cos(2/3 acos(s)) on [0, 1]: Chebyshev interpolation, in powers of 2 s - 1. */
RANGE_INLINE double fracture_third_cosine(double s) {
  static const double c[17] = {0.766044443118978,       0.24740906632284043,     -0.015509188436481955,
                               0.002466352815691789,    -0.0005041246913301313,  0.00011642544451832467,
                               -2.891993360699116e-05,  7.54113105182103e-06,    -2.035886681257262e-06,
                               5.639788836689093e-07,   -1.5948649112929443e-07, 4.617777441564896e-08,
                               -1.3456397963049525e-08, 3.6028213343971334e-09,  -1.0683273724516248e-09,
                               5.264174066673318e-10,   -1.5966098420242849e-10};
  const double t = 2 * s - 1, t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
  const double low = (c[0] + c[1] * t + t2 * (c[2] + c[3] * t)) + t4 * (c[4] + c[5] * t + t2 * (c[6] + c[7] * t));
  const double high = (c[8] + c[9] * t + t2 * (c[10] + c[11] * t)) +
                      t4 * (c[12] + c[13] * t + t2 * (c[14] + c[15] * t));
  return low + t8 * (high + t8 * c[16]);
}

/* Largest principal value of a deviator. */
RANGE_INLINE double fracture_largest(double xx, double xy, double xz, double yy, double yz) {
  const double zz = -(xx + yy);
  const double third = (xx * xx + yy * yy + xx * yy + xy * xy + xz * xz + yz * yz) * (1.0 / 3); /* J2/3 */
  const double size = sqrt(third), inverse = third > 0 ? 1 / (size * third) : 0;
  const double det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double cosine = range_smaller(range_larger(0.5 * det * inverse, -1), 1);
  return 2 * size * fracture_third_cosine(sqrt(0.5 + 0.5 * cosine));
}

/* D^(1/3) by flaws: all damage, unless another module damages the body, too. */
RANGE_INLINE double *fracture_own_damage(const struct sph_system *s, const struct sph_solid *body) {
  return sph_solid_has(body, SPH_COLUMN(flaw_damage)) ? s->c.flaw_damage : s->c.damage;
}

/* The stress that opens flaws: the particle's own, or the mean of its cell. */
RANGE_INLINE const double *fracture_pressure(const struct sph_system *s, const struct sph_solid *body) {
  return sph_solid_has(body, SPH_COLUMN(crack_pressure)) ? s->c.crack_pressure : s->c.pressure;
}

/* What opens and shuts the flaws of a particle. */
struct fracture_load {
  double strain; /* E eps at the damage of the old state, Pa */
  double shut;   /* D^(1/3) by flaws at which pressure shuts the weakest flaw; infinite where damage shuts none */
};

/* `largest`: lambda(S). */
RANGE_INLINE struct fracture_load fracture_load(const struct sph_system *s, const struct sph_solid *body, size_t i,
                                                double largest) {
  const double *shear_damage = range_shear_damage(s, body), pressure = fracture_pressure(s, body)[i];
  if (!(pressure > 0))
    return (struct fracture_load){largest - pressure, INFINITY};
  const double damage = shear_damage[i] * shear_damage[i] * shear_damage[i];
  struct fracture_load load = {largest - pressure / range_larger(1 - damage, 1e-30), INFINITY};
  if (shear_damage != s->c.damage)
    return load; /* damage does not soften the deviator */
  const double own = fracture_own_damage(s, body)[i], by_others = damage - own * own * own;
  const double above = largest - s->c.weakest[i];
  load.shut = above > pressure ? cbrt(range_larger(1 - pressure / above - by_others, 0)) : 0;
  return load;
}

/* Advances the damage of one particle over the step that has led to this load, and finds its new rate and cap. Its list
 * of flaws is searched only when the strain has left the bracket between two thresholds. */
RANGE_INLINE void fracture_grow(struct sph_system *s, const struct sph_solid *body, size_t i, double young,
                                struct fracture_load load) {
  const double rate = s->c.damage_rate[i], cap = s->c.damage_cap[i];
  double *damage = fracture_own_damage(s, body) + i;
  if (!(load.strain >= s->c.open_from[i] && load.strain < s->c.open_below[i])) {
    const struct sph_flaws_lists *flaws = body->prepared[SPH_MODULE_weibull];
    const size_t own = s->id[i] - body->first;
    double bracket[2];
    const uint32_t open = sph_flaws_active(flaws, own, load.strain / young, bracket);
    s->c.open_from[i] = bracket[0] * young;
    s->c.open_below[i] = bracket[1] * young;
    s->c.open_rate[i] = open ? sph_material_damage_rate(open, s->in.fracture.growth) * s->c.crack_rate[i] : 0;
    s->c.damage_cap[i] = open ? sph_material_damage_cap(open, sph_flaws_total(flaws, own), s->in.fracture.cap) : 0;
  }
  const double limit = range_smaller(range_larger(cap, s->c.damage_cap[i]), load.shut);
  const double grown = *damage + 0.5 * s->dt * (rate + s->c.open_rate[i]);
  *damage = range_larger(*damage, range_smaller(grown, limit));
  s->c.damage_rate[i] = *damage < s->c.damage_cap[i] ? s->c.open_rate[i] : 0;
  if (s->c.damage[i] >= 1)
    s->c.weakest[i] = INFINITY; /* no flaw is left to open */
}

RANGE_HOOK void fracture_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double *pressure = fracture_pressure(s, body), *weakest = s->c.weakest, *rate = s->c.damage_rate;
  double *const *deviator = sph_solid_has(body, SPH_COLUMN(crack_pressure)) ? s->c.crack_stress : s->c.stress;
  const double *xx = deviator[0], *xy = deviator[1], *xz = deviator[2], *yy = deviator[3], *yz = deviator[4];
  double above[SPH_BLOCK];
  uint32_t which[SPH_BLOCK];
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double J2 = xx[i] * xx[i] + yy[i] * yy[i] + xx[i] * yy[i] + xy[i] * xy[i] + xz[i] * xz[i] + yz[i] * yz[i];
    above[k] = 2 * sqrt(J2 * (1.0 / 3)) * (1 + 1e-12) - pressure[i] - weakest[i];
  }
  size_t count = 0;
  for (size_t k = 0; k < n; k++) {
    which[count] = (uint32_t)k;
    count += (above[k] >= 0) | (rate[low + k] > 0);
  }
  if (!count)
    return;
  const double young = sph_material_young_modulus(&body->physics.material);
  double largest[SPH_BLOCK];
  RANGE_LOOP
  for (size_t m = 0; m < count; m++) {
    const size_t i = low + which[m];
    largest[m] = fracture_largest(xx[i], xy[i], xz[i], yy[i], yz[i]);
  }
  for (size_t m = 0; m < count; m++) {
    const size_t i = low + which[m];
    fracture_grow(s, body, i, young, fracture_load(s, body, i, largest[m]));
  }
}

static const sph_hook fracture_hooks[SPH_STAGES] = {[SPH_CRACK] = fracture_range};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool fracture_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->flaws != NULL;
}

static status fracture_check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                             size_t last, struct error *error) {
  (void)particles;
  if (!(body->strength && body->material.elastic.shear_modulus > 0))
    return status_fail(error, STATUS_CONTENT,
                       "flaws but no strength: only a solid cracks; set strength: true or fracture: off");
  if (body->flaws->particles != last - first)
    return status_fail(error, STATUS_CONTENT, "%zu particles, but flaws for %zu", last - first, body->flaws->particles);
  return STATUS_OK;
}

static void fracture_fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  const struct sph_flaws_lists *flaws = body->prepared[SPH_MODULE_weibull];
  const double young = sph_material_young_modulus(&body->physics.material),
               crack_speed = sph_material_crack_speed(&body->physics.material);
  for (size_t i = body->first; i < body->last; i++) {
    const double volume = p->mass[i] / p->density[i];
    const double radius = s->in.fracture.crack_radius == SPH_CRACK_RADIUS_SUPPORT ? 2 * p->h[i]
                                                                                  : cbrt(3 * volume / (4 * M_PI));
    s->c.damage[i] = p->damage_cbrt ? p->damage_cbrt[i] : 0;
    s->c.crack_rate[i] = crack_speed / radius;
    s->c.weakest[i] = young * sph_flaws_lowest(flaws, i - body->first);
  }
}

static const struct sph_column_need fracture_columns[] = {{SPH_COLUMNS_OF(damage), 0, NULL},
                                                          {SPH_COLUMNS_OF(damage_rate), 0, NULL},
                                                          {SPH_COLUMNS_OF(damage_cap), 0, NULL},
                                                          {SPH_COLUMNS_OF(weakest), INFINITY, NULL},
                                                          {SPH_COLUMNS_OF(open_from), 0, NULL},
                                                          {SPH_COLUMNS_OF(open_below), 0, NULL},
                                                          {SPH_COLUMNS_OF(open_rate), 0, NULL},
                                                          {SPH_COLUMNS_OF(crack_rate), 0, NULL},
                                                          {0}};

static const struct sph_module fracture_module = {
    .name = "fracture",
    .doc = "Damage grows from open flaws, D^(1/3) at n^p c_g/R_s up to its cap, and takes tension and shear away: "
           "(1-D) S (unless damage acts through the yield stress), and (1-D) P where P < 0. It never heals.",
    .source = "Grady & Kipp 1980; Benz & Asphaug 1995, sections 3 and 4.3",
    .when = "a body whose material has Weibull parameters",
    .on = fracture_on,
    .columns = fracture_columns,
    .check = fracture_check,
    .fill = fracture_fill,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_CHOICE(fracture.growth, fracture.growth,
             FIELD_WORDS_HERE(SPH_GROWTHS, [SPH_GROWTH_CUBE_ROOT] = "cube-root", [SPH_GROWTH_LINEAR] = "linear"),
             .when = "target.fracture=auto|on",
             .choice_docs = "n^(1/3) c_g/R_s, which gives Grady and Kipp's rate law\nn c_g/R_s, as printed",
             .doc = "Rate of D^(1/3) of a particle with n open flaws.", .source = "BA95 section 4.3 for `linear`"),
    INPUT_CHOICE(
        fracture.cap, fracture.cap,
        FIELD_WORDS_HERE(SPH_CAPS, [SPH_CAP_BA95] = "ba95", [SPH_CAP_COUNT] = "count", [SPH_CAP_NONE] = "none"),
        .when = "target.fracture=auto|on", .choice_docs = "(n/n_tot)^(1/3), as printed\nn/n_tot\n1",
        .doc = "Largest damage of a particle with n of its n_tot flaws open.", .source = "BA95 eq. 22 for `ba95`"),
    INPUT_CHOICE(
        fracture.crack_radius, fracture.crack_radius,
        FIELD_WORDS_HERE(SPH_CRACK_RADII, [SPH_CRACK_RADIUS_VOLUME] = "volume", [SPH_CRACK_RADIUS_SUPPORT] = "support"),
        .when = "target.fracture=auto|on",
        .choice_docs = "radius of the sphere of the particle's volume\n"
                       "2h: strength falls with R_s, and most of a body is destroyed where `volume` leaves a core",
        .doc = "R_s: length that a crack has to grow until its particle is broken.",
        .source = "BA95 eq. 15; the paper gives no value"),
    INPUT_REAL(fidelity.damage_step, fracture.damage_step, "1", 0.2, 1e-6, 1, .when = "target.fracture=auto|on",
               .doc = "Largest change of D^(1/3) in a time step."),
#endif
