/* Goodman and Weare's walkers. */
#include "analysis/inference/posterior_sample.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/random.h"

enum { WALKERS = 80, SWEEPS = 200, KEPT = POSTERIOR_SAMPLE_NODES / WALKERS, EVERY = 2 };
static const double STRETCH = 2; /* a, as in the paper */

static double density(const struct posterior_model *model, const double *z) {
  double sum = posterior_likelihood(model, z);
  for (size_t i = 0; i < model->inputs; i++)
    sum -= z[i] * z[i] / 2;
  return sum;
}

/* One sweep: each half moves along lines through walkers of the other half. */
static void sweep(const struct posterior_model *model, uint64_t seed, uint64_t number, double *z, double *log_density) {
  const size_t p = model->inputs;
  double moved[POSTERIOR_INPUTS];
  for (size_t w = 0; w < WALKERS; w++) {
    uint64_t bits[4];
    random_bits(seed, RANDOM_INFERENCE, UINT64_C(1) << 62 | number << 16 | w, 0, bits);
    const bool upper = w >= WALKERS / 2;
    const size_t other = (size_t)(random_uniform(bits[0]) * (WALKERS / 2)) + (upper ? 0 : WALKERS / 2);
    const double root = 1 / sqrt(STRETCH) + random_uniform(bits[1]) * (sqrt(STRETCH) - 1 / sqrt(STRETCH));
    const double stretch = root * root; /* of density 1 / sqrt(stretch) between 1/a and a */
    for (size_t i = 0; i < p; i++)
      moved[i] = z[other * p + i] + stretch * (z[w * p + i] - z[other * p + i]);
    const double there = density(model, moved);
    if (log(random_uniform(bits[2])) < (double)(p - 1) * log(stretch) + there - log_density[w]) {
      memcpy(z + w * p, moved, p * sizeof *moved);
      log_density[w] = there;
    }
  }
}

/* Each walker begins at the best of ten draws from the prior. */
static void begin(const struct posterior_model *model, uint64_t seed, double *z, double *log_density) {
  const size_t p = model->inputs;
  double tried[POSTERIOR_INPUTS];
  for (size_t w = 0; w < WALKERS; w++) {
    log_density[w] = -HUGE_VAL;
    for (size_t t = 0; t < 10; t++) {
      for (size_t i = 0; i < p; i++)
        tried[i] = gsl_cdf_ugaussian_Pinv(
            fmax(random_draw(seed, RANDOM_INFERENCE, UINT64_C(1) << 63 | w << 16 | t, i), 0x1p-54));
      const double there = density(model, tried);
      if (t > 0 && !(there > log_density[w]))
        continue;
      log_density[w] = there;
      memcpy(z + w * p, tried, p * sizeof *tried);
    }
  }
}

bool posterior_sample_fill(const struct posterior_model *model, uint64_t seed, double *z) {
  const size_t p = model->inputs;
  double *walkers = calloc(WALKERS * p, sizeof *walkers), *log_density = calloc(WALKERS, sizeof *log_density);
  if (walkers && log_density) {
    begin(model, seed, walkers, log_density);
    uint64_t number = 0;
    for (; number < SWEEPS; number++)
      sweep(model, seed, number, walkers, log_density);
    for (size_t kept = 0; kept < KEPT; kept++) {
      for (int i = 0; i < EVERY; i++, number++)
        sweep(model, seed, number, walkers, log_density);
      memcpy(z + kept * WALKERS * p, walkers, WALKERS * p * sizeof *walkers);
    }
  }
  const bool done = walkers && log_density;
  free(walkers);
  free(log_density);
  return done;
}
