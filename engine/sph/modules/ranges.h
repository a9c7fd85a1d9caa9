/* The loops over particles, compiled once per CPU class and chosen at run time.
 *
 * Results are bit-identical only within one class (contraction to FMA differs), so a run records its class. The
 * environment variable CLAST_CPU=baseline|v3|v4 limits the class; a class that this machine lacks is not used. */
#ifndef CLAST_ENGINE_SPH_MODULES_RANGES_H
#define CLAST_ENGINE_SPH_MODULES_RANGES_H

#include "engine/sph/step/system_layout.h"

struct sph_ranges {
  const sph_hook *module[SPH_MODULES]; /* SPH_STAGES loops of each; NULL: the module has none */
  /* Loops of every body, whatever its modules (motion.h). */
  sph_hook predict;                                       /* x v rho u h */
  sph_hook output_fluid, output_whole, output_damaged;    /* columns that the pair loop reads */
  sph_hook hold;                                          /* held freedoms and damping: the new accelerations */
  sph_hook fluid_rates;                                   /* u */
  sph_hook correct_fluid, correct_whole, correct_damaged; /* v rho h, and the limits of the time step */
};

extern const struct sph_ranges sph_ranges_baseline;
#ifdef __x86_64__
extern const struct sph_ranges sph_ranges_v3, sph_ranges_v4;
#endif

const struct sph_ranges *sph_ranges_choose(void);

#endif
