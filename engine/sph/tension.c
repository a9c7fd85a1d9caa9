#include "engine/sph/tension.h"

#include <math.h>
#include <string.h>

/* Jacobi's rotations: a (symmetric, 3 x 3) becomes diagonal, the columns of v its axes. */
static void diagonalise(double a[3][3], double v[3][3]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      v[i][j] = i == j;
  for (int sweep = 0; sweep < 12; sweep++) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    if (!(off > 1e-32 * on)) return;
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; k++) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq, a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; k++) {
          const double pk = a[p][k], qk = a[q][k], vp = v[k][p], vq = v[k][q];
          a[p][k] = c * pk - s * qk, a[q][k] = s * pk + c * qk;
          v[k][p] = c * vp - s * vq, v[k][q] = s * vp + c * vq;
        }
      }
  }
}

void sph_tension_opposed(double epsilon, const double stress[6], double artificial[6]) {
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  double a[3][3], v[3][3];
  for (int k = 0; k < 6; k++)
    a[row[k]][column[k]] = a[column[k]][row[k]] = stress[k];
  memset(artificial, 0, 6 * sizeof *artificial);
  const double radius[3] = {fabs(stress[1]) + fabs(stress[2]), fabs(stress[1]) + fabs(stress[4]), fabs(stress[2]) + fabs(stress[4])};
  if (a[0][0] + radius[0] <= 0 && a[1][1] + radius[1] <= 0 && a[2][2] + radius[2] <= 0) return; /* pressed all round */
  diagonalise(a, v);
  for (int axis = 0; axis < 3; axis++)
    if (a[axis][axis] > 0)
      for (int k = 0; k < 6; k++)
        artificial[k] -= epsilon * a[axis][axis] * v[row[k]][axis] * v[column[k]][axis];
}
