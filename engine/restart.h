/* Restart files of any engine: all data that the next step of a run depends on, for the same binary on the same CPU
 * class. A file is written under a temporary name and renamed.
 *
 *   "CLASTRUN", u64 version, u64 seed, u64 CPU class, u64 build, u64 length + identity (engine, results_version, all
 * inputs), u64 number of parts, each u64 size + bytes, u64 FNV-1a of all before it.
 *
 * Parts: the run's state (a plain value), its samples, its moving system. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "engine/engine.h"
#include "engine/frame.h"

/* Memory that is saved and loaded as raw bytes. */
struct restart_block {
  void *at;
  size_t size; /* bytes */
};
/* All blocks one after the other, `size` bytes, which the caller frees. NULL: no memory. */
void *restart_blocks_copy(const struct restart_block *blocks, size_t count, size_t *size);
/* False, and nothing is loaded, when the blocks have another size. */
bool restart_blocks_load(const struct restart_block *blocks, size_t count, const void *bytes, size_t size);

/* STATUS_IO, STATUS_MEMORY. */
status restart_save(const struct engine_kind *kind, void *run, const char *path, struct error *error);
/* Creates a run from its restart file; it continues bit-identically. *run is NULL on failure. STATUS_MISSING,
 * STATUS_IO, STATUS_MEMORY; STATUS_CONTENT: not a restart file, damaged, or of another CPU class, build or inputs. */
status restart_load(const struct engine_kind *kind, const void *inputs, const char *path, void **run,
                    struct error *error);

/* Reads only the seed from a restart file. STATUS_MISSING, STATUS_IO; STATUS_CONTENT: not a restart file. */
status restart_peek(const char *path, uint64_t *seed, struct error *error);
