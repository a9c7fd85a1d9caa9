/* The exact fronts that a piston makes in matter without strength, from the jump conditions: the reference of protocol
 * piston. They use this engine's equation of state and crush curve; tests compare them with a solution that shares
 * neither (tests/verification/palpha_exact.h).
 *
 * In porous matter there are two fronts: the elastic precursor, which raises the pressure to P_e, and behind it the
 * shock, which crushes pores. A piston slower than the matter behind the precursor makes only an elastic front. Where
 * the shock would be faster than the precursor, and in solid matter, there is only the shock. Across a front, ahead 1,
 * behind 2, in the frame of the matter ahead:
 *
 *   rho1 U = rho2 (U - w)
 *   P2 - P1 = rho1 U w
 *   u2 - u1 = (P1 + P2)/2 (1/rho1 - 1/rho2)
 *
 * A two-power curve that softens at P_t could split the shock once more; here it is one shock. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_PLANE_SHOCK_H
#define CLAST_ENGINE_SPH_MATERIAL_PLANE_SHOCK_H

#include <stdbool.h>
#include <stdio.h>

#include "engine/sph/material/material.h"
#include "schemas/status.h"

struct sph_front {
  double speed, velocity;           /* m/s at rest ahead of everything: of the front, of the matter behind it */
  double density, pressure, energy; /* behind it: kg/m^3 bulk, Pa, J/kg */
  double distention;                /* behind it */
};

struct sph_plane_shock {
  double first_density; /* kg/m^3, bulk, ahead of the fronts */
  bool has_precursor, has_shock;
  struct sph_front precursor, shock; /* all NaN where there is none */
};

/* STATUS_CONTENT: values that give no law, or a piston so fast or slow that no pressure up to 1e16 Pa stops it. */
status sph_plane_shock(const struct sph_material *material, double piston, struct sph_plane_shock *out,
                       struct error *error);
/* Prints the existing fronts, one per line. */
void sph_plane_shock_describe(const struct sph_plane_shock *shock, FILE *out);

#endif
