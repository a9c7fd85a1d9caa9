/* Neighbour lists by chunks of particles that are close together in space. A chunk has slots, places of records, for
 * its own particles and behind them for its halo: the particles of later chunks in its lists. So all data of a chunk
 * fit into the cache of a core while it is summed.
 *
 *   slots   | own particles (SPH_CHUNK of them) | halo, ascending particle numbers |
 *   lists   | list 0 | list 1 | ...               slots, padded to whole batches (neighbours.h, sph_chunks_balance)
 *
 * The halo of a chunk consists of stretches, each of them a part of one later chunk. */
#ifndef CLAST_ENGINE_SPH_PAIRS_CHUNKS_H
#define CLAST_ENGINE_SPH_PAIRS_CHUNKS_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/pairs/neighbours.h"
#include "schemas/status.h"

enum { SPH_CHUNK = 4096 };

/* Halo particles first .. first + count - 1 of chunk `chunk`, all of which belong to one other chunk. */
struct sph_chunk_stretch {
  uint32_t chunk, first, count;
};

struct sph_chunk {
  size_t first, own;                /* first particle, number of particles */
  size_t halo, halo_before;         /* size of the halo; total size of the halos of earlier chunks */
  uint32_t *halo_particle;          /* their numbers: ascending, all above the chunk's own */
  size_t halo_capacity;             /* of halo_particle */
  struct sph_neighbour_lists lists; /* entries are slots */
  /* The stretches of other chunks' halos that are this chunk's own particles, in the order of those chunks. */
  const struct sph_chunk_stretch *stretch;
  size_t stretches;
  atomic_bool summed, delivered; /* in this pass of the pair loop */
};

struct sph_chunks {
  size_t count, per_list; /* chunks; particles that share a list */
  size_t most_slots;      /* largest number of slots (own and halo) of a chunk; 0 before the first lists are made */
  size_t halos;           /* halo particles of all chunks */
  struct sph_chunk *chunk;
  struct sph_neighbours *neighbours;
  uint32_t *start;                   /* `start` and `count` of all chunks' lists */
  struct sph_chunk_stretch *stretch; /* of all chunks */
  size_t stretch_capacity;
};

/* For n particles; `per_list` as for sph_neighbours_create. STATUS_MEMORY: nothing is left to free. */
status sph_chunks_create(size_t n, size_t per_list, const struct sph_pair_kernels *kernels, struct sph_chunks *out,
                         struct error *error);
void sph_chunks_clear(struct sph_chunks *chunks);
size_t sph_chunks_bytes(const struct sph_chunks *chunks);

/* Makes new lists. Arguments and errors as for sph_neighbours_find. */
status sph_chunks_list(struct sph_chunks *chunks, size_t n, const double *x, const double *y, const double *z,
                       const double *reach, const double periodic[3], int threads, struct error *error);

/* Balances the lists of a chunk of `own` particles, shared by `per_list` (one or two), so that most of them fill whole
 * batches. Afterwards a list may begin with particles before its first one; every pair is still in one list, and
 * entries are numbers without tags. lists->j is replaced. False without memory. */
bool sph_chunks_balance(size_t own, size_t per_list, struct sph_neighbour_lists *lists);

#endif
