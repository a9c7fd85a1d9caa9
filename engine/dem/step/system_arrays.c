/* The arrays of a system, all from the single list in system_layout.h. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/step/system_layout.h"

struct array {
  size_t offset; /* of the pointer in struct dem_system */
  size_t size;   /* bytes of an element */
  size_t allocated, saved;
};

#define ONE(type, name, allocated, saved) +1
#define ROW(type, name, allocated, saved) {offsetof(struct dem_system, name), sizeof(type), allocated, saved},

enum { ARRAYS = DEM_ARRAYS(ONE) };
_Static_assert(ARRAYS + 2 <= DEM_SAVED_BLOCKS, "too few blocks for all arrays");

static void list(const struct dem_system *s, struct array out[ARRAYS]) {
  const struct array all[ARRAYS] = {DEM_ARRAYS(ROW)};
  memcpy(out, all, sizeof all);
}

static void **pointer(struct dem_system *s, const struct array *array) {
  return (void **)((char *)s + array->offset);
}

static void *zeroed(size_t count, size_t size) {
  const size_t bytes = ((count ? count : 1) * size + 63) / 64 * 64;
  void *block = aligned_alloc(64, bytes);
  if (block)
    memset(block, 0, bytes);
  return block;
}

/* Gives each column its part of the arena. */
static void place_columns(struct dem_system *s) {
  double *next = s->arena;
#define PLACE(name)                                                                                                    \
  s->c.name = next;                                                                                                    \
  next += s->padded;
  DEM_COLUMNS(PLACE)
#undef PLACE
  if (s->in->fidelity.integrator != DEM_GEAR)
    return;
  for (int k = 0; k < 3; k++)
    for (int order = 2; order < 6; order++) {
      s->c.gear[k][order] = next;
      next += s->padded;
    }
}

bool dem_system_arrays_allocate(struct dem_system *s) {
  const size_t n = s->count;
#define COUNT_COLUMN(name) +1
  const size_t columns = DEM_COLUMNS(COUNT_COLUMN) + (s->in->fidelity.integrator == DEM_GEAR ? 3 * 4 : 0);
#undef COUNT_COLUMN
  s->arena_doubles = columns * s->padded;
  s->bond_capacity = (s->pair_count + DEM_BLOCK - 1) / DEM_BLOCK;
  s->near_capacity = (4 * n + DEM_BLOCK) / DEM_BLOCK * DEM_BLOCK;
  s->cell_capacity = 8 * n + 64;
  for (s->cell_buckets = 64; s->cell_buckets < 2 * n;)
    s->cell_buckets *= 2;

  struct array all[ARRAYS];
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++) {
    void *block = zeroed(all[k].allocated, all[k].size);
    if (!block)
      return false;
    *pointer(s, &all[k]) = block;
  }
  place_columns(s);
  return true;
}

void dem_system_arrays_free(struct dem_system *s) {
  struct array all[ARRAYS];
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++)
    free(*pointer(s, &all[k]));
}

size_t dem_system_arrays_bytes(const struct dem_system *s) {
  struct array all[ARRAYS];
  list(s, all);
  size_t bytes = sizeof *s;
  for (size_t k = 0; k < ARRAYS; k++)
    bytes += all[k].allocated * all[k].size;
  return bytes;
}

bool dem_system_arrays_grow_near(struct dem_system *s, size_t pairs) {
  if (pairs <= s->near_capacity)
    return true;
  const size_t capacity = (pairs + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
  struct dem_near_block *near = aligned_alloc(64, capacity / DEM_BLOCK * sizeof *near);
  struct dem_near_pair *near_pair = malloc(capacity * sizeof *near_pair);
  uint32_t *general = malloc((s->bond_capacity * DEM_BLOCK + capacity) * sizeof *general);
  if (!near || !near_pair || !general) {
    free(near);
    free(near_pair);
    free(general);
    return false;
  }
  memcpy(near, s->near, s->near_capacity / DEM_BLOCK * sizeof *near);
  memcpy(near_pair, s->near_pair, s->near_capacity * sizeof *near_pair);
  free(s->near);
  free(s->near_pair);
  free(s->general);
  s->near = near;
  s->near_pair = near_pair;
  s->general = general;
  s->near_capacity = capacity;
  return true;
}

size_t dem_system_arrays_saved(struct dem_system *s, struct restart_block blocks[DEM_SAVED_BLOCKS]) {
  struct array all[ARRAYS];
  size_t count = 0;
  blocks[count++] = (struct restart_block){&s->now, sizeof s->now}; /* first: the others' sizes follow from it */
  blocks[count++] = (struct restart_block){&s->held_count, sizeof s->held_count};
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++)
    if (all[k].saved > 0)
      blocks[count++] = (struct restart_block){*pointer(s, &all[k]), all[k].saved * all[k].size};
  return count;
}

void dem_system_arrays_ring(const struct dem_system *s, uint32_t grain, double dx, double dy, struct dem_ring *ring) {
  const uint32_t first = s->first_vertex[grain];
  const double c = s->c.cosine[grain], sn = s->c.sine[grain];
  ring->count = s->first_vertex[grain + 1] - first;
  for (size_t v = 0; v < ring->count; v++) {
    const double x = s->outline_x[first + v], y = s->outline_y[first + v];
    ring->x[v] = c * x - sn * y + dx;
    ring->y[v] = sn * x + c * y + dy;
  }
  for (size_t v = ring->count; v <= dem_overlap_last(ring); v++) {
    ring->x[v] = ring->x[0];
    ring->y[v] = ring->y[0];
  }
}
