/* The front of a crack (module crack_front): its speed, its plane, the tension it needs, its effect on a particle, and
 * identical bits after a restart. A cube under even tension along z, whose ends are held, with one flaw, in its middle.
 */
#include "engine/sph/body/flaws.h"
#include "engine/sph/material/material.h"
#include "engine/sph/step/system.h"
#include "tests/support/sph_solid.h"

static const double side = 0.01, load = 4e-4; /* m; strain */

/* A flaw of the particle nearest to the middle opens at once, all others never do. */
static struct sph_flaws *one_flaw(const struct sph_particles *p, size_t *middle) {
  struct sph_flaws *flaws = calloc(1, sizeof *flaws);
  flaws->particles = flaws->count = p->n;
  flaws->first = malloc((p->n + 1) * sizeof *flaws->first);
  flaws->log_strain = malloc(p->n * sizeof *flaws->log_strain);
  double nearest = INFINITY;
  for (size_t i = 0; i < p->n; i++) {
    const double r = sqrt(p->x[i] * p->x[i] + p->y[i] * p->y[i] + p->z[i] * p->z[i]);
    flaws->first[i] = i;
    flaws->log_strain[i] = 0;
    if (r < nearest)
      nearest = r, *middle = i;
  }
  flaws->first[p->n] = p->n;
  flaws->log_strain[*middle] = log(0.9 * load);
  return flaws;
}

static struct solid_case pulled(int front, double arrest, struct sph_flaws **flaws, size_t *middle) {
  struct solid_case c = solid_pulled_cube(side, load);
  c.parameters.in.crack_front.front = front;
  c.parameters.in.crack_front.arrest = arrest;
  *flaws = one_flaw(c.particles, middle);
  c.physics[0].flaws = *flaws;
  return c;
}

/* Reached particles lie within h of the plane. The front was there no earlier than c_g allows, and near the plane at
 * most 6 % later (from neighbour to neighbour it does not run quite straight; measured: 1.9 %) beside one step. No
 * particle near the plane is left out. (Farther from it, broken particles may have taken the tension away before.) */
TEST(speed_and_plane) {
  struct sph_flaws *flaws;
  size_t middle, reached = 0, broken = 0;
  struct solid_case c = pulled(SPH_CRACK_FRONT_PLANE, 0, &flaws, &middle);
  const struct sph_particles *p = c.particles;
  const double h = c.range[0].h, crack_speed = sph_material_crack_speed(&c.physics[0].material);
  solid_start(&c);
  while (c.system->now.time < 0.4 * side / crack_speed)
    solid_step(&c, INFINITY);
  const struct sph_system *s = c.system;
  const double step = s->now.last_step;
  for (size_t k = 0; k < s->n; k++) {
    const size_t i = s->id[k];
    const double x = p->x[i] - p->x[middle], y = p->y[i] - p->y[middle], z = p->z[i] - p->z[middle];
    const double straight = sqrt(x * x + y * y + z * z) / crack_speed, time = s->c.front_time[k];
    const bool was_there = isfinite(time);
    reached += was_there;
    broken += s->c.damage[k] >= 1;
    assert_true(was_there || s->c.damage[k] == 0);
    if (fabs(z) > h * (1 + 1e-9))
      assert_false(was_there);
    if (was_there)
      assert_true(time >= straight);
    if (was_there && fabs(z) < h / 2)
      assert_true(time <= 1.06 * straight + 2 * step);
    if (!was_there && fabs(z) < h / 2)
      assert_true(s->now.time < 1.06 * straight + 2 * step);
  }
  assert_true(reached > 100 && broken > reached / 2);
  sph_flaws_free(flaws);
  solid_end(&c);
}

/* Particles that a front has reached (off: damaged ones) after 40 steps under `times` the load. */
static size_t count_reached(int front, double arrest, double times) {
  struct sph_flaws *flaws;
  size_t middle, reached = 0;
  struct solid_case c = pulled(front, arrest, &flaws, &middle);
  c.particles->damage_cbrt[middle] = 1; /* for any load */
  for (size_t i = 0; i < c.particles->n; i++) {
    for (int k = 0; k < 6; k++)
      c.particles->stress[k][i] *= times;
    c.particles->density[i] = 2700 + times * (c.particles->density[i] - 2700);
  }
  solid_start(&c);
  for (int step = 0; step < 40; step++)
    solid_step(&c, INFINITY);
  for (size_t i = 0; i < c.particles->n; i++)
    reached += front == SPH_CRACK_FRONT_NONE ? c.system->c.damage[i] > 0 : isfinite(c.system->c.front_time[i]) != 0;
  sph_flaws_free(flaws);
  solid_end(&c);
  return reached;
}

/* The front stops where the tension is less than the given share of the flaw's threshold, which is 0.9 times the load.
 * Without the module the crack stays in its particle. */
TEST(tension_and_off) {
  assert_int_equal(count_reached(SPH_CRACK_FRONT_NONE, 0.5, 1), 1);
  assert_true(count_reached(SPH_CRACK_FRONT_PLANE, 0.5, 1) > 50);
  assert_true(count_reached(SPH_CRACK_FRONT_PLANE, 0, 0.1) > 50); /* any tension is enough */
  assert_int_equal(count_reached(SPH_CRACK_FRONT_PLANE, 1, 0.1), 1);
  assert_int_equal(count_reached(SPH_CRACK_FRONT_PLANE, 0.5, -1), 1); /* compression */
}

/* The same bits after a restart at any step as the front comes to the first neighbours, and with two threads. */
TEST(same_bits) {
  struct sph_flaws *flaws;
  size_t middle;
  struct solid_case c = pulled(SPH_CRACK_FRONT_PLANE, 0, &flaws, &middle), again = c;
  solid_start(&c);
  again.parameters.in.fidelity.threads = 2;
  for (int step = 0; step < 8; step++)
    solid_step(&c, INFINITY);
  for (int step = 8; step < 16; step++) {
    solid_resume(&again, c.system);
    solid_step(&c, INFINITY);
    solid_step(&again, INFINITY);
    solid_same(&c, &again);
    sph_system_free(again.system);
  }
  sph_flaws_free(flaws);
  solid_end(&c);
}
