/* The order of a step, and why: physics modules in modules.c; here what stands around them.
 *
 *   predict x v rho u h S D | pressure, yield, open flaws, damaged stress | one pair loop | rates, half the change of rates
 *
 * Everything happens block by block, so that the columns of a block are read once from memory before the pair loop and once
 * after it. */
#include "engine/sph/system_step.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/sph/limits.h"
#include "engine/sph/order.h"

enum { LISTINGS_PER_SORT = 8, STEPS_PER_LISTING = 20, ROOM = 4 }; /* ROOM: most slack, in h */
static const double collapse = 1e-6; /* of the first step: what takes a million times longer will not end */

static void run_blocks(struct sph_system *s, bool after) {
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(s->p.threads) if (s->p.threads > 1)
#endif
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *block = &s->block[k];
    const struct sph_solid *body = &s->solid[block->body];
    const sph_hook *hook = after ? body->after : body->before;
    const size_t count = after ? body->after_count : body->before_count;
    for (size_t m = 0; m < count; m++)
      hook[m](s, body, block);
    if (!after) block->worn = sph_pairs_worn(s->pairs, block->low, block->high, s->c.x, s->c.y, s->c.z, s->c.h);
  }
}

static void permute(struct sph_system *s) {
  double **slot[SPH_COLUMNS], *scratch = s->c.gradient[0];
  size_t kept;
  sph_system_create_columns(s, slot, &kept);
  for (size_t k = 0; k < kept; k++) {
    double *column = *slot[k];
    for (size_t i = 0; i < s->n; i++)
      scratch[i] = column[s->order[i]];
    memcpy(column, scratch, s->n * sizeof(double));
  }
  uint32_t *word = (uint32_t *)(void *)scratch;
  for (size_t i = 0; i < s->n; i++)
    word[i] = s->id[s->order[i]];
  memcpy(s->id, word, s->n * sizeof *word);
  uint8_t *byte = (uint8_t *)scratch;
  for (size_t i = 0; s->held && i < s->n; i++)
    byte[i] = s->held[s->order[i]];
  if (s->held) memcpy(s->held, byte, s->n);
}

/* Bodies stay in their places; within each, along the space-filling curve. */
static bool sort(struct sph_system *s) {
  struct error error = {0};
  for (size_t b = 0; b < s->body_count; b++) {
    const size_t first = s->solid[b].first, count = s->solid[b].last - first;
    if (!count) continue;
    if (sph_order_find(count, s->c.x + first, s->c.y + first, s->c.z + first, s->order + first, &error) != STATUS_OK) {
      snprintf(s->failure, sizeof s->failure, "%.200s", error.message);
      return false;
    }
    for (size_t i = first; i < first + count; i++)
      s->order[i] += (uint32_t)first;
  }
  permute(s);
  return true;
}

static void wrap(double *x, size_t n, double length) {
  if (!(length > 0)) return;
  for (size_t i = 0; i < n; i++) {
    x[i] -= length * floor(x[i] / length);
    if (!(x[i] < length)) x[i] = 0;
  }
}

bool sph_system_step_relist(struct sph_system *s) {
  struct error error = {0};
  if (sph_pairs_relist(s->pairs, &error) == STATUS_OK) return true;
  snprintf(s->failure, sizeof s->failure, "%.200s", error.message);
  return false;
}

/* How far each particle may go before lists are worn: fast ones have more room, so that a spray of debris does not make new
 * lists all the time, and slow ones have little, so that their lists are short. A thin periodic box bounds the reach. */
static void set_slack(struct sph_system *s, double *slack) {
  const struct sph_columns *c = &s->c;
  double thinnest = INFINITY;
  for (int d = 0; d < 3; d++)
    if (s->p.periodic[d] < thinnest) thinnest = s->p.periodic[d];
  const double horizon = STEPS_PER_LISTING * s->dt, reach = 0.2499 * thinnest; /* twice a pair's reach must fit */
  for (size_t i = 0; i < s->n; i++) {
    const double h = c->h[i], most = fmin(ROOM * h, fmax(s->p.skin * h, reach - h));
    const double way = horizon * sqrt(c->vx[i] * c->vx[i] + c->vy[i] * c->vy[i] + c->vz[i] * c->vz[i]);
    slack[i] = fmin(most, fmax(s->p.skin * h, way));
  }
}

/* New lists when the old ones may miss a pair; now and then sorted anew, by the count of listings alone. */
static bool list(struct sph_system *s) {
  bool worn = s->now.listings == 0;
  for (size_t k = 0; k < s->block_count; k++)
    worn |= s->block[k].worn;
  if (!worn) return true;
  wrap(s->c.x, s->n, s->p.periodic[0]);
  wrap(s->c.y, s->n, s->p.periodic[1]);
  wrap(s->c.z, s->n, s->p.periodic[2]);
  if (s->now.listings++ % LISTINGS_PER_SORT == 0 && !sort(s)) return false;
  const double *const from[4] = {s->c.x, s->c.y, s->c.z, s->c.h};
  double *const *listed = sph_pairs_listed(s->pairs);
  for (int k = 0; k < 4; k++)
    memcpy(listed[k], from[k], s->n * sizeof(double));
  set_slack(s, listed[4]);
  return sph_system_step_relist(s);
}

static void sum_pairs(struct sph_system *s) {
  const struct sph_columns *c = &s->c;
  struct sph_pair_fields fields = {.x = c->x,
                                   .y = c->y,
                                   .z = c->z,
                                   .h = c->h,
                                   .vx = c->vx,
                                   .vy = c->vy,
                                   .vz = c->vz,
                                   .mass = c->mass,
                                   .density = c->density,
                                   .sound_speed = c->sound_speed,
                                   .pressure_term = c->pressure_term};
  struct sph_pair_sums sums = {.ax = c->new_ax, .ay = c->new_ay, .az = c->new_az, .heating = c->heating, .power = c->power, .signal = c->signal};
  for (int k = 0; k < 6; k++) {
    fields.stress[k] = c->damaged[k];
    fields.correction[k] = sums.correction[k] = c->correction[k];
  }
  for (int k = 0; k < 9; k++)
    sums.gradient[k] = c->gradient[k];
  sph_pairs_sum(s->pairs, s->n, &fields, &sums);
}

static bool gather(struct sph_system *s, double dt) {
  memset(s->now.worst, 0, sizeof s->now.worst);
  double damping = 0, holding = 0;
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *b = &s->block[k];
    s->now.clamped += b->clamped;
    s->now.density_held += b->density_held;
    damping += b->damped;
    holding += b->work_of_held;
    for (int l = 0; l < SPH_LIMITS; l++)
      s->now.worst[l] = fmax(s->now.worst[l], b->worst[l]);
  }
  s->now.damped += 0.5 * dt * (s->now.damping_power + damping);
  s->now.work_of_held += 0.5 * dt * (s->now.holding_power + holding);
  s->now.damping_power = damping;
  s->now.holding_power = holding;
  for (size_t k = 0; k < s->block_count; k++)
    if (s->block[k].lost < s->n) {
      const size_t i = s->block[k].lost;
      snprintf(s->failure, sizeof s->failure,
               "particle %u of body %u is no longer finite (or beyond 1e30) at %.6g s, step %llu: x %.4g %.4g %.4g m, "
               "density %.4g kg/m^3, energy %.4g J/kg",
               (unsigned)s->id[i], (unsigned)s->block[k].body, s->now.time, (unsigned long long)s->now.steps, s->c.x[i],
               s->c.y[i], s->c.z[i], s->c.density[i], s->c.energy[i]);
      return false;
    }
  return true;
}

/* Carries the state over dt, with one evaluation of the forces at its end. */
static bool advance(struct sph_system *s, double dt) {
  s->dt = dt;
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *b = &s->block[k];
    memset(b->worst, 0, sizeof b->worst);
    b->clamped = b->damped = b->work_of_held = 0;
    b->density_held = 0;
    b->lost = s->n;
  }
  run_blocks(s, false);
  if (!list(s)) return false;
  sum_pairs(s);
  run_blocks(s, true);
  return gather(s, dt);
}

bool sph_system_step_begin(struct sph_system *s) {
  if (s->p.gradient_correction && !advance(s, 0)) return false; /* forces need the correction of the pass before */
  return advance(s, 0);
}

bool sph_system_step(struct sph_system *s, double until) {
  int limiter;
  if (s->failure[0]) return false;
  const double dt = sph_limits_step(s, until, &limiter);
  if (!(dt > 0)) return dt == 0; /* already there */
  const bool chosen = limiter != SPH_LIMIT_END && limiter != SPH_LIMIT_GIVEN;
  if (chosen && s->now.first_step == 0) s->now.first_step = dt;
  if (chosen && (dt < collapse * s->now.first_step || s->now.time + dt == s->now.time)) {
    static const char *const names[SPH_LIMITS] = {"Courant", "force", "damage", "distention", "energy", "density", "given", "end"};
    snprintf(s->failure, sizeof s->failure, "the time step fell to %.3g s (%s limit) at %.6g s, step %llu; it began with %.3g s",
             dt, names[limiter], s->now.time, (unsigned long long)s->now.steps, s->now.first_step);
    return false;
  }
  const bool done = advance(s, dt);
  s->now.time = limiter == SPH_LIMIT_END ? until : s->now.time + dt;
  s->now.last_step = dt;
  s->now.limiter = limiter;
  s->now.steps++;
  return done;
}
