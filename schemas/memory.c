/* Small memory that is there or ends the process. */
#include "schemas/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void memory_refused(void) {
  static const char refused[] = "clast: the system refused memory; the process ends\n";
  (void)!write(STDERR_FILENO, refused, sizeof refused - 1);
  _exit(STATUS_MEMORY); /* exit() would run handlers that need memory, also those of MPI and HDF5 */
}

void memory_free(void *pointer) {
  void *owned;
  memcpy(&owned, pointer, sizeof owned);
  free(owned);
}

status memory_array(void *pointer, size_t count, size_t size, const char *what, struct error *error) {
  void *memory = calloc(count ? count : 1, size);
  memcpy(pointer, &memory, sizeof memory); /* a pointer of any type */
  return memory ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for %s", what);
}

void *memory_small(size_t count, size_t size) {
  assert(size == 0 || count <= MEMORY_SMALL / size);
  void *memory = calloc(count ? count : 1, size ? size : 1);
  if (!memory)
    memory_refused();
  return memory;
}

char *memory_small_text(const char *text) {
  const size_t size = strlen(text) + 1;
  return memcpy(memory_small(size, 1), text, size);
}
