/* What viscosity.c declares. */

#ifdef SPH_MODULE_STRUCTS
struct sph_viscosity_inputs {
  double alpha, beta; /* 1 */
};
#endif
MODULE_INPUTS(viscosity)
