/* Lists of neighbours by chunks of particles that stand together in space: each has places ("slots") for its own
 * particles and, behind them, for the foreign ones that they meet, so that what a chunk needs of them all fits into a
 * core's cache. */
#ifndef CLAST_ENGINE_SPH_PAIRS_CHUNKS_H
#define CLAST_ENGINE_SPH_PAIRS_CHUNKS_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/pairs/neighbours.h"
#include "schemas/status.h"

enum { SPH_CHUNK = 4096 };

/* A stretch of a chunk's `other`: those that belong to another chunk. */
struct sph_chunk_share {
  uint32_t chunk, first, count;
};

struct sph_chunk {
  size_t first, own, others;        /* others: how many foreign ones, */
  uint32_t *other;                  /* their numbers: ascending, all above the chunk's own */
  struct sph_neighbour_lists lists; /* of slots; whole batches (exchange.h) */
  size_t others_before;             /* others of all chunks before it */
  size_t shares; /* which particles of this chunk are others of which chunks, in the order of chunks: how many, */
  const struct sph_chunk_share *share;
  size_t other_capacity;
  atomic_bool summed, taken; /* in this pass of the pair loop */
};

struct sph_chunks {
  size_t count, share, most_slots,
      others; /* most_slots: own and others of one chunk; others: of all; 0 both before the first listing */
  struct sph_chunk *chunk;
  struct sph_neighbours *neighbours;
  uint32_t *start;                /* of all lists */
  struct sph_chunk_share *shares; /* of all chunks */
  size_t share_capacity;
};

/* For n particles; `share`: as for sph_neighbours_create. STATUS_MEMORY: then nothing is left to free. */
status sph_chunks_create(size_t n, size_t share, const struct sph_pair_kernels *kernels, struct sph_chunks *out,
                         struct error *error);
void sph_chunks_clear(struct sph_chunks *chunks);
size_t sph_chunks_bytes(const struct sph_chunks *chunks);

/* New lists, as sph_neighbours_find says. */
status sph_chunks_list(struct sph_chunks *chunks, size_t n, const double *x, const double *y, const double *z,
                       const double *reach, const double periodic[3], int threads, struct error *error);

#endif
