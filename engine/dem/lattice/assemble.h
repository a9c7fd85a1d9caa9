/* From a tessellation to a system's arrays: allocation and the constants of grains, beams and contacts. */
#ifndef CLAST_ENGINE_DEM_LATTICE_ASSEMBLE_H
#define CLAST_ENGINE_DEM_LATTICE_ASSEMBLE_H

#include "engine/dem/step/system_layout.h"

/* `system` must be zero except for in, velocities, kernels. STATUS_CONTENT: outlines that cannot be used;
 * STATUS_MEMORY. In both cases *system owns the allocated memory. */
status dem_assemble(struct dem_system *system, const struct dem_tessellation *tessellation, uint64_t seed,
                    struct error *error);

/* S_ref of a pair (conservative law: kappa = Y / (L_c S_ref)), m; it never changes during a run.
 * Pairs that were never bonded (side = 0): 0.27 (d_i + d_j). Bonded pairs: the common side, but at least half of that
 * value. The floor is needed because the lattice makes arbitrarily short sides, and kappa acts on any later overlap of
 * the two grains: without it, about 1 run in 100 had a pair too stiff for its time step after its beam had broken, and
 * its energy diverged. A pair with a side below the floor is softer than Y by side/S_ref when aligned; such pairs carry
 * little load. */
double dem_assemble_reference_side(double side, double diameter_i, double diameter_j);

/* Coefficients of the contact of two grains; `side` is their common side, 0 for grains that never had one. */
struct dem_contact dem_assemble_contact(const struct dem_system *system, uint32_t i, uint32_t j, double side);

#endif
