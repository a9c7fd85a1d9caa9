/* P-alpha over a range: (alpha, P), sound speed, f, the deviator's change with alpha, damage by compaction.
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

#include "engine/sph/material/palpha.h"
#include "engine/sph/modules/range_tools.h"

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
  double *pressure = s->c.pressure, *sound_speed = s->c.sound_speed;
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
    sound_speed[i] = c + (start - c) * (t.next - 1) * share;
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

/* For other modules: the density of the solid between the pores, and the effective shear modulus, (f/alpha) 2 mu
 * [JBM08]. (The share of alpha's change in dS/dt is in palpha_range.) */
RANGE_HOOK void palpha_publish(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double *alpha = s->c.distention, *f = s->c.shear_factor, *density = s->c.density;
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
    two_mu[i] = solid_two_mu * f[i] / alpha[i];
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
