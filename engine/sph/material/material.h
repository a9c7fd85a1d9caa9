/* What a solid is made of: the numbers that equation of state, strength and fracture need, and their rows. The modules
 * that are on decide which of them a scene needs; a value that is not given is NaN, and the module that needs it
 * refuses it.
 *
 * To add a value or a choice: a member of struct sph_material (or of a struct in it) and a row, both here. The
 * documents of engine/sph/material/builtin/ are read through the rows (materials.c), and each body of a scene has them
 * as inputs (scene/inputs.c), there with the named material's values as defaults. SPH_MATERIAL_ROWS(VALUE, CHOICE,
 * CHOICE_VALUE) has every row, of one of three kinds:
 *
 * VALUE(member, unit, minimum, maximum, flags, need, doc, source): a number.
 *
 * CHOICE(member, choices, flags, need, name, choice_docs, doc, source): a word. The first one is the default, and no
 * value counts with it. `name` is what messages call the choice.
 *
 * CHOICE_VALUE(member, unit, default, minimum, maximum, flags, when, doc, source): a number that counts only with
 * certain words of a choice: `when` is "path=word|word". With default NAN the material must give it.
 *
 * `need` says which bodies use it: ALWAYS, STRENGTH, FRACTURE. Flags: OFF, it may be off; ABOVE its minimum; SILENT, a
 * choice that came later (FIELD_SILENT_DEFAULT). */
#ifndef CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H
#define CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H

#include <math.h>

#include "schemas/field.h"

/* Tillotson 1962; Melosh 1989, appendix II. */
struct sph_tillotson {
  double A, B;           /* Pa: bulk modulus and its non-linear companion */
  double a, b;           /* 1 */
  double alpha, beta;    /* 1: decay in hot expansion (not the exponent of a spectrum) */
  double E0, E_iv, E_cv; /* J/kg: reference, incipient and complete vaporisation */
};

struct sph_weibull {
  double m; /* 1 */
  double k; /* m^-3 */
};

/* Pores: P-alpha (palpha.h). */
enum sph_palpha_curve { SPH_CRUSH_NONE, SPH_CRUSH_QUADRATIC, SPH_CRUSH_TWO_POWER };
struct sph_palpha {
  int curve;         /* enum sph_palpha_curve; none: a material without pores, and nothing else here counts */
  double distention; /* alpha_0; 1: no pores, the solid itself */
  double fraction; /* porosity 1 - 1/alpha_0: another way to give it in a document, made to agree; not used elsewhere */
  double elastic_pressure; /* Pa, P_e: plastic crushing begins */
  double solid_pressure;   /* Pa, P_s: all pores are closed */
  double sound_speed;      /* m/s, c_e of the porous matter at alpha_0; NaN: no elastic change of alpha */
  /* two-power curve */
  double elastic_distention, transition_distention; /* alpha_e, alpha_t */
  double transition_pressure;                       /* Pa, P_t */
  double exponent_low, exponent_high;               /* n1, n2 */
};

/* Yield stress of rock under pressure (modules/pressure_strength.c). */
enum sph_pressure_strength_law { SPH_PRESSURE_STRENGTH_NONE, SPH_PRESSURE_STRENGTH_LUNDBORG };
struct sph_pressure_strength {
  int law;                /* enum sph_pressure_strength_law; none: nothing else here counts */
  double intact_cohesion; /* Pa, Y_0; this and the others bound sqrt(J2) */
  double intact_friction; /* 1, mu_i */
  double intact_limit;    /* Pa, Y_M */
  double broken_cohesion; /* Pa, Y_d0 */
  double broken_friction; /* 1, mu_d */
};

struct sph_material {
  double density; /* kg/m^3 at rest */
  struct sph_tillotson tillotson;
  double bulk_modulus;  /* Pa: K for Young's modulus and the speed of cracks; NaN or 0: tillotson.A */
  double shear_modulus; /* Pa */
  double yield_stress;  /* Pa at u = 0; falls to zero at melt_energy; INFINITY: never yields */
  double melt_energy;   /* J/kg, NaN: yield does not depend on u */
  double tension_limit; /* Pa: lowest pressure is -tension_limit where no flaws limit tension; NaN = off */
  struct sph_weibull weibull;
  struct sph_palpha porosity;
  struct sph_pressure_strength pressure_strength;
};

#define SPH_MATERIAL_OFF          FIELD_MAY_BE_OFF
#define SPH_MATERIAL_ABOVE        FIELD_ABOVE_MINIMUM
#define SPH_MATERIAL_SILENT       FIELD_SILENT_DEFAULT
#define SPH_MATERIAL_CHOICES(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The solid itself. */
#define SPH_SOLID_ROWS(VALUE)                                                                                          \
  VALUE(density, "kg/m^3", 1e-3, 1e6, 0, ALWAYS, "rho_0: density at rest.", NULL)                                      \
  VALUE(tillotson.A, "Pa", 1, 1e15, 0, ALWAYS, "Tillotson's A: bulk modulus at rest.",                                 \
        "Tillotson 1962; Melosh 1989, appendix II")                                                                    \
  VALUE(tillotson.B, "Pa", 0, 1e15, 0, ALWAYS, "Tillotson's B: quadratic term in compression.",                        \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.a, "1", 0, 100, 0, ALWAYS,                                                                           \
        "Tillotson's a: Grueneisen coefficient of hot matter. 0, with b 0: pressure does not depend on energy.",       \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.b, "1", 0, 100, 0, ALWAYS, "Tillotson's b: a + b is the Grueneisen coefficient at rest.",            \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.alpha, "1", 0, 1e3, 0, ALWAYS, "Tillotson's alpha: decay in hot expansion.",                         \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.beta, "1", 0, 1e3, 0, ALWAYS, "Tillotson's beta: decay in hot expansion.",                           \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.E0, "J/kg", 1e-3, 1e15, 0, ALWAYS, "Tillotson's reference energy.", "Melosh 1989, appendix II")      \
  VALUE(tillotson.E_iv, "J/kg", 1e-3, 1e15, 0, ALWAYS, "Energy of incipient vaporisation.",                            \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(tillotson.E_cv, "J/kg", 1e-3, 1e15, 0, ALWAYS, "Energy of complete vaporisation, above E_iv.",                 \
        "Melosh 1989, appendix II")                                                                                    \
  VALUE(bulk_modulus, "Pa", 1, 1e15, SPH_MATERIAL_OFF, STRENGTH,                                                       \
        "K where Young's modulus and the speed of cracks are made from it. off: tillotson.A.",                         \
        "Benz & Asphaug 1995, eq. 21")                                                                                 \
  VALUE(shear_modulus, "Pa", 1, 1e15, SPH_MATERIAL_OFF, STRENGTH, "mu: shear modulus.", "Benz & Asphaug 1995, eq. 6")  \
  VALUE(yield_stress, "Pa", 0, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_ABOVE, STRENGTH,                                  \
        "Y_0: von Mises yield stress of cold matter; with pores of the solid between them, and the porous body "       \
        "yields at Y_0/alpha. off: elastic at any stress.",                                                            \
        "Benz & Asphaug 1995, eq. 9; Jutzi, Benz & Michel 2008")                                                       \
  VALUE(melt_energy, "J/kg", 1, 1e15, SPH_MATERIAL_OFF, STRENGTH,                                                      \
        "Energy at which the yield stress has fallen to zero, linearly. off: it does not depend on energy.",           \
        "Benz & Asphaug 1995, section 2")                                                                              \
  VALUE(tension_limit, "Pa", 0, 1e15, SPH_MATERIAL_OFF, ALWAYS,                                                        \
        "Largest tension of matter without flaws (lowest pressure is minus this). It falls with expansion, to none "   \
        "at 0.9 of the density, so that cold matter reaches 1/(1 + 10 tension_limit/A) of it. With pores it is that "  \
        "of the porous body, as strengths are measured (our choice); of the solid's value give that over alpha_0. "    \
        "off: no limit, down to -A and beyond.",                                                                       \
        NULL)                                                                                                          \
  VALUE(weibull.m, "1", 1, 200, SPH_MATERIAL_OFF, FRACTURE,                                                            \
        "Weibull's m: n(eps) = k eps^m flaws per volume are weaker than the strain eps. Large m: all flaws alike. "    \
        "off: no flaws.",                                                                                              \
        "Benz & Asphaug 1995, eq. 11")                                                                                 \
  VALUE(weibull.k, "1/m^3", 1, 1e200, SPH_MATERIAL_OFF, FRACTURE,                                                      \
        "Weibull's k (papers print 1/cm^3, which is 1e6 of these). off: no flaws.", "Benz & Asphaug 1995, eq. 11")

/* Pores (P-alpha). */
#define SPH_POROSITY_ON        "porosity.curve=quadratic|two-power"
#define SPH_POROSITY_TWO_POWER "porosity.curve=two-power"
#define SPH_POROSITY_ROWS(CHOICE, CHOICE_VALUE)                                                                        \
  CHOICE(porosity.curve, SPH_MATERIAL_CHOICES("none", "quadratic", "two-power"), 0, ALWAYS, "crush curve",             \
         "no pores\nalpha = 1 + (alpha_e - 1)((P_s - P)/(P_s - P_e))^2\n"                                              \
         "a steep law up to P_t and a second one up to P_s, for very porous matter such as pumice",                    \
         "Crush curve: how pores far below the resolution close under pressure (P-alpha).",                            \
         "Herrmann 1969; Jutzi, Benz & Michel 2008")                                                                   \
  CHOICE_VALUE(porosity.distention, "1", NAN, 1, 100, 0, SPH_POROSITY_ON,                                              \
               "alpha_0: density of the solid over that of the porous body. 1: no pores, the solid itself to the "     \
               "bit. In a scene porosity.fraction may be given instead.",                                              \
               "Herrmann 1969")                                                                                        \
  CHOICE_VALUE(porosity.fraction, "1", NAN, 0, 0.99, SPH_MATERIAL_OFF, SPH_POROSITY_ON,                                \
               "Porosity, 1 - 1/alpha_0: give it or porosity.distention, not both; the other follows.", NULL)          \
  CHOICE_VALUE(porosity.elastic_pressure, "Pa", NAN, 0, 1e15, 0, SPH_POROSITY_ON,                                      \
               "P_e: from here on pores are crushed for good.", "Jutzi, Benz & Michel 2008")                           \
  CHOICE_VALUE(porosity.solid_pressure, "Pa", NAN, 0, 1e15, SPH_MATERIAL_ABOVE, SPH_POROSITY_ON,                       \
               "P_s: from here on all pores are closed.", "Jutzi, Benz & Michel 2008")                                 \
  CHOICE_VALUE(porosity.sound_speed, "m/s", NAN, 0, 1e6, SPH_MATERIAL_OFF | SPH_MATERIAL_ABOVE, SPH_POROSITY_ON,       \
               "c_e: bulk sound speed of the porous body, not above the solid's. off: pores do not give way "          \
               "elastically, and the solid's speed is taken.",                                                         \
               "Herrmann 1969; Jutzi, Benz & Michel 2008")                                                             \
  CHOICE_VALUE(                                                                                                        \
      porosity.elastic_distention, "1", NAN, 1, 100, SPH_MATERIAL_ABOVE, SPH_POROSITY_TWO_POWER,                       \
      "alpha_e: where the crush curve begins, at P_e. A body of lower alpha_0 keeps it until it meets the curve.",     \
      "Jutzi et al. 2009")                                                                                             \
  CHOICE_VALUE(porosity.transition_distention, "1", NAN, 1, 100, 0, SPH_POROSITY_TWO_POWER,                            \
               "alpha_t: below it, and above P_t, the first power law has ended.", "Jutzi et al. 2009")                \
  CHOICE_VALUE(porosity.transition_pressure, "Pa", NAN, 0, 1e15, SPH_MATERIAL_ABOVE, SPH_POROSITY_TWO_POWER,           \
               "P_t: where the first power law ends.", "Jutzi et al. 2009")                                            \
  CHOICE_VALUE(porosity.exponent_low, "1", NAN, 1, 100, 0, SPH_POROSITY_TWO_POWER,                                     \
               "n1: exponent of the law between P_e and P_t.", "Jutzi et al. 2009")                                    \
  CHOICE_VALUE(porosity.exponent_high, "1", NAN, 1, 100, 0, SPH_POROSITY_TWO_POWER,                                    \
               "n2: exponent of the law up to P_s.", "Jutzi et al. 2009")

/* Yield stress under pressure. */
#define SPH_PRESSURE_STRENGTH_ON "pressure_strength.law=lundborg"
#define SPH_PRESSURE_STRENGTH_ROWS(CHOICE, CHOICE_VALUE)                                                               \
  CHOICE(pressure_strength.law, SPH_MATERIAL_CHOICES("none", "lundborg"), SPH_MATERIAL_SILENT, STRENGTH, "yield law",  \
         "yield_stress at any pressure, and (1 - D) of the deviator acts\n"                                            \
         "intact rock follows Lundborg, broken rock keeps friction, and damage acts on the deviator through the "      \
         "yield stress alone; yield_stress is not used, melt_energy is",                                               \
         "Yield stress under pressure.", "Collins, Melosh & Ivanov 2004; Jutzi 2015")                                  \
  CHOICE_VALUE(pressure_strength.intact_cohesion, "Pa", 90e6, 0, 1e15, 0, SPH_PRESSURE_STRENGTH_ON,                    \
               "Y_0: bound of sqrt(J2) of intact rock at P = 0.",                                                      \
               "Collins, Melosh & Ivanov 2004; 90 MPa: granite, Jutzi 2015")                                           \
  CHOICE_VALUE(pressure_strength.intact_friction, "1", 2, 0, 100, 0, SPH_PRESSURE_STRENGTH_ON,                         \
               "mu_i: internal friction of intact rock.", "Lundborg 1968; Collins, Melosh & Ivanov 2004")              \
  CHOICE_VALUE(pressure_strength.intact_limit, "Pa", 1.5e9, 0, 1e15, SPH_MATERIAL_ABOVE, SPH_PRESSURE_STRENGTH_ON,     \
               "Y_M: bound of sqrt(J2) of intact rock at high pressure, above intact_cohesion.",                       \
               "Lundborg 1968; 1.5 GPa: granite, Jutzi 2015")                                                          \
  CHOICE_VALUE(pressure_strength.broken_cohesion, "Pa", 0, 0, 1e15, 0, SPH_PRESSURE_STRENGTH_ON,                       \
               "Y_d0: bound of sqrt(J2) of broken rock at P = 0.", "Collins, Melosh & Ivanov 2004")                    \
  CHOICE_VALUE(pressure_strength.broken_friction, "1", 0.8, 0, 100, 0, SPH_PRESSURE_STRENGTH_ON,                       \
               "mu_d: friction of broken rock. 0, with broken_cohesion 0: broken rock bears no shear.",                \
               "Collins, Melosh & Ivanov 2004; 0.8: Jutzi 2015")

/* All, in the order of the tables. */
#define SPH_MATERIAL_ROWS(VALUE, CHOICE, CHOICE_VALUE)                                                                 \
  SPH_SOLID_ROWS(VALUE)                                                                                                \
  SPH_POROSITY_ROWS(CHOICE, CHOICE_VALUE)                                                                              \
  SPH_PRESSURE_STRENGTH_ROWS(CHOICE, CHOICE_VALUE)

#endif
