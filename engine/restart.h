/* Restart files of any engine: what the next step depends on, for the same binary on the same CPU class; written under
 * a temporary name and renamed.
 *
 *   "CLASTRUN", u64 version, u64 seed, u64 CPU class, u64 length + identity (engine, results_version, all inputs), u64
 * number of parts, each u64 size + bytes, u64 FNV-1a of all before it. */
#ifndef CLAST_ENGINE_RESTART_H
#define CLAST_ENGINE_RESTART_H

#include <stddef.h>
#include <stdint.h>

#include "engine/engine.h"

struct restart_part {
  const void *at;
  size_t size;
};

/* STATUS_IO, STATUS_MEMORY. */
status restart_save(const struct engine_kind *kind, const void *inputs, uint64_t seed, size_t count,
                    const struct restart_part *parts, const char *path, struct error *error);

/* The seed of the run that a file is of, without reading the rest. STATUS_MISSING, STATUS_IO; STATUS_CONTENT: no
 * restart file. */
status restart_peek(const char *path, uint64_t *seed, struct error *error);

struct restart; /* owns the file's bytes */
/* STATUS_MISSING, STATUS_IO; STATUS_CONTENT: no restart file, damaged, of another CPU class, of other inputs or another
 * version, or not `count` parts. */
status restart_open(const struct engine_kind *kind, const void *inputs, size_t count, const char *path,
                    struct restart **out, struct error *error);
uint64_t restart_seed(const struct restart *restart);
struct restart_part restart_part(const struct restart *restart, size_t index); /* borrowed, not aligned */
/* Copies part `index` to `to`; false, and nothing copied, when it has not just that size. */
bool restart_copy(const struct restart *restart, size_t index, void *to, size_t size);
void restart_close(struct restart *restart); /* NULL is fine */
/* What to say when the parts do not fit the run. */
status restart_refuse(const char *path, struct error *error);

#endif
