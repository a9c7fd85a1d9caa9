/* Synthetic models for the tests of inference: cheap functions of the inputs with a scatter over seeds replace an
 * engine; also the rounds of a fit with them. */
#pragma once

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/inference/inference.h"
#include "engine/random.h"

/* Standard normal numbers of a test. The program does not use purpose 100. */
static inline double case_normal(uint64_t seed, uint64_t item, uint64_t draw) {
  return gsl_cdf_ugaussian_Pinv(fmax(random_draw(seed, 100, item, draw), 0x1p-54));
}

enum { CASE_MEMBERS = 24, CASE_ROUNDS = 8, CASE_REPLICATES = 4, CASE_POINTS = CASE_MEMBERS * CASE_ROUNDS };

/* Output k of a run at quantiles u of the priors with one seed. */
typedef double (*case_model)(const double *u, size_t k, uint64_t seed);

struct case_fit {
  size_t inputs, outputs, points;
  bool own_seeds; /* each point has seeds of its own; else all points share theirs */
  double z[CASE_POINTS * INFERENCE_INPUTS];
  double values[INFERENCE_OUTPUTS * CASE_POINTS * CASE_REPLICATES]; /* packed: outputs x points x replicates */
  struct surfaces surfaces;
  struct posterior posterior;
  size_t rounds;
};

static inline void case_quantiles(size_t inputs, const double *z, double *u) {
  for (size_t i = 0; i < inputs; i++)
    u[i] = gsl_cdf_ugaussian_P(z[i]);
}

static inline struct surfaces_runs case_runs(const struct case_fit *fit, double *packed) {
  /* `values` has room for all points; surfaces_runs expects only the existing ones. */
  for (size_t k = 0; k < fit->outputs; k++)
    memcpy(packed + k * fit->points * CASE_REPLICATES, fit->values + k * CASE_POINTS * CASE_REPLICATES,
           fit->points * CASE_REPLICATES * sizeof *packed);
  return (struct surfaces_runs){.points = fit->points,
                                .inputs = fit->inputs,
                                .outputs = fit->outputs,
                                .replicates = CASE_REPLICATES,
                                .z = fit->z,
                                .values = packed,
                                .shared_seeds = !fit->own_seeds};
}

/* A round of the ensemble: runs of its members with seeds first_seed + r, or such seeds of their own. first_seed: less
 * than a million. */
static inline void case_run(struct case_fit *fit, case_model model, const double *members, uint64_t first_seed) {
  double u[INFERENCE_INPUTS];
  for (size_t j = 0; j < CASE_MEMBERS; j++, fit->points++) {
    memcpy(fit->z + fit->points * fit->inputs, members + j * fit->inputs, fit->inputs * sizeof(double));
    const uint64_t seed = first_seed + (fit->own_seeds ? UINT64_C(1000000) * (fit->points + 1) : 0);
    case_quantiles(fit->inputs, members + j * fit->inputs, u);
    for (size_t k = 0; k < fit->outputs; k++)
      for (size_t r = 0; r < CASE_REPLICATES; r++)
        fit->values[(k * CASE_POINTS + fit->points) * CASE_REPLICATES + r] = model(u, k, seed + r);
  }
}

/* A whole fit: rounds of the ensemble until the data are fully assimilated, one more round there, surfaces, posterior.
 */
static inline status case_solve(struct case_fit *fit, case_model model, const struct posterior_datum *data,
                                const bool *bounded, uint64_t seed, struct error *why) {
  const size_t p = fit->inputs, d = fit->outputs;
  static double packed[INFERENCE_OUTPUTS * CASE_POINTS * CASE_REPLICATES];
  double members[CASE_MEMBERS * INFERENCE_INPUTS], g[CASE_MEMBERS * INFERENCE_OUTPUTS], y[INFERENCE_OUTPUTS];
  double gamma[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  struct ensemble_kalman e =
      {.members = CASE_MEMBERS, .inputs = p, .outputs = d, .z = members, .g = g, .y = y, .gamma = gamma, .seed = seed};
  /* A Latin hypercube: each stratum j of input i is given to one member. The strides have no divisor in common with the
   * number of members, so no member is left out. */
  static const size_t stride[] = {5, 7, 11, 13, 17, 19, 23, 1};
  for (size_t i = 0; i < p; i++)
    for (size_t j = 0; j < CASE_MEMBERS; j++) {
      const size_t place = (j * stride[i % 8] + i) % CASE_MEMBERS;
      members[place * p + i] = gsl_cdf_ugaussian_Pinv(((double)j + 0.5) / CASE_MEMBERS);
    }
  for (size_t k = 0; k < d; k++)
    y[k] = data[k].value;
  status code = STATUS_OK;
  while (code == STATUS_OK && e.tempered < 1 - 1e-9) {
    case_run(fit, model, members, 1000 * seed);
    const struct surfaces_runs runs = case_runs(fit, packed);
    for (size_t j = 0; j < CASE_MEMBERS; j++)
      for (size_t k = 0; k < d; k++)
        g[j * d + k] = surfaces_mean(&runs, k, fit->points - CASE_MEMBERS + j);
    e.least = (1 - e.tempered) / (double)(CASE_ROUNDS - 1 - e.round);
    code = surfaces_errors(&runs, data, bounded, CASE_MEMBERS, gamma, why);
    if (code == STATUS_OK)
      code = ensemble_kalman_step(&e, why);
    e.round++;
  }
  if (code == STATUS_OK)
    case_run(fit, model, members, 1000 * seed);
  fit->rounds = e.round + 1;
  const struct surfaces_runs runs = case_runs(fit, packed);
  if (code == STATUS_OK)
    code = surfaces_fit(&runs, data, bounded, &fit->surfaces, why);
  return code == STATUS_OK ? posterior_make(&fit->surfaces.model, seed, &fit->posterior, why) : code;
}

static inline void case_clear(struct case_fit *fit) {
  surfaces_clear(&fit->surfaces);
  posterior_clear(&fit->posterior);
}
