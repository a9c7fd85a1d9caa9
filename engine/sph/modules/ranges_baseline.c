/* The range loops for CPU class baseline. */
#define RANGES_TABLE sph_ranges_baseline
#include "engine/sph/modules/ranges.h"
