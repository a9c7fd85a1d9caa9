/* Records what this process asks the disk to keep, and makes the files as they may look after a power cut.
 *
 * The functions below take the place of those of the C library, also for SQLite, which is a shared library. They call
 * the original and note each write, truncation, sync, removal and renaming of a file in the recorded folder. A file
 * that is written by stdio is noted when it is synced or renamed. A sync is noted only: waiting for the real disk would
 * prove nothing. Files -shm are left out: SQLite makes them again.
 *
 * The model of the disk: a sync of a file keeps all its bytes; a sync of a folder keeps its names. What is not synced
 * may be lost or kept, each 512 bytes of a write on its own; names in the order of their changes, as file systems with
 * a journal do. A file of which only the name was synced is empty. */
#pragma once

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/clock.h"

enum disk_kind { DISK_MADE, DISK_WROTE, DISK_CUT, DISK_SYNCED, DISK_FOLDER_SYNCED, DISK_REMOVED, DISK_RENAMED };
struct disk_op {
  enum disk_kind kind;
  size_t file;                   /* number of the file */
  char name[128], new_name[128]; /* relative to the recorded folder; a folder's own name is "" */
  off_t at;                      /* offset; of DISK_CUT: the new size */
  size_t size;
  uint8_t *bytes;
  double time; /* s, monotonic */
};
static struct {
  char root[PATH_MAX]; /* "" while nothing is recorded */
  struct disk_op *ops;
  size_t count, capacity;
  struct {
    ino_t inode; /* 0: removed */
    bool written;
  } files[4096];
  size_t file_count;
} disk;

#define DISK_NEED(condition)                                                                                           \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, #condition, strerror(errno));                             \
      abort();                                                                                                         \
    }                                                                                                                  \
  } while (0)
#define DISK_ORIGINAL(type, name, ...)                                                                                 \
  static type (*original)(__VA_ARGS__);                                                                                \
  if (!original)                                                                                                       \
    *(void **)&original = dlsym(RTLD_NEXT, name);

static struct disk_op *disk_note(enum disk_kind kind, size_t file, const char *name) {
  if (disk.count == disk.capacity) {
    disk.capacity = disk.capacity ? 2 * disk.capacity : 1024;
    disk.ops = realloc(disk.ops, disk.capacity * sizeof *disk.ops);
    DISK_NEED(disk.ops);
  }
  struct disk_op *op = &disk.ops[disk.count++];
  *op = (struct disk_op){.kind = kind, .file = file, .time = clock_s()};
  snprintf(op->name, sizeof op->name, "%s", name);
  return op;
}

/* The path relative to the recorded folder; NULL: it is outside, or a -shm file. */
static const char *disk_inside(const char *path) {
  const size_t length = strlen(disk.root), whole = strlen(path);
  if (!length || strncmp(path, disk.root, length) != 0 || (path[length] && path[length] != '/'))
    return NULL;
  if (whole > 4 && strcmp(path + whole - 4, "-shm") == 0)
    return NULL;
  return path[length] ? path + length + 1 : "";
}

static const char *disk_inside_of_name(const char *path, char absolute[2 * PATH_MAX]) {
  if (!disk.root[0])
    return NULL;
  char here[PATH_MAX] = "";
  if (path[0] != '/')
    DISK_NEED(getcwd(here, sizeof here));
  snprintf(absolute, 2 * PATH_MAX, "%s%s%s", here, here[0] ? "/" : "", path);
  return disk_inside(absolute);
}

static const char *disk_inside_of_descriptor(int descriptor, char path[PATH_MAX]) {
  if (!disk.root[0])
    return NULL;
  const int before = errno;
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, PATH_MAX - 1);
  errno = before;
  if (length <= 0)
    return NULL;
  path[length] = '\0';
  return disk_inside(path);
}

/* The number of a file; notes its making when it is new. */
static size_t disk_file(ino_t inode, const char *name) {
  for (size_t i = disk.file_count; i-- > 0;)
    if (disk.files[i].inode == inode)
      return i;
  DISK_NEED(disk.file_count < sizeof disk.files / sizeof disk.files[0]);
  disk.files[disk.file_count].inode = inode;
  disk.files[disk.file_count].written = false;
  disk_note(DISK_MADE, disk.file_count, name);
  return disk.file_count++;
}

static void disk_wrote(size_t file, const char *name, const void *bytes, size_t size, off_t at) {
  struct disk_op *op = disk_note(DISK_WROTE, file, name);
  op->at = at;
  op->size = size;
  op->bytes = malloc(size + 1);
  DISK_NEED(op->bytes);
  memcpy(op->bytes, bytes, size);
}

/* Notes the bytes of a file that stdio wrote. */
static void disk_take_whole(size_t file, const char *name) {
  if (disk.files[file].written)
    return;
  char path[2 * PATH_MAX];
  snprintf(path, sizeof path, "%s/%s", disk.root, name);
  FILE *in = fopen(path, "rb");
  static uint8_t bytes[1 << 20];
  const size_t size = in ? fread(bytes, 1, sizeof bytes, in) : 0;
  if (in)
    fclose(in);
  disk_wrote(file, name, bytes, size, 0);
}

static void disk_note_write(int descriptor, const void *bytes, ssize_t size, off_t at) {
  char path[PATH_MAX];
  const char *name = disk_inside_of_descriptor(descriptor, path);
  struct stat now;
  if (!name || size < 0 || fstat(descriptor, &now) != 0)
    return;
  const size_t file = disk_file(now.st_ino, name);
  disk.files[file].written = true;
  disk_wrote(file, name, bytes, (size_t)size, at);
}

static void disk_note_cut(int descriptor, off_t size) {
  char path[PATH_MAX];
  const char *name = disk_inside_of_descriptor(descriptor, path);
  struct stat now;
  if (name && fstat(descriptor, &now) == 0)
    disk_note(DISK_CUT, disk_file(now.st_ino, name), name)->at = size;
}

static void disk_note_sync(int descriptor) {
  char path[PATH_MAX];
  const char *name = disk_inside_of_descriptor(descriptor, path);
  struct stat now;
  if (!name || fstat(descriptor, &now) != 0)
    return;
  if (S_ISDIR(now.st_mode)) {
    disk_note(DISK_FOLDER_SYNCED, 0, name);
    return;
  }
  const size_t file = disk_file(now.st_ino, name);
  disk_take_whole(file, name);
  disk_note(DISK_SYNCED, file, name);
}

static ssize_t disk_pwrite(int descriptor, const void *bytes, size_t size, off_t at) {
  DISK_ORIGINAL(ssize_t, "pwrite", int, const void *, size_t, off_t)
  const ssize_t done = original(descriptor, bytes, size, at);
  disk_note_write(descriptor, bytes, done, at);
  return done;
}
static int disk_ftruncate(int descriptor, off_t size) {
  DISK_ORIGINAL(int, "ftruncate", int, off_t)
  const int failed = original(descriptor, size);
  if (!failed)
    disk_note_cut(descriptor, size);
  return failed;
}

#pragma GCC visibility push(default) /* libraries must find these */
ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t at) {
  return disk_pwrite(descriptor, bytes, size, at);
}
ssize_t pwrite64(int descriptor, const void *bytes, size_t size, off_t at) {
  return disk_pwrite(descriptor, bytes, size, at);
}
ssize_t write(int descriptor, const void *bytes, size_t size) {
  DISK_ORIGINAL(ssize_t, "write", int, const void *, size_t)
  const off_t at = disk.root[0] ? lseek(descriptor, 0, SEEK_CUR) : 0;
  const ssize_t done = original(descriptor, bytes, size);
  disk_note_write(descriptor, bytes, done, at);
  return done;
}
int ftruncate(int descriptor, off_t size) {
  return disk_ftruncate(descriptor, size);
}
int ftruncate64(int descriptor, off_t size) {
  return disk_ftruncate(descriptor, size);
}
int fsync(int descriptor) {
  disk_note_sync(descriptor);
  return 0;
}
int fdatasync(int descriptor) {
  disk_note_sync(descriptor);
  return 0;
}
int mkdir(const char *path, mode_t mode) {
  DISK_ORIGINAL(int, "mkdir", const char *, mode_t)
  char absolute[2 * PATH_MAX];
  const char *name = disk_inside_of_name(path, absolute);
  const int failed = original(path, mode);
  if (!failed && name)
    disk_note(DISK_MADE, SIZE_MAX, name);
  return failed;
}
int unlink(const char *path) {
  DISK_ORIGINAL(int, "unlink", const char *)
  char absolute[2 * PATH_MAX];
  const char *name = disk_inside_of_name(path, absolute);
  struct stat before;
  const bool there = name && lstat(path, &before) == 0;
  const int failed = original(path);
  if (failed || !there)
    return failed;
  const size_t file = disk_file(before.st_ino, name);
  disk.files[file].inode = 0;
  disk_note(DISK_REMOVED, file, name);
  return failed;
}
int rename(const char *from, const char *to) {
  DISK_ORIGINAL(int, "rename", const char *, const char *)
  char absolute[2 * PATH_MAX], absolute_to[2 * PATH_MAX];
  const char *name = disk_inside_of_name(from, absolute), *new_name = disk_inside_of_name(to, absolute_to);
  struct stat moved;
  const bool there = name && new_name && lstat(from, &moved) == 0;
  const size_t file = there ? disk_file(moved.st_ino, name) : 0;
  if (there)
    disk_take_whole(file, name);
  const int failed = original(from, to);
  if (!failed && there)
    snprintf(disk_note(DISK_RENAMED, file, name)->new_name, sizeof disk.ops->new_name, "%s", new_name);
  return failed;
}

#pragma GCC visibility pop

/* Begins a record of a new, empty folder in the current one. */
static void disk_begin(const char *folder) {
  char command[PATH_MAX];
  snprintf(command, sizeof command, "rm -rf '%s' && mkdir '%s'", folder, folder);
  DISK_NEED(system(command) == 0);
  for (size_t i = 0; i < disk.count; i++)
    free(disk.ops[i].bytes);
  disk.count = disk.file_count = 0;
  DISK_NEED(realpath(folder, disk.root));
}
static void disk_end(void) {
  disk.root[0] = '\0';
}

/* The disk while a record is played. */
struct disk_play {
  struct disk_content {
    uint8_t *bytes;
    size_t size;
    size_t *pending, pending_count, pending_capacity; /* operations since the last sync */
  } * contents;
  struct disk_name {
    char name[128];
    size_t file; /* SIZE_MAX: a folder */
  } names[1024]; /* names that are kept */
  size_t name_count;
  size_t *changes, change_count; /* operations on names that no sync of the folder has kept yet */
  size_t next;                   /* operation */
};

static void disk_resize(struct disk_content *content, size_t size) {
  content->bytes = realloc(content->bytes, size + 1);
  DISK_NEED(content->bytes);
  if (size > content->size)
    memset(content->bytes + content->size, 0, size - content->size);
  content->size = size;
}

static uint64_t disk_draw(uint64_t *state) { /* splitmix64 */
  uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
  x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
  return x ^ x >> 31;
}

/* `draws`: NULL, or the random numbers that decide which 512 bytes arrive. */
static void disk_apply(struct disk_content *content, const struct disk_op *op, uint64_t *draws) {
  enum { SECTOR = 512 };
  if (op->kind == DISK_CUT) {
    if (!draws || disk_draw(draws) & 1)
      disk_resize(content, (size_t)op->at);
    return;
  }
  for (size_t from = 0; from < op->size;) {
    const size_t at = (size_t)op->at + from, end = (at / SECTOR + 1) * SECTOR;
    const size_t part = end - at < op->size - from ? end - at : op->size - from;
    if (!draws || disk_draw(draws) & 1) {
      if (at + part > content->size)
        disk_resize(content, at + part);
      memcpy(content->bytes + at, op->bytes + from, part);
    }
    from += part;
  }
}

static struct disk_name *disk_find(struct disk_name *names, size_t count, const char *name) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i].name, name) == 0)
      return &names[i];
  return NULL;
}

static void disk_change(struct disk_name *names, size_t *count, const struct disk_op *op) {
  struct disk_name *old = disk_find(names, *count, op->name);
  if (old && op->kind != DISK_MADE)
    *old = names[--*count];
  if (op->kind == DISK_REMOVED)
    return;
  const char *name = op->kind == DISK_RENAMED ? op->new_name : op->name;
  struct disk_name *place = disk_find(names, *count, name);
  if (!place) {
    DISK_NEED(*count < 1024);
    place = &names[(*count)++];
  }
  snprintf(place->name, sizeof place->name, "%s", name);
  place->file = op->file;
}

static bool disk_is_in(const char *name, const char *folder) {
  const char *slash = strrchr(name, '/');
  const size_t length = slash ? (size_t)(slash - name) : 0;
  return strlen(folder) == length && strncmp(name, folder, length) == 0;
}

static void disk_step(struct disk_play *play) {
  const size_t index = play->next++;
  const struct disk_op *op = &disk.ops[index];
  struct disk_content *content = op->file < disk.file_count ? &play->contents[op->file] : NULL;
  switch (op->kind) {
  case DISK_MADE:
  case DISK_REMOVED:
  case DISK_RENAMED: play->changes[play->change_count++] = index; break;
  case DISK_WROTE:
  case DISK_CUT:
    if (content->pending_count == content->pending_capacity) {
      content->pending_capacity = 2 * content->pending_capacity + 64;
      content->pending = realloc(content->pending, content->pending_capacity * sizeof *content->pending);
      DISK_NEED(content->pending);
    }
    content->pending[content->pending_count++] = index;
    break;
  case DISK_SYNCED:
    for (size_t i = 0; i < content->pending_count; i++)
      disk_apply(content, &disk.ops[content->pending[i]], NULL);
    content->pending_count = 0;
    break;
  case DISK_FOLDER_SYNCED: {
    size_t left = 0;
    for (size_t i = 0; i < play->change_count; i++)
      if (disk_is_in(disk.ops[play->changes[i]].name, op->name))
        disk_change(play->names, &play->name_count, &disk.ops[play->changes[i]]);
      else
        play->changes[left++] = play->changes[i];
    play->change_count = left;
    break;
  }
  }
}

static void disk_play_begin(struct disk_play *play) {
  *play = (struct disk_play){.contents = calloc(disk.file_count + 1, sizeof *play->contents),
                             .changes = calloc(disk.count + 1, sizeof *play->changes)};
  DISK_NEED(play->contents && play->changes);
}

static void disk_play_end(struct disk_play *play) {
  for (size_t i = 0; i < disk.file_count; i++) {
    free(play->contents[i].bytes);
    free(play->contents[i].pending);
  }
  free(play->contents);
  free(play->changes);
}

enum disk_rest { DISK_REST_LOST, DISK_REST_KEPT, DISK_REST_DRAWN, DISK_RESTS };
/* Plays the record up to its first `count` operations, which must not decrease, and makes the folder `into` as it may
 * be after a power cut then. `rest`: what happens to whatever is not synced. */
static void disk_cut(struct disk_play *play, size_t count, enum disk_rest rest, uint64_t seed, const char *into) {
  while (play->next < count)
    disk_step(play);
  char command[PATH_MAX];
  snprintf(command, sizeof command, "rm -rf '%s' && mkdir '%s'", into, into);
  DISK_NEED(system(command) == 0);
  static struct disk_name names[1024];
  size_t name_count = play->name_count;
  memcpy(names, play->names, sizeof names);
  const size_t changes = rest == DISK_REST_LOST   ? 0
                         : rest == DISK_REST_KEPT ? play->change_count
                                                  : disk_draw(&seed) % (play->change_count + 1);
  for (size_t i = 0; i < changes; i++)
    disk_change(names, &name_count, &disk.ops[play->changes[i]]);
  for (size_t i = 0; i < name_count; i++) { /* folders first */
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%.2000s/%.127s", into, names[i].name);
    if (names[i].file == SIZE_MAX)
      DISK_NEED(mkdir(path, 0777) == 0);
  }
  for (size_t i = 0; i < name_count; i++) {
    if (names[i].file == SIZE_MAX)
      continue;
    const struct disk_content *kept = &play->contents[names[i].file];
    struct disk_content content = {0};
    disk_resize(&content, kept->size);
    if (kept->size)
      memcpy(content.bytes, kept->bytes, kept->size);
    for (size_t k = 0; rest != DISK_REST_LOST && k < kept->pending_count; k++)
      disk_apply(&content, &disk.ops[kept->pending[k]], rest == DISK_REST_DRAWN ? &seed : NULL);
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%.2000s/%.127s", into, names[i].name);
    FILE *out = fopen(path, "wb"); /* fails when the folder of the file was lost: then so is the file */
    if (out)
      DISK_NEED(fwrite(content.bytes, 1, content.size, out) == content.size && fclose(out) == 0);
    free(content.bytes);
  }
}
