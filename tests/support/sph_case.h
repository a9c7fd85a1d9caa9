/* Small solids for the tests of the moving system: cubic blocks, basalt, and a few measured quantities. */
#pragma once

#include "engine/sph/step/system.h"
#include "tests/support/case_parameters.h"
#include "tests/support/check.h"
#include "tests/support/flaw_row.h"

#define CASE_UNUSED __attribute__((unused))

static const struct sph_material case_basalt = {.density = 2700,
                                                .tillotson = {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7},
                                                .elastic.shear_modulus = 2.27e10,
                                                .yield.stress = 3.5e9,
                                                .melt_energy = 3.4e6,
                                                .tension_limit.pressure = NAN,
                                                .weibull = {8.5, 5e34}};

struct case_block { /* particles at the centres of cubes of `spacing`, from `corner` on */
  size_t count[3];
  double corner[3], velocity[3], spacing;
};

static CASE_UNUSED struct sph_particles *case_make(const struct case_block *blocks, size_t count, double density,
                                                   double h_over_spacing, int arrays) {
  size_t n = 0;
  for (size_t b = 0; b < count; b++)
    n += blocks[b].count[0] * blocks[b].count[1] * blocks[b].count[2];
  struct sph_particles *p = NULL;
  assert_int_equal(sph_particles_make(n, arrays, &p, NULL), STATUS_OK);
  size_t i = 0;
  for (size_t b = 0; b < count; b++) {
    const struct case_block *k = &blocks[b];
    for (size_t z = 0; z < k->count[2]; z++)
      for (size_t y = 0; y < k->count[1]; y++)
        for (size_t x = 0; x < k->count[0]; x++, i++) {
          const double s = k->spacing;
          p->x[i] = k->corner[0] + s * ((double)x + 0.5);
          p->y[i] = k->corner[1] + s * ((double)y + 0.5);
          p->z[i] = k->corner[2] + s * ((double)z + 0.5);
          p->vx[i] = k->velocity[0];
          p->vy[i] = k->velocity[1];
          p->vz[i] = k->velocity[2];
          p->mass[i] = density * s * s * s;
          p->density[i] = density;
          p->h[i] = h_over_spacing * s;
          p->body[i] = (uint8_t)b;
        }
  }
  return p;
}

static CASE_UNUSED struct sph_flaws *case_flaws(size_t n, double volume, uint64_t seed, uint64_t body) {
  const struct sph_flaw_law law = {.weibull = case_basalt.weibull, .seed = seed, .body = body};
  return flaw_row(&law, n, volume);
}

static CASE_UNUSED struct sph_system *case_system(const struct sph_particles *p, size_t bodies,
                                                  const struct sph_body_physics *physics,
                                                  const struct case_parameters *parameters) {
  struct sph_system *s = NULL;
  OK(sph_system_create(p, bodies, physics, &parameters->in, &parameters->domain, &s, &error));
  return s;
}

static CASE_UNUSED void case_steps(struct sph_system *s, int steps) {
  for (int k = 0; k < steps; k++)
    if (!sph_system_step(s, HUGE_VAL))
      fail_msg("step %d: %s", k, s->failure);
}

static CASE_UNUSED void case_run(struct sph_system *s, double until) {
  while (s->now.time < until)
    if (!sph_system_step(s, until))
      fail_msg("at %g s: %s", s->now.time, s->failure);
}

/* One loop of a module. */
struct case_loop {
  int module, stage; /* enum sph_module_index, enum sph_stage */
};

/* Runs these loops over all blocks, with the same terms; loops of rates see simple shear, dv_x/dy = 1/s. Bodies without
 * the module are included unless `only_on`. */
static CASE_UNUSED void case_loops(struct sph_system *s, const struct case_loop *loops, size_t count, bool only_on) {
  double zero[SPH_BLOCK] = {0}, one[SPH_BLOCK];
  for (size_t i = 0; i < SPH_BLOCK; i++)
    one[i] = 1;
  struct sph_pair_sums sums = {.ax = zero, .ay = zero, .az = zero, .heating = zero, .signal = zero};
  for (int k = 0; k < 9; k++)
    sums.gradient[k] = k == 1 ? one : zero;
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *block = &s->block[k];
    const struct sph_solid *body = &s->solid[block->body];
    struct sph_terms terms = {.solid_density = s->c.density + block->low};
    block->sums = &sums;
    block->terms = &terms;
    for (size_t l = 0; l < count; l++)
      if (!only_on || set_has(body->modules.word, (size_t)loops[l].module))
        s->ranges->module[loops[l].module][loops[l].stage](s, body, block);
    block->sums = NULL;
    block->terms = NULL;
  }
}
#define CASE_LOOPS(s, only_on, ...)                                                                                    \
  case_loops(s, (const struct case_loop[]){__VA_ARGS__},                                                               \
             sizeof((const struct case_loop[]){__VA_ARGS__}) / sizeof(struct case_loop), only_on)

/* From the yield limit to the stress that has returned to it. */
#define CASE_YIELD(s)                                                                                                  \
  CASE_LOOPS(s, true, {SPH_MODULE_yield, SPH_YIELD}, {SPH_MODULE_tension_limit, SPH_YIELD},                            \
             {SPH_MODULE_palpha, SPH_YIELD_OF_BODY}, {SPH_MODULE_elastic, SPH_RETURN})

static CASE_UNUSED double case_total(struct sph_ledger l) {
  return l.kinetic + l.internal + l.damped - l.work_of_held;
}
