/* Memory layout of the moving system; for engine/sph/ and its tests only.
 *
 * Particles are columns (structure of arrays). Bodies follow one another, so that a range has one material;
 * within a body particles are sorted in space. All loops over particles go block by block: a block's columns stay in
 * the cache from one hook to the next, and the sums of a block depend neither on the number of threads nor on the width
 * of the CPU's vectors. */
#ifndef CLAST_ENGINE_SPH_STEP_SYSTEM_LAYOUT_H
#define CLAST_ENGINE_SPH_STEP_SYSTEM_LAYOUT_H

#include "engine/sph/modules/modules.h"
#include "engine/sph/step/system.h"

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
  struct sph_body_physics physics; /* flaws is NULL (modules/weibull.c has them) */
  struct sph_module_set modules;
  struct sph_column_set columns; /* those that its modules need */
  void *prepared[SPH_MODULES];   /* by its modules (sph_module.prepare) */
  size_t first, last;            /* its particles */
  double density;                /* kg/m^3 at the start, bulk */
  double lowest_density;
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
  uint64_t steps, listings, density_held;
  uint64_t horizon;  /* number of steps for which lists are made */
  double neighbours; /* within 2h, at the last pass of the pair loop */
  int64_t limiter;
};

struct sph_ranges; /* ranges.h */

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
  const struct sph_ranges *ranges;
  int fault; /* enum sph_fault; `failure` has the message */
  char failure[256];
};

/* system_columns.c: which columns every body has. */
struct sph_column_set sph_system_columns_of_all(bool damped);
/* The arrays of particles (enum sph_particle_arrays) that go with such columns. */
int sph_system_columns_arrays(const struct sph_column_set *columns);
/* Allocates the system's columns and the arrays beside them, at their initial values. STATUS_MEMORY. */
status sph_system_columns_take(struct sph_system *system, const struct sph_particles *particles, struct error *error);
/* Pointers to the columns that exist, in a fixed order. Returns how many. */
size_t sph_system_columns_list(const struct sph_system *system, double *column[SPH_COLUMNS]);
/* Copies the initial values of particles into the columns, and columns back into particles (sph_system_read). */
void sph_system_columns_fill(struct sph_system *system, const struct sph_particles *particles);
void sph_system_columns_read(const struct sph_system *system, struct sph_particles *out);
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

/* ---- system_list.c: when a system sorts its particles and makes lists of neighbours ---- */

/* Makes new lists when the old ones may miss a pair (a block has no slack left). Every few times the particles are
 * sorted first; a count decides, not the clock. False as sph_system_step. */
bool sph_system_list(struct sph_system *system);
/* Lists for the positions at which the last lists were made (sph_pairs_listed); after a restart. */
bool sph_system_list_again(struct sph_system *system);
/* Largest h with slack, m, at which no particle meets its own image in a periodic box; infinite in open space. */
double sph_system_list_reach(const struct sph_domain *domain);

#endif
