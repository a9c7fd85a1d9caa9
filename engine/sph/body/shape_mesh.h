/* The functions of shape.h for meshes. Only the area is used outside of this folder. */
#ifndef CLAST_ENGINE_SPH_BODY_SHAPE_MESH_H
#define CLAST_ENGINE_SPH_BODY_SHAPE_MESH_H

#include "engine/sph/body/shape.h"

status sph_shape_mesh_check(const struct sph_shape *shape, struct error *error);
double sph_shape_mesh_volume(const struct sph_shape *shape); /* m^3; NaN without a mesh, as when a scene is read */
double sph_shape_mesh_area(const struct sph_shape *shape);   /* m^2 */
bool sph_shape_mesh_inside(const struct sph_shape *shape, const double point[3]);
double sph_shape_mesh_distance(const struct sph_shape *shape, const double point[3], double normal[3]);
double sph_shape_mesh_reach(const struct sph_shape *shape, const double direction[3]);
bool sph_shape_mesh_surface(const struct sph_shape *shape, const double direction[3], double point[3],
                            double normal[3]);
bool sph_shape_mesh_place(const struct sph_shape *shape, const double uniform[3], double point[3]);
/* The gap between a mesh and a shape that is no sphere, m; negative: overlap. */
double sph_shape_mesh_gap(const struct sph_shape *mesh, const struct sph_shape *other);

#endif
