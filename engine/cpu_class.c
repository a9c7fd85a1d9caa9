#include "engine/cpu_class.h"

#include <stdlib.h>
#include <string.h>

enum cpu_class cpu_class_choose(void) {
#ifdef __x86_64__
  const char *wanted = getenv("CLAST_CPU");
  const int limit = !wanted ? 4 : !strcmp(wanted, "baseline") ? 1 : !strcmp(wanted, "v3") ? 3 : 4;
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2") &&
                  __builtin_cpu_supports("bmi");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (v4 && limit >= 4) return CPU_V4;
  if (v3 && limit >= 3) return CPU_V3;
#endif
  return CPU_BASELINE;
}

bool cpu_class_known(const char *name) {
  return !strcmp(name, "baseline") || !strcmp(name, "v3") || !strcmp(name, "v4");
}

const char *cpu_class_name(enum cpu_class class) {
  return class == CPU_V4 ? "v4" : class == CPU_V3 ? "v3" : "baseline";
}
