/* Lists of neighbours: pairs of particles within reach of each other.
 *
 * Particles with consecutive numbers are near each other in space (kd_tree.h). Up to 16 of them share a leaf box, eight
 * boxes a larger one, and so on up to the top; a search goes down this tree. Memory depends on the number of particles
 * alone, not on their extent; particles of very different reach may be mixed; nothing is sorted. A poor order of the
 * particles costs time, never a pair. */
#pragma once

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { SPH_LIST_ALIGN = 16 };

struct sph_pair_kernels; /* pairs.h */
struct sph_neighbours;   /* opaque: the tree of boxes */

/* An entry of a list: the bits below SPH_TAGS are a particle's number. Where up to four particles share the list, bit
 * SPH_TAGS + k is set if that particle is a neighbour of the k-th of them. */
enum { SPH_TAGS = 28, SPH_NUMBER = (1 << SPH_TAGS) - 1 };

/* The neighbour lists of one chunk. List g serves `per_list` consecutive particles, starting at per_list * g; particles
 * are counted from the first of the chunk. The list holds, in ascending order, every particle after the first of these
 * that is a neighbour of any of them (so it may hold the others of them). Lists are padded to multiples of
 * SPH_LIST_ALIGN entries with the list's first particle:
 *
 *   j:  | a b c d e P P P | f g h ...         P: padding
 *       ^ start[0]        ^ start[1]          count[0] = 5 */
struct sph_neighbour_lists {
  uint32_t *start, *count; /* the caller's: one element per list; `start` has one more, the end */
  uint32_t *j;             /* entries, aligned to 64 bytes; grown as needed, freed by the caller */
  size_t capacity;         /* of j */
  size_t pairs;            /* number of pairs, whether or not particles share a list */
};

/* For at most n particles in chunks of `chunk` consecutive ones (a multiple of `per_list`). NULL without memory. */
struct sph_neighbours *sph_neighbours_create(size_t n, size_t chunk, size_t per_list,
                                             const struct sph_pair_kernels *kernels);
void sph_neighbours_free(struct sph_neighbours *neighbours); /* NULL is fine */

/* Builds the boxes for pairs with r < reach_i + reach_j; along axes whose `periodic` length is not NaN the nearest
 * image counts. The arrays must stay until the next call and be readable up to 7 elements beyond their end. Bits do not
 * depend on `threads`. STATUS_MEMORY; STATUS_CONTENT when a periodic box is too thin for its particles. */
status sph_neighbours_find(struct sph_neighbours *neighbours, size_t n, const double *x, const double *y,
                           const double *z, const double *reach, const double periodic[3], int threads,
                           struct error *error);

/* The lists of one chunk; several threads may call it at the same time. False without memory. */
bool sph_neighbours_list(const struct sph_neighbours *neighbours, size_t chunk, struct sph_neighbour_lists *lists);

/* Neighbour lists by chunks of particles that are close together in space. A chunk has slots, places of records, for
 * its own particles and behind them for its halo: the particles of later chunks in its lists. So all data of a chunk
 * fit into the cache of a core while it is summed.
 *
 *   slots   | own particles (SPH_CHUNK of them) | halo, ascending particle numbers |
 *   lists   | list 0 | list 1 | ...               slots, padded to whole batches (sph_chunks_balance)
 *
 * The halo of a chunk consists of stretches, each of them a part of one later chunk. */

enum { SPH_CHUNK = 4096 };

/* Halo particles first .. first + count - 1 of chunk `chunk`, all of which belong to one other chunk. */
struct sph_chunk_stretch {
  uint32_t chunk, first, count;
};

struct sph_chunk {
  size_t first, own;      /* first particle, number of particles */
  uint32_t (*foreign)[2]; /* pairs of different bodies, which are in no list: numbers of particles */
  size_t foreign_count, foreign_capacity;
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

/* Makes new lists. Arguments and errors as for sph_neighbours_find. `body` (by particle; NULL: all pairs are in lists)
 * parts the pairs: those of different bodies go to `foreign` of the chunks. */
status sph_chunks_list(struct sph_chunks *chunks, size_t n, const double *x, const double *y, const double *z,
                       const double *reach, const double periodic[3], const uint8_t *body, int threads,
                       struct error *error);

/* Balances the lists of a chunk of `own` particles, shared by `per_list` (one or two), so that most of them fill whole
 * batches. Afterwards a list may begin with particles before its first one; every pair is still in one list, and
 * entries are numbers without tags. lists->j is replaced. False without memory. */
bool sph_chunks_balance(size_t own, size_t per_list, struct sph_neighbour_lists *lists);

/* foreign.c: takes the pairs of different bodies out of the lists of a chunk as they come from sph_neighbours_list.
 * False without memory. */
bool sph_foreign_part(struct sph_chunk *chunk, size_t per_list, const uint8_t *body, struct sph_neighbour_lists *lists);
/* Makes the rows of all foreign pairs of the chunks. False without memory. */
struct sph_foreign;
bool sph_foreign_collect(const struct sph_chunks *chunks, size_t n, struct sph_foreign *out);
void sph_foreign_clear(struct sph_foreign *foreign);
