/* Moving solids for tests, through engine/sph/body/bodies.h and engine/sph/step/system.h alone. Any error fails the
 * test.
 *
 *   struct solid_case c = solid_make(1);      parameters at their defaults, bodies empty
 *   c.body[0].shape = ...; c.physics[0].material = solid_basalt(); c.physics[0].strength = true;
 *   solid_build(&c, SPH_WITH_STRESS);       particles at rest in c.particles, to be changed at will
 *   solid_start(&c);                        the system
 *   solid_until(&c, t); solid_read(&c);  c.particles at time t
 *   solid_end(&c); */
#pragma once

#include "engine/sph/body/bodies.h"
#include "engine/sph/material/material.h"
#include "engine/sph/step/system.h"
#include "tests/support/case_parameters.h"
#include "tests/support/check.h"

#define UNUSED __attribute__((unused))

enum { SOLID_BODIES = 3 };

struct solid_case {
  size_t bodies;
  struct sph_body body[SOLID_BODIES];
  struct sph_body_physics physics[SOLID_BODIES];
  struct case_parameters parameters;
  struct sph_range range[SOLID_BODIES];
  struct sph_particles *particles;
  struct sph_system *system;
};

/* Benz & Asphaug 1994, 1995. */
UNUSED static struct sph_material solid_basalt(void) {
  return (struct sph_material){.density = 2700,
                               .tillotson = {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7},
                               .elastic.shear_modulus = 2.27e10,
                               .yield.stress = 3.5e9,
                               .melt_energy = 3.4e6,
                               .tension_limit.pressure = NAN,
                               .weibull = {8.5, 5e34}};
}

/* Melosh 1989. */
UNUSED static struct sph_material solid_aluminium(void) {
  return (struct sph_material){.density = 2700,
                               .tillotson = {7.52e10, 6.5e10, 0.5, 1.63, 5, 5, 5e6, 3e6, 1.39e7},
                               .elastic.shear_modulus = 2.69e10,
                               .yield.stress = 2.76e8,
                               .melt_energy = NAN,
                               .tension_limit.pressure = NAN,
                               .weibull = {NAN, NAN}};
}

UNUSED static double solid_young(const struct sph_material *m) {
  return 9 * m->tillotson.A * m->elastic.shear_modulus / (3 * m->tillotson.A + m->elastic.shear_modulus);
}
UNUSED static double solid_poisson(const struct sph_material *m) {
  return (3 * m->tillotson.A - 2 * m->elastic.shear_modulus) / (2 * (3 * m->tillotson.A + m->elastic.shear_modulus));
}

struct solid_jump {
  double shock, density, pressure, energy;
};

/* State behind a shock that accelerates matter at rest to the velocity up: rho0 Us = rho (Us - up), P = rho0 Us up, u =
 * up^2/2. Us between the bulk sound speed and 5 up + c by bisection. */
UNUSED static struct solid_jump solid_hugoniot(const struct sph_material *m, double up) {
  double low = up * (1 + 1e-9), high = 5 * up + sqrt(m->tillotson.A / m->density);
  struct solid_jump j = {0};
  for (int it = 0; it < 200; it++) {
    j.shock = (low + high) / 2;
    j.density = m->density * j.shock / (j.shock - up);
    j.energy = up * up / 2;
    j.pressure = m->density * j.shock * up;
    if (sph_tillotson(&m->tillotson, m->density, j.density, j.energy).pressure > j.pressure)
      low = j.shock; /* compressed too much: the shock is faster */
    else
      high = j.shock;
  }
  return j;
}

UNUSED static bool solid_full(void) {
  const char *full = getenv("CLAST_FULL");
  return full && strcmp(full, "1") == 0;
}

/* Under the sanitizers a run takes twenty times as long: tests keep their coarsest form there. */
#ifdef __SANITIZE_ADDRESS__
enum { SOLID_SLOW = 1 };
#else
enum { SOLID_SLOW = 0 };
#endif

UNUSED static struct solid_case solid_make(size_t bodies) {
  struct solid_case c = {.bodies = bodies, .parameters = case_parameters_default()};
  for (size_t b = 0; b < SOLID_BODIES; b++) {
    c.body[b].h_over_spacing = NAN;
    c.body[b].lattice.particles = NAN;
    c.body[b].lattice.grading.growth = NAN;
  }
  return c;
}

UNUSED static void solid_build(struct solid_case *c, int arrays) {
  for (size_t b = 0; b < c->bodies; b++)
    c->body[b].density = c->physics[b].material.density;
  if (sph_bodies_make(c->body, c->bodies, arrays, &c->particles, c->range, &error))
    fail_msg("bodies: %s", error.message);
  c->parameters.domain.spacing_over_h = c->range[0].nearest / c->range[0].h;
}

UNUSED static void solid_start(struct solid_case *c) {
  if (sph_system_create(c->particles, c->bodies, c->physics, &c->parameters.in, &c->parameters.domain, &c->system,
                        &error))
    fail_msg("system: %s", error.message);
}

UNUSED static void solid_step(struct solid_case *c, double until) {
  if (!sph_system_step(c->system, until))
    fail_msg("step: %s", c->system->failure);
}

UNUSED static void solid_until(struct solid_case *c, double until) {
  while (c->system->now.time < until)
    solid_step(c, until);
}

UNUSED static void solid_read(struct solid_case *c) {
  sph_system_read(c->system, c->particles);
}

UNUSED static void solid_end(struct solid_case *c) {
  sph_system_free(c->system);
  sph_particles_free(c->particles);
  c->system = NULL;
  c->particles = NULL;
}

/* Energy error, J: energy added by clamps, which the ledger lists separately, counts as error. `start` is the ledger at
 * time 0. */
UNUSED static double solid_energy_error(struct solid_case *c, struct sph_ledger start) {
  struct sph_ledger now = sph_system_ledger(c->system);
  return now.contact + now.kinetic + now.internal + now.damped - now.work_of_held - start.kinetic - start.internal;
}

/* A bar along direction 0-2, `length` long, that is one block of an endless solid across: the thinnest cross-section in
 * which no particle meets its own image. The lattice is periodic across the bar, and also along it if `endless`. */
UNUSED static void solid_bar(struct solid_case *c, int kind, int along, double length, double spacing, bool endless) {
  struct sph_body *b = &c->body[0];
  double reach = 4 * SPH_BODIES_H * spacing * (1 + c->parameters.in.fidelity.skin) * 1.05;
  b->shape.kind = SPH_SHAPE_BOX;
  b->lattice.kind = kind;
  b->lattice.spacing = spacing;
  for (int d = 0; d < 3; d++) {
    b->shape.side[d] = d == along ? length : sph_lattice_period(kind, spacing, d, reach);
    b->shape.centre[d] = b->shape.side[d] / 2;
    b->lattice.periodic[d] = d != along || endless;
    c->parameters.domain.periodic[d] = b->lattice.periodic[d] ? b->shape.side[d] : (double)NAN;
  }
}

UNUSED static double *solid_position(struct sph_particles *p, int d) {
  return d == 0 ? p->x : d == 1 ? p->y : p->z;
}
UNUSED static double *solid_velocity(struct sph_particles *p, int d) {
  return d == 0 ? p->vx : d == 1 ? p->vy : p->vz;
}

/* Order of convergence from three values with resolutions in the ratio 1 : ratio : ratio^2; the limit need not be
 * known. */
UNUSED static double solid_order(double coarse, double middle, double fine, double ratio) {
  return log(fabs((coarse - middle) / (middle - fine))) / log(ratio);
}

/* Follows an oscillating amplitude from its maximum: times of zero crossings and the extremes between them. */
struct solid_swing {
  double time, value; /* of the last sample */
  double start;       /* the first value */
  int crossings;
  double crossing[3]; /* s */
  double extreme[4];  /* largest |value| before the first, second, ... crossing */
};
UNUSED static void solid_swing_add(struct solid_swing *s, double time, double value) {
  if (s->start == 0)
    s->start = value;
  else if (s->value * value < 0 && s->crossings < 3)
    s->crossing[s->crossings++] = s->time + (time - s->time) * s->value / (s->value - value);
  if (fabs(value) > s->extreme[s->crossings])
    s->extreme[s->crossings] = fabs(value);
  s->time = time;
  s->value = value;
}
/* From the first to the third zero: one period. */
UNUSED static double solid_swing_period(const struct solid_swing *s) {
  assert_int_equal(s->crossings, 3);
  return s->crossing[2] - s->crossing[0];
}

/* A cube of about 4000 basalt particles in equilibrium under tension along z alone, at this strain; its ends along z
 * are held. The caller makes the system. */
UNUSED static struct solid_case solid_pulled_cube(double side, double strain) {
  struct solid_case c = solid_make(1);
  c.physics[0].material = solid_basalt();
  c.physics[0].strength = true;
  c.body[0].shape = (struct sph_shape){.kind = SPH_SHAPE_BOX, .side = {side, side, side}};
  c.body[0].lattice.particles = 4000;
  solid_build(&c, SPH_WITH_STRESS | SPH_WITH_DAMAGE | SPH_WITH_HELD);
  sph_bodies_hold(c.particles, c.range[0], side / 2 - 2 * c.range[0].h, SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z);
  struct sph_particles *p = c.particles;
  const struct sph_material *m = &c.physics[0].material;
  const double stress = solid_young(m) * strain, shrunk = 1 - (1 - 2 * solid_poisson(m)) * strain;
  for (size_t i = 0; i < p->n; i++) {
    p->density[i] = m->density * shrunk;
    p->mass[i] *= shrunk;
    p->stress[0][i] = p->stress[3][i] = -stress / 3;
    p->stress[5][i] = 2 * stress / 3;
  }
  return c;
}

/* Makes the system of `c` again and gives it the state of another one, as a restart does. */
UNUSED static void solid_resume(struct solid_case *c, const struct sph_system *from) {
  size_t size;
  OWNED void *state = sph_system_state_copy(from, &size);
  solid_start(c);
  assert_true(sph_system_state_load(c->system, state, size));
}

/* Fails unless both systems have the same state, bit by bit. */
UNUSED static void solid_same(const struct solid_case *a, const struct solid_case *b) {
  size_t size, size_b;
  OWNED void *state = sph_system_state_copy(a->system, &size), *other = sph_system_state_copy(b->system, &size_b);
  assert_int_equal(size, size_b);
  assert_memory_equal(state, other, size);
}
