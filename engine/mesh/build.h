/* Makes a mesh from its file; used inside engine/mesh only. */
#pragma once

#include "engine/mesh/mesh.h"

/* Vertices and faces as read from a file. */
struct mesh_soup {
  const char *name;
  bool numbered; /* `line` holds numbers of faces, as a binary file has no lines */
  size_t vertices, vertex_room, faces, face_room;
  size_t tail; /* bytes behind the last face of a binary file */
  double (*vertex)[3];
  uint32_t (*face)[3];
  uint32_t *line; /* of each face */
};

/* Makes an error message with the place in the file (line 0: no place). Returns STATUS_CONTENT. */
status mesh_refuse(const struct mesh_soup *soup, size_t line, struct error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* STATUS_CONTENT: not finite, or too many faces; STATUS_MEMORY. */
status mesh_soup_vertex(struct mesh_soup *soup, size_t line, const double place[3], struct error *error);
status mesh_soup_face(struct mesh_soup *soup, size_t line, const uint32_t corners[3], struct error *error);

/* formats.c: reads a file into the soup. `text` ends with a NUL behind its `size` bytes; joined lines are changed in
 * place. */
status mesh_formats_read(struct mesh_soup *soup, char *text, size_t size, struct error *error);

/* search.c: lists the faces by column, checks that lines enter and leave the solid in turn, and makes the tree of
 * boxes. STATUS_CONTENT, STATUS_MEMORY. */
status mesh_search_make(struct mesh *mesh, const struct mesh_soup *soup, struct error *error);
void mesh_search_free(struct mesh *mesh);

/* The unit normal of a face, outwards. */
void mesh_normal(const struct mesh *mesh, uint32_t face, double normal[3]);
