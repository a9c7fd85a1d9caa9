/* Pressure and sound speed of one particle. */
#include "engine/sph/material/material.h"

#include <math.h>

struct branch {
  double p, by_rho, by_u;
};

static struct branch compressed(const struct sph_tillotson_material *t, double rho0, double rho, double u) {
  double eta = rho / rho0, mu = eta - 1;
  double B = eta < 1 ? 0 : t->B;
  double e = t->E0 * eta * eta, w = u / e + 1;
  double bw = t->b / w;
  struct branch c;
  c.p = (t->a + bw) * rho * u + t->A * mu + B * mu * mu;
  /* dw/drho = -2 u/(e rho), dw/du = 1/e */
  c.by_rho = (t->a + bw) * u + bw / w * 2 * u / e * u + (t->A + 2 * B * mu) / rho0;
  c.by_u = (t->a + bw) * rho - bw / w * rho * u / e;
  return c;
}

static struct branch expanded(const struct sph_tillotson_material *t, double rho0, double rho, double u) {
  double eta = rho / rho0, mu = eta - 1;
  double z = 1 / eta - 1;
  double e = t->E0 * eta * eta, w = u / e + 1;
  double hot = t->b * rho * u / w;
  double cold = t->A * mu * exp(-t->beta * z);
  double decay = exp(-t->alpha * z * z);
  double dz = -rho0 / (rho * rho); /* dz/drho */
  double hot_by_rho = t->b * u / w + hot / w * 2 * u / (e * rho);
  double cold_by_rho = t->A / rho0 * exp(-t->beta * z) - cold * t->beta * dz;
  struct branch x;
  x.p = t->a * rho * u + (hot + cold) * decay;
  x.by_rho = t->a * u + (hot_by_rho + cold_by_rho - (hot + cold) * 2 * t->alpha * z * dz) * decay;
  x.by_u = t->a * rho + (t->b * rho / w - hot / (w * e)) * decay;
  return x;
}

struct sph_pressure sph_tillotson(const struct sph_tillotson_material *t, double rho0, double rho, double u) {
  if (u < 0)
    u = 0;
  struct branch r;
  if (rho >= rho0 || u <= t->E_iv) {
    r = compressed(t, rho0, rho, u);
  } else if (u >= t->E_cv) {
    r = expanded(t, rho0, rho, u);
  } else {
    struct branch c = compressed(t, rho0, rho, u), x = expanded(t, rho0, rho, u);
    double range = 1 / (t->E_cv - t->E_iv);
    double wx = (u - t->E_iv) * range, wc = (t->E_cv - u) * range;
    r.p = wx * x.p + wc * c.p;
    r.by_rho = wx * x.by_rho + wc * c.by_rho;
    r.by_u = wx * x.by_u + wc * c.by_u + (x.p - c.p) * range;
  }
  double c2 = r.by_rho + r.p / (rho * rho) * r.by_u;
  double floor2 = t->A / (4 * rho0);
  return (struct sph_pressure){r.p, r.by_rho, r.by_u, sqrt(c2 > floor2 ? c2 : floor2)};
}
