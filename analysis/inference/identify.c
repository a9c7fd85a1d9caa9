/* Directions of much and of little information. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"

enum { NODES = 64 };
static const double STEP = 0.05; /* step of the slopes, in normal coordinates */
static const double PART = 0.25; /* a component of a unit vector counts from this size on */

/* J^T C^-1 J at z. */
static void information_at(const struct posterior_model *model, const double *z, double *information) {
  const size_t p = model->inputs, d = model->outputs;
  double slope[INFERENCE_INPUTS][INFERENCE_OUTPUTS], weighted[INFERENCE_OUTPUTS], x[INFERENCE_INPUTS];
  double moved[INFERENCE_INPUTS], mean[INFERENCE_OUTPUTS], c[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  memset(information, 0, p * p * sizeof *information);
  posterior_expect(model, z, mean, c);
  if (!covariance_factor(d, c))
    return;
  for (size_t i = 0; i < p; i++) {
    memcpy(moved, z, p * sizeof *moved);
    for (int side = -1; side <= 1; side += 2) {
      moved[i] = z[i] + side * STEP;
      posterior_place(model, moved, x);
      for (size_t k = 0; k < d; k++) {
        const double value = kriging_predict(model->data[k].surface, x, NULL) / (2 * STEP);
        slope[i][k] = side < 0 ? -value : slope[i][k] + value;
      }
    }
  }
  for (size_t i = 0; i < p; i++) {
    covariance_solve(d, c, slope[i], weighted);
    for (size_t j = 0; j < p; j++)
      for (size_t k = 0; k < d; k++)
        information[i * p + j] += weighted[k] * slope[j][k];
  }
}

/* Medians over nodes of the sorted eigenvalues. Along a bent ridge the directions turn, but the eigenvalues stay. */
static void find_information(const struct posterior_model *model, const struct posterior *posterior,
                             struct identify *out) {
  const size_t p = model->inputs;
  double values[INFERENCE_INPUTS][NODES], h[INFERENCE_INPUTS * INFERENCE_INPUTS];
  double eigen[INFERENCE_INPUTS], vectors[INFERENCE_INPUTS * INFERENCE_INPUTS];
  for (size_t n = 0; n < NODES; n++) {
    const size_t node = posterior_node(posterior, ((double)n + 0.5) / NODES);
    information_at(model, posterior->z + node * p, h);
    covariance_eigen(p, h, eigen, vectors);
    for (size_t i = 0; i < p; i++)
      values[i][n] = fmax(eigen[i], 0);
  }
  for (size_t i = 0; i < p; i++) {
    qsort(values[i], NODES, sizeof(double), sample_ascending);
    out->direction[i].information = (values[i][NODES / 2 - 1] + values[i][NODES / 2]) / 2;
    out->determined += out->direction[i].information > 1;
  }
}

/* Directions come from the mean information over nodes, because the slopes at a single place may come from a local
 * wiggle of the surface. */
static void find_directions(const struct posterior_model *model, const struct posterior *posterior,
                            const double *covariance, struct identify *out) {
  const size_t p = model->inputs;
  double h[INFERENCE_INPUTS * INFERENCE_INPUTS] = {0}, here[INFERENCE_INPUTS * INFERENCE_INPUTS],
                              vectors[INFERENCE_INPUTS * INFERENCE_INPUTS], eigen[INFERENCE_INPUTS];
  for (size_t n = 0; n < NODES; n++) {
    information_at(model, posterior->z + posterior_node(posterior, ((double)n + 0.5) / NODES) * p, here);
    for (size_t i = 0; i < p * p; i++)
      h[i] += here[i] / NODES;
  }
  covariance_eigen(p, h, eigen, vectors);
  for (size_t i = 0; i < p; i++) {
    const double *v = vectors + i * p;
    struct identify_direction *direction = &out->direction[i];
    size_t largest = 0;
    double variance = 0;
    for (size_t a = 0; a < p; a++) {
      largest = fabs(v[a]) > fabs(v[largest]) ? a : largest;
      for (size_t b = 0; b < p; b++)
        variance += v[a] * v[b] * covariance[a * p + b];
    }
    for (size_t a = 0; a < p; a++)
      direction->along[a] = v[largest] < 0 ? -v[a] : v[a];
    direction->deviation = sqrt(variance);
  }
}

void identify_find(const struct posterior_model *model, const struct posterior *posterior, struct identify *out) {
  double covariance[INFERENCE_INPUTS * INFERENCE_INPUTS], vectors[INFERENCE_INPUTS * INFERENCE_INPUTS];
  double eigen[INFERENCE_INPUTS];
  *out = (struct identify){.inputs = model->inputs};
  posterior_moments(posterior, out->centre, covariance);
  covariance_eigen(model->inputs, covariance, eigen, vectors);
  out->widest = sqrt(eigen[0]);
  for (size_t i = 0; i < model->inputs; i++) {
    /* Widths are in quantiles of the prior, whose own 90 % interval is 0.9 wide. */
    const double low = posterior_quantile(posterior, i, 0.05), high = posterior_quantile(posterior, i, 0.95);
    out->kept[i] = (gsl_cdf_ugaussian_P(high) - gsl_cdf_ugaussian_P(low)) / 0.9;
  }
  find_information(model, posterior, out);
  find_directions(model, posterior, covariance, out);
}

bool identify_mixed(const struct identify *found, size_t direction, size_t input) {
  return fabs(found->direction[direction].along[input]) >= PART;
}
