#include "engine/sph/step/limits.h"

#include <math.h>

double sph_limits_step(const struct sph_system *s, double until, int *limiter) {
  double inverse = 0;
  *limiter = SPH_LIMIT_COURANT;
  for (int k = 0; k < SPH_LIMITS; k++)
    if (s->now.worst[k] > inverse) {
      inverse = s->now.worst[k];
      *limiter = k;
    }
  double dt = 1 / inverse;
  if (dt > s->domain.largest_time_step) {
    dt = s->domain.largest_time_step;
    *limiter = SPH_LIMIT_GIVEN;
  }
  if (dt >= until - s->now.time) {
    dt = until - s->now.time;
    *limiter = SPH_LIMIT_END;
  }
  return dt;
}
