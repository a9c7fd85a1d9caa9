/* What weibull.c declares: the flaws of a material, how they are drawn and how they are kept. */

MATERIAL_MEMBERS(struct sph_weibull { double m, k; } weibull;) /* 1, m^-3 */

MATERIAL_VALUE(weibull.m, "1", 1, 200, SPH_MATERIAL_OFF, FRACTURE,
               "Weibull's m: n(eps) = k eps^m flaws per volume are weaker than the strain eps. Large m: all flaws "
               "alike. off: no flaws.",
               "Benz & Asphaug 1995, eq. 11")
MATERIAL_VALUE(weibull.k, "1/m^3", 1, 1e200, SPH_MATERIAL_OFF, FRACTURE,
               "Weibull's k (papers print 1/cm^3, which is 1e6 of these). off: no flaws.",
               "Benz & Asphaug 1995, eq. 11")

INPUT_CHOICE(
    fracture, draw, SPH_CHOICES("ranked", "poisson"), .number = SPH_FLAWS_POISSON, .when = "target.fracture=auto|on",
    .choice_docs = "eps_j = (j/kV)^(1/m), as printed: a seed only moves the flaws about, and the scatter is too "
                   "small\n"
                   "the body's flaw strengths are a draw themselves: each seed is a specimen of its own",
    .doc = "The strengths of the flaws.", .source = "BA95 eq. 20 for `ranked`")
INPUT_CHOICE(fidelity, flaws, SPH_CHOICES("exact", "compact"), .when = "target.fracture=auto|on",
             .choice_docs = "every flaw is kept\nlowest, highest and number of each particle, a power law between",
             .doc = "Storage of a particle's flaws.")
