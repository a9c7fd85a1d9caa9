#include "engine/sph/fracture.h"

#include <math.h>

/* Trigonometric solution of the characteristic cubic (Smith 1961, Commun. ACM 4, 168), scaled by the tensor's size. */
double sph_fracture_largest_tension(double xx, double xy, double xz, double yy, double yz, double zz) {
  double mean = (xx + yy + zz) / 3;
  double a = xx - mean, b = yy - mean, c = zz - mean;
  double p2 = (a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6;
  if (!(p2 > 0)) return mean;
  double p = sqrt(p2);
  a /= p, b /= p, c /= p, xy /= p, xz /= p, yz /= p;
  double half_det = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / 2;
  double angle = half_det <= -1 ? acos(-1.0) / 3 : half_det >= 1 ? 0 : acos(half_det) / 3;
  return mean + 2 * p * cos(angle);
}

double sph_fracture_strain(double tension, double damage, double young_modulus) {
  double left = 1 - damage;
  return tension > 0 && left > 0 ? tension / (left * young_modulus) : 0;
}

double sph_fracture_grow(double damage_cbrt, size_t active, size_t total, int growth, int cap, double rate, double dt) {
  if (!active) return damage_cbrt;
  double n = (double)active, share = n / (double)total;
  double grown = damage_cbrt + (growth == SPH_GROWTH_LINEAR ? n : cbrt(n)) * rate * dt;
  double limit = 1;
  if (cap == SPH_CAP_BA95)
    limit = cbrt(cbrt(share)); /* D_max = share^(1/3), and the state is its cube root */
  else if (cap == SPH_CAP_COUNT)
    limit = cbrt(share);
  if (grown > limit) grown = limit;
  return grown > damage_cbrt ? grown : damage_cbrt;
}
