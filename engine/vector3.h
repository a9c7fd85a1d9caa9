/* Vectors of three components, for the geometry of shapes and meshes. The order of the sums affects the bits of
 * results. */
#pragma once

#include <math.h>

static inline double vector3_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector3_subtract(const double a[3], const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = a[k] - b[k];
}

/* `out` is neither a nor b. */
static inline void vector3_cross(const double a[3], const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* The unit vector along a; `out` may be a, and stays as it is when a has no direction. Returns the length of a. Scales
 * first, so that no length overflows. */
static inline double vector3_unit(const double a[3], double out[3]) {
  const double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
  if (!(largest > 0) || !isfinite(largest))
    return 0;
  const double scaled[3] = {a[0] / largest, a[1] / largest, a[2] / largest};
  const double length = sqrt(vector3_dot(scaled, scaled));
  for (int k = 0; k < 3; k++)
    out[k] = scaled[k] / length;
  return length * largest;
}
