/* The choice of the CPU class for the hot loops. */
#include "engine/cpu_class.h"

#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name;
  enum cpu_class class;
} classes[] = {{"baseline", CPU_BASELINE}, {"v3", CPU_V3}, {"v4", CPU_V4}};
enum { CLASSES = sizeof classes / sizeof classes[0] };

static int find(const char *name) {
  for (int k = 0; k < CLASSES; k++)
    if (strcmp(name, classes[k].name) == 0)
      return k;
  return CLASSES;
}

enum cpu_class cpu_class_choose(void) {
#ifdef __x86_64__
  const char *wanted = getenv("CLAST_CPU");
  const enum cpu_class limit = wanted && cpu_class_known(wanted) ? classes[find(wanted)].class : CPU_V4;
  __builtin_cpu_init();
#define HAS(feature) (__builtin_cpu_supports(feature) != 0)
  const bool v3 = HAS("avx2") & HAS("fma") & HAS("bmi2") & HAS("bmi");
  const bool v4 = v3 & HAS("avx512f") & HAS("avx512bw") & HAS("avx512cd") & HAS("avx512dq") & HAS("avx512vl");
#undef HAS
  if (v4 && limit >= CPU_V4)
    return CPU_V4;
  if (v3 && limit >= CPU_V3)
    return CPU_V3;
#endif
  return CPU_BASELINE;
}

bool cpu_class_known(const char *name) {
  return find(name) < CLASSES;
}

const char *cpu_class_name(enum cpu_class class) {
  int k = 0;
  while (classes[k].class != class)
    k++;
  return classes[k].name;
}
