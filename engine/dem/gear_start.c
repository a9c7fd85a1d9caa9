#include "engine/dem/gear_start.h"

bool dem_gear_start(struct dem_system *s) {
  const double half = 0.5 * s->p.time_step * s->p.time_step;
  const double *const force[3] = {s->c.fx, s->c.fy, s->c.torque};
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  for (int k = 0; k < 3; ++k)
    for (size_t g = 0; g < s->padded; ++g)
      s->c.gear[k][2][g] = half * force[k][g] * mobility[k][g];
  return true;
}
