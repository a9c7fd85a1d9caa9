/* What a piston does to matter without strength, from the jump conditions alone: the exact answer beside a plate that
 * is shocked (protocol piston). Written with this engine's equation of state and crush curve; tests hold it against a
 * solution that shares neither (tests/verification/palpha_exact.h).
 *
 * Porous matter answers with two fronts: the elastic precursor, which raises it to P_e, and behind it the shock that
 * crushes pores. A piston slower than the precursor's matter makes only an elastic front; a shock faster than the
 * precursor has swallowed it, and solid matter has none. Across a front, ahead 1, behind 2, in the frame of the matter
 * ahead: rho1 U = rho2 (U - w),  P2 - P1 = rho1 U w,  u2 - u1 = (P1 + P2)/2 (1/rho1 - 1/rho2) Curves that would split
 * the shock once more (a two-power curve that softens at P_t) are not followed: it is taken as one. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_PLANE_SHOCK_H
#define CLAST_ENGINE_SPH_MATERIAL_PLANE_SHOCK_H

#include <stdbool.h>

#include "engine/sph/material/material.h"
#include "schemas/status.h"

struct sph_front {
  double speed, velocity;           /* m/s at rest ahead of everything: of the front, of the matter behind it */
  double density, pressure, energy; /* behind it: kg/m^3 bulk, Pa, J/kg */
  double distention;                /* behind it */
};

struct sph_plane_shock {
  double first_density; /* kg/m^3, bulk, before */
  bool has_precursor, has_shock;
  struct sph_front precursor, shock; /* all NaN where there is none */
};

/* STATUS_CONTENT: values that make no law, or a piston so fast (or slow)
 * that no pressure up to 1e16 Pa holds it. */
status sph_plane_shock(const struct sph_material *material, double piston, struct sph_plane_shock *out,
                       struct error *error);

#endif
