/* Makes a mesh from its file; used inside engine/mesh only. */
#ifndef CLAST_ENGINE_MESH_BUILD_H
#define CLAST_ENGINE_MESH_BUILD_H

#include "engine/mesh/mesh.h"

/* Vertices and faces as read from a file. */
struct mesh_soup {
  const char *name;
  bool numbered; /* `line` holds numbers of faces, as a binary file has no lines */
  size_t vertices, vertex_room, faces, face_room;
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

/* formats.c: reads a file into the soup. `text` ends with a NUL behind its `size` bytes. */
status mesh_formats_read(struct mesh_soup *soup, const char *text, size_t size, struct error *error);

/* closed.c: merges equal vertices, and checks that every edge has two faces that turn opposite ways and every face an
 * area. */
status mesh_closed_make(struct mesh_soup *soup, struct error *error);

/* inside.c: lists the faces by column, and checks that lines enter and leave the solid in turn. */
status mesh_inside_make(struct mesh *mesh, struct error *error);
void mesh_inside_free(struct mesh_columns *columns);
status mesh_inside_check(const struct mesh *mesh, const struct mesh_soup *soup, struct error *error);

/* The unit normal of a face, outwards. */
void mesh_normal(const struct mesh *mesh, uint32_t face, double normal[3]);

/* distance.c: the tree of boxes. */
status mesh_distance_make(struct mesh *mesh, struct error *error);
void mesh_distance_free(struct mesh_tree *tree);

#endif
