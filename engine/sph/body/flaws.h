/* Explicit Weibull flaws. Benz & Asphaug 1995 eqs. 11 and 20 [BA95].
 *
 * Flaw j = 1, 2, ... of a body of (solid) volume V has the activation strain
 *   ranked:  eps_j = (j / kV)^(1/m)             as printed: a seed only moves the flaws about
 *   poisson: eps_j = (Gamma_j / kV)^(1/m)       Gamma_j cumulative unit exponentials: the strengths are a draw, too
 * and goes to the particle that owns a random point, until every particle has one (about N ln N flaws). Thresholds are
 * kept as logarithms, ln eps_j = (ln j - ln k - ln V)/m, which no m, k that a user can type overflows. */
#ifndef CLAST_ENGINE_SPH_BODY_FLAWS_H
#define CLAST_ENGINE_SPH_BODY_FLAWS_H

#include <stddef.h>
#include <stdint.h>

#include "engine/sph/material/material.h"
#include "schemas/status.h"

enum sph_flaw_draw { SPH_FLAWS_RANKED, SPH_FLAWS_POISSON };

struct sph_flaw_law {
  struct sph_weibull weibull;
  double volume; /* m^3, of solid matter */
  int draw;      /* enum sph_flaw_draw */
  uint64_t seed;
  uint64_t body; /* bodies of one seed have flaws of their own */
  /* For bodies whose particles differ much in size; 0: draw until every particle has a flaw. Else so many are drawn,
   * and a particle i that got none is given the first it would get later: at rank last + E / share[i], E a unit
   * exponential. */
  uint64_t number;
  const double *share;         /* with `number`: part of the volume of each particle; NULL: 1/n */
  const unsigned char *exempt; /* particles that have no flaws (owner() must not name them); NULL: none */
};

/* Flaws by particle: particle i has first[i] .. first[i+1]-1, log_strain ascending within it. */
struct sph_flaws {
  size_t particles, count;
  size_t *first;
  double *log_strain;
};

/* Which particle owns the place of flaw `flaw` (0, 1, ...), below n; SPH_FLAWS_NOBODY when the place is outside. Places
 * are drawn from (seed, RANDOM_FLAW_PLACE, body, flaw), so that a seed means the same flaws at every resolution. */
typedef size_t (*sph_flaws_owner)(void *context, uint64_t flaw);
#define SPH_FLAWS_NOBODY ((size_t)-1)

/* Draws until each of n particles has a flaw (owner(), or NULL: a random particle), or `most` flaws are out (0: 64 n ln
 * n). STATUS_MEMORY; STATUS_CONTENT when some particle got none within the limit, when none may have one, or when m, k,
 * or the volume is no positive number. */
status sph_flaws_make(const struct sph_flaw_law *law, size_t n, sph_flaws_owner owner, void *context, uint64_t most,
                      struct sph_flaws **out, struct error *error);
void sph_flaws_free(struct sph_flaws *flaws); /* NULL is fine */

#endif
