/* The kernels of the pair loop, compiled once per CPU class and chosen at run time (engine/sph/modules/ranges.h: bits
 * of results), in double and in float.
 *
 * All data that a pair needs of a particle are in one record, a row of numbers, so that a neighbour costs two cache
 * lines. A kernel loads the records of as many neighbours as a vector register has lanes and transposes them in
 * registers. The sums of the neighbours are transposed back and added to their records of sums. */
#ifndef CLAST_ENGINE_SPH_PAIRS_PAIRS_KERNELS_H
#define CLAST_ENGINE_SPH_PAIRS_PAIRS_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Columns of a record. Float records hold x, y, z as 32-bit integers in a small unit of length: differences are exact
 * and wrap round harmlessly, so precision does not depend on a particle's place in a scene of kilometres. */
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
  PAIR_ZZ, /* T: sigma/rho^2 with the pressure term; times B with the gradient correction */
  PAIR_SOUND,
  PAIR_DENSITY,
  PAIR_ARTIFICIAL,      /* with artificial stress: the six columns of R */
  PAIR_TURNED = 16,     /* with the gradient correction: YX ZX ZY of T, which is not symmetric then */
  PAIR_TURNED_TOO = 24, /* the same with both */
};
/* Columns of a record of sums. In float a sum is multiplied by the masses of both partners (volumes with volume
 * weights), so that both get the same number; unpack divides by the particle's own. */
enum sph_pair_sum {
  SUM_ACCELERATION,
  SUM_GRADIENT = 3,
  SUM_HEATING = 12, /* times -2 */
  SUM_SIGNAL,       /* the largest, not the sum; above zero if there are neighbours */
  SUM_MOMENT,       /* with the gradient correction: six columns, times -1 */
  SUM_COLUMNS = SUM_MOMENT + 6,
};
/* Length of a record in columns: the plain one; with artificial stress or the gradient correction (sums: with moments);
 * with both. */
enum { PAIR_NARROW = 16, PAIR_MIDDLE_DOUBLE = 24, PAIR_MIDDLE_FLOAT = 32, PAIR_WIDE = 32 };

/* The length of a record that has one, two or none of the extra parts. */
static inline size_t sph_pair_columns(bool single, bool one, bool other) {
  if (one && other)
    return PAIR_WIDE;
  if (!one && !other)
    return PAIR_NARROW;
  return single ? PAIR_MIDDLE_FLOAT : PAIR_MIDDLE_DOUBLE;
}

/* Particles with consecutive numbers that share one list of neighbours. A neighbour is loaded, and its sums are stored,
 * once for all of them. */
enum { PAIR_GROUP_DOUBLE = 1, PAIR_GROUP_FLOAT = 2 };

/* One chunk (chunks.h) as the kernels see it. A slot is the place of a record: the chunk's own particles, then its
 * halo. */
struct sph_pair_chunk {
  size_t own, slots;         /* own particles; own and halo */
  const uint32_t *start;     /* by group: where its list begins, a multiple of 16 */
  const uint32_t *count;     /* by group: number of neighbours */
  const uint32_t *neighbour; /* slots; members of a group but the first are in the group's list */
};

/* Columns from which records are packed: arrays of all particles. */
struct sph_pair_source {
  const double *column[PAIR_WIDE];        /* by enum sph_pair_column; NULL: zero. XX to YZ: the deviator */
  double scale[PAIR_WIDE];                /* from SI to the records' units; powers of two */
  const double *stress_factor, *pressure; /* factor of the deviator; added to XX, YY, ZZ, in their units */
  const double *correction[6];            /* B, a factor of the stress; NULL without the correction */
  double per_unit[3];                     /* 1/m, inverse unit of float records' positions */
  bool volume_weights;                    /* the stress is sigma, not sigma/rho^2 */
};

/* Columns to which sums are unpacked. */
struct sph_pair_sink {
  double *column[SUM_COLUMNS]; /* by enum sph_pair_sum; without moments NULL from there on */
  double scale[SUM_COLUMNS];   /* from the records' units to SI */
  const double *mass, *density;
  double mass_unit, density_unit;
  bool volume_weights; /* if not, gradient and moments are divided by the density */
};

/* Columns of the particles whose gradients are corrected. */
struct sph_pair_correction {
  const double *old[6];                                              /* the B of this pass's forces */
  const double *density, *pressure_term, *stress_factor, *stress[5]; /* the last two are NULL without strength */
  double *gradient[9];                                               /* in: the sum; out: times the new B */
  double *correction[6];                                             /* in: the moments; out: the new B */
  double *power;                                                     /* out: the work of the forces, J/kg/s */
};

struct sph_pair_constants {
  double alpha, twice_beta;
  double periodic[3], per_period[3]; /* m, length of a periodic axis and its inverse; NaN: open (double records only) */
  double unit[3];                    /* unit of float records' positions over their unit of h; used if wrapped */
  double norm;                       /* of W'/r */
  double spline_at_spacing;          /* W(spacing)/norm, for the artificial stress */
  bool strength, volume_weights, wrapped;
};

/* A box of neighbours.h: all its particles lie within `half` of `middle`, and none has a larger reach than `reach`. */
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
  /* Applies the gradient correction to `count` particles (pairs_kernels_correct.h). */
  void (*correct)(const struct sph_pair_correction *, size_t count);
  /* The artificial stress R of the particles first .. last - 1 (xx xy xz yy yz zz), which opposes the tension in
   * stress_factor S + pressure_term I, in the same unit (pairs_kernels_tension.h). */
  void (*oppose)(double epsilon, const double *const stress[5], const double *stress_factor,
                 const double *pressure_term, size_t first, size_t last, double *const out[6]);
};

extern const struct sph_pair_kernels sph_pairs_kernels_baseline;
#ifdef __x86_64__
extern const struct sph_pair_kernels sph_pairs_kernels_v3, sph_pairs_kernels_v4;
#endif

const struct sph_pair_kernels *sph_pairs_kernels_choose(void);

#endif
