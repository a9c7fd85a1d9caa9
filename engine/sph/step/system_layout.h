/* How the moving system lies in memory; for engine/sph/ and its tests only.
 *
 * Particles are columns (structure of arrays). Bodies stand one after the other, so that a range has one material;
 * within a body particles are sorted in space. All loops over particles go block by block: a block's columns stay in
 * the cache from one hook to the next, and what a block sums up depends neither on the number of threads nor on the
 * CPU's width. */
#ifndef CLAST_ENGINE_SPH_STEP_SYSTEM_LAYOUT_H
#define CLAST_ENGINE_SPH_STEP_SYSTEM_LAYOUT_H

#include "engine/sph/modules/modules.h"
#include "engine/sph/modules/weibull.h"
#include "engine/sph/step/system.h"

enum { SPH_BLOCK = SPH_PIECE, SPH_HOOKS = 24 };

/* Columns, all of n. Not allocated (NULL) where no body needs them: system_create.c has the rows. The deviator is kept
 * by five components, xx xy xz yy yz: its trace is zero by construction. */
struct sph_columns {
  double *x, *y, *z;
  double *vx, *vy, *vz;
  double *mass;
  double *density, *energy;
  double *h, *h_initial;
  double *ax, *ay, *az; /* rates of the last evaluation */
  double *density_rate, *energy_rate;
  double *pressure, *sound_speed; /* undamaged, bulk */
  double *pressure_term;          /* -P/rho^2, damaged: what the pair loop takes */
  double *stress[5], *stress_rate[5];
  double *stress_factor;                     /* (1-D)/rho^2: what the pair loop takes times the stress */
  double *damage, *damage_rate, *damage_cap; /* D^(1/3); the rate holds until the cap; */
  double *weakest;                           /* Young's modulus times the lowest threshold, Pa; infinite once D = 1 */
  double *open_from, *open_below,
      *open_rate;     /* while E eps, Pa, lies between these, D^(1/3) grows at that rate (or is capped) */
  double *crack_rate; /* c_g / R_s, 1/s */
  double *damping;
  /* pores */
  double *distention, *rest_distention; /* alpha, now and at P = 0 (palpha.h) */
  double *shear_factor;                 /* f of the last evaluation */
  double *tension, *compaction;         /* D^(1/3) by flaws and by closed pores, of which `damage` is made */
  double *correction[6];                /* B, of the gradient correction, at the last pair loop */
};

struct sph_solid;
struct sph_block;
typedef void (*sph_hook)(struct sph_system *system, const struct sph_solid *body, struct sph_block *block);

/* A fixed piece of a body that lies within one piece of the pair loop, and what its hooks found there in this step. */
struct sph_block {
  size_t low, high;
  const struct sph_pair_sums *sums; /* of its particles, the first of them at 0; only while `after` hooks run */
  uint32_t body;
  double worst[SPH_LIMITS];    /* largest inverse of a time step, 1/s, per limiter */
  double clamped;              /* J */
  double damped, work_of_held; /* W, now */
  uint64_t density_held;
  double slack; /* m: so much of its slack each particle has left at least; below 0 one may have none left, once looked
                   up has none */
  double swollen; /* volume that lists reach, over that of the supports, beyond what the skin adds; summed */
  size_t lost;    /* place of a particle that is no longer finite, or n */
};

/* A body's constants, made once from its material. */
struct sph_solid {
  struct sph_body_physics physics; /* porosity points at `porosity`, flaws is NULL (see weibull) */
  struct sph_palpha_law porosity;
  struct sph_weibull_lists *weibull;
  size_t first, last; /* its particles */
  double young;       /* Pa, 9 K mu/(3 K + mu) */
  double crack_speed; /* m/s, 0.4 sqrt((K + 4 mu/3)/rho0) */
  double density;     /* kg/m^3 at the start: material density over distention */
  double lowest_density;
  sph_hook before[SPH_HOOKS], after[SPH_HOOKS]; /* what a step calls, in order */
  size_t before_count, after_count;
};

/* All that changes from step to step and is no column. */
struct sph_progress {
  double time, last_step, first_step;
  double worst[SPH_LIMITS];
  double clamped, damped, work_of_held; /* J, booked so far */
  double damping_power, holding_power;  /* W, at the last evaluation */
  uint64_t steps, listings, density_held;
  uint64_t horizon;  /* steps that lists are made for */
  double neighbours; /* within 2h, at the last pass of the pair loop */
  int64_t limiter;
};

struct sph_ranges; /* ranges.h */

struct sph_system {
  struct sph_inputs in; /* viscosity, method, fracture and fidelity of it */
  struct sph_domain domain;
  double highest_h; /* over its first value: SPH_HIGHEST_H, or what a thin periodic box allows */
  struct sph_progress now;
  size_t n, stride; /* particles; doubles from one column to the next */
  struct sph_columns c;
  double *arena; /* holds every column */
  size_t arena_doubles;
  uint32_t *id;  /* id of the particle that stands at a place */
  uint8_t *held; /* enum sph_freedom bits; NULL when none is */
  double dt;     /* s, of the step under way */
  uint32_t *order;
  size_t body_count, block_count;
  struct sph_solid *solid; /* its bodies */
  struct sph_block *block;
  bool strength, fracture, pores; /* some body has it */
  bool damage;                    /* of flaws, or of pores that close */
  struct sph_pairs *pairs;
  const struct sph_ranges *ranges;
  int fault; /* enum sph_fault; in words: */
  char failure[256];
};

/* Pointer slots of the columns that exist, in a fixed order. Returns how many. */
enum { SPH_COLUMNS = sizeof(struct sph_columns) / sizeof(double *) };
size_t sph_system_create_columns(struct sph_system *system, double **slot[SPH_COLUMNS]);

/* What sph_system_create refuses: STATUS_CONTENT, or STATUS_MEMORY before anything is allocated. */
status sph_system_check(const struct sph_particles *particles, size_t body_count, const struct sph_body_physics *bodies,
                        const struct sph_inputs *inputs, const struct sph_domain *domain, struct error *error);

#endif
