/* Shape files that scenes use, by their content. A scene keeps the SHA-256 of the file (an input with FIELD_FILE);
 * this list keeps the bytes and the mesh of each until the process ends. So a run depends on what a file holds, not on
 * its name; stores keep the bytes, and tasks carry them to other processes. */
#ifndef CLAST_ENGINE_MESH_FILES_H
#define CLAST_ENGINE_MESH_FILES_H

#include "engine/mesh/mesh.h"

enum { MESH_HASH_SIZE = 65 }; /* 64 hexadecimal digits and a NUL, as `sha256sum FILE` prints them */

struct mesh_file {
  char hash[MESH_HASH_SIZE];
  unsigned char *bytes;
  size_t size;
  struct mesh *mesh;
};

/* Reads a file; a name without a leading / is relative to `folder` (NULL: the current one). STATUS_MISSING, STATUS_IO,
 * or as mesh_read. */
status mesh_files_open(const char *name, const char *folder, const struct mesh_file **out, struct error *error);
/* The same from the bytes that a store or a task holds. */
status mesh_files_add(const char *name, const void *bytes, size_t size, const struct mesh_file **out,
                      struct error *error);
/* NULL: no file of this hash has been read. */
const struct mesh_file *mesh_files_find(const char *hash);

#endif
