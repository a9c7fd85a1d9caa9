/* A mesh in metres, with its centre of mass at the centre of the shape. */
#include "engine/sph/body/shape_mesh.h"

#include <math.h>
#include <stddef.h>

#include "engine/mesh/mesh.h"

status sph_shape_mesh_check(const struct sph_shape *s, struct error *error) {
  if (!s->mesh)
    return status_fail(error, STATUS_CONTENT, "a mesh without its shape file: name the file in the scene.");
  if (!(s->unit > 0) || !isnormal(sph_shape_mesh_volume(s)))
    return status_fail(error, STATUS_CONTENT, "a unit of the shape file is %g m, which makes %g m^3 of the body.",
                       s->unit, sph_shape_mesh_volume(s));
  return STATUS_OK;
}

double sph_shape_mesh_volume(const struct sph_shape *s) {
  return s->mesh ? s->mesh->volume * s->unit * s->unit * s->unit : (double)NAN;
}

double sph_shape_mesh_area(const struct sph_shape *s) {
  return s->mesh ? s->mesh->area * s->unit * s->unit : (double)NAN;
}

static void to_file(const struct sph_shape *s, const double point[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = (point[k] - s->centre[k]) / s->unit;
}

static void from_file(const struct sph_shape *s, const double place[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = s->centre[k] + s->unit * place[k];
}

bool sph_shape_mesh_inside(const struct sph_shape *s, const double point[3]) {
  double p[3];
  to_file(s, point, p);
  return s->mesh && mesh_inside(s->mesh, p);
}

double sph_shape_mesh_distance(const struct sph_shape *s, const double point[3], double normal[3]) {
  double p[3];
  to_file(s, point, p);
  return s->mesh ? s->unit * mesh_distance(s->mesh, p, normal) : (double)NAN;
}

double sph_shape_mesh_reach(const struct sph_shape *s, const double direction[3]) {
  return s->mesh ? s->unit * mesh_reach(s->mesh, direction) : (double)NAN;
}

bool sph_shape_mesh_surface(const struct sph_shape *s, const double direction[3], double point[3], double normal[3]) {
  double p[3] = {0, 0, 0};
  const bool found = s->mesh && mesh_surface(s->mesh, direction, p, normal);
  from_file(s, p, point);
  return found;
}

bool sph_shape_mesh_place(const struct sph_shape *s, const double u[3], double point[3]) {
  double p[3];
  for (int k = 0; k < 3; k++)
    p[k] = s->mesh->low[k] + u[k] * (s->mesh->high[k] - s->mesh->low[k]);
  from_file(s, p, point);
  return mesh_inside(s->mesh, p);
}

/* ---- gaps ---- */

static double between(const double a[3], const double b[3]) {
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static const double golden = 0.6180339887498949;

/* A point of a face: the part `along` of the way from its first corner to the point at `across` of the opposite edge.
 */
static void point_of(const double corner[3][3], double across, double along, double p[3]) {
  for (int k = 0; k < 3; k++) {
    const double end = corner[1][k] + across * (corner[2][k] - corner[1][k]);
    p[k] = corner[0][k] + along * (end - corner[0][k]);
  }
}

/* The least signed distance of `other` from the points at `across` of a face. */
static double ray_gap(const double corner[3][3], double across, const struct sph_shape *other, int turns) {
  double low = 0, high = 1, gap = INFINITY;
  for (int turn = 0; turn < turns; turn++) {
    double p[3], distance[2];
    const double along[2] = {high - golden * (high - low), low + golden * (high - low)};
    for (int i = 0; i < 2; i++) {
      point_of(corner, across, along[i], p);
      distance[i] = sph_shape_distance(other, p, NULL);
    }
    gap = fmin(gap, fmin(distance[0], distance[1]));
    *(distance[0] <= distance[1] ? &high : &low) = along[distance[0] <= distance[1]];
  }
  return gap;
}

/* The same of the whole face. The distance from a convex body is a convex function, so golden sections end at its least
 * value; from a mesh it is one of the low ones. */
static double face_gap(const double corner[3][3], const struct sph_shape *other) {
  const int turns = other->kind == SPH_SHAPE_MESH ? 20 : 36;
  double low = 0, high = 1, gap = INFINITY;
  for (int turn = 0; turn < turns; turn++) {
    const double across[2] = {high - golden * (high - low), low + golden * (high - low)};
    const double distance[2] = {ray_gap(corner, across[0], other, turns), ray_gap(corner, across[1], other, turns)};
    gap = fmin(gap, fmin(distance[0], distance[1]));
    *(distance[0] <= distance[1] ? &high : &low) = across[distance[0] <= distance[1]];
  }
  return gap;
}

double sph_shape_mesh_gap(const struct sph_shape *s, const struct sph_shape *other) {
  const struct mesh *m = s->mesh;
  double gap = INFINITY;
  if (!m || (other->kind == SPH_SHAPE_MESH && !other->mesh))
    return NAN;
  for (size_t f = 0; f < m->faces; f++) {
    double corner[3][3], middle[3], radius = 0;
    for (int c = 0; c < 3; c++)
      from_file(s, m->vertex[m->face[f][c]], corner[c]);
    for (int k = 0; k < 3; k++)
      middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) / 3;
    for (int c = 0; c < 3; c++)
      radius = fmax(radius, between(corner[c], middle));
    const double distance = sph_shape_distance(other, middle, NULL);
    if (distance - radius < gap)
      gap = fmin(gap, fmin(distance, face_gap(corner, other)));
  }
  /* One may be wholly inside the other. The other's surface above its centre is a point of it. */
  double point[3], normal[3];
  const double up[3] = {0, 0, 1};
  if (gap > 0 && sph_shape_surface(other, up, point, normal))
    gap = fmin(gap, fmax(-sph_shape_reach(other, up), sph_shape_distance(s, point, NULL)));
  return gap;
}
