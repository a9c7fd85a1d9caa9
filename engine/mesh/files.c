/* The list of shape files that were read. It is short: a campaign has one or a few. */
#include "engine/mesh/files.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "engine/file_name.h"
#include "schemas/file.h"
#include "schemas/sha256.h"

struct entry {
  struct entry *next;
  struct mesh_file file;
};

static struct entry *entries; /* entries are only added at the head: pointers to files stay valid */

const struct mesh_file *mesh_files_find(const char *hash) {
  for (const struct entry *e = entries; e; e = e->next)
    if (strcmp(e->file.hash, hash) == 0)
      return &e->file;
  return NULL;
}

/* Takes ownership of the bytes. */
static status add(const char *name, unsigned char *bytes, size_t size, const struct mesh_file **out,
                  struct error *error) {
  char hash[MESH_HASH_SIZE];
  sha256_text(bytes, size, hash);
  *out = mesh_files_find(hash);
  if (*out) {
    free(bytes);
    return STATUS_OK;
  }
  struct entry *entry = calloc(1, sizeof *entry);
  status code = entry ? mesh_read(name, bytes, size, &entry->file.mesh, error)
                      : status_fail(error, STATUS_MEMORY, "no memory for the shape file %.3000s", name);
  if (code) {
    free(entry);
    free(bytes);
    return code;
  }
  memcpy(entry->file.hash, hash, sizeof hash);
  entry->file.bytes = bytes;
  entry->file.size = size;
  entry->next = entries;
  entries = entry;
  *out = &entry->file;
  return STATUS_OK;
}

status mesh_files_add(const char *name, const void *bytes, size_t size, const struct mesh_file **out,
                      struct error *error) {
  unsigned char *copy = malloc(size + 1);
  if (!copy)
    return status_fail(error, STATUS_MEMORY, "no memory for the shape file %.3000s", name);
  if (size)
    memcpy(copy, bytes, size);
  return add(name, copy, size, out, error);
}

/* A device or a pipe may never end, and a large file is not read at all. */
static status look(const char *path, struct error *error) {
  struct stat about;
  if (stat(path, &about) != 0)
    return STATUS_OK; /* opening it reports the reason */
  if (!S_ISREG(about.st_mode))
    return status_fail(error, STATUS_IO, "%.3000s: is no regular file: name a shape file (STL or OBJ)", path);
  if (about.st_size > MESH_MOST_BYTES)
    return status_fail(error, STATUS_CONTENT,
                       "%.3000s: the file has %lld MB, and %d MB is the most: take a coarser model", path,
                       (long long)(about.st_size >> 20), MESH_MOST_BYTES >> 20);
  return STATUS_OK;
}

status mesh_files_open(const char *name, const char *folder, const struct mesh_file **out, struct error *error) {
  char *path = file_name_in(folder, name);
  unsigned char *bytes = NULL;
  size_t size = 0;
  *out = NULL;
  if (!path)
    return status_fail(error, STATUS_MEMORY, "no memory for the name of a file");
  status code = look(path, error);
  if (!code)
    code = file_input(path, error);
  if (!code)
    code = file_read(path, "shape file", &bytes, &size, error);
  if (!code)
    code = add(path, bytes, size, out, error);
  free(path);
  return code;
}
