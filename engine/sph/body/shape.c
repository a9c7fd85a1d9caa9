/* Spheres, cylinders, boxes: volume, distance, surface, random points. Meshes are in shape_mesh.c. */
#include "engine/sph/body/shape.h"

#include <math.h>
#include <stddef.h>

#include "engine/sph/body/shape_mesh.h"

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the length of a. Scales first, so that no size overflows. */
static double unit(const double a[3], double out[3]) {
  const double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
  if (!(largest > 0) || !isfinite(largest))
    return 0;
  const double b[3] = {a[0] / largest, a[1] / largest, a[2] / largest}, length = sqrt(dot(b, b));
  for (int k = 0; k < 3; k++)
    out[k] = b[k] / length;
  return length * largest;
}

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
  if (!(unit(s->axis, ignored) > 0))
    return status_fail(error, STATUS_CONTENT, "the axis of a cylinder has no direction.");
  return STATUS_OK;
}

status sph_shape_check(const struct sph_shape *s, struct error *error) {
  static const char *const side[3] = {"side x of a box", "side y of a box", "side z of a box"};
  for (int k = 0; k < 3; k++)
    if (!isfinite(s->centre[k]))
      return status_fail(error, STATUS_CONTENT, "the centre of a body is not finite.");
  status code = STATUS_OK;
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return positive(s->radius, "the radius of a sphere", error);
  case SPH_SHAPE_CYLINDER: return check_cylinder(s, error);
  case SPH_SHAPE_BOX:
    for (int k = 0; k < 3; k++) {
      code = positive(s->side[k], side[k], error);
      if (code)
        return code;
    }
    return STATUS_OK;
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
  if (s->kind != SPH_SHAPE_CYLINDER || !(unit(s->axis, w) > 0))
    return;
  /* u: the coordinate axis least along w, turned normal to it; for the axis z this is the identity */
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(w[k]) < fabs(w[least]))
      least = k;
  for (int k = 0; k < 3; k++)
    u[k] = (k == least) - w[least] * w[k];
  unit(u, u);
  for (int k = 0; k < 3; k++)
    v[k] = w[(k + 1) % 3] * u[(k + 2) % 3] - w[(k + 2) % 3] * u[(k + 1) % 3];
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

double sph_shape_distance(const struct sph_shape *s, const double point[3], double normal[3]) {
  double p[3], unused[3], weight[3] = {0}, q[3];
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_distance(s, point, normal);
  if (!normal)
    normal = unused;
  for (int k = 0; k < 3; k++)
    p[k] = point[k] - s->centre[k];
  if (s->kind == SPH_SHAPE_SPHERE) {
    const double r = unit(p, normal);
    if (!(r > 0)) {
      normal[0] = 0;
      normal[1] = 0;
      normal[2] = 1;
    }
    return r - s->radius;
  }
  if (s->kind == SPH_SHAPE_BOX) {
    for (int k = 0; k < 3; k++)
      q[k] = fabs(p[k]) - 0.5 * s->side[k];
    const double distance = beyond(q, 3, weight);
    for (int k = 0; k < 3; k++)
      normal[k] = copysign(weight[k], p[k]);
    return distance;
  }
  double w[3], across[3], outward[3];
  unit(s->axis, w);
  const double along = dot(p, w);
  for (int k = 0; k < 3; k++)
    across[k] = p[k] - along * w[k];
  const double r = unit(across, outward);
  if (!(r > 0)) {
    double frame[3][3];
    sph_shape_frame(s, frame);
    for (int k = 0; k < 3; k++)
      outward[k] = frame[k][0];
  }
  const bool hole = s->inner_radius > 0 && s->inner_radius - r > r - s->radius;
  q[0] = hole ? s->inner_radius - r : r - s->radius;
  q[1] = fabs(along) - 0.5 * s->length;
  const double distance = beyond(q, 2, weight);
  for (int k = 0; k < 3; k++)
    normal[k] = weight[0] * (hole ? -outward[k] : outward[k]) + weight[1] * copysign(1, along) * w[k];
  return distance;
}

int sph_shape_walls(const struct sph_shape *s, const double point[3], double depth[SPH_SHAPE_WALLS],
                    double normal[SPH_SHAPE_WALLS][3]) {
  double p[3], w[3], across[3],
      outward[3] = {0}; /* stays zero on the axis, which is far from the barrel and not in a hole */
  for (int k = 0; k < 3; k++)
    p[k] = point[k] - s->centre[k];
  if (s->kind == SPH_SHAPE_SPHERE || s->kind == SPH_SHAPE_MESH) {
    depth[0] = -sph_shape_distance(s, point, normal[0]);
    return 1;
  }
  if (s->kind == SPH_SHAPE_BOX) {
    for (int wall = 0; wall < 6; wall++) { /* as enum sph_side of bodies.h: low x, high x, low y, ... */
      const int sign = wall % 2 ? 1 : -1;
      depth[wall] = 0.5 * s->side[wall / 2] - sign * p[wall / 2];
      for (int k = 0; k < 3; k++)
        normal[wall][k] = k == wall / 2 ? sign : 0;
    }
    return 6;
  }
  unit(s->axis, w);
  const double along = dot(p, w);
  for (int k = 0; k < 3; k++)
    across[k] = p[k] - along * w[k];
  const double r = unit(across, outward);
  for (int k = 0; k < 3; k++) {
    normal[0][k] = -w[k];
    normal[1][k] = w[k];
    normal[2][k] = outward[k];
    normal[3][k] = -outward[k];
  }
  depth[0] = 0.5 * s->length + along;
  depth[1] = 0.5 * s->length - along;
  depth[2] = s->radius - r;
  depth[3] = r - s->inner_radius;
  return s->inner_radius > 0 ? 4 : 3;
}

bool sph_shape_inside(const struct sph_shape *s, const double point[3]) {
  const double p[3] = {point[0] - s->centre[0], point[1] - s->centre[1], point[2] - s->centre[2]};
  if (s->kind == SPH_SHAPE_SPHERE)
    return dot(p, p) < s->radius * s->radius;
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_inside(s, point);
  return sph_shape_distance(s, point, NULL) < 0;
}

double sph_shape_reach(const struct sph_shape *s, const double direction[3]) {
  if (s->kind == SPH_SHAPE_SPHERE)
    return s->radius;
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_reach(s, direction);
  if (s->kind == SPH_SHAPE_BOX)
    return 0.5 * (fabs(direction[0]) * s->side[0] + fabs(direction[1]) * s->side[1] + fabs(direction[2]) * s->side[2]);
  double w[3];
  unit(s->axis, w);
  const double along = dot(direction, w);
  return 0.5 * s->length * fabs(along) + s->radius * sqrt(fmax(0, dot(direction, direction) - along * along));
}

bool sph_shape_surface(const struct sph_shape *s, const double direction[3], double point[3], double normal[3]) {
  double d[3] = {0, 0, 1}, t = s->radius;
  unit(direction, d);
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_surface(s, d, point, normal);
  for (int k = 0; k < 3; k++)
    normal[k] = d[k];
  if (s->kind == SPH_SHAPE_BOX) {
    t = INFINITY;
    int face = 0;
    for (int k = 0; k < 3; k++)
      if (d[k] != 0 && 0.5 * s->side[k] / fabs(d[k]) < t) {
        t = 0.5 * s->side[k] / fabs(d[k]);
        face = k;
      }
    for (int k = 0; k < 3; k++)
      normal[k] = k == face ? copysign(1, d[k]) : 0;
  } else if (s->kind == SPH_SHAPE_CYLINDER) {
    double w[3], outward[3] = {0};
    unit(s->axis, w);
    const double along = dot(d, w);
    for (int k = 0; k < 3; k++)
      outward[k] = d[k] - along * w[k];
    const double across = unit(outward, outward);
    const double to_side = across > 0 ? s->radius / across : HUGE_VAL;
    const double to_end = along != 0 ? 0.5 * s->length / fabs(along) : HUGE_VAL;
    t = fmin(to_side, to_end);
    for (int k = 0; k < 3; k++)
      normal[k] = to_side <= to_end ? outward[k] : copysign(w[k], along * w[k]);
  }
  for (int k = 0; k < 3; k++)
    point[k] = s->centre[k] + t * d[k];
  return true;
}

bool sph_shape_place(const struct sph_shape *s, const double u[3], double point[3]) {
  double local[3], frame[3][3];
  if (s->kind == SPH_SHAPE_MESH)
    return sph_shape_mesh_place(s, u, point);
  if (s->kind == SPH_SHAPE_BOX) {
    for (int k = 0; k < 3; k++)
      point[k] = s->centre[k] + (u[k] - 0.5) * s->side[k];
    return true;
  }
  if (s->kind == SPH_SHAPE_SPHERE) {
    const double r = s->radius * cbrt(u[0]), z = 2 * u[1] - 1, across = r * sqrt(fmax(0, 1 - z * z));
    point[0] = s->centre[0] + across * cos(2 * M_PI * u[2]);
    point[1] = s->centre[1] + across * sin(2 * M_PI * u[2]);
    point[2] = s->centre[2] + r * z;
    return true;
  }
  const double inner = s->inner_radius, outer = s->radius;
  const double r = sqrt(inner * inner + u[0] * (outer - inner) * (outer + inner));
  local[0] = r * cos(2 * M_PI * u[1]);
  local[1] = r * sin(2 * M_PI * u[1]);
  local[2] = (u[2] - 0.5) * s->length;
  sph_shape_frame(s, frame);
  for (int k = 0; k < 3; k++)
    point[k] = s->centre[k] + dot(frame[k], local);
  return true;
}
