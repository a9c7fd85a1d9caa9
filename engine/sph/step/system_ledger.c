#include <math.h>

#include "engine/sph/step/system_layout.h"

/* Sums go block by block and are then added up, so that their rounding grows with the number of blocks, not particles.
 */
static void add_block(const struct sph_system *s, const struct sph_block *b, struct sph_ledger *sum) {
  struct sph_ledger part = {0};
  for (size_t i = b->low; i < b->high; i++) {
    const double m = s->c.mass[i], r[3] = {s->c.x[i], s->c.y[i], s->c.z[i]};
    const double p[3] = {m * s->c.vx[i], m * s->c.vy[i], m * s->c.vz[i]};
    part.kinetic += 0.5 * (p[0] * s->c.vx[i] + p[1] * s->c.vy[i] + p[2] * s->c.vz[i]);
    part.internal += m * s->c.energy[i];
    part.momentum_scale += sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; k++) {
      part.momentum[k] += p[k];
      part.angular_momentum[k] += r[(k + 1) % 3] * p[(k + 2) % 3] - r[(k + 2) % 3] * p[(k + 1) % 3];
    }
  }
  sum->kinetic += part.kinetic;
  sum->internal += part.internal;
  sum->momentum_scale += part.momentum_scale;
  for (int k = 0; k < 3; k++) {
    sum->momentum[k] += part.momentum[k];
    sum->angular_momentum[k] += part.angular_momentum[k];
  }
}

struct sph_ledger sph_system_ledger(const struct sph_system *s) {
  struct sph_ledger sum = {0};
  for (size_t k = 0; k < s->block_count; k++)
    add_block(s, &s->block[k], &sum);
  sum.work_of_held = s->now.work_of_held;
  sum.damped = s->now.damped;
  sum.clamped = s->now.clamped;
  sum.density_held = s->now.density_held;
  return sum;
}
