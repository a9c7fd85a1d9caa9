/* The modules of the solid, in the order in which they act within a stage. This is the only list of them: the
 * descriptors (modules.c) and the loops of every CPU class (ranges_body.h, which defines SPH_MODULE_LOOPS) follow.
 *
 *   elastic             first, because the others act on its stress
 *   tillotson, palpha   the last of them that is on sets the pressure
 *   yield, pressure_strength   the last of them that is on sets the yield limit
 *   tension_limit       after the modules that set the pressure and the yield limit, which it bounds
 *   weibull, fracture   last, because the stress that opens flaws is within the yield limit
 *   crack_cell          after fracture, whose R_s it sets for cells of particles
 *   crack_front         after fracture, whose thresholds, rates and caps it changes for the next step
 *   the rest            options of the pair loop, without loops here
 *
 * To add a module: NAME.c with its descriptor, NAME_loop.h with its loops, and a line in each of the two lists below.
 * Values that it needs of a material are rows of material/material.h. */
#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/crack_front_loop.h"
#include "engine/sph/modules/elastic_loop.h"
#include "engine/sph/modules/fracture_loop.h"
#include "engine/sph/modules/palpha_loop.h"
#include "engine/sph/modules/pressure_strength_loop.h"
#include "engine/sph/modules/tension_limit_loop.h"
#include "engine/sph/modules/tillotson_loop.h"
#include "engine/sph/modules/yield_loop.h"

#else

#define SPH_MODULE_LIST(WITH_LOOPS, WITHOUT)                                                                           \
  WITH_LOOPS(elastic)                                                                                                  \
  WITH_LOOPS(tillotson)                                                                                                \
  WITH_LOOPS(palpha)                                                                                                   \
  WITH_LOOPS(yield)                                                                                                    \
  WITH_LOOPS(pressure_strength)                                                                                        \
  WITH_LOOPS(tension_limit)                                                                                            \
  WITHOUT(weibull)                                                                                                     \
  WITH_LOOPS(fracture)                                                                                                 \
  WITHOUT(crack_cell)                                                                                                  \
  WITH_LOOPS(crack_front)                                                                                              \
  WITHOUT(viscosity)                                                                                                   \
  WITHOUT(artificial_stress)                                                                                           \
  WITHOUT(gradient_correction)

#endif
