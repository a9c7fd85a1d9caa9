/* A plain C version of the same model: bench_dem's ratios refer to its speed. FROZEN: it is never optimised or changed,
 * so that a ratio means the same on every machine and in every year. */
#pragma once

#include "engine/dem/step/system.h"

struct reference_dem;
struct reference_dem *reference_dem_create(const struct dem_tessellation *tessellation,
                                           const struct dem_inputs *inputs);
void reference_dem_state(struct reference_dem *reference, const struct dem_system *system); /* start from its state */
void reference_dem_step(struct reference_dem *reference);
double reference_dem_energy(struct reference_dem *reference);
void reference_dem_free(struct reference_dem *reference);
