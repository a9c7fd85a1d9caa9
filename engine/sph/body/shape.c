/* Spheres, cylinders, boxes: volume, distance, surface, random points. Meshes are in shape_mesh.c. */
#include "engine/sph/body/shape.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "engine/sph/body/shape_mesh.h"
#include "engine/vector3.h"

static status positive(double value, const char *name, struct error *error) {
  if (value > 0 && isfinite(value) && isnormal(value * value * value))
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT, "%s is %g m: give a positive length.", name, value);
}

static status check_cylinder(const struct sph_shape *s, struct error *error) {
  double ignored[3];
  status code = positive(s->radius, "the radius of a cylinder", error);
  if (code)
    return code;
  code = positive(s->length, "the length of a cylinder", error);
  if (code)
    return code;
  if (!(s->inner_radius >= 0 && s->inner_radius < s->radius))
    return status_fail(error, STATUS_CONTENT,
                       "the hole of a cylinder has radius %g m: give 0 to below its radius, %g m.", s->inner_radius,
                       s->radius);
  if (!(vector3_unit(s->axis, ignored) > 0))
    return status_fail(error, STATUS_CONTENT, "the axis of a cylinder has no direction.");
  return STATUS_OK;
}

static status check_box(const struct sph_shape *s, struct error *error) {
  static const char *const name[3] = {"side x of a box", "side y of a box", "side z of a box"};
  for (int k = 0; k < 3; k++) {
    const status code = positive(s->side[k], name[k], error);
    if (code)
      return code;
  }
  return STATUS_OK;
}

status sph_shape_check(const struct sph_shape *s, struct error *error) {
  for (int k = 0; k < 3; k++)
    if (!isfinite(s->centre[k]))
      return status_fail(error, STATUS_CONTENT, "the centre of a body is not finite.");
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return positive(s->radius, "the radius of a sphere", error);
  case SPH_SHAPE_CYLINDER: return check_cylinder(s, error);
  case SPH_SHAPE_BOX: return check_box(s, error);
  case SPH_SHAPE_MESH: return sph_shape_mesh_check(s, error);
  default: return status_fail(error, STATUS_INTERNAL, "shape %d is unknown", s->kind);
  }
}

double sph_shape_volume(const struct sph_shape *s) {
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return 4 * M_PI / 3 * s->radius * s->radius * s->radius;
  case SPH_SHAPE_CYLINDER: return M_PI * (s->radius - s->inner_radius) * (s->radius + s->inner_radius) * s->length;
  case SPH_SHAPE_MESH: return sph_shape_mesh_volume(s);
  default: return s->side[0] * s->side[1] * s->side[2];
  }
}

void sph_shape_frame(const struct sph_shape *s, double f[3][3]) {
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      f[a][b] = a == b;
  double w[3], u[3], v[3];
  if (s->kind != SPH_SHAPE_CYLINDER || !(vector3_unit(s->axis, w) > 0))
    return;
  /* u: the coordinate axis least along w, turned normal to it; for the axis z this is the identity */
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(w[k]) < fabs(w[least]))
      least = k;
  for (int k = 0; k < 3; k++)
    u[k] = (k == least) - w[least] * w[k];
  vector3_unit(u, u);
  vector3_cross(w, u, v);
  for (int k = 0; k < 3; k++) {
    f[k][0] = u[k];
    f[k][1] = v[k];
    f[k][2] = w[k];
  }
}

/* Boxes, and cylinders in each plane through their axis, are products of intervals. q: distance beyond each interval,
 * negative inside. Returns the signed distance of the product: outside that of the corner or face, inside that of the
 * nearest face. `weight`: the components of the normal. */
static double beyond(const double q[3], int count, double weight[3]) {
  double squares = 0, most = -INFINITY;
  int nearest = 0;
  for (int k = 0; k < count; k++) {
    if (q[k] > most) {
      most = q[k];
      nearest = k;
    }
    squares += q[k] > 0 ? q[k] * q[k] : 0;
  }
  const double distance = most > 0 ? sqrt(squares) : most;
  for (int k = 0; k < count; k++)
    weight[k] = most > 0 ? fmax(q[k], 0) / distance : k == nearest;
  return distance;
}

static double sphere_distance(const struct sph_shape *s, const double p[3], double normal[3]) {
  const double r = vector3_unit(p, normal);
  if (!(r > 0)) { /* at the centre: any direction */
    normal[0] = 0;
    normal[1] = 0;
    normal[2] = 1;
  }
  return r - s->radius;
}

static double box_distance(const struct sph_shape *s, const double p[3], double normal[3]) {
  double q[3], weight[3];
  for (int k = 0; k < 3; k++)
    q[k] = fabs(p[k]) - 0.5 * s->side[k];
  const double distance = beyond(q, 3, weight);
  for (int k = 0; k < 3; k++)
    normal[k] = copysign(weight[k], p[k]);
  return distance;
}

/* A point in a cylinder's coordinates. */
struct cylinder_place {
  double axis[3], outward[3]; /* unit vectors; outward is 0 on the axis */
  double along, r;            /* m: from the centre along the axis, from the axis */
};

static struct cylinder_place place_in_cylinder(const struct sph_shape *s, const double p[3]) {
  struct cylinder_place at = {0};
  double across[3];
  vector3_unit(s->axis, at.axis);
  at.along = vector3_dot(p, at.axis);
  for (int k = 0; k < 3; k++)
    across[k] = p[k] - at.along * at.axis[k];
  at.r = vector3_unit(across, at.outward);
  return at;
}

static double cylinder_distance(const struct sph_shape *s, const double p[3], double normal[3]) {
  struct cylinder_place at = place_in_cylinder(s, p);
  if (!(at.r > 0)) { /* on the axis: any direction across it */
    double frame[3][3];
    sph_shape_frame(s, frame);
    for (int k = 0; k < 3; k++)
      at.outward[k] = frame[k][0];
  }
  const double to_hole = s->inner_radius - at.r, to_barrel = at.r - s->radius;
  const bool hole = s->inner_radius > 0 && to_hole > to_barrel;
  const double q[3] = {hole ? to_hole : to_barrel, fabs(at.along) - 0.5 * s->length};
  double weight[3];
  const double distance = beyond(q, 2, weight);
  for (int k = 0; k < 3; k++)
    normal[k] = weight[0] * (hole ? -at.outward[k] : at.outward[k]) + weight[1] * copysign(1, at.along) * at.axis[k];
  return distance;
}

double sph_shape_distance(const struct sph_shape *s, const double point[3], double normal[3]) {
  double p[3], unused[3];
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_distance(s, point, normal);
  if (!normal)
    normal = unused;
  vector3_subtract(point, s->centre, p);
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return sphere_distance(s, p, normal);
  case SPH_SHAPE_BOX: return box_distance(s, p, normal);
  default: return cylinder_distance(s, p, normal);
  }
}

static int box_walls(const struct sph_shape *s, const double p[3], double depth[SPH_SHAPE_WALLS],
                     double normal[SPH_SHAPE_WALLS][3]) {
  for (int wall = 0; wall < 6; wall++) { /* as enum sph_side of bodies.h: low x, high x, low y, ... */
    const int sign = wall % 2 ? 1 : -1;
    depth[wall] = 0.5 * s->side[wall / 2] - sign * p[wall / 2];
    for (int k = 0; k < 3; k++)
      normal[wall][k] = k == wall / 2 ? sign : 0;
  }
  return 6;
}

/* On the axis `outward` is 0; the barrel is far from there, and a hole has no matter there. */
static int cylinder_walls(const struct sph_shape *s, const double p[3], double depth[SPH_SHAPE_WALLS],
                          double normal[SPH_SHAPE_WALLS][3]) {
  const struct cylinder_place at = place_in_cylinder(s, p);
  for (int k = 0; k < 3; k++) {
    normal[0][k] = -at.axis[k];
    normal[1][k] = at.axis[k];
    normal[2][k] = at.outward[k];
    normal[3][k] = -at.outward[k];
  }
  depth[0] = 0.5 * s->length + at.along;
  depth[1] = 0.5 * s->length - at.along;
  depth[2] = s->radius - at.r;
  depth[3] = at.r - s->inner_radius;
  return s->inner_radius > 0 ? 4 : 3;
}

int sph_shape_walls(const struct sph_shape *s, const double point[3], double depth[SPH_SHAPE_WALLS],
                    double normal[SPH_SHAPE_WALLS][3]) {
  double p[3];
  vector3_subtract(point, s->centre, p);
  switch (s->kind) {
  case SPH_SHAPE_BOX: return box_walls(s, p, depth, normal);
  case SPH_SHAPE_CYLINDER: return cylinder_walls(s, p, depth, normal);
  default: depth[0] = -sph_shape_distance(s, point, normal[0]); return 1;
  }
}

bool sph_shape_inside(const struct sph_shape *s, const double point[3]) {
  double p[3];
  switch (s->kind) {
  case SPH_SHAPE_MESH: return sph_shape_mesh_inside(s, point);
  case SPH_SHAPE_SPHERE: vector3_subtract(point, s->centre, p); return vector3_dot(p, p) < s->radius * s->radius;
  default: return sph_shape_distance(s, point, NULL) < 0;
  }
}

static double cylinder_reach(const struct sph_shape *s, const double direction[3]) {
  double w[3] = {0};
  vector3_unit(s->axis, w);
  const double along = vector3_dot(direction, w);
  return 0.5 * s->length * fabs(along) + s->radius * sqrt(fmax(0, vector3_dot(direction, direction) - along * along));
}

double sph_shape_reach(const struct sph_shape *s, const double d[3]) {
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return s->radius;
  case SPH_SHAPE_MESH: return sph_shape_mesh_reach(s, d);
  case SPH_SHAPE_BOX: return 0.5 * (fabs(d[0]) * s->side[0] + fabs(d[1]) * s->side[1] + fabs(d[2]) * s->side[2]);
  default: return cylinder_reach(s, d);
  }
}

/* How far the ray from the centre along the unit vector d stays in the shape, m, and the outward normal there. */
static double box_ray(const struct sph_shape *s, const double d[3], double normal[3]) {
  double nearest = INFINITY;
  int face = 0;
  for (int k = 0; k < 3; k++) {
    if (d[k] == 0)
      continue;
    const double to_face = 0.5 * s->side[k] / fabs(d[k]);
    if (to_face < nearest) {
      nearest = to_face;
      face = k;
    }
  }
  for (int k = 0; k < 3; k++)
    normal[k] = k == face ? copysign(1, d[k]) : 0;
  return nearest;
}

static double cylinder_ray(const struct sph_shape *s, const double d[3], double normal[3]) {
  const struct cylinder_place at = place_in_cylinder(s, d);
  const double to_side = at.r > 0 ? s->radius / at.r : HUGE_VAL;
  const double to_end = at.along != 0 ? 0.5 * s->length / fabs(at.along) : HUGE_VAL;
  for (int k = 0; k < 3; k++)
    normal[k] = to_side <= to_end ? at.outward[k] : copysign(at.axis[k], at.along * at.axis[k]);
  return fmin(to_side, to_end);
}

bool sph_shape_surface(const struct sph_shape *s, const double direction[3], double point[3], double normal[3]) {
  double d[3] = {0, 0, 1}, ray;
  vector3_unit(direction, d);
  switch (s->kind) {
  case SPH_SHAPE_MESH: return sph_shape_mesh_surface(s, d, point, normal);
  case SPH_SHAPE_BOX: ray = box_ray(s, d, normal); break;
  case SPH_SHAPE_CYLINDER: ray = cylinder_ray(s, d, normal); break;
  default: ray = s->radius; memcpy(normal, d, sizeof d);
  }
  for (int k = 0; k < 3; k++)
    point[k] = s->centre[k] + ray * d[k];
  return true;
}

static void place_in_box(const struct sph_shape *s, const double u[3], double p[3]) {
  for (int k = 0; k < 3; k++)
    p[k] = (u[k] - 0.5) * s->side[k];
}

static void place_in_sphere(const struct sph_shape *s, const double u[3], double p[3]) {
  const double r = s->radius * cbrt(u[0]), z = 2 * u[1] - 1, across = r * sqrt(fmax(0, 1 - z * z));
  p[0] = across * cos(2 * M_PI * u[2]);
  p[1] = across * sin(2 * M_PI * u[2]);
  p[2] = r * z;
}

static void place_in_ring(const struct sph_shape *s, const double u[3], double p[3]) {
  const double inner = s->inner_radius, outer = s->radius;
  const double r = sqrt(inner * inner + u[0] * (outer - inner) * (outer + inner));
  const double local[3] = {r * cos(2 * M_PI * u[1]), r * sin(2 * M_PI * u[1]), (u[2] - 0.5) * s->length};
  double frame[3][3];
  sph_shape_frame(s, frame);
  for (int k = 0; k < 3; k++)
    p[k] = vector3_dot(frame[k], local);
}

bool sph_shape_place(const struct sph_shape *s, const double u[3], double point[3]) {
  double p[3];
  switch (s->kind) {
  case SPH_SHAPE_MESH: return sph_shape_mesh_place(s, u, point);
  case SPH_SHAPE_BOX: place_in_box(s, u, p); break;
  case SPH_SHAPE_SPHERE: place_in_sphere(s, u, p); break;
  default: place_in_ring(s, u, p);
  }
  for (int k = 0; k < 3; k++)
    point[k] = s->centre[k] + p[k];
  return true;
}
