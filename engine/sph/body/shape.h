/* The true shapes of bodies: what is inside, sizes, distances, and points drawn uniformly from them. Both particles and
 * flaws are placed by these functions, so that a body is the same at every resolution. */
#ifndef CLAST_ENGINE_SPH_BODY_SHAPE_H
#define CLAST_ENGINE_SPH_BODY_SHAPE_H

#include <stdbool.h>

#include "schemas/status.h"

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

/* STATUS_CONTENT: a size is not positive and finite, a hole is as wide as its cylinder, or an axis has no length. */
status sph_shape_check(const struct sph_shape *shape, struct error *error);
double sph_shape_volume(const struct sph_shape *shape); /* m^3 */
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
/* The point where the ray from the centre along `direction` leaves the hull (of a mesh: the mesh, for the last time),
 * and the outward normal there. False: a mesh that the ray does not meet. */
bool sph_shape_surface(const struct sph_shape *shape, const double direction[3], double point[3], double normal[3]);
/* Turns three uniforms of [0, 1) into a point that is uniform in the shape. For a mesh the point is uniform in the box
 * around it. False: the point is outside of the mesh; draw again. */
bool sph_shape_place(const struct sph_shape *shape, const double uniform[3], double point[3]);
/* The distance of two shapes, m; negative: the depth of their overlap. Rings count as their hulls. Exact when one is a
 * sphere, else to about 1e-6 of their size. Of two meshes, or of a mesh and a box or cylinder, the depth is that of the
 * deepest place found, and a gap may be too large where both are concave. */
double sph_shape_gap(const struct sph_shape *a, const struct sph_shape *b);
/* The smallest gap (m) from now on while b moves past a with the relative velocity of b (m/s), and its time (s) in
 * *when (NULL is fine). */
double sph_shape_gap_ahead(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3],
                           double *when);
/* A right-handed frame, in columns, whose third axis is the cylinder's; the identity for other shapes. */
void sph_shape_frame(const struct sph_shape *shape, double frame[3][3]);

#endif
