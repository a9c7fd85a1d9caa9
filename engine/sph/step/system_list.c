/* Sorting particles and making new neighbour lists. */
#include "engine/sph/step/system_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "engine/sph/body/hilbert.h"

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
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
#endif
  for (size_t k = 0; k < columns; k++) {
#ifdef _OPENMP
    double *scratch = room + (size_t)omp_get_thread_num() * s->n;
#else
    double *scratch = room;
#endif
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
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
#endif
  for (size_t i = 0; i < s->n; i++) {
    s->c.x[i] = sph_system_columns_wrapped(s->c.x[i], length[0]);
    s->c.y[i] = sph_system_columns_wrapped(s->c.y[i], length[1]);
    s->c.z[i] = sph_system_columns_wrapped(s->c.z[i], length[2]);
  }
}

static double cube(double x) {
  return x * x * x;
}

double sph_system_list_reach(const struct sph_domain *domain) {
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
  const double reach = sph_system_list_reach(&s->domain);
  double *const *listed = sph_pairs_listed(s->pairs);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 4) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
#endif
  for (size_t k = 0; k < s->block_count; k++) {
    struct sph_block *block = &s->block[k];
    block->swollen = 0;
    for (size_t i = block->low; i < block->high; i++) {
      const double h = c->h[i], most = fmin(ROOM * h, fmax(skin * h, reach - h));
      const double way = horizon * sqrt(c->vx[i] * c->vx[i] + c->vy[i] * c->vy[i] + c->vz[i] * c->vz[i]);
      const double slack = fmin(most, fmax(skin * h, way));
      listed[0][i] = c->x[i], listed[1][i] = c->y[i], listed[2][i] = c->z[i], listed[3][i] = h, listed[4][i] = slack;
      if (slack > skin * h)
        block->swollen += cube(1 + slack / h) - cube(1 + skin);
    }
  }
  return sph_system_list_again(s);
}

bool sph_system_list_again(struct sph_system *s) {
  struct error error = {0};
  for (size_t k = 0; k < s->block_count; k++)
    s->block[k].slack = -1; /* unknown: look_up_slack computes it */
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

bool sph_system_list(struct sph_system *s) {
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
