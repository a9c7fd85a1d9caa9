#include "engine/restart.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/atomic_file.h"
#include "engine/cpu_class.h"

static const char magic[8] = "CLASTRUN";
enum { VERSION = 2, PARTS = 8 };

struct restart {
  unsigned char *bytes;
  uint64_t seed;
  struct restart_part part[PARTS];
};

static char *identity(const struct engine_kind *kind, const void *inputs) {
  char *rows = field_identity(kind->inputs, inputs), *text = NULL;
  size_t size = rows ? strlen(rows) + strlen(kind->name) + 64 : 0;
  if (rows && (text = malloc(size)))
    snprintf(text, size, "%s results_version=%d\n%s", kind->name, kind->results_version, rows);
  free(rows);
  return text;
}

static uint64_t checksum(const unsigned char *at, size_t size) { /* FNV-1a */
  uint64_t hash = 0xcbf29ce484222325U;
  for (size_t k = 0; k < size; k++)
    hash = (hash ^ at[k]) * 0x100000001b3U;
  return hash;
}

struct bytes {
  unsigned char *at;
  size_t size, used; /* used: written, or read so far */
};

static void put(struct bytes *b, const void *from, size_t size) {
  if (size)
    memcpy(b->at + b->used, from, size);
  b->used += size;
}
static void put_number(struct bytes *b, uint64_t number) {
  put(b, &number, sizeof number);
}

static bool get(struct bytes *b, void *to, size_t size) {
  if (b->size - b->used < size)
    return false;
  memcpy(to, b->at + b->used, size);
  b->used += size;
  return true;
}
static bool get_exactly(struct bytes *b, uint64_t number) {
  uint64_t came;
  return get(b, &came, sizeof came) && came == number;
}

status restart_save(const struct engine_kind *kind, const void *inputs, uint64_t seed, size_t count,
                    const struct restart_part *parts, const char *path, struct error *error) {
  char *text = identity(kind, inputs);
  struct bytes b = {.size = text ? sizeof magic + 8 * 6 + strlen(text) : 0};
  for (size_t k = 0; k < count; k++)
    b.size += 8 + parts[k].size;
  b.at = text ? malloc(b.size) : NULL;
  if (!b.at) {
    free(text);
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  }
  put(&b, magic, sizeof magic);
  put_number(&b, VERSION);
  put_number(&b, seed);
  put_number(&b, cpu_class_choose());
  put_number(&b, strlen(text));
  put(&b, text, strlen(text));
  put_number(&b, count);
  for (size_t k = 0; k < count; k++) {
    put_number(&b, parts[k].size);
    put(&b, parts[k].at, parts[k].size);
  }
  put_number(&b, checksum(b.at, b.used));
  status code = atomic_file_write(path, "restart file", b.at, b.used, error);
  free(b.at);
  free(text);
  return code;
}

/* Everything between head and checksum. */
static bool read_parts(struct bytes *b, size_t count, struct restart *restart) {
  b->size -= 8;
  bool good = count <= PARTS && get_exactly(b, count);
  for (size_t k = 0; good && k < count; k++) {
    uint64_t size;
    good = get(b, &size, 8) && size <= b->size - b->used;
    if (good) {
      restart->part[k] = (struct restart_part){b->at + b->used, size};
      b->used += size;
    }
  }
  return good && b->used == b->size;
}

status restart_peek(const char *path, uint64_t *seed, struct error *error) {
  struct {
    char magic[sizeof magic];
    uint64_t version, seed;
  } head;
  FILE *file = fopen(path, "rb");
  if (!file)
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "cannot read the restart file '%s': %s",
                       path, strerror(errno));
  size_t got = fread(&head, sizeof head, 1, file);
  fclose(file);
  if (got != 1 || memcmp(head.magic, magic, sizeof magic) != 0)
    return status_fail(error, STATUS_CONTENT,
                       "'%s' is no restart file: name another one, or move it away to start the run afresh", path);
  *seed = head.seed;
  return STATUS_OK;
}

status restart_open(const struct engine_kind *kind, const void *inputs, size_t count, const char *path,
                    struct restart **out, struct error *error) {
  *out = NULL;
  struct bytes b = {0};
  char *text = identity(kind, inputs), head[sizeof magic];
  struct restart *restart = calloc(1, sizeof *restart);
  uint64_t length, sum, class;
  status code = text && restart ? atomic_file_read(path, "restart file", &b.at, &b.size, error)
                                : status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
  if (code)
    goto cleanup;
  if (b.size < sizeof magic + 8 || !get(&b, head, sizeof head) || memcmp(head, magic, sizeof magic) != 0) {
    code = status_fail(error, STATUS_CONTENT,
                       "'%s' is no restart file: name another one, or move it away to start the run afresh", path);
    goto cleanup;
  }
  memcpy(&sum, b.at + b.size - 8, 8);
  if (sum != checksum(b.at, b.size - 8)) {
    code = status_fail(error, STATUS_CONTENT, "the restart file '%s' is damaged or cut short: start the run afresh",
                       path);
    goto cleanup;
  }
  const bool known = get_exactly(&b, VERSION) && get(&b, &restart->seed, 8) && get(&b, &class, 8);
  if (known && class != (uint64_t)cpu_class_choose()) {
    const char *name = cpu_class_name((enum cpu_class) class);
    code = status_fail(
        error, STATUS_CONTENT,
        "the restart file '%s' is of CPU class %s, this run of %s, and bits are the same within one class only: "
        "resume on a machine that has it with CLAST_CPU=%s in the environment, or start the run afresh",
        path, name, cpu_class_name(cpu_class_choose()), name);
    goto cleanup;
  }
  if (!known || !get(&b, &length, 8) || length != strlen(text) || b.size - b.used < length ||
      memcmp(b.at + b.used, text, length) != 0) {
    code = status_fail(
        error, STATUS_CONTENT,
        "the restart file '%s' belongs to another scene or another version of clast: start the run afresh", path);
    goto cleanup;
  }
  b.used += length;
  if (!read_parts(&b, count, restart)) {
    code = restart_refuse(path, error);
    goto cleanup;
  }
  restart->bytes = b.at;
  b.at = NULL;
  *out = restart;
  restart = NULL;
cleanup:
  free(text);
  free(b.at);
  free(restart);
  return code;
}

status restart_refuse(const char *path, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "the restart file '%s' was written by another build of clast: start the run afresh", path);
}

uint64_t restart_seed(const struct restart *restart) {
  return restart->seed;
}

struct restart_part restart_part(const struct restart *restart, size_t index) {
  return restart->part[index];
}

bool restart_copy(const struct restart *restart, size_t index, void *to, size_t size) {
  if (restart->part[index].size != size)
    return false;
  if (size)
    memcpy(to, restart->part[index].at, size);
  return true;
}

void restart_close(struct restart *restart) {
  if (!restart)
    return;
  free(restart->bytes);
  free(restart);
}
