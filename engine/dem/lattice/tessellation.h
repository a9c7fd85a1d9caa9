/* Grains of a body: the Voronoi cells of a random lattice (K99 section 2.1), cut by the body's outline. */
#ifndef CLAST_ENGINE_DEM_LATTICE_TESSELLATION_H
#define CLAST_ENGINE_DEM_LATTICE_TESSELLATION_H

#include <stddef.h>

#include "engine/dem/lattice/lattice.h"

/* The cells of a body, and the pairs of cells with a common side. */
struct dem_tessellation {
  size_t cell_count;
  uint32_t *first_vertex;   /* cell_count + 1 */
  struct dem_point *vertex; /* m, world frame, counter-clockwise per cell; no side shorter than 1e-12 x spacing */
  struct dem_point *centroid;
  double *area;              /* m^2 */
  double *polar_moment;      /* m^4: second moment of area about the centroid */
  uint32_t *grid_x, *grid_y; /* the lattice square of the cell's point, counted from a block's lower left square or a
                              * disc's central one; squares left of it and below it as 2^32 minus their distance */
  size_t pair_count;
  uint32_t (*pair)[2]; /* neighbours, first < second, sorted */
  double *side;        /* m, length of the common side of each pair */
  size_t joined_at;    /* first cell of the second of two joined bodies; 0 for one body */
};

status dem_tessellation_make(const struct dem_lattice *lattice, struct dem_tessellation **out, struct error *error);
/* Joins two bodies into one, without pairs between them. The caller still owns both inputs. */
status dem_tessellation_join(const struct dem_tessellation *a, const struct dem_tessellation *b,
                             struct dem_tessellation **out, struct error *error);
void dem_tessellation_free(struct dem_tessellation *tessellation); /* NULL is fine */

#endif
