/* Makes the lists of all chunks: of neighbours (neighbours.c), balanced (list_balance.c), with slots in place of
 * particle numbers. */
#include "engine/sph/pairs/chunks.h"

#include <stdlib.h>
#include <string.h>

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
  }
  sph_neighbours_free(c->neighbours);
  free(c->chunk);
  free(c->start);
  free(c->stretch);
  *c = (struct sph_chunks){0};
}

size_t sph_chunks_bytes(const struct sph_chunks *c) {
  size_t bytes = sph_neighbours_bytes(c->neighbours) + c->stretch_capacity * sizeof *c->stretch;
  for (size_t k = 0; k < c->count; k++)
    bytes += sizeof *c->chunk +
             (c->chunk[k].lists.capacity + c->chunk[k].halo_capacity + 2 * c->chunk[k].own + 1) * sizeof(uint32_t);
  return bytes;
}

/* The particles of later chunks that are in a chunk's lists, numbered from its first own one: a bit for each, and for
 * each word of bits the number of bits set before it. */
struct met {
  uint64_t *bits;
  uint32_t *before, last, total; /* last: the highest number */
};

/* The slot of a particle that was met. */
static uint32_t slot_of(const struct sph_chunk *c, const struct met *met, uint32_t number) {
  const uint64_t below = met->bits[number / BITS] & (((uint64_t)1 << number % BITS) - 1);
  return (uint32_t)(c->own + met->before[number / BITS] + (size_t)__builtin_popcountll(below));
}

/* Marks the halo entries, which are at the end of each list, as lists are ascending. */
static void meet(const struct sph_chunk *c, size_t lists, struct met *met) {
  const struct sph_neighbour_lists *l = &c->lists;
  for (size_t k = 0; k < lists; k++) {
    const uint32_t *list = l->j + l->start[k];
    for (size_t e = l->count[k]; e > 0 && list[e - 1] >= c->own; e--) {
      met->bits[list[e - 1] / BITS] |= (uint64_t)1 << list[e - 1] % BITS;
      met->last = list[e - 1] > met->last ? list[e - 1] : met->last;
    }
  }
  for (size_t w = 0; w <= met->last / BITS; w++) {
    met->before[w] = met->total;
    met->total += (uint32_t)__builtin_popcountll(met->bits[w]);
  }
}

/* Finds the halo of chunk c and turns the numbers in its lists into slots. False without memory. */
static bool find_halo(struct sph_chunk *c, size_t lists, size_t n) {
  const size_t words = (n - c->first) / BITS + 1;
  const struct sph_neighbour_lists *l = &c->lists;
  struct met met = {.bits = calloc(words, sizeof *met.bits), .before = malloc(words * sizeof *met.before)};
  bool enough = met.bits && met.before;
  if (!enough)
    goto cleanup;
  meet(c, lists, &met);
  c->halo = met.total;
  if (c->halo > c->halo_capacity) {
    free(c->halo_particle);
    c->halo_capacity = c->halo + c->halo / 8;
    c->halo_particle = malloc(c->halo_capacity * sizeof *c->halo_particle);
    enough = c->halo_particle;
    if (!enough) {
      c->halo_capacity = 0;
      goto cleanup;
    }
  }

  for (size_t w = 0, at = 0; w <= met.last / BITS; w++)
    for (uint64_t word = met.bits[w]; word; word &= word - 1)
      c->halo_particle[at++] = (uint32_t)(c->first + w * BITS) + (uint32_t)__builtin_ctzll(word);
  for (size_t k = 0; k < lists; k++) {
    uint32_t *list = l->j + l->start[k];
    for (size_t e = l->count[k]; e > 0 && list[e - 1] >= c->own; e--)
      list[e - 1] = slot_of(c, &met, list[e - 1]);
  }
cleanup:
  free(met.bits);
  free(met.before);
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
  if (total > s->stretch_capacity) {
    free(s->stretch);
    s->stretch_capacity = total + total / 8;
    s->stretch = malloc(s->stretch_capacity * sizeof *s->stretch);
    if (!s->stretch) {
      s->stretch_capacity = 0;
      return false;
    }
  }

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
static bool list_chunk(const struct sph_chunks *s, size_t k, size_t n, struct sph_neighbour_lists *scratch) {
  struct sph_chunk *c = &s->chunk[k];
  c->first = k * SPH_CHUNK;
  c->own = n - c->first < SPH_CHUNK ? n - c->first : SPH_CHUNK;
  c->lists.start = s->start + 2 * c->first + k;
  c->lists.count = c->lists.start + c->own + 1;
  scratch->start = c->lists.start;
  scratch->count = c->lists.count;
  if (!sph_neighbours_list(s->neighbours, k, scratch) || !sph_list_balance(c->own, s->per_list, scratch))
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
                       const double *reach, const double periodic[3], int threads, struct error *error) {
  const status code = sph_neighbours_find(s->neighbours, n, x, y, z, reach, periodic, threads, error);
  bool enough = true;
  if (code)
    return code;
#ifdef _OPENMP
#pragma omp parallel num_threads(threads) if (threads > 1) reduction(&& : enough)
#endif
  {
    struct sph_neighbour_lists scratch = {0};
#ifdef _OPENMP
#pragma omp for schedule(dynamic, 1)
#endif
    for (size_t k = 0; k < s->count; k++)
      enough = list_chunk(s, k, n, &scratch) && enough;
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
