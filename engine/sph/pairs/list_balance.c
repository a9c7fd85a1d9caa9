/* Balances lists of neighbours so that most of them fill whole batches.
 *
 * A list is summed in batches of as many neighbours as a vector register has lanes, and a partly filled last batch
 * wastes lanes: one in six where two particles share a list (batches of 16), one in nine where none do (8). But a pair
 * may be in the list of either partner. So each list passes the neighbours beyond its last full batch of
 * SPH_LIST_ALIGN to the lists of those neighbours, if they come later in the chunk:
 * A list of 18, for example, keeps 16 and becomes an entry in the lists of two of its neighbours.
 *
 * Lists shared by two particles become shorter as well: if a list holds both particles of a later list, each as a
 * neighbour of the same one particle p, then a single entry of the later list, p, serves for both pairs. */
#include <stdlib.h>
#include <string.h>

#include "engine/sph/pairs/neighbours.h"

enum { BATCH = SPH_LIST_ALIGN, MOST = PAIR_GROUP_FLOAT, BOTH = 3 };
_Static_assert(PAIR_GROUP_DOUBLE == 1 && MOST == 2, "the tags of an entry name the two particles of a list");

/* Entries passed to later lists so far: particle who[e] goes to list to[e]. Those of one list are linked: first[list],
 * then next[e]; 0 ends the chain. */
struct passed {
  uint32_t *who, *to, *next, *first;
  uint32_t count;
};

/* The loops that pass entries avoid branches that a processor would predict wrongly half the time: an entry is always
 * written, but counted only if it is `chosen`. Returns the new count. */
static inline uint32_t pass(const struct passed *p, uint32_t count, size_t list, size_t who, bool chosen) {
  p->who[count + 1] = (uint32_t)who;
  p->to[count + 1] = (uint32_t)list;
  return count + chosen;
}

static inline bool share_list(uint32_t a, uint32_t b) {
  return (a & SPH_NUMBER) / MOST == (b & SPH_NUMBER) / MOST;
}

/* For lists shared by two: passes both particles of a later list if each is a neighbour of the same one of `low` and
 * low + 1. Writes the entries that stay to `to`, in order, and returns their number. */
static size_t pass_doubles(const uint32_t *from, uint32_t *to, size_t count, size_t own, size_t low, struct passed *p) {
  size_t kept = 0;
  uint32_t passed = p->count;
  for (uint32_t k = 0, before = UINT32_MAX, its; k < count; k++, before = its) {
    its = from[k];
    const uint32_t number = its & SPH_NUMBER;
    const uint32_t next = k + 1 < count ? from[k + 1] : UINT32_MAX; /* has no partner for a list */
    const bool first = share_list(its, next), last = share_list(its, before);
    const uint32_t whose = (its | (first ? next : 0) | (last ? before : 0)) >> SPH_TAGS;
    const bool go = (first | last) & (number >= low + MOST) & (number < own) & (whose != BOTH);
    passed = pass(p, passed, number / MOST, low + whose / 2, go & first);
    to[kept] = its;
    kept += !go;
  }
  p->count = passed;
  return kept;
}

/* Passes up to `excess` neighbours to later lists. Particles that share a list are passed together. Writes the entries
 * that stay to `to`, which may be `from`, in order, and returns their number. */
static inline size_t pass_excess(const size_t per_list, const uint32_t *from, uint32_t *to, size_t count, size_t own,
                                 size_t low, size_t excess, struct passed *p) {
  size_t kept = 0, k = 0;
  uint32_t passed = p->count;
  for (size_t size; k < count && excess && (from[k] & SPH_NUMBER) < own; k += size) { /* the halo is at the end */
    const uint32_t its = from[k], number = its & SPH_NUMBER;
    size = per_list == 2 && k + 1 < count && share_list(its, from[k + 1]) ? 2 : 1;
    const uint32_t other = from[k + size - 1], whose = per_list == 1 ? 1 : (its | other) >> SPH_TAGS;
    const bool go = number >= low + per_list && size <= excess;
    for (uint32_t m = 0; m < per_list; m++)
      passed = pass(p, passed, number / per_list, low + m, go & whose >> m & 1);
    to[kept] = its;
    to[kept + size - 1] = other;
    kept += go ? 0 : size;
    excess -= go ? size : 0;
  }
  p->count = passed;
  memmove(to + kept, from + k, (count - k) * sizeof *to);
  return kept + count - k;
}

/* Makes the new list at `to`: the particles that earlier lists passed to it, then its own entries that stay.
 * Returns its length. */
static size_t balance_list(const struct sph_neighbour_lists *lists, size_t list, size_t own, size_t per_list,
                           uint32_t *to, struct passed *p) {
  const uint32_t *from = lists->j + lists->start[list];
  const size_t count = lists->count[list], low = list * per_list;
  size_t more = 0, kept;
  uint32_t before = p->count;
  for (uint32_t k = p->first[list]; k; k = p->next[k])
    to[more++] = p->who[k];

  if (per_list == 1) {
    kept = pass_excess(1, from, to + more, count, own, low, (more + count) % BATCH, p);
  } else {
    kept = pass_doubles(from, to + more, count, own, low, p);
    kept = pass_excess(2, to + more, to + more, kept, own, low, (more + kept) % BATCH, p);
    for (size_t k = more; k < more + kept; k++)
      to[k] &= SPH_NUMBER;
  }

  while (before++ < p->count) { /* link the entries just passed */
    p->next[before] = p->first[p->to[before]];
    p->first[p->to[before]] = before;
  }
  return more + kept;
}

bool sph_list_balance(size_t own, size_t per_list, struct sph_neighbour_lists *lists) {
  const size_t count = (own + per_list - 1) / per_list;
  const size_t most = per_list * (lists->start[count] + 1) + 1; /* entries that may be passed */
  const size_t capacity = per_list * lists->start[count] + (count + 1) * BATCH;
  uint32_t *fresh = aligned_alloc(64, (capacity * sizeof *fresh + 63) / 64 * 64), used = 0;
  struct passed p = {.who = malloc(3 * most * sizeof *p.who), .first = calloc(count + 1, sizeof *p.first)};
  const bool enough = fresh && p.who && p.first;
  if (!enough)
    goto cleanup;
  p.to = p.who + most;
  p.next = p.to + most;

  for (size_t list = 0; list < count; list++) {
    const size_t length = balance_list(lists, list, own, per_list, fresh + used, &p);
    lists->start[list] = used;
    lists->count[list] = (uint32_t)length;
    used += (uint32_t)length;
    for (; used % BATCH; used++)
      fresh[used] = (uint32_t)(list * per_list);
  }
  lists->start[count] = used;
  free(lists->j);
  lists->j = fresh;
  lists->capacity = capacity;
  fresh = NULL;

cleanup:
  free(fresh);
  free(p.first);
  free(p.who);
  return enough;
}
