/* What gradient_correction.c declares. */

#ifdef SPH_MODULE_STRUCTS
struct sph_gradient_correction_inputs {
  bool on;
};
#endif
MODULE_INPUTS(gradient_correction)

COLUMN(correction[6]) /* B, at the last pair loop */
