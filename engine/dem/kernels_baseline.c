/* The range loops for CPU class baseline. */
#define LANES         2
#define KERNELS_TABLE dem_kernels_baseline
#define KERNELS_NAME  "baseline"
#include "engine/dem/kernels.h"

#include "engine/dem/kernels_body.h"
