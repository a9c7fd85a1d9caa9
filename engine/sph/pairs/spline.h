/* The cubic spline W(r, h) of support 2h in three dimensions. Monaghan & Lattanzio 1985. */
#ifndef CLAST_ENGINE_SPH_PAIRS_SPLINE_H
#define CLAST_ENGINE_SPH_PAIRS_SPLINE_H

#define SPH_SPLINE_NORM 0.31830988618379067154 /* 1/pi */

/* W, 1/m^3. */
static inline double sph_spline(double r, double h) {
  const double q = r / h, t = 2 - q, norm = SPH_SPLINE_NORM / (h * h * h);
  if (q < 1)
    return norm * (1 - 1.5 * q * q + 0.75 * q * q * q);
  return q < 2 ? norm * 0.25 * t * t * t : 0;
}

/* (dW/dr)/r, 1/m^5; finite at r = 0. */
static inline double sph_spline_slope(double r, double h) {
  const double q = r / h, t = 2 - q, norm = SPH_SPLINE_NORM / (h * h * h * h * h);
  if (q < 1)
    return norm * (2.25 * q - 3);
  return q < 2 ? -norm * 0.75 * t * t / q : 0;
}

#endif
