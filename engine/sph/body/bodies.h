/* The solids of a scene before the first step: particles in true shapes, the places of bodies and their motion, and
 * which particles are held or damped. Pure functions of their arguments (and of a seed). In the order of use:
 *
 *   struct sph_body body[2] = {{.shape = ..., .lattice = ..., .density = 2700, .h_over_spacing = NAN}, {...}};
 *   double flight[3];
 *   sph_bodies_aim(&body[0].shape, &body[1].shape, angle, flight)   places the projectile
 *   sph_bodies_make(body, 2, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &particles, range, &error)   also checks for overlaps
 *   sph_bodies_move(particles, range[1], velocity)
 *   sph_flaws_place(&law, &body[0].shape, particles, range[0], INFINITY, &flaws, &error)   (flaws.h) */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/body/particles.h"

/* The true shapes of bodies: what is inside, sizes, distances, and points drawn uniformly from them. Both particles and
 * flaws are placed by these functions, so that a body is the same at every resolution. */

enum sph_shape_kind { SPH_SHAPE_SPHERE, SPH_SHAPE_CYLINDER, SPH_SHAPE_BOX, SPH_SHAPE_MESH, SPH_SHAPES };

struct mesh;

struct sph_shape {
  int kind;                /* enum sph_shape_kind */
  double centre[3];        /* m */
  double radius;           /* m: sphere, cylinder */
  double inner_radius;     /* m: hole along a cylinder's axis (then it is a ring); 0: none */
  double length;           /* m: cylinder */
  double axis[3];          /* cylinder: direction of its axis, of any length but 0 */
  double side[3];          /* m: box, along x, y, z */
  const struct mesh *mesh; /* mesh: its surface, borrowed (engine/mesh); `centre` is its centre of mass */
  double unit;             /* m: mesh, one unit of its file */
};

/* Sizes are positive and finite, a hole is narrower than its cylinder, and an axis has a length. */
double sph_shape_volume(const struct sph_shape *shape); /* m^3 */
/* m: the shortest way through its middle between two faces, of a ring through the wall, of a mesh across its box */
double sph_shape_thinnest(const struct sph_shape *shape);
bool sph_shape_inside(const struct sph_shape *shape, const double point[3]);
/* The exact signed distance to the nearest surface, m, positive outside. `normal` (NULL is fine) points outwards there.
 */
double sph_shape_distance(const struct sph_shape *shape, const double point[3], double normal[3]);
/* The depth below each of the surfaces (faces, barrel, hole), m, negative outside, and their outward normals. Returns
 * their number, up to SPH_SHAPE_WALLS. */
enum { SPH_SHAPE_WALLS = 6 };
int sph_shape_walls(const struct sph_shape *shape, const double point[3], double depth[SPH_SHAPE_WALLS],
                    double normal[SPH_SHAPE_WALLS][3]);
/* The extent of the shape from its centre along a unit direction, m; of a ring that of its hull. */
double sph_shape_reach(const struct sph_shape *shape, const double direction[3]);
/* The point where the line from the centre upwards (z) leaves the hull (of a mesh: the mesh, for the last time), and
 * the outward normal there. False: a mesh that the line does not meet. */
bool sph_shape_top(const struct sph_shape *shape, double point[3], double normal[3]);
/* Turns three uniforms of [0, 1) into a point that is uniform in the shape. For a mesh the point is uniform in the box
 * around it. False: the point is outside of the mesh; draw again. */
bool sph_shape_place(const struct sph_shape *shape, const double uniform[3], double point[3]);
double sph_shape_mesh_area(const struct sph_shape *shape); /* m^2, of a mesh */
/* The distance of two shapes, m; negative: they overlap. Rings count as their hulls. Exact when one is a sphere, else
 * to about 1e-6 of their size; so is the depth of an overlap with a sphere. Of a mesh and another shape it is that of
 * the deepest place found, and a gap may be too large where both are concave; of boxes and cylinders it is just below
 * 0. */
double sph_shape_gap(const struct sph_shape *a, const struct sph_shape *b);
/* The smallest gap (m) from now on while b moves past a with the relative velocity of b (m/s). */
double sph_shape_gap_ahead(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3]);
/* A right-handed frame, in columns, whose third axis is the cylinder's; the identity for other shapes. */
void sph_shape_frame(const struct sph_shape *shape, double frame[3][3]);

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

/* STATUS_CONTENT: a shape too thin for its particles; STATUS_MEMORY, with the number, before anything is allocated. On
 * failure *points is empty. Only boxes, and cylinders along their axis, can be periodic, of lattices that are neither
 * turned nor graded. */
status sph_lattice_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                        struct error *error);
void sph_lattice_empty(struct sph_points *points); /* frees the arrays in `points` */

/* The length (m) of direction 0 to 2 that holds whole periods of the unstretched lattice, next above `at_least`.
 * Periodic lengths of thin bars should be at least 4h and the skin, so that no particle meets its own image. */
double sph_lattice_period(int kind, double spacing, int direction, double at_least);

/* Memory for n places. STATUS_MEMORY. */
status sph_lattice_allocate(struct sph_points *points, size_t n, struct error *error);

/* irregular.c: irregular points, uniform or finer near a point. `wanted`: number of uniform particles (not used with a
 * grading). Fills *points: x, y, z, n, and share when graded. STATUS_MEMORY; STATUS_CONTENT when a grading cannot give
 * the number of particles. */
status sph_irregular_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, double wanted,
                          struct sph_points *points, struct error *error);
/* The least spacing (m) near the point, at least grading.fine, with which no spacing of the body is above `coarsest`
 * times the uniform one of so many particles. Needs the volume of the shape; grading.growth is not used. */
double sph_irregular_finest(struct sph_grading grading, const struct sph_shape *shape, double particles,
                            double coarsest);
/* The fewest particles with which that is grading.fine. */
double sph_irregular_least(struct sph_grading grading, const struct sph_shape *shape, double coarsest);
/* The largest spacing (m) of a body of so many particles; at its farthest place from the point. */
double sph_irregular_coarsest(struct sph_grading grading, const struct sph_shape *shape, double particles);
/* STATUS_CONTENT: the grading cannot give so many particles. */
status sph_irregular_check(struct sph_grading grading, const struct sph_shape *shape, double particles,
                           struct error *error);

/* h over spacing, where spacing = (V/n)^(1/3). It gives 56 neighbours within 2h on the hexagonal and cubic lattices at
 * rest (48 by volume). On a lattice the sum of (m_j/rho_j) x dW/dx, a factor of every strain and every force, depends
 * on h and is not exactly 1. With this h it is 1.006, 1.006, 0.993 along x, y, z of the hexagonal lattice and 0.992 on
 * the cubic one. With 1.21 it is 1.024 and 0.981: wave speeds are wrong by 2 % and moduli by 4 %, at any resolution. */
#define SPH_BODIES_H 1.13

struct sph_body {
  struct sph_shape shape;
  struct sph_lattice lattice;
  double density;        /* kg/m^3, bulk */
  double h_over_spacing; /* NaN: SPH_BODIES_H */
};

struct sph_range { /* a body's particles: ids first .. first + n - 1 */
  size_t first, n;
  double spacing, nearest; /* m, as in sph_points */
  double h;                /* m; in a graded body that of the mean particle */
  double mass;             /* kg, of the body: density x true volume */
};

/* Makes the particles of all bodies, one body after the other, at rest. Fills x y z, mass, density, h and body;
 * `arrays` as for sph_particles_make. `ranges` (NULL is fine) has room for `count`. STATUS_CONTENT: bodies overlap (the
 * message has their names and the depth), or as sph_lattice_fill says; STATUS_MEMORY. */
status sph_bodies_make(const struct sph_body *bodies, size_t count, int arrays, struct sph_particles **out,
                       struct sph_range *ranges, struct error *error);

/* The point of impact (sph_shape_top of the target), and unit vectors there. frame[2] is the outward normal, frame[0]
 * lies in the face, towards +x (towards +y if the normal is within 0.1 rad of the x axis). Of a face whose normal is z
 * they are x, y and z. False: a mesh that the line upwards does not meet. */
bool sph_bodies_face(const struct sph_shape *target, double point[3], double frame[3][3]);

/* Puts the projectile at the target, in contact at the point of impact. `flight` becomes the unit vector of its motion:
 * `angle` (rad) from the inward normal, turned towards frame[0], below pi/2. STATUS_CONTENT: no point of impact. */
status sph_bodies_aim(const struct sph_shape *target, struct sph_shape *projectile, double angle, double flight[3],
                      struct error *error);

/* Velocity fields. Each is added to the present velocities. */
void sph_bodies_move(struct sph_particles *particles, struct sph_range range, const double velocity[3]);
/* A stretch along z: v = rate (-ratio x, -ratio y, z); rate in 1/s, `ratio` is Poisson's. */
void sph_bodies_stretch(struct sph_particles *particles, struct sph_range range, double rate, double ratio);
/* v = spin x r, rad/s. */
void sph_bodies_spin(struct sph_particles *particles, struct sph_range range, const double spin[3]);

/* Sets the bits `freedoms` of `held` in both ends of a body along z, |z| > half (m). */
void sph_bodies_hold(struct sph_particles *particles, struct sph_range range, double half, int freedoms);
/* Damping at all sides of a box except the upper one of z, where the impact is, so that waves leave it. The damping
 * rate (1/s) grows as the square of the depth from 0 at `margin` (m) from a side to `rate` at the side; the largest of
 * the sides counts. */
void sph_bodies_damp(struct sph_particles *particles, struct sph_range range, const struct sph_shape *box,
                     double margin, double rate);
