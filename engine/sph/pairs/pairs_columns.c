/* How the pair loop reads and writes columns: units of float records, sources and sinks of records, constants. */
#include <math.h>

#include "engine/sph/pairs/pairs_layout.h"
#include "engine/sph/pairs/spline.h"

enum { ROW_POWER = 14, ROW_CORRECTION = 15 }; /* rows of a buffer behind those of enum sph_pair_sum */

static double power_of_two(double x) {
  int exponent;
  if (!(x > 0) || !isfinite(x))
    return 1;
  frexp(x, &exponent);
  return ldexp(1, exponent);
}

void sph_pairs_columns_units(struct sph_pairs *p, size_t n, const struct sph_pair_fields *f) {
  struct sph_pairs_units *u = &p->units;
  double h = 0, density = 0, sound = 0;
  for (size_t i = 0; i < n; i++) {
    h = f->h[i] > h ? f->h[i] : h;
    density = f->density[i] > density ? f->density[i] : density;
    sound = f->sound_speed[i] > sound ? f->sound_speed[i] : sound;
  }
  u->length = power_of_two(h);
  u->density = power_of_two(density);
  u->velocity = power_of_two(sound);
  u->mass = u->density * u->length * u->length * u->length;
  u->specific = u->velocity * u->velocity / u->density;
  u->per_length = 1 / u->length;
  u->per_mass = 1 / u->mass;
  u->per_velocity = 1 / u->velocity;
  u->per_density = 1 / u->density;
  u->per_specific = 1 / u->specific;
  p->units_chosen = true;
}

struct sph_pair_source sph_pairs_columns_source(const struct sph_pairs *p, const struct sph_pair_fields *f) {
  const struct sph_pairs_units *u = &p->units;
  struct sph_pair_source s = {
      .column = {f->x, f->y, f->z, f->h, f->vx, f->vy, f->vz, f->mass},
      .scale = {1, 1, 1, 0.5 / (p->single ? p->h_unit : 1), u->per_velocity, u->per_velocity, u->per_velocity,
                u->per_mass},
      .pressure = f->pressure_term,
      .stress_factor = f->stress_factor,
      .volume_weights = p->options.method.volume_weights,
  };
  s.column[PAIR_SOUND] = f->sound_speed;
  s.scale[PAIR_SOUND] = u->per_velocity;
  s.column[PAIR_DENSITY] = f->density;
  s.scale[PAIR_DENSITY] = u->per_density;
  for (int k = 0; k < 6; k++) {
    s.column[PAIR_XX + k] = p->options.strength && k < 5 ? f->stress[k] : NULL;
    s.column[PAIR_ARTIFICIAL + k] = p->opposed[k];
    s.scale[PAIR_XX + k] = u->per_specific;
    s.scale[PAIR_ARTIFICIAL + k] = u->per_specific;
    s.correction[k] = p->corrected ? f->correction[k] : NULL;
  }
  for (int d = 0; d < 3; d++)
    s.per_unit[d] = 1 / p->unit[d];
  return s;
}

struct sph_pair_sums sph_pairs_columns_sums(const struct sph_pairs *p, double *buffer) {
  struct sph_pair_sums s = {.ax = buffer,
                            .ay = buffer + SPH_PAIRS_ROW,
                            .az = buffer + 2 * SPH_PAIRS_ROW,
                            .heating = buffer + SUM_HEATING * SPH_PAIRS_ROW,
                            .signal = buffer + SUM_SIGNAL * SPH_PAIRS_ROW};
  for (size_t k = 0; k < 9; k++)
    s.gradient[k] = buffer + (SUM_GRADIENT + k) * SPH_PAIRS_ROW;
  if (!p->corrected)
    return s;
  s.power = buffer + ROW_POWER * SPH_PAIRS_ROW;
  for (size_t k = 0; k < 6; k++)
    s.correction[k] = buffer + (ROW_CORRECTION + k) * SPH_PAIRS_ROW;
  return s;
}

struct sph_pair_sink sph_pairs_columns_sink(const struct sph_pairs *p, const struct sph_pair_sums *sums) {
  const struct sph_pairs_units *u = &p->units;
  const double acceleration = u->velocity * u->velocity / u->length;
  struct sph_pair_sink s = {.column = {sums->ax, sums->ay, sums->az},
                            .scale = {acceleration, acceleration, acceleration},
                            .mass_unit = u->mass,
                            .density_unit = u->density,
                            .volume_weights = p->options.method.volume_weights};
  for (int k = 0; k < 9; k++) {
    s.column[SUM_GRADIENT + k] = sums->gradient[k];
    s.scale[SUM_GRADIENT + k] = u->velocity / u->length;
  }
  s.column[SUM_HEATING] = sums->heating;
  s.scale[SUM_HEATING] = -0.5 * acceleration * u->velocity;
  s.column[SUM_SIGNAL] = sums->signal;
  s.scale[SUM_SIGNAL] = u->velocity;
  for (int k = 0; k < 6 && p->corrected; k++) {
    s.column[SUM_MOMENT + k] = sums->correction[k];
    s.scale[SUM_MOMENT + k] = p->single ? -p->h_unit / u->length : -1;
  }
  return s;
}

struct sph_pair_constants sph_pairs_columns_constants(const struct sph_pairs *p) {
  const struct sph_pair_options *o = &p->options;
  struct sph_pair_constants c = {.alpha = o->viscosity.alpha,
                                 .twice_beta = 2 * o->viscosity.beta,
                                 .spline_at_spacing = sph_spline(o->spacing_over_h, 1) / SPH_SPLINE_NORM,
                                 .norm = SPH_SPLINE_NORM * (p->single ? pow(p->units.length / p->h_unit, 4) : 1),
                                 .strength = o->strength,
                                 .volume_weights = o->method.volume_weights};
  for (int d = 0; d < 3; d++) {
    c.periodic[d] = o->periodic[d];
    c.per_period[d] = 1 / o->periodic[d];
    c.unit[d] = p->unit[d] / p->h_unit;
    c.wrapped |= !isnan(o->periodic[d]);
  }
  return c;
}
