/* What a solid is made of: the numbers that equation of state, strength and fracture need. Which of them a scene really
 * needs is decided by the modules that are on; a value that is not given is NaN, and asking for it is an error there.
 */
#ifndef CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H
#define CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H

/* Tillotson 1962; Melosh 1989, appendix II. */
struct sph_tillotson {
  double A, B;           /* Pa: bulk modulus and its non-linear companion */
  double a, b;           /* 1 */
  double alpha, beta;    /* 1: decay in hot expansion (not the exponent of a spectrum) */
  double E0, E_iv, E_cv; /* J/kg: reference, incipient and complete vaporisation */
};

struct sph_weibull {
  double m; /* 1 */
  double k; /* m^-3 */
};

/* Pores: P-alpha (palpha.h). */
enum sph_palpha_curve { SPH_CRUSH_NONE, SPH_CRUSH_QUADRATIC, SPH_CRUSH_TWO_POWER };
struct sph_palpha {
  int curve;         /* enum sph_palpha_curve; none: a material without pores, and nothing else here counts */
  double distention; /* alpha_0; 1: no pores, the solid itself */
  double fraction; /* porosity 1 - 1/alpha_0: another way to give it in a document, made to agree; not used elsewhere */
  double elastic_pressure; /* Pa, P_e: plastic crushing begins */
  double solid_pressure;   /* Pa, P_s: all pores are closed */
  double sound_speed;      /* m/s, c_e of the porous matter at alpha_0; NaN: no elastic change of alpha */
  /* two-power curve */
  double elastic_distention, transition_distention; /* alpha_e, alpha_t */
  double transition_pressure;                       /* Pa, P_t */
  double exponent_low, exponent_high;               /* n1, n2 */
};

struct sph_material {
  double density; /* kg/m^3 at rest */
  struct sph_tillotson tillotson;
  double bulk_modulus;  /* Pa: K for Young's modulus and the speed of cracks; NaN or 0: tillotson.A */
  double shear_modulus; /* Pa */
  double yield_stress;  /* Pa at u = 0; falls to zero at melt_energy; INFINITY: never yields */
  double melt_energy;   /* J/kg, NaN: yield does not depend on u */
  double tension_limit; /* Pa: lowest pressure is -tension_limit where no flaws limit tension; NaN = off */
  struct sph_weibull weibull;
  struct sph_palpha porosity;
};

#endif
