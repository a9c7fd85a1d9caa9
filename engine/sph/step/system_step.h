/* One time step; for engine/sph/ only. */
#ifndef CLAST_ENGINE_SPH_STEP_SYSTEM_STEP_H
#define CLAST_ENGINE_SPH_STEP_SYSTEM_STEP_H

#include "engine/sph/step/system_layout.h"

/* Sorts, lists and evaluates at the initial state. False (see failure): as sph_system_step. */
bool sph_system_step_begin(struct sph_system *system);

/* What the pair loop is given of the particles as they stand; the system's own columns. */
struct sph_pair_fields sph_system_step_fields(const struct sph_system *system);

#endif
