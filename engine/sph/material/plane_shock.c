/* One or two fronts ahead of a piston, by bisection on the jump conditions. */
#include "engine/sph/material/palpha.h"

#include <math.h>
#include <stddef.h>

enum { HALVINGS = 100 }; /* of a bracket: to the last bit */
static const double most_pressure = 1e16;
static const struct sph_front none = {NAN, NAN, NAN, NAN, NAN, NAN};

struct matter {
  const struct sph_material *material;
  const struct sph_palpha_law *law; /* NULL: solid */
};

/* Distention of fresh matter that is loaded to P: the elastic branch, bounded by the crush curve. */
static double distention_at(const struct matter *m, double pressure) {
  if (!m->law)
    return 1;
  if (pressure >= m->law->given.solid_pressure)
    return 1;
  double elastic = sph_palpha_elastic(m->law, m->law->given.distention, pressure);
  return pressure > m->law->given.elastic_pressure ? fmin(elastic, sph_palpha_crush(m->law, pressure)) : elastic;
}

/* The front that takes matter from the state `ahead` to a pressure. The density is found by halving, because
 * P_s(alpha rho, u(rho)) rises with rho. */
static struct sph_front front_to(const struct matter *m, const struct sph_front *ahead, double pressure) {
  struct sph_front f = {.pressure = pressure, .distention = distention_at(m, pressure)};
  const struct sph_tillotson_material *t = &m->material->tillotson;
  double low = ahead->density, high = 20 * m->material->density, mean = (ahead->pressure + pressure) / 2;
  for (int k = 0; k < HALVINGS; k++) {
    f.density = (low + high) / 2;
    f.energy = ahead->energy + mean * (1 / ahead->density - 1 / f.density);
    if (sph_tillotson(t, m->material->density, f.distention * f.density, f.energy).pressure < f.distention * pressure)
      low = f.density;
    else
      high = f.density;
  }
  double jump = pressure - ahead->pressure, gain = sqrt(jump * (1 / ahead->density - 1 / f.density));
  f.velocity = ahead->velocity + gain;
  f.speed = ahead->velocity + jump / (ahead->density * gain);
  return f;
}

/* The front behind which matter moves with the piston. */
static struct sph_front front_of(const struct matter *m, const struct sph_front *ahead, double piston) {
  double low = fmax(ahead->pressure, 1e-6), high = most_pressure;
  for (int k = 0; k < HALVINGS; k++) {
    double middle = sqrt(low * high);
    if (front_to(m, ahead, middle).velocity < piston)
      low = middle;
    else
      high = middle;
  }
  return front_to(m, ahead, sqrt(low * high));
}

/* The fronts ahead of the piston: a precursor, a shock behind it, or both. */
static void find_fronts(const struct matter *m, const struct sph_front *rest, double piston,
                        struct sph_plane_shock *out) {
  const double elastic = m->law ? sph_palpha_crush_begin(m->law) : 0;
  if (elastic > 0) {
    out->precursor = front_to(m, rest, elastic);
    out->has_precursor = true;
    if (!(piston > out->precursor.velocity)) { /* too slow for a shock */
      out->precursor = front_of(m, rest, piston);
      return;
    }
    out->shock = front_of(m, &out->precursor, piston);
    out->has_shock = true;
    if (out->shock.speed < out->precursor.speed)
      return;
    out->precursor = none; /* the shock has overtaken it */
    out->has_precursor = false;
  }
  out->shock = front_of(m, rest, piston);
  out->has_shock = true;
}

status sph_plane_shock(const struct sph_material *material, double piston, struct sph_plane_shock *out,
                       struct error *error) {
  const bool porous = sph_material_solid_ratio(material) > 1;
  struct sph_palpha_law law;
  *out = (struct sph_plane_shock){.precursor = none, .shock = none};
  if (porous)
    TRY(sph_palpha_prepare(&material->palpha, material, &law, error));
  const struct matter m = {.material = material, .law = porous ? &law : NULL};
  struct sph_front rest = {.distention = porous ? law.given.distention : 1};
  rest.density = out->first_density = material->density / rest.distention;
  find_fronts(&m, &rest, piston, out);

  const struct sph_front *last = out->has_shock ? &out->shock : &out->precursor;
  const bool follows = fabs(last->velocity - piston) < 1e-6 * piston;
  if (!follows || !(last->speed > piston) || !(last->density > out->first_density))
    return status_fail(error, STATUS_CONTENT,
                       "no shock wave in this material gives it a speed of %.6g m/s: give another piston.speed",
                       piston);
  return STATUS_OK;
}

static void describe_front(const char *name, const struct sph_front *f, FILE *out) {
  fprintf(out, "  exact %s: %.6g m/s; behind it %.4g Pa, %.6g kg/m^3, distention %.6g, matter at %.4g m/s\n", name,
          f->speed, f->pressure, f->density, f->distention, f->velocity);
}

void sph_plane_shock_describe(const struct sph_plane_shock *shock, FILE *out) {
  if (shock->has_precursor)
    describe_front("elastic precursor", &shock->precursor, out);
  if (shock->has_shock)
    describe_front("shock", &shock->shock, out);
}
