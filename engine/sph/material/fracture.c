/* The largest principal tension, the growth rate of damage and its cap. */
#include "engine/sph/material/fracture.h"

#include <math.h>

/* Trigonometric solution of the characteristic cubic (Smith 1961, Commun. ACM 4, 168), scaled by the tensor's size. */
double sph_fracture_largest_tension(double xx, double xy, double xz, double yy, double yz, double zz) {
  double mean = (xx + yy + zz) / 3;
  double a = xx - mean, b = yy - mean, c = zz - mean;
  double p2 = (a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6;
  if (!(p2 > 0))
    return mean;
  double p = sqrt(p2);
  a /= p, b /= p, c /= p, xy /= p, xz /= p, yz /= p;
  double half_det = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / 2;
  double angle = half_det <= -1 ? M_PI / 3 : half_det >= 1 ? 0 : acos(half_det) / 3;
  return mean + 2 * p * cos(angle);
}

double sph_fracture_rate(size_t active, int growth) {
  const double n = (double)active;
  return growth == SPH_GROWTH_LINEAR ? n : cbrt(n);
}

double sph_fracture_limit(size_t active, size_t total, int cap) {
  const double share = (double)active / (double)total;
  return cap == SPH_CAP_BA95    ? cbrt(cbrt(share)) /* D_max = share^(1/3), and the state is its cube root */
         : cap == SPH_CAP_COUNT ? cbrt(share)
                                : 1;
}
