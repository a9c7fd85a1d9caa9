/* A plain solid step, never changed: bench_sph compares its speed with it, and unit tests compare their results with
 * it. */
#include "tests/bench/reference_sph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/pairs/pairs.h"

static double image(double along, double length) {
  return isnan(length) ? along : along - length * nearbyint(along / length);
}

void reference_sph_sum(size_t n, const size_t *start, const uint32_t *count, const uint32_t *neighbour,
                       const struct sph_pair_options *o, const struct sph_pair_fields *f, const double *const *stress,
                       const double *const *artificial, const struct sph_pair_sums *sums) {
  double *columns[] = {sums->ax, sums->ay, sums->az, sums->heating, sums->signal};
  for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++)
    memset(columns[k], 0, n * sizeof(double));
  for (int k = 0; k < 9; k++)
    memset(sums->gradient[k], 0, n * sizeof(double));
  for (size_t i = 0; i < n; i++)
    for (size_t k = start[i]; k < start[i] + count[i]; k++) {
      size_t j = neighbour[k];
      double d[3] = {image(f->x[i] - f->x[j], o->periodic[0]), image(f->y[i] - f->y[j], o->periodic[1]),
                     image(f->z[i] - f->z[j], o->periodic[2])};
      double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h = 0.5 * (f->h[i] + f->h[j]);
      if (!(square < 4 * h * h))
        continue;
      double r = sqrt(square), slope = sph_spline_slope(r, h);
      double w[3] = {slope * d[0], slope * d[1], slope * d[2]};
      double v[3] = {f->vx[i] - f->vx[j], f->vy[i] - f->vy[j], f->vz[i] - f->vz[j]};
      double closing = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
      double mu = h * fmin(closing, 0) / (square + 0.01 * h * h);
      double viscous = mu *
                       (2 * o->viscosity.beta * mu - o->viscosity.alpha * (f->sound_speed[i] + f->sound_speed[j])) /
                       (f->density[i] + f->density[j]);
      double si = 1, sj = 1; /* of sigma/rho^2 */
      if (o->method.volume_weights)
        si = f->density[i] / f->density[j], sj = f->density[j] / f->density[i];
      double along = si * f->pressure_term[i] + sj * f->pressure_term[j] - viscous,
             t[6] = {along, 0, 0, along, 0, along};
      double ratio = artificial ? sph_spline(r, h) / sph_spline(o->spacing_over_h * h, h) : 0, opposed[6] = {0},
             work = 0;
      for (int c = 0; c < 6; c++) {
        if (o->strength)
          t[c] += si * stress[c][i] + sj * stress[c][j];
        if (artificial)
          opposed[c] = pow(ratio, 4) * (si * artificial[c][i] + sj * artificial[c][j]);
        t[c] += opposed[c];
      }
      static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
          work -= v[a] * opposed[at[a][b]] * w[b];
      double force[3] = {t[0] * w[0] + t[1] * w[1] + t[2] * w[2], t[1] * w[0] + t[3] * w[1] + t[4] * w[2],
                         t[2] * w[0] + t[4] * w[1] + t[5] * w[2]};
      double mi = f->mass[i], mj = f->mass[j], heat = 0.5 * (viscous * slope * closing + work);
      sums->ax[i] += mj * force[0], sums->ay[i] += mj * force[1], sums->az[i] += mj * force[2];
      sums->ax[j] -= mi * force[0], sums->ay[j] -= mi * force[1], sums->az[j] -= mi * force[2];
      sums->heating[i] += mj * heat, sums->heating[j] += mi * heat;
      sums->signal[i] = fmax(sums->signal[i], -mu), sums->signal[j] = fmax(sums->signal[j], -mu);
      double wi = o->method.volume_weights ? mj / f->density[j] : mj / f->density[i];
      double wj = o->method.volume_weights ? mi / f->density[i] : mi / f->density[j];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          sums->gradient[3 * a + b][i] -= wi * v[a] * w[b];
          sums->gradient[3 * a + b][j] -= wj * v[a] * w[b];
        }
    }
}

/* Appends one chunk's lists; false when they break the rules of pairs/lists.h. */
static bool append(const struct sph_neighbour_lists *lists, size_t first, size_t own, size_t *used,
                   struct reference_sph_lists *out) {
  bool good = lists->start[0] == 0;
  out->j = realloc(out->j, (*used + lists->start[own] + 1) * sizeof *out->j);
  if (!out->j)
    return false;
  for (size_t k = 0; k < own; k++) {
    const uint32_t *j = lists->j + lists->start[k], count = lists->count[k],
                   room = lists->start[k + 1] - lists->start[k];
    good &= count <= room && room < count + SPH_LIST_ALIGN && room % SPH_LIST_ALIGN == 0;
    out->start[first + k] = *used;
    out->count[first + k] = count;
    for (uint32_t m = 0; m < room && good; m++) {
      good &= m >= count ? j[m] == k : j[m] > k && (m == 0 || j[m] > j[m - 1]);
      if (m < count)
        out->j[(*used)++] = j[m] + (uint32_t)first;
    }
  }
  return good;
}

status reference_sph_lists_make(size_t n, size_t chunk, const double *const at[3], const double *reach,
                                const double periodic[3], int threads, struct reference_sph_lists *out,
                                struct error *error) {
  struct sph_neighbours *neighbours = sph_neighbours_create(n, chunk, 1, sph_pairs_kernels_choose());
  struct sph_neighbour_lists lists = {.start = malloc((chunk + 1) * sizeof(uint32_t)),
                                      .count = malloc(chunk * sizeof(uint32_t))};
  size_t used = 0;
  *out = (struct reference_sph_lists){.start = malloc(n * sizeof(size_t)), .count = malloc(n * sizeof(uint32_t))};
  status code = STATUS_MEMORY;
  if (neighbours && lists.start && lists.count && out->start && out->count)
    code = sph_neighbours_find(neighbours, n, at[0], at[1], at[2], reach, periodic, threads, error);
  for (size_t first = 0; first < n && !code; first += chunk)
    if (!sph_neighbours_list(neighbours, first / chunk, &lists) ||
        !append(&lists, first, n - first < chunk ? n - first : chunk, &used, out))
      code = status_fail(error, STATUS_INTERNAL, "bad lists of the chunk from particle %zu on", first);
  if (code)
    reference_sph_lists_free(out);
  free(lists.start);
  free(lists.count);
  free(lists.j);
  sph_neighbours_free(neighbours);
  return code;
}

void reference_sph_lists_free(struct reference_sph_lists *lists) {
  free(lists->start);
  free(lists->count);
  free(lists->j);
  *lists = (struct reference_sph_lists){0};
}

/* Jacobi's rotations: a (symmetric, 3 x 3) becomes diagonal; the columns of v become its axes. */
static void diagonalise(double a[3][3], double v[3][3]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      v[i][j] = i == j;
  for (int sweep = 0; sweep < 12; sweep++) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    if (!(off > 1e-32 * on))
      return;
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0)
          continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1),
                     s = t * c;
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

void reference_sph_opposed(double epsilon, const double stress[6], double artificial[6]) {
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  double a[3][3], v[3][3];
  for (int k = 0; k < 6; k++)
    a[row[k]][column[k]] = a[column[k]][row[k]] = stress[k];
  memset(artificial, 0, 6 * sizeof *artificial);
  const double radius[3] = {fabs(stress[1]) + fabs(stress[2]), fabs(stress[1]) + fabs(stress[4]),
                            fabs(stress[2]) + fabs(stress[4])};
  if (a[0][0] + radius[0] <= 0 && a[1][1] + radius[1] <= 0 && a[2][2] + radius[2] <= 0)
    return; /* compression along all axes */
  diagonalise(a, v);
  for (int axis = 0; axis < 3; axis++)
    if (a[axis][axis] > 0)
      for (int k = 0; k < 6; k++)
        artificial[k] -= epsilon * a[axis][axis] * v[row[k]][axis] * v[column[k]][axis];
}
