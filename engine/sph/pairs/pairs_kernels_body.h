/* All kernels of one CPU class. The including file sets WIDTH (bytes of a register), KERNELS_TABLE and KERNELS_NAME. */
#include "engine/sph/pairs/pairs.h"

/* The order matters: each header uses the names of those before it. */
/* clang-format off */
#define TEMPLATE_DOUBLE
#include "engine/sph/pairs/templates_on.h"
#include "engine/sph/pairs/vector.h"
#include "engine/sph/pairs/pairs_term.h"
#define SPH_PAIR_TERM
#include "engine/sph/modules/declarations.h"
#include "engine/sph/pairs/pairs_kernels_records.h"
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/templates_off.h"

#define TEMPLATE_FLOAT
#include "engine/sph/pairs/templates_on.h"
#include "engine/sph/pairs/vector.h"
#include "engine/sph/pairs/pairs_term.h"
#define SPH_PAIR_TERM
#include "engine/sph/modules/declarations.h"
#include "engine/sph/pairs/pairs_kernels_records.h"
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/templates_off.h"

#include "engine/sph/pairs/pairs_kernels_near.h"
/* clang-format on */

const struct sph_pair_kernels KERNELS_TABLE = {
    .name = KERNELS_NAME,
    .in_double = &record_kernels_double,
    .in_float = &record_kernels_float,
    .near_boxes = near_boxes,
    .near_particles = near_particles,
    .near_pairs = near_pairs,
#define PAIR_MADE(term, count) .make_##term = term##_make,
#define PAIR_FINISH(term)      .finish_##term = term##_finish,
#include "engine/sph/modules/declarations.h"
};
