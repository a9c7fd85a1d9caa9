/* Saves and loads all data on which the next step depends. Lists are not saved: they are made again from the positions
 * at which they were made, in the same order, and the pair loop sums in that order. */
#include <stdio.h>
#include <string.h>

#include "engine/restart.h"
#include "engine/sph/step/system_layout.h"

enum { BLOCKS = SPH_COLUMNS + 10 };

static size_t saved(struct sph_system *s, struct restart_block out[BLOCKS]) {
  double *column[SPH_COLUMNS];
  size_t count = 0;
  const size_t columns = sph_system_columns_list(s, column);
  out[count++] = (struct restart_block){&s->n, sizeof s->n};
  out[count++] = (struct restart_block){&s->now, sizeof s->now};
  for (size_t k = 0; k < columns; k++)
    out[count++] = (struct restart_block){column[k], s->n * sizeof(double)};
  for (int k = 0; k < 5; k++)
    out[count++] = (struct restart_block){sph_pairs_listed(s->pairs)[k], s->n * sizeof(double)};
  out[count++] = (struct restart_block){s->id, s->n * sizeof *s->id};
  if (s->held)
    out[count++] = (struct restart_block){s->held, s->n};
  return count;
}

size_t sph_system_state_size(const struct sph_system *system) {
  struct sph_system view = *system; /* blocks need a writable system; here they are only counted */
  struct restart_block blocks[BLOCKS];
  return restart_blocks_size(blocks, saved(&view, blocks));
}

void sph_system_state_save(const struct sph_system *system, void *bytes) {
  struct sph_system view = *system;
  struct restart_block blocks[BLOCKS];
  restart_blocks_save(blocks, saved(&view, blocks), bytes);
}

bool sph_system_state_load(struct sph_system *s, const void *bytes, size_t size) {
  struct restart_block blocks[BLOCKS];
  size_t n;
  if (size != sph_system_state_size(s))
    return false;
  memcpy(&n, bytes, sizeof n);
  if (n != s->n)
    return false;
  restart_blocks_load(blocks, saved(s, blocks), bytes);
  for (size_t i = 0; i < n; i++)
    if (s->id[i] >= n) {
      s->fault = SPH_FAULT_NOT_FINITE;
      snprintf(s->failure, sizeof s->failure, "the state read back is no state of this system");
      return false;
    }
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->restored)
        sph_modules_at(m)->restored(s, &s->solid[b]);
  s->fault = SPH_FAULT_NONE;
  s->failure[0] = '\0';
  return sph_system_list_again(s);
}
