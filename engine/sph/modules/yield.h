/* Von Mises: Y = Y0 (1 - u/u_melt), zero beyond, as the yield limit of each particle [BA95 eqs. 8-10]. A yield law only
 * writes the limit; `elastic` brings the stress back to it. */

MODULE(yield)
MODULE_HOOKS(yield)
MODULE_MATERIAL(yield)

#ifdef SPH_MODULE_STRUCTS
struct sph_yield_material {
  double stress; /* Pa at u = 0; NaN or INFINITY: never yields */
};
#endif

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/range_tools.h"

RANGE_HOOK void yield_limit(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double y0 = body->physics.material.yield.stress, melt = body->physics.material.melt_energy;
  const double softening = melt > 0 ? 1 / melt : 0; /* NaN: none */
  const double *energy = s->c.energy + b->low;
  double *limit = b->terms->yield_limit;
  const size_t n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    limit[k] = range_larger(y0 * (1 - energy[k] * softening), 0);
}

static const sph_hook yield_hooks[SPH_STAGES] = {[SPH_YIELD] = yield_limit};

#endif
