#include "engine/sph/exchange.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What lists have been handed so far, linked by list. */
struct handed {
  uint32_t *first, *next, *who; /* first: by list; 0 is the end */
  uint32_t count;
};

/* Rounding allowed for: a pair too many in a list does no harm. */
static bool is_near(const struct sph_exchange_places *p, size_t i, size_t j) {
  const double at[3] = {p->x[i] - p->x[j], p->y[i] - p->y[j], p->z[i] - p->z[j]}, reach = p->reach[i] + p->reach[j];
  double square = 0;
  for (int d = 0; d < 3; d++) {
    const double along = p->periodic[d] > 0 ? at[d] - p->periodic[d] * nearbyint(at[d] / p->periodic[d]) : at[d];
    square += along * along;
  }
  return square < reach * reach * (1 + 1e-12);
}

/* The particles low .. high - 1 of one list go into `list`, those that are near one of the `count` of its particles. */
static void hand_over(const struct sph_exchange_places *p, size_t low, size_t high, const uint32_t *its, size_t count, size_t list,
                      struct handed *h) {
  for (size_t i = low; i < high; i++) {
    bool near = false;
    for (size_t k = 0; k < count && !near; k++)
      near = is_near(p, i, its[k]);
    if (!near) continue;
    h->who[++h->count] = (uint32_t)i;
    h->next[h->count] = h->first[list];
    h->first[list] = h->count;
  }
}

/* Of `count` neighbours of the particles low .. high - 1 at most `excess` go where they have lists of their own, with all that stand
 * in one list with them: a pair of lists is on one side as a whole. The others stay, in order; returns how many. */
static size_t keep_rest(const struct sph_exchange_places *p, size_t own, size_t share, size_t low, size_t high, uint32_t *j, size_t count,
                        size_t excess, struct handed *h) {
  size_t kept = 0, k = 0;
  for (; k < count && j[k] < own && excess;) {
    const size_t list = j[k] / share;
    size_t end = k + 1;
    while (end < count && j[end] < own && j[end] / share == list)
      end++;
    if (j[k] >= high && end - k <= excess) {
      hand_over(p, low, high, j + k, end - k, list, h);
      excess -= end - k;
      k = end;
    }
    while (k < end)
      j[kept++] = j[k++];
  }
  memmove(j + kept, j + k, (count - k) * sizeof *j);
  return kept + count - k;
}

bool sph_exchange(const struct sph_exchange_places *p, size_t own, size_t share, struct sph_neighbour_lists *lists) {
  enum { BATCH = SPH_LIST_ALIGN };
  const size_t count = (own + share - 1) / share, most = count * share * (BATCH - 1) + 1; /* handed over */
  const size_t room = lists->start[count] + most + count * BATCH;
  uint32_t *fresh = aligned_alloc(64, (room * sizeof *fresh + 63) / 64 * 64), used = 0;
  struct handed h = {calloc(count + 1, sizeof *h.first), malloc(most * sizeof *h.next), malloc(most * sizeof *h.who), 0};
  const bool enough = fresh && h.first && h.next && h.who;
  for (size_t list = 0; enough && list < count; list++) {
    const size_t low = list * share, high = low + share < own ? low + share : own;
    uint32_t *to = fresh + used, more = 0;
    for (uint32_t k = h.first[list]; k; k = h.next[k])
      to[more++] = h.who[k];
    memcpy(to + more, lists->j + lists->start[list], lists->count[list] * sizeof *to);
    const size_t excess = (more + lists->count[list]) % BATCH;
    const size_t rest = more + keep_rest(p, own, share, low, high, to + more, lists->count[list], excess, &h);
    lists->start[list] = used;
    lists->count[list] = (uint32_t)rest;
    used += (uint32_t)rest;
    for (; used % BATCH; used++)
      fresh[used] = (uint32_t)low;
  }
  if (enough) {
    lists->start[count] = used;
    free(lists->j);
    lists->j = fresh;
    lists->capacity = room;
  } else {
    free(fresh);
  }
  free(h.first);
  free(h.next);
  free(h.who);
  return enough;
}
