/* Von Mises: S -> f S, f = min(1, Y/sqrt(3 J2)), J2 = S:S/2 [BA95 eqs. 8-10; eq. 9 lacks the root: only with it does S
 * land on the yield surface]. Y = Y0 (1 - u/u_melt), zero beyond. Where tension_limit stands for flaws, Y falls with
 * expansion as that does: torn matter has no strength. */
#ifndef CLAST_ENGINE_SPH_MODULES_YIELD_RANGE_H
#define CLAST_ENGINE_SPH_MODULES_YIELD_RANGE_H

#include "engine/sph/modules/range_tools.h"

RANGE_INLINE void yield_loop(struct sph_system *s, const struct sph_solid *body, struct sph_block *b, bool pores) {
  const double y0 = body->physics.material.yield_stress, melt = body->physics.material.melt_energy;
  const double softening = melt > 0 ? 1 / melt : 0; /* NaN: none */
  const double per_density = 1 / body->physics.material.density;
  const bool tears = !body->weibull && isfinite(body->physics.material.tension_limit);
  const double *energy = s->c.energy, *alpha = s->c.distention, *density = s->c.density;
  double *xx = s->c.stress[0], *xy = s->c.stress[1], *xz = s->c.stress[2], *yy = s->c.stress[3], *yz = s->c.stress[4];
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++) {
    const double of_solid = (pores ? alpha[i] : 1) * density[i] * per_density;
    const double whole = tears ? range_smaller(range_larger(10 * (of_solid - 0.9), 0), 1) : 1;
    const double y = whole * range_larger(y0 * (1 - energy[i] * softening), 0) / (pores ? alpha[i] : 1);
    const double J2 = xx[i] * xx[i] + yy[i] * yy[i] + xx[i] * yy[i] + xy[i] * xy[i] + xz[i] * xz[i] + yz[i] * yz[i];
    const double size2 = 3 * J2;
    const double f = size2 > y * y ? y / sqrt(size2) : 1;
    xx[i] *= f, xy[i] *= f, xz[i] *= f, yy[i] *= f, yz[i] *= f;
  }
}

/* With pores the stored S is the bulk one: |S| <= Y/alpha. */
RANGE_HOOK void yield_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  if (body->physics.porosity)
    yield_loop(s, body, b, true);
  else
    yield_loop(s, body, b, false);
}

#endif
