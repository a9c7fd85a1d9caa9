#include "engine/sph/ranges.h"

#include <stdlib.h>
#include <string.h>

const struct sph_ranges *sph_ranges_choose(void) {
  const struct sph_ranges *best = &sph_ranges_baseline;
#ifdef __x86_64__
  const char *wanted = getenv("CLAST_CPU");
  const int limit = !wanted ? 4 : !strcmp(wanted, "baseline") ? 1 : !strcmp(wanted, "v3") ? 3 : 4;
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2") &&
                  __builtin_cpu_supports("bmi");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (v3 && limit >= 3) best = &sph_ranges_v3;
  if (v4 && limit >= 4) best = &sph_ranges_v4;
#endif
  return best;
}
