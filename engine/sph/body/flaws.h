/* Explicit Weibull flaws. Benz & Asphaug 1995 eqs. 11 and 20 [BA95].
 *
 * Flaw j = 1, 2, ... of a body of (solid) volume V has the activation strain
 *   ranked:  eps_j = (j / kV)^(1/m)             as printed: a seed only changes the places of the flaws
 *   poisson: eps_j = (Gamma_j / kV)^(1/m)       Gamma_j cumulative unit exponentials: the strengths are drawn, too
 * and belongs to the particle nearest to a random point. Thresholds are kept as logarithms, ln eps_j = (ln j - ln k -
 * ln V)/m, which do not overflow for any m and k that a user can type.
 *
 * Flaws are points in the body's true shape (sph_flaws_place), so that one seed means the same physical flaws at every
 * resolution. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/body/bodies.h"
#include "engine/sph/material/material.h"

/* Cells of a body that crack as one (modules/crack_cell.h): cubes of a fixed width. The grid of cubes is turned and
 * shifted by the seed. A cube cut by the surface is a smaller cell. */

/* One block of memory: free() ends it. */
struct sph_cells {
  size_t particles, count; /* number of particles; number of cells that have a particle */
  uint32_t *of;            /* by particle of the body: its cell */
};

/* Sorts the particles of a body, at their initial places, into cells of this width (m). Drawn from (seed,
 * RANDOM_CELL, body). STATUS_MEMORY. */
status sph_flaws_cells(uint64_t seed, uint64_t body, double width, const struct sph_particles *particles,
                       struct sph_range range, struct sph_cells **out, struct error *error);

enum sph_flaw_draw { SPH_FLAWS_RANKED, SPH_FLAWS_POISSON, SPH_FLAW_DRAWS };

struct sph_flaw_law {
  struct sph_weibull_material weibull;
  double solid_ratio; /* density of the solid over that of the body; 0 counts as 1 */
  int draw;           /* enum sph_flaw_draw */
  uint64_t seed;
  uint64_t body;     /* bodies of one seed have different flaws */
  double cell_width; /* m, particles of a cell of this width share flaws (struct sph_cells). 0: each has its own */
};

/* Flaws by owner: owner i has first[i] .. first[i+1]-1, log_strain ascending within it. Owners are the particles, or
 * the cells where there are some. */
struct sph_flaws {
  size_t particles, count; /* of the body; of flaws */
  size_t *first;
  double *log_strain;
  struct sph_cells *cells; /* NULL: particles own flaws */
};

void sph_flaws_free(struct sph_flaws *flaws); /* NULL is fine */

/* The flaws of a body. Their points are uniform in the shape; each flaw belongs to the nearest particle (of two, to
 * that with the lower id). V is the shape's volume over law->solid_ratio. With `half`, flaws in the ends |z| > half (m)
 * are dropped and particles there have none.
 *
 * n (ln n + 0.5772) flaws are drawn, as many as equal cells need on average until each has one. A particle i that got
 * none is then given the first one that it would get if drawing went on: at rank last + E V/V_i, E a unit exponential
 * and V_i its volume. (Drawing until each has one would count the smallest cell: cells cut by the surface made 13 to
 * 17 % more flaws of it.) So the weakest flaw of every particle follows the law exactly. With law->cell_width, n counts
 * cells, and a flaw belongs to the cell of the nearest particle. STATUS_MEMORY; STATUS_CONTENT when m, k or the volume
 * is not a positive number, or all particles are in the ends. */
status sph_flaws_place(const struct sph_flaw_law *law, const struct sph_shape *shape,
                       const struct sph_particles *particles, struct sph_range range, double half,
                       struct sph_flaws **out, struct error *error);

/* The place of flaw `flaw` = 0, 1, ... */
void sph_flaws_point(uint64_t seed, uint64_t body, uint64_t flaw, const struct sph_shape *shape, double point[3]);

/* The flaws of one body, as thresholds of strain per particle. Exact: every threshold of every particle, ascending.
 * Compact: (lowest, exponent, number) per particle, with
 *   n(eps) = min(total, floor((eps/lowest)^q)),  q = ln(total)/ln(highest/lowest),
 * a power law that counts 1 at the lowest and all at the highest threshold; so codes of this kind save memory (Benz &
 * Asphaug 1994). A threshold beyond the range of a double is infinite (it never opens) or 0. */
struct sph_flaws_lists; /* opaque; body->prepared[SPH_MODULE_weibull] */

/* STATUS_MEMORY. *out is a struct sph_flaws_lists. */
status sph_flaws_lists_make(const struct sph_flaws *flaws, bool compact, void **out, struct error *error);
void sph_flaws_lists_free(void *lists); /* NULL is fine */
double sph_flaws_lowest(const struct sph_flaws_lists *lists, size_t particle);
uint32_t sph_flaws_total(const struct sph_flaws_lists *lists, size_t particle);
/* Number of open flaws; the same for every strain with bracket[0] <= strain < bracket[1]. */
uint32_t sph_flaws_active(const struct sph_flaws_lists *lists, size_t particle, double strain, double bracket[2]);
