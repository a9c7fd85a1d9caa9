/* Tillotson pressure and sound speed over a range. Nearly all matter is cold or compressed. That branch, which has no
 * transcendental function, is computed for all particles; the few hot, expanded ones are computed again by the general
 * form. */

MODULE(tillotson)
MODULE_HOOKS(tillotson)
MODULE_MATERIAL(tillotson)

#ifdef SPH_MODULE_STRUCTS
/* Tillotson 1962; Melosh 1989, appendix II. */
struct sph_tillotson_material {
  double A, B;           /* Pa: bulk modulus and its non-linear companion */
  double a, b;           /* 1 */
  double alpha, beta;    /* 1: decay in hot expansion (not the exponent of a spectrum) */
  double E0, E_iv, E_cv; /* J/kg: reference, incipient and complete vaporisation */
};
#endif

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/material/tillotson.h"
#include "engine/sph/modules/range_tools.h"

RANGE_HOOK void tillotson_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const struct sph_tillotson_material t = body->physics.material.tillotson;
  const double density0 = body->physics.material.density, inverse0 = 1 / density0, floor2 = t.A / (4 * density0);
  const double *density = s->c.density, *energy = s->c.energy;
  double *pressure = s->c.pressure, *sound_speed = s->c.sound_speed;
  int64_t hot = 0;
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++) {
    const double rho = density[i], u = range_larger(energy[i], 0);
    const double eta = rho * inverse0, mu = eta - 1, B = mu < 0 ? 0 : t.B;
    const double e = t.E0 * eta * eta, q = 1 / (u + e), w = t.b * e * q; /* w = b/(u/e + 1) */
    const double p = (t.a + w) * rho * u + (t.A + B * mu) * mu;
    const double by_density = (t.a + w) * u + 2 * w * q * u * u + (t.A + 2 * B * mu) * inverse0;
    const double by_energy = rho * (t.a + w - w * q * u);
    const double c2 = by_density + p / (rho * rho) * by_energy;
    pressure[i] = p;
    sound_speed[i] = sqrt(range_larger(c2, floor2));
    hot |= -(int64_t)(rho < density0) & -(int64_t)(u > t.E_iv);
  }
  if (!hot)
    return;
  for (size_t i = b->low; i < b->high; i++)
    if (density[i] < density0 && energy[i] > t.E_iv) {
      const struct sph_pressure r = sph_tillotson(&t, density0, density[i], energy[i]);
      pressure[i] = r.pressure;
      sound_speed[i] = r.sound_speed;
    }
}

static const sph_hook tillotson_hooks[SPH_STAGES] = {[SPH_RESPOND] = tillotson_range};

#endif
