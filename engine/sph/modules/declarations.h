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
 *   PAIR_TERM(term, on)   a term of the pair loop (pairs/pairs_term.h), usually of the module's name, and its condition
 *                         on `o`, a struct sph_pair_options. It may have:
 *   PAIR_FIELDS(member, count)      columns of the system that the pair loop reads, of the COLUMN of that name
 *   PAIR_MADE(term, count)          arrays of all particles that it makes before a pass
 *   PAIR_RECORD(term, count)        columns that it adds to a record of the pair loop
 *   PAIR_SUMS(term, member, count, scale)   sums that it adds; they become the COLUMN of that name. `scale` brings them
 *                                           to SI; it is made from `u`, a struct sph_pair_units
 *   PAIR_POWER(term)                its finish fills the power of struct sph_pair_sums
 *   PAIR_CONSTANT(name, value)      a number that is the same for all pairs; `value` is made from `o`
 *   PAIR_PACK(term), PAIR_STRESS(term), PAIR_STRESS_ADDED(term), PAIR_FORCE(term), PAIR_SUMMED(term), PAIR_FINISH(term)
 *                                   the functions that it has
 *
 *   TIME_STEP_LIMIT(NAME, member, doc)   SPH_LIMIT_NAME, and the result limited.member
 *
 * Three ready-made kinds: SPH_MODULE_STRUCTS takes the structs (structs.h), SPH_MODULE_LOOPS the loops (ranges_body.h),
 * SPH_PAIR_TERM the functions of terms (pairs/pairs_kernels_body.h). */
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
#ifndef PAIR_TERM
#define PAIR_TERM(...)
#endif
#ifndef PAIR_FIELDS
#define PAIR_FIELDS(...)
#endif
#ifndef PAIR_MADE
#define PAIR_MADE(...)
#endif
#ifndef PAIR_RECORD
#define PAIR_RECORD(...)
#endif
#ifndef PAIR_SUMS
#define PAIR_SUMS(...)
#endif
#ifndef PAIR_POWER
#define PAIR_POWER(...)
#endif
#ifndef PAIR_CONSTANT
#define PAIR_CONSTANT(...)
#endif
#ifndef PAIR_PACK
#define PAIR_PACK(...)
#endif
#ifndef PAIR_STRESS
#define PAIR_STRESS(...)
#endif
#ifndef PAIR_STRESS_ADDED
#define PAIR_STRESS_ADDED(...)
#endif
#ifndef PAIR_FORCE
#define PAIR_FORCE(...)
#endif
#ifndef PAIR_SUMMED
#define PAIR_SUMMED(...)
#endif
#ifndef PAIR_FINISH
#define PAIR_FINISH(...)
#endif
#ifndef TIME_STEP_LIMIT
#define TIME_STEP_LIMIT(...)
#endif

#include "engine/sph/modules/list.h"

#undef SPH_MODULE_STRUCTS
#undef SPH_MODULE_LOOPS
#undef SPH_PAIR_TERM
#undef MODULE
#undef MODULE_HOOKS
#undef MODULE_INPUTS
#undef MODULE_MATERIAL
#undef MODULE_RESULTS
#undef COLUMN
#undef PARTICLE_ARRAYS
#undef PARTICLE_COLUMN
#undef PROFILE_COLUMN
#undef PAIR_TERM
#undef PAIR_FIELDS
#undef PAIR_MADE
#undef PAIR_RECORD
#undef PAIR_SUMS
#undef PAIR_POWER
#undef PAIR_CONSTANT
#undef PAIR_PACK
#undef PAIR_STRESS
#undef PAIR_STRESS_ADDED
#undef PAIR_FORCE
#undef PAIR_SUMMED
#undef PAIR_FINISH
#undef TIME_STEP_LIMIT
