/* Fragments: connected components of grains or particles joined by intact links. Pure functions: an engine calls them
 * at the end of a run; analysis may call them again on a snapshot. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct fragment {
  double mass;        /* kg (2D: kg per metre of thickness) */
  double position[3]; /* m, centre of mass */
  double velocity[3]; /* m/s, of the centre of mass */
  double spin[3]; /* rad/s: inverse moment of inertia times angular momentum, about the centre of mass (2D: z only) */
  double moment_of_inertia; /* kg m^2, about the centre of mass (2D: about z; 3D: trace/3 of the tensor) */
  double kinetic_energy;    /* J: translation, rotation and internal motion */
  double length[3];         /* m, longest first: axes of the solid ellipsoid of its moments; 0: not measured */
  uint32_t count;           /* grains or particles in it */
  uint32_t first;           /* its lowest member index */
};

/* Union-find over `links` (pairs of indices below n). label[i] = fragment number, fragments numbered by descending
 * mass, ties by lowest member index. Returns the number of fragments. `label` has n entries, owned by the caller. */
size_t fragments_label(size_t n, const double *mass, size_t link_count, const uint32_t (*links)[2], uint32_t *label);

/* A grain or a particle. */
struct fragment_member {
  double mass;                     /* kg (2D: kg per metre of thickness) */
  double position[3], velocity[3]; /* m, m/s */
  double spin;                     /* rad/s about z (particles: 0) */
  double moment_of_inertia;        /* kg m^2 about its own centre (particles: 0) */
};

/* Finds and measures fragments. *out has *count fragments by descending mass (malloc'd, owned by the caller; NULL when
 * n is 0); `label` (n entries) may be NULL. STATUS_MEMORY.
 *
 * In 2D spin and moment of inertia are about z. In space spin is I^-1 L with the full inertia tensor I about the centre
 * of mass: the angular velocity of a rigidly turning fragment of any shape. About an axis without inertia (one
 * particle, particles in a line) it is 0. moment_of_inertia is trace(I)/3. A member's own moment is that of a sphere,
 * its own spin is about z. */
status fragments_find(bool in_space, size_t n, const struct fragment_member *members, size_t link_count,
                      const uint32_t (*links)[2], uint32_t *label, struct fragment **out, size_t *count,
                      struct error *error);

/* Principal axes of a symmetric tensor xx xy xz yy yz zz: values ascending, axis[k] the unit vector of value[k].
 * Jacobi's rotations: exact to rounding for every finite tensor. */
void fragments_principal(const double tensor[6], double value[3], double axis[3][3]);

/* Steps of union-find. The caller first sets parent[i] = i. The root is the lowest index of the set. */
uint32_t fragments_root(uint32_t *parent, uint32_t i);
/* Joins two sets. True when a and b were in different ones. */
bool fragments_join(uint32_t *parent, uint32_t a, uint32_t b);
