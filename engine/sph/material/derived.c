/* Elastic constants, wave speeds and crack speeds that follow from a material. */
#include "engine/sph/material/derived.h"

#include <math.h>

double sph_derived_bulk_modulus(const struct sph_material *m) {
  return m->elastic.bulk_modulus > 0 ? m->elastic.bulk_modulus : m->tillotson.A;
}

double sph_derived_young_modulus(const struct sph_material *m) {
  const double K = sph_derived_bulk_modulus(m);
  return 9 * K * m->elastic.shear_modulus / (3 * K + m->elastic.shear_modulus);
}

double sph_derived_poisson_ratio(const struct sph_material *m) {
  const double K = sph_derived_bulk_modulus(m);
  return (3 * K - 2 * m->elastic.shear_modulus) / (2 * (3 * K + m->elastic.shear_modulus));
}

double sph_derived_crack_speed(const struct sph_material *m) {
  return 0.4 * sqrt((sph_derived_bulk_modulus(m) + 4 * m->elastic.shear_modulus / 3) / m->density);
}

double sph_derived_solid_ratio(const struct sph_material *m) {
  return m->palpha.curve != SPH_CRUSH_NONE && m->palpha.distention > 1 ? m->palpha.distention : 1;
}

double sph_derived_bulk_density(const struct sph_material *m) {
  return m->density / sph_derived_solid_ratio(m);
}

/* The pressure responds with A, even where K is given. */
double sph_derived_longitudinal_speed(const struct sph_material *m, bool strength) {
  const double shear2 = strength ? 4.0 / 3 * m->elastic.shear_modulus / m->density : 0;
  double bulk2 = m->tillotson.A / m->density;
  if (sph_derived_solid_ratio(m) > 1 && !isnan(m->palpha.sound_speed))
    bulk2 = m->palpha.sound_speed * m->palpha.sound_speed;
  return sqrt(bulk2 + shear2);
}
