/* One time step. The order of the physics modules is in modules/declarations.h.
 *
 *   1. predict x v rho u h S
 *   2. pressure, yield limit, open flaws and damage, damaged stress
 *   3. one pair loop
 *   4. rates; half the change of the rates is added to the predicted state
 *
 * Where a module of a body averages over particles of several blocks (sph_module.meet), step 2 is split in two at that
 * point.
 *
 * All of it happens block by block, so that the columns of a block are read from memory once before the pair loop and
 * once after it. The rates of a block follow as soon as its sums are complete. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/body/kd_tree.h"
#include "engine/sph/step/system.h"
#include "engine/threads.h"

/* Sorting particles and making new neighbour lists. */

enum {
  LISTINGS_PER_SORT = 8,
  LEAST_HORIZON = 2, /* smallest number of steps for which lists are made */
  ROOM = 4,          /* largest slack over h */
};

/* Per precision. horizon_most: largest number of steps for which lists are made. rebuild_cost: time to make the
 * lists of a particle over the time to sum one neighbour (bench_sph pairs). In float a sum takes half the time that it
 * takes in double, and making lists takes as long. So longer lists pay in float. */
static const uint64_t horizon_most[] = {[SPH_DOUBLE] = 20, [SPH_FLOAT] = 30};
static const double rebuild_cost[] = {[SPH_DOUBLE] = 50, [SPH_FLOAT] = 100};

/* Moves the particle at order[i] to i, in all columns. */
static bool permute(struct sph_system *s) {
  double *all[SPH_COLUMNS];
  const size_t columns = sph_system_columns_list(s, all),
               threads = s->in.fidelity.threads > 1 ? (size_t)s->in.fidelity.threads : 1;
  double *room = malloc(threads * s->n * sizeof *room);
  if (!room) {
    s->fault = SPH_FAULT_MEMORY;
    snprintf(s->failure, sizeof s->failure, "no memory to sort %zu particles", s->n);
    return false;
  }
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t k = 0; k < columns; k++) {
    double *scratch = room + (size_t)omp_get_thread_num() * s->n;
    double *column = all[k];
    for (size_t i = 0; i < s->n; i++)
      scratch[i] = column[s->order[i]];
    memcpy(column, scratch, s->n * sizeof(double));
  }
  uint32_t *word = (uint32_t *)(void *)room;
  for (size_t i = 0; i < s->n; i++)
    word[i] = s->id[s->order[i]];
  memcpy(s->id, word, s->n * sizeof *word);
  uint8_t *byte = (uint8_t *)room;
  for (size_t i = 0; s->held && i < s->n; i++)
    byte[i] = s->held[s->order[i]];
  if (s->held)
    memcpy(s->held, byte, s->n);
  free(room);
  return true;
}

/* Sorts the particles of each body along the space-filling curve. */
static bool sort(struct sph_system *s) {
  struct error error = {0};
  for (size_t b = 0; b < s->body_count; b++) {
    const size_t first = s->solid[b].first, count = s->solid[b].last - first;
    if (!count)
      continue;
    if (sph_hilbert_find(count, s->c.x + first, s->c.y + first, s->c.z + first, s->order + first, &error) !=
        STATUS_OK) {
      s->fault = SPH_FAULT_MEMORY;
      snprintf(s->failure, sizeof s->failure, "%.200s", error.message);
      return false;
    }
    for (size_t i = first; i < first + count; i++)
      s->order[i] += (uint32_t)first;
  }
  return permute(s);
}

static void wrap(struct sph_system *s) {
  const double *length = s->domain.periodic;
  if (!(length[0] > 0 || length[1] > 0 || length[2] > 0))
    return;
#pragma omp parallel for schedule(static) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t i = 0; i < s->n; i++) {
    s->c.x[i] = sph_system_columns_wrapped(s->c.x[i], length[0]);
    s->c.y[i] = sph_system_columns_wrapped(s->c.y[i], length[1]);
    s->c.z[i] = sph_system_columns_wrapped(s->c.z[i], length[2]);
  }
}

static double cube(double x) {
  return x * x * x;
}

double sph_system_step_reach(const struct sph_domain *domain) {
  double thinnest = INFINITY;
  for (int d = 0; d < 3; d++)
    if (domain->periodic[d] < thinnest)
      thinnest = domain->periodic[d];
  return 0.2499 * thinnest; /* twice the reach of a pair, 2 (h + slack), must fit */
}

/* Makes lists for the present positions. Slack is how far a particle may move before the lists may miss a pair. A fast
 * particle has more slack, so that a spray of debris does not need new lists in every step; a slow one has less, so
 * that its list is short. A thin periodic box bounds the reach. */
static bool list_anew(struct sph_system *s) {
  const struct sph_columns *c = &s->c;
  const double skin = s->in.fidelity.skin, horizon = (double)s->now.horizon * s->dt;
  const double reach = sph_system_step_reach(&s->domain);
  double *const *listed = sph_pairs_listed(s->pairs);
#pragma omp parallel for schedule(dynamic, 4) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *block = &s->block[k];
    block->swollen = 0;
    for (size_t i = block->low; i < block->high; i++) {
      const double h = c->h[i], wide = s->body ? fmax(h, c->h_initial[i]) : h; /* contact keeps the h of the start */
      const double most = fmin(ROOM * h, fmax(skin * h, reach - wide));
      const double way = horizon * sqrt(c->vx[i] * c->vx[i] + c->vy[i] * c->vy[i] + c->vz[i] * c->vz[i]);
      const double slack = fmin(most, fmax(skin * h, way));
      listed[0][i] = c->x[i], listed[1][i] = c->y[i], listed[2][i] = c->z[i], listed[3][i] = wide, listed[4][i] = slack;
      if (slack > skin * h)
        block->swollen += cube(1 + slack / h) - cube(1 + skin);
    }
  }
  return sph_system_step_relist(s);
}

bool sph_system_step_relist(struct sph_system *s) {
  struct error error = {0};
  for (size_t k = 0; k < s->block_count; k++)
    s->block[k].slack = -1; /* unknown: run_before computes it */
  if (sph_pairs_relist(s->pairs, &error) == STATUS_OK)
    return true;
  s->fault = error.status == STATUS_MEMORY ? SPH_FAULT_MEMORY : SPH_FAULT_NOT_FINITE;
  snprintf(s->failure, sizeof s->failure, "%.200s", error.message);
  return false;
}

/* Cost of pairs that are in the lists only because of fast particles' slack, over the steps for which the lists are
 * made. It is high where many particles fly fast and close together. The unit is that of `rebuild_cost`. The cost is
 * counted and not timed, because the bits depend on it. */
static double cost_of_slack(const struct sph_system *s) {
  double swollen = 0;
  for (size_t k = 0; k < s->block_count; k++)
    swollen += s->block[k].swollen;
  const double beyond = sph_pairs_reached(s->pairs) - s->now.neighbours,
               most = s->now.neighbours * swollen / (double)s->n;
  return fmin(beyond, most) * (double)s->now.horizon;
}

static void lengthen(struct sph_system *s) {
  const uint64_t most = horizon_most[s->in.fidelity.precision];
  s->now.horizon = s->now.horizon && s->now.horizon < most / 2 ? 2 * s->now.horizon : most;
}

/* Makes new lists when the old ones may miss a pair (a block has no slack left). Every few times the particles are
 * sorted first; a count decides, not the clock. False as sph_system_step. */
static bool renew_lists(struct sph_system *s) {
  bool worn = s->now.listings == 0;
  for (size_t k = 0; k < s->block_count; k++)
    worn |= s->block[k].slack < 0; /* of this step */
  if (!worn)
    return true;
  wrap(s);
  if (s->now.listings++ % LISTINGS_PER_SORT == 0) {
    if (!sort(s))
      return false;
    lengthen(s);
  }
  if (!list_anew(s))
    return false;
  /* Lists for half as many steps cost less where the loss is above the cost of making lists twice. Lists for twice as
   * many steps have about eight times the loss. */
  while (s->now.horizon > LEAST_HORIZON && s->now.neighbours > 0 &&
         cost_of_slack(s) > 2 * rebuild_cost[s->in.fidelity.precision]) {
    s->now.horizon /= 2;
    if (!list_anew(s))
      return false;
  }
  if (s->now.neighbours > 0 && 8 * cost_of_slack(s) < 2 * rebuild_cost[s->in.fidelity.precision])
    lengthen(s); /* for the next lists */
  return true;
}

static const double
    collapse = 1e-6; /* share of the first step: with steps a million times smaller a run would not end */

static void run(struct sph_system *s, struct sph_block *block, const sph_hook *hook, size_t count) {
  for (size_t m = 0; m < count; m++)
    hook[m](s, &s->solid[block->body], block);
}

/* The loops before the pair loop of one block: those before `meet` of its body, those after it, or both. */
static void run_before(struct sph_system *s, struct sph_block *block, bool first, bool last) {
  const struct sph_solid *body = &s->solid[block->body];
  const size_t low = first ? 0 : body->first_count, high = last ? body->before_count : body->first_count;
  struct sph_terms terms;
  terms.solid_density = s->c.density + block->low;
  block->terms = &terms;
  run(s, block, body->before + low, high - low);
  block->terms = NULL;
  if (last &&
      block->slack < 0) /* the fastest particles of all steps may have used it up; the factor allows for rounding */
    block->slack = 0.99 * sph_pairs_slack(s->pairs, block->low, block->high, s->c.x, s->c.y, s->c.z, s->c.h);
}

static void before_pairs(struct sph_system *s) {
  bool meets = false;
  for (size_t b = 0; b < s->body_count; b++)
    meets = meets || s->solid[b].meet;
#pragma omp parallel for schedule(dynamic, 4) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t k = 0; k < s->block_count; k++)
    run_before(s, &s->block[k], true, !meets);
  if (!meets)
    return;
  for (size_t b = 0; b < s->body_count; b++)
    if (s->solid[b].meet)
      s->solid[b].meet(s, &s->solid[b]);
#pragma omp parallel for schedule(dynamic, 4) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t k = 0; k < s->block_count; k++)
    run_before(s, &s->block[k], false, true);
}

/* The first block whose particles begin at index `at` or behind it. */
static size_t first_block(const struct sph_system *s, size_t at) {
  size_t low = 0, high = s->block_count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (s->block[middle].low < at)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Called by the pair loop with the sums of some particles: runs the loops after the pair loop on their blocks. */
static void after_pairs(void *context, size_t first, size_t count, const struct sph_pair_sums *sums) {
  struct sph_system *s = context;
#define PAIR_SUMS(term, member, number, scale)                                                                         \
  for (size_t m = 0; m < (number) && sums->member[m]; m++)                                                             \
    memcpy(((double *const *)(const void *)&s->c.member)[m] + first, sums->member[m], count * sizeof(double));
#define PAIR_FOUND(term, member, number) PAIR_SUMS(term, member, number, 1)
#include "engine/sph/modules/declarations.h"
  for (size_t k = first_block(s, first); k < s->block_count && s->block[k].low < first + count; k++) {
    struct sph_block *block = &s->block[k];
    const struct sph_solid *body = &s->solid[block->body];
    const size_t skip = block->low - first;
    struct sph_pair_sums own = {.ax = sums->ax + skip,
                                .ay = sums->ay + skip,
                                .az = sums->az + skip,
                                .heating = sums->heating + skip,
                                .power = sums->power ? sums->power + skip : NULL,
                                .signal = sums->signal + skip};
    for (int m = 0; m < 9; m++)
      own.gradient[m] = sums->gradient[m] + skip;
    block->sums = &own;
    run(s, block, body->after, body->after_count);
    block->sums = NULL;
  }
}

struct sph_pair_fields sph_system_step_fields(const struct sph_system *s) {
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
                                   .sound_speed = c->wave_speed ? c->wave_speed : c->sound_speed,
                                   .pressure_term = c->pressure_term,
                                   .stress_factor = c->stress_factor};
#define PAIR_FIELDS(member, count) memcpy(fields.member, &c->member, sizeof fields.member);
#include "engine/sph/modules/declarations.h"
  for (int k = 0; k < 5; k++)
    fields.stress[k] = c->stress[k];
  return fields;
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
      s->fault = SPH_FAULT_NOT_FINITE;
      snprintf(s->failure, sizeof s->failure,
               "particle %u of body %u is not finite (or beyond 1e30) at %.6g s, step %llu: x %.3g %.3g %.3g m, "
               "density %.3g kg/m^3, energy %.3g J/kg: lower fidelity.cfl",
               (unsigned)s->id[i], (unsigned)s->block[k].body, s->now.time, (unsigned long long)s->now.steps, s->c.x[i],
               s->c.y[i], s->c.z[i], s->c.density[i], s->c.energy[i]);
      return false;
    }
  return true;
}

/* Advances the state by dt, with one evaluation of the forces at the end. */
static bool advance(struct sph_system *s, double dt) {
  s->dt = dt;
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *b = &s->block[k];
    memset(b->worst, 0, sizeof b->worst);
    b->clamped = b->damped = b->work_of_held = 0;
    b->density_held = 0;
    b->lost = s->n;
  }
  before_pairs(s);
  if (!renew_lists(s))
    return false;
  if (s->meet_others && !s->meet_others(s)) {
    s->fault = SPH_FAULT_MEMORY;
    snprintf(s->failure, sizeof s->failure, "no memory for the contact of bodies");
    return false;
  }
  const struct sph_pair_fields fields = sph_system_step_fields(s);
  sph_pairs_sum(s->pairs, s->n, &fields, after_pairs, s);
  s->now.neighbours = sph_pairs_neighbours(s->pairs);
  return gather(s, dt);
}

bool sph_system_step_begin(struct sph_system *s) {
  if (sph_pairs_look_back(s->pairs) && !advance(s, 0))
    return false; /* the forces need sums of the previous pass */
  return advance(s, 0);
}

/* The next step, s, from the limits that the blocks found at the last evaluation; not beyond `until`. */
static double choose_step(const struct sph_system *s, double until, int *limiter) {
  double inverse = 0;
  *limiter = SPH_LIMIT_COURANT;
  for (int k = 0; k < SPH_LIMITS; k++)
    if (s->now.worst[k] > inverse) {
      inverse = s->now.worst[k];
      *limiter = k;
    }
  double dt = 1 / inverse;
  if (dt > s->domain.largest_time_step) {
    dt = s->domain.largest_time_step;
    *limiter = SPH_LIMIT_GIVEN;
  }
  if (dt >= until - s->now.time) {
    dt = until - s->now.time;
    *limiter = SPH_LIMIT_END;
  }
  return dt;
}

static size_t hottest(const struct sph_system *s) {
  size_t most = 0;
  for (size_t i = 1; i < s->n; i++)
    if (s->c.energy[i] > s->c.energy[most])
      most = i;
  return most;
}

bool sph_system_step(struct sph_system *s, double until) {
  int limiter;
  if (s->fault)
    return false;
  const double dt = choose_step(s, until, &limiter);
  if (!(dt > 0))
    return dt == 0; /* already there */
  const bool chosen = limiter != SPH_LIMIT_END && limiter != SPH_LIMIT_GIVEN;
  if (chosen && s->now.first_step == 0)
    s->now.first_step = dt;
  if (chosen && (dt < collapse * s->now.first_step || s->now.time + dt == s->now.time)) {
    static const char *const names[SPH_LIMITS] = {
#define TIME_STEP_LIMIT(NAME, member, ...) #member,
#include "engine/sph/modules/declarations.h"
        "given", "end"};
    const char *remedy = s->in.method.volume_weights ? "lower fidelity.cfl, or take more particles"
                                                     : "lower fidelity.cfl, or set method.volume_weights: true";
    s->fault = SPH_FAULT_TIME_STEP;
    snprintf(s->failure, sizeof s->failure,
             "the time step fell to %.3g s (%s limit) at %.6g s, step %llu; it began with %.3g s. Particle %u is the "
             "hottest, at %.3g J/kg: %s",
             dt, names[limiter], s->now.time, (unsigned long long)s->now.steps, s->now.first_step,
             (unsigned)s->id[hottest(s)], s->c.energy[hottest(s)], remedy);
    return false;
  }
  const bool done = advance(s, dt);
  s->now.time = limiter == SPH_LIMIT_END ? until : s->now.time + dt;
  s->now.last_step = dt;
  s->now.limiter = limiter;
  s->now.steps++;
  return done;
}
