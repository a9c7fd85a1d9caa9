/* Pairs of particles within reach of each other. Particles of consecutive numbers stand near each other (order.h): up
 * to 16 of them share a box, eight boxes a larger one, and so on to the top; whoever looks for neighbours goes down
 * that tree. Memory depends on n alone, never on the extent; particles of any reach stand side by side; nothing is
 * sorted. A poor order of the particles costs time, never a pair. */
#ifndef CLAST_ENGINE_SPH_PAIRS_NEIGHBOURS_H
#define CLAST_ENGINE_SPH_PAIRS_NEIGHBOURS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/pairs/pairs_kernels.h"
#include "schemas/status.h"

enum { SPH_LIST_ALIGN = 16 };

struct sph_neighbours; /* opaque: the boxes */

/* Where several particles share a list, at most four, bit SPH_TAGS + k of an entry says that it is a neighbour of the
 * k-th of them; the bits below are its number. */
enum { SPH_TAGS = 28, SPH_NUMBER = (1 << SPH_TAGS) - 1 };

/* Of a chunk whose first particle is `first`. List g is that of the `share` particles from first + share g on: whoever
 * comes after the first of them and is a neighbour of one of them (or one of them), ascending, counted from `first`. It
 * stands at j[start[g]]
 * .. j[start[g] + count[g] - 1]; start[g] is a multiple of SPH_LIST_ALIGN, and what lies between lists is their first
 * particle. */
struct sph_neighbour_lists {
  uint32_t *start, *count; /* the caller's: one for each list, one more of start */
  uint32_t *j;             /* grown as needed (aligned to 64 bytes) from what it is; the caller frees it */
  size_t capacity;
  size_t pairs; /* how many there are, whoever shares a list */
};

/* For n particles at most, looked up in chunks of `chunk` consecutive ones (a multiple of `share`). NULL without
 * memory. */
struct sph_neighbours *sph_neighbours_create(size_t n, size_t chunk, size_t share,
                                             const struct sph_pair_kernels *kernels);
void sph_neighbours_free(struct sph_neighbours *neighbours); /* NULL is fine */
size_t sph_neighbours_bytes(const struct sph_neighbours *neighbours);

/* Boxes for pairs with r < reach_i + reach_j; nearest image along axes whose `periodic` length is not NaN. The arrays
 * are kept until the next call, and may be read up to 7 beyond their end. Bits depend on `threads` nowhere.
 * STATUS_MEMORY, STATUS_CONTENT (a periodic box that is too thin for its particles). */
status sph_neighbours_find(struct sph_neighbours *neighbours, size_t n, const double *x, const double *y,
                           const double *z, const double *reach, const double periodic[3], int threads,
                           struct error *error);

/* The lists of one chunk; for several at the same time. False without memory. */
bool sph_neighbours_list(const struct sph_neighbours *neighbours, size_t chunk, struct sph_neighbour_lists *lists);

#endif
