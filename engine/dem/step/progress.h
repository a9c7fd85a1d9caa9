/* How far a moving system has come. */
#pragma once

#include <stdint.h>

/* Values that change from step to step and are not arrays. */
struct dem_progress {
  double time, last_break; /* s; last_break: 0 before any */
  /* Largest speed so far, m/s, at which two grains without a beam between them came near each other on paths that meet:
   * centres within a mean diameter. */
  double fastest_approach;
  uint64_t steps, rebuilds;
  double contact, damping, friction, broken_beam,
      external_work; /* booked so far, J/m (contact: laws that store none) */
  double begun;      /* J/m, of contacts that began with a break; a part of broken_beam, with the other sign */
  uint64_t break_count, bond_blocks, near_count;
  uint64_t ready; /* forces belong to the positions */
  uint64_t gear_started;
};
