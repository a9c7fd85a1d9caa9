#include "engine/sph/pairs/list_balance.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = SPH_LIST_ALIGN, MOST = PAIR_GROUP_FLOAT, BOTH = 3 };
_Static_assert(PAIR_GROUP_DOUBLE == 1 && MOST == 2, "of a list's two particles an entry's tags say which of them");

/* What lists have been handed so far: who, to which list, linked by list. */
struct handed {
  uint32_t *who, *to, *next, *first; /* first: by list; 0 is the end */
  uint32_t count;
};

/* All this is without branches where they would be guessed wrong half the time: when `given`, `who` goes into a list.
 * Returns how many are handed over by then. */
static inline uint32_t hand_over(const struct handed *h, uint32_t count, size_t list, size_t who, bool given) {
  h->who[count + 1] = (uint32_t)who;
  h->to[count + 1] = (uint32_t)list;
  return count + given;
}

static inline bool share_list(uint32_t a, uint32_t b) {
  return (a & SPH_NUMBER) / MOST == (b & SPH_NUMBER) / MOST;
}

/* Lists shared by two: both particles of a later list that are neighbours of one of `low`, low + 1 alone: there that
 * one stands for both of them. Returns how many others there are, in order, at `to`. */
static size_t shorten(const uint32_t *from, uint32_t *to, size_t count, size_t own, size_t low, struct handed *h) {
  size_t kept = 0;
  uint32_t handed = h->count;
  for (uint32_t k = 0, before = UINT32_MAX, its; k < count; k++, before = its) {
    its = from[k];
    const uint32_t number = its & SPH_NUMBER,
                   next = k + 1 < count ? from[k + 1] : UINT32_MAX; /* shares a list with nobody */
    const bool first = share_list(its, next), last = share_list(its, before);
    const uint32_t whose = (its | (first ? next : 0) | (last ? before : 0)) >> SPH_TAGS;
    const bool go = (first | last) & (number >= low + MOST) & (number < own) & (whose != BOTH);
    handed = hand_over(h, handed, number / MOST, low + whose / 2, go & first);
    to[kept] = its;
    kept += !go;
  }
  h->count = handed;
  return kept;
}

/* `excess` of the neighbours, or fewer, go to later lists; with all that stand in one list with them, for a pair of
 * lists is on one side as a whole. Returns how many others there are, in order, at `to`, which may be `from`. */
static inline size_t shed(const size_t share, const uint32_t *from, uint32_t *to, size_t count, size_t own, size_t low,
                          size_t excess, struct handed *h) {
  size_t kept = 0, k = 0;
  uint32_t handed = h->count;
  for (size_t size; k < count && excess && (from[k] & SPH_NUMBER) < own;
       k += size) { /* foreign ones stand at the end */
    const uint32_t its = from[k], number = its & SPH_NUMBER;
    size = share == 2 && k + 1 < count && share_list(its, from[k + 1]) ? 2 : 1;
    const uint32_t other = from[k + size - 1], whose = share == 1 ? 1 : (its | other) >> SPH_TAGS;
    const bool go = number >= low + share && size <= excess;
    for (uint32_t m = 0; m < share; m++)
      handed = hand_over(h, handed, number / share, low + m, go & whose >> m & 1);
    to[kept] = its, to[kept + size - 1] = other;
    kept += go ? 0 : size;
    excess -= go ? size : 0;
  }
  h->count = handed;
  memmove(to + kept, from + k, (count - k) * sizeof *to);
  return kept + count - k;
}

bool sph_list_balance(size_t own, size_t share, struct sph_neighbour_lists *lists) {
  const size_t count = (own + share - 1) / share,
               most = share * (lists->start[count] + 1) + 1; /* that are handed over */
  const size_t room = share * lists->start[count] + (count + 1) * BATCH;
  uint32_t *fresh = aligned_alloc(64, (room * sizeof *fresh + 63) / 64 * 64), used = 0;
  struct handed h = {.who = malloc(3 * most * sizeof *h.who), .first = calloc(count + 1, sizeof *h.first)};
  const bool enough = fresh && h.who && h.first;
  h.to = h.who + (enough ? most : 0), h.next = h.to + (enough ? most : 0);
  for (size_t list = 0; enough && list < count; list++) {
    uint32_t *to = fresh + used, more = 0;
    for (uint32_t k = h.first[list]; k; k = h.next[k])
      to[more++] = h.who[k];
    const uint32_t *from = lists->j + lists->start[list];
    const size_t count_before = lists->count[list];
    uint32_t *j = to + more, before = h.count;
    size_t rest;
    if (share == 1) {
      rest = more + shed(1, from, j, count_before, own, list, (more + count_before) % BATCH, &h);
    } else {
      rest = shorten(from, j, count_before, own, list * share, &h);
      rest = more + shed(2, j, j, rest, own, list * share, (more + rest) % BATCH, &h);
    }
    while (before++ < h.count) {
      h.next[before] = h.first[h.to[before]];
      h.first[h.to[before]] = before;
    }
    for (size_t k = more; share > 1 && k < rest; k++)
      to[k] &= SPH_NUMBER;
    lists->start[list] = used;
    lists->count[list] = (uint32_t)rest;
    used += (uint32_t)rest;
    for (; used % BATCH; used++)
      fresh[used] = (uint32_t)(list * share);
  }
  if (enough) {
    lists->start[count] = used;
    free(lists->j);
    lists->j = fresh;
    lists->capacity = room;
    fresh = NULL;
  }
  free(fresh);
  free(h.first);
  free(h.who);
  return enough;
}
