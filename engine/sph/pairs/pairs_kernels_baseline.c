/* The pair loop for any CPU. */
#define WIDTH         16
#define KERNELS_TABLE sph_pairs_kernels_baseline
#define KERNELS_NAME  "baseline"
#include "engine/sph/pairs/pairs_kernels_body.h"
