#include "engine/sph/pairs/chunks.h"

#include <stdlib.h>
#include <string.h>

#include "engine/sph/pairs/list_balance.h"

enum { BITS = 64 };

status sph_chunks_create(size_t n, size_t share, const struct sph_pair_kernels *kernels, struct sph_chunks *out,
                         struct error *error) {
  struct sph_chunks c = {.count = (n + SPH_CHUNK - 1) / SPH_CHUNK, .share = share};
  c.chunk = calloc(c.count + 1, sizeof *c.chunk);
  c.start = malloc((2 * n + c.count + 1) * sizeof *c.start);
  c.neighbours = sph_neighbours_create(n, SPH_CHUNK, share, kernels);
  *out = c;
  if (c.chunk && c.start && c.neighbours)
    return STATUS_OK;
  sph_chunks_clear(out);
  return status_fail(error, STATUS_MEMORY, "no memory for lists of neighbours of %zu particles", n);
}

void sph_chunks_clear(struct sph_chunks *c) {
  for (size_t k = 0; c->chunk && k < c->count; k++) {
    free(c->chunk[k].lists.j);
    free(c->chunk[k].other);
  }
  sph_neighbours_free(c->neighbours);
  free(c->chunk);
  free(c->start);
  free(c->shares);
  *c = (struct sph_chunks){0};
}

size_t sph_chunks_bytes(const struct sph_chunks *c) {
  size_t bytes = sph_neighbours_bytes(c->neighbours) + c->share_capacity * sizeof *c->shares;
  for (size_t k = 0; k < c->count; k++)
    bytes += sizeof *c->chunk +
             (c->chunk[k].lists.capacity + c->chunk[k].other_capacity + 2 * c->chunk[k].own + 1) * sizeof(uint32_t);
  return bytes;
}

static size_t bits_below(uint64_t word, uint32_t bit) {
  return (size_t)__builtin_popcountll(word & (((uint64_t)1 << bit) - 1));
}

/* From numbers, counted from the chunk's first one, to slots. Foreign ones stand at the end of each list, lists being
 * ascending: a bit for each of them, and how many bits are set before a word of them. */
static bool find_others(struct sph_chunk *c, size_t lists, size_t n) {
  const size_t words = (n - c->first) / BITS + 1;
  uint64_t *met = calloc(words, sizeof *met);
  uint32_t *before = malloc(words * sizeof *before), total = 0, last = 0;
  const struct sph_neighbour_lists *l = &c->lists;
  bool enough = met && before;
  for (size_t k = 0; enough && k < lists; k++)
    for (const uint32_t *list = l->j + l->start[k], *j = list + l->count[k]; j > list && j[-1] >= c->own; j--) {
      met[j[-1] / BITS] |= (uint64_t)1 << j[-1] % BITS;
      last = j[-1] > last ? j[-1] : last;
    }
  for (size_t w = 0; enough && w <= last / BITS; w++) {
    before[w] = total;
    total += (uint32_t)__builtin_popcountll(met[w]);
  }
  c->others = total;
  if (enough && total > c->other_capacity) {
    free(c->other);
    c->other_capacity = total + total / 8;
    c->other = malloc(c->other_capacity * sizeof *c->other);
    if (!c->other)
      c->other_capacity = 0;
    enough = c->other;
  }
  if (!enough)
    goto cleanup;
  for (size_t w = 0, at = 0; w <= last / BITS; w++)
    for (uint64_t word = met[w]; word; word &= word - 1)
      c->other[at++] = (uint32_t)(c->first + w * BITS) + (uint32_t)__builtin_ctzll(word);
  for (size_t k = 0; k < lists; k++)
    for (uint32_t *list = l->j + l->start[k], *j = list + l->count[k]; j > list && j[-1] >= c->own; j--) {
      const uint32_t word = j[-1] / BITS;
      j[-1] = (uint32_t)(c->own + before[word] + bits_below(met[word], j[-1] % BITS));
    }
cleanup:
  free(met);
  free(before);
  return enough;
}

/* One past the last of `others` from `first` on that belongs to the same chunk as that. */
static size_t end_of_share(const struct sph_chunk *c, size_t first) {
  const uint32_t owner = c->other[first] / SPH_CHUNK;
  size_t low = first, high = c->others;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (c->other[middle] / SPH_CHUNK == owner)
      low = middle;
    else
      high = middle;
  }
  return high;
}

static bool find_shares(struct sph_chunks *s) {
  size_t total = 0;
  for (size_t k = 0; k < s->count; k++)
    s->chunk[k].shares = 0;
  for (size_t k = 0; k < s->count; k++)
    for (size_t m = 0; m < s->chunk[k].others; m = end_of_share(&s->chunk[k], m), total++)
      s->chunk[s->chunk[k].other[m] / SPH_CHUNK].shares++;
  if (total > s->share_capacity) {
    free(s->shares);
    s->share_capacity = total + total / 8;
    s->shares = malloc(s->share_capacity * sizeof *s->shares);
    if (!s->shares) {
      s->share_capacity = 0;
      return false;
    }
  }
  struct sph_chunk_share *next = s->shares;
  for (size_t k = 0; k < s->count; k++) {
    s->chunk[k].share = next;
    if (next)
      next += s->chunk[k].shares;
    s->chunk[k].shares = 0;
  }
  for (size_t k = 0; k < s->count; k++)
    for (size_t m = 0, end; m < s->chunk[k].others; m = end) {
      struct sph_chunk *owner = &s->chunk[s->chunk[k].other[m] / SPH_CHUNK];
      end = end_of_share(&s->chunk[k], m);
      s->shares[(size_t)(owner->share - s->shares) + owner->shares++] = (struct sph_chunk_share){(uint32_t)k,
                                                                                                 (uint32_t)m,
                                                                                                 (uint32_t)(end - m)};
    }
  return true;
}

/* Lists are made in `room`, which chunks share, and kept in no more memory than they take. */
static bool list_chunk(const struct sph_chunks *s, size_t k, size_t n, struct sph_neighbour_lists *room) {
  struct sph_chunk *c = &s->chunk[k];
  c->first = k * SPH_CHUNK;
  c->own = n - c->first < SPH_CHUNK ? n - c->first : SPH_CHUNK;
  room->start = c->lists.start = s->start + 2 * c->first + k;
  room->count = c->lists.count = c->lists.start + c->own + 1;
  if (!sph_neighbours_list(s->neighbours, k, room) || !sph_list_balance(c->own, s->share, room))
    return false;
  const size_t lists = (c->own + s->share - 1) / s->share, used = room->start[lists];
  if (!c->lists.j || c->lists.capacity < used || c->lists.capacity > used + used / 4) {
    free(c->lists.j);
    c->lists.capacity = used + used / 16 / SPH_LIST_ALIGN * SPH_LIST_ALIGN;
    c->lists.j = aligned_alloc(64, c->lists.capacity * sizeof *c->lists.j + 64);
    if (!c->lists.j) {
      c->lists.capacity = 0;
      return false;
    }
  }
  memcpy(c->lists.j, room->j, used * sizeof *room->j);
  c->lists.pairs = room->pairs;
  return find_others(c, lists, n);
}

status sph_chunks_list(struct sph_chunks *s, size_t n, const double *x, const double *y, const double *z,
                       const double *reach, const double periodic[3], int threads, struct error *error) {
  const status code = sph_neighbours_find(s->neighbours, n, x, y, z, reach, periodic, threads, error);
  bool enough = true;
  if (code)
    return code;
#ifdef _OPENMP
#pragma omp parallel num_threads(threads) if (threads > 1) reduction(&& : enough)
#endif
  {
    struct sph_neighbour_lists room = {0};
#ifdef _OPENMP
#pragma omp for schedule(dynamic, 1)
#endif
    for (size_t k = 0; k < s->count; k++)
      enough = list_chunk(s, k, n, &room) && enough;
    free(room.j);
  }
  if (!enough || !find_shares(s))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", n);
  s->others = s->most_slots = 0;
  for (size_t k = 0; k < s->count; k++) {
    struct sph_chunk *c = &s->chunk[k];
    c->others_before = s->others;
    s->others += c->others;
    if (c->own + c->others > s->most_slots)
      s->most_slots = c->own + c->others;
  }
  return STATUS_OK;
}
