/* The range loops for CPU class v3. */
#if defined(__x86_64__) && defined(__GNUC__)
#pragma GCC target("arch=x86-64-v3")
#define RANGES_TABLE sph_ranges_v3
#include "engine/sph/modules/ranges.h"
#endif
