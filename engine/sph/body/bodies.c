/* Placing, moving, stretching, holding and damping the bodies of a scene. */
#include "engine/sph/body/bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/vector3.h"
#include "schemas/memory.h"

/* Bodies may touch; rounding is allowed for. */
static status check_overlap(const struct sph_shape *a, const struct sph_shape *b, struct error *error) {
  const double gap = sph_shape_gap(a, b), size = cbrt(fmin(sph_shape_volume(a), sph_shape_volume(b)));
  return gap < -1e-9 * size
             ? status_fail(error, STATUS_CONTENT, "the target and the projectile overlap by %.4g m", -gap)
             : STATUS_OK;
}

/* The particles of body b, at its points and from the index `first` on. */
static struct sph_range fill(const struct sph_body *body, size_t b, const struct sph_points *from, size_t first,
                             struct sph_particles *p) {
  const double wide = isnan(body->h_over_spacing) ? SPH_BODIES_H : body->h_over_spacing;
  struct sph_range range = {.first = first, .n = from->n, .spacing = from->spacing, .nearest = from->nearest};
  range.h = wide * from->spacing;
  range.mass = body->density * sph_shape_volume(&body->shape);
  for (size_t i = 0; i < from->n; i++) {
    const double share = from->share ? from->share[i] : 1;
    p->x[first + i] = from->x[i];
    p->y[first + i] = from->y[i];
    p->z[first + i] = from->z[i];
    p->mass[first + i] = range.mass / (double)from->n * share;
    p->density[first + i] = body->density;
    p->h[first + i] = range.h * (from->share ? cbrt(share) : 1);
    p->body[first + i] = (uint8_t)b;
  }
  return range;
}

status sph_bodies_make(const struct sph_body *bodies, size_t count, int arrays, struct sph_particles **out,
                       struct sph_range *ranges, struct error *error) {
  *out = NULL;
  for (size_t b = 1; b < count; b++)
    TRY(check_overlap(&bodies[b - 1].shape, &bodies[b].shape, error));
  OWNED struct sph_points *points = memory_small(count, sizeof *points);
  status code = STATUS_OK;
  size_t n = 0, first = 0;
  for (size_t b = 0; b < count && !code; b++) {
    code = sph_lattice_fill(&bodies[b].lattice, &bodies[b].shape, &points[b], error);
    n += points[b].n;
  }
  if (!code)
    code = sph_particles_make(n, arrays, out, error);
  for (size_t b = 0; b < count; b++) {
    if (!code) {
      const struct sph_range range = fill(&bodies[b], b, &points[b], first, *out);
      if (ranges)
        ranges[b] = range;
      first += range.n;
    }
    sph_lattice_empty(&points[b]);
  }
  return code;
}

bool sph_bodies_face(const struct sph_shape *target, double point[3], double frame[3][3]) {
  double *aside = frame[0], *normal = frame[2];
  if (!sph_shape_top(target, point, normal))
    return false;
  const int towards = fabs(normal[0]) > cos(0.1) ? 1 : 0;
  for (int k = 0; k < 3; k++)
    aside[k] = (k == towards) - normal[towards] * normal[k];
  const double length = sqrt(vector3_dot(aside, aside));
  for (int k = 0; k < 3; k++)
    aside[k] /= length;
  vector3_cross(normal, aside, frame[1]);
  return true;
}

status sph_bodies_aim(const struct sph_shape *target, struct sph_shape *projectile, double angle, double flight[3],
                      struct error *error) {
  double point[3], frame[3][3];
  if (!sph_bodies_face(target, point, frame))
    return status_fail(error, STATUS_CONTENT,
                       "no point of impact: the line from the target's centre of mass upwards (z) does not meet the "
                       "target. Turn the mesh in its file.");
  const double *aside = frame[0], *normal = frame[2];
  const double away = sph_shape_reach(projectile, (const double[3]){-normal[0], -normal[1], -normal[2]});
  for (int k = 0; k < 3; k++) {
    projectile->centre[k] = point[k] + away * normal[k];
    flight[k] = -cos(angle) * normal[k] + sin(angle) * aside[k];
  }
  return STATUS_OK;
}

void sph_bodies_move(struct sph_particles *p, struct sph_range range, const double velocity[3]) {
  for (size_t i = range.first; i < range.first + range.n; i++) {
    p->vx[i] += velocity[0];
    p->vy[i] += velocity[1];
    p->vz[i] += velocity[2];
  }
}

void sph_bodies_stretch(struct sph_particles *p, struct sph_range range, double rate, double ratio) {
  for (size_t i = range.first; i < range.first + range.n; i++) {
    p->vx[i] -= rate * (ratio * p->x[i]);
    p->vy[i] -= rate * (ratio * p->y[i]);
    p->vz[i] += rate * p->z[i];
  }
}

void sph_bodies_spin(struct sph_particles *p, struct sph_range range, const double spin[3]) {
  for (size_t i = range.first; i < range.first + range.n; i++) {
    double v[3];
    vector3_cross(spin, (double[3]){p->x[i], p->y[i], p->z[i]}, v);
    p->vx[i] += v[0];
    p->vy[i] += v[1];
    p->vz[i] += v[2];
  }
}

void sph_bodies_hold(struct sph_particles *p, struct sph_range range, double half, int freedoms) {
  for (size_t i = range.first; i < range.first + range.n; i++)
    if (fabs(p->z[i]) > half)
      p->held[i] |= (uint8_t)freedoms;
}

void sph_bodies_damp(struct sph_particles *p, struct sph_range range, const struct sph_shape *box, double margin,
                     double rate) {
  for (size_t i = range.first; i < range.first + range.n; i++) {
    const double r[3] = {p->x[i] - box->centre[0], p->y[i] - box->centre[1], p->z[i] - box->centre[2]};
    double deepest = 0;
    for (int side = 0; side < 5; side++) { /* two of x, two of y, the lower of z */
      const double from = 0.5 * box->side[side / 2] + (side % 2 ? -1 : 1) * r[side / 2];
      deepest = fmax(deepest, fmin(1, 1 - from / margin));
    }
    p->damping[i] = fmax(p->damping[i], rate * deepest * deepest);
  }
}
