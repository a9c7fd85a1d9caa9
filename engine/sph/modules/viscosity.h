/* Artificial viscosity: a term of the pair loop that is always compiled in.
 *
 *   viscosity.alpha, viscosity.beta   linear and quadratic; both 0: none
 *
 * Monaghan's artificial viscosity, the term of the pair loop that every combination has. Its speed of sound is that of
 * the wave that acts: where pores close, of a wave along the crush curve (palpha.h). */

MODULE(viscosity)
MODULE_INPUTS(viscosity)

#ifdef SPH_MODULE_STRUCTS
struct sph_viscosity_inputs {
  double alpha, beta; /* 1 */
};
#endif

PAIR_CONSTANT(alpha, o->viscosity.alpha)
PAIR_CONSTANT(twice_beta, 2 * o->viscosity.beta)

#ifdef SPH_PAIR_TERM

/* Pi_ij of |mu_ij|, which is zero where the partners recede. `mu_per` is |mu_ij| over rho_i + rho_j. */
INLINE void TYPED(viscosity_pair)(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                                  vec mu_per, vec mu, struct pair_batch *p) {
  const vec sound = me->record[PAIR_SOUND] + its[PAIR_SOUND];
  p->viscous = mu_per * ((REAL)k->twice_beta * mu + (REAL)k->alpha * sound);
  if (SINGLE && k->volume_weights)
    p->viscous *= me->record[PAIR_DENSITY] * its[PAIR_DENSITY];
}

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool viscosity_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->viscosity.alpha > 0 || inputs->viscosity.beta > 0;
}

static const struct sph_module viscosity_module = {
    .name = "viscosity",
    .doc = "Monaghan's artificial viscosity on approaching pairs, damaged ones included, and its heating.",
    .source = "Monaghan 1992; Benz & Asphaug 1995, section 4.1",
    .when = "viscosity alpha or beta above 0",
    .on = viscosity_on,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_REAL(viscosity.alpha, viscosity.alpha, "1", 1.5, 0, 100, .flags = FIELD_DERIVED,
           .doc = "Monaghan's linear artificial viscosity. Unless given it is 1.5, with method.reconstruction 3: less "
                  "would ring behind shocks.",
           .source = "Monaghan 1992"),
    INPUT_REAL(viscosity.beta, viscosity.beta, "1", 3, 0, 100, .flags = FIELD_DERIVED,
               .doc = "Monaghan's quadratic artificial viscosity. Unless given it is 3, with method.reconstruction 6.",
               .source = "Monaghan 1992"),
#endif
