/* Makes the lists of all chunks: of neighbours (neighbours.c), balanced, with slots in place of particle numbers. */
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"

enum { BITS = 64 };

status sph_chunks_create(size_t n, size_t per_list, const struct sph_pair_kernels *kernels, struct sph_chunks *out,
                         struct error *error) {
  struct sph_chunks c = {.count = (n + SPH_CHUNK - 1) / SPH_CHUNK, .per_list = per_list};
  c.chunk = calloc(c.count + 1, sizeof *c.chunk);
  c.start = malloc((2 * n + c.count + 1) * sizeof *c.start);
  c.neighbours = sph_neighbours_create(n, SPH_CHUNK, per_list, kernels);
  *out = c;
  if (c.chunk && c.start && c.neighbours)
    return STATUS_OK;
  sph_chunks_clear(out);
  return status_fail(error, STATUS_MEMORY, "no memory for lists of neighbours of %zu particles", n);
}

void sph_chunks_clear(struct sph_chunks *c) {
  for (size_t k = 0; c->chunk && k < c->count; k++) {
    free(c->chunk[k].lists.j);
    free(c->chunk[k].halo_particle);
    free(c->chunk[k].foreign);
  }
  sph_neighbours_free(c->neighbours);
  free(c->chunk);
  free(c->start);
  free(c->stretch);
  *c = (struct sph_chunks){0};
}

/* ---- balance ----
 *
 * Lists of neighbours are balanced so that most of them fill whole batches.
 *
 * A list is summed in batches of as many neighbours as a vector register has lanes, and a partly filled last batch
 * wastes lanes: one in six where two particles share a list (batches of 16), one in nine where none do (8). But a pair
 * may be in the list of either partner. So each list passes the neighbours beyond its last full batch of
 * SPH_LIST_ALIGN to the lists of those neighbours, if they come later in the chunk:
 * A list of 18, for example, keeps 16 and becomes an entry in the lists of two of its neighbours.
 *
 * Lists shared by two particles become shorter as well: if a list holds both particles of a later list, each as a
 * neighbour of the same one particle p, then a single entry of the later list, p, serves for both pairs. */

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

bool sph_chunks_balance(size_t own, size_t per_list, struct sph_neighbour_lists *lists) {
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

/* ---- halo ---- */

/* The particles of later chunks that are in a chunk's lists, numbered from its first own one: a bit for each, and for
 * each word of bits the number of bits set before it. */
struct halo_marks {
  uint64_t *bits;
  uint32_t *before, last, total; /* last: the highest number */
};

/* The slot of a particle of the halo. */
static uint32_t slot_of(const struct sph_chunk *c, const struct halo_marks *marks, uint32_t number) {
  const uint64_t below = marks->bits[number / BITS] & (((uint64_t)1 << number % BITS) - 1);
  return (uint32_t)(c->own + marks->before[number / BITS] + (size_t)__builtin_popcountll(below));
}

/* Marks the halo entries, which are at the end of each list, as lists are ascending. */
static void mark_halo(const struct sph_chunk *c, size_t lists, struct halo_marks *marks) {
  const struct sph_neighbour_lists *l = &c->lists;
  for (size_t k = 0; k < lists; k++) {
    const uint32_t *list = l->j + l->start[k];
    for (size_t e = l->count[k]; e > 0 && list[e - 1] >= c->own; e--) {
      marks->bits[list[e - 1] / BITS] |= (uint64_t)1 << list[e - 1] % BITS;
      marks->last = list[e - 1] > marks->last ? list[e - 1] : marks->last;
    }
  }
  for (size_t w = 0; w <= marks->last / BITS; w++) {
    marks->before[w] = marks->total;
    marks->total += (uint32_t)__builtin_popcountll(marks->bits[w]);
  }
}

/* Finds the halo of chunk c and turns the numbers in its lists into slots. False without memory. */
static bool find_halo(struct sph_chunk *c, size_t lists, size_t n) {
  const size_t words = (n - c->first) / BITS + 1;
  const struct sph_neighbour_lists *l = &c->lists;
  struct halo_marks marks = {.bits = calloc(words, sizeof *marks.bits), .before = malloc(words * sizeof *marks.before)};
  bool enough = marks.bits && marks.before;
  if (!enough)
    goto cleanup;
  mark_halo(c, lists, &marks);
  c->halo = marks.total;
  enough = grow_aligned(&c->halo_particle, &c->halo_capacity, c->halo, sizeof *c->halo_particle, 0);
  if (!enough)
    goto cleanup;

  for (size_t w = 0, at = 0; w <= marks.last / BITS; w++)
    for (uint64_t word = marks.bits[w]; word; word &= word - 1)
      c->halo_particle[at++] = (uint32_t)(c->first + w * BITS) + (uint32_t)__builtin_ctzll(word);
  for (size_t k = 0; k < lists; k++) {
    uint32_t *list = l->j + l->start[k];
    for (size_t e = l->count[k]; e > 0 && list[e - 1] >= c->own; e--)
      list[e - 1] = slot_of(c, &marks, list[e - 1]);
  }
cleanup:
  free(marks.bits);
  free(marks.before);
  return enough;
}

/* The end of the stretch of c's halo that begins at `first`: all of it belongs to one chunk. */
static size_t end_of_stretch(const struct sph_chunk *c, size_t first) {
  const uint32_t owner = c->halo_particle[first] / SPH_CHUNK;
  size_t low = first, high = c->halo;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (c->halo_particle[middle] / SPH_CHUNK == owner)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Finds the stretches of all halos and gives them to the chunks to which their particles belong. */
static bool find_stretches(struct sph_chunks *s) {
  size_t total = 0;
  for (size_t k = 0; k < s->count; k++)
    s->chunk[k].stretches = 0;
  for (size_t k = 0; k < s->count; k++)
    for (size_t m = 0; m < s->chunk[k].halo; m = end_of_stretch(&s->chunk[k], m), total++)
      s->chunk[s->chunk[k].halo_particle[m] / SPH_CHUNK].stretches++;
  if (!grow_aligned(&s->stretch, &s->stretch_capacity, total, sizeof *s->stretch, 0))
    return false;

  struct sph_chunk_stretch *next = s->stretch;
  for (size_t k = 0; k < s->count; k++) {
    s->chunk[k].stretch = next;
    if (next)
      next += s->chunk[k].stretches;
    s->chunk[k].stretches = 0;
  }
  for (size_t k = 0; k < s->count; k++)
    for (size_t m = 0, end; m < s->chunk[k].halo; m = end) {
      struct sph_chunk *owner = &s->chunk[s->chunk[k].halo_particle[m] / SPH_CHUNK];
      end = end_of_stretch(&s->chunk[k], m);
      s->stretch[(size_t)(owner->stretch - s->stretch) +
                 owner->stretches++] = (struct sph_chunk_stretch){(uint32_t)k, (uint32_t)m, (uint32_t)(end - m)};
    }
  return true;
}

/* Makes the lists of chunk k. They are made in `scratch`, which a thread uses for one chunk after the other, and kept
 * in no more memory than they need. */
static bool list_chunk(const struct sph_chunks *s, size_t k, size_t n, const uint8_t *body,
                       struct sph_neighbour_lists *scratch) {
  struct sph_chunk *c = &s->chunk[k];
  c->first = k * SPH_CHUNK;
  c->own = n - c->first < SPH_CHUNK ? n - c->first : SPH_CHUNK;
  c->lists.start = s->start + 2 * c->first + k;
  c->lists.count = c->lists.start + c->own + 1;
  scratch->start = c->lists.start;
  scratch->count = c->lists.count;
  if (!sph_neighbours_list(s->neighbours, k, scratch) || (body && !sph_foreign_part(c, s->per_list, body, scratch)) ||
      !sph_chunks_balance(c->own, s->per_list, scratch))
    return false;

  const size_t lists = (c->own + s->per_list - 1) / s->per_list, used = scratch->start[lists];
  if (!c->lists.j || c->lists.capacity < used || c->lists.capacity > used + used / 4) {
    free(c->lists.j);
    c->lists.capacity = used + used / 16 / SPH_LIST_ALIGN * SPH_LIST_ALIGN;
    c->lists.j = aligned_alloc(64, c->lists.capacity * sizeof *c->lists.j + 64);
    if (!c->lists.j) {
      c->lists.capacity = 0;
      return false;
    }
  }
  memcpy(c->lists.j, scratch->j, used * sizeof *scratch->j);
  c->lists.pairs = scratch->pairs;
  return find_halo(c, lists, n);
}

status sph_chunks_list(struct sph_chunks *s, size_t n, const double *x, const double *y, const double *z,
                       const double *reach, const double periodic[3], const uint8_t *body, int threads,
                       struct error *error) {
  const status code = sph_neighbours_find(s->neighbours, n, x, y, z, reach, periodic, threads, error);
  bool enough = true;
  if (code)
    return code;
#pragma omp parallel num_threads(threads) if (threads > 1) reduction(&& : enough)
  {
    struct sph_neighbour_lists scratch = {0};
#pragma omp for schedule(dynamic, 1)
    for (size_t k = 0; k < s->count; k++)
      enough = list_chunk(s, k, n, body, &scratch) && enough;
    free(scratch.j);
  }
  if (!enough || !find_stretches(s))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", n);

  s->halos = 0;
  s->most_slots = 0;
  for (size_t k = 0; k < s->count; k++) {
    struct sph_chunk *c = &s->chunk[k];
    c->halo_before = s->halos;
    s->halos += c->halo;
    if (c->own + c->halo > s->most_slots)
      s->most_slots = c->own + c->halo;
  }
  return STATUS_OK;
}
