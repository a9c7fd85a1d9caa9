/* Grows arrays. */
#include "engine/grow.h"

#include <stdlib.h>
#include <string.h>

enum { LEAST_ROOM = 32, CACHE_LINE = 64 };

bool grow_block(void *array, size_t bytes) {
  void *block;
  memcpy(&block, array, sizeof block); /* a pointer of any type */
  block = realloc(block, bytes);
  if (!block)
    return false;
  memcpy(array, &block, sizeof block);
  return true;
}

bool grow_doubling(void *array, size_t *room, size_t need, size_t item) {
  size_t wanted = 2 * *room > LEAST_ROOM ? 2 * *room : LEAST_ROOM;
  if (wanted < need)
    wanted = need;
  if (!grow_block(array, wanted * item))
    return false;
  *room = wanted;
  return true;
}

status grow_or_fail(void *array, size_t *room, size_t need, size_t item, const char *what, struct error *error) {
  return grow_room(array, room, need, item) ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for %s", what);
}

bool grow_aligned(void *array, size_t *room, size_t need, size_t item, size_t keep) {
  if (need <= *room)
    return true;
  const size_t wanted = need + need / 8 + GROW_SPARE;
  void *old, *block = aligned_alloc(CACHE_LINE, (wanted * item + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE);
  if (!block)
    return false;
  memcpy(&old, array, sizeof old); /* a pointer of any type */
  if (keep)
    memcpy(block, old, keep * item);
  free(old);
  memcpy(array, &block, sizeof block);
  *room = wanted;
  return true;
}
