/* Spheres, cylinders, boxes: volume, distance, surface, random points. Meshes in metres, with their centre of mass at
 * the centre of the shape; and distances of two shapes: gaps, depths of overlap, and the nearest approach of a flight.
 */
#include "engine/sph/body/bodies.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "engine/mesh/mesh.h"
#include "engine/vector3.h"

/* ---- meshes ---- */

static double mesh_shape_volume(const struct sph_shape *s) {
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

static bool mesh_shape_top(const struct sph_shape *s, double point[3], double normal[3]) {
  double p[3] = {0, 0, 0};
  const bool found = s->mesh && mesh_top(s->mesh, p, normal);
  from_file(s, p, point);
  return found;
}

static bool mesh_shape_place(const struct sph_shape *s, const double u[3], double point[3]) {
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

static double mesh_shape_gap(const struct sph_shape *s, const struct sph_shape *other) {
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
  if (gap > 0 && sph_shape_top(other, point, normal))
    gap = fmin(gap, fmax(-sph_shape_reach(other, up), sph_shape_distance(s, point, NULL)));
  return gap;
}

double sph_shape_volume(const struct sph_shape *s) {
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return 4 * M_PI / 3 * s->radius * s->radius * s->radius;
  case SPH_SHAPE_CYLINDER: return M_PI * (s->radius - s->inner_radius) * (s->radius + s->inner_radius) * s->length;
  case SPH_SHAPE_MESH: return mesh_shape_volume(s);
  default: return s->side[0] * s->side[1] * s->side[2];
  }
}

double sph_shape_thinnest(const struct sph_shape *s) {
  const double across = s->inner_radius > 0 ? s->radius - s->inner_radius : 2 * s->radius;
  double side[3] = {s->side[0], s->side[1], s->side[2]};
  for (int k = 0; k < 3 && s->kind == SPH_SHAPE_MESH; k++)
    side[k] = s->mesh ? s->unit * (s->mesh->high[k] - s->mesh->low[k]) : (double)NAN;
  switch (s->kind) {
  case SPH_SHAPE_SPHERE: return across;
  case SPH_SHAPE_CYLINDER: return fmin(across, s->length);
  default: return fmin(side[0], fmin(side[1], side[2]));
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
  if (s->kind == SPH_SHAPE_MESH) {
    to_file(s, point, p);
    return s->mesh ? s->unit * mesh_distance(s->mesh, p, normal) : (double)NAN;
  }
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
  case SPH_SHAPE_MESH: to_file(s, point, p); return s->mesh && mesh_inside(s->mesh, p);
  case SPH_SHAPE_SPHERE: vector3_subtract(point, s->centre, p); return vector3_dot(p, p) < s->radius * s->radius;
  case SPH_SHAPE_BOX:
    vector3_subtract(point, s->centre, p);
    return fabs(p[0]) < 0.5 * s->side[0] && fabs(p[1]) < 0.5 * s->side[1] && fabs(p[2]) < 0.5 * s->side[2];
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
  case SPH_SHAPE_MESH: return s->mesh ? s->unit * mesh_reach(s->mesh, d) : (double)NAN;
  case SPH_SHAPE_BOX: return 0.5 * (fabs(d[0]) * s->side[0] + fabs(d[1]) * s->side[1] + fabs(d[2]) * s->side[2]);
  default: return cylinder_reach(s, d);
  }
}

/* How far the line from the centre upwards stays in the cylinder, m, and the outward normal there. */
static double cylinder_top(const struct sph_shape *s, double normal[3]) {
  const struct cylinder_place at = place_in_cylinder(s, (const double[]){0, 0, 1});
  const double to_side = at.r > 0 ? s->radius / at.r : HUGE_VAL;
  const double to_end = at.along != 0 ? 0.5 * s->length / fabs(at.along) : HUGE_VAL;
  for (int k = 0; k < 3; k++)
    normal[k] = to_side <= to_end ? at.outward[k] : copysign(at.axis[k], at.along * at.axis[k]);
  return fmin(to_side, to_end);
}

bool sph_shape_top(const struct sph_shape *s, double point[3], double normal[3]) {
  if (s->kind == SPH_SHAPE_MESH)
    return mesh_shape_top(s, point, normal);
  memcpy(point, s->centre, sizeof s->centre);
  memcpy(normal, (const double[]){0, 0, 1}, sizeof(double[3]));
  switch (s->kind) {
  case SPH_SHAPE_BOX: point[2] += 0.5 * s->side[2]; break;
  case SPH_SHAPE_CYLINDER: point[2] += cylinder_top(s, normal); break;
  default: point[2] += s->radius;
  }
  return true;
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
  case SPH_SHAPE_MESH: return mesh_shape_place(s, u, point);
  case SPH_SHAPE_BOX:
    for (int k = 0; k < 3; k++)
      p[k] = (u[k] - 0.5) * s->side[k];
    break;
  case SPH_SHAPE_SPHERE: place_in_sphere(s, u, p); break;
  default: place_in_ring(s, u, p);
  }
  for (int k = 0; k < 3; k++)
    point[k] = s->centre[k] + p[k];
  return true;
}

/* ---- distances of two shapes ---- */

static struct sph_shape hull(const struct sph_shape *s) {
  struct sph_shape h = *s;
  h.inner_radius = 0;
  return h;
}

/* Between convex bodies, alternate projections onto one and the other end at the nearest pair of points, or at a point
 * of both, whose depth in one of them is a least overlap. */
static double convex_gap(const struct sph_shape *a, const struct sph_shape *b) {
  double p[3], normal[3], gap = INFINITY;
  memcpy(p, b->centre, sizeof p);
  const double x[3] = {1, 0, 0}, size = sph_shape_reach(a, x) + sph_shape_reach(b, x);
  for (int round = 0; round < 2000; round++) {
    const double before = gap;
    for (int side = 0; side < 2; side++) {
      gap = sph_shape_distance(side ? b : a, p, normal);
      for (int k = 0; k < 3 && gap > 0; k++)
        p[k] -= gap * normal[k];
    }
    if (gap <= 1e-9 * size)
      return fmin(gap, -DBL_MIN);
    if (before - gap < 1e-12 * size && round)
      break;
  }
  return gap;
}

double sph_shape_gap(const struct sph_shape *ring_a, const struct sph_shape *ring_b) {
  const struct sph_shape a = hull(ring_a), b = hull(ring_b);
  if (b.kind == SPH_SHAPE_SPHERE)
    return sph_shape_distance(&a, b.centre, NULL) - b.radius;
  if (a.kind == SPH_SHAPE_SPHERE)
    return sph_shape_distance(&b, a.centre, NULL) - a.radius;

  const bool mesh_a = a.kind == SPH_SHAPE_MESH, mesh_b = b.kind == SPH_SHAPE_MESH;
  if (mesh_a && mesh_b)
    return fmin(mesh_shape_gap(&a, &b), mesh_shape_gap(&b, &a));
  if (mesh_a)
    return mesh_shape_gap(&a, &b);
  if (mesh_b)
    return mesh_shape_gap(&b, &a);
  return convex_gap(&a, &b);
}

double sph_shape_gap_ahead(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3]) {
  double direction[3], d[3], least = sph_shape_gap(a, b);
  if (!(vector3_unit(velocity, direction) > 0) || least <= 0)
    return least;

  /* Between convex bodies the gap is a convex function of the way: golden section. */
  vector3_subtract(a->centre, b->centre, d);
  const double reach = sph_shape_reach(b, direction);
  double low = 0, high = fmax(0, vector3_dot(d, direction)) + sph_shape_reach(a, direction) + reach;
  for (int turn = 0; turn < 200 && high - low > 1e-12 * (high + reach) && !(least <= 0); turn++) {
    const double ways[2] = {high - golden * (high - low), low + golden * (high - low)};
    double gaps[2];
    for (int i = 0; i < 2; i++) {
      struct sph_shape moved = *b;
      for (int k = 0; k < 3; k++)
        moved.centre[k] = b->centre[k] + ways[i] * direction[k];
      gaps[i] = sph_shape_gap(a, &moved);
    }
    if (gaps[0] <= gaps[1])
      high = ways[1];
    else
      low = ways[0];
    least = fmin(least, fmin(gaps[0], gaps[1]));
  }
  return least;
}
