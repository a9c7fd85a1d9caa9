/* Declarations of modules. Tables and structs are made from them. Each NAME.h of a module has lines of the kinds below,
 * and then its loops. A file that makes a table of one kind defines that kind as a macro and includes this file; lines
 * of other kinds vanish. So everything about a module is in its two files, and no table is written twice.
 *
 *   MATERIAL_MEMBERS(...)        members of struct sph_material; then its rows, as in material/material.h:
 *   MATERIAL_VALUE(member, unit, minimum, maximum, flags, need, doc, source)
 *   MATERIAL_CHOICE(member, choices, absent, need, name, choice_docs, doc, source)
 *   MATERIAL_CHOICE_VALUE(member, unit, default, minimum, maximum, flags, when, doc, source)
 *
 *   INPUT_REAL(section, member, unit, default, minimum, maximum, ...)   an input of the scene: member and row. Sections
 *   INPUT_CHOICE(section, member, choices, ...)                         are fracture, viscosity, method and fidelity;
 *   INPUT_SWITCH(section, member, default, ...)                         `...` are more of struct field (.doc, .when)
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
 *   RESULT_MEMBERS(...)                     members of struct sph_results; then rows (observe/results.c)
 *   FRONT_RESULT_MEMBERS(...)               members of its structs shock and precursor
 *   RESULT_REAL(path, unit, minimum, ...)
 *   RESULT_SHARE(path, ...)
 *
 * Three ready-made kinds: SPH_INPUT_MEMBERS and SPH_INPUT_ROWS make the members and the rows of one section, which the
 * includer names by IN_section(...); SPH_MODULE_LOOPS takes the loops (ranges_body.h). */
#ifdef SPH_INPUT_MEMBERS
#define INPUT_REAL(section, member, ...)   IN_##section(double member;)
#define INPUT_CHOICE(section, member, ...) IN_##section(int member;)
#define INPUT_SWITCH(section, member, ...) IN_##section(bool member;)
#endif
#ifdef SPH_INPUT_ROWS
#define INPUT_REAL(section, member, ...)   IN_##section(REAL(section.member, __VA_ARGS__), )
#define INPUT_CHOICE(section, member, ...) IN_##section(CHOICE(section.member, __VA_ARGS__), )
#define INPUT_SWITCH(section, member, ...) IN_##section(SWITCH(section.member, __VA_ARGS__), )
#endif

#ifndef IN_fracture
#define IN_fracture(...)
#endif
#ifndef IN_viscosity
#define IN_viscosity(...)
#endif
#ifndef IN_method
#define IN_method(...)
#endif
#ifndef IN_fidelity
#define IN_fidelity(...)
#endif
#ifndef MATERIAL_MEMBERS
#define MATERIAL_MEMBERS(...)
#endif
#ifndef MATERIAL_VALUE
#define MATERIAL_VALUE(...)
#endif
#ifndef MATERIAL_CHOICE
#define MATERIAL_CHOICE(...)
#endif
#ifndef MATERIAL_CHOICE_VALUE
#define MATERIAL_CHOICE_VALUE(...)
#endif
#ifndef INPUT_REAL
#define INPUT_REAL(...)
#endif
#ifndef INPUT_CHOICE
#define INPUT_CHOICE(...)
#endif
#ifndef INPUT_SWITCH
#define INPUT_SWITCH(...)
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
#ifndef RESULT_MEMBERS
#define RESULT_MEMBERS(...)
#endif
#ifndef FRONT_RESULT_MEMBERS
#define FRONT_RESULT_MEMBERS(...)
#endif
#ifndef RESULT_REAL
#define RESULT_REAL(...)
#endif
#ifndef RESULT_SHARE
#define RESULT_SHARE(...)
#endif

#define SPH_MODULE_DECLARATIONS
#include "engine/sph/modules/list.h"
#undef SPH_MODULE_DECLARATIONS

#undef SPH_INPUT_MEMBERS
#undef SPH_INPUT_ROWS
#undef IN_fracture
#undef IN_viscosity
#undef IN_method
#undef IN_fidelity
#undef MATERIAL_MEMBERS
#undef MATERIAL_VALUE
#undef MATERIAL_CHOICE
#undef MATERIAL_CHOICE_VALUE
#undef INPUT_REAL
#undef INPUT_CHOICE
#undef INPUT_SWITCH
#undef COLUMN
#undef PARTICLE_ARRAYS
#undef PARTICLE_COLUMN
#undef PROFILE_COLUMN
#undef TIME_STEP_LIMIT
#undef RESULT_MEMBERS
#undef FRONT_RESULT_MEMBERS
#undef RESULT_REAL
#undef RESULT_SHARE
