/* Time to find the fragments: half-shattered spheres on a hexagonal lattice, as at the end of an impact. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include "engine/random.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/observe/observe.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(void) {
  const double sizes[] = {1e4, 1e5, 1e6};
  for (int k = 0; k < 3; k++) {
    struct sph_body body = {.shape = {.kind = SPH_SHAPE_SPHERE, .radius = 0.03},
                            .density = 2700,
                            .h_over_spacing = NAN};
    struct sph_particles *p;
    struct sph_range range;
    struct error error = {0};
    body.lattice = (struct sph_lattice){.kind = SPH_LATTICE_HEXAGONAL, .particles = sizes[k]};
    if (sph_bodies_make(&body, 1, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &p, &range, &error)) {
      fprintf(stderr, "%s\n", error.message);
      return 1;
    }
    for (size_t i = 0; i < p->n; i++) { /* a core with spalls round it; everything else is broken */
      double r = sqrt(p->x[i] * p->x[i] + p->y[i] * p->y[i] + p->z[i] * p->z[i]) / 0.03;
      double wave = sin(500 * p->x[i]) * sin(500 * p->y[i]) * sin(500 * p->z[i]);
      p->damage_cbrt[i] = r > 0.7 && wave < 0.3 + 0.2 * random_draw(1, 900, i, 0);
    }
    struct sph_fragments_options options = sph_fragments_default();
    double best = HUGE_VAL;
    size_t count = 0;
    for (int trial = 0; trial < 5; trial++) {
      struct sph_fragments pieces;
      double begin = now();
      if (sph_fragments_find(p, &options, &pieces, &error))
        return 1;
      best = fmin(best, now() - begin);
      count = pieces.resolved;
      sph_fragments_clear(&pieces);
    }
    printf("sph_fragments_seconds_%zu %.4f s\n", (size_t)sizes[k], best);
    fprintf(stderr, "%zu particles, %zu fragments\n", p->n, count);
    sph_particles_free(p);
  }
  return 0;
}
