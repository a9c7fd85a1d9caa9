/* Values of a solid that the equation of state, strength and fracture need. The modules that are on decide which of
 * them a scene needs; a value that is not given is NaN, and the module that needs it refuses it.
 *
 * A value or a choice that one module needs is a member of its struct and a row of its table (modules/declarations.h);
 * values that several modules read are here, and their rows in materials.c. The documents of
 * engine/sph/material/builtin/ are read through the rows, and each body of a scene has them as inputs
 * (scene/inputs.c), there with the named material's values as defaults.
 *
 * The default of a number is NAN: a material gives it (FIELD_REQUIRED), or it is off unless given (FIELD_MAY_BE_OFF).
 * `.when` says which bodies use it: "../strength=true", "../fracture=auto|on", or a choice of the material. The first
 * word of a choice is the default, and no value counts with it; its label is what messages call it. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H
#define CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H

#include "engine/sph/modules/structs.h"

struct sph_material {
  double density;     /* kg/m^3 at rest */
  double melt_energy; /* J/kg, NaN: yield does not depend on u */
#define MODULE_MATERIAL(name) struct sph_##name##_material name;
#include "engine/sph/modules/declarations.h"
};

/* Rows; the including file defines MATERIAL, the name of the struct (schemas/rows.h). */
#define MATERIAL_REAL(path_, member_, ...) REAL_OF(MATERIAL, path_, member_, __VA_ARGS__)
#define MATERIAL_CHOICE(path_, member_, choices_, ...)                                                                 \
  ROW_OF(MATERIAL, path_, member_, FIELD_CHOICE, NULL, .choices = choices_, __VA_ARGS__)

#endif
