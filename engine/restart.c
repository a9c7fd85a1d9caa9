/* The writer and reader of restart files. */
#include "engine/restart.h"

#include <errno.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/cpu_class.h"
#include "schemas/file.h"
#include "schemas/memory.h"

static const char magic[8] = "CLASTRUN";
/* 4: the file records the build. */
enum { VERSION = 4 };
#define NO_RESTART_FILE "'%s' is no restart file: name another one, or move it away to start the run again"
enum { STATE, SAMPLES, SYSTEM, PARTS };

struct part {
  const void *at; /* not aligned */
  size_t size;
};

static size_t size_of(const struct restart_block *blocks, size_t count) {
  size_t total = 0;
  for (size_t k = 0; k < count; k++)
    total += blocks[k].size;
  return total;
}

void *restart_blocks_copy(const struct restart_block *blocks, size_t count, size_t *size) {
  *size = size_of(blocks, count);
  unsigned char *bytes = malloc(*size), *to = bytes;
  for (size_t k = 0; bytes && k < count; to += blocks[k++].size)
    memcpy(to, blocks[k].at, blocks[k].size);
  return bytes;
}

bool restart_blocks_load(const struct restart_block *blocks, size_t count, const void *bytes, size_t size) {
  const unsigned char *from = bytes;
  if (size != size_of(blocks, count))
    return false;
  for (size_t k = 0; k < count; from += blocks[k++].size)
    memcpy(blocks[k].at, from, blocks[k].size);
  return true;
}

static char *identity(const struct engine_kind *kind, const void *inputs) {
  OWNED char *rows = field_identity(kind->inputs, inputs);
  const size_t size = strlen(rows) + strlen(kind->name) + 64;
  char *text = malloc(size);
  if (text)
    snprintf(text, size, "%s results_version=%d\n%s", kind->name, kind->results_version, rows);
  return text;
}

/* The first object is the program itself; its notes have the id that the linker makes of all its code (--build-id). */
static int add_notes(struct dl_phdr_info *program, size_t size, void *hash) {
  uint64_t *sum = hash;
  (void)size;
  for (size_t k = 0; k < program->dlpi_phnum; k++) {
    const ElfW(Phdr) *part = &program->dlpi_phdr[k];
    if (part->p_type == PT_NOTE)
      *sum = text_hash(*sum, (const void *)(program->dlpi_addr + part->p_vaddr), part->p_memsz);
  }
  return 1;
}

/* Structs and columns are saved as raw memory. Another build may have them in another order of the same size and would
 * mix them up. */
static uint64_t build_hash(void) {
  uint64_t sum = TEXT_HASH_START;
  dl_iterate_phdr(add_notes, &sum);
  return sum;
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

/* Writes a file of these parts. */
static status write_parts(const struct engine_kind *kind, const void *inputs, uint64_t seed,
                          const struct part parts[PARTS], const char *path, struct error *error) {
  OWNED char *text = identity(kind, inputs);
  struct bytes b = {.size = text ? sizeof magic + 8 * 7 + strlen(text) : 0};
  for (size_t k = 0; k < PARTS; k++)
    b.size += 8 + parts[k].size;
  OWNED unsigned char *whole = b.at = text ? malloc(b.size) : NULL;
  if (!whole)
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  put(&b, magic, sizeof magic);
  put_number(&b, VERSION);
  put_number(&b, seed);
  put_number(&b, cpu_class_choose());
  put_number(&b, build_hash());
  put_number(&b, strlen(text));
  put(&b, text, strlen(text));
  put_number(&b, PARTS);
  for (size_t k = 0; k < PARTS; k++) {
    put_number(&b, parts[k].size);
    put(&b, parts[k].at, parts[k].size);
  }
  put_number(&b, text_hash(TEXT_HASH_START, b.at, b.used));
  return file_write(path, "restart file", whole, b.used, error);
}

status restart_save(const struct engine_kind *kind, void *run, const char *path, struct error *error) {
  const struct frame *frame = run;
  size_t size;
  OWNED void *system = kind->copy_system(run, &size);
  if (!system)
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  const struct part parts[PARTS] = {
      [STATE] = {frame->state, frame->state_size},
      [SAMPLES] = {frame->sample, frame->state->samples * frame->sample_size},
      [SYSTEM] = {system, size},
  };
  return write_parts(kind, frame->inputs, frame->seed, parts, path, error);
}

/* Reads everything between head and checksum. */
static bool read_parts(struct bytes *b, struct part parts[PARTS]) {
  b->size -= 8;
  if (!get_exactly(b, PARTS))
    return false;
  for (size_t k = 0; k < PARTS; k++) {
    uint64_t size;
    if (!get(b, &size, 8) || size > b->size - b->used)
      return false;
    parts[k] = (struct part){b->at + b->used, size};
    b->used += size;
  }
  return b->used == b->size;
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
    return status_fail(error, STATUS_CONTENT, NO_RESTART_FILE, path);
  *seed = head.seed;
  return STATUS_OK;
}

static status refuse(const char *path, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "the restart file '%s' was written by another build of clast, and only that build can continue "
                     "it: finish the run with that build, or start it again",
                     path);
}

/* Reads the magic and checks the sum over the file. */
static status read_seal(struct bytes *b, const char *path, struct error *error) {
  char head[sizeof magic];
  uint64_t sum;
  if (b->size < sizeof magic + 8 || !get(b, head, sizeof head) || memcmp(head, magic, sizeof magic) != 0)
    return status_fail(error, STATUS_CONTENT, NO_RESTART_FILE, path);
  memcpy(&sum, b->at + b->size - 8, 8);
  if (sum != text_hash(TEXT_HASH_START, b->at, b->size - 8))
    return status_fail(error, STATUS_CONTENT, "the restart file '%s' is damaged or cut short: start the run again",
                       path);
  return STATUS_OK;
}

/* Reads magic, checksum, version, seed, class, build and identity: everything before the parts. */
static status read_head(struct bytes *b, const char *identity, const char *path, uint64_t *seed, struct error *error) {
  uint64_t class, length;
  TRY(read_seal(b, path, error));
  if (!get_exactly(b, VERSION) || !get(b, seed, 8) || !get(b, &class, 8))
    return refuse(path, error);
  if (class != (uint64_t)cpu_class_choose()) {
    const char *name = cpu_class_name((enum cpu_class) class);
    return status_fail(
        error, STATUS_CONTENT,
        "the restart file '%s' is of CPU class %s, this run of %s, and bits are the same within one class only: "
        "resume on a machine that has it with CLAST_CPU=%s in the environment, or start the run again",
        path, name, cpu_class_name(cpu_class_choose()), name);
  }
  if (!get_exactly(b, build_hash()))
    return refuse(path, error);
  const bool whole = get(b, &length, 8) && length <= b->size - b->used;
  if (!whole || length != strlen(identity) || memcmp(b->at + b->used, identity, length) != 0)
    return status_fail(error, STATUS_CONTENT,
                       "the restart file '%s' belongs to another scene: name another one, or start the run again",
                       path);
  b->used += length;
  return STATUS_OK;
}

/* Fills a run, which has just been created, from the parts. */
static status load_parts(const struct engine_kind *kind, void *run, const struct part parts[PARTS], const char *path,
                         struct error *error) {
  const struct frame *frame = run;
  if (parts[STATE].size != frame->state_size)
    return refuse(path, error);
  memcpy(frame->state, parts[STATE].at, frame->state_size);
  if (frame->state->samples > frame->sample_capacity ||
      parts[SAMPLES].size != frame->state->samples * frame->sample_size)
    return refuse(path, error);
  if (parts[SAMPLES].size)
    memcpy(frame->sample, parts[SAMPLES].at, parts[SAMPLES].size);
  status code = kind->load_system(run, parts[SYSTEM].at, parts[SYSTEM].size, error);
  return code == STATUS_CONTENT ? refuse(path, error) : code;
}

status restart_load(const struct engine_kind *kind, const void *inputs, const char *path, void **out,
                    struct error *error) {
  *out = NULL;
  OWNED unsigned char *whole = NULL;
  OWNED char *text = identity(kind, inputs);
  struct bytes b = {0};
  struct part parts[PARTS];
  uint64_t seed = 0;
  if (!text)
    return status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
  TRY(file_read(path, "restart file", &whole, &b.size, error));
  b.at = whole;
  TRY(read_head(&b, text, path, &seed, error));
  if (!read_parts(&b, parts))
    return refuse(path, error);
  TRY(kind->prepare(inputs, seed, out, error));
  const status code = load_parts(kind, *out, parts, path, error);
  if (code) {
    kind->free(*out);
    *out = NULL;
  }
  return code;
}
