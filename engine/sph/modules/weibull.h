/* What weibull.c declares: the flaws of a material, how they are drawn and how they are kept. */

MODULE(weibull)
MODULE_MATERIAL(weibull)
MODULE_INPUTS(weibull)

#ifdef SPH_MODULE_STRUCTS
struct sph_weibull_material {
  double m, k; /* 1, m^-3; NaN: no flaws */
};
/* Every flaw of a particle, or the lowest, the highest and the number of them. */
enum sph_flaw_lists { SPH_FLAWS_EXACT, SPH_FLAWS_COMPACT, SPH_FLAW_LISTS };
struct sph_weibull_inputs {
  int draw;  /* enum sph_flaws_draw */
  int flaws; /* enum sph_flaw_lists */
};
#endif
