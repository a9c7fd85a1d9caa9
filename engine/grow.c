/* Grows arrays. */
#include "engine/grow.h"

#include <stdlib.h>
#include <string.h>

enum { LEAST_ROOM = 32 };

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
