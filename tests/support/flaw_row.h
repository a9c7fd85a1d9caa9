/* Flaws of particles that need no shape of their own: a row of n equal cubes of this volume (m^3) together. */
#pragma once

#include "engine/sph/body/flaws.h"
#include "tests/support/check.h"

static __attribute__((unused)) struct sph_flaws *flaw_row(const struct sph_flaw_law *law, size_t n, double volume) {
  const double side = cbrt(volume / (double)n);
  const struct sph_shape row = {.kind = SPH_SHAPE_BOX, .side = {volume / (side * side), side, side}};
  struct sph_particles *p = NULL;
  struct sph_flaws *flaws = NULL;
  OK(sph_particles_make(n, 0, &p, &error));
  for (size_t i = 0; i < n; i++) {
    p->x[i] = side * ((double)i + 0.5 - (double)n / 2);
    p->mass[i] = 1;
  }
  OK(sph_flaws_place(law, &row, p, (struct sph_range){.n = n, .mass = (double)n}, INFINITY, &flaws, &error));
  sph_particles_free(p);
  return flaws;
}
