/* The modules of the solid, in the order in which they act within a stage. This is the only list of them: the
 * descriptors (modules.c), the loops of every CPU class (ranges_body.h) and what modules declare (declarations.h)
 * follow.
 *
 *   elastic             first, because the others act on its stress
 *   tillotson, palpha   the last of them that is on sets the pressure
 *   yield, pressure_strength   the last of them that is on sets the yield limit
 *   tension_limit       after the modules that set the pressure and the yield limit, which it bounds
 *   weibull, fracture   last, because the stress that opens flaws is within the yield limit
 *   crack_cell          after fracture, whose R_s it sets for cells of particles
 *   crack_front         after fracture, whose thresholds, rates and caps it changes for the next step
 *   the rest            options of the pair loop, without loops here
 * motion.h is no module: it has the loops of every body.
 *
 * To add a module: NAME.c with its descriptor, NAME.h with what it declares and its loops, and a line below. */
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
/* clang-format on */

/* The combinations of terms for which the pair loop is compiled, in two precisions and three CPU classes: a name, and
 * the terms that are on. */
#define SPH_PAIR_COMBINATIONS(COMBINATION)                                                                             \
  COMBINATION(plain, 0)                                                                                                \
  COMBINATION(artificial, .artificial_stress = true)                                                                   \
  COMBINATION(corrected, .gradient_correction = true)                                                                  \
  COMBINATION(both, .artificial_stress = true, .gradient_correction = true)
