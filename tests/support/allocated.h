/* Memory of this process that malloc() and its kin have given and that is not yet freed, in bytes. */
#pragma once

#include <stddef.h>

#ifdef __SANITIZE_ADDRESS__
size_t __sanitizer_get_current_allocated_bytes(void); /* of the runtime; gcc may come without its header */
static inline size_t allocated(void) {
  return __sanitizer_get_current_allocated_bytes();
}
#else
#include <malloc.h>
static inline size_t allocated(void) {
  const struct mallinfo2 all = mallinfo2();
  return all.uordblks + all.hblkhd;
}
#endif
