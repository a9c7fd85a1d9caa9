/* A small collision that breaks both bodies, for tests of the moving solid. */
#pragma once

#include "tests/support/sph_case.h"

#include "engine/sph/step/system.h"

enum { SIDE = 8, SMALL = 3 };
static const double spacing = 1e-3;

struct collision {
  struct sph_particles *particles;
  struct sph_flaws *flaws[2];
  struct sph_body_physics physics[2];
  struct case_parameters parameters;
};

/* A basalt cube, hit off centre by a small one at 1 km/s; both crack. */
static inline struct collision collide(double speed) {
  const struct case_block blocks[2] = {
      {{SIDE, SIDE, SIDE}, {0, 0, 0}, {0, 0, 0}, spacing},
      {{SMALL, SMALL, SMALL}, {1.3e-3, 2.7e-3, 8.9e-3}, {0, 0, -speed}, spacing},
  };
  struct collision c = {.parameters = case_parameters_default()};
  c.particles = case_make(blocks, 2, 2700, 1.21, SPH_WITH_STRESS | SPH_WITH_DAMAGE);
  for (int b = 0; b < 2; b++) {
    const size_t n = blocks[b].count[0] * blocks[b].count[1] * blocks[b].count[2];
    c.flaws[b] = case_flaws(n, (double)n * pow(spacing, 3), 7, (uint64_t)b);
    c.physics[b] = (struct sph_body_physics){.material = case_basalt, .strength = true, .flaws = c.flaws[b]};
  }
  return c;
}

static inline void let_go(struct collision *c) {
  sph_particles_free(c->particles);
  sph_flaws_free(c->flaws[0]);
  sph_flaws_free(c->flaws[1]);
}
