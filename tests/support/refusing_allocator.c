/* A library for LD_PRELOAD. It notes every place of a program that allocates memory, and refuses the memory at one of
 * them. A place is a call in the program, with the calls that led to it: a helper that grows blocks is many places.
 *
 *   ALLOCATIONS=FILE         a file that holds the table of places; all processes of the program share it
 *   ALLOCATIONS_REFUSE=KEY   the first allocation at this place gets NULL; every other one, in any process, gets memory
 *   ALLOCATIONS_LIBRARIES=1  also what other libraries than libc ask for, at the program's call of the library
 *
 * tests/extremes/memory.py reads the table. */
#define _GNU_SOURCE /* dl_iterate_phdr, dladdr */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* The names under which libc exports its own allocator: a library that takes the place of malloc() needs them. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

enum { PLACES = 1 << 14, FRAMES = 3, DEPTH = 48 };
struct place {
  _Atomic uint64_t key;   /* 0: free */
  uint64_t frame[FRAMES]; /* addresses in the program, nearest call first; 0: none */
  char owner[32];         /* which asks for the memory: "" for the program and libc */
};
static struct table {
  _Atomic uint64_t refused; /* number of refusals: 0 or 1 */
  struct place place[PLACES];
} * table;

static uint64_t wanted;            /* place to refuse; 0: none */
static uintptr_t start, low, high; /* where the program was loaded, and its code */
static uintptr_t libc_low, libc_high;
static bool libraries; /* allocations of other libraries count, too */
static __thread bool inside __attribute__((tls_model("initial-exec")));

static int find_code(struct dl_phdr_info *info, size_t size, void *first) {
  (void)size;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const uintptr_t from = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr, to = from + info->dlpi_phdr[i].p_memsz;
    if (info->dlpi_phdr[i].p_type != PT_LOAD || !(info->dlpi_phdr[i].p_flags & PF_X))
      continue;
    if (*(bool *)first) {
      start = info->dlpi_addr;
      low = from;
      high = to;
    } else if (from <= (uintptr_t)&fopen && (uintptr_t)&fopen < to) {
      libc_low = from;
      libc_high = to;
    }
  }
  *(bool *)first = false;
  return 0;
}

__attribute__((constructor)) static void begin(void) {
  const char *path = getenv("ALLOCATIONS"), *key = getenv("ALLOCATIONS_REFUSE");
  const int file = path ? open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;
  bool first = true;
  void *warm[2];
  if (file < 0 || ftruncate(file, sizeof *table) != 0)
    return;
  inside = true;
  (void)backtrace(warm, 2); /* its first call allocates */
  dl_iterate_phdr(find_code, &first);
  libraries = getenv("ALLOCATIONS_LIBRARIES") != NULL;
  wanted = key ? strtoull(key, NULL, 16) : 0;
  void *shared = mmap(NULL, sizeof *table, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  inside = false;
  if (shared != MAP_FAILED)
    table = shared;
}

/* Which library asks: of the frames between this one and the program's nearest. "": only libc. */
static void name_library(void *const *frames, int count, char name[32]) {
  *name = '\0';
  for (int i = 0; i < count; i++) {
    Dl_info of;
    if (!dladdr(frames[i], &of) || !of.dli_fname)
      continue;
    const char *slash = strrchr(of.dli_fname, '/'), *base = slash ? slash + 1 : of.dli_fname;
    if (strncmp(base, "libc.", 5) != 0)
      snprintf(name, 32, "%s", base);
  }
}

static bool in_program(uintptr_t address) {
  return address >= low && address < high;
}

static bool in_libc(uintptr_t address) {
  return address >= libc_low && address < libc_high;
}

/* Frames of this library on top of the one that allocates: refuse, refuses, malloc. */
enum { OWN_FRAMES = 3 };

/* True: this allocation is refused. direct: the program itself asks. */
__attribute__((noinline)) static bool refuse(bool direct) {
  void *frames[DEPTH];
  uint64_t at[FRAMES] = {0}, key = UINT64_C(0xcbf29ce484222325);
  int found = 0, first = 0;
  const int count = backtrace(frames, direct ? OWN_FRAMES + FRAMES : DEPTH);
  for (int i = OWN_FRAMES; i < count && found < FRAMES; i++) {
    const uintptr_t here = (uintptr_t)frames[i];
    if (in_program(here)) {
      first = found ? first : i;
      at[found++] = here - start;
    } else if (!found && !in_libc(here) && !libraries) {
      return false;
    }
  }
  if (!found)
    return false; /* of a library's own thread, or before main() */
  for (int i = 0; i < FRAMES; i++)
    key = (key ^ at[i]) * UINT64_C(0x100000001b3);
  for (size_t i = key % PLACES; !wanted; i = (i + 1) % PLACES) {
    uint64_t empty = 0;
    if (atomic_compare_exchange_strong(&table->place[i].key, &empty, key)) {
      memcpy(table->place[i].frame, at, sizeof at);
      name_library(frames + OWN_FRAMES, first - OWN_FRAMES, table->place[i].owner);
      break;
    }
    if (empty == key)
      break;
  }
  return key == wanted && atomic_fetch_add(&table->refused, 1) == 0;
}

__attribute__((noinline)) static bool refuses(uintptr_t caller) {
  const bool direct = in_program(caller);
  if (!table || inside || !(direct || in_libc(caller) || libraries) || (wanted && atomic_load(&table->refused)))
    return false;
  const int kept = errno;
  inside = true;
  const bool refused = refuse(direct);
  inside = false;
  errno = refused ? ENOMEM : kept;
  return refused;
}

#define CALLER ((uintptr_t)__builtin_return_address(0))

void *malloc(size_t size) {
  return refuses(CALLER) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
  return refuses(CALLER) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size) {
  return refuses(CALLER) ? NULL : __libc_realloc(block, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
  return refuses(CALLER) ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
  if (refuses(CALLER))
    return ENOMEM;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
