/* The pair loop: all forces and rates between two particles, once a step. Particles are sorted in space (kd_tree.h), so
 * that neighbours are near in memory. Each pair i < j is visited once: particle i has a list of neighbours j with a
 * skin, and the lists are used for many steps.
 *
 * Per pair, with h = (h_i + h_j)/2, the cubic spline W of support 2h, and the damaged stress sigma, pressure included:
 *   dv_i/dt   = sum_j m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2 - Pi_ij + f^n (R_i + R_j)) . grad_i W      [BA95 eq. 17]
 *   dv_a/dx_b = sum_j (m_j/rho_i) (v_j - v_i)_a grad_i W_b          [BA95 eq. 18]; m_j/rho_j with `volume_weights`
 *   heating   = 1/2 sum_j m_j (v_i - v_j) . (Pi_ij - f^n (R_i + R_j)) . grad_i W   (J/kg/s; eq. 4 lacks it)
 * Pi is Monaghan's viscosity, for approaching pairs only (damaged ones included).
 *
 * With the gradient correction dv_a/dx_b is multiplied by B_i, the inverse of M_i = sum_j m_j/sqrt(rho_i rho_j)
 * (x_j - x_i) grad_i W, so that it is exact for linear fields; its weights are the same (gradient_correction.h says
 * why). In the forces sigma_i/rho_i^2 becomes sigma_i B_i/(rho_i sqrt(rho_i rho_j)), which makes them conjugate to the
 * corrected gradient: energy and angular momentum are conserved, and a free side is as stiff as the inside [Bonet & Lok
 * 1999, Comput. Methods Appl. Mech. Eng. 180, 97]. M_i is a sum of the same pass, so the forces use the B_i of the pass
 * before.
 *
 * With `volume_weights` dv_a/dx_b has m_j/rho_j, and for the same reason sigma_i/rho_i^2 + sigma_j/rho_j^2 becomes
 * (sigma_i + sigma_j)/(rho_i rho_j). */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/scene/inputs.h"
#include "schemas/status.h"

/* Sections of the inputs, those of all modules too, and what follows from the bodies. */
struct sph_pair_options {
  struct sph_method method;
  struct sph_fidelity fidelity; /* precision, and threads, on which the bits do not depend */
  bool strength;                /* stress[] is given; else the pressure alone */
  bool turns;                   /* the target spins: gradients keep rotations whole (gradient_correction.h) */
  double spacing_over_h;        /* initial particle spacing over h: the f = W(r)/W(spacing) of the artificial stress */
  double periodic[3];           /* m, length of the periodic box along each axis; NaN = open */
  /* By place: the body of a particle; the caller's, and constant. NULL: all pairs are in the loop, whatever their
   * bodies. Else it leaves out pairs of different bodies, which sph_pairs_foreign has. */
  const uint8_t *body;
#define MODULE_INPUTS(name) struct sph_##name##_inputs name;
#include "engine/sph/modules/declarations.h"
};

/* Columns of n particles in sorted order; read only. */
struct sph_pair_fields {
  const double *x, *y, *z, *h, *vx, *vy, *vz, *mass, *density, *sound_speed;
  const double *pressure_term; /* -P/rho^2 with the damaged bulk pressure */
  const double *stress[5];     /* S, undamaged deviator, Pa: xx xy xz yy yz, its trace is zero; NULL without strength */
  const double *stress_factor; /* (1-D)/rho^2: sigma/rho^2 = stress_factor S + pressure_term I */
  /* Columns that terms read, also the sums of the pass before; only where the term is on. */
#define PAIR_FIELDS(member, count) const double *member[count];
#include "engine/sph/modules/declarations.h"
};

/* The sums of a pass, for some consecutive particles. */
struct sph_pair_sums {
  double *ax, *ay, *az; /* m/s^2 */
  double *gradient[9];  /* 1/s: xx xy xz yx ... with ab = dv_a/dx_b; corrected where that is on */
  double *heating;      /* J/kg/s: viscous, and the work of the artificial stress, which has either sign */
  /* Only with gradient_correction, else NULL. The work of the forces, J/kg/s: rho_i (sigma/rho^2 : g), where g is the
   * sum times the forces' B. With it total energy is conserved however much B changes between two passes. */
  double *power;
  /* Sums of terms, each for the column of its name; NULL where the term is off. */
#define PAIR_SUMS(term, member, count, scale) double *member[count];
#define PAIR_FOUND(term, member, count)       double *member[count];
#include "engine/sph/modules/declarations.h"
  /* m/s: largest |mu_ij| = h |v.r|/(r^2 + 0.01 h^2) of approaching pairs, for the time step. -1 without neighbours:
   * such a particle does not limit the step. */
  double *signal;
};

enum { SPH_PIECE = 512 }; /* number of particles whose sums are delivered together */

struct sph_pairs; /* opaque: lists and records */

/* For at most n particles. Later only sph_pairs_list allocates memory, when lists must grow. STATUS_MEMORY;
 * STATUS_CONTENT for more particles than the lists of float records can name (lists.h), and when the pair loop is
 * not compiled for terms that are on together (SPH_PAIR_COMBINATIONS). */
status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error);
void sph_pairs_free(struct sph_pairs *pairs); /* NULL is fine */

/* The smallest remaining slack (m) of the particles low .. high - 1. Slack shrinks as a particle moves and as its h
 * grows. Negative: the lists may miss pairs; it is also negative when a position is not finite or there are no lists
 * yet. */
double sph_pairs_slack(const struct sph_pairs *pairs, size_t low, size_t high, const double *x, const double *y,
                       const double *z, const double *h);
/* Makes new lists for particles in sorted order: all pairs with r < h_i + h_j + slack_i + slack_j. `slack` (m) is how
 * far a particle may move before the lists become stale; fast particles have more. Memory is bounded by n, whatever the
 * extent. STATUS_MEMORY; STATUS_CONTENT when a periodic box is thinner than twice the reach of a pair. */
status sph_pairs_list(struct sph_pairs *pairs, size_t n, const double *x, const double *y, const double *z,
                      const double *h, const double *slack, struct error *error);
/* x y z h slack, n each, with which the last lists were made. A restart puts them back; sph_pairs_relist then makes the
 * same lists again. */
double *const *sph_pairs_listed(struct sph_pairs *pairs);
status sph_pairs_relist(struct sph_pairs *pairs, struct error *error);
/* The pairs of different bodies that the loop leaves out, as rows: one for each particle that has such neighbours, by
 * ascending places. Each pair is in both rows. As in the lists, pairs may be farther apart than their support. */
struct sph_foreign {
  size_t count;
  struct {
    size_t first;      /* its neighbours are other[first] ... other[first of the next row - 1] */
    uint32_t particle; /* its place */
  } * row;
  uint32_t *other; /* rows of neighbours */
  size_t row_capacity, other_capacity;
};
/* Without `body` there are none. They are those of the last lists. */
const struct sph_foreign *sph_pairs_foreign(const struct sph_pairs *pairs);
/* Adds to sum[i] the volumes m_j/rho_j of the neighbours of particle i in the loop, each times `weight` of the square
 * of its distance and the mean h; itself too. */
void sph_pairs_volumes(const struct sph_pairs *pairs, const struct sph_pair_fields *fields,
                       double (*weight)(double square, double h), double *sum);
/* The nearest image of a distance `along` on an axis of this periodic length (NaN: open). */
double sph_pairs_image(double along, double length);
/* Receives the sums of `count` particles, at most SPH_PIECE, from `first` on, a multiple of SPH_PIECE. They may be
 * changed and are gone afterwards. */
typedef void sph_pairs_take(void *context, size_t first, size_t count, const struct sph_pair_sums *sums);
/* A pass over all pairs. Sums are delivered to `take` piece by piece, as soon as they are complete, while they are in
 * the cache. The pass no longer reads the fields of those particles, so they may be changed. Several threads call
 * `take` at the same time. */
void sph_pairs_sum(struct sph_pairs *pairs, size_t n, const struct sph_pair_fields *fields, sph_pairs_take *take,
                   void *context);
/* Do terms read the sums of the pass before? Then the first pass of a run must be made twice. */
bool sph_pairs_look_back(const struct sph_pairs *pairs);
/* Mean number of neighbours in the lists (each pair counts for both): the time of a pass is proportional to it. */
double sph_pairs_reached(const struct sph_pairs *pairs);
/* Mean number of neighbours within 2h in the last pass (each pair counts for both). */
double sph_pairs_neighbours(const struct sph_pairs *pairs);

/* The kernels of the pair loop, compiled once per CPU class and chosen at run time (engine/sph/modules/ranges.h: bits
 * of results), in double and in float.
 *
 * All data that a pair needs of a particle are in one record, a row of numbers, so that a neighbour costs two cache
 * lines. A kernel loads the records of as many neighbours as a vector register has lanes and transposes them in
 * registers. The sums of the neighbours are transposed back and added to their records of sums. */

/* The terms of the pair loop (pairs_term.h), in the order of the modules; a shape says which are on. */
enum sph_pair_term {
#define PAIR_TERM(name, on) PAIR_TERM_##name,
#include "engine/sph/modules/declarations.h"
  PAIR_TERMS
};
struct sph_pair_shape {
#define PAIR_TERM(name, on) bool name;
#include "engine/sph/modules/declarations.h"
};
/* The shapes of SPH_PAIR_COMBINATIONS (modules/declarations.h). */
enum sph_pair_combination {
#define COMBINATION(name, ...) PAIR_SHAPE_##name,
  SPH_PAIR_COMBINATIONS(COMBINATION) PAIR_SHAPES
#undef COMBINATION
};

/* Columns of a record: those of every record, then those of its terms. Float records hold x, y, z as 32-bit integers in
 * a small unit of length: differences are exact and wrap round harmlessly, so precision does not depend on a particle's
 * place in a scene of kilometres. */
enum sph_pair_column {
  PAIR_X,
  PAIR_Y,
  PAIR_Z,
  PAIR_H, /* h/2 */
  PAIR_VX,
  PAIR_VY,
  PAIR_VZ,
  PAIR_MASS,
  PAIR_XX,
  PAIR_XY,
  PAIR_XZ,
  PAIR_YY,
  PAIR_YZ,
  PAIR_ZZ, /* T: sigma/rho^2 with the pressure term, unless a term changes it */
  PAIR_SOUND,
  PAIR_DENSITY,
  PAIR_BASE,
};
/* The columns of a term begin at a multiple of four: a small term is then loaded at once. */
#define PAIR_ALIGNED(column) (((column) + 3) / 4 * 4)
/* Columns of a record of sums. In float a sum is multiplied by the masses of both partners (volumes with volume
 * weights), so that both get the same number; unpack divides by the particle's own. */
enum sph_pair_sum {
  SUM_ACCELERATION,
  SUM_GRADIENT = 3,
  SUM_HEATING = 12, /* times -2 */
  SUM_SIGNAL,       /* the largest, not the sum; above zero if there are neighbours */
  SUM_BASE,         /* the sums of terms follow, weighted as the gradient is */
};

/* Sizes: how many columns a term has, and of the longest record, that of all terms. An enumerator is one more than the
 * one before it, which here is the last column before the term. */
enum {
#define PAIR_RECORD(term, count)              PAIR_RECORD_##term = count,
#define PAIR_SUMS(term, member, count, scale) PAIR_SUMS_##term = count,
#include "engine/sph/modules/declarations.h"
  PAIR_BASE_END = PAIR_BASE - 1,
#define PAIR_RECORD(term, count) PAIR_BEFORE_##term, PAIR_END_##term = PAIR_ALIGNED(PAIR_BEFORE_##term) + (count)-1,
#include "engine/sph/modules/declarations.h"
  PAIR_ALL,
  SUM_BASE_END = SUM_BASE - 1,
#define PAIR_SUMS(term, member, count, scale) SUM_BEFORE_##term, SUM_END_##term = SUM_BEFORE_##term + (count)-1,
#include "engine/sph/modules/declarations.h"
  SUM_ALL,
  FOUND_END = -1,
#define PAIR_FOUND(term, member, count) FOUND_##member, FOUND_END_##member = FOUND_##member + (count)-1,
#include "engine/sph/modules/declarations.h"
  FOUND_ALL,
  MADE_END = -1,
#define PAIR_MADE(term, count) MADE_##term, MADE_END_##term = MADE_##term + (count)-1,
#include "engine/sph/modules/declarations.h"
  MADE_ALL,
  PAIR_MOST = (PAIR_ALL + 15) / 16 * 16, /* whole registers */
  SUM_MOST = (SUM_ALL + 15) / 16 * 16,
  SUM_SPREAD = 16, /* sums that are added to records in whole registers; those behind them in fours */
};

/* The number of columns of a record, in front of the part of term `end` (PAIR_TERMS: of all). A constant where the
 * shape is one. */
static inline size_t sph_pair_shape_columns(const struct sph_pair_shape shape, const int end) {
  size_t columns = PAIR_BASE;
#define PAIR_RECORD(term, count)                                                                                       \
  if (shape.term && PAIR_TERM_##term < end)                                                                            \
    columns = PAIR_ALIGNED(columns) + (count);
#include "engine/sph/modules/declarations.h"
  return columns;
}
/* The first column of a term. */
static inline size_t sph_pair_shape_first(const struct sph_pair_shape shape, const int term) {
  return PAIR_ALIGNED(sph_pair_shape_columns(shape, term));
}
/* The same of a record of sums. */
static inline size_t sph_pair_shape_sums(const struct sph_pair_shape shape, const int end) {
  size_t columns = SUM_BASE;
#define PAIR_SUMS(term, member, count, scale)                                                                          \
  if (shape.term && PAIR_TERM_##term < end)                                                                            \
    columns += (count);
#include "engine/sph/modules/declarations.h"
  return columns;
}
/* The length of a record in whole cache lines of 64 bytes, for numbers of `bytes` bytes. */
static inline size_t sph_pair_shape_stride(size_t columns, size_t bytes) {
  const size_t line = 64 / bytes;
  return (columns + line - 1) / line * line;
}
/* Particles with consecutive numbers that share one list of neighbours. A neighbour is loaded, and its sums are stored,
 * once for all of them. */
enum { PAIR_GROUP_DOUBLE = 1, PAIR_GROUP_FLOAT = 2 };

/* One chunk (lists.h) as the kernels see it. A slot is the place of a record: the chunk's own particles, then its
 * halo. */
struct sph_pair_chunk {
  size_t own, slots;         /* own particles; own and halo */
  const uint32_t *start;     /* by group: where its list begins, a multiple of 16 */
  const uint32_t *count;     /* by group: number of neighbours */
  const uint32_t *neighbour; /* slots; members of a group but the first are in the group's list */
};

/* Units in which the numbers of float records are of order 1; powers of two. In double all units are 1. per_...: their
 * inverses. */
struct sph_pair_units {
  double length, mass, velocity, density, specific; /* specific: of stress over density squared */
  double per_length, per_mass, per_velocity, per_density, per_specific;
  double distance; /* m, of h and of the distance of two particles */
};

/* Columns from which records are packed: arrays of all particles. */
struct sph_pair_source {
  const double *column[PAIR_BASE];        /* by enum sph_pair_column; NULL: zero. XX to YZ: the deviator */
  double scale[PAIR_BASE];                /* from SI to the records' units; powers of two */
  const double *stress_factor, *pressure; /* factor of the deviator; added to XX, YY, ZZ, in their units */
  double per_unit[3];                     /* 1/m, inverse unit of float records' positions */
  bool volume_weights;                    /* the stress is sigma, not sigma/rho^2 */
  bool geometric_weights;                 /* the stress is sigma/rho */
  struct sph_pair_shape shape;            /* for its terms, also: */
  struct sph_pair_units unit;
  struct sph_pair_fields fields;
  const double *made[MADE_ALL]; /* by MADE_...: what terms made before the pass */
};

/* Columns to which sums are unpacked. */
struct sph_pair_sink {
  double *column[SUM_MOST]; /* by enum sph_pair_sum */
  double scale[SUM_MOST];   /* from the records' units to SI */
  size_t columns;
  const double *mass, *density;
  double mass_unit, density_unit;
  bool volume_weights;    /* if not, the gradient and the sums of terms are divided by the density */
  bool geometric_weights; /* but not with these */
};

struct sph_pair_constants {
  double periodic[3], per_period[3]; /* m, length of a periodic axis and its inverse; NaN: open (double records only) */
  double unit[3];                    /* unit of float records' positions over their unit of h; used if wrapped */
  double norm;                       /* of W'/r */
  bool strength, volume_weights, wrapped;
#define PAIR_CONSTANT(name, value) double name;
#include "engine/sph/modules/declarations.h"
};

/* A box of neighbours.c: all its particles lie within `half` of `middle`, and none has a larger reach than `reach`. */
struct sph_near_box {
  double middle[3], half[3], reach;
};
/* Eight boxes side by side. A box that does not exist has NaN for its middle and is near no other box. */
struct sph_near_boxes {
  double middle[3][8], half[3][8], reach[8];
};
struct sph_near_particles {
  const double *place[3], *reach; /* by particle */
  const uint32_t *first;          /* by leaf box: its first particle, and the number of them */
  const uint8_t *size;
};

/* Kernels that read or write records, in one precision. */
struct sph_record_kernels {
  size_t bytes; /* of a number */
  /* By shape. They return how many pairs are within the support. */
  double (*sum[PAIR_SHAPES])(const struct sph_pair_chunk *, const struct sph_pair_constants *, const void *in,
                             void *out);
  /* Makes the records of `count` particles, `stride` columns each: those from `first` on or, when `which` is not NULL,
   * those that it names. */
  void (*pack)(const struct sph_pair_source *, size_t first, const uint32_t *which, size_t count, size_t stride,
               void *in);
  /* Brings the sums of `count` particles, whose records begin at `records`, back to columns from place `first` on. The
   * signal of a particle without neighbours is -1. */
  void (*unpack)(const struct sph_pair_sink *, size_t first, size_t count, size_t stride, const void *records);
};

struct sph_pair_kernels {
  const char *name;
  const struct sph_record_kernels *in_double, *in_float;
  /* Finds those children of `count` parent boxes (eight each) that may hold particles within reach of `own` and whose
   * number is not below `lowest`. Writes their numbers to `found` (room for 8 count), returns how many. */
  size_t (*near_boxes)(const struct sph_near_boxes *boxes, const uint32_t *parent, size_t count,
                       const struct sph_near_box *own, const double period[3], uint32_t lowest, uint32_t *found);
  /* The same for the particles of `count` leaves: x, y, z, reach to `at`, their numbers to `number` (room for 17
   * count). */
  size_t (*near_particles)(const struct sph_near_particles *particles, const uint32_t *leaf, size_t count,
                           const struct sph_near_box *own, const double period[3], double *at[4], uint32_t *number);
  /* Finds those of `count` candidates (x, y, z, reach in `at`) that are within the sum of reaches of one of `owns`
   * particles `own`. Writes their numbers to `found`, returns how many. If `tag` is not 0, it is the bit that marks a
   * candidate near the first of `own`; the next bit marks one near the second, and so on. Adds the number of pairs to
   * *pairs. `at` and `number` are read, and `found` is written, up to 7 places beyond the end. */
  size_t (*near_pairs)(size_t count, double *const at[4], const uint32_t *number, const double (*own)[4], size_t owns,
                       const double period[3], uint32_t tag, uint32_t *found, size_t *pairs);
  /* Functions of terms (pairs_term.h), for `options` and all fields. */
#define PAIR_MADE(term, count)                                                                                         \
  void (*make_##term)(const struct sph_pair_options *options, const struct sph_pair_fields *fields, size_t first,      \
                      size_t last, double *const *made);
#define PAIR_FINISH(term)                                                                                              \
  void (*finish_##term)(const struct sph_pair_options *options, const struct sph_pair_fields *fields, size_t first,    \
                        size_t count, const struct sph_pair_sums *sums);
#include "engine/sph/modules/declarations.h"
};

extern const struct sph_pair_kernels sph_pairs_kernels_baseline;
#ifdef __x86_64__
extern const struct sph_pair_kernels sph_pairs_kernels_v3, sph_pairs_kernels_v4;
#endif

const struct sph_pair_kernels *sph_pairs_kernels_choose(void);

/* The cubic spline W(r, h) of support 2h in three dimensions. Monaghan & Lattanzio 1985. */

#define SPH_SPLINE_NORM 0.31830988618379067154 /* 1/pi */

/* W, 1/m^3. */
static inline double sph_spline(double r, double h) {
  const double q = r / h, t = 2 - q, norm = SPH_SPLINE_NORM / (h * h * h);
  if (q < 1)
    return norm * (1 - 1.5 * q * q + 0.75 * q * q * q);
  return q < 2 ? norm * 0.25 * t * t * t : 0;
}

/* (dW/dr)/r, 1/m^5; finite at r = 0. */
static inline double sph_spline_slope(double r, double h) {
  const double q = r / h, t = 2 - q, norm = SPH_SPLINE_NORM / (h * h * h * h * h);
  if (q < 1)
    return norm * (2.25 * q - 3);
  return q < 2 ? -norm * 0.75 * t * t / q : 0;
}
