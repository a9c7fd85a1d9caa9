#include <stdlib.h>
#include <string.h>

#include "engine/dem/step/system_layout.h"

struct section {
  void *data;
  size_t bytes;
};

enum { SECTIONS = 16 };

/* All that the next step depends on, in order; the first says how long the others are. */
static size_t sections(struct dem_system *s, struct section out[SECTIONS]) {
  const size_t n = s->count, pairs = s->pair_count;
  const size_t near_blocks = (s->now.near_count + DEM_BLOCK - 1) / DEM_BLOCK;
  const struct section all[] = {
      {&s->now, sizeof s->now},
      {&s->held_count, sizeof s->held_count},
      {s->arena, s->arena_doubles * sizeof(double)},
      {s->freedoms, n},
      {s->present, n},
      {s->held_vx, n * sizeof(double)},
      {s->held_vy, n * sizeof(double)},
      {s->held_spin, n * sizeof(double)},
      {s->held, n * sizeof *s->held},
      {s->alive, pairs},
      {s->pair_lane, pairs * sizeof *s->pair_lane},
      {s->lane_pair, s->bond_capacity * DEM_BLOCK * sizeof *s->lane_pair},
      {s->bond, s->now.bond_blocks * sizeof *s->bond},
      {s->near, near_blocks * sizeof *s->near},
      {s->near_pair, s->now.near_count * sizeof *s->near_pair},
      {s->log, s->now.break_count * sizeof *s->log},
  };
  memcpy(out, all, sizeof all);
  return sizeof all / sizeof *all;
}

size_t dem_system_state_size(const struct dem_system *system) {
  struct dem_system view = *system; /* sections() wants pointers it may write through; this one only counts */
  struct section list[SECTIONS];
  size_t total = 0;
  for (size_t k = 0, count = sections(&view, list); k < count; ++k)
    total += list[k].bytes;
  return total;
}

void dem_system_state_save(const struct dem_system *system, void *bytes) {
  struct dem_system view = *system;
  struct section list[SECTIONS];
  unsigned char *to = bytes;
  for (size_t k = 0, count = sections(&view, list); k < count; ++k) {
    memcpy(to, list[k].data, list[k].bytes);
    to += list[k].bytes;
  }
}

static bool reserve(struct dem_system *s, size_t near_count) {
  if (near_count <= s->near_capacity)
    return true;
  const size_t capacity = (near_count + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
  struct dem_near_block *near = aligned_alloc(64, capacity / DEM_BLOCK * sizeof *near);
  struct dem_near_pair *pairs = malloc(capacity * sizeof *pairs);
  uint32_t *general = malloc((s->bond_capacity * DEM_BLOCK + capacity) * sizeof *general);
  if (!near || !pairs || !general) {
    free(near);
    free(pairs);
    free(general);
    return false;
  }
  free(s->near);
  free(s->near_pair);
  free(s->general);
  s->near = near;
  s->near_pair = pairs;
  s->general = general;
  s->near_capacity = capacity;
  s->general_capacity = s->bond_capacity * DEM_BLOCK + capacity;
  return true;
}

bool dem_system_state_load(struct dem_system *s, const void *bytes, size_t size) {
  struct dem_progress saved;
  if (size < sizeof saved)
    return false;
  memcpy(&saved, bytes, sizeof saved);
  if (saved.bond_blocks > s->bond_capacity || saved.break_count > s->pair_count ||
      saved.near_count > size / sizeof *s->near_pair || !reserve(s, (size_t)saved.near_count))
    return false;
  const struct dem_progress kept = s->now;
  s->now = saved;
  if (dem_system_state_size(s) != size) {
    s->now = kept;
    return false;
  }
  struct section list[SECTIONS];
  const unsigned char *from = bytes;
  for (size_t k = 0, count = sections(s, list); k < count; ++k) {
    memcpy(list[k].data, from, list[k].bytes);
    from += list[k].bytes;
  }
  return true;
}
