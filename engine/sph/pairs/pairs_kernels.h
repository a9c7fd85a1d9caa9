/* The pair loop over one chunk of particles, compiled once per CPU class and chosen at run time
 * (engine/sph/modules/ranges.h says what that means for bits), in double and in float.
 *
 * What a pair needs of a particle is one record, so that a neighbour costs two cache lines and no gather: records of as
 * many neighbours as there are lanes are loaded whole and transposed in registers, and what the neighbours get is
 * transposed back and added to records of sums. */
#ifndef CLAST_ENGINE_SPH_PAIRS_PAIRS_KERNELS_H
#define CLAST_ENGINE_SPH_PAIRS_PAIRS_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Columns of a record. Float records hold x, y, z as 32-bit integers in units of a quantum: differences are exact and
 * wrap round harmlessly, so that precision does not depend on where in a scene of kilometres a particle is. */
enum sph_pair_column {
  PAIR_X,
  PAIR_Y,
  PAIR_Z,
  PAIR_H /* half of it */,
  PAIR_VX,
  PAIR_VY,
  PAIR_VZ,
  PAIR_MASS,
  PAIR_XX,
  PAIR_XY,
  PAIR_XZ,
  PAIR_YY,
  PAIR_YZ,
  PAIR_ZZ, /* T: sigma/rho^2, the pressure term in it; times B where corrected */
  PAIR_SOUND,
  PAIR_DENSITY,
  PAIR_ARTIFICIAL,      /* six more where there is artificial stress: R */
  PAIR_TURNED = 16,     /* and YX ZX ZY of T where the gradient is corrected: it is no longer symmetric; */
  PAIR_TURNED_TOO = 24, /* where both are, here */
};
/* Columns of a record of sums. In float they are those of both masses times what a pair does (volumes with volume
 * weights), which is the same number for both; what is not symmetric is divided out of the sums. */
enum sph_pair_sum {
  SUM_ACCELERATION,
  SUM_GRADIENT = 3,
  SUM_HEATING = 12 /* twice, negative */,
  SUM_SIGNAL /* above zero for those with neighbours */,
  SUM_MOMENT, /* six, negative, where the gradient is corrected */
  SUM_COLUMNS = SUM_MOMENT + 6,
};
/* Columns from a record to the next: without more, with artificial stress or correction (or moments), with both. */
enum { PAIR_NARROW = 16, PAIR_MIDDLE_DOUBLE = 24, PAIR_MIDDLE_FLOAT = 32, PAIR_WIDE = 32 };

/* So many particles that follow each other share one list: what any of them may meet. A neighbour is then loaded and
 * its sums are stored once for all of them. */
enum { PAIR_GROUP_DOUBLE = 1, PAIR_GROUP_FLOAT = 2 };

struct sph_pair_chunk {
  size_t own, slots;         /* particles whose lists these are; those and the foreign ones behind them */
  const uint32_t *start;     /* by group: multiples of 16 */
  const uint32_t *count;     /* by group: how many of them are neighbours */
  const uint32_t *neighbour; /* slots; among them members of the group but the first */
};

/* What records are made of: arrays of all particles. */
struct sph_pair_source {
  const double *column[PAIR_WIDE];        /* by column; NULL: zero. XX to YZ: of the deviator, which gives ZZ */
  double scale[PAIR_WIDE];                /* to the records' units; powers of two */
  const double *stress_factor, *pressure; /* times the deviator; added to XX, YY, ZZ, scaled as they are */
  const double *correction[6];            /* B by which the stress is multiplied; NULL without */
  double per_quantum[3];                  /* of float records' positions */
  bool volume_weights;                    /* stresses are wanted as sigma, not as sigma/rho^2 */
};

/* Where sums go: arrays of all particles. */
struct sph_pair_sink {
  double *column[SUM_COLUMNS]; /* by enum sph_pair_sum; NULL from the moments on without them */
  double scale[SUM_COLUMNS];   /* from the records' units */
  const double *mass, *density;
  double mass_unit, density_unit;
  bool volume_weights; /* else gradient and moments are divided by the density */
};

/* Arrays of the particles that are corrected. */
struct sph_pair_correction {
  const double *old[6];                                              /* B that the forces were made with */
  const double *density, *pressure_term, *stress_factor, *stress[5]; /* the last two: NULL without strength */
  double *gradient[9];                                               /* what was summed; after: times the new B */
  double *correction[6];                                             /* moments; after: the new B */
  double *power;                                                     /* after: the work of the forces, J/kg/s */
};

struct sph_pair_constants {
  double alpha, twice_beta;
  double periodic[3], per_period[3]; /* length and its inverse; NaN = open (double records only) */
  double quantum[3];        /* of float records' positions, over the length that is 1 in their h; used where wrapped */
  double norm;              /* of the spline's slope over r, which makes a length of W' */
  double spline_at_spacing; /* W(spacing)/norm, for the artificial stress */
  bool strength, volume_weights, wrapped;
};

/* Boxes of neighbours.h: all particles of one lie within `half` of `middle`, and none reaches further than `reach`. */
struct sph_near_box {
  double middle[3], half[3], reach;
};
struct sph_near_boxes { /* eight, side by side; what is not there has a middle of NaN and is near nothing */
  double middle[3][8], half[3][8], reach[8];
};
struct sph_near_particles {
  const double *place[3], *reach; /* by particle */
  const uint32_t *first;          /* by group: its first particle, and how many */
  const uint8_t *size;
};

/* Kernels that read or write records, in one precision. */
struct sph_record_kernels {
  size_t bytes; /* of a number */
  /* [gradient corrected][artificial stress]. They return how many pairs are within the support. */
  double (*sum[2][2])(const struct sph_pair_chunk *, const struct sph_pair_constants *, const void *in, void *out);
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
  /* Of the children of `count` parent boxes (8 each) those that may hold particles within reach of `own`, and that are
   * not below `lowest`: how many, and their numbers in `found` (8 times count). */
  size_t (*near_boxes)(const struct sph_near_boxes *boxes, const uint32_t *parent, size_t count,
                       const struct sph_near_box *own, const double period[3], uint32_t lowest, uint32_t *found);
  /* Likewise of the particles of `count` groups: x y z reach to `at`, numbers to `number` (17 times count each). */
  size_t (*near_particles)(const struct sph_near_particles *particles, const uint32_t *group, size_t count,
                           const struct sph_near_box *own, const double period[3], double *at[4], uint32_t *number);
  /* Of `count` candidates at x y z reach the numbers of those within the sum of reaches of one of `owns` others; `at`
   * and `number` may be read, and `found` written, up to 7 beyond the end. `tag`, when not 0, is a bit that is set in
   * the numbers of those within reach of the first of the others; the next one, of the second, and so on. To *pairs is
   * added how many that are, counted for each of those others. */
  size_t (*near_pairs)(size_t count, double *const at[4], const uint32_t *number, const double (*own)[4], size_t owns,
                       const double period[3], uint32_t tag, uint32_t *found, size_t *pairs);
  /* What moments make of the sums of `count` particles: pairs_kernels_correct.h. */
  void (*correct)(const struct sph_pair_correction *, size_t count);
  /* The artificial stress R of the particles first..last-1, opposed to the tension in stress_factor S + pressure_term I
   * (xx xy xz yy yz zz): pairs_kernels_tension.h. */
  void (*oppose)(double epsilon, const double *const stress[5], const double *stress_factor,
                 const double *pressure_term, size_t first, size_t last, double *const out[6]);
};

extern const struct sph_pair_kernels sph_pairs_kernels_baseline;
#ifdef __x86_64__
extern const struct sph_pair_kernels sph_pairs_kernels_v3, sph_pairs_kernels_v4;
#endif

const struct sph_pair_kernels *sph_pairs_kernels_choose(void);

#endif
