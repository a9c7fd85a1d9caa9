/* Distances of two shapes: gaps, depths of overlap, and the nearest approach of a flight. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "engine/sph/body/shape.h"
#include "engine/sph/body/shape_mesh.h"
#include "engine/vector3.h"

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
      vector3_cross(try[i], try[3 + j], try[count]);
  memcpy(try[count++], d, sizeof try[0]);
  for (int i = 0; count < DIRECTIONS; i++, count++) { /* an even cover of half the sphere */
    const double z = (i + 0.5) / 48, across = sqrt(1 - z * z), turn = 2.399963229728653 * i;
    try[count][0] = across * cos(turn);
    try[count][1] = across * sin(turn);
    try[count][2] = z;
  }
}

/* Two hulls, and the direction that separates them best so far. */
struct separation {
  const struct sph_shape *a, *b;
  double between[3]; /* m, of their centres */
  double direction[3], distance;
};

/* Takes the direction of `towards`, which is longer than `least`, if it separates the hulls better. */
static bool improve(struct separation *s, const double towards[3], double least) {
  double v[3];
  if (!(vector3_unit(towards, v) > least))
    return false;
  const double distance = fabs(vector3_dot(v, s->between)) - sph_shape_reach(s->a, v) - sph_shape_reach(s->b, v);
  if (!(distance > s->distance))
    return false;
  s->distance = distance;
  memcpy(s->direction, v, sizeof v);
  return true;
}

/* Tries to turn the direction a little, both ways about each axis. */
static bool turn(struct separation *s, double step) {
  for (int side = 0; side < 6; side++) {
    double w[3];
    memcpy(w, s->direction, sizeof w);
    w[side / 2] += side % 2 ? step : -step;
    if (improve(s, w, 0))
      return true;
  }
  return false;
}

/* The depth of overlap, negative, is the least push along any direction that separates two hulls. Tries some
 * directions, then searches about the best. */
static double depth(const struct sph_shape *a, const struct sph_shape *b) {
  struct separation s = {.a = a, .b = b, .direction = {0, 0, 1}, .distance = -INFINITY};
  double try[DIRECTIONS][3];
  vector3_subtract(b->centre, a->centre, s.between);
  directions(a, b, s.between, try);
  for (int i = 0; i < DIRECTIONS; i++)
    improve(&s, try[i], 1e-9);
  for (double step = 0.3; step > 1e-7;)
    if (!turn(&s, step))
      step *= 0.5;
  return s.distance;
}

/* Between convex bodies, alternate projections onto one and the other end at the nearest pair of points. */
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
      return fmin(depth(a, b), 0);
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
    return fmin(sph_shape_mesh_gap(&a, &b), sph_shape_mesh_gap(&b, &a));
  if (mesh_a)
    return sph_shape_mesh_gap(&a, &b);
  if (mesh_b)
    return sph_shape_mesh_gap(&b, &a);
  return convex_gap(&a, &b);
}

double sph_shape_gap_ahead(const struct sph_shape *a, const struct sph_shape *b, const double velocity[3],
                           double *when) {
  const double golden = 0.6180339887498949;
  double direction[3], d[3], least = sph_shape_gap(a, b), unused;
  if (!when)
    when = &unused;
  *when = 0;
  const double speed = vector3_unit(velocity, direction);
  if (!(speed > 0) || least <= 0)
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
    *when = 0.5 * (low + high) / speed;
  }
  return least;
}
