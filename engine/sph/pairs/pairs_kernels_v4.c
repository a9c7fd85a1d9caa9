/* The pair loop for CPU class v4. */
#if defined(__x86_64__) && defined(__GNUC__)
#pragma GCC target("arch=x86-64-v4")
#define WIDTH         64
#define KERNELS_TABLE sph_pairs_kernels_v4
#define KERNELS_NAME  "v4"
#include "engine/sph/pairs/pairs_kernels_body.h"
#endif
