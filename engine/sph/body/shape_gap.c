/* Distances of two shapes: gaps, depths of overlap, and the nearest approach of a flight. */
#include <math.h>
#include <stddef.h>

#include "engine/sph/body/shape.h"
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

static struct sph_shape hull(const struct sph_shape *s) {
  struct sph_shape h = *s;
  h.inner_radius = 0;
  return h;
}

enum { DIRECTIONS = 64 };

/* Directions that may separate two hulls, of any length: those of faces and edges, of the centres (d), and a cover of
 * the sphere. */
static void directions(const struct sph_shape *a, const struct sph_shape *b, const double d[3],
                       double try[DIRECTIONS][3]) {
  double fa[3][3], fb[3][3];
  sph_shape_frame(a, fa);
  sph_shape_frame(b, fb);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      try[i][k] = fa[k][i];
      try[3 + i][k] = fb[k][i];
    }
  int count = 6;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++, count++)
      for (int k = 0; k < 3; k++)
        try[count][k] = try[i][(k + 1) % 3] * try[3 + j][(k + 2) % 3] - try[i][(k + 2) % 3] * try[3 + j][(k + 1) % 3];
  for (int k = 0; k < 3; k++)
    try[count][k] = d[k];
  count++;
  for (int i = 0; count < DIRECTIONS; i++, count++) { /* an even cover of half the sphere */
    const double z = (i + 0.5) / 48, across = sqrt(1 - z * z), turn = 2.399963229728653 * i;
    try[count][0] = across * cos(turn);
    try[count][1] = across * sin(turn);
    try[count][2] = z;
  }
}

/* The depth of overlap is the least push along any direction that separates two hulls. Tries some directions, then
 * searches about the best. */
static double depth(const struct sph_shape *a, const struct sph_shape *b) {
  double try[DIRECTIONS][3], d[3], best = -INFINITY, u[3] = {0, 0, 1}, v[3];
  for (int k = 0; k < 3; k++)
    d[k] = b->centre[k] - a->centre[k];
  directions(a, b, d, try);
#define PART(v) (fabs(dot(v, d)) - sph_shape_reach(a, v) - sph_shape_reach(b, v))
  for (int i = 0; i < DIRECTIONS; i++)
    if (unit(try[i], v) > 1e-9 && PART(v) > best) {
      best = PART(v);
      for (int k = 0; k < 3; k++)
        u[k] = v[k];
    }
  for (double step = 0.3; step > 1e-7;) {
    bool better = false;
    for (int i = 0; i < 3 && !better; i++)
      for (int sign = -1; sign <= 1 && !better; sign += 2) {
        double w[3] = {u[0], u[1], u[2]};
        w[i] += sign * step;
        if (unit(w, v) > 0 && PART(v) > best) {
          best = PART(v);
          for (int k = 0; k < 3; k++)
            u[k] = v[k];
          better = true;
        }
      }
    if (!better)
      step *= 0.5;
  }
#undef PART
  return best;
}

double sph_shape_gap(const struct sph_shape *ring_a, const struct sph_shape *ring_b) {
  const struct sph_shape a = hull(ring_a), b = hull(ring_b);
  if (b.kind == SPH_SHAPE_SPHERE)
    return sph_shape_distance(&a, b.centre, NULL) - b.radius;
  if (a.kind == SPH_SHAPE_SPHERE)
    return sph_shape_distance(&b, a.centre, NULL) - a.radius;
  if (a.kind == SPH_SHAPE_MESH && b.kind == SPH_SHAPE_MESH)
    return fmin(sph_shape_mesh_gap(&a, &b), sph_shape_mesh_gap(&b, &a));
  if (a.kind == SPH_SHAPE_MESH || b.kind == SPH_SHAPE_MESH)
    return a.kind == SPH_SHAPE_MESH ? sph_shape_mesh_gap(&a, &b) : sph_shape_mesh_gap(&b, &a);
  /* Between convex bodies, alternate projections onto one and the other end at the nearest pair of points. */
  double p[3] = {b.centre[0], b.centre[1], b.centre[2]}, normal[3], gap = INFINITY;
  const double size = sph_shape_reach(&a, (double[3]){1, 0, 0}) + sph_shape_reach(&b, (double[3]){1, 0, 0});
  for (int turn = 0; turn < 2000; turn++) {
    double before = gap;
    for (int side = 0; side < 2; side++) {
      const double distance = sph_shape_distance(side ? &b : &a, p, normal);
      for (int k = 0; k < 3 && distance > 0; k++)
        p[k] -= distance * normal[k];
      gap = distance;
    }
    if (gap <= 1e-9 * size)
      return fmin(depth(&a, &b), 0);
    if (before - gap < 1e-12 * size && turn)
      break;
  }
  return gap;
}

double sph_shape_gap_ahead(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3],
                           double *when) {
  double direction[3], zero = sph_shape_gap(a, b), unused;
  if (!when)
    when = &unused;
  *when = 0;
  const double speed = unit(velocity, direction);
  if (!(speed > 0) || zero <= 0)
    return zero;
  /* Between convex bodies the gap is a convex function of the way: golden section. */
  const double d[3] = {a->centre[0] - b->centre[0], a->centre[1] - b->centre[1], a->centre[2] - b->centre[2]};
  double ways[4] = {0, 0, 0,
                    fmax(0, dot(d, direction)) + sph_shape_reach(a, direction) + sph_shape_reach(b, direction)};
  const double golden = 0.6180339887498949;
  struct sph_shape moved = *b;
  double gaps[4] = {zero, 0, 0, 0};
  for (int turn = 0; turn < 200 && ways[3] - ways[0] > 1e-12 * (ways[3] + sph_shape_reach(b, direction)); turn++) {
    ways[1] = ways[3] - golden * (ways[3] - ways[0]);
    ways[2] = ways[0] + golden * (ways[3] - ways[0]);
    for (int i = 1; i <= 2; i++) {
      for (int k = 0; k < 3; k++)
        moved.centre[k] = b->centre[k] + ways[i] * direction[k];
      gaps[i] = sph_shape_gap(a, &moved);
    }
    if (gaps[1] <= gaps[2])
      ways[3] = ways[2];
    else
      ways[0] = ways[1];
    zero = fmin(zero, fmin(gaps[1], gaps[2]));
    *when = 0.5 * (ways[0] + ways[3]) / speed;
    if (zero <= 0)
      break;
  }
  return zero;
}
