/* Declarations of modules. Tables and structs are made from them. Each NAME.h of a module has lines of the kinds below,
 * and then its loops. A file that makes a table of one kind defines that kind as a macro and includes this file; lines
 * of other kinds vanish. So everything about a module is in its two files, and no table is written twice.
 *
 *   MODULE(name)            the module: sph_NAME_module in NAME.c
 *   MODULE_HOOKS(name)      it has loops: NAME_hooks
 *   MODULE_INPUTS(name)     it has inputs: struct sph_NAME_inputs, and in NAME.c the table of their rows, of that name
 *   MODULE_MATERIAL(name)   likewise values of a material, sph_NAME_material: paths are those of its document
 *   MODULE_RESULTS(name)    likewise results, sph_NAME_results
 *
 *   COLUMN(member)                     of the moving system (struct sph_columns): an array of doubles
 *   COLUMN(member[n])                  n such arrays
 *   PARTICLE_ARRAYS(FLAG, column)      the flag SPH_WITH_FLAG of struct sph_particles, set where the column exists
 *   PARTICLE_COLUMN(FLAG, member, absent, unit, doc)   a column that is read back and written into snapshots; `absent`
 *                                                      is its value in bodies without it
 *   PROFILE_COLUMN(member, of_impact, of_plate, absent, unit, doc)   mean in the layers of a profile, of these columns
 *
 *   TIME_STEP_LIMIT(NAME, member, doc)   SPH_LIMIT_NAME, and the result limited.member
 *
 * Two ready-made kinds: SPH_MODULE_STRUCTS takes the structs (structs.h), SPH_MODULE_LOOPS the loops (ranges_body.h).
 */
#ifndef MODULE
#define MODULE(...)
#endif
#ifndef MODULE_HOOKS
#define MODULE_HOOKS(...)
#endif
#ifndef MODULE_INPUTS
#define MODULE_INPUTS(...)
#endif
#ifndef MODULE_MATERIAL
#define MODULE_MATERIAL(...)
#endif
#ifndef MODULE_RESULTS
#define MODULE_RESULTS(...)
#endif
#ifndef COLUMN
#define COLUMN(...)
#endif
#ifndef PARTICLE_ARRAYS
#define PARTICLE_ARRAYS(...)
#endif
#ifndef PARTICLE_COLUMN
#define PARTICLE_COLUMN(...)
#endif
#ifndef PROFILE_COLUMN
#define PROFILE_COLUMN(...)
#endif
#ifndef TIME_STEP_LIMIT
#define TIME_STEP_LIMIT(...)
#endif

#include "engine/sph/modules/list.h"

#undef SPH_MODULE_STRUCTS
#undef SPH_MODULE_LOOPS
#undef MODULE
#undef MODULE_HOOKS
#undef MODULE_INPUTS
#undef MODULE_MATERIAL
#undef MODULE_RESULTS
#undef COLUMN
#undef PARTICLE_ARRAYS
#undef PARTICLE_COLUMN
#undef PROFILE_COLUMN
#undef TIME_STEP_LIMIT
