/* An entry of the log of broken beams. */
#ifndef CLAST_ENGINE_DEM_BEAMS_BREAK_H
#define CLAST_ENGINE_DEM_BEAMS_BREAK_H

#include <stdbool.h>
#include <stdint.h>

struct dem_break {
  double time;             /* s */
  uint32_t beam;           /* index into the tessellation's pairs */
  double strain, angle[2]; /* angle: rotations of the two ends, rad */
  bool bending;            /* mode: the bending term was the larger one */
};

#endif
