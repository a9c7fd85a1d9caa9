/* The solids of a scene before the first step: particles on lattices in true shapes, where bodies stand and how they
 * move, what is held or damped. Pure functions of their arguments (and of a seed).
 *
 *   struct sph_body body[2] = {{.shape = ..., .lattice = ..., .density = 2700, .h_over_spacing = NAN}, {...}};
 *   double flight[3];
 *   sph_bodies_aim(&body[0].shape, &body[1].shape, direction, angle, gap, flight)   places the projectile
 *   sph_bodies_make(body, 2, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &particles, range, &error)   checks overlaps, too
 *   sph_bodies_move(particles, range[1], velocity)
 *   sph_flaw_places_make(&law, &body[0].shape, particles, range[0], NULL, &flaws, &error)   (flaw_places.h) */
#ifndef CLAST_ENGINE_SPH_BODY_BODIES_H
#define CLAST_ENGINE_SPH_BODY_BODIES_H

#include "engine/sph/body/lattice.h"
#include "engine/sph/body/particles.h"

/* h over spacing, spacing = (V/n)^(1/3): 56 neighbours within 2h on the resting hexagonal and cubic lattices (48 by
 * volume). On a lattice the sum of (m_j/rho_j) x dW/dx, by which every strain and every force is multiplied, is not 1
 * but depends on h: here 1.006, 1.006, 0.993 along x, y, z of the hexagonal lattice and 0.992 on the cubic one. At 1.21
 * it is 1.024 and 0.981: waves 2 % too fast or too slow, moduli wrong by 4 %, at any resolution. */
#define SPH_BODIES_H 1.13

struct sph_body {
  struct sph_shape shape;
  struct sph_lattice lattice;
  double density;        /* kg/m^3, bulk (with pores) */
  double h_over_spacing; /* NaN: SPH_BODIES_H */
};

struct sph_range { /* a body's particles: ids first .. first + n - 1 */
  size_t first, n;
  double spacing, nearest; /* m, as in sph_points */
  double h;                /* m (graded: of the mean particle) */
  double mass;             /* kg, of the body: density x true volume */
};

/* Particles of all bodies, one after the other, at rest, with x y z, mass, density, h, body filled; `arrays` as for
 * sph_particles_make. STATUS_CONTENT: overlapping bodies (named, with the depth) or what sph_lattice_fill refuses;
 * STATUS_MEMORY. */
status sph_bodies_make(const struct sph_body *bodies, size_t count, int arrays, struct sph_particles **out,
                       struct sph_range *ranges, struct error *error);

/* Puts the projectile in front of the target, its surface `gap` from the point where the ray from the target's centre
 * along `direction` leaves the target, and gives the unit `flight` direction: `angle` (rad) from the inward normal
 * there, turned towards +x (towards +y if the normal is within 0.1 rad of the x axis). STATUS_CONTENT: no direction, a
 * negative gap, an angle not in [0, pi/2). */
status sph_bodies_aim(const struct sph_shape *target, struct sph_shape *projectile, const double direction[3],
                      double angle, double gap, double flight[3], struct error *error);

/* Velocity fields; each adds to what is there. */
void sph_bodies_move(struct sph_particles *particles, struct sph_range range, const double velocity[3]);
/* v = rate (along - ratio across), along and across the `axis` through `centre`; rate in 1/s, ratio: Poisson's. */
void sph_bodies_stretch(struct sph_particles *particles, struct sph_range range, const double centre[3],
                        const double axis[3], double rate, double ratio);
/* v = spin x (r - centre), rad/s. */
void sph_bodies_spin(struct sph_particles *particles, struct sph_range range, const double centre[3],
                     const double spin[3]);

/* The middle of a body: |(r - centre) . axis| <= half. What lies beyond are its two ends. */
struct sph_middle {
  double centre[3]; /* m */
  double axis[3];   /* of any length but 0 */
  double half;      /* m */
};
bool sph_bodies_beyond(const struct sph_middle *middle, const double point[3]);
/* Sets the bits of `held` beyond the middle, returns how many particles that are. */
size_t sph_bodies_hold(struct sph_particles *particles, struct sph_range range, const struct sph_middle *middle,
                       int freedoms);

/* Far sides of a box that let waves out: damping (1/s) grows from 0 at `margin` from a damped side as the square of the
 * depth to `rate` at the side; the largest of the sides counts. */
enum sph_side {
  SPH_SIDE_X0 = 1,
  SPH_SIDE_X1 = 2,
  SPH_SIDE_Y0 = 4,
  SPH_SIDE_Y1 = 8,
  SPH_SIDE_Z0 = 16,
  SPH_SIDE_Z1 = 32
};
void sph_bodies_damp(struct sph_particles *particles, struct sph_range range, const struct sph_shape *box, int sides,
                     double margin, double rate);

#endif
