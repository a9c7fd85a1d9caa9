/* Saves all data on which the next step depends to memory of the caller, for restart files and trial steps. */
#include <string.h>

#include "engine/dem/step/system.h"
#include "engine/dem/step/system_layout.h"

size_t dem_system_state_size(const struct dem_system *system) {
  struct dem_system view = *system; /* blocks need a writable system; here they are only counted */
  struct restart_block blocks[DEM_SAVED_BLOCKS];
  return restart_blocks_size(blocks, dem_system_arrays_saved(&view, blocks));
}

void dem_system_state_save(const struct dem_system *system, void *bytes) {
  struct dem_system view = *system;
  struct restart_block blocks[DEM_SAVED_BLOCKS];
  restart_blocks_save(blocks, dem_system_arrays_saved(&view, blocks), bytes);
}

bool dem_system_state_load(struct dem_system *s, const void *bytes, size_t size) {
  struct dem_progress saved;
  if (size < sizeof saved)
    return false;
  memcpy(&saved, bytes, sizeof saved);
  if (saved.bond_blocks > s->bond_capacity || saved.break_count > s->pair_count)
    return false;
  if (saved.near_count > size / sizeof *s->near_pair || !dem_system_arrays_grow_near(s, (size_t)saved.near_count))
    return false;

  const struct dem_progress before = s->now;
  s->now = saved;
  if (dem_system_state_size(s) != size) {
    s->now = before;
    return false;
  }
  struct restart_block blocks[DEM_SAVED_BLOCKS];
  restart_blocks_load(blocks, dem_system_arrays_saved(s, blocks), bytes);
  return true;
}
