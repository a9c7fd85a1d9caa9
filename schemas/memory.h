/* Small memory: allocations whose size constants of the program bound. When the system refuses one, the process ends
 * with the exit code STATUS_MEMORY; the farm counts such a run as lost and tries it again, and a store survives the end
 * of any process. So the caller checks nothing. Whatever grows with a file, a store or the particles of a scene uses
 * memory_array() or malloc(), and returns STATUS_MEMORY instead. */
#pragma once

#include <stddef.h>

#include "schemas/status.h"

enum { MEMORY_SMALL = 1 << 16 }; /* bytes, the largest allocation here */

/* `count` items of `size` bytes, all zero; never NULL. The caller frees them. */
void *memory_small(size_t count, size_t size) __attribute__((malloc, returns_nonnull));
/* A copy of a text of less than MEMORY_SMALL bytes; never NULL. The caller frees it. */
char *memory_small_text(const char *text) __attribute__((malloc, returns_nonnull));
/* `count` items of `size` bytes, all zero, for what grows; also for 0 items. `pointer`: address of the pointer to them.
 * STATUS_MEMORY: "no memory for WHAT". The caller frees them. */
status memory_array(void *pointer, size_t count, size_t size, const char *what, struct error *error);
/* A pointer declared OWNED is freed where its block is left, so that TRY and return are allowed anywhere:
 *   OWNED char *text = NULL; */
#define OWNED __attribute__((cleanup(memory_free)))
void memory_free(void *pointer); /* for OWNED: frees what the pointer at this address points to */
/* Ends the process as above, where memory that constants bound was refused elsewhere. */
void memory_refused(void) __attribute__((noreturn));
