/* Grains of a body: the Voronoi cells of a random lattice (K99 section 2.1), cut by the body's outline. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
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
  double hole;             /* disc: radius of its hole, cells whose centroid does not lie within it; 0: none */
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
status dem_tessellation_points(const struct dem_lattice *lattice, struct dem_lattice_points *points,
                               struct error *error);

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

/* An entry of the log of broken beams. A beam joins the cells of a pair. */
struct dem_break {
  double time;             /* s */
  uint32_t beam;           /* index into the tessellation's pairs */
  double strain, angle[2]; /* angle: rotations of the two ends, rad */
  bool bending;            /* mode: the bending term was the larger one */
};

status dem_tessellation_make(const struct dem_lattice *lattice, struct dem_tessellation **out, struct error *error);
/* Joins two bodies into one, without pairs between them. The caller still owns both inputs. */
status dem_tessellation_join(const struct dem_tessellation *a, const struct dem_tessellation *b,
                             struct dem_tessellation **out, struct error *error);
/* The common side of cells i and j: its number in each (side k goes from vertex k to the next), and its vector (m),
 * counter-clockwise for cell i. False if there is none. */
bool dem_tessellation_side(const struct dem_tessellation *t, uint32_t i, uint32_t j, uint32_t side[2],
                           struct dem_point *along);
void dem_tessellation_free(struct dem_tessellation *tessellation); /* NULL is fine */
