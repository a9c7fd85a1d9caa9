/* The values of a material, one row each: SPH_MATERIAL_ROWS(R) is R(member of struct sph_material, unit, minimum, maximum,
 * flags, need, doc, source) for every one. The documents of engine/sph/materials/ are read through them (materials.c), and
 * each body of a scene has them as inputs (inputs.c), there with the named material's values as defaults.
 * `need` says what asks for a value: ALWAYS, STRENGTH, FRACTURE. Flags: OFF, it may be off; LOG; ABOVE its minimum. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_ROWS_H
#define CLAST_ENGINE_SPH_MATERIAL_ROWS_H

#include "schemas/field.h"

#define SPH_MATERIAL_OFF FIELD_MAY_BE_OFF
#define SPH_MATERIAL_LOG FIELD_LOG
#define SPH_MATERIAL_ABOVE FIELD_ABOVE_MINIMUM

#define SPH_MATERIAL_ROWS(R)                                                                                           \
  R(density, "kg/m^3", 1e-3, 1e6, SPH_MATERIAL_LOG, ALWAYS, "rho_0: density at rest.", NULL)                           \
  R(tillotson.A, "Pa", 1, 1e15, SPH_MATERIAL_LOG, ALWAYS, "Tillotson's A: bulk modulus at rest.",                      \
    "Tillotson 1962; Melosh 1989, appendix II")                                                                        \
  R(tillotson.B, "Pa", 0, 1e15, 0, ALWAYS, "Tillotson's B: quadratic term in compression.", "Melosh 1989, appendix II") \
  R(tillotson.a, "1", 0, 100, 0, ALWAYS, "Tillotson's a: Grueneisen coefficient of hot matter. 0, with b 0: pressure "  \
    "does not depend on energy.", "Melosh 1989, appendix II")                                                          \
  R(tillotson.b, "1", 0, 100, 0, ALWAYS, "Tillotson's b: a + b is the Grueneisen coefficient at rest.",                \
    "Melosh 1989, appendix II")                                                                                        \
  R(tillotson.alpha, "1", 0, 1e3, 0, ALWAYS, "Tillotson's alpha: decay in hot expansion.", "Melosh 1989, appendix II")  \
  R(tillotson.beta, "1", 0, 1e3, 0, ALWAYS, "Tillotson's beta: decay in hot expansion.", "Melosh 1989, appendix II")   \
  R(tillotson.E0, "J/kg", 1e-3, 1e15, SPH_MATERIAL_LOG, ALWAYS, "Tillotson's reference energy.",                       \
    "Melosh 1989, appendix II")                                                                                        \
  R(tillotson.E_iv, "J/kg", 1e-3, 1e15, SPH_MATERIAL_LOG, ALWAYS, "Energy of incipient vaporisation.",                 \
    "Melosh 1989, appendix II")                                                                                        \
  R(tillotson.E_cv, "J/kg", 1e-3, 1e15, SPH_MATERIAL_LOG, ALWAYS, "Energy of complete vaporisation, above E_iv.",      \
    "Melosh 1989, appendix II")                                                                                        \
  R(bulk_modulus, "Pa", 1, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG, STRENGTH,                                        \
    "K where Young's modulus and the speed of cracks are made from it. off: tillotson.A.", "Benz & Asphaug 1995, eq. 21") \
  R(shear_modulus, "Pa", 1, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG, STRENGTH, "mu: shear modulus.",                 \
    "Benz & Asphaug 1995, eq. 6")                                                                                      \
  R(yield_stress, "Pa", 0, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG | SPH_MATERIAL_ABOVE, STRENGTH,                   \
    "Y_0: von Mises yield stress of cold matter. off: elastic at any stress.", "Benz & Asphaug 1995, eq. 9")           \
  R(melt_energy, "J/kg", 1, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG, STRENGTH,                                       \
    "Energy at which the yield stress has fallen to zero, linearly. off: it does not depend on energy.",               \
    "Benz & Asphaug 1995, section 2")                                                                                  \
  R(tension_limit, "Pa", 0, 1e15, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG, ALWAYS,                                         \
    "Largest tension of matter without flaws (lowest pressure is minus this). off: no limit, down to -A and beyond.", NULL) \
  R(weibull.m, "1", 1, 200, SPH_MATERIAL_OFF, FRACTURE,                                                                \
    "Weibull's m: n(eps) = k eps^m flaws per volume are weaker than the strain eps. Large m: all flaws alike. off: no "   \
    "flaws.", "Benz & Asphaug 1995, eq. 11")                                                                           \
  R(weibull.k, "1/m^3", 1, 1e200, SPH_MATERIAL_OFF | SPH_MATERIAL_LOG, FRACTURE,                                       \
    "Weibull's k (papers print 1/cm^3, which is 1e6 of these). off: no flaws.", "Benz & Asphaug 1995, eq. 11")

#endif
