/* All kernels of one CPU class. The including file sets WIDTH (bytes of a register), KERNELS_TABLE and KERNELS_NAME. */
#include "engine/sph/pairs/pairs_kernels.h"
#include "engine/sph/pairs/spline.h"

/* The order matters: each header uses the names of those before it. */
/* clang-format off */
#define TEMPLATE_DOUBLE
#include "engine/sph/pairs/templates_on.h"
#include "engine/sph/pairs/vector.h"
#include "engine/sph/pairs/pairs_kernels_correct.h"
#include "engine/sph/pairs/pairs_kernels_tension.h"
#include "engine/sph/pairs/pairs_kernels_records.h"
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/pairs_kernels_pack.h"
#include "engine/sph/pairs/templates_off.h"

#define TEMPLATE_FLOAT
#include "engine/sph/pairs/templates_on.h"
#include "engine/sph/pairs/vector.h"
#include "engine/sph/pairs/pairs_kernels_records.h"
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/pairs_kernels_pack.h"
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
    .correct = correct,
    .oppose = oppose,
};
