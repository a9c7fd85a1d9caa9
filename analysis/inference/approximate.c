/* Populations of approximate Bayesian computation. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/inference/covariance.h"
#include "engine/random.h"

static double uniform(const struct approximate *a, size_t particle, uint64_t draw) {
  return random_draw(a->seed, RANDOM_INFERENCE, UINT64_C(1) << 61 | a->round << 32 | particle, draw);
}

static double normal(const struct approximate *a, size_t particle, uint64_t draw) {
  return gsl_cdf_ugaussian_Pinv(fmax(uniform(a, particle, draw), 0x1p-54));
}

status approximate_begin(struct approximate *a, size_t particles, size_t inputs, uint64_t seed, struct error *error) {
  *a = (struct approximate){.particles = particles, .inputs = inputs, .seed = seed, .accepted = 1};
  a->z = calloc(particles * inputs, sizeof(double));
  a->distance = calloc(particles, sizeof(double));
  a->weight = calloc(particles, sizeof(double));
  if (!a->z || !a->distance || !a->weight || inputs > INFERENCE_INPUTS)
    return status_fail(error, STATUS_MEMORY, "no memory for particles");
  return STATUS_OK;
}

void approximate_clear(struct approximate *a) {
  free(a->z);
  free(a->distance);
  free(a->weight);
  *a = (struct approximate){0};
}

/* Twice the weighted covariance of the kept particles, as a Cholesky factor. */
static void kernel(const struct approximate *a, double *factor) {
  const size_t p = a->inputs;
  double mean[INFERENCE_INPUTS] = {0}, sum = 0;
  memset(factor, 0, p * p * sizeof *factor);
  for (size_t n = 0; n < a->kept; n++)
    sum += a->weight[n];
  for (size_t n = 0; n < a->kept; n++)
    for (size_t i = 0; i < p; i++)
      mean[i] += a->weight[n] / sum * a->z[n * p + i];
  for (size_t n = 0; n < a->kept; n++)
    for (size_t i = 0; i < p; i++)
      for (size_t j = 0; j < p; j++)
        factor[i * p + j] += 2 * a->weight[n] / sum * (a->z[n * p + i] - mean[i]) * (a->z[n * p + j] - mean[j]);
  for (size_t i = 0; i < p; i++)
    factor[i * p + i] += 1e-6;
  covariance_factor(p, factor);
}

static size_t pick(const struct approximate *a, double u) {
  double sum = 0, below = 0;
  for (size_t n = 0; n < a->kept; n++)
    sum += a->weight[n];
  for (size_t n = 0; n < a->kept; n++) {
    below += a->weight[n] / sum;
    if (below > u)
      return n;
  }
  return a->kept - 1;
}

/* Prior density divided by the proposal density at z, summed over all kept particles. */
static double weight_of(const struct approximate *a, const double *factor, const double *z) {
  const size_t p = a->inputs;
  double proposed = 0, sum = 0, prior = 0, step[INFERENCE_INPUTS], half[INFERENCE_INPUTS];
  for (size_t n = 0; n < a->kept; n++) {
    for (size_t i = 0; i < p; i++)
      step[i] = z[i] - a->z[n * p + i];
    proposed += a->weight[n] * exp(-covariance_distance(p, factor, step, half) / 2);
    sum += a->weight[n];
  }
  for (size_t i = 0; i < p; i++)
    prior -= z[i] * z[i] / 2;
  /* The factor of the kernel is the same for all particles of a round. Particles kept from earlier rounds have another
   * factor, so it cannot be left out. */
  return exp(prior) / (proposed / sum * exp(-covariance_log_determinant(p, factor) / 2));
}

size_t approximate_propose(struct approximate *a) {
  const size_t p = a->inputs;
  double factor[INFERENCE_INPUTS * INFERENCE_INPUTS];
  if (a->kept)
    kernel(a, factor);
  for (size_t n = a->kept; n < a->particles; n++) {
    double *z = a->z + n * p;
    const size_t from = a->kept ? pick(a, uniform(a, n, 0)) : 0;
    double noise[INFERENCE_INPUTS];
    for (size_t i = 0; i < p; i++)
      noise[i] = normal(a, n, i + 1);
    for (size_t i = 0; i < p; i++) {
      z[i] = a->kept ? a->z[from * p + i] : noise[i];
      for (size_t j = 0; a->kept && j <= i; j++)
        z[i] += factor[i * p + j] * noise[j];
    }
    a->weight[n] = a->kept ? weight_of(a, factor, z) : 1;
  }
  return a->particles - a->kept;
}

struct place {
  double distance;
  size_t from;
};

static int by_distance(const void *a, const void *b) {
  const struct place *x = a, *y = b;
  if (x->distance != y->distance)
    return x->distance > y->distance ? 1 : -1;
  return x->from > y->from ? 1 : -1;
}

void approximate_take(struct approximate *a, const double *distance) {
  const size_t n = a->particles, p = a->inputs, keep = n / 2;
  struct place *places = calloc(n, sizeof *places);
  double *z = calloc(n * p, sizeof *z), *weight = calloc(n, sizeof *weight);
  for (size_t i = a->kept; i < n; i++)
    a->distance[i] = isfinite(distance[i - a->kept]) ? distance[i - a->kept] : HUGE_VAL;
  if (places && z && weight) {
    size_t fresh = 0;
    for (size_t i = 0; i < n; i++)
      places[i] = (struct place){a->distance[i], i};
    qsort(places, n, sizeof *places, by_distance);
    for (size_t i = 0; i < n; i++) {
      memcpy(z + i * p, a->z + places[i].from * p, p * sizeof *z);
      weight[i] = a->weight[places[i].from];
      a->distance[i] = places[i].distance;
      fresh += i < keep && places[i].from >= a->kept;
    }
    memcpy(a->z, z, n * p * sizeof *z);
    memcpy(a->weight, weight, n * sizeof *weight);
    a->accepted = a->kept ? (double)fresh / (double)(n - a->kept) : 1;
    a->kept = keep;
    a->tolerance = a->distance[keep - 1];
    a->round++;
  }
  free(places);
  free(z);
  free(weight);
}

struct weighted {
  double z, weight;
};

static int by_z(const void *a, const void *b) {
  const double x = ((const struct weighted *)a)->z, y = ((const struct weighted *)b)->z;
  return (x > y) - (x < y);
}

double approximate_quantile(const struct approximate *a, size_t input, double p) {
  struct weighted *nodes = calloc(a->kept + 1, sizeof *nodes);
  double sum = 0, below = 0, found = NAN;
  if (!nodes)
    return NAN;
  for (size_t n = 0; n < a->kept; n++) {
    nodes[n] = (struct weighted){a->z[n * a->inputs + input], a->weight[n]};
    sum += a->weight[n];
  }
  qsort(nodes, a->kept, sizeof *nodes, by_z);
  for (size_t n = 0; n < a->kept && isnan(found); n++) {
    below += nodes[n].weight / sum;
    if (below >= p)
      found = nodes[n].z;
  }
  free(nodes);
  return found;
}
