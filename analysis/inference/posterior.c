/* Likelihood, grid, sampler, and statistics of weighted nodes. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "schemas/memory.h"

/* Nodes per input of a grid of 1 to 4 inputs. */
enum { GRID_INPUTS = 4 };
static const size_t nodes_of[GRID_INPUTS + 1] = {0, 400, 60, 22, 12};
enum { ZOOMS = 4, PREDICTED_NODES = 400 };
static const double NEGLIGIBLE = 12;   /* drop below the largest log density: a density of 6e-6 of the maximum */
static const double FEWEST_NODES = 40; /* effective nodes; with fewer a grid is too coarse */

double posterior_share(double z) {
  return gsl_cdf_ugaussian_P(z);
}

double posterior_coordinate(double share) {
  return gsl_cdf_ugaussian_Pinv(fmin(fmax(share, 1e-12), 1 - 1e-12));
}

void posterior_place(const struct posterior_model *model, const double *z, double *x) {
  for (size_t i = 0; i < model->inputs; i++)
    x[i] = model->bounded[i] ? sqrt(12) * (gsl_cdf_ugaussian_P(z[i]) - 0.5) : z[i];
}

void posterior_expect(const struct posterior_model *model, const double *z, double *mean, double *covariance) {
  const size_t d = model->outputs;
  double x[INFERENCE_INPUTS], surface[INFERENCE_OUTPUTS], scatter[INFERENCE_OUTPUTS];
  posterior_place(model, z, x);
  for (size_t k = 0; k < d; k++) {
    const struct posterior_datum *datum = &model->data[k];
    mean[k] = kriging_predict(datum->surface, x, &surface[k]);
    scatter[k] = sqrt(seed_scatter_variance(datum->scatter, x) / (double)datum->specimens);
  }
  for (size_t k = 0; k < d; k++)
    for (size_t l = 0; l < d; l++) {
      const struct posterior_datum *datum = &model->data[k];
      const bool together = model->data[l].shot == datum->shot;
      double *c = &covariance[k * d + l];
      *c = together ? scatter[k] * scatter[l] * (k == l ? 1 : model->correlation[k * d + l]) : 0;
      if (k == l)
        *c += datum->error * datum->error + datum->resolution * datum->resolution + surface[k];
    }
}

/* Logarithm of the normal density of the data. */
static double likelihood(const struct posterior_model *model, const double *z) {
  const size_t d = model->outputs;
  double mean[INFERENCE_OUTPUTS], half[INFERENCE_OUTPUTS], c[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  posterior_expect(model, z, mean, c);
  for (size_t k = 0; k < d; k++)
    mean[k] = model->data[k].value - mean[k];
  if (!covariance_factor(d, c))
    return -HUGE_VAL;
  return -(covariance_distance(d, c, mean, half) + covariance_log_determinant(d, c)) / 2;
}

/* ---- the grid ---- */

struct box { /* limits in quantiles of the priors */
  double low[INFERENCE_INPUTS], high[INFERENCE_INPUTS];
};

/* Nodes are the centres of cells of equal prior probability. Returns the largest log density. */
static double fill_grid(const struct posterior_model *model, const struct box *box, size_t side,
                        struct posterior *out) {
  double most = -HUGE_VAL;
  for (size_t n = 0; n < out->count; n++) {
    size_t rest = n;
    for (size_t i = 0; i < model->inputs; i++, rest /= side) {
      const double share = ((double)(rest % side) + 0.5) / (double)side;
      out->z[n * model->inputs + i] = gsl_cdf_ugaussian_Pinv(box->low[i] + share * (box->high[i] - box->low[i]));
    }
    out->weight[n] = likelihood(model, out->z + n * model->inputs);
    most = fmax(most, out->weight[n]);
  }
  return most;
}

/* Shrinks the box to the nodes that are not negligible, plus one cell. Returns the ratio of the new volume to the old
 * one. */
static double shrink(const struct posterior_model *model, const struct posterior *grid, double most, size_t side,
                     struct box *box) {
  double factor = 1;
  for (size_t i = 0; i < model->inputs; i++) {
    const double cell = (box->high[i] - box->low[i]) / (double)side;
    double low = 1, high = 0;
    for (size_t n = 0; n < grid->count; n++)
      if (grid->weight[n] > most - NEGLIGIBLE) {
        const double u = gsl_cdf_ugaussian_P(grid->z[n * model->inputs + i]);
        low = fmin(low, u);
        high = fmax(high, u);
      }
    low = fmax(low - 1.5 * cell, box->low[i]);
    high = fmin(high + 1.5 * cell, box->high[i]);
    factor *= (high - low) / (box->high[i] - box->low[i]);
    box->low[i] = low;
    box->high[i] = high;
  }
  return factor;
}

static status allocate(struct posterior *out, size_t count, size_t inputs, struct error *error) {
  *out = (struct posterior){.count = count, .inputs = inputs};
  TRY(memory_array(&out->z, count * inputs, sizeof(double), "the posterior", error));
  return memory_array(&out->weight, count, sizeof(double), "the posterior", error);
}

/* *effective: the number of nodes that have most of the weight. */
static status make_grid(const struct posterior_model *model, struct posterior *out, double *effective,
                        struct error *error) {
  const size_t side = nodes_of[model->inputs];
  size_t count = 1;
  struct box box;
  for (size_t i = 0; i < model->inputs; i++) {
    count *= side;
    box.low[i] = 0;
    box.high[i] = 1;
  }
  TRY(allocate(out, count, model->inputs, error));
  double most = fill_grid(model, &box, side, out);
  for (int zoom = 0; zoom < ZOOMS && shrink(model, out, most, side, &box) < 0.5; zoom++)
    most = fill_grid(model, &box, side, out);
  if (most == -HUGE_VAL)
    return status_fail(
        error, STATUS_CONTENT,
        "no inputs within the priors give the measured values: widen the priors (`vary`), or check the measurements");
  double sum = 0, squares = 0;
  for (size_t n = 0; n < out->count; n++)
    sum += out->weight[n] = exp(out->weight[n] - most);
  for (size_t n = 0; n < out->count; n++) {
    out->weight[n] /= sum;
    squares += out->weight[n] * out->weight[n];
  }
  *effective = 1 / squares;
  return STATUS_OK;
}

/* A sample of the posterior by walkers that move along lines through each other: the stretch move of Goodman & Weare
 * (2010, doi 10.2140/camcos.2010.5.65), whose cost does not depend on how stretched the posterior is.
 *
 * The walkers begin at draws from the prior and go to the posterior in stages (Del Moral, Doucet & Jasra 2006,
 * doi 10.1111/j.1467-9868.2006.00553.x): at each the likelihood has a higher power, up to 1. The next power leaves half
 * of the walkers effective; they are drawn anew by their weights and then move. A walker that began far from the data,
 * at a lower maximum, is so replaced: the moves alone do not bring it over. */
enum { SAMPLE_NODES = 4000, WALKERS = 80, HALF = WALKERS / 2, KEPT = SAMPLE_NODES / WALKERS, EVERY = 2 };
enum { STAGE_SWEEPS = 10, LAST_SWEEPS = 100 };
static const double STRETCH = 2; /* a, as in the paper */

struct walkers {
  double z[WALKERS * INFERENCE_INPUTS], likelihood[WALKERS]; /* its logarithm */
  double power;                                              /* of the likelihood, 0 to 1 */
  uint64_t seed, sweeps;                                     /* sweeps so far */
};

static double log_prior(size_t inputs, const double *z) {
  double sum = 0;
  for (size_t i = 0; i < inputs; i++)
    sum -= z[i] * z[i] / 2;
  return sum;
}

/* One sweep: each half moves along lines through walkers of the other half. */
static void sweep(const struct posterior_model *model, struct walkers *all) {
  const size_t p = model->inputs;
  double moved[INFERENCE_INPUTS];
  for (size_t w = 0; w < WALKERS; w++) {
    uint64_t bits[4];
    random_bits(all->seed, RANDOM_INFERENCE, UINT64_C(1) << 62 | all->sweeps << 16 | w, 0, bits);
    const size_t other = (size_t)(random_uniform(bits[0]) * HALF) + (w >= HALF ? 0 : HALF);
    const double root = 1 / sqrt(STRETCH) + random_uniform(bits[1]) * (sqrt(STRETCH) - 1 / sqrt(STRETCH));
    const double stretch = root * root; /* of density 1 / sqrt(stretch) between 1/a and a */
    double *const z = all->z + w * p;
    for (size_t i = 0; i < p; i++)
      moved[i] = all->z[other * p + i] + stretch * (z[i] - all->z[other * p + i]);
    const double there = likelihood(model, moved);
    const double gain = all->power * (there - all->likelihood[w]) + log_prior(p, moved) - log_prior(p, z);
    if (log(random_uniform(bits[2])) < (double)(p - 1) * log(stretch) + gain) {
      memcpy(z, moved, p * sizeof *moved);
      all->likelihood[w] = there;
    }
  }
  all->sweeps++;
}

/* Weights of the walkers if the power rises by `more`. Returns the effective number of walkers. */
static double weigh(const struct walkers *all, double more, double weight[WALKERS]) {
  double most = -HUGE_VAL, sum = 0, squares = 0;
  for (size_t w = 0; w < WALKERS; w++)
    most = fmax(most, all->likelihood[w]);
  for (size_t w = 0; w < WALKERS; w++) {
    weight[w] = exp(more * (all->likelihood[w] - most));
    sum += weight[w];
    squares += weight[w] * weight[w];
  }
  for (size_t w = 0; w < WALKERS; w++)
    weight[w] /= sum;
  return sum * sum / squares;
}

/* Raises the power and draws the walkers anew, by evenly spaced shares of the weight; copies of one walker go to either
 * half. */
static void next_stage(const struct posterior_model *model, struct walkers *all) {
  const size_t p = model->inputs;
  const struct walkers before = *all;
  double weight[WALKERS], low = 0, high = 1 - all->power, below = 0;
  if (weigh(all, high, weight) < HALF)
    for (int i = 0; i < 60; i++) {
      const double middle = (low + high) / 2;
      if (weigh(all, middle, weight) < HALF)
        high = middle;
      else
        low = middle;
    }
  weigh(all, high, weight);
  all->power = high == 1 - all->power ? 1 : all->power + high;
  for (size_t from = 0, drawn = 0; from < WALKERS && drawn < WALKERS; from++) {
    below += weight[from];
    for (; drawn < WALKERS && (((double)drawn + 0.5) / WALKERS < below || from == WALKERS - 1); drawn++) {
      const size_t to = drawn / 2 + (drawn % 2) * HALF;
      memcpy(all->z + to * p, before.z + from * p, p * sizeof *all->z);
      all->likelihood[to] = before.likelihood[from];
    }
  }
}

/* Fills z, SAMPLE_NODES x inputs. The same seed gives the same sample. */
static void fill_sample(const struct posterior_model *model, uint64_t seed, double *z) {
  const size_t p = model->inputs;
  struct walkers all = {.seed = seed};
  for (size_t w = 0; w < WALKERS; w++) {
    for (size_t i = 0; i < p; i++)
      all.z[w * p + i] = gsl_cdf_ugaussian_Pinv(
          fmax(random_draw(seed, RANDOM_INFERENCE, UINT64_C(1) << 63 | w << 16, i), 0x1p-54));
    all.likelihood[w] = likelihood(model, all.z + w * p);
  }
  while (all.power < 1) {
    next_stage(model, &all);
    for (int i = 0; i < STAGE_SWEEPS; i++)
      sweep(model, &all);
  }
  for (int i = 0; i < LAST_SWEEPS; i++)
    sweep(model, &all);
  for (size_t kept = 0; kept < KEPT; kept++) {
    for (int i = 0; i < EVERY; i++)
      sweep(model, &all);
    memcpy(z + kept * WALKERS * p, all.z, WALKERS * p * sizeof *z);
  }
}

status posterior_make(const struct posterior_model *model, uint64_t seed, struct posterior *out, struct error *error) {
  *out = (struct posterior){0};
  if (model->inputs <= GRID_INPUTS) {
    double effective = 0;
    TRY(make_grid(model, out, &effective, error));
    if (effective >= FEWEST_NODES)
      return STATUS_OK;
    posterior_clear(out);
  }
  TRY(allocate(out, SAMPLE_NODES, model->inputs, error));
  out->sampled = true;
  fill_sample(model, seed, out->z);
  for (size_t n = 0; n < out->count; n++)
    out->weight[n] = 1 / (double)out->count;
  return STATUS_OK;
}

void posterior_clear(struct posterior *posterior) {
  free(posterior->z);
  free(posterior->weight);
  *posterior = (struct posterior){0};
}

/* ---- statistics of the nodes ---- */

struct weighted {
  double z, weight; /* z comes first: sample_ascending() sorts by it */
};

double posterior_quantile(const struct posterior *posterior, size_t input, double p) {
  OWNED struct weighted *nodes = malloc(posterior->count * sizeof *nodes);
  if (!nodes)
    return NAN;
  for (size_t n = 0; n < posterior->count; n++)
    nodes[n] = (struct weighted){posterior->z[n * posterior->inputs + input], posterior->weight[n]};
  qsort(nodes, posterior->count, sizeof *nodes, sample_ascending); /* by z */

  /* Nodes of the same z (a column of the grid) are merged; half of the weight counts as below z, half as above. */
  double before = -1, z_before = nodes[0].z, below = 0;
  for (size_t n = 0; n < posterior->count;) {
    const double z = nodes[n].z;
    double here = 0;
    for (; n < posterior->count && nodes[n].z - z <= 1e-9; n++)
      here += nodes[n].weight;
    const double middle = below + here / 2;
    if (middle >= p)
      return before < 0 ? z : z_before + (z - z_before) * (p - before) / (middle - before);
    before = middle;
    z_before = z;
    below += here;
  }
  return z_before;
}

void posterior_moments(const struct posterior *posterior, double *mean, double *covariance) {
  const size_t p = posterior->inputs;
  memset(mean, 0, p * sizeof *mean);
  memset(covariance, 0, p * p * sizeof *covariance);
  for (size_t n = 0; n < posterior->count; n++)
    for (size_t i = 0; i < p; i++)
      mean[i] += posterior->weight[n] * posterior->z[n * p + i];
  for (size_t n = 0; n < posterior->count; n++)
    for (size_t i = 0; i < p; i++)
      for (size_t j = 0; j < p; j++)
        covariance[i * p + j] += posterior->weight[n] * (posterior->z[n * p + i] - mean[i]) *
                                 (posterior->z[n * p + j] - mean[j]);
}

size_t posterior_node(const struct posterior *posterior, double p) {
  double below = 0;
  for (size_t n = 0; n < posterior->count; n++) {
    below += posterior->weight[n];
    if (below > p)
      return n;
  }
  return posterior->count - 1;
}

/* Mean and standard deviation of output k at evenly drawn nodes. */
static void expect_at_nodes(const struct posterior_model *model, const struct posterior *posterior, size_t k,
                            double mean[PREDICTED_NODES], double deviation[PREDICTED_NODES]) {
  double m[INFERENCE_OUTPUTS], c[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  for (size_t n = 0; n < PREDICTED_NODES; n++) {
    const size_t node = posterior_node(posterior, ((double)n + 0.5) / PREDICTED_NODES);
    posterior_expect(model, posterior->z + node * posterior->inputs, m, c);
    mean[n] = m[k];
    deviation[n] = sqrt(c[k * model->outputs + k]);
  }
}

static double share_below(const double *mean, const double *deviation, double value) {
  double share = 0;
  for (size_t n = 0; n < PREDICTED_NODES; n++)
    share += gsl_cdf_ugaussian_P((value - mean[n]) / deviation[n]) / PREDICTED_NODES;
  return share;
}

double posterior_predicted(const struct posterior_model *model, const struct posterior *posterior, size_t k, double p) {
  double mean[PREDICTED_NODES], deviation[PREDICTED_NODES], low = HUGE_VAL, high = -HUGE_VAL;
  expect_at_nodes(model, posterior, k, mean, deviation);
  for (size_t n = 0; n < PREDICTED_NODES; n++) {
    low = fmin(low, mean[n] - 8 * deviation[n]);
    high = fmax(high, mean[n] + 8 * deviation[n]);
  }
  for (int i = 0; i < 60; i++) {
    const double middle = (low + high) / 2;
    if (share_below(mean, deviation, middle) < p)
      low = middle;
    else
      high = middle;
  }
  return (low + high) / 2;
}

double posterior_below(const struct posterior_model *model, const struct posterior *posterior, size_t k, double value) {
  double mean[PREDICTED_NODES], deviation[PREDICTED_NODES];
  expect_at_nodes(model, posterior, k, mean, deviation);
  return share_below(mean, deviation, value);
}
