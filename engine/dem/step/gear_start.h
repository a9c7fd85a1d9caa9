/* Higher derivatives for the Gear integrator to start from: it needs five, and a scene gives one. */
#ifndef CLAST_ENGINE_DEM_STEP_GEAR_START_H
#define CLAST_ENGINE_DEM_STEP_GEAR_START_H

#include "engine/dem/step/system_layout.h"

/* Fill r_2 .. r_5: from the accelerations along four trial steps of the classical Runge-Kutta method, undone
 * afterwards. False: out of memory, or the trial steps are not finite. */
bool dem_gear_start(struct dem_system *system);

#endif
