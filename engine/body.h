/* A body in pieces, read back from a fields file (HDF5, VTKHDF group) of any engine whose cells are polygons: what
 * pictures are drawn from. The file may come from anywhere: every size and index is checked. */
#ifndef CLAST_ENGINE_BODY_H
#define CLAST_ENGINE_BODY_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct body {
  size_t cells;
  uint32_t *first_vertex; /* cells + 1 */
  double (*vertex)[2];    /* m */
  uint32_t *fragment;     /* per cell: number of its fragment, 0 the heaviest */
  size_t cracks;          /* broken links between cells of one fragment */
  uint32_t (*crack)[2];   /* pairs of cells */
};

/* STATUS_MISSING: no such file; STATUS_CONTENT: no fields file, or damaged; STATUS_MEMORY. *body is all zero then. */
status body_read(const char *path, struct body *body, struct error *error);
void body_clear(struct body *body);

#endif
