/* The moving solid: conservation in a collision with fracture, ledger, limits and rates by hand, absent modules. */
#include "tests/support/sph_collision.h"

TEST(conserved) {
  struct collision c = collide(1000);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  const struct sph_ledger first = sph_system_ledger(s);
  case_run(s, 6e-6); /* several crossings of the large cube */
  const struct sph_ledger last = sph_system_ledger(s);
  print_message("%llu steps, damage %.3f, energy %.3e of %.3e J (clamped %.1e)\n", (unsigned long long)s->now.steps,
                sph_system_damage(s, 0, s->body_count), case_total(last) - case_total(first), case_total(first),
                last.clamped);
  assert_true(sph_system_damage(s, 0, s->body_count) >
              0.2);           /* it does break: at the large one's end of the energy, most of it */
  for (int k = 0; k < 3; k++) /* pair forces are opposite to the last bit: what remains is rounding of the sums */
    assert_true(fabs(last.momentum[k] - first.momentum[k]) < 1e-12 * last.momentum_scale);
  /* the bound for a whole impact run, before the booked clamps are credited */
  assert_true(fabs(case_total(last) - case_total(first)) < 5e-3 * case_total(first));
  assert_true(last.clamped <= 1e-3 * case_total(first));
  sph_system_free(s);
  let_go(&c);
}

/* The sums themselves, written again: a ledger with a wrong sign or factor would be conserved as well. */
TEST(ledger_by_hand) {
  const struct case_block block = {{4, 3, 5}, {-1e-3, 2e-3, 5e-3}, {3, -7, 11}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700, 1.21, 0);
  double kinetic = 0, internal = 0, px = 0, py = 0, pz = 0, lx = 0, ly = 0, lz = 0, scale = 0;
  for (size_t i = 0; i < p->n; i++) {
    p->mass[i] *= 1 + 0.01 * (double)i, p->energy[i] = 10 + (double)i;
    p->vx[i] += 40 * p->y[i] / spacing, p->vz[i] -= 9 * p->x[i] / spacing;
    const double m = p->mass[i], x = p->x[i], y = p->y[i], z = p->z[i], u = p->vx[i], v = p->vy[i], w = p->vz[i];
    kinetic += m * (u * u + v * v + w * w) / 2, internal += m * p->energy[i], scale += m * sqrt(u * u + v * v + w * w);
    px += m * u, py += m * v, pz += m * w;
    lx += m * (y * w - z * v), ly += m * (z * u - x * w), lz += m * (x * v - y * u);
  }
  const struct sph_body_physics fluid = {.material = case_basalt};
  const struct case_parameters parameters = case_parameters_default();
  SPH_SYSTEM *s = case_system(p, 1, &fluid, &parameters);
  const struct sph_ledger l = sph_system_ledger(s);
  const double got[] = {l.kinetic,
                        l.internal,
                        l.momentum_scale,
                        l.momentum[0],
                        l.momentum[1],
                        l.momentum[2],
                        l.angular_momentum[0],
                        l.angular_momentum[1],
                        l.angular_momentum[2]};
  const double want[] = {kinetic, internal, scale, px, py, pz, lx, ly, lz};
  for (int k = 0; k < 9; k++)
    assert_true(want[k] != 0 && fabs(got[k] / want[k] - 1) < 1e-12); /* the order of sums */
  assert_true(l.work_of_held == 0 && l.damped == 0 && l.clamped == 0 && l.density_held == 0);
}

static double seen_signal[4096], seen_divergence[4096];

/* A hook that only reads. */
static void see_sums(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)s, (void)body;
  for (size_t i = b->low; i < b->high; i++) {
    double *const *g = b->sums->gradient;
    seen_signal[i] = b->sums->signal[i - b->low];
    seen_divergence[i] = g[0][i - b->low] + g[4][i - b->low] + g[8][i - b->low];
  }
}

/* Every limit of the step as defined in motion.h, from the columns, during an impact; the step is the smallest of them.
 */
TEST(limits_by_hand) {
  struct collision c = collide(1000);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  assert_true(s->n <= sizeof seen_signal / sizeof *seen_signal);
  for (size_t b = 0; b < s->body_count; b++)
    s->solid[b].after[s->solid[b].after_count++] = see_sums;
  double share[3] = {0}; /* if the viscous terms or the shear in the Courant limit were missing, the test would fail */
  for (int step = 0; step < 60; step++) {
    case_steps(s, 1);
    double courant = 0, bare = 0, linear = 0, fluid = 0, force = 0, energy = 0, density = 0, damage = 0;
    for (size_t i = 0; i < s->n; i++) {
      const double h = s->c.h[i], sound = s->c.sound_speed[i], left = 1 - pow(s->c.damage[i], 3),
                   signal = fmax(seen_signal[i], 0);
      const double speed = sqrt(sound * sound + 4.0 / 3 * case_basalt.elastic.shear_modulus * left / s->c.density[i]);
      const double pull = sqrt(pow(s->c.ax[i], 2) + pow(s->c.ay[i], 2) + pow(s->c.az[i], 2));
      if (seen_signal[i] < 0)
        continue;
      courant = fmax(courant, (speed + 0.6 * (1.5 * sound + 3 * signal)) / (0.3 * h));
      bare = fmax(bare, speed / (0.3 * h)), linear = fmax(linear, (speed + 0.9 * sound) / (0.3 * h));
      fluid = fmax(fluid, (sound + 0.6 * (1.5 * sound + 3 * signal)) / (0.3 * h));
      force = fmax(force, sqrt(pull / h) / 0.3);
      energy = fmax(energy, 5 * fabs(s->c.energy_rate[i]) / (s->c.energy[i] + 0.01 * sound * sound));
      density = fmax(density, 10 * fabs(seen_divergence[i]));
      damage = fmax(damage, s->c.damage_rate[i] / 0.2);
    }
    const double *worst = s->now.worst;
    /* the density in c_L is that before half the change of its rate: well below a percent */
    assert_true(fabs(worst[SPH_LIMIT_COURANT] / courant - 1) < 0.01);
    assert_true(fabs(worst[SPH_LIMIT_FORCE] - force) <= 1e-9 * force &&
                fabs(worst[SPH_LIMIT_ENERGY] - energy) <= 1e-9 * energy);
    assert_true(fabs(worst[SPH_LIMIT_DENSITY] - density) <= 1e-9 * density &&
                fabs(worst[SPH_LIMIT_DAMAGE] - damage) <= 1e-9 * damage);
    share[0] = fmax(share[0], 1 - bare / courant), share[1] = fmax(share[1], 1 - linear / courant),
    share[2] = fmax(share[2], 1 - fluid / courant);
    const double longest = 1 / fmax(worst[SPH_LIMIT_COURANT], fmax(fmax(force, energy), fmax(density, damage)));
    case_steps(s, 1);
    assert_true(fabs(s->now.last_step / longest - 1) < 1e-9);
  }
  assert_true(share[0] > 0.03 && share[1] > 0.03 && share[2] > 0.03);
  assert_true(sph_system_damage(s, 0, s->body_count) > 0);
  sph_system_free(s);
  let_go(&c);
}

enum { BOOSTED_STEPS = 30 };

/* A fragment at 20 km/s, far from the collision, sets the step. Positions are relative to the moving frame. */
static struct sph_particles *seen_in_flight(const double boost[3], double step[BOOSTED_STEPS], double *time) {
  struct collision c = collide(1000);
  const size_t lonely = c.particles->n - 1;
  c.particles->z[lonely] = 0.1;
  c.particles->vz[lonely] = 2e4;
  for (size_t i = 0; i < c.particles->n; i++) {
    c.particles->vx[i] += boost[0];
    c.particles->vy[i] += boost[1];
    c.particles->vz[i] += boost[2];
  }
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  for (int k = 0; k < BOOSTED_STEPS; k++) {
    case_steps(s, 1);
    step[k] = s->now.last_step;
  }
  *time = s->now.time;
  struct sph_particles *now = c.particles;
  sph_system_read(s, now);
  for (size_t i = 0; i < now->n; i++) {
    now->x[i] -= boost[0] * *time;
    now->y[i] -= boost[1] * *time;
    now->z[i] -= boost[2] * *time;
  }
  c.particles = NULL;
  sph_system_free(s);
  let_go(&c);
  return now;
}

/* Galilean invariance: an observer in motion sees the same steps and the same motion. */
TEST(boosted) {
  const double rest[3] = {0, 0, 0}, boost[3] = {100, -60, 80};
  double step[2][BOOSTED_STEPS], time[2], apart = 0, uneven = 0;
  SPH_PARTICLES *at_rest = seen_in_flight(rest, step[0], &time[0]);
  SPH_PARTICLES *flying = seen_in_flight(boost, step[1], &time[1]);
  for (int k = 0; k < BOOSTED_STEPS; k++)
    uneven = fmax(uneven, fabs(step[1][k] / step[0][k] - 1));
  for (size_t i = 0; i < at_rest->n; i++)
    apart = fmax(apart, fabs(at_rest->x[i] - flying->x[i]) + fabs(at_rest->y[i] - flying->y[i]) +
                            fabs(at_rest->z[i] - flying->z[i]));
  print_message("steps differ by %.1e, places by %.1e of the spacing\n", uneven, apart / spacing);
  assert_true(time[0] * 2e4 > 2 * spacing);
  assert_true(uneven < 1e-9 && apart < 1e-9 * spacing); /* rounding: 1e-16, grown by the blow and by the lists' order */
}

/* h^3 rho is conserved while matter is compressed and expands, within the bounds of h. */
TEST(h_follows_density) {
  struct collision c = collide(3000);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  double densest = 1, thinnest = 1;
  for (int look = 0; look < 6; look++) {
    case_steps(s, 20);
    for (size_t i = 0; i < s->n; i++) {
      const double h = s->c.h[i] / s->c.h_initial[i], density = s->c.density[i] / 2700;
      densest = fmax(densest, density), thinnest = fmin(thinnest, density);
      /* the cube root is a series, within (0.1)^4/24 a step at most */
      if (density > 0.2)
        assert_true(fabs(h * h * h * density - 1) < 1e-3);
    }
  }
  assert_true(densest > 1.1 && thinnest < 0.9);
  sph_system_free(s);
  let_go(&c);
}

/* Damping as strong as three Courant steps allow: motion dies out and no energy is gained. */
TEST(fast_damping) {
  const struct case_block block = {{6, 6, 6}, {0, 0, 0}, {0, 0, 10}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700, 1.21, SPH_WITH_STRESS | SPH_WITH_DAMPING);
  const struct sph_body_physics body = {.material = case_basalt, .strength = true};
  const struct case_parameters parameters = case_parameters_default();
  struct sph_system *s = case_system(p, 1, &body, &parameters);
  const double courant = 1 / s->now.worst[SPH_LIMIT_COURANT];
  sph_system_free(s);
  for (size_t i = 0; i < p->n; i++)
    p->damping[i] = 3 / courant;
  s = case_system(p, 1, &body, &parameters);
  const struct sph_ledger first = sph_system_ledger(s);
  case_steps(s, 40);
  const struct sph_ledger last = sph_system_ledger(s);
  assert_true(s->now.last_step < courant / 3);
  /* the larger root at 0.9 is -0.87: after 40 steps 1e-5 of the energy. So near the bound half as much again is booked
   * as damped; sides have that rate in their outermost layer alone */
  assert_true(last.kinetic < 1e-4 * first.kinetic && last.damped > 0.9 * first.kinetic &&
              last.damped < 1.6 * first.kinetic);
  sph_system_free(s);
}

/* A block's slack is never above the smallest slack of its particles; when used up it is computed again. So no list
 * misses a pair. */
TEST(slack_is_never_overrated) {
  struct collision c = collide(1000);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  size_t kept = 0, looked_up = 0;
  for (int step = 0; step < 300; step++) {
    double before[64];
    assert_true(s->block_count <= 64);
    for (size_t k = 0; k < s->block_count; k++)
      before[k] = s->block[k].slack;
    const uint64_t listings = s->now.listings;
    case_steps(s, 1);
    for (size_t k = 0; k < s->block_count; k++) {
      const struct sph_block *b = &s->block[k];
      if (s->now.listings > listings || b->slack < 0)
        continue;
      assert_true(b->slack <= sph_pairs_slack(s->pairs, b->low, b->high, s->c.x, s->c.y, s->c.z, s->c.h));
      looked_up += b->slack > before[k], kept += b->slack <= before[k];
    }
  }
  print_message("%zu blocks looked up, %zu not, %llu listings\n", looked_up, kept, (unsigned long long)s->now.listings);
  assert_true(looked_up > 0 && kept > looked_up && s->now.listings < 100);
  sph_system_free(s);
  let_go(&c);
}

/* Flaws open by eq. 21, from the damaged stress: E eps = lambda(S) - P under tension, lambda(S) - P/(1-D) under
 * pressure. */
TEST(flaws_open_by_the_damaged_stress) {
  struct collision c = collide(0);
  c.parameters.in.fracture.cap = SPH_CAP_NONE;
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  static const struct {
    double tension, pressure, damage; /* of the weakest flaw's E eps; D */
    bool opens;
  } cases[] = {{2, 0.8, 0, true},       {2, 0.8, 0.5, false}, {2, 1.01, 0, false},
               {2.7, 0.8, 0.5, true},   {0.6, -0.5, 0, true}, {0.6, -0.5, 0.5, true},
               {0.6, -0.3, 0.5, false}, {1.01, 0, 0.9, true}, {3, -3, 1, false}};
  OWNED double *weakest = malloc(s->n * sizeof *weakest);
  memcpy(weakest, s->c.weakest, s->n * sizeof *weakest);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    for (size_t i = 0; i < s->n; i++) {
      const double w = weakest[i];
      s->c.weakest[i] = cases[k].damage < 1 ? w : HUGE_VAL;
      s->c.stress[0][i] = cases[k].tension * w, s->c.stress[3][i] = -0.5 * cases[k].tension * w;
      s->c.stress[1][i] = s->c.stress[2][i] = s->c.stress[4][i] = 0;
      s->c.pressure[i] = cases[k].pressure * w;
      s->c.damage[i] = cbrt(cases[k].damage);
      s->c.open_from[i] = s->c.open_below[i] = 0;
    }
    CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
    for (size_t i = 0; i < s->n; i++)
      if ((s->c.damage_rate[i] > 0) != cases[k].opens)
        fail_msg("case %zu: rate %g", k, s->c.damage_rate[i]);
  }
  sph_system_free(s);
  let_go(&c);
}

/* One load on all particles, in units of the E eps of the weakest flaw: largest principal deviator and pressure. */
static void load_all(struct sph_system *s, double tension, double pressure) {
  for (size_t i = 0; i < s->n; i++) {
    const double w = s->c.weakest[i];
    s->c.stress[0][i] = tension * w;
    s->c.stress[3][i] = -0.5 * tension * w;
    s->c.stress[1][i] = s->c.stress[2][i] = s->c.stress[4][i] = 0;
    s->c.pressure[i] = pressure * w;
  }
}

/* Damage at its cap has no rate: otherwise it would continue to shorten the time step. Below the cap it grows up to the
 * cap and not beyond it. */
TEST(growth_ends_at_the_cap) {
  struct collision c = collide(0);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  static const double share[] = {0.5, 0.999, 1, 1.001}; /* of the cap, in D^(1/3) */
  for (int k = 0; k < 4; k++)
    for (int way = 0; way < 2; way++) { /* a step long beside what is left to grow, a short one */
      s->dt = 0;
      load_all(s, 1.3, 0);
      CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK}); /* finds the cap of this load */
      for (size_t i = 0; i < s->n; i++)
        s->c.damage[i] = share[k] * s->c.damage_cap[i];
      CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
      size_t below_one = 0;
      for (size_t i = 0; i < s->n; i++)
        if (s->c.damage_cap[i] < 0.99) { /* not all of its flaws are open */
          below_one++;
          assert_true((s->c.damage_rate[i] > 0) == (k < 2));
        }
      assert_true(4 * below_one > s->n); /* many have flaws left at this load */
      const double before = s->c.damage[0], rate = s->c.damage_rate[0], cap = s->c.damage_cap[0];
      s->dt = way ? 1e-12 : 1;
      CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
      const double expected = k < 2 ? fmin(before + s->dt * rate, cap) : before;
      assert_true(fabs(s->c.damage[0] - expected) <= 1e-15);
      memset(s->c.damage, 0, s->n * sizeof *s->c.damage);
    }
  sph_system_free(s);
  let_go(&c);
}

/* Heun: half a step by the rate of the old state, half by that of the new one; also where the load has gone. */
TEST(growth_is_the_mean_of_two_rates) {
  struct collision c = collide(0);
  c.parameters.in.fracture.cap = SPH_CAP_NONE;
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  s->dt = 1e-9;
  double grown[3];
  for (int k = 0; k < 3; k++) { /* the load comes, stays, goes */
    const double before = s->c.damage[0];
    load_all(s, k < 2 ? 1.0001 : 0.9, 0);
    CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
    grown[k] = (s->c.damage[0] - before) / (s->dt * s->c.crack_rate[0]); /* one open flaw: D^(1/3) at c_g/R_s */
  }
  assert_true(fabs(grown[0] - 0.5) < 1e-9 && fabs(grown[1] - 1) < 1e-9 && fabs(grown[2] - 0.5) < 1e-9);
  sph_system_free(s);
  let_go(&c);
}

/* Under pressure a flaw closes as damage grows: at the D of this table, E eps = lambda(S) - P/(1-D) falls to its
 * threshold. Damage stops there for any step length, and it never heals. */
TEST(pressure_shuts_flaws) {
  static const struct {
    double tension, pressure, damage; /* of the weakest flaw's E eps; D = 1 - P/(lambda - 1) */
  } cases[] = {{2, 0.8, 0.2}, {3, 0.5, 0.75}, {2, 0.999, 0.001}, {2, 1.001, 0}, {0.9, 0.01, 0}};
  static const double steps[] = {1e-12, 1e-8, 1e-6, 1};
  struct collision c = collide(0);
  c.parameters.in.fracture.cap = SPH_CAP_NONE;
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    for (size_t m = 0; m < sizeof steps / sizeof *steps; m++) {
      memset(s->c.damage, 0, s->n * sizeof *s->c.damage);
      memset(s->c.damage_rate, 0, s->n * sizeof *s->c.damage_rate);
      s->dt = steps[m];
      load_all(s, cases[k].tension, cases[k].pressure);
      for (int pass = 0; pass < 3; pass++)
        CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
      for (size_t i = 0; i < s->n; i++) {
        const double d = pow(s->c.damage[i], 3);
        assert_true(d <= cases[k].damage + 1e-12);
        if (steps[m] == 1)
          assert_true(fabs(d - cases[k].damage) < 1e-7); /* lambda(S) is known to 1e-8 */
      }
    }
  sph_system_free(s);
  let_go(&c);
}

/* A fast body makes lists invalid soon. With slack for many steps each of its particles would list most of the others.
 * Lists are then made for fewer steps, so that a pass sums few surplus pairs. Bodies at rest list for many steps. */
TEST(lists_stay_short_in_a_fast_body) {
  static const double speeds[] = {0, 5000};
  double beyond[2];
  for (int k = 0; k < 2; k++) {
    struct collision c = collide(0);
    for (size_t i = 0; i < c.particles->n; i++)
      c.particles->vx[i] += speeds[k];
    struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
    case_steps(s, 10);
    beyond[k] = sph_pairs_reached(s->pairs) - s->now.neighbours;
    print_message("%g m/s: for %d steps, %.1f neighbours listed beyond the %.1f\n", speeds[k], (int)s->now.horizon,
                  beyond[k], s->now.neighbours);
    assert_true(k ? s->now.horizon < 20 : s->now.horizon == 20);
    sph_system_free(s);
    let_go(&c);
  }
  assert_true(beyond[1] < beyond[0] + 60); /* what lists cost in two steps; 500 with lists for 20 */
}

static size_t columns_of(size_t module, size_t other, const struct sph_body_physics *body) {
  struct sph_module_set modules = {0};
  set_add(modules.word, module, 1);
  set_add(modules.word, other, 1);
  const struct sph_column_set columns = sph_modules_columns(&modules, body);
  return set_size(columns.word, SPH_COLUMNS);
}

TEST(absent) {
  struct collision c = collide(1000);
  struct sph_system *solid = case_system(c.particles, 2, c.physics, &c.parameters);
  for (int b = 0; b < 2; b++)
    c.physics[b].flaws = NULL;
  struct sph_system *whole = case_system(c.particles, 2, c.physics, &c.parameters);
  for (int b = 0; b < 2; b++)
    c.physics[b].strength = false;
  struct sph_system *fluid = case_system(c.particles, 2, c.physics, &c.parameters);
  /* the memory of a module that `clast explain` prints is the memory it adds */
  const struct sph_body_physics cracks = {.strength = true, .flaws = c.flaws[0]};
  assert_int_equal((solid->arena_doubles - whole->arena_doubles) / solid->stride,
                   columns_of(SPH_MODULE_weibull, SPH_MODULE_fracture, &cracks));
  assert_int_equal((whole->arena_doubles - fluid->arena_doubles) / solid->stride,
                   columns_of(SPH_MODULE_elastic, SPH_MODULE_elastic, &cracks));
  assert_true(fluid->arena_doubles < whole->arena_doubles && whole->arena_doubles < solid->arena_doubles);
  assert_non_null(solid->c.damage);
  assert_non_null(solid->c.open_rate);
  assert_null(whole->c.damage);
  assert_null(whole->c.weakest);
  assert_null(whole->c.open_rate);
  assert_non_null(whole->c.stress[0]);
  assert_null(fluid->c.stress[0]);
  assert_null(fluid->c.stress_factor);
  assert_null(fluid->c.distention);
  assert_null(fluid->c.damping);
  assert_null(fluid->held);
  assert_true(fluid->solid[0].before_count < whole->solid[0].before_count);
  /* a fluid projectile on a solid target: each has its own physics */
  c.physics[0].strength = true;
  struct sph_system *mixed = case_system(c.particles, 2, c.physics, &c.parameters);
  assert_true(mixed->solid[1].before_count == fluid->solid[1].before_count);
  case_run(mixed, 2e-6);
  sph_system_read(mixed, c.particles);
  double target = 0;
  for (size_t i = 0; i < c.particles->n; i++)
    if (c.particles->body[i] == 1)
      assert_true(c.particles->stress[0][i] == 0 && c.particles->stress[4][i] == 0);
    else
      target = fmax(target, fabs(c.particles->stress[0][i]));
  assert_true(target > 1e6);
  sph_system_free(solid);
  sph_system_free(whole);
  sph_system_free(fluid);
  sph_system_free(mixed);
  let_go(&c);
}

/* A wall of held particles is pushed by a moving block: its work is booked. A damped one gives its energy to `damped`.
 */
TEST(held) {
  const struct case_block block = {{6, 6, 12}, {0, 0, 0}, {0, 0, 0}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700, 1.21, SPH_WITH_STRESS | SPH_WITH_HELD | SPH_WITH_DAMPING);
  for (size_t i = 0; i < p->n; i++) {
    if (p->z[i] > 10e-3)
      p->held[i] = SPH_HELD_Z, p->vz[i] = 40;
    if (p->z[i] < 6e-3)
      p->damping[i] = 1e6;
    if (p->z[i] < 1e-3)
      p->held[i] = SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z;
  }
  const struct sph_body_physics solid = {.material = case_basalt, .strength = true};
  const struct case_parameters parameters = case_parameters_default();
  SPH_SYSTEM *s = case_system(p, 1, &solid, &parameters);
  const double first = case_total(sph_system_ledger(s));
  case_run(s, 10e-6);
  const struct sph_ledger last = sph_system_ledger(s);
  print_message("work of held %.4e, damped %.4e, change %.2e J\n", last.work_of_held, last.damped,
                case_total(last) - first);
  assert_true(last.work_of_held > 10 * first && last.damped > 0.05 * last.work_of_held);
  assert_true(fabs(case_total(last) - first) < 5e-3 * last.work_of_held); /* as the impact's bound */
  sph_system_read(s, p);
  for (size_t i = 0; i < p->n; i++) {
    if (p->held[i] == SPH_HELD_Z)
      assert_true(p->vz[i] == 40);
    if (p->held[i] > SPH_HELD_Z)
      assert_true(p->vx[i] == 0 && p->vz[i] == 0);
  }
}
