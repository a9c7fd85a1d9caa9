/* The range loops for CPU class v3. */
#if defined(__x86_64__) && defined(__GNUC__)
#pragma GCC target("arch=x86-64-v3")
#define LANES         4
#define KERNELS_TABLE dem_kernels_v3
#define KERNELS_NAME  "v3"
#include "engine/dem/step/kernels_body.h"
#endif
