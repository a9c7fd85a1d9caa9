/* The length of a step, and what set it. */
#ifndef CLAST_ENGINE_SPH_STEP_LIMITS_H
#define CLAST_ENGINE_SPH_STEP_LIMITS_H

#include "engine/sph/step/system_layout.h"

/* From what the blocks found at the last evaluation (progress.worst); not beyond `until`. */
double sph_limits_step(const struct sph_system *system, double until, int *limiter);

#endif
