/* P-alpha in the moving system: the range loop against the formulas one by one, deviator, yield, damage, limiter,
 * state; and arrays that must be absent without pores. */
#include "tests/support/sph_case.h"

#include "engine/random.h"
#include "engine/sph/material/material.h"
#include "engine/sph/material/palpha.h"

static const struct sph_palpha_material porous_basalt = {.distention = 1.5,
                                                         .curve = SPH_CRUSH_QUADRATIC,
                                                         .elastic_pressure = 5e6,
                                                         .solid_pressure = 3e8,
                                                         .sound_speed = 1800};
static const struct sph_palpha_material two_power = {.distention = 1.5,
                                                     .curve = SPH_CRUSH_TWO_POWER,
                                                     .elastic_pressure = 1e6,
                                                     .solid_pressure = 213e6,
                                                     .sound_speed = NAN,
                                                     .elastic_distention = 1.5,
                                                     .transition_distention = 1.2,
                                                     .transition_pressure = 68e6,
                                                     .exponent_low = 12,
                                                     .exponent_high = 3};

static void near(double got, double want, double tolerance, const char *what) {
  if (!(fabs(got - want) <= tolerance))
    fail_msg("%s: got %.17g, expected %.17g +- %g", what, got, want, tolerance);
}

/* A cube of basalt with pores (or none), 6^3 particles, strength; flaws too strong to open. */
static struct sph_system *cube(const struct sph_palpha_material *porosity, bool strength, bool flaws, size_t *count) {
  struct case_block block = {.count = {6, 6, 6}, .spacing = 1e-3};
  SPH_PARTICLES *p = case_make(&block, 1, 2700 / (porosity ? porosity->distention : 1), 1.05,
                               SPH_WITH_STRESS | SPH_WITH_DAMAGE);
  SPH_FLAWS *list = flaws ? case_flaws(p->n, 1e-30, 1, 0) : NULL;
  struct sph_body_physics body = {.material = case_basalt, .strength = strength, .flaws = list};
  if (porosity)
    body.material.palpha = *porosity;
  struct case_parameters parameters = case_parameters_default();
  struct sph_system *s = case_system(p, 1, &body, &parameters);
  *count = p->n;
  return s;
}

/* The state of the pores at the current densities and energies, and the values passed to other modules. */
static void respond(struct sph_system *s) {
  CASE_LOOPS(s, true, {SPH_MODULE_palpha, SPH_RESPOND}, {SPH_MODULE_palpha, SPH_PUBLISH});
}

/* Random states, all branches mixed within a block: the loop gives what sph_palpha_update gives. */
TEST(loop_is_the_formula) {
  const struct sph_palpha_material *given[] = {&porous_basalt, &two_power};
  for (uint64_t round = 0; round < 60; round++) {
    size_t n;
    SPH_SYSTEM *s = cube(given[round % 2], false, false, &n);
    const struct sph_palpha_law *law = s->solid[0].prepared[SPH_MODULE_palpha];
    double rest[216], alpha[216], rho[216], u[216];
    int crushed = 0, solid = 0, elastic = 0;
    for (size_t i = 0; i < n; i++) {
      double r[4];
      for (uint64_t k = 0; k < 4; k++)
        r[k] = random_draw(round, RANDOM_FLAW_PLACE, i, k);
      rest[i] = r[0] < 0.2 ? 1 : r[0] < 0.4 ? 1.5 : 1 + 0.5 * r[1];
      alpha[i] = fmax(1, rest[i] - 0.01 * r[2]);
      rho[i] = 2700 / rest[i] * (r[3] < 0.5 ? 0.99 + 0.04 * r[3] : 0.7 + r[3]);
      u[i] = r[1] < 0.7 ? 1e4 * r[2] : r[1] < 0.9 ? 1e6 * r[2] : 1e8 * r[2];
      s->c.rest_distention[i] = rest[i], s->c.distention[i] = alpha[i], s->c.density[i] = rho[i], s->c.energy[i] = u[i];
    }
    respond(s);
    for (size_t i = 0; i < n; i++) {
      struct sph_palpha_state want = sph_palpha_update(law, rest[i], alpha[i], rho[i], u[i]);
      crushed += want.rest < rest[i] && want.rest > 1, solid += want.rest == 1,
          elastic += want.rest == rest[i] && want.rest > 1;
      near(s->c.distention[i], want.distention, 1e-10, "alpha");
      near(s->c.rest_distention[i], want.rest, 1e-10, "rest distention");
      near(s->c.pressure[i], want.pressure, 1e-9 * (fabs(want.pressure) + 2.67e10), "pressure");
      near(s->c.sound_speed[i], want.sound_speed, 1e-7 * want.sound_speed, "sound speed");
      near(s->c.shear_factor[i], want.shear_factor, 1e-6, "f");
    }
    if (crushed < 10 || solid < 10 || elastic < 10)
      fail_msg("%d crushed, %d solid, %d elastic", crushed, solid, elastic);
  }
}

/* S is the bulk deviator: alpha S holds while alpha changes. */
TEST(deviator_follows_alpha) {
  size_t n;
  SPH_SYSTEM *s = cube(&porous_basalt, true, false, &n);
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 5; k++)
      s->c.stress[k][i] = 1e6 * (k + 1);
    s->c.density[i] = 1800 * (1 + 0.6 * (double)i / (double)n);
  }
  respond(s);
  bool moved = false;
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 5; k++)
      near(s->c.stress[k][i] * s->c.distention[i], 1.5 * 1e6 * (k + 1), 1e-3, "alpha S");
    moved |= s->c.distention[i] == 1;
  }
  assert_true(moved);
}

/* dS/dt = (f/alpha) 2 mu dev(eps) + R S - S R: simple shear at 1/s, stress-free. */
TEST(shear_rate) {
  size_t n;
  SPH_SYSTEM *s = cube(&porous_basalt, true, false, &n);
  for (size_t i = 0; i < n; i++)
    s->c.density[i] = 1800 * (1 + 0.6 * (double)i / (double)n);
  respond(s);
  double lowest = 1;
  for (int falls = 0; falls < 2; falls++) { /* strain feeds the deviator, or takes from it */
    for (size_t i = 0; i < n; i++) {
      for (int k = 0; k < 5; k++)
        s->c.stress[k][i] = s->c.stress_rate[k][i] = 0;
      s->c.stress[1][i] = falls ? -1 : 0; /* Pa */
    }
    CASE_LOOPS(s, true, {SPH_MODULE_elastic, SPH_RATES});
    for (size_t i = 0; i < n; i++) {
      struct sph_palpha_state want = sph_palpha_update(s->solid[0].prepared[SPH_MODULE_palpha], 1.5, 1.5,
                                                       1800 * (1 + 0.6 * (double)i / (double)n), 0);
      const double factor = falls ? 1 : want.shear_factor;
      near(s->c.stress_rate[1][i], factor / want.distention * 2.27e10, 1e-5 * 2.27e10, "shear stress rate");
      lowest = fmin(lowest, want.shear_factor);
    }
  }
  assert_true(lowest < 0.2); /* crushing matter hardly resists shear */
}

TEST(yield_falls_with_alpha) {
  size_t n;
  SPH_SYSTEM *s = cube(&porous_basalt, true, false, &n);
  for (size_t i = 0; i < n; i++) {
    s->c.distention[i] = 1 + 0.5 * (double)i / (double)n;
    for (int k = 0; k < 5; k++)
      s->c.stress[k][i] = 1e12;
  }
  CASE_YIELD(s);
  for (size_t i = 0; i < n; i++) {
    double **t = s->c.stress, xx = t[0][i], xy = t[1][i], xz = t[2][i], yy = t[3][i], yz = t[4][i];
    double J2 = xx * xx + yy * yy + xx * yy + xy * xy + xz * xz + yz * yz;
    near(sqrt(3 * J2), 3.5e9 / s->c.distention[i], 1, "yield stress"); /* the bulk Y/alpha */
  }
}

/* The tension limit is that of the porous body, whatever its distention. It falls as far as the solid has expanded. */
TEST(tension_limit_is_of_the_body) {
  size_t n;
  SPH_SYSTEM *s = cube(&porous_basalt, false, false, &n);
  s->solid[0].physics.material.tension_limit.pressure = 1e6;
  for (size_t i = 0; i < n; i++) {
    const double expanded = i % 3 == 0 ? 1 : i % 3 == 1 ? 0.95 : 0.9; /* of the solid: whole, half torn, torn */
    s->c.distention[i] = 1 + 0.002 * (double)i;
    s->c.density[i] = expanded * 2700 / s->c.distention[i];
    s->c.pressure[i] = i % 2 ? -1e7 : 2e5;
  }
  CASE_LOOPS(s, false, {SPH_MODULE_palpha, SPH_PUBLISH}, {SPH_MODULE_tension_limit, SPH_LIMIT});
  for (size_t i = 0; i < n; i++)
    near(s->c.pressure[i],
         i % 2 == 0   ? 2e5
         : i % 3 == 0 ? -1e6
         : i % 3 == 1 ? -5e5
                      : 0,
         1e-6, "pressure"); /* a dozen roundings of 1e6 */
}

/* D = min(1, D_tension + D_compaction); closed pores do not open again, and elastic change causes no damage. */
TEST(damage_adds_up) {
  for (int flaws = 0; flaws < 2; flaws++) {
    size_t n;
    SPH_SYSTEM *s = cube(&porous_basalt, true, flaws, &n);
    assert_true(!s->c.flaw_damage == !flaws);
    for (int step = 0; step < 3; step++) { /* loaded, unloaded, loaded again */
      for (size_t i = 0; i < n; i++) {
        if (s->c.flaw_damage)
          s->c.flaw_damage[i] = (double)(i % 7) / 6;
        s->c.density[i] = (step == 1 ? 1700 : 1800 * (1 + 0.6 * (double)i / (double)n));
      }
      respond(s);
      CASE_LOOPS(s, true, {SPH_MODULE_palpha, SPH_DAMAGE});
      for (size_t i = 0; i < n; i++) {
        double c = sph_palpha_damage_cbrt(s->solid[0].prepared[SPH_MODULE_palpha], s->c.rest_distention[i]);
        double want = fmin(1, cbrt(c * c * c + (flaws ? pow((double)(i % 7) / 6, 3) : 0)));
        near(s->c.damage[i], want, 1e-12, "damage");
      }
      assert_true(s->c.rest_distention[0] == 1.5 && s->c.compaction[0] == 0);
      assert_true(s->c.rest_distention[n - 1] == 1 && s->c.damage[n - 1] == 1);
    }
  }
}

/* An impact at 1 km/s of a pore-free block on a porous one, both with strength and unbreakable flaws. */
struct impact {
  struct sph_particles *p;
  struct sph_system *s;
  struct sph_flaws *flaws[2];
};

static struct impact impact_of(const struct sph_palpha_material *target, const struct sph_palpha_material *projectile,
                               bool strength) {
  struct case_block blocks[2] =
      {{.count = {10, 10, 6}, .spacing = 1e-3},
       {.count = {5, 5, 5}, .spacing = 1e-3, .corner = {2.5e-3, 2.5e-3, 6e-3}, .velocity = {0, 0, -1000}}};
  struct impact m = {.p = case_make(blocks, 2, 2700, 1.05, SPH_WITH_STRESS | SPH_WITH_DAMAGE | SPH_WITH_DISTENTION)};
  for (size_t i = 0; i < m.p->n; i++) {
    const struct sph_palpha_material *pores = m.p->body[i] ? projectile : target;
    m.p->distention[i] = pores ? pores->distention : 1;
    m.p->density[i] = 2700 / m.p->distention[i];
    m.p->mass[i] = m.p->density[i] * 1e-9;
  }
  struct sph_body_physics bodies[2];
  const size_t count[2] = {600, 125};
  for (int b = 0; b < 2; b++) {
    m.flaws[b] = strength ? case_flaws(count[b], 1e-300, 1, (uint64_t)b) : NULL;
    bodies[b] = (struct sph_body_physics){.material = case_basalt, .strength = strength, .flaws = m.flaws[b]};
    if (b ? projectile : target)
      bodies[b].material.palpha = b ? *projectile : *target;
  }
  struct case_parameters parameters = case_parameters_default();
  m.s = case_system(m.p, 2, bodies, &parameters);
  return m;
}
static void impact_end(struct impact *m) {
  sph_system_free(m->s);
  sph_particles_free(m->p);
  sph_flaws_free(m->flaws[0]);
  sph_flaws_free(m->flaws[1]);
}

/* alpha_0 = 1 is the solid itself: the same bits and bytes, and no arrays for pores. */
TEST(solid_bits) {
  struct sph_palpha_material none = porous_basalt;
  none.distention = 1;
  struct impact a = impact_of(&none, &none, true), b = impact_of(NULL, NULL, true);
  case_steps(a.s, 60);
  case_steps(b.s, 60);
  size_t na, nb;
  OWNED void *sa = sph_system_state_copy(a.s, &na), *sb = sph_system_state_copy(b.s, &nb);
  assert_int_equal(na, nb);
  assert_memory_equal(sa, sb, na);
  assert_int_equal(a.s->arena_doubles, b.s->arena_doubles);
  assert_null(a.s->c.distention);
  assert_null(a.s->c.rest_distention);
  assert_null(a.s->c.shear_factor);
  assert_null(a.s->c.compaction);
  assert_null(a.s->c.flaw_damage);
  assert_int_equal(a.s->solid[0].before_count, b.s->solid[0].before_count);
  impact_end(&a);
  impact_end(&b);
}

/* No flaw opens here, so all damage comes from compaction, in the porous body alone. The distention limiter keeps
 * |dalpha| within 0.01 per step. */
TEST(beside_a_solid) {
  struct impact m = impact_of(&porous_basalt, NULL, true);
  double last[725], rest[725], most = 0;
  for (size_t i = 0; i < 725; i++)
    last[i] = rest[i] = m.p->distention[i];
  int limited = 0;
  for (int k = 0; k < 150; k++) {
    case_steps(m.s, 1);
    limited += m.s->now.limiter == SPH_LIMIT_DISTENTION;
    sph_system_read(m.s, m.p);
    for (size_t i = 0; i < 725; i++) {
      most = fmax(most, fabs(m.p->distention[i] - last[i]));
      last[i] = m.p->distention[i];
      if (!(m.p->rest_distention[i] <= rest[i]))
        fail_msg("closed pores have opened: %g after %g", m.p->rest_distention[i], rest[i]);
      rest[i] = m.p->rest_distention[i];
    }
  }
  size_t crushed = 0;
  for (size_t i = 0; i < 725; i++) {
    crushed += m.p->distention[i] < 1.01 && m.p->body[i] == 0;
    if (m.p->body[i] == 1) {
      assert_true(m.p->distention[i] == 1 && m.p->damage_cbrt[i] == 0);
    } else if (m.p->distention[i] == 1) {
      assert_true(m.p->damage_cbrt[i] == 1);
    }
  }
  print_message("%zu of 600 crushed; %d of 150 steps limited by alpha; largest change %.4f\n", crushed, limited, most);
  assert_true(crushed > 20);
  assert_true(limited > 5);
  if (most > 0.01)
    fail_msg("alpha changed by %g in a step", most);
  struct sph_ledger l = sph_system_ledger(m.s);
  near(case_total(l), 0.5 * 125 * 2.7e-6 * 1e6, 0.005 * 168.75, "energy");
  impact_end(&m);
}

TEST(restart) {
  struct impact a = impact_of(&porous_basalt, &two_power, true), b = impact_of(&porous_basalt, &two_power, true);
  case_steps(a.s, 40);
  size_t size;
  OWNED void *bytes = sph_system_state_copy(a.s, &size);
  assert_true(sph_system_state_load(b.s, bytes, size));
  case_steps(a.s, 40);
  case_steps(b.s, 40);
  size_t na, nb;
  OWNED void *sa = sph_system_state_copy(a.s, &na), *sb = sph_system_state_copy(b.s, &nb);
  assert_int_equal(na, nb);
  assert_memory_equal(sa, sb, na);
  impact_end(&a);
  impact_end(&b);
}

/* Few pores: the run approaches the solid's in proportion to alpha_0 - 1. */
TEST(tends_to_the_solid) {
  struct impact solid = impact_of(NULL, NULL, false);
  case_run(solid.s, 1.5e-6);
  sph_system_read(solid.s, solid.p);
  double last = 0;
  for (int k = 0; k < 3; k++) {
    const double a0[] = {1.01, 1.001, 1.0001};
    struct sph_palpha_material few = porous_basalt;
    few.distention = a0[k], few.sound_speed = sqrt(2.67e10 / 2700) * (1 - 1.5 * (a0[k] - 1));
    few.elastic_pressure = 5e8 * (a0[k] - 1);
    struct impact m = impact_of(&few, NULL, false);
    case_run(m.s, 1.5e-6);
    sph_system_read(m.s, m.p);
    double far = 0;
    for (size_t i = 0; i < m.p->n; i++)
      far = fmax(far, fabs(m.p->z[i] - solid.p->z[i]));
    print_message("alpha_0 %.4f: particles within %.3g m of the solid's\n", a0[k], far);
    if (k)
      assert_true(far < 0.3 * last);
    last = far;
    impact_end(&m);
  }
  assert_true(last < 1e-6); /* of bodies of 10 mm that moved 1.5 mm */
  impact_end(&solid);
}

TEST(refused) {
  struct case_block block = {.count = {3, 3, 3}, .spacing = 1e-3};
  SPH_PARTICLES *p = case_make(&block, 1, 1800, 1.05, SPH_WITH_DISTENTION);
  struct sph_body_physics body = {.material = case_basalt};
  struct sph_palpha_material *bad = &body.material.palpha;
  *bad = porous_basalt;
  struct case_parameters parameters = case_parameters_default();
  struct sph_system *s;
  bad->solid_pressure = 1;
  assert_int_equal(sph_system_create(p, 1, &body, &parameters.in, &parameters.domain, &s, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "solid_pressure"));
  *bad = porous_basalt;
  p->distention[5] = 1.6;
  assert_int_equal(sph_system_create(p, 1, &body, &parameters.in, &parameters.domain, &s, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "distention"));
}
