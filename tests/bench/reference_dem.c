/* The frozen plain C version of the grains: the reference speed of bench_dem. */
#include "tests/bench/reference_dem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32 };

struct body {
  double x, y, angle, vx, vy, spin, fx, fy, torque, mass, inertia, radius;
  int count, present;
  struct dem_point corner[MOST], world[MOST];
};

struct bond {
  uint32_t i, j;
  double l0, phi0, phi, alpha, cross, diagonal, kappa;
  int beam;
};

struct reference_dem {
  struct dem_inputs in;
  size_t bodies, bonds;
  struct body *body;
  struct bond *bond;
  double energy;
};

struct reference_dem *reference_dem_create(const struct dem_tessellation *t, const struct dem_inputs *in) {
  struct reference_dem *r = calloc(1, sizeof *r);
  r->in = *in;
  r->bodies = t->cell_count;
  r->body = calloc(r->bodies, sizeof *r->body);
  r->bond = calloc(t->pair_count + 12 * r->bodies, sizeof *r->bond);
  for (size_t i = 0; i < r->bodies; ++i) {
    struct body *b = &r->body[i];
    b->x = t->centroid[i].x;
    b->y = t->centroid[i].y;
    b->mass = in->grain.density * t->area[i];
    b->inertia = in->grain.density * t->polar_moment[i];
    b->present = 1;
    b->count = (int)(t->first_vertex[i + 1] - t->first_vertex[i]);
    for (int v = 0; v < b->count; ++v) {
      const struct dem_point w = t->vertex[t->first_vertex[i] + (uint32_t)v];
      b->corner[v] = (struct dem_point){(w.x - b->x) * (1.0 - 1e-11), (w.y - b->y) * (1.0 - 1e-11)};
      b->radius = fmax(b->radius, hypot(b->corner[v].x, b->corner[v].y));
    }
  }
  size_t next = 0; /* tessellation pairs are sorted: first, then second */
  for (uint32_t i = 0; i < r->bodies; ++i)
    for (uint32_t j = i + 1; j < r->bodies; ++j) {
      const int bonded = next < t->pair_count && t->pair[next][0] == i && t->pair[next][1] == j;
      const double dx = r->body[j].x - r->body[i].x, dy = r->body[j].y - r->body[i].y, l = hypot(dx, dy);
      if (!bonded && l > 1.02 * (r->body[i].radius + r->body[j].radius))
        continue;
      struct bond *b = &r->bond[r->bonds++];
      const double di = sqrt(4.0 * t->area[i] / M_PI), dj = sqrt(4.0 * t->area[j] / M_PI);
      const double usual = 0.27 * (di + dj), s = bonded ? t->side[next] : usual;
      *b = (struct bond){.i = i, .j = j, .l0 = l, .phi0 = atan2(dy, dx), .beam = bonded};
      b->phi = b->phi0;
      b->kappa = in->grain.young_modulus * 0.5 * (1.0 / di + 1.0 / dj) / fmax(s, 0.5 * usual);
      if (bonded) {
        const double a = l / (in->beam.young_modulus * s), c = 12.0 * l * l * l / (in->beam.young_modulus * s * s * s);
        const double beta = 1.0 / (2.0 * a + c / 12.0), delta = beta * (2.0 * a / c + 1.0 / 3.0);
        b->alpha = 1.0 / a;
        b->cross = 0.5 * beta * l * l;
        b->diagonal = delta * l * l;
        ++next;
      }
    }
  return r;
}

void reference_dem_state(struct reference_dem *r, const struct dem_system *s) {
  for (uint32_t i = 0; i < r->bodies; ++i) {
    const struct dem_grain g = dem_system_grain(s, i);
    struct body *b = &r->body[i];
    b->x = g.x, b->y = g.y, b->angle = g.angle, b->vx = g.vx, b->vy = g.vy, b->spin = g.spin, b->present = g.present;
  }
}

static void beam(struct reference_dem *r, struct bond *b) {
  struct body *i = &r->body[b->i], *j = &r->body[b->j];
  const double dx = j->x - i->x, dy = j->y - i->y, l = sqrt(dx * dx + dy * dy), ux = dx / l, uy = dy / l;
  b->phi += remainder(atan2(dy, dx) - b->phi, 2.0 * M_PI);
  const double t1 = i->angle - (b->phi - b->phi0), t2 = j->angle - (b->phi - b->phi0), stretch = l - b->l0;
  const double m1 = b->diagonal * (t2 - t1) - b->cross * t2, m2 = b->diagonal * (t1 - t2) - b->cross * t1;
  const double tension = b->alpha * stretch, shear = (m1 + m2) / l;
  const double fx = tension * ux - shear * uy, fy = tension * uy + shear * ux;
  i->fx += fx, i->fy += fy, i->torque += m1;
  j->fx -= fx, j->fy -= fy, j->torque += m2;
  r->energy += 0.5 * b->alpha * stretch * stretch + 0.5 * b->diagonal * (t1 - t2) * (t1 - t2) + b->cross * t1 * t2;
}

/* True if all corners of b lie outside one side of a. */
static int separates(const struct body *a, const struct body *b) {
  for (int k = 0; k < a->count; ++k) {
    const struct dem_point p = a->world[k], q = a->world[(k + 1) % a->count];
    int inside = 0;
    for (int v = 0; v < b->count && !inside; ++v)
      inside = (q.x - p.x) * (b->world[v].y - p.y) - (q.y - p.y) * (b->world[v].x - p.x) > 0.0;
    if (!inside)
      return 1;
  }
  return 0;
}

static void contact(struct reference_dem *r, const struct bond *b) {
  struct body *i = &r->body[b->i], *j = &r->body[b->j];
  const double dx = j->x - i->x, dy = j->y - i->y, reach = i->radius + j->radius;
  if (dx * dx + dy * dy > reach * reach || separates(i, j) || separates(j, i))
    return;
  /* Clip i by j's sides (Sutherland & Hodgman); edge[] says which side of j an edge of the result lies on, or -1. */
  struct dem_point poly[2 * MOST], out[2 * MOST];
  int edge[2 * MOST], out_edge[2 * MOST], n = i->count;
  for (int v = 0; v < n; ++v)
    poly[v] = i->world[v], edge[v] = -1;
  for (int k = 0; k < j->count && n; ++k) {
    const struct dem_point p = j->world[k], q = j->world[(k + 1) % j->count];
    int m = 0;
    for (int v = 0; v < n; ++v) {
      const struct dem_point a = poly[v], c = poly[(v + 1) % n];
      const double da = (q.x - p.x) * (a.y - p.y) - (q.y - p.y) * (a.x - p.x);
      const double dc = (q.x - p.x) * (c.y - p.y) - (q.y - p.y) * (c.x - p.x);
      if (da >= 0.0)
        out[m] = a, out_edge[m++] = edge[v];
      if ((da >= 0.0) != (dc >= 0.0)) {
        const double t = da / (da - dc);
        out[m] = (struct dem_point){a.x + t * (c.x - a.x), a.y + t * (c.y - a.y)};
        out_edge[m++] = da >= 0.0 ? k : edge[v];
      }
    }
    n = m;
    memcpy(poly, out, (size_t)n * sizeof *out);
    memcpy(edge, out_edge, (size_t)n * sizeof *edge);
  }
  double twice = 0.0, cx = 0.0, cy = 0.0, moment = 0.0;
  for (int v = 0; v < n; ++v) {
    const double ax = poly[v].x - i->x, ay = poly[v].y - i->y, bx = poly[(v + 1) % n].x - i->x,
                 by = poly[(v + 1) % n].y - i->y;
    twice += ax * by - ay * bx;
    if (edge[v] < 0)
      cx += bx - ax, cy += by - ay, moment += 0.5 * (bx * bx + by * by - ax * ax - ay * ay);
  }
  const double f = b->kappa * 0.5 * twice, fx = -f * cy, fy = f * cx;
  i->fx += fx, i->fy += fy, i->torque += f * moment;
  j->fx -= fx, j->fy -= fy, j->torque -= f * moment - (dx * fy - dy * fx);
  r->energy += 0.125 * b->kappa * twice * twice;
}

static void forces(struct reference_dem *r) {
  r->energy = 0.0;
  for (size_t k = 0; k < r->bodies; ++k) {
    struct body *b = &r->body[k];
    const double c = cos(b->angle), s = sin(b->angle);
    b->fx = b->fy = b->torque = 0.0;
    for (int v = 0; v < b->count; ++v)
      b->world[v] = (struct dem_point){b->x + c * b->corner[v].x - s * b->corner[v].y,
                                       b->y + s * b->corner[v].x + c * b->corner[v].y};
  }
  for (size_t k = 0; k < r->bonds; ++k) {
    struct bond *b = &r->bond[k];
    if (!r->body[b->i].present || !r->body[b->j].present)
      continue;
    if (b->beam)
      beam(r, b);
    contact(r, b);
  }
}

static void kick(struct reference_dem *r) {
  const double h = 0.5 * r->in.fidelity.time_step;
  for (size_t k = 0; k < r->bodies; ++k) {
    struct body *b = &r->body[k];
    b->vx += h * b->fx / b->mass, b->vy += h * b->fy / b->mass, b->spin += h * b->torque / b->inertia;
  }
}

void reference_dem_step(struct reference_dem *r) {
  kick(r);
  for (size_t k = 0; k < r->bodies; ++k) {
    struct body *b = &r->body[k];
    b->x += r->in.fidelity.time_step * b->vx, b->y += r->in.fidelity.time_step * b->vy,
        b->angle += r->in.fidelity.time_step * b->spin;
  }
  forces(r);
  kick(r);
}

double reference_dem_energy(struct reference_dem *r) {
  forces(r);
  double kinetic = 0.0;
  for (size_t k = 0; k < r->bodies; ++k) {
    const struct body *b = &r->body[k];
    kinetic += 0.5 * b->mass * (b->vx * b->vx + b->vy * b->vy) + 0.5 * b->inertia * b->spin * b->spin;
  }
  return r->energy + kinetic;
}

void reference_dem_free(struct reference_dem *r) {
  free(r->body);
  free(r->bond);
  free(r);
}
