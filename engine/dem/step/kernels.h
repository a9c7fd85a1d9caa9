/* The loops over whole ranges, compiled once per CPU class and chosen at run time.
 *
 * Which class, and what that means for bits, is said in engine/cpu_class.h. */
#ifndef CLAST_ENGINE_DEM_STEP_KERNELS_H
#define CLAST_ENGINE_DEM_STEP_KERNELS_H

#include "engine/dem/contacts/overlap_types.h"
#include "engine/dem/step/system_layout.h"

struct dem_kernels {
  const char *name; /* "baseline", "v3" (AVX2, FMA), "v4" (AVX-512): x86-64 microarchitecture levels */
  void (*rest)(struct dem_system *system);    /* bond blocks: the positions now are the beams' rest state */
  void (*forces)(struct dem_system *system);  /* bond blocks, near blocks, general overlaps into fx, fy, torque */
  void (*measure)(struct dem_system *system); /* sums.beam, sums.contact, sums.overlaps; changes nothing else */
  bool (*verlet_drift)(struct dem_system *system, bool *moved); /* false: not finite; moved: the list is worn out */
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

const struct dem_kernels *dem_kernels_choose(void);

#endif
