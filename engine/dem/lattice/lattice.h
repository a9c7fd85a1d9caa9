/* The points of a vectorizable random lattice, and the Voronoi cell of one of them, in lattice units (spacing 1).
 *
 * One point per grid square, drawn uniformly from the concentric square of side `disorder` (K99 section 2.1: "randomly
 * and independently in each square of the grid with a maximal distance a from the center", a between 0 and the
 * spacing). K99 does not say whether that region is a disc or a square. A disc of radius a = spacing would leave the
 * grid square, against "in each square"; the square of side a = spacing fills it exactly, so the region is that square.
 * No place in the plane is then farther than sqrt(2) from a point. Hence a cell reaches at most sqrt(2) from its point,
 * and neighbours lie at most three squares apart. */
#ifndef CLAST_ENGINE_DEM_LATTICE_LATTICE_H
#define CLAST_ENGINE_DEM_LATTICE_LATTICE_H

#include <stdbool.h>
#include <stdint.h>

#include "schemas/status.h"

struct dem_point {
  double x, y;
};

enum dem_outline { DEM_OUTLINE_DISC, DEM_OUTLINE_BLOCK };

struct dem_lattice {
  enum dem_outline outline;
  double spacing;          /* m, grid constant */
  double disorder;         /* 0..1: a over spacing; 0 = square lattice */
  double radius;           /* disc: cells whose centroid lies within it */
  uint32_t columns, rows;  /* block: cells clipped by the rectangle columns x rows spacings */
  struct dem_point origin; /* centre of the disc, lower left corner of the block */
  uint64_t seed;
  uint64_t stream; /* which body of the scene: bodies of one seed differ */
};

/* One number for a lattice square. A square of one seed has the same number in a body of any size. */
static inline uint64_t dem_lattice_square(uint32_t grid_x, uint32_t grid_y) {
  return (uint64_t)grid_y << 32 | grid_x;
}

struct dem_lattice_points {
  uint32_t columns, rows;  /* squares */
  uint32_t centre;         /* column and row of a disc's central square; 0 for a block */
  bool walled;             /* cells end at the rectangle [0, columns] x [0, rows] */
  struct dem_point *point; /* columns x rows, row by row */
};

/* For a disc the lattice is square, centred on the middle of a square, and reaches far enough beyond the disc that no
 * cell of it is unbounded. STATUS_MEMORY. */
status dem_lattice_fill(const struct dem_lattice *lattice, struct dem_lattice_points *points, struct error *error);

enum { DEM_LATTICE_CORNERS = 40 };

/* A cell while it is cut: corners counter-clockwise relative to its point; `across` identifies the neighbour beyond the
 * side from corner k to k + 1: the index of another point, or -1..-4 for the left, lower, right, upper wall. */
struct dem_lattice_cell {
  int count;
  double x[DEM_LATTICE_CORNERS], y[DEM_LATTICE_CORNERS];
  int64_t across[DEM_LATTICE_CORNERS];
};
/* Cuts one cell. False when it has too many corners (never seen: nearly all of its 48 candidates would have to be
 * neighbours). */
bool dem_lattice_cell(const struct dem_lattice_points *points, uint32_t column, uint32_t row,
                      struct dem_lattice_cell *cell);

/* The corner between the sides that the cell of point i shares with a and b. All cells that meet there get the same
 * bits. */
struct dem_point dem_lattice_corner(const struct dem_lattice_points *points, int64_t i, int64_t a, int64_t b);

#endif
