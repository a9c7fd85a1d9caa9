/* From a tessellation to a system's arrays: allocation and the constants of grains, beams and contacts. */
#ifndef CLAST_ENGINE_DEM_LATTICE_ASSEMBLE_H
#define CLAST_ENGINE_DEM_LATTICE_ASSEMBLE_H

#include "engine/dem/step/system_layout.h"

/* `system` is zeroed but for in, velocities, kernels. STATUS_CONTENT for outlines that cannot be used, STATUS_MEMORY.
 * What was allocated is in *system either way. */
status dem_assemble(struct dem_system *system, const struct dem_tessellation *tessellation, uint64_t seed,
                    struct error *error);

/* S_ref of the conservative law, kappa = Y / (L_c S_ref), m; fixed for good when the pair is met first.
 * 0.27 (d_i + d_j) for pairs that were never bonded (side = 0). For bonded ones the common side, but at least half of
 * that: the lattice makes sides of any shortness, and kappa acts on whatever the two grains overlap later. With S_ref
 * -> 0 such a pair met again after its beam had broken was too stiff for any time step and blew the run up (1 run in
 * about 100). Aligned, a pair with a side below the floor is softer than Y by side/S_ref: those pairs carry little. */
double dem_assemble_reference_side(double side, double diameter_i, double diameter_j);

/* Coefficients of the contact of two grains; `side` is their common side, 0 for grains that never had one. */
struct dem_contact dem_assemble_contact(const struct dem_system *system, uint32_t i, uint32_t j, double side);

#endif
