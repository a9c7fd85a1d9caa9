#include "engine/sph/pairs/pairs_kernels.h"

#include "engine/cpu_class.h"

const struct sph_pair_kernels *sph_pairs_kernels_choose(void) {
#ifdef __x86_64__
  const enum cpu_class best = cpu_class_choose();
  if (best == CPU_V4)
    return &sph_pairs_kernels_v4;
  if (best == CPU_V3)
    return &sph_pairs_kernels_v3;
#endif
  return &sph_pairs_kernels_baseline;
}
