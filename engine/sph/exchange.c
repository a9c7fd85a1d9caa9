#include "engine/sph/exchange.h"

#include <stdlib.h>
#include <string.h>

enum { SHARE = PAIR_GROUP_FLOAT, BATCH = SPH_LIST_ALIGN, BOTH = 3 };
_Static_assert(SHARE == 2, "of a list's two particles an entry's tags say which of them");

/* What lists have been handed so far: who, to which list, linked by list. */
struct handed {
  uint32_t *who, *to, *next, *first; /* first: by list; 0 is the end */
  uint32_t count;
};

/* All this is without branches where they would be guessed wrong half the time: when `given`, `who` goes into a list. Returns how
 * many are handed over by then. */
static inline uint32_t hand_over(const struct handed *h, uint32_t count, size_t list, size_t who, bool given) {
  h->who[count + 1] = (uint32_t)who;
  h->to[count + 1] = (uint32_t)list;
  return count + given;
}

static inline bool share_list(uint32_t a, uint32_t b) {
  return (a & SPH_NUMBER) / SHARE == (b & SPH_NUMBER) / SHARE;
}

/* Both particles of a later list that are neighbours of one of `low`, low + 1 alone: there that one stands for both of them. Returns
 * how many others stay in j[0 .. count - 1], in order; j[count] may be written. */
static size_t shorten(uint32_t *j, size_t count, size_t own, size_t low, struct handed *h) {
  size_t kept = 0;
  uint32_t handed = h->count;
  j[count] = UINT32_MAX; /* shares a list with nobody */
  for (uint32_t k = 0, before = UINT32_MAX, its; k < count; k++, before = its) {
    its = j[k];
    const uint32_t number = its & SPH_NUMBER, next = j[k + 1];
    const bool first = share_list(its, next), last = share_list(its, before);
    const uint32_t whose = (its | (first ? next : 0) | (last ? before : 0)) >> SPH_TAGS;
    const bool go = (first | last) & (number >= low + SHARE) & (number < own) & (whose != BOTH);
    handed = hand_over(h, handed, number / SHARE, low + whose / 2, go & first);
    j[kept] = its;
    kept += !go;
  }
  h->count = handed;
  return kept;
}

/* `excess` of the neighbours, or fewer, go to later lists; with all that stand in one list with them, for a pair of lists is on one
 * side as a whole. Returns how many others stay, in order. */
static size_t shed(uint32_t *j, size_t count, size_t own, size_t low, size_t excess, struct handed *h) {
  size_t kept = 0, k = 0;
  uint32_t handed = h->count;
  for (size_t size; k < count && excess && (j[k] & SPH_NUMBER) < own; k += size) { /* foreign ones stand at the end */
    const uint32_t number = j[k] & SPH_NUMBER;
    size = k + 1 < count && share_list(j[k], j[k + 1]) ? 2 : 1;
    const uint32_t whose = (j[k] | (size == 2 ? j[k + 1] : 0)) >> SPH_TAGS;
    const bool go = number >= low + SHARE && size <= excess;
    for (uint32_t m = 0; m < SHARE; m++)
      handed = hand_over(h, handed, number / SHARE, low + m, go & whose >> m & 1);
    j[kept] = j[k], j[kept + size - 1] = j[k + size - 1];
    kept += go ? 0 : size;
    excess -= go ? size : 0;
  }
  h->count = handed;
  memmove(j + kept, j + k, (count - k) * sizeof *j);
  return kept + count - k;
}

bool sph_exchange(size_t own, struct sph_neighbour_lists *lists) {
  const size_t count = (own + SHARE - 1) / SHARE, most = SHARE * (lists->start[count] + 1) + 1; /* that are handed over */
  const size_t room = SHARE * lists->start[count] + (count + 1) * BATCH;
  uint32_t *fresh = aligned_alloc(64, (room * sizeof *fresh + 63) / 64 * 64), used = 0;
  struct handed h = {.who = malloc(3 * most * sizeof *h.who), .first = calloc(count + 1, sizeof *h.first)};
  const bool enough = fresh && h.who && h.first;
  h.to = h.who + (enough ? most : 0), h.next = h.to + (enough ? most : 0);
  for (size_t list = 0; enough && list < count; list++) {
    uint32_t *to = fresh + used, more = 0;
    for (uint32_t k = h.first[list]; k; k = h.next[k])
      to[more++] = h.who[k];
    uint32_t *j = to + more;
    memcpy(j, lists->j + lists->start[list], lists->count[list] * sizeof *j);
    uint32_t before = h.count;
    size_t rest = shorten(j, lists->count[list], own, list * SHARE, &h);
    rest = more + shed(j, rest, own, list * SHARE, (more + rest) % BATCH, &h);
    while (before++ < h.count) {
      h.next[before] = h.first[h.to[before]];
      h.first[h.to[before]] = before;
    }
    for (size_t k = more; k < rest; k++)
      to[k] &= SPH_NUMBER;
    lists->start[list] = used;
    lists->count[list] = (uint32_t)rest;
    used += (uint32_t)rest;
    for (; used % BATCH; used++)
      fresh[used] = (uint32_t)(list * SHARE);
  }
  if (enough) lists->start[count] = used;
  if (enough && used > lists->capacity) {
    free(lists->j);
    lists->j = fresh;
    lists->capacity = room;
    fresh = NULL;
  } else if (enough) {
    memcpy(lists->j, fresh, used * sizeof *fresh);
  }
  free(fresh);
  free(h.first);
  free(h.who);
  return enough;
}
