/* The true outlines of bodies: what is inside, how large, how far away, and points drawn uniformly from them. Particles
 * and flaws are both placed by these, so that a body is the same whatever its resolution. */
#ifndef CLAST_ENGINE_SPH_BODY_SHAPE_H
#define CLAST_ENGINE_SPH_BODY_SHAPE_H

#include <stdbool.h>

#include "schemas/status.h"

enum sph_shape_kind { SPH_SHAPE_SPHERE, SPH_SHAPE_CYLINDER, SPH_SHAPE_BOX };

struct sph_shape {
  int kind;            /* enum sph_shape_kind */
  double centre[3];    /* m */
  double radius;       /* m: sphere, cylinder */
  double inner_radius; /* m: cylinder with a hole along its axis (a ring); 0 = full */
  double length;       /* m: cylinder */
  double axis[3];      /* cylinder: direction of its axis, of any length but 0 */
  double side[3];      /* m: box, along x, y, z */
};

/* STATUS_CONTENT for sizes that are not positive and finite, a hole as wide as its cylinder, an axis of no length. */
status sph_shape_check(const struct sph_shape *shape, struct error *error);
double sph_shape_volume(const struct sph_shape *shape); /* m^3 */
bool sph_shape_inside(const struct sph_shape *shape, const double point[3]);
/* Signed distance to the nearest surface, m, positive outside (exact inside; outside, too); `normal` (NULL is fine)
 * points outwards there. */
double sph_shape_distance(const struct sph_shape *shape, const double point[3], double normal[3]);
/* Depth below each of the surfaces (faces, barrel, hole), m, negative outside, and their outward normals; returns how
 * many, up to SPH_SHAPE_WALLS. */
enum { SPH_SHAPE_WALLS = 6 };
int sph_shape_walls(const struct sph_shape *shape, const double point[3], double depth[SPH_SHAPE_WALLS],
                    double normal[SPH_SHAPE_WALLS][3]);
/* How far the shape reaches from its centre along a unit direction (of a ring: its hull), m. */
double sph_shape_reach(const struct sph_shape *shape, const double direction[3]);
/* Where the ray from the centre along `direction` leaves the hull, and the outward normal there. */
void sph_shape_surface(const struct sph_shape *shape, const double direction[3], double point[3], double normal[3]);
/* The point for three uniforms of [0, 1): uniform in the shape. */
void sph_shape_place(const struct sph_shape *shape, const double uniform[3], double point[3]);
/* Distance of two shapes (of rings: of their hulls), m; negative: the depth of their overlap. Exact when one is a
 * sphere, else to about 1e-6 of their size. */
double sph_shape_gap(const struct sph_shape *a, const struct sph_shape *b);
/* Smallest gap while b flies by a with the relative velocity b - a (m/s), from now on; *when (NULL is fine) in s. */
double sph_shape_approach(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3], double *when);
/* Columns of a right-handed frame whose third axis is the cylinder's; the identity for other shapes. */
void sph_shape_frame(const struct sph_shape *shape, double frame[3][3]);

#endif
