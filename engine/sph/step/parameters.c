#include <math.h>

#include "engine/sph/step/system.h"

struct sph_parameters sph_parameters_default(void) {
  return (struct sph_parameters){
      .viscosity_alpha = 1.5,
      .viscosity_beta = 3,
      .spacing_over_h = 0.95,
      .cfl = 0.3,
      .damage_step = 0.2,
      .distention_step = 0.01,
      .largest_time_step = NAN,
      .growth = SPH_GROWTH_CUBE_ROOT,
      .cap = SPH_CAP_BA95,
      .h_lowest = 0.5,
      .h_highest = 2,
      .density_lowest = 0.03, /* a particle alone, m W(0): h stays within twice its first size. Thinner ones have
                                 P/rho^2 without bound */
      .skin = 0.05,
      .periodic = {NAN, NAN, NAN},
      .precision = SPH_DOUBLE,
      .threads = 1,
  };
}
