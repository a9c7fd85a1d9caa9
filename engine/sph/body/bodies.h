/* The solids of a scene before the first step: particles in true shapes, the places of bodies and their motion, and
 * which particles are held or damped. Pure functions of their arguments (and of a seed). In the order of use:
 *
 *   struct sph_body body[2] = {{.shape = ..., .lattice = ..., .density = 2700, .h_over_spacing = NAN}, {...}};
 *   double flight[3];
 *   sph_bodies_aim(&body[0].shape, &body[1].shape, direction, angle, gap, flight)   places the projectile
 *   sph_bodies_make(body, 2, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &particles, range, &error)   also checks for overlaps
 *   sph_bodies_move(particles, range[1], velocity)
 *   sph_flaws_place(&law, &body[0].shape, particles, range[0], NULL, &flaws, &error)   (flaws.h) */
#ifndef CLAST_ENGINE_SPH_BODY_BODIES_H
#define CLAST_ENGINE_SPH_BODY_BODIES_H

#include "engine/sph/body/lattice.h"
#include "engine/sph/body/particles.h"

/* h over spacing, where spacing = (V/n)^(1/3). It gives 56 neighbours within 2h on the hexagonal and cubic lattices at
 * rest (48 by volume). On a lattice the sum of (m_j/rho_j) x dW/dx, a factor of every strain and every force, depends
 * on h and is not exactly 1. With this h it is 1.006, 1.006, 0.993 along x, y, z of the hexagonal lattice and 0.992 on
 * the cubic one. With 1.21 it is 1.024 and 0.981: wave speeds are wrong by 2 % and moduli by 4 %, at any resolution. */
#define SPH_BODIES_H 1.13

struct sph_body {
  struct sph_shape shape;
  struct sph_lattice lattice;
  double density;        /* kg/m^3, bulk */
  double h_over_spacing; /* NaN: SPH_BODIES_H */
};

struct sph_range { /* a body's particles: ids first .. first + n - 1 */
  size_t first, n;
  double spacing, nearest; /* m, as in sph_points */
  double h;                /* m; in a graded body that of the mean particle */
  double mass;             /* kg, of the body: density x true volume */
};

/* Makes the particles of all bodies, one body after the other, at rest. Fills x y z, mass, density, h and body;
 * `arrays` as for sph_particles_make. `ranges` (NULL is fine) has room for `count`. STATUS_CONTENT: bodies overlap (the
 * message has their names and the depth), or as sph_lattice_fill says; STATUS_MEMORY. */
status sph_bodies_make(const struct sph_body *bodies, size_t count, int arrays, struct sph_particles **out,
                       struct sph_range *ranges, struct error *error);

/* Puts the projectile in front of the target. The ray from the target's centre along `direction` leaves the target at
 * the point of impact; the projectile's surface is `gap` (m) away from it. `flight` becomes the unit vector of its
 * motion: `angle` (rad) from the inward normal, turned towards +x (towards +y if the normal is within 0.1 rad of the x
 * axis). STATUS_CONTENT: no direction, a negative gap, or an angle outside of [0, pi/2). */
status sph_bodies_aim(const struct sph_shape *target, struct sph_shape *projectile, const double direction[3],
                      double angle, double gap, double flight[3], struct error *error);

/* Velocity fields. Each is added to the present velocities. */
void sph_bodies_move(struct sph_particles *particles, struct sph_range range, const double velocity[3]);
/* v = rate (along - ratio across): components along and across the `axis` through `centre`; rate in 1/s, `ratio` is
 * Poisson's. */
void sph_bodies_stretch(struct sph_particles *particles, struct sph_range range, const double centre[3],
                        const double axis[3], double rate, double ratio);
/* v = spin x (r - centre), rad/s. */
void sph_bodies_spin(struct sph_particles *particles, struct sph_range range, const double centre[3],
                     const double spin[3]);

/* The middle of a body, |(r - centre) . axis| <= half. The rest of the body is its two ends. */
struct sph_middle {
  double centre[3]; /* m */
  double axis[3];   /* of any length but 0 */
  double half;      /* m */
};
bool sph_bodies_beyond(const struct sph_middle *middle, const double point[3]);
/* Sets the bits `freedoms` of `held` for the particles in the ends, and returns their number. */
size_t sph_bodies_hold(struct sph_particles *particles, struct sph_range range, const struct sph_middle *middle,
                       int freedoms);

/* Damping at the far sides of a box, so that waves leave it. The damping rate (1/s) grows as the square of the depth
 * from 0 at `margin` (m) from a damped side to `rate` at the side; the largest of the sides counts. */
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
