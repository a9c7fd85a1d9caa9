/* The range loops for CPU class baseline. */
#define LANES         2
#define KERNELS_TABLE dem_kernels_baseline
#define KERNELS_NAME  "baseline"
#include "engine/dem/step/kernels_body.h"
