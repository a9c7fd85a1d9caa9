/* The moving solid: one force evaluation a step over sorted particles and reused neighbour lists.
 * Benz & Asphaug 1995 [BA95] sections 2-4; corrections and choices are documented where they are made. */
#ifndef CLAST_ENGINE_SPH_STEP_SYSTEM_H
#define CLAST_ENGINE_SPH_STEP_SYSTEM_H

#include <math.h>
#include <stdbool.h>

#include "engine/sph/body/flaws.h"
#include "engine/sph/body/particles.h"
#include "engine/sph/material/fracture.h"
#include "engine/sph/material/material.h"
#include "engine/sph/pairs/pairs.h"
#include "engine/sph/scene/inputs.h"

/* Material and physics of one body. Off means absent: nothing is stored or called for it. */
struct sph_body_physics {
  struct sph_material material;
  bool strength;                 /* deviatoric stress: Hooke, Jaumann, radial return */
  const struct sph_flaws *flaws; /* NULL: no fracture; by the body's own particle order; copied at create */
};

/* Data of the step beside bodies and inputs: they follow from the positions of the particles, or are bounds. */
struct sph_domain {
  double periodic[3];       /* m, length of the periodic box per direction; NaN = open */
  double spacing_over_h;    /* first particle spacing over h: the artificial stress */
  double largest_time_step; /* s, NaN = off */
  double lowest_density;    /* over the initial one: a lower density is raised to it, and the ledger counts that */
};
/* An open space. 0.03 is the density of a particle alone, m W(0), at the largest h: thinner ones would have P/rho^2
 * without bound. */
#define SPH_DOMAIN_OPEN                                                                                                \
  { .periodic = {NAN, NAN, NAN}, .spacing_over_h = 0.95, .largest_time_step = NAN, .lowest_density = 0.03 }

/* Bounds of h over its first value. */
#define SPH_LOWEST_H  0.5
#define SPH_HIGHEST_H 2.0

enum sph_limiter { /* what set the time step */
#define TIME_STEP_LIMIT(NAME, ...) SPH_LIMIT_##NAME,
#include "engine/sph/modules/declarations.h"
                   SPH_LIMIT_GIVEN,
                   SPH_LIMIT_END,
                   SPH_LIMITS
};

/* J, kg m/s, kg m^2/s. Energy error = kinetic + internal + damped - initial - work_of_held. The energy that the bound
 * u >= 0 adds is `clamped`; it is no part of that sum. */
struct sph_ledger {
  double kinetic, internal, work_of_held, damped, clamped;
  uint64_t density_held; /* particle-steps at the lowest density; it changes pressures, but adds no energy by itself */
  double momentum[3], angular_momentum[3];
  double momentum_scale; /* sum |p| */
};

struct sph_system; /* opaque */

/* All arguments are copied. Of the inputs a system reads viscosity, method, fracture and fidelity, and its modules what
 * they need. Periodic directions run from 0 to their length. STATUS_MEMORY, before anything is allocated when it would
 * not fit; STATUS_CONTENT when an input is out of its range, or when a body lacks a material value that its physics
 * needs (named). */
status sph_system_create(const struct sph_particles *particles, size_t body_count,
                         const struct sph_body_physics *bodies, const struct sph_inputs *inputs,
                         const struct sph_domain *domain, struct sph_system **out, struct error *error);
void sph_system_free(struct sph_system *system); /* NULL is fine */
size_t sph_system_bytes(const struct sph_system *system);

enum sph_fault { /* why a step failed */
                 SPH_FAULT_NONE,
                 SPH_FAULT_NOT_FINITE,
                 SPH_FAULT_TIME_STEP, /* the same on any machine */
                 SPH_FAULT_MEMORY,    /* too little memory; the run may succeed on another machine */
};

/* One time step, not beyond `until` (s). False after a fault; later calls return false, too. */
bool sph_system_step(struct sph_system *system, double until);
int sph_system_fault(const struct sph_system *system); /* enum sph_fault */
const char *
sph_system_failure(const struct sph_system *system); /* what failed, where and when; empty without a fault */
double sph_system_time(const struct sph_system *system);
double sph_system_last_step(const struct sph_system *system); /* s */
int sph_system_limiter(const struct sph_system *system);      /* enum sph_limiter, of the last step */
uint64_t sph_system_steps(const struct sph_system *system);
struct sph_ledger sph_system_ledger(const struct sph_system *system);
/* Mass-weighted mean damage of bodies with flaws, and its present rate (1/s; NULL is fine). A rate above 0 means that
 * fracture goes on. */
double sph_system_damage(const struct sph_system *system, double *rate);
/* Fills the arrays that *out has, in the order of the ids, all at one time. Positions are wrapped into the box in
 * periodic directions. The pressure is that of the last evaluation (the predicted state of the same time). */
void sph_system_read(const struct sph_system *system, struct sph_particles *out);
/* Number of flaws of each particle, by id (0 in bodies without flaws). False, and nothing is filled, when no body has
 * flaws. */
bool sph_system_flaws(const struct sph_system *system, uint32_t *count);
double sph_system_neighbours(const struct sph_system *system); /* mean number of neighbours within 2h */

size_t sph_system_state_size(const struct sph_system *system);
void sph_system_state_save(const struct sph_system *system, void *bytes);
bool sph_system_state_load(struct sph_system *system, const void *bytes,
                           size_t size); /* the next steps give the same bits */

#endif
