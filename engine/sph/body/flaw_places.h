/* Flaws as points in a body's true shape, so that one seed means the same physical flaws at every resolution. */
#ifndef CLAST_ENGINE_SPH_BODY_FLAW_PLACES_H
#define CLAST_ENGINE_SPH_BODY_FLAW_PLACES_H

#include "engine/sph/body/bodies.h"
#include "engine/sph/body/flaws.h"

/* Points drawn from (law->seed, RANDOM_FLAW_PLACE, law->body, flaw), uniform in the shape, are given to the nearest
 * particle (the lower id of two). law->volume is not used: V is the shape's volume over the particles' distention. With
 * `middle` (NULL: whole body), flaws of the ends are dropped and particles there have none.
 *
 * Bodies of equal particles draw until each has a flaw. Graded ones draw n (ln n + 0.5772) flaws, what equal particles
 * need on average; a particle that got none is given the first flaw that it would get if drawing went on (its rank has
 * an exponential waiting time: the weakest flaw of every particle follows the law exactly). STATUS_MEMORY;
 * STATUS_CONTENT when m or k or the volume is no positive number, or all particles lie in the ends. */
status sph_flaw_places_make(const struct sph_flaw_law *law, const struct sph_shape *shape,
                            const struct sph_particles *particles, struct sph_range range,
                            const struct sph_middle *middle, struct sph_flaws **out, struct error *error);

/* The place of flaw `flaw` = 0, 1, ... */
void sph_flaw_places_point(uint64_t seed, uint64_t body, uint64_t flaw, const struct sph_shape *shape, double point[3]);

#endif
