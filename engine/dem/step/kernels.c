#include "engine/dem/step/kernels.h"

#include "engine/cpu_class.h"

const struct dem_kernels *dem_kernels_choose(void) {
#ifdef __x86_64__
  const enum cpu_class best = cpu_class_choose();
  if (best == CPU_V4)
    return &dem_kernels_v4;
  if (best == CPU_V3)
    return &dem_kernels_v3;
#endif
  return &dem_kernels_baseline;
}
