/* A broken body of polygons (DEM's grains), and its reader: what picture_fragments() draws.
 *
 * A fields file (HDF5, VTKHDF group) may come from anywhere, so the reader checks every size and index. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_BODY_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_BODY_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Convex cells, and the fragment that each one belongs to. */
struct picture_body {
  size_t cells;
  uint32_t *first_vertex; /* cells + 1: cell i has the vertices first_vertex[i] .. first_vertex[i + 1] - 1 */
  double (*vertex)[2];    /* m */
  uint32_t *fragment;     /* by cell: number of its fragment, 0 the heaviest */
  size_t cracks;          /* broken links inside one fragment, drawn as lines; between fragments there is a gap */
  uint32_t (*crack)[2];   /* pairs of cells; NULL for none */
};

/* Reads the body of a fields file of any engine whose cells are polygons. *body owns its arrays: picture_body_clear().
 * STATUS_MISSING: there is no such file. STATUS_CONTENT: it is no fields file, or it is damaged. STATUS_MEMORY.
 * After an error *body is all zero. */
status picture_body_read(const char *path, struct picture_body *body, struct error *error);
void picture_body_clear(struct picture_body *body);

#endif
