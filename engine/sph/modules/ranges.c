/* The CPU class whose loops this process runs. */
#include "engine/sph/modules/ranges.h"

#include "engine/cpu_class.h"

const struct sph_ranges *sph_ranges_choose(void) {
#ifdef __x86_64__
  const enum cpu_class best = cpu_class_choose();
  if (best == CPU_V4)
    return &sph_ranges_v4;
  if (best == CPU_V3)
    return &sph_ranges_v3;
#endif
  return &sph_ranges_baseline;
}
