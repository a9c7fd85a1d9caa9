/* Ensemble Kalman inversion. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "engine/random.h"
#include "schemas/memory.h"

/* Limit of normal coordinates: 0.05 % of the prior lies beyond 3.5. */
static const double FARTHEST = 3.5;

struct work {
  size_t good;                   /* number of members with results */
  size_t *member;                /* indices of these members */
  double *mean_z, *mean_g;       /* of the good members */
  double *cross, *spread;        /* covariances: inputs x outputs, outputs x outputs */
  double *root;                  /* Cholesky factor of gamma */
  double *innovation, *weighted; /* outputs */
  double *misfit;                /* of each good member; all arrays above follow it */
};

static double normal(const struct ensemble_kalman *e, uint64_t member, uint64_t draw) {
  const double u = random_draw(e->seed, RANDOM_INFERENCE, e->round << 32 | member, draw);
  return gsl_cdf_ugaussian_Pinv(fmin(fmax(u, 0x1p-54), 1 - 0x1p-53));
}

static void find_covariances(const struct ensemble_kalman *e, struct work *w) {
  const size_t p = e->inputs, d = e->outputs;
  const double n = (double)w->good;
  for (size_t i = 0; i < w->good; i++) {
    for (size_t a = 0; a < p; a++)
      w->mean_z[a] += e->z[w->member[i] * p + a] / n;
    for (size_t k = 0; k < d; k++)
      w->mean_g[k] += e->g[w->member[i] * d + k] / n;
  }
  for (size_t i = 0; i < w->good; i++) {
    const double *z = e->z + w->member[i] * p, *g = e->g + w->member[i] * d;
    for (size_t k = 0; k < d; k++) {
      const double dg = (g[k] - w->mean_g[k]) / (n - 1);
      for (size_t a = 0; a < p; a++)
        w->cross[a * d + k] += (z[a] - w->mean_z[a]) * dg;
      for (size_t l = 0; l < d; l++)
        w->spread[k * d + l] += (g[l] - w->mean_g[l]) * dg;
    }
  }
}

/* The part of the data that a step uses: max(d / 2 mean, sqrt(d / 2 variance)) of the misfits, but at least `least` and
 * at most the remaining part. */
static double part_of(const struct ensemble_kalman *e, struct work *w) {
  double mean = 0, variance = 0;
  for (size_t i = 0; i < w->good; i++) { /* half the squared distance from the data, in units of the errors */
    for (size_t k = 0; k < e->outputs; k++)
      w->innovation[k] = e->y[k] - e->g[w->member[i] * e->outputs + k];
    w->misfit[i] = covariance_distance(e->outputs, w->root, w->innovation, w->weighted) / 2;
    mean += w->misfit[i] / (double)w->good;
  }
  for (size_t i = 0; i < w->good; i++)
    variance += (w->misfit[i] - mean) * (w->misfit[i] - mean) / (double)(w->good - 1);
  const double half = (double)e->outputs / 2;
  const double part = fmax(fmax(half / mean, sqrt(half / variance)), e->least);
  const double left = 1 - e->tempered;
  return part < left ? part : left;
}

static void move(const struct ensemble_kalman *e, struct work *w, size_t member, double part) {
  const size_t p = e->inputs, d = e->outputs;
  const double stretch = 1 / sqrt(part);
  for (size_t k = 0; k < d; k++) {
    double noise = 0;
    for (size_t l = 0; l <= k; l++)
      noise += w->root[k * d + l] * normal(e, member, l);
    w->innovation[k] = e->y[k] + stretch * noise - e->g[member * d + k];
  }
  covariance_solve(d, w->spread, w->innovation, w->weighted);
  for (size_t a = 0; a < p; a++) {
    double *z = &e->z[member * p + a];
    for (size_t k = 0; k < d; k++)
      *z += w->cross[a * d + k] * w->weighted[k];
    *z = fmin(fmax(*z, -FARTHEST), FARTHEST);
  }
}

/* Replaces a member without results by a good one, shifted by a tenth of the prior's width. */
static void replace(const struct ensemble_kalman *e, const struct work *w, size_t member) {
  const double u = random_draw(e->seed, RANDOM_INFERENCE, e->round << 32 | member, 1000000);
  const size_t other = w->member[(size_t)(u * (double)w->good)];
  for (size_t a = 0; a < e->inputs; a++)
    e->z[member * e->inputs + a] = e->z[other * e->inputs + a] + 0.1 * normal(e, member, 1000001 + a);
}

static status step(struct ensemble_kalman *e, struct work *w, struct error *error) {
  const size_t d = e->outputs;
  for (size_t j = 0; j < e->members; j++) {
    bool good = true;
    for (size_t k = 0; k < d; k++)
      good = good && isfinite(e->g[j * d + k]);
    if (good)
      w->member[w->good++] = j;
  }
  if (w->good < 3)
    return status_fail(error, STATUS_CONTENT,
                       "only %zu of %zu members of the ensemble have results, and a fit needs three: see `clast query "
                       "STORE --named failures`",
                       w->good, e->members);
  find_covariances(e, w);
  memcpy(w->root, e->gamma, d * d * sizeof(double));
  if (!covariance_factor(d, w->root))
    return status_fail(error, STATUS_CONTENT,
                       "the covariance of the measurement is not positive: give every value an "
                       "error above 0");
  const double part = part_of(e, w);
  for (size_t k = 0; k < d * d; k++)
    w->spread[k] += e->gamma[k] / part;
  if (!covariance_factor(d, w->spread))
    return status_fail(error, STATUS_INTERNAL, "the covariance of the ensemble is not positive");
  for (size_t i = 0; i < w->good; i++)
    move(e, w, w->member[i], part);
  for (size_t j = 0, i = 0; j < e->members; j++)
    if (i < w->good && w->member[i] == j)
      i++;
    else
      replace(e, w, j);
  e->tempered += part;
  return STATUS_OK;
}

status ensemble_kalman_step(struct ensemble_kalman *e, struct error *error) {
  const size_t n = e->members, p = e->inputs, d = e->outputs;
  OWNED size_t *member = NULL;
  OWNED double *numbers = NULL;
  TRY(memory_array(&member, n, sizeof *member, "the ensemble", error));
  TRY(memory_array(&numbers, n + p + 3 * d + p * d + 2 * d * d, sizeof *numbers, "the ensemble", error));
  struct work w = {.member = member, .misfit = numbers, .mean_z = numbers + n};
  w.mean_g = w.mean_z + p;
  w.innovation = w.mean_g + d;
  w.weighted = w.innovation + d;
  w.cross = w.weighted + d;
  w.spread = w.cross + p * d;
  w.root = w.spread + d * d;
  return step(e, &w, error);
}
