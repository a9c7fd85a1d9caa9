#include "engine/sph/pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/neighbours.h"
#include "engine/sph/spline.h"

struct sph_pairs {
  struct sph_pair_options options;
  size_t n;
  struct sph_neighbours lists;
  double *listed[4]; /* x y z h when the lists were made */
  double *moment;    /* 6 n, gradient correction */
  size_t within;     /* pairs inside the support at the last pass */
};

status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error) {
  struct sph_pairs *pairs = calloc(1, sizeof *pairs);
  *out = NULL;
  bool whole = pairs != NULL;
  if (pairs) {
    pairs->options = *options;
    pairs->n = n;
    for (int k = 0; k < 4 && whole; k++)
      whole = (pairs->listed[k] = malloc((n + 1) * sizeof(double))) != NULL;
    if (options->gradient_correction && whole) whole = (pairs->moment = malloc((6 * n + 1) * sizeof(double))) != NULL;
  }
  if (!whole) {
    sph_pairs_free(pairs);
    return status_fail(error, STATUS_MEMORY, "no memory for the pair loop of %zu particles", n);
  }
  *out = pairs;
  return STATUS_OK;
}

void sph_pairs_free(struct sph_pairs *pairs) {
  if (!pairs) return;
  sph_neighbours_clear(&pairs->lists);
  for (int k = 0; k < 4; k++)
    free(pairs->listed[k]);
  free(pairs->moment);
  free(pairs);
}

size_t sph_pairs_bytes(const struct sph_pairs *pairs) {
  size_t n = pairs->n, reals = pairs->moment ? 10 : 4;
  return sizeof *pairs + reals * n * sizeof(double) + (n + 1) * sizeof(size_t) + pairs->lists.capacity * sizeof(uint32_t);
}

static double image(double along, double length) {
  return isnan(length) ? along : along - length * nearbyint(along / length);
}

bool sph_pairs_stale(const struct sph_pairs *pairs, size_t n, const double *x, const double *y, const double *z,
                     const double *h) {
  if (pairs->lists.n != n || !pairs->lists.first) return true;
  const double *periodic = pairs->options.periodic;
  for (size_t i = 0; i < n; i++) { /* (h + h') (1 + skin) covers (h_new + h_new') + both moves when this holds for each */
    double dx = image(x[i] - pairs->listed[0][i], periodic[0]), dy = image(y[i] - pairs->listed[1][i], periodic[1]),
           dz = image(z[i] - pairs->listed[2][i], periodic[2]);
    if (!(sqrt(dx * dx + dy * dy + dz * dz) + h[i] <= pairs->listed[3][i] * (1 + pairs->options.skin))) return true;
  }
  return false;
}

status sph_pairs_list(struct sph_pairs *pairs, size_t n, const double *x, const double *y, const double *z,
                      const double *h, struct error *error) {
  const double *now[4] = {x, y, z, h};
  status code = sph_neighbours_find(n, x, y, z, h, pairs->options.skin, pairs->options.periodic, &pairs->lists, error);
  for (int k = 0; k < 4 && !code; k++)
    memcpy(pairs->listed[k], now[k], n * sizeof(double));
  return code;
}

/* v = M w for a symmetric M (xx xy xz yy yz zz). */
static void apply(const double *m, const double w[3], double v[3]) {
  v[0] = m[0] * w[0] + m[1] * w[1] + m[2] * w[2];
  v[1] = m[1] * w[0] + m[3] * w[1] + m[4] * w[2];
  v[2] = m[2] * w[0] + m[4] * w[1] + m[5] * w[2];
}

static double power(size_t i, const struct sph_pair_fields *f, const struct sph_pair_sums *sums, bool strength) {
  double *const *g = sums->gradient;
  double sum = f->pressure_term[i] * (g[0][i] + g[4][i] + g[8][i]);
  if (strength)
    sum += f->stress[0][i] * g[0][i] + f->stress[3][i] * g[4][i] + f->stress[5][i] * g[8][i] +
           f->stress[1][i] * (g[1][i] + g[3][i]) + f->stress[2][i] * (g[2][i] + g[6][i]) +
           f->stress[4][i] * (g[5][i] + g[7][i]);
  return f->density[i] * sum;
}

static void correct(size_t i, const double *m, const struct sph_pair_sums *sums) {
  double a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], c = m[1] * m[4] - m[2] * m[3];
  double determinant = m[0] * a + m[1] * b + m[2] * c;
  double mean = (m[0] + m[3] + m[5]) / 3; /* 1 inside, 1/8 in a corner */
  if (!(mean > 0.02 && determinant > 0.02 * mean * mean * mean)) return; /* too few neighbours, or all in a plane */
  double s = 1 / determinant;
  double inverse[6] = {s * a, s * b, s * c, s * (m[0] * m[5] - m[2] * m[2]), s * (m[1] * m[2] - m[0] * m[4]),
                       s * (m[0] * m[3] - m[1] * m[1])};
  for (int row = 0; row < 3; row++) {
    double g[3] = {sums->gradient[3 * row][i], sums->gradient[3 * row + 1][i], sums->gradient[3 * row + 2][i]}, v[3];
    apply(inverse, g, v);
    for (int k = 0; k < 3; k++)
      sums->gradient[3 * row + k][i] = v[k];
  }
}

void sph_pairs_sum(struct sph_pairs *pairs, size_t n, const struct sph_pair_fields *f, const struct sph_pair_sums *sums) {
  const struct sph_pair_options *o = &pairs->options;
  for (int k = 0; k < 9; k++)
    memset(sums->gradient[k], 0, n * sizeof(double));
  double *plain[] = {sums->ax, sums->ay, sums->az, sums->heating, sums->signal};
  for (size_t k = 0; k < sizeof plain / sizeof plain[0]; k++)
    memset(plain[k], 0, n * sizeof(double));
  if (pairs->moment) memset(pairs->moment, 0, 6 * n * sizeof(double));
  pairs->within = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = pairs->lists.first[i]; k < pairs->lists.first[i + 1]; k++) {
      size_t j = pairs->lists.j[k];
      double d[3] = {image(f->x[i] - f->x[j], o->periodic[0]), image(f->y[i] - f->y[j], o->periodic[1]),
                     image(f->z[i] - f->z[j], o->periodic[2])};
      double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h = 0.5 * (f->h[i] + f->h[j]);
      if (!(square < 4 * h * h)) continue;
      pairs->within++;
      double slope = sph_spline_slope(sqrt(square), h);
      double w[3] = {slope * d[0], slope * d[1], slope * d[2]};
      double v[3] = {f->vx[i] - f->vx[j], f->vy[i] - f->vy[j], f->vz[i] - f->vz[j]};
      double closing = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
      double mu = h * fmin(closing, 0) / (square + 0.01 * h * h);
      double viscous = mu * (2 * o->viscosity_beta * mu - o->viscosity_alpha * (f->sound_speed[i] + f->sound_speed[j])) /
                       (f->density[i] + f->density[j]);
      double along = f->pressure_term[i] + f->pressure_term[j] - viscous, force[3] = {along * w[0], along * w[1], along * w[2]};
      if (o->strength) {
        double t[6], s[3];
        for (int c = 0; c < 6; c++)
          t[c] = f->stress[c][i] + f->stress[c][j];
        apply(t, w, s);
        for (int c = 0; c < 3; c++)
          force[c] += s[c];
      }
      double mi = f->mass[i], mj = f->mass[j], heat = 0.5 * viscous * slope * closing;
      sums->ax[i] += mj * force[0], sums->ay[i] += mj * force[1], sums->az[i] += mj * force[2];
      sums->ax[j] -= mi * force[0], sums->ay[j] -= mi * force[1], sums->az[j] -= mi * force[2];
      sums->heating[i] += mj * heat, sums->heating[j] += mi * heat;
      sums->signal[i] = fmax(sums->signal[i], -mu), sums->signal[j] = fmax(sums->signal[j], -mu);
      double wi = o->volume_weights ? mj / f->density[j] : mj / f->density[i];
      double wj = o->volume_weights ? mi / f->density[i] : mi / f->density[j];
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          sums->gradient[3 * a + b][i] -= wi * v[a] * w[b];
          sums->gradient[3 * a + b][j] -= wj * v[a] * w[b];
        }
      if (pairs->moment)
        for (int c = 0; c < 6; c++) {
          static const int row[] = {0, 0, 0, 1, 1, 2}, column[] = {0, 1, 2, 1, 2, 2};
          pairs->moment[6 * i + (size_t)c] -= wi * d[row[c]] * w[column[c]];
          pairs->moment[6 * j + (size_t)c] -= wj * d[row[c]] * w[column[c]];
        }
    }
  if (pairs->moment)
    for (size_t i = 0; i < n; i++) {
      if (sums->power) sums->power[i] = power(i, f, sums, o->strength);
      correct(i, pairs->moment + 6 * i, sums);
    }
}

double sph_pairs_neighbours(const struct sph_pairs *pairs) {
  return pairs->n ? 2 * (double)pairs->within / (double)pairs->n : 0;
}
