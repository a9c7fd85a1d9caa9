/* What viscosity.c declares. */

MODULE(viscosity)
MODULE_INPUTS(viscosity)

#ifdef SPH_MODULE_STRUCTS
struct sph_viscosity_inputs {
  double alpha, beta; /* 1 */
};
#endif
