/* The range loops for CPU class v4. */
#if defined(__x86_64__) && defined(__GNUC__)
#pragma GCC target("arch=x86-64-v4")
#define LANES         8
#define KERNELS_TABLE dem_kernels_v4
#define KERNELS_NAME  "v4"
#include "engine/dem/step/kernels_body.h"
#endif
