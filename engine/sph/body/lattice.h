/* The places of a body's particles at rest: a lattice that is cut by, or fitted to, the body's shape, or irregular
 * points.
 *
 * `spacing` is the side of the cube that holds one particle, (V/n)^(1/3), for every lattice. The nearest neighbours are
 * `nearest` apart: 1.1225 spacings (2^(1/6)) on the hexagonal lattice, 1 on the cubic one. Each particle has V/n of the
 * true volume V, so its mass is density x V/n, and the sum is exact.
 *
 * Lattices in boxes along the axes are fitted: whole rows and layers, stretched a little per direction, half a row from
 * each side, so that periodic sides match. The number of particles is that of whole planes: within 1 % of the wanted
 * one in hexagonal cubes of 12000 and in long bars of fewer, within 2 % in cubic cubes, coarser where planes are few.
 * In cylinders layers are whole along the axis. All other lattices, turned ones included, are cut by the surface: their
 * offset is searched to give the wanted number. Then the lattice is scaled (by less than 0.1 % where it has hundreds of
 * particles) so that its volume per particle is exactly V/n. */
#ifndef CLAST_ENGINE_SPH_BODY_LATTICE_H
#define CLAST_ENGINE_SPH_BODY_LATTICE_H

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/body/shape.h"

enum sph_lattice_kind {
  SPH_LATTICE_HEXAGONAL, /* close packed, ABAB; rows along x (third axis: the cylinder's) */
  SPH_LATTICE_CUBIC,
  SPH_LATTICE_IRREGULAR, /* random points, pushed apart until the density sum is uniform */
  SPH_LATTICES
};

/* Finer spacing near a point: s(d) = fine + growth d^2/(d + 4 fine), where d is the distance from the sphere of
 * `radius` about `point`. Graded bodies always have irregular points, as no lattice changes its spacing without
 * defects. */
struct sph_grading {
  double fine;     /* m, spacing within `radius`; 0: no grading */
  double point[3]; /* m */
  double radius;   /* m */
  double growth;   /* largest growth of spacing per distance, up to 0.12; NaN: found from `particles` */
};

struct sph_lattice {
  int kind;         /* enum sph_lattice_kind */
  double particles; /* wanted number; NaN: from `spacing` */
  double spacing;   /* m; used when `particles` is NaN */
  bool turned;      /* lattices: orientation and offset are drawn from the seed */
  bool periodic[3]; /* boxes, and cylinders along their axis: the direction is periodic; the body begins at 0 in it */
  uint64_t seed;
  uint64_t body; /* bodies of one seed have different points */
  struct sph_grading grading;
};

struct sph_points {
  size_t n;
  double *x, *y, *z;
  double *share;  /* graded: volume of each particle over V/n; NULL: all equal */
  double spacing; /* m, (V/n)^(1/3) */
  double nearest; /* m, distance of nearest neighbours (irregular points: the mean) */
  double stretch; /* largest spacing of a direction over the ideal one; 1: not stretched */
};

/* STATUS_CONTENT: no particles, a shape too thin for its particles, or impossible sizes; STATUS_MEMORY, with the
 * number, before anything is allocated. On failure *points is empty. */
status sph_lattice_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                        struct error *error);
void sph_lattice_empty(struct sph_points *points); /* frees the arrays in `points` */

/* The length (m) of direction 0 to 2 that holds whole periods of the unstretched lattice, next above `at_least`.
 * Periodic lengths of thin bars should be at least 4h and the skin, so that no particle meets its own image. */
double sph_lattice_period(int kind, double spacing, int direction, double at_least);

#endif
