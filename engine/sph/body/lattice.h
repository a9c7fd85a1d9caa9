/* Where the particles of a body stand at rest: lattices cut by, or fitted to, the body's shape.
 *
 * `spacing` always means the side of the cube that holds one particle, (V/n)^(1/3), whatever the lattice. Nearest
 * neighbours stand `nearest` apart: 1.1225 spacings (2^(1/6)) on the hexagonal lattice, 1 on the cubic one. Every
 * particle stands for V/n of the true volume V, so mass per particle is density x V/n, and the sum is exact.
 *
 * Boxes along the axes are fitted: whole rows and layers, stretched a little per direction, half a row from each side;
 * so periodic sides match. Their number is that of whole planes: within 1 % of a wanted one in hexagonal cubes of 12000
 * and in long bars of fewer, 2 % in cubic cubes, coarser where planes are few (turned lattices are cut: any
 * number). Cylinders have whole layers along their axis. Elsewhere the lattice is cut by the surface: its offset is
 * searched so that the number comes out right, then it is scaled (by less than 0.1 % where it has hundreds) so that its
 * volume per particle is exactly V/n. */
#ifndef CLAST_ENGINE_SPH_BODY_LATTICE_H
#define CLAST_ENGINE_SPH_BODY_LATTICE_H

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/body/shape.h"

enum sph_lattice_kind {
  SPH_LATTICE_HEXAGONAL, /* close packed, ABAB; rows along x (third axis: the cylinder's) */
  SPH_LATTICE_CUBIC,
  SPH_LATTICE_IRREGULAR, /* random points pushed apart until the density sum is uniform */
};

/* Finer near a point: s(d) = fine + growth d^2/(d + 4 fine), d = distance from the sphere of `radius` about `point`.
 * Always irregular points: no lattice changes its spacing without defects. */
struct sph_grading {
  double fine;     /* m, spacing within `radius`; 0 = no grading */
  double point[3]; /* m */
  double radius;   /* m */
  double growth;   /* largest growth of spacing per distance, up to 0.12; NaN: found from `particles` */
};

struct sph_lattice {
  int kind;         /* enum sph_lattice_kind */
  double particles; /* wanted number; NaN: `spacing` decides */
  double spacing;   /* m; used when `particles` is NaN */
  bool turned;      /* regular lattices: orientation and offset drawn from the seed (boxes: then cut, not fitted) */
  bool periodic[3]; /* boxes, and cylinders along their axis: that direction repeats; the body begins at 0 there */
  uint64_t seed;
  uint64_t body; /* bodies of one seed differ */
  struct sph_grading grading;
};

struct sph_points {
  size_t n;
  double *x, *y, *z;
  double *share;  /* graded: volume of each over V/n; NULL: all equal */
  double spacing; /* m, (V/n)^(1/3) */
  double nearest; /* m, distance of nearest neighbours (irregular: mean) */
  double stretch; /* largest spacing of a direction over the ideal one, 1 = unstretched */
};

/* STATUS_CONTENT: no particles, or a shape too thin for its particles, or sizes that cannot be; STATUS_MEMORY with the
 * number, before anything is allocated. On failure *points is empty. */
status sph_lattice_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                        struct error *error);
void sph_lattice_empty(struct sph_points *points); /* frees what is in it */

/* The length of direction 0-2 next above `at_least` that holds whole periods of the unstretched lattice, m. Periodic
 * lengths of thin bars: at least 4h and the skin, so that no particle meets its own image. */
double sph_lattice_period(int kind, double spacing, int direction, double at_least);

#endif
