/* What artificial_stress.c declares. */

MODULE(artificial_stress)
MODULE_INPUTS(artificial_stress)

#ifdef SPH_MODULE_STRUCTS
struct sph_artificial_stress_inputs {
  double epsilon; /* 1; 0: off */
};
#endif
