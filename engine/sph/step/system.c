/* A moving system: its memory, its state between steps, and saving and loading that state. */
#include "engine/sph/step/system.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/restart.h"
#include "engine/sph/modules/weibull_lists.h"
#include "engine/sph/step/system_layout.h"

void sph_system_free(struct sph_system *s) {
  if (!s)
    return;
  for (size_t b = 0; s->solid && b < s->body_count; b++)
    for (size_t m = 0; m < SPH_MODULES; m++)
      if (s->solid[b].prepared[m])
        sph_modules_at(m)->free_prepared(s->solid[b].prepared[m]);
  sph_pairs_free(s->pairs);
  free(s->arena);
  free(s->id);
  free(s->held);
  free(s->order);
  free(s->solid);
  free(s->block);
  free(s);
}

size_t sph_system_bytes(const struct sph_system *s) {
  size_t bytes = sizeof *s + s->arena_doubles * sizeof(double) + s->n * 2 * sizeof(uint32_t) +
                 s->body_count * sizeof *s->solid + s->block_count * sizeof *s->block + sph_pairs_bytes(s->pairs);
  if (s->held)
    bytes += s->n * sizeof *s->held;
  for (size_t b = 0; b < s->body_count; b++)
    for (size_t m = 0; m < SPH_MODULES; m++)
      if (s->solid[b].prepared[m])
        bytes += sph_modules_at(m)->bytes_prepared(s->solid[b].prepared[m]);
  return bytes;
}

int sph_system_fault(const struct sph_system *s) {
  return s->fault;
}
const char *sph_system_failure(const struct sph_system *s) {
  return s->failure;
}
double sph_system_time(const struct sph_system *s) {
  return s->now.time;
}
double sph_system_last_step(const struct sph_system *s) {
  return s->now.last_step;
}
int sph_system_limiter(const struct sph_system *s) {
  return (int)s->now.limiter;
}
uint64_t sph_system_steps(const struct sph_system *s) {
  return s->now.steps;
}
double sph_system_neighbours(const struct sph_system *s) {
  return s->now.neighbours;
}

void sph_system_read(const struct sph_system *s, struct sph_particles *out) {
  sph_system_columns_read(s, out);
}

static const struct sph_weibull_lists *flaws_of(const struct sph_solid *body) {
  return body->prepared[SPH_MODULE_weibull];
}

bool sph_system_flaws(const struct sph_system *s, uint32_t *count) {
  bool any = false;
  for (size_t b = 0; b < s->body_count; b++)
    any |= flaws_of(&s->solid[b]) != NULL;
  for (size_t b = 0; any && b < s->body_count; b++) {
    const struct sph_solid *body = &s->solid[b];
    for (size_t i = body->first; i < body->last; i++) /* bodies stand in the order of their ids */
      count[i] = flaws_of(body) ? sph_weibull_total(flaws_of(body), i - body->first) : 0;
  }
  return any;
}

double sph_system_damage(const struct sph_system *s, double *rate) {
  double volume = 0, damage = 0, growth = 0;
  for (size_t b = 0; b < s->body_count; b++) {
    const struct sph_solid *body = &s->solid[b];
    const double *by_flaws = sph_solid_has(body, SPH_COLUMN(flaw_damage)) ? s->c.flaw_damage : s->c.damage;
    if (!flaws_of(body))
      continue;
    for (size_t i = body->first; i < body->last; i++) {
      const double v = s->c.mass[i], d = s->c.damage[i];
      volume += v;
      damage += v * d * d * d;
      growth += v * 3 * by_flaws[i] * by_flaws[i] * s->c.damage_rate[i];
    }
  }
  if (rate)
    *rate = volume > 0 ? growth / volume : 0;
  return volume > 0 ? damage / volume : 0;
}

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

/* ---- saving and loading ----
 *
 * All data on which the next step depends are saved. Lists are not saved: they are made again from the positions at
 * which they were made, in the same order, and the pair loop sums in that order. */

enum { BLOCKS = SPH_COLUMNS + 10 };

static size_t saved(struct sph_system *s, struct restart_block out[BLOCKS]) {
  double *column[SPH_COLUMNS];
  size_t count = 0;
  const size_t columns = sph_system_columns_list(s, column);
  out[count++] = (struct restart_block){&s->n, sizeof s->n};
  out[count++] = (struct restart_block){&s->now, sizeof s->now};
  for (size_t k = 0; k < columns; k++)
    out[count++] = (struct restart_block){column[k], s->n * sizeof(double)};
  for (int k = 0; k < 5; k++)
    out[count++] = (struct restart_block){sph_pairs_listed(s->pairs)[k], s->n * sizeof(double)};
  out[count++] = (struct restart_block){s->id, s->n * sizeof *s->id};
  if (s->held)
    out[count++] = (struct restart_block){s->held, s->n};
  return count;
}

size_t sph_system_state_size(const struct sph_system *system) {
  struct sph_system view = *system; /* blocks need a writable system; here they are only counted */
  struct restart_block blocks[BLOCKS];
  return restart_blocks_size(blocks, saved(&view, blocks));
}

void sph_system_state_save(const struct sph_system *system, void *bytes) {
  struct sph_system view = *system;
  struct restart_block blocks[BLOCKS];
  restart_blocks_save(blocks, saved(&view, blocks), bytes);
}

bool sph_system_state_load(struct sph_system *s, const void *bytes, size_t size) {
  struct restart_block blocks[BLOCKS];
  size_t n;
  if (size != sph_system_state_size(s))
    return false;
  memcpy(&n, bytes, sizeof n);
  if (n != s->n)
    return false;
  restart_blocks_load(blocks, saved(s, blocks), bytes);
  for (size_t i = 0; i < n; i++)
    if (s->id[i] >= n) {
      s->fault = SPH_FAULT_NOT_FINITE;
      snprintf(s->failure, sizeof s->failure, "the state read back is no state of this system");
      return false;
    }
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->restored)
        sph_modules_at(m)->restored(s, &s->solid[b]);
  s->fault = SPH_FAULT_NONE;
  s->failure[0] = '\0';
  return sph_system_list_again(s);
}
