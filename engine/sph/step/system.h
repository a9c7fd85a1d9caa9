/* The moving solid: one force evaluation a step over sorted particles and reused neighbour lists.
 * Benz & Asphaug 1995 [BA95] sections 2-4; corrections and choices are documented where they are made. */
#pragma once

#include <math.h>
#include <stdbool.h>

#include "engine/sph/body/flaws.h"
#include "engine/sph/body/particles.h"
#include "engine/sph/material/material.h"
#include "engine/sph/modules/module.h"
#include "engine/sph/pairs/pairs.h"
#include "engine/sph/scene/inputs.h"

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

/* J, kg m/s, kg m^2/s. Energy error = kinetic + internal + contact + damped - initial - work_of_held. `contact` is the
 * energy of bodies that overlap. The energy that the bound u >= 0 adds is `clamped`; it is no part of that sum. */
struct sph_ledger {
  double kinetic, internal, contact, work_of_held, damped, clamped;
  uint64_t density_held; /* particle-steps at the lowest density; it changes pressures, but adds no energy by itself */
  double momentum[3], angular_momentum[3];
  double momentum_scale; /* sum |p| */
};

struct sph_system; /* below */

/* All arguments are copied. Of the inputs a system reads viscosity, method, fracture and fidelity, and its modules what
 * they need. Periodic directions run from 0 to their length. STATUS_MEMORY; STATUS_CONTENT when a body lacks a
 * material value that its physics needs (named). */
status sph_system_create(const struct sph_particles *particles, size_t body_count,
                         const struct sph_body_physics *bodies, const struct sph_inputs *inputs,
                         const struct sph_domain *domain, struct sph_system **out, struct error *error);
void sph_system_free(struct sph_system *system); /* NULL is fine */

enum sph_fault { /* why a step failed */
                 SPH_FAULT_NONE,
                 SPH_FAULT_NOT_FINITE,
                 SPH_FAULT_TIME_STEP, /* the same on any machine */
                 SPH_FAULT_MEMORY,    /* too little memory; the run may succeed on another machine */
};

/* One time step, not beyond `until` (s). False after a fault; later calls return false, too. */
bool sph_system_step(struct sph_system *system, double until);
struct sph_ledger sph_system_ledger(const struct sph_system *system);
/* Mass-weighted mean damage of those of the bodies first .. last - 1 that have flaws; 0 if none has. */
double sph_system_damage(const struct sph_system *system, size_t first, size_t last);
/* Fills the arrays that *out has, in the order of the ids, all at one time. Positions are wrapped into the box in
 * periodic directions. The pressure is that of the last evaluation (the predicted state of the same time). */
void sph_system_read(const struct sph_system *system, struct sph_particles *out);
/* Number of flaws of each particle, by id (0 in bodies without flaws). False, and nothing is filled, when no body has
 * flaws. */
bool sph_system_flaws(const struct sph_system *system, uint32_t *count);

/* Everything that the next step depends on: a restored run continues with the same bits. copy: malloc'd, NULL without
 * memory. load: false when the bytes do not fit this system. */
void *sph_system_state_copy(const struct sph_system *system, size_t *size);
bool sph_system_state_load(struct sph_system *system, const void *bytes, size_t size);

/* Memory layout of the moving system; for engine/sph/ and its tests only.
 *
 * Particles are columns (structure of arrays). Bodies follow one another, so that a range has one material;
 * within a body particles are sorted in space. All loops over particles go block by block: a block's columns stay in
 * the cache from one hook to the next, and the sums of a block depend neither on the number of threads nor on the width
 * of the CPU's vectors. */

enum { SPH_BLOCK = SPH_PIECE, SPH_HOOKS = 4 + SPH_MODULES * SPH_STAGES };

/* Columns, all of n. Every body has those named here (but damping); modules declare the others and say which bodies
 * need them: elsewhere they are NULL. The deviator is kept by five components, xx xy xz yy yz: its trace is zero by
 * construction. */
struct sph_columns {
  double *x, *y, *z;
  double *vx, *vy, *vz;
  double *mass;
  double *density, *energy;
  double *h, *h_initial;
  double *ax, *ay, *az; /* rates of the last evaluation */
  double *density_rate, *energy_rate;
  double *pressure, *sound_speed; /* undamaged, bulk */
  double *pressure_term;          /* -P/rho^2, damaged: the pair loop reads it */
  double *damping;
#define COLUMN(member) double *member;
#include "engine/sph/modules/declarations.h"
};

/* The index of a column among all; the first index and the number of consecutive columns. */
#define SPH_COLUMN(name)     (offsetof(struct sph_columns, name) / sizeof(double *))
#define SPH_COLUMNS_OF(name) SPH_COLUMN(name), sizeof(((struct sph_columns *)NULL)->name) / sizeof(double *)
enum { SPH_COLUMNS = sizeof(struct sph_columns) / sizeof(double *) };
struct sph_column_set {
  uint64_t word[SET_WORDS(SPH_COLUMNS)];
};

struct sph_solid;
struct sph_block;
typedef void (*sph_hook)(struct sph_system *system, const struct sph_solid *body, struct sph_block *block);

/* Values that modules exchange about the particles of a block (0 is its first) while the hooks before the pair loop
 * run. */
struct sph_terms {
  const double *solid_density;   /* kg/m^3; the density of the body unless a module publishes another */
  double yield_limit[SPH_BLOCK]; /* Pa, bound of sqrt(3 J2) of the stored deviator */
  double published[SPH_BLOCK];   /* memory of the module that publishes solid_density */
};

/* A fixed piece of a body within one piece of the pair loop, and the results of its hooks in this step. */
struct sph_block {
  size_t low, high;
  struct sph_terms *terms;          /* only while `before` hooks run */
  const struct sph_pair_sums *sums; /* of its particles, the first of them at 0; only while `after` hooks run */
  uint32_t body;
  double worst[SPH_LIMITS];    /* largest inverse of a time step, 1/s, per limiter */
  double clamped;              /* J */
  double damped, work_of_held; /* W, now */
  uint64_t density_held;
  double slack;   /* m: smallest remaining slack of its particles; below 0 the lists may miss a pair */
  double swollen; /* sum over particles: volume of the list's reach over that of the support, less what the skin adds */
  size_t lost;    /* index of a particle that is no longer finite, or n */
};

/* A body: its modules, and the data that they prepared from its material. */
struct sph_solid {
  struct sph_body_physics physics; /* flaws is NULL (module weibull has them) */
  struct sph_module_set modules;
  struct sph_column_set columns;                /* those that its modules need */
  void *prepared[SPH_MODULES];                  /* by its modules (sph_module.prepare) */
  size_t first, last;                           /* its particles */
  double density;                               /* kg/m^3 at the start, bulk */
  double lowest_density, lowest_energy;         /* kg/m^3, J/kg: what falls below them is raised to them */
  sph_hook before[SPH_HOOKS], after[SPH_HOOKS]; /* loops of a step, in order: before and after the pair loop */
  size_t before_count, after_count;
  size_t first_count;                                                    /* of `before`: those that run before `meet` */
  void (*meet)(struct sph_system *system, const struct sph_solid *body); /* sph_module.meet; NULL: no module has it */
};

static inline bool sph_solid_has(const struct sph_solid *body, size_t column) {
  return set_has(body->columns.word, column);
}

/* Values that change from step to step, beside the columns. */
struct sph_progress {
  double time, last_step, first_step;
  double worst[SPH_LIMITS];
  double clamped, damped, work_of_held; /* J, since the start */
  double damping_power, holding_power;  /* W, at the last evaluation */
  double contact;                       /* J, at the last evaluation: energy of bodies that overlap */
  uint64_t steps, listings, density_held;
  uint64_t horizon;  /* number of steps for which lists are made */
  double neighbours; /* within 2h, at the last pass of the pair loop */
  int64_t limiter;
};

struct sph_ranges; /* ranges.h */

/* What a particle gets from other bodies: one for each row of sph_pairs_foreign. */
struct sph_touch {
  double pressure, energy;         /* Pa, J */
  double acceleration[3], heating; /* m/s^2, J/kg/s */
  double signal;                   /* m/s, as in struct sph_pair_sums */
};

struct sph_system {
  struct sph_inputs in; /* a copy of all; the step itself reads viscosity, method, fracture and fidelity */
  struct sph_domain domain;
  double highest_h; /* over its first value: SPH_HIGHEST_H, or less in a thin periodic box */
  double drift[3];  /* m/s, of the centre of mass at the start: limits of the step take speeds from it */
  struct sph_progress now;
  size_t n, stride; /* particles; doubles from one column to the next */
  struct sph_columns c;
  double *arena; /* holds every column */
  size_t arena_doubles;
  uint32_t *id;  /* by index: id of the particle */
  uint8_t *held; /* enum sph_freedom bits; NULL when none is */
  double dt;     /* s, of the step under way */
  uint32_t *order;
  size_t body_count, block_count;
  struct sph_solid *solid; /* its bodies */
  struct sph_block *block;
  struct sph_column_set columns; /* that some body needs */
  struct sph_pairs *pairs;
  bool (*meet_others)(struct sph_system *system); /* sph_module.touch; NULL: no module has it */
  uint8_t *body;                                  /* by index: body of the particle; NULL without meet_others */
  struct sph_touch *touch;
  size_t touch_capacity;
  const struct sph_ranges *ranges;
  int fault; /* enum sph_fault; `failure` has the message */
  char failure[256];
};

/* Which columns every body has. */
struct sph_column_set sph_system_columns_of_all(bool damped);
/* The arrays of particles (enum sph_particle_arrays) that go with such columns. */
int sph_system_columns_arrays(const struct sph_column_set *columns);
/* Pointers to the columns that exist, in a fixed order. Returns how many. */
size_t sph_system_columns_list(const struct sph_system *system, double *column[SPH_COLUMNS]);
/* Estimated bytes per particle of a system with these columns (of all bodies) and `pairs` bytes for options of the pair
 * loop. Flaws are not in it. */
double sph_system_columns_bytes(const struct sph_column_set *columns, size_t pairs,
                                const struct sph_fidelity *fidelity);

/* x wrapped into the periodic box; unchanged when `length` is NaN. */
double sph_system_columns_wrapped(double x, double length);

/* ---- system_step.c ---- */

/* Sorts the particles, makes lists and evaluates the forces at the initial state. False as sph_system_step. */
bool sph_system_step_begin(struct sph_system *system);

/* The columns that the pair loop reads. */
struct sph_pair_fields sph_system_step_fields(const struct sph_system *system);

/* Lists for the positions at which the last lists were made (sph_pairs_listed); after a restart. */
bool sph_system_step_relist(struct sph_system *system);
/* Largest h with slack, m, at which no particle meets its own image in a periodic box; infinite in open space. */
double sph_system_step_reach(const struct sph_domain *domain);

/* The loops over particles, compiled once per CPU class and chosen at run time.
 *
 * Results are bit-identical only within one class (contraction to FMA differs), so a run records its class. The
 * environment variable CLAST_CPU=baseline|v3|v4 limits the class; a class that this machine lacks is not used. */

struct sph_ranges {
  const sph_hook *module[SPH_MODULES]; /* SPH_STAGES loops of each; NULL: the module has none */
  /* Loops of every body, whatever its modules (motion.h). */
  sph_hook predict;                                       /* x v rho u h */
  sph_hook output_fluid, output_whole, output_damaged;    /* columns that the pair loop reads */
  sph_hook hold;                                          /* held freedoms and damping: the new accelerations */
  sph_hook fluid_rates;                                   /* u */
  sph_hook correct_fluid, correct_whole, correct_damaged; /* v rho h, and the limits of the time step */
};

extern const struct sph_ranges sph_ranges_baseline;
#ifdef __x86_64__
extern const struct sph_ranges sph_ranges_v3, sph_ranges_v4;
#endif
