/* The moving solid to the last bit: after a restart, with any number of threads; and, except for rounding, for any axes
 * and numbering. */
#include "tests/support/sph_collision.h"

static void assert_same_bits(const struct sph_system *a, const struct sph_system *b) {
  size_t size[2];
  OWNED void *left = sph_system_state_copy(a, &size[0]), *right = sph_system_state_copy(b, &size[1]);
  assert_int_equal(size[0], size[1]);
  assert_memory_equal(left, right, size[0]);
}

TEST(restarted) {
  struct collision c = collide(1000);
  struct sph_system *whole = case_system(c.particles, 2, c.physics, &c.parameters);
  struct sph_system *again = case_system(c.particles, 2, c.physics, &c.parameters);
  for (int cut = 0; cut < 3; cut++) {
    case_steps(whole, 37);
    size_t size;
    OWNED void *bytes = sph_system_state_copy(whole, &size);
    for (size_t k = 0; k < again->block_count; k++)
      again->block[k].slack = 1; /* of where its particles were before */
    assert_true(sph_system_state_load(again, bytes, size));
    for (size_t k = 0; k < again->block_count; k++)
      assert_true(again->block[k].slack < 0); /* to be looked up: the lists may be all but worn */
    assert_false(sph_system_state_load(again, bytes, size - 1));
    case_steps(whole, 41);
    case_steps(again, 41);
    assert_same_bits(whole, again);
  }
  assert_true(whole->now.listings > 2); /* the restart also covers list rebuilds */
  assert_string_equal(again->failure, "");
  sph_system_free(whole);
  sph_system_free(again);
  let_go(&c);
}

/* Every module at once, on two chunks of the pair loop: a porous cracking cube, part of it held and part damped, hit by
 * a solid one. */
static struct collision everything_on(int precision) {
  static const struct sph_palpha_material pores = {.distention = 1.3,
                                                   .curve = SPH_CRUSH_QUADRATIC,
                                                   .elastic_pressure = 5e6,
                                                   .solid_pressure = 3e8,
                                                   .sound_speed = 2000};
  const struct case_block blocks[2] = {{{18, 18, 18}, {0, 0, 0}, {0, 0, 0}, spacing},
                                       {{SMALL, SMALL, SMALL}, {6.3e-3, 7.7e-3, 18.9e-3}, {0, 0, -3000}, spacing}};
  struct collision c = {.parameters = case_parameters_default()};
  c.particles = case_make(blocks, 2, 2700, 1.21,
                          SPH_WITH_STRESS | SPH_WITH_DAMAGE | SPH_WITH_HELD | SPH_WITH_DAMPING | SPH_WITH_DISTENTION);
  const size_t target = 18 * 18 * 18;
  for (size_t i = 0; i < target; i++) {
    c.particles->density[i] /= 1.3, c.particles->mass[i] /= 1.3, c.particles->distention[i] = 1.3;
    if (c.particles->z[i] < 1e-3)
      c.particles->held[i] = SPH_HELD_X | SPH_HELD_Z;
    if (c.particles->x[i] < 2e-3)
      c.particles->damping[i] = 1e6;
  }
  c.flaws[0] = case_flaws(target, (double)target * pow(spacing, 3), 7, 0);
  c.physics[0] = (struct sph_body_physics){.material = case_basalt, .strength = true, .flaws = c.flaws[0]};
  c.physics[0].material.palpha = pores;
  c.physics[1] = (struct sph_body_physics){.material = case_basalt, .strength = true};
  c.physics[1].material.tension_limit.pressure = 1e8;
  c.parameters.in.artificial_stress.epsilon = 0.2;
  c.parameters.domain.spacing_over_h = 1 / 1.21;
  c.parameters.in.gradient_correction.on = true;
  c.parameters.in.method.volume_weights = true;
  c.parameters.in.weibull.flaws = SPH_FLAWS_COMPACT;
  c.parameters.in.fidelity.precision = precision;
  return c;
}

TEST(every_module) {
  for (int precision = SPH_DOUBLE; precision <= SPH_FLOAT; precision++) {
    struct collision c = everything_on(precision);
    struct sph_system *whole = case_system(c.particles, 2, c.physics, &c.parameters);
    c.parameters.in.fidelity.threads = 2;
    struct sph_system *again = case_system(c.particles, 2, c.physics, &c.parameters);
    case_steps(whole, 45);
    size_t size;
    OWNED void *bytes = sph_system_state_copy(whole, &size);
    assert_true(sph_system_state_load(again, bytes, size)); /* in the middle, and with other threads */
    case_steps(whole, 45);
    case_steps(again, 45);
    assert_same_bits(whole, again);
    assert_true(sph_system_damage(whole, 0, whole->body_count) > 0 && whole->now.damped > 0 &&
                whole->now.listings > 1); /* all modules did act */
    double closed = 0;
    for (size_t i = 0; i < whole->n; i++)
      closed = fmax(closed, 1.3 - whole->c.rest_distention[i]);
    assert_true(closed > 0.1);
    sph_system_free(whole);
    sph_system_free(again);
    let_go(&c);
  }
}

/* Physics does not depend on the axes: the same scene with x, y, z permuted, or mirrored, gives the same. */
TEST(no_axis_is_special) {
  enum { PLAIN, TURNED, MIRRORED, SCENES };
  struct sph_particles *seen[SCENES];
  for (int scene = 0; scene < SCENES; scene++) {
    struct collision c = everything_on(SPH_DOUBLE);
    struct sph_particles *p = c.particles;
    double *const at[3] = {p->x, p->y, p->z}, *const v[3] = {p->vx, p->vy, p->vz};
    for (size_t i = 0; i < p->n; i++) {
      double r[3], w[3];
      for (int k = 0; k < 3; k++)
        r[k] = at[k][i], w[k] = v[k][i] + 40 * ((k * 7 + (int)(i % 5)) % 3); /* no direction without motion */
      const unsigned held = p->held[i];
      for (int k = 0; k < 3; k++) {
        const int from = scene == TURNED ? (k + 1) % 3 : k, sign = scene == MIRRORED && k == 0 ? -1 : 1;
        at[k][i] = sign * r[from], v[k][i] = sign * w[from];
        if (scene == TURNED)
          p->held[i] = (uint8_t)((p->held[i] & ~(1u << k)) | (held >> from & 1u) << k);
      }
    }
    struct sph_system *s = case_system(p, 2, c.physics, &c.parameters);
    case_steps(s, 60);
    assert_true(sph_system_damage(s, 0, s->body_count) > 0);
    assert_int_equal(sph_particles_make(p->n, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &seen[scene], NULL), STATUS_OK);
    sph_system_read(s, seen[scene]);
    sph_system_free(s);
    let_go(&c);
  }
  const struct sph_particles *plain = seen[PLAIN];
  double way = 0, speed = 0, stress = 0;
  for (int scene = TURNED; scene < SCENES; scene++)
    for (size_t i = 0; i < plain->n; i++) {
      static const int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
      const struct sph_particles *p = seen[scene];
      double *const at[2][3] = {{plain->x, plain->y, plain->z}, {p->x, p->y, p->z}};
      double *const v[2][3] = {{plain->vx, plain->vy, plain->vz}, {p->vx, p->vy, p->vz}};
      for (int k = 0; k < 3; k++) {
        const int from = scene == TURNED ? (k + 1) % 3 : k, sign = scene == MIRRORED && k == 0 ? -1 : 1;
        way = fmax(way, fabs(at[1][k][i] - sign * at[0][from][i]));
        speed = fmax(speed, fabs(v[1][k][i] - sign * v[0][from][i]));
        for (int l = 0; l < 3; l++) {
          const int other = scene == TURNED ? (l + 1) % 3 : l,
                    both = scene == MIRRORED && (k == 0) != (l == 0) ? -1 : 1;
          stress = fmax(stress, fabs(p->stress[place[k][l]][i] - both * plain->stress[place[from][other]][i]));
        }
      }
      stress = fmax(stress, fabs(p->pressure[i] - plain->pressure[i]));
      assert_true(fabs(p->damage_cbrt[i] - plain->damage_cbrt[i]) < 1e-6);
    }
  print_message("turned or mirrored: %.1e m, %.1e m/s, %.1e Pa\n", way, speed, stress);
  /* sums in another order: roundings of 3 km/s and 10 GPa, grown over 60 steps */
  assert_true(way < 1e-9 * spacing && speed < 1e-9 && stress < 0.1);
  for (int scene = 0; scene < SCENES; scene++)
    sph_particles_free(seen[scene]);
}

TEST(threads) {
  struct collision c = collide(1000);
  struct sph_system *one = case_system(c.particles, 2, c.physics, &c.parameters);
  c.parameters.in.fidelity.threads = 2;
  struct sph_system *two = case_system(c.particles, 2, c.physics, &c.parameters);
  case_steps(one, 60);
  case_steps(two, 60);
  assert_same_bits(one, two);
  sph_system_free(one);
  sph_system_free(two);
  let_go(&c);
}

/* Ids mean nothing to the physics: the same solid with its particles numbered backwards moves the same to the last bit.
 * Only ties on the space-filling curve could change the order of sums; here there are none. */
TEST(renumbered) {
  const struct case_block block = {{6, 5, 4}, {0, 0, 0}, {0, 0, 0}, spacing};
  struct sph_particles *p = case_make(&block, 1, 2700, 1.21, SPH_WITH_STRESS),
                       *q = case_make(&block, 1, 2700, 1.21, SPH_WITH_STRESS);
  const size_t n = p->n;
  for (size_t i = 0; i < n; i++)
    p->vx[i] = 30 * sin(900 * p->z[i]), p->vy[i] = 20 * sin(700 * p->x[i]);
  for (size_t i = 0; i < n; i++) {
    const size_t k = n - 1 - i;
    q->x[i] = p->x[k], q->y[i] = p->y[k], q->z[i] = p->z[k], q->vx[i] = p->vx[k], q->vy[i] = p->vy[k],
    q->vz[i] = p->vz[k];
  }
  const struct sph_body_physics solid = {.material = case_basalt, .strength = true};
  const struct case_parameters parameters = case_parameters_default();
  SPH_SYSTEM *a = case_system(p, 1, &solid, &parameters), *b = case_system(q, 1, &solid, &parameters);
  case_steps(a, 50);
  case_steps(b, 50);
  sph_system_read(a, p);
  sph_system_read(b, q);
  for (size_t i = 0; i < n; i++) {
    const size_t k = n - 1 - i;
    assert_true(p->x[k] == q->x[i] && p->vy[k] == q->vy[i] && p->stress[1][k] == q->stress[1][i] &&
                p->energy[k] == q->energy[i]);
  }
  sph_particles_free(p);
  sph_particles_free(q);
}
