/* The pair loop for CPU class v3. */
#if defined(__x86_64__) && defined(__GNUC__)
#pragma GCC target("arch=x86-64-v3")
#define WIDTH         32
#define KERNELS_TABLE sph_pairs_kernels_v3
#define KERNELS_NAME  "v3"
#include "engine/sph/pairs/pairs_kernels_body.h"
#endif
