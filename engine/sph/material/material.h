/* Values of a solid that the equation of state, strength and fracture need. The modules that are on
 * decide which of them a scene needs; a value that is not given is NaN, and the module that needs it refuses it.
 *
 * To add a value or a choice that one module needs: MATERIAL_MEMBERS and a row in its header (modules/declarations.h);
 * values that several modules read are here, in SPH_MATERIAL_COMMON. The documents of engine/sph/material/builtin/ are
 * read through the rows (materials.c), and each body of a scene has them as inputs (scene/inputs.c), there with the
 * named material's values as defaults. A row is of one of three kinds:
 *
 * MATERIAL_VALUE(member, unit, minimum, maximum, flags, need, doc, source): a number.
 *
 * MATERIAL_CHOICE(member, choices, absent, need, name, choice_docs, doc, source): a word. The first one is the default,
 * and no value counts with it. `name` is what messages call the choice.
 *
 * MATERIAL_CHOICE_VALUE(member, unit, default, minimum, maximum, flags, when, doc, source): a number that counts only
 * with certain words of a choice: `when` is "path=word|word". With default NAN the material must give it.
 *
 * `need` says which bodies use it: ALWAYS, STRENGTH, FRACTURE. Flags: OFF, it may be off; ABOVE its minimum. `absent`
 * of a choice that came later: field.absent. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H
#define CLAST_ENGINE_SPH_MATERIAL_MATERIAL_H

#include <math.h>

#include "schemas/field.h"

struct sph_material {
  double density;     /* kg/m^3 at rest */
  double melt_energy; /* J/kg, NaN: yield does not depend on u */
#define MATERIAL_MEMBERS(...) __VA_ARGS__
#include "engine/sph/modules/declarations.h"
};

#define SPH_MATERIAL_OFF   FIELD_MAY_BE_OFF
#define SPH_MATERIAL_ABOVE FIELD_ABOVE_MINIMUM
#define SPH_CHOICES(...)   ((const char *const[]){__VA_ARGS__, NULL})

#define SPH_MATERIAL_COMMON(VALUE)                                                                                     \
  VALUE(density, "kg/m^3", 1e-3, 1e6, 0, ALWAYS, "rho_0: density at rest.", NULL)                                      \
  VALUE(melt_energy, "J/kg", 1, 1e15, SPH_MATERIAL_OFF, STRENGTH,                                                      \
        "Energy at which the yield stress has fallen to zero, linearly. off: it does not depend on energy.",           \
        "Benz & Asphaug 1995, section 2")

#endif
