/* From a tessellation to a system's arrays: allocation and the constants of grains, beams and contacts. */
#ifndef CLAST_ENGINE_DEM_ASSEMBLE_H
#define CLAST_ENGINE_DEM_ASSEMBLE_H

#include "engine/dem/system_layout.h"

/* `system` is zeroed but for p, velocities, kernels. STATUS_CONTENT for outlines that cannot be used, STATUS_MEMORY.
 * What was allocated is in *system either way. */
status dem_assemble(struct dem_system *system, const struct dem_tessellation *tessellation, struct error *error);

#endif
