/* P-alpha porosity. Jutzi & Benz [JB]; Jutzi, Benz & Michel 2008 [JBM08]. alpha = rho_s/rho >= 1, P = P_s(alpha rho, u)/alpha.
 * A body without pores has none of this: no array, no call (off means absent). */
#ifndef CLAST_ENGINE_SPH_PALPHA_H
#define CLAST_ENGINE_SPH_PALPHA_H

enum sph_palpha_curve { SPH_CRUSH_QUADRATIC, SPH_CRUSH_TWO_POWER };

struct sph_palpha {
  double distention;        /* alpha_0 > 1 */
  int curve;                /* enum sph_palpha_curve */
  double elastic_pressure;  /* Pa, P_e: plastic crushing begins */
  double solid_pressure;    /* Pa, P_s: all pores are closed */
  double sound_speed;       /* m/s, c_e of the porous matter at alpha_0; NaN: no elastic change of alpha below P_e */
  /* two-power curve */
  double elastic_distention, transition_distention; /* alpha_e, alpha_t */
  double transition_pressure;                       /* Pa, P_t */
  double exponent_low, exponent_high;               /* n1, n2 */
};

#endif
