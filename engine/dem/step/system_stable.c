/* The longest time step: a limit of h omega over omega_max of the network at rest, by power iteration on M^-1 K without
 * ever building K. Contacts of bonded pairs count as springs across the common side's middle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/step/system.h"
#include "engine/dem/step/system_layout.h"

static void add(double *f, uint32_t grain, double x, double y, double torque) {
  f[3 * grain] += x;
  f[3 * grain + 1] += y;
  f[3 * grain + 2] += torque;
}

/* Adds K u of one beam (and its contact) to f: linearised forces at rest, u = (x, y, angle) of every grain. */
static void add_bond(const struct dem_system *s, size_t slot, const double *u, double *f) {
  const struct dem_bond_block *b = &s->bond[slot / DEM_BLOCK];
  const size_t lane = slot % DEM_BLOCK;
  const uint32_t i = b->first[lane], j = b->second[lane];
  const double ex = b->reference_x[lane], ey = b->reference_y[lane], l = b->length[lane];
  const double dx = u[3 * j] - u[3 * i], dy = u[3 * j + 1] - u[3 * i + 1];
  const double stretch = dx * ex + dy * ey, phi = (dy * ex - dx * ey) / l;
  const double t1 = u[3 * i + 2] - phi, t2 = u[3 * j + 2] - phi;
  const double m1 = b->diagonal[lane] * (t1 - t2) + b->cross[lane] * t2;
  const double m2 = b->diagonal[lane] * (t2 - t1) + b->cross[lane] * t1;
  const double tension = b->axial[lane] * stretch, shear = -(m1 + m2) / l;
  const double fx = tension * ex - shear * ey, fy = tension * ey + shear * ex;
  add(f, i, -fx, -fy, m1);
  add(f, j, fx, fy, m2);
  if (!(b->stiffness[lane] > 0.0))
    return;
  const double hx = b->half_x[0][lane], hy = b->half_y[0][lane], side = 2.0 * sqrt(hx * hx + hy * hy);
  const double k = dem_laws_spring(s->in->contact.law, b->stiffness[lane], side);
  const double nx = 2.0 * hy / side, ny = -2.0 * hx / side; /* from i to j */
  const double r1x = b->middle_x[0][lane], r1y = b->middle_y[0][lane], r2x = b->middle_x[1][lane],
               r2y = b->middle_y[1][lane];
  const double gap = (dx - u[3 * j + 2] * r2y + u[3 * i + 2] * r1y) * nx +
                     (dy + u[3 * j + 2] * r2x - u[3 * i + 2] * r1x) * ny;
  const double push = k * gap;
  add(f, i, -push * nx, -push * ny, -push * (r1x * ny - r1y * nx));
  add(f, j, push * nx, push * ny, push * (r2x * ny - r2y * nx));
}

/* Largest h omega. Velocity Verlet is stable below 2. Gear's corrector of this order has no such edge: a mode without
 * damping grows as a high power of h omega. At 0.54 it gains 1 % of its energy in a period, at 0.3 it gains 0.02 %
 * (tests/verification/test_dem_motion.c). */
static const double largest_angle[] = {[DEM_VERLET] = 2.0, [DEM_GEAR] = 0.54};

/* Any start vector that contains all modes. The two grains beyond the last one stay at rest. */
static void start(const struct dem_system *s, double *u) {
  const size_t n = s->count;
  for (size_t k = 0; k < 3 * n; k++)
    u[k] = ((double)(k * 2654435761u >> 7 & 1023u) / 511.5 - 1.0) * (k % 3 == 2 ? 1.0 / s->mean_diameter : 1.0);
  memset(u + 3 * n, 0, 6 * sizeof *u);
}

/* f = K u */
static void apply_stiffness(const struct dem_system *s, const double *u, double *f) {
  memset(f, 0, 3 * (s->count + 2) * sizeof *f);
  for (size_t slot = 0; slot < s->now.bond_blocks * DEM_BLOCK; slot++)
    if (s->lane_pair[slot] != DEM_NO_PAIR)
      add_bond(s, slot, u, f);
}

/* Returns the Rayleigh quotient u.K u / u.M u from f = K u. Then f = M^-1 K u and *largest its largest component. */
static double quotient(const struct dem_system *s, const double *u, double *f, double *largest) {
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  double top = 0.0, bottom = 0.0, most = 0.0;
  for (size_t i = 0; i < s->count; i++)
    for (size_t k = 0; k < 3; k++) {
      const double per_mass = mobility[k][i], v = u[3 * i + k];
      if (!(per_mass > 0.0))
        continue;
      top += v * f[3 * i + k];
      bottom += v * v / per_mass;
      f[3 * i + k] *= per_mass;
      most = fmax(most, fabs(f[3 * i + k]));
    }
  *largest = most;
  return bottom > 0.0 ? top / bottom : 0.0;
}

/* u = f, scaled; held degrees of freedom stay at rest. */
static void take_next(const struct dem_system *s, const double *f, double largest, double *u) {
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  for (size_t i = 0; i < s->count; i++)
    for (size_t k = 0; k < 3; k++)
      u[3 * i + k] = mobility[k][i] > 0.0 ? f[3 * i + k] / largest : 0.0;
}

double dem_system_stable_time_step(const struct dem_system *s) {
  const size_t size = 3 * (s->count + 2);
  double *u = malloc(2 * size * sizeof *u);
  if (!u)
    return NAN;
  double *f = u + size, squared = 0.0;
  start(s, u);
  for (int iteration = 0; iteration < 1000; iteration++) {
    double largest;
    const double before = squared;
    apply_stiffness(s, u, f);
    squared = quotient(s, u, f, &largest);
    const bool settled = iteration > 20 && fabs(squared - before) < 1e-7 * squared;
    if (!(largest > 0.0) || settled)
      break;
    take_next(s, f, largest, u);
  }
  free(u);
  return squared > 0.0 ? largest_angle[s->in->fidelity.integrator] / sqrt(squared) : (double)INFINITY;
}
