/* What gradient_correction.c declares. */

MODULE(gradient_correction)
MODULE_INPUTS(gradient_correction)

#ifdef SPH_MODULE_STRUCTS
struct sph_gradient_correction_inputs {
  bool on;
};
#endif

COLUMN(correction[6]) /* B, at the last pair loop */
