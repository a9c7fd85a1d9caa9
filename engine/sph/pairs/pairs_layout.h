/* The inside of the pair loop, for pairs.c, pairs_sum.c and pairs_columns.c only. */
#ifndef CLAST_ENGINE_SPH_PAIRS_PAIRS_LAYOUT_H
#define CLAST_ENGINE_SPH_PAIRS_PAIRS_LAYOUT_H

#include "engine/sph/pairs/chunks.h"
#include "engine/sph/pairs/pairs.h"
#include "engine/sph/pairs/pairs_kernels.h"

/* A buffer of one piece's sums has a row for each column of struct sph_pair_sums: those of enum sph_pair_sum up to the
 * signal, then power and correction. */
enum {
  SPH_PAIRS_ROWS = 21,
  SPH_PAIRS_ROW = SPH_PIECE + 8, /* length of a row: at multiples of 4 kB all rows would compete for the same lines of
                                  * the cache */
  SPH_PAIRS_BUFFER = SPH_PAIRS_ROWS * SPH_PAIRS_ROW,
};

/* Units in which the numbers of float records are of order 1; powers of two. In double all units are 1. per_...: their
 * inverses. */
struct sph_pairs_units {
  double length, mass, velocity, density, specific; /* specific: of stress over density squared */
  double per_length, per_mass, per_velocity, per_density, per_specific;
};

struct sph_pairs {
  struct sph_pair_options options;
  const struct sph_pair_kernels *kernels;
  const struct sph_record_kernels *records; /* those of the precision */
  bool single;                              /* records are of float */
  bool artificial, corrected;               /* artificial stress; gradient correction */
  size_t n, threads;
  size_t in_columns, out_columns; /* of a record; of a record of sums */
  double *opposed[6];             /* artificial stress R of each particle, m^5/(kg s^2); NULL without */
  double *listed[5];              /* x y z h slack when the lists were made */
  double *reach;                  /* h + slack */
  struct sph_chunks lists;
  void *in; /* records of a chunk, one buffer per thread */
  size_t in_capacity;
  void *out; /* records of sums of `depth` chunks, used in turn */
  size_t out_capacity, depth;
  void *halo; /* records of sums of all halos */
  size_t halo_capacity;
  double *buffer; /* sums of a piece, one buffer per thread */
  double unit[3]; /* m, unit of float records' positions */
  double h_unit;  /* m, the unit of their h: the same, except on periodic axes */
  struct sph_pairs_units units;
  bool units_chosen; /* since the lists were made; in double they stay 1 */
  size_t within;     /* pairs inside the support in the last pass, counted twice */
};

/* A chunk's sums are delivered this many chunks after it was summed. A single thread delivers at once, while the sums
 * are in its cache. Several threads keep some chunks for the end, as work for those that find no chunk left to sum. */
static inline size_t sph_pairs_lag(const struct sph_pairs *p) {
  return p->threads > 1 ? 4 * p->threads : 0;
}

/* Chooses the units of float records. As powers of two they change no bit of a result, so they need not be the same
 * after a restart. */
void sph_pairs_columns_units(struct sph_pairs *pairs, size_t n, const struct sph_pair_fields *fields);
/* The data of a pass: sources of records, constants of the sums, the sums of a piece in its buffer, and the columns
 * that records of sums become. */
struct sph_pair_source sph_pairs_columns_source(const struct sph_pairs *pairs, const struct sph_pair_fields *fields);
struct sph_pair_constants sph_pairs_columns_constants(const struct sph_pairs *pairs);
struct sph_pair_sums sph_pairs_columns_sums(const struct sph_pairs *pairs, double *buffer);
struct sph_pair_sink sph_pairs_columns_sink(const struct sph_pairs *pairs, const struct sph_pair_sums *sums);

#endif
