/* Monaghan's artificial viscosity, the term of the pair loop that every combination has. */

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

/* Pi_ij. `mu_per` is |mu_ij| over rho_i + rho_j; zero where the partners recede. */
INLINE void TYPED(viscosity_pair)(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                                  vec mu_per, struct pair_batch *p) {
  const vec sound = me->record[PAIR_SOUND] + its[PAIR_SOUND];
  p->viscous = mu_per * ((REAL)k->twice_beta * p->mu + (REAL)k->alpha * sound);
  if (SINGLE && k->volume_weights)
    p->viscous *= me->record[PAIR_DENSITY] * its[PAIR_DENSITY];
}

#endif
