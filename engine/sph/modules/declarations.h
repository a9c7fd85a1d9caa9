/* Declarations of modules. Tables and structs are made from them. Each NAME.h of a module has lines of the kinds below,
 * and behind them its sections. A file that makes a table of one kind defines that kind as a macro and includes this
 * file; lines of other kinds vanish. A file that needs a section defines its name and includes this file. So everything
 * about a module is in its one file, nothing is written twice, and NAME.h includes nothing itself.
 *
 *   MODULE(name)            the module: NAME_module
 *   MODULE_HOOKS(name)      it has loops: NAME_hooks
 *   MODULE_INPUTS(name)     it has inputs: struct sph_NAME_inputs, the member NAME of struct sph_inputs
 *   MODULE_MATERIAL(name)   likewise values of a material, struct sph_NAME_material of struct sph_material
 *   MODULE_RESULTS(name)    likewise results, struct sph_NAME_results of struct sph_results
 *   MODULE_REPORT(name)     it fills results: NAME_report
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
 *   PAIR_FOUND(term, member, count)         values that its finish makes; they become the COLUMN of that name
 *   PAIR_POWER(term)                its finish fills the power of struct sph_pair_sums
 *   PAIR_CONSTANT(name, value)      a number that is the same for all pairs; `value` is made from `o`
 *   PAIR_PACK(term), PAIR_BEFORE(term), PAIR_STRESS(term), PAIR_STRESS_ADDED(term), PAIR_FORCE(term),
 *   PAIR_SUMMED(term), PAIR_FINISH(term)   the functions that it has
 *
 *   TIME_STEP_LIMIT(NAME, member, doc)   SPH_LIMIT_NAME, and the result limited.member
 *
 * Sections, each behind `#ifdef`:
 *   SPH_MODULE_STRUCTS         structs of inputs, values of a material and results (structs.h)
 *   SPH_MODULE_INPUT_ROWS, SPH_MODULE_MATERIAL_ROWS, SPH_MODULE_RESULT_ROWS
 *                              the rows of their members (scene/inputs.c, material/material.c, observe/results.c).
 *                              They come last in the file: clang-format takes what follows for a part of them
 *   SPH_MODULE_LOOPS           loops over particles, and NAME_hooks, the table of them (ranges.h)
 *   SPH_PAIR_TERM              functions of a term (pairs/pairs_kernels_body.h)
 *   SPH_MODULE_DESCRIPTORS     checks, preparation and NAME_module, the descriptor (modules.c)
 *   SPH_MODULE_REPORT          NAME_report(run, results), for runs with a body that has the module (observe/report.c)
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
#ifndef MODULE_REPORT
#define MODULE_REPORT(...)
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
#ifndef PAIR_FOUND
#define PAIR_FOUND(...)
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
#ifndef PAIR_BEFORE
#define PAIR_BEFORE(...)
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

/* The modules of the solid, in the order in which they act within a stage. This is the only list of them: the
 * descriptors, the loops of every CPU class and what modules declare follow.
 *
 *   elastic             first, because the others act on its stress
 *   tillotson, palpha   the last of them that is on sets the pressure
 *   yield, pressure_strength   the last of them that is on sets the yield limit
 *   tension_limit       after the modules that set the pressure and the yield limit, which it bounds
 *   weibull, fracture   last, because the stress that opens flaws is within the yield limit
 *   crack_cell          after fracture, whose R_s it sets for cells of particles
 *   crack_front         after fracture, whose thresholds, rates and caps it changes for the next step
 *   contact             not within the pair loop, which it makes leave out pairs of different bodies
 *   the rest            options of the pair loop, without loops here
 * motion.h is no module: it has the loops of every body.
 *
 * To add a module: NAME.h with what it declares and its sections, and a line below. */
/* clang-format off */
#include "engine/sph/modules/motion.h"
#include "engine/sph/modules/elastic.h"
#include "engine/sph/modules/tillotson.h"
#include "engine/sph/modules/palpha.h"
#include "engine/sph/modules/yield.h"
#include "engine/sph/modules/pressure_strength.h"
#include "engine/sph/modules/tension_limit.h"
#include "engine/sph/modules/weibull.h"
#include "engine/sph/modules/fracture.h"
#include "engine/sph/modules/crack_cell.h"
#include "engine/sph/modules/crack_front.h"
#include "engine/sph/modules/viscosity.h"
#include "engine/sph/modules/artificial_stress.h"
#include "engine/sph/modules/gradient_correction.h"
#include "engine/sph/modules/crack_surfaces.h"
#include "engine/sph/modules/reconstruction.h"
#include "engine/sph/modules/contact.h"
/* clang-format on */

/* The combinations of terms for which the pair loop is compiled, in two precisions and three CPU classes: a name, and
 * the terms that are on. */
#define SPH_PAIR_COMBINATIONS(COMBINATION)                                                                             \
  COMBINATION(plain, 0)                                                                                                \
  COMBINATION(artificial, .artificial_stress = true)                                                                   \
  COMBINATION(corrected, .gradient_correction = true)                                                                  \
  COMBINATION(both, .artificial_stress = true, .gradient_correction = true)                                            \
  COMBINATION(surfaces, .gradient_correction = true, .crack_surfaces = true)                                           \
  COMBINATION(smooth, .gradient_correction = true, .reconstruction = true)                                             \
  COMBINATION(limits, .gradient_correction = true, .crack_surfaces = true, .reconstruction = true)

#undef SPH_MODULE_STRUCTS
#undef SPH_MODULE_LOOPS
#undef SPH_PAIR_TERM
#undef SPH_MODULE_INPUT_ROWS
#undef SPH_MODULE_MATERIAL_ROWS
#undef SPH_MODULE_RESULT_ROWS
#undef SPH_MODULE_DESCRIPTORS
#undef SPH_MODULE_REPORT
#undef MODULE
#undef MODULE_HOOKS
#undef MODULE_INPUTS
#undef MODULE_MATERIAL
#undef MODULE_RESULTS
#undef MODULE_REPORT
#undef COLUMN
#undef PARTICLE_ARRAYS
#undef PARTICLE_COLUMN
#undef PROFILE_COLUMN
#undef PAIR_TERM
#undef PAIR_FIELDS
#undef PAIR_MADE
#undef PAIR_RECORD
#undef PAIR_SUMS
#undef PAIR_FOUND
#undef PAIR_POWER
#undef PAIR_CONSTANT
#undef PAIR_PACK
#undef PAIR_BEFORE
#undef PAIR_STRESS
#undef PAIR_STRESS_ADDED
#undef PAIR_FORCE
#undef PAIR_SUMMED
#undef PAIR_FINISH
#undef TIME_STEP_LIMIT
