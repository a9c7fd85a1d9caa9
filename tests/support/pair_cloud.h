/* Particles with all fields that the pair loop reads, drawn from a seed, for its tests. Uses cmocka: include it after
 * cmocka's headers. */
#pragma once

#include <math.h>
#include <stdlib.h>

#include "engine/sph/pairs/pairs.h"
#include "tests/support/noise.h"

enum { SIDE = 22, LARGE = 36, MOST = LARGE * LARGE * LARGE, COLUMNS = 11 }; /* SIDE: three chunks; LARGE: twelve */

struct cloud {
  double a[COLUMNS][MOST], stress[5][MOST], factor[MOST], slack[MOST], damage[MOST]; /* a: x y z h vx vy vz m rho c p */
  size_t n;
};

static const char *const classes[] = {"baseline", "v3", "v4"};

static const struct sph_pair_options usual = {.viscosity = {.alpha = 1.5, .beta = 3},
                                              .strength = true,
                                              .spacing_over_h = 0.9,
                                              .periodic = {NAN, NAN, NAN},
                                              .fidelity.threads = 1};

/* A jittered cubic lattice of `spacing` with all fields drawn; when `mixed` every 50th particle is up to 10 times
 * larger. */
static inline struct cloud *cloud_make(int side, double spacing, bool mixed, uint64_t seed) {
  struct cloud *c = calloc(1, sizeof *c);
  assert_non_null(c);
  for (int i = 0; i < side * side * side; i++, c->n++) {
    const int at[3] = {i % side, i / side % side, i / side / side};
    for (int d = 0; d < 3; d++)
      c->a[d][i] = spacing * (at[d] + 0.5 + 0.2 * noise(&seed));
    c->a[3][i] = 1.2 * spacing * (mixed && i % 50 == 0 ? 5.5 + 9 * noise(&seed) : 1);
    for (int k = 4; k < 7; k++)
      c->a[k][i] = noise(&seed);
    c->a[7][i] = pow(spacing, 3) * (1 + noise(&seed)), c->a[8][i] = 1 + 0.1 * noise(&seed),
    c->a[9][i] = 1 + 0.2 * noise(&seed);
    c->a[10][i] = noise(&seed);
    for (int k = 0; k < 5; k++)
      c->stress[k][i] = 1e9 * noise(&seed);
    c->factor[i] = i % 9 == 0 ? 0 : 1e-9 * (1 + noise(&seed));
    c->slack[i] = 0.05 * c->a[3][i];
  }
  return c;
}

static inline double slack_of(const struct cloud *c, const struct sph_pairs *pairs) {
  return sph_pairs_slack(pairs, 0, c->n, c->a[0], c->a[1], c->a[2], c->a[3]);
}
