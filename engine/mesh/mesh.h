/* A closed surface of triangles from a shape file (STL or OBJ), and the solid inside it.
 *
 * Lengths are in units of the file. Places are relative to the centre of mass of the solid (uniform density). A mesh is
 * checked when it is read: every edge has two faces that turn opposite ways, and lines through all faces enter and
 * leave the solid in turn. So cavities and several parts are fine; holes and faces that cut others are not.
 *
 * Files are untrusted data, and their size is limited. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { MESH_MOST_BYTES = 32 << 20, MESH_MOST_FACES = 500000 };

struct mesh_columns;
struct mesh_tree;

struct mesh {
  size_t vertices, faces;
  size_t tail; /* bytes of the file behind the last face, which are not read (binary STL) */
  double (*vertex)[3];
  uint32_t (*face)[3]; /* its vertices, counter-clockwise seen from outside */
  size_t parts;        /* of the solid, which do not touch */
  double centre[3];    /* of mass, in the coordinates of the file */
  double volume, area;
  double low[3], high[3];       /* the box around it */
  struct mesh_columns *columns; /* search.c */
  struct mesh_tree *tree;       /* search.c */
};

/* `name` is for messages. The format is found by the content. STATUS_CONTENT: not a shape file, or not a closed
 * surface, with line (or number of the face) and remedy; STATUS_MEMORY. */
status mesh_read(const char *name, const void *bytes, size_t size, struct mesh **out, struct error *error);
void mesh_free(struct mesh *mesh); /* NULL is fine */

/* Sums the winding number of the surface about the point (1 inside, 0 outside) over the faces above it. An edge gives
 * the same answer in its two faces, so no line passes between them. Only points within rounding of the surface are
 * undecided. */
bool mesh_inside(const struct mesh *mesh, const double point[3]);
/* The distance to the nearest face, negative inside. `normal` (NULL is fine) points outwards there. */
double mesh_distance(const struct mesh *mesh, const double point[3], double normal[3]);
/* The largest coordinate along a direction. */
double mesh_reach(const struct mesh *mesh, const double direction[3]);
/* The last place where the line from the centre upwards (z) leaves the solid, and the normal of the face there. False:
 * it does not meet the solid (a ring). */
bool mesh_top(const struct mesh *mesh, double point[3], double normal[3]);

/* Shape files that scenes use, by their content. A scene keeps the SHA-256 of the file (an input with FIELD_FILE);
 * this list keeps the bytes and the mesh of each until the process ends. So a run depends on what a file holds, not on
 * its name; stores keep the bytes, and tasks carry them to other processes. */
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
