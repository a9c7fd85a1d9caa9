/* The bound of tension in bodies without flaws. It falls with the expansion of the solid matter, and the yield limit
 * with it. */

MODULE(tension_limit)
MODULE_HOOKS(tension_limit)
MODULE_MATERIAL(tension_limit)

#ifdef SPH_MODULE_STRUCTS
struct sph_tension_limit_material {
  double pressure; /* Pa; NaN: off */
};
#endif

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/range_tools.h"

/* 1 at the density at rest, 0 from 0.9 of it down: torn matter neither pulls nor shears. */
RANGE_INLINE double tension_limit_whole(double relative_density) {
  return range_smaller(range_larger(10 * (relative_density - 0.9), 0), 1);
}

/* P >= -tension_limit. */
RANGE_HOOK void tension_limit_pressure(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double lowest = -body->physics.material.tension_limit.pressure,
               per_density = 1 / body->physics.material.density;
  const double *density = b->terms->solid_density;
  double *pressure = s->c.pressure;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    pressure[low + k] = range_larger(pressure[low + k], lowest * tension_limit_whole(density[k] * per_density));
}

RANGE_HOOK void tension_limit_yield(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)s;
  const double per_density = 1 / body->physics.material.density, *density = b->terms->solid_density;
  double *limit = b->terms->yield_limit;
  const size_t n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    limit[k] *= tension_limit_whole(density[k] * per_density);
}

static const sph_hook tension_limit_hooks[SPH_STAGES] =
    {[SPH_LIMIT] = tension_limit_pressure, [SPH_YIELD] = tension_limit_yield};

#endif
