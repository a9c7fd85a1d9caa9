/* Growing arrays. The capacity doubles, so adding an item takes constant time on average.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

/* `array` is the address of a pointer from malloc() or NULL. False: no memory; the array is unchanged.
 */
bool grow_block(void *array, size_t bytes);                              /* resizes it to `bytes` bytes */
bool grow_doubling(void *array, size_t *room, size_t need, size_t item); /* for grow_room */

/* Makes room for `need` items of `item` bytes. *room: capacity in items. */
static inline bool grow_room(void *array, size_t *room, size_t need, size_t item) {
  return need <= *room || grow_doubling(array, room, need, item);
}
/* The same. STATUS_MEMORY: "no memory for WHAT". */
status grow_or_fail(void *array, size_t *room, size_t need, size_t item, const char *what, struct error *error);

/* The same for an array that begins at a cache line. Its capacity is an eighth more than `need`, plus GROW_SPARE items
 * that kernels may read beyond the end. The first `keep` items are kept. */
enum { GROW_SPARE = 64 };
bool grow_aligned(void *array, size_t *room, size_t need, size_t item, size_t keep);
