/* Arrays that grow: the one place that says how. A growing array doubles, so adding an item costs the same on average.
 */
#ifndef CLAST_ENGINE_GROW_H
#define CLAST_ENGINE_GROW_H

#include <stdbool.h>
#include <stddef.h>

/* `array` is the address of a pointer from malloc() or NULL. On false there is no memory, and the array is as before.
 */
bool grow_block(void *array, size_t bytes);                              /* makes it `bytes` long */
bool grow_doubling(void *array, size_t *room, size_t need, size_t item); /* for grow_room */

/* Makes room for `need` items of `item` bytes. *room: for how many there is room. */
static inline bool grow_room(void *array, size_t *room, size_t need, size_t item) {
  return need <= *room || grow_doubling(array, room, need, item);
}

/* The same for an array that begins at a cache line: room for an eighth more than `need`, and for GROW_SPARE items that
 * kernels may read beyond the end. The first `keep` items stay. */
enum { GROW_SPARE = 64 };
bool grow_aligned(void *array, size_t *room, size_t need, size_t item, size_t keep);

#endif
