/* The moving solid at its bounds: speeds, clamps, thin matter, states that cannot go on, systems that are refused. */
#include "tests/support/sph_collision.h"

#include "engine/sph/body/bodies.h"

/* At 70 km/s, ten times the speed of sound, a body must not jump into another between two steps. The Courant condition
 * alone would allow this, because it sees only pairs already in reach; the energy would then grow several times. */
TEST(fast) {
  for (int gap = 0; gap < 4; gap++) {
    struct collision c = collide(70000);
    for (size_t i = 0; i < c.particles->n; i++)
      if (c.particles->body[i] == 1)
        c.particles->z[i] += 2e-3 + 0.7e-3 * gap; /* out of each other's reach at first */
    struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
    const struct sph_ledger first = sph_system_ledger(s);
    case_run(s, 0.4e-6);
    const struct sph_ledger last = sph_system_ledger(s);
    print_message("70 km/s: %llu steps, energy %.1e of it, kinetic left %.2f\n", (unsigned long long)s->now.steps,
                  (case_total(last) - case_total(first)) / case_total(first), last.kinetic / first.kinetic);
    assert_true(last.kinetic < 0.8 * first.kinetic);                                    /* they met */
    assert_true(fabs(case_total(last) - case_total(first)) < 5e-3 * case_total(first)); /* as above */
    sph_system_free(s);
    let_go(&c);
  }
}

/* Matter that does more work than its internal energy allows: the ledger books the energy added by the clamp, to the
 * joule. */
TEST(clamps) {
  const struct case_block block = {{6, 6, 6}, {0, 0, 0}, {0, 0, 0}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700, 1.21, 0);
  for (size_t i = 0; i < p->n;
       i++) { /* tension at u = 0: contraction of a stretched solid takes from u what is not there */
    p->density[i] = 2600;
    p->vx[i] = 300 * sin(6000 * p->y[i]);
  }
  const struct sph_body_physics fluid = {.material = case_basalt};
  struct case_parameters parameters = case_parameters_default();
  parameters.in.viscosity.alpha = parameters.in.viscosity.beta = 0; /* no heating: it would hide the clamp */
  parameters.in.fidelity.cfl = 0.03;                                /* the integrator's own error small beside it */
  SPH_SYSTEM *s = case_system(p, 1, &fluid, &parameters);
  const double first = case_total(sph_system_ledger(s));
  case_steps(s, 300);
  const struct sph_ledger last = sph_system_ledger(s);
  print_message("clamped %.4g J, energy gained %.4g J of %.4g\n", last.clamped, case_total(last) - first, first);
  assert_true(last.clamped > 0);
  assert_true(fabs(case_total(last) - first - last.clamped) < 0.01 * last.clamped);
  sph_system_read(s, p);
  for (size_t i = 0; i < p->n; i++)
    assert_true(p->energy[i] >= 0);
}

/* Density does not fall below its bound; energy is conserved. */
TEST(thin) {
  const struct case_block block = {{6, 6, 6}, {0, 0, 0}, {0, 0, 0}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700, 1.21, 0);
  for (size_t i = 0; i < p->n; i++)
    p->energy[i] = 5e7; /* vapour */
  const struct sph_body_physics fluid = {.material = case_basalt};
  struct case_parameters parameters = case_parameters_default();
  parameters.domain.lowest_density = 0.5;
  SPH_SYSTEM *s = case_system(p, 1, &fluid, &parameters);
  case_steps(s, 150);
  assert_true(sph_system_ledger(s).density_held > 0);
  sph_system_read(s, p);
  for (size_t i = 0; i < p->n; i++)
    assert_true(p->density[i] >= 0.5 * 2700);
}

/* The bound itself: that of a particle alone, m W(0) at the largest h it may have. (Of thinner matter P/rho^2 has no
 * bound: nylon debris at 1e-3 of its density has driven runs apart; that takes tens of thousands of particles.) It is a
 * share of what the body has at rest: matter of many pores keeps its density. */
TEST(not_thinner_than_alone) {
  static const struct sph_palpha_material pores = {.distention = 50,
                                                   .curve = SPH_CRUSH_QUADRATIC,
                                                   .elastic_pressure = 1e6,
                                                   .solid_pressure = 1e8,
                                                   .sound_speed = NAN};
  const struct case_parameters parameters = case_parameters_default();
  const double alone = 1 / (M_PI * pow(SPH_HIGHEST_H * SPH_BODIES_H, 3)); /* of the density at rest */
  assert_true(parameters.domain.lowest_density > 0.8 * alone && parameters.domain.lowest_density < 2 * alone);
  const struct case_block block = {{6, 6, 6}, {0, 0, 0}, {0, 0, 0}, spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700.0 / 50, 1.21, SPH_WITH_DISTENTION);
  for (size_t i = 0; i < p->n; i++)
    p->distention[i] = 50;
  struct sph_body_physics body = {.material = case_basalt};
  body.material.palpha = pores;
  SPH_SYSTEM *s = case_system(p, 1, &body, &parameters);
  case_steps(s, 3);
  assert_true(sph_system_ledger(s).density_held == 0);
  sph_system_read(s, p);
  for (size_t i = 0; i < p->n; i++)
    assert_true(fabs(p->density[i] - 54) < 1e-9);
}

TEST(lost) {
  struct collision c = collide(1000);
  struct sph_system *s = case_system(c.particles, 2, c.physics, &c.parameters);
  case_steps(s, 5);
  for (size_t i = 0; i < s->n; i++)
    if (s->id[i] == 123)
      s->c.energy[i] = NAN;
  assert_false(sph_system_step(s, HUGE_VAL));
  print_message("%s\n", s->failure);
  assert_non_null(strstr(s->failure, "is not finite"));
  assert_non_null(strstr(s->failure, "body 0"));
  assert_false(sph_system_step(s, HUGE_VAL)); /* and it remains false */
  sph_system_free(s);
  /* the message of a step that becomes too short names the limit */
  s = case_system(c.particles, 2, c.physics, &c.parameters);
  case_steps(s, 2);
  s->now.worst[SPH_LIMIT_ENERGY] = 1e30;
  assert_false(sph_system_step(s, HUGE_VAL));
  print_message("%s\n", s->failure);
  assert_non_null(strstr(s->failure, "energy limit"));
  sph_system_free(s);
  let_go(&c);
}

TEST(refused) {
  struct collision c = collide(1000);
  struct sph_system *s = NULL;
  struct sph_body_physics lacking[2] = {c.physics[0], c.physics[1]};
  lacking[1].material.elastic.shear_modulus = NAN;
  assert_int_equal(sph_system_create(c.particles, 2, lacking, &c.parameters.in, &c.parameters.domain, &s, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "body 1: shear_modulus"));
  assert_null(s);
  lacking[1] = c.physics[1];
  lacking[0].material.tillotson.E0 = NAN;
  assert_int_equal(sph_system_create(c.particles, 2, lacking, &c.parameters.in, &c.parameters.domain, &s, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "body 0: tillotson.E0"));
  lacking[0] = c.physics[0];
  lacking[0].strength = false;
  assert_int_equal(sph_system_create(c.particles, 2, lacking, &c.parameters.in, &c.parameters.domain, &s, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "flaws but no strength"));
  c.particles->density[40] = NAN;
  assert_int_equal(sph_system_create(c.particles, 2, c.physics, &c.parameters.in, &c.parameters.domain, &s, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "particle 40"));
  c.particles->density[40] = 2700;
  c.particles->body[3] = 1; /* then body 0 again: out of order */
  assert_int_equal(sph_system_create(c.particles, 2, c.physics, &c.parameters.in, &c.parameters.domain, &s, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "out of order"));
  let_go(&c);
}
