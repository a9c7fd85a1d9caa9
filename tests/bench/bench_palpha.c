/* Cost of porosity: the same impact with and without pores; time per particle-step and bytes per particle. Prints `name
 * value unit`. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "engine/sph/material/material.h"
#include "engine/sph/step/system.h"
#include "tests/support/allocated.h"
#include "tests/support/case_parameters.h"

enum { ROUNDS = 3, STEPS = 60, N = 24, SMALL = 6 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A block of porous ice (or of the same ice without pores) and a solid projectile at 3 km/s, with strength and flaws.
 */
static struct sph_system *make(const struct sph_material *material, bool pores, bool flaws) {
  const size_t large = N * N * N, small = SMALL * SMALL * SMALL;
  const double dx = 1e-3;
  struct sph_particles *p;
  if (sph_particles_make(large + small, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &p, NULL) != STATUS_OK)
    exit(1);
  for (size_t i = 0; i < p->n; i++) {
    size_t k = i < large ? i : i - large, side = i < large ? N : SMALL;
    double shift = i < large ? 0 : 0.5 * (N - SMALL);
    p->x[i] = dx * ((double)(k % side) + 0.5 + shift);
    p->y[i] = dx * ((double)(k / side % side) + 0.5 + shift);
    p->z[i] = dx * ((double)(k / side / side) + 0.5 + (i < large ? 0 : N));
    p->vz[i] = i < large ? 0 : -3000;
    p->body[i] = i >= large;
    p->density[i] = material->density / (pores && i < large ? material->palpha.distention : 1);
    p->mass[i] = p->density[i] * dx * dx * dx;
    p->h[i] = 1.2 * dx;
  }
  const struct sph_flaw_law law = {.weibull = material->weibull, .seed = 1};
  const double edge = N * dx;
  const struct sph_shape cube = {.kind = SPH_SHAPE_BOX,
                                 .centre = {edge / 2, edge / 2, edge / 2},
                                 .side = {edge, edge, edge}};
  struct sph_flaws *list = NULL;
  if (flaws && sph_flaws_place(&law, &cube, p, (struct sph_range){.n = large}, HUGE_VAL, &list, NULL) != STATUS_OK)
    exit(1);
  struct sph_body_physics bodies[2] = {{.material = *material, .strength = true, .flaws = list},
                                       {.material = *material, .strength = true}};
  bodies[1].material.palpha.curve = SPH_CRUSH_NONE;
  if (!pores)
    bodies[0].material.palpha.curve = SPH_CRUSH_NONE;
  struct case_parameters parameters = case_parameters_default();
  struct sph_system *s;
  struct error error;
  if (sph_system_create(p, 2, bodies, &parameters.in, &parameters.domain, &s, &error) != STATUS_OK) {
    fprintf(stderr, "%s\n", error.message);
    exit(1);
  }
  sph_flaws_free(list);
  sph_particles_free(p);
  return s;
}

/* Time of the loop of the pores alone (or of Tillotson's loop, which it replaces) on the current state of the run. The
 * loop does not change this state. */
static double loop(struct sph_system *s, sph_hook hook) {
  static double none[SPH_BLOCK];
  struct sph_pair_sums still = {0};
  double best = HUGE_VAL;
  for (int k = 0; k < 9; k++)
    still.gradient[k] = none;
  for (size_t k = 0; k < s->block_count; k++)
    s->block[k].sums = &still;
  for (int round = 0; round < 20; round++) {
    double start = now();
    for (size_t k = 0; k < s->block_count; k++)
      if (s->block[k].high > s->block[k].low) /* the bodies that have the module */
        hook(s, &s->solid[s->block[k].body], &s->block[k]);
    best = fmin(best, now() - start);
  }
  for (size_t k = 0; k < s->block_count; k++)
    s->block[k].sums = NULL;
  return best / (double)s->n;
}

int main(void) {
  struct sph_material material;
  struct error error;
  if (sph_materials_load("porous-ice", &material, &error) != STATUS_OK)
    return 1;
  const double particles = N * N * N + SMALL * SMALL * SMALL;
  double loops[2] = {HUGE_VAL, HUGE_VAL}, limit = HUGE_VAL;
  double best[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, bytes[3] = {0};
  for (int round = 0; round < ROUNDS; round++)
    for (int pores = 0; pores < 3; pores++) { /* without; with; alpha_0 = 1 */
      struct sph_material m = material;
      if (pores == 2)
        m.palpha.distention = 1;
      const size_t before = allocated();
      struct sph_system *s = make(&m, pores > 0, true);
      double start = now();
      for (int k = 0; k < STEPS; k++)
        if (!sph_system_step(s, HUGE_VAL))
          return 1;
      best[pores] = fmin(best[pores], (now() - start) / (STEPS * particles));
      if (pores < 2) {
        sph_hook hook = s->ranges->module[pores ? SPH_MODULE_palpha : SPH_MODULE_tillotson][SPH_RESPOND];
        for (size_t k = 0; pores && k < s->block_count; k++)
          if (!set_has(s->solid[s->block[k].body].modules.word, SPH_MODULE_palpha))
            s->block[k].high = s->block[k].low; /* the projectile has no pores */
        loops[pores] = fmin(loops[pores], loop(s, hook));
        if (pores)
          limit = fmin(limit, loop(s, s->ranges->module[SPH_MODULE_palpha][SPH_RATES]));
      }
      bytes[pores] = (double)(allocated() - before) / particles;
      sph_system_free(s);
    }
  printf("palpha_solid_particle_step %.1f ns\n", 1e9 * best[0]);
  printf("palpha_porous_particle_step %.1f ns\n", 1e9 * best[1]);
  printf("palpha_porous_over_solid %.3f 1\n", best[1] / best[0]);
  printf("palpha_distention_1_over_solid %.3f 1\n", best[2] / best[0]);
  printf("palpha_loop %.1f ns\n", 1e9 * loops[1]);
  printf("palpha_limit_loop %.1f ns\n", 1e9 * limit);
  printf("palpha_tillotson_loop %.1f ns\n", 1e9 * loops[0]);
  printf("palpha_solid_bytes %.0f B\n", bytes[0]);
  printf("palpha_porous_bytes %.0f B\n", bytes[1]);
  return 0;
}
