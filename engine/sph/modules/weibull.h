/* The flaws of one body: how they are drawn, and how they are kept for the step (struct sph_flaws_lists in
 * body/flaws.h).
 *
 *   material.weibull.m, material.weibull.k   n(eps) = k eps^m flaws per volume open below the strain eps
 *   fidelity.flaws                           exact or compact lists
 */

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

#ifdef SPH_MODULE_DESCRIPTORS

static status weibull_prepare(const struct sph_inputs *inputs, const struct sph_particles *particles,
                              struct sph_solid *body, struct error *error) {
  (void)particles;
  return sph_flaws_lists_make(body->physics.flaws, inputs->weibull.flaws == SPH_FLAWS_COMPACT,
                              &body->prepared[SPH_MODULE_weibull], error);
}

static bool weibull_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->flaws != NULL;
}

static const struct sph_module weibull_module = {
    .name = "weibull",
    .doc = "Explicit flaws: each particle has its own list of strains at which a flaw opens, or that list's lowest, "
           "number and exponent (compact).",
    .source = "Benz & Asphaug 1995, eqs. 11 and 20",
    .when = "a body whose material has Weibull parameters",
    .on = weibull_on,
    .prepare = weibull_prepare,
    .free_prepared = sph_flaws_lists_free,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_CHOICE(fracture.draw, weibull.draw,
             FIELD_WORDS_HERE(SPH_FLAW_DRAWS, [SPH_FLAWS_RANKED] = "ranked", [SPH_FLAWS_POISSON] = "poisson"),
             .number = SPH_FLAWS_POISSON, .when = "target.fracture=auto|on",
             .choice_docs =
                 "eps_j = (j/kV)^(1/m), as printed: a seed only moves the flaws about, and the scatter is too small\n"
                 "the body's flaw strengths are a draw themselves: each seed is a specimen of its own",
             .doc = "The strengths of the flaws.", .source = "BA95 eq. 20 for `ranked`"),
    INPUT_CHOICE(fidelity.flaws, weibull.flaws,
                 FIELD_WORDS_HERE(SPH_FLAW_LISTS, [SPH_FLAWS_EXACT] = "exact", [SPH_FLAWS_COMPACT] = "compact"),
                 .when = "target.fracture=auto|on",
                 .choice_docs = "every flaw is kept\nlowest, highest and number of each particle, a power law between",
                 .doc = "Storage of a particle's flaws."),
#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
    MATERIAL_REAL(weibull.m, weibull.m, "1", NAN, 1, 200, .flags = FIELD_MAY_BE_OFF, .when = "../fracture=auto|on",
                  .doc = "Weibull's m: n(eps) = k eps^m flaws per volume are weaker than the strain eps. Large m: all "
                         "flaws alike. off: no flaws.",
                  .source = "Benz & Asphaug 1995, eq. 11"),
    MATERIAL_REAL(
        weibull.k, weibull.k, "1/m^3", NAN, 1, 1e200, .flags = FIELD_MAY_BE_OFF, .when = "../fracture=auto|on",
        .doc = "Weibull's k: flaws per volume. Papers print it in cm^-3: 1 cm^-3 is 10^6 m^-3. off: no flaws.",
        .source = "Benz & Asphaug 1995, eq. 11"),
#endif
