/* The loops over whole ranges. They are compiled once per CPU class and chosen at run time; engine/cpu_class.h says
 * when results are bit-identical. */
#ifndef CLAST_ENGINE_DEM_STEP_KERNELS_H
#define CLAST_ENGINE_DEM_STEP_KERNELS_H

#include "engine/cpu_class.h"
#include "engine/dem/step/system_layout.h"

struct dem_kernels {
  const char *name;                           /* of the CPU class */
  void (*rest)(struct dem_system *system);    /* takes the positions now as the rest state of the beams */
  void (*forces)(struct dem_system *system);  /* of beams and contacts, into fx, fy, torque */
  void (*measure)(struct dem_system *system); /* fills sums.beam, sums.contact, sums.overlaps */
  bool (*verlet_drift)(struct dem_system *system, bool *moved); /* false: not finite; moved: the lists end */
  void (*verlet_kick)(struct dem_system *system);
  bool (*gear_predict)(struct dem_system *system, bool *moved);
  void (*gear_correct)(struct dem_system *system);
  void (*turn)(struct dem_system *system); /* cosine and sine from the angles */
  void (*best_side)(const struct dem_ring ring[2], struct dem_overlap *out);
  void (*overlap)(struct dem_ring ring[2], struct dem_overlap *out); /* moves the rings' origin */
};

extern const struct dem_kernels dem_kernels_baseline;
#ifdef __x86_64__
extern const struct dem_kernels dem_kernels_v3, dem_kernels_v4;
#endif

/* The kernels of the CPU class that this run uses. */
static inline const struct dem_kernels *dem_kernels_choose(void) {
#ifdef __x86_64__
  const enum cpu_class best = cpu_class_choose();
  if (best == CPU_V4)
    return &dem_kernels_v4;
  if (best == CPU_V3)
    return &dem_kernels_v3;
#endif
  return &dem_kernels_baseline;
}

#endif
