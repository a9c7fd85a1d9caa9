/* Tillotson equation of state, pressure and sound speed. Melosh 1989; Benz & Asphaug 1994.
 *
 * eta = rho/rho0, mu = eta - 1, w = u/(E0 eta^2) + 1:
 *   compressed or cold (rho >= rho0 or u <= E_iv):  P_c = (a + b/w) rho u + A mu + B mu^2, with B = 0 for eta < 1
 *     (with B, dP/drho < 0 below eta = 1 - A/(2B));
 *   hot, expanded (rho < rho0, u >= E_cv):
 *     P_e = a rho u + (b rho u/w + A mu exp(-beta (1/eta-1))) exp(-alpha (1/eta-1)^2);
 *   between: both at the actual u, with weights linear in u, so that P is continuous.
 * c^2 = dP/drho + (P/rho^2) dP/du, at least A/(4 rho0). c jumps at E_iv and E_cv, as the model says. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_TILLOTSON_H
#define CLAST_ENGINE_SPH_MATERIAL_TILLOTSON_H

#include "engine/sph/material/material.h"

struct sph_pressure {
  double pressure;    /* Pa */
  double by_density;  /* dP/drho at constant u, m^2/s^2 */
  double by_energy;   /* dP/du at constant rho, kg/m^3 */
  double sound_speed; /* m/s, bulk */
};

/* u < 0 is evaluated at u = 0 (the pole is at -E0 eta^2). The step holds u at 0, too, and the ledger counts that. */
struct sph_pressure sph_tillotson(const struct sph_tillotson_material *t, double density0, double density, double u);

#endif
