/* Fits surfaces to runs. */
#include "analysis/inference/inference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

static const double *values_of(const struct surfaces_runs *runs, size_t output, size_t point) {
  return runs->values + (output * runs->points + point) * runs->replicates;
}

static size_t count_of(const struct surfaces_runs *runs, size_t output, size_t point) {
  const double *v = values_of(runs, output, point);
  size_t n = 0;
  for (size_t r = 0; r < runs->replicates; r++)
    n += isfinite(v[r]);
  return n;
}

double surfaces_mean(const struct surfaces_runs *runs, size_t output, size_t point) {
  const double *v = values_of(runs, output, point);
  const size_t n = count_of(runs, output, point);
  double sum = 0;
  for (size_t r = 0; r < runs->replicates; r++)
    sum += isfinite(v[r]) ? v[r] : 0;
  return n ? sum / (double)n : (double)NAN;
}

/* Data for the scatter and surface of one output: copies, without points of fewer than two runs. */
struct part {
  struct seed_scatter_runs runs;
  double *x, *values, *mean, *noise;
};

#define PART __attribute__((cleanup(part_clear))) struct part
static void part_clear(struct part *part) {
  free(part->x);
  free(part->values);
  free(part->mean);
  free(part->noise);
}

static bool is_taken(const struct surfaces_runs *runs, size_t point) {
  if (runs->points <= SURFACES_POINTS || point >= runs->points - SURFACES_POINTS * 3 / 4)
    return true;
  const size_t step = (runs->points + SURFACES_POINTS - 1) / (SURFACES_POINTS / 4);
  return point % step == 0;
}

static status part_make(const struct surfaces_runs *runs, const bool *bounded, size_t output, struct part *part,
                        struct error *error) {
  struct posterior_model place = {.inputs = runs->inputs};
  memcpy(place.bounded, bounded, runs->inputs * sizeof *bounded);
  TRY(memory_array(&part->x, runs->points * runs->inputs, sizeof(double), "a surface", error));
  TRY(memory_array(&part->values, runs->points * runs->replicates, sizeof(double), "a surface", error));
  TRY(memory_array(&part->mean, runs->points, sizeof(double), "a surface", error));
  size_t n = 0;
  for (size_t i = 0; i < runs->points; i++) {
    if (!is_taken(runs, i) || count_of(runs, output, i) < 2)
      continue;
    posterior_place(&place, runs->z + i * runs->inputs, part->x + n * runs->inputs);
    memcpy(part->values + n * runs->replicates, values_of(runs, output, i), runs->replicates * sizeof(double));
    part->mean[n++] = surfaces_mean(runs, output, i);
  }
  part->runs = (struct seed_scatter_runs){.points = n,
                                          .inputs = runs->inputs,
                                          .replicates = runs->replicates,
                                          .x = part->x,
                                          .values = part->values};
  return memory_array(&part->noise, n * n, sizeof(double), "a surface", error);
}

static void find_correlations(const struct surfaces_runs *runs, double *correlation) {
  for (size_t k = 0; k < runs->outputs; k++)
    for (size_t l = 0; l <= k; l++) {
      const struct seed_scatter_runs a = {.points = runs->points,
                                          .inputs = runs->inputs,
                                          .replicates = runs->replicates,
                                          .values = values_of(runs, k, 0)};
      struct seed_scatter_runs b = a;
      b.values = values_of(runs, l, 0);
      /* With a correlation of 1, one datum would determine another exactly. */
      const double r = k == l ? 1 : 0.98 * seed_scatter_correlation(&a, &b);
      correlation[k * runs->outputs + l] = correlation[l * runs->outputs + k] = r;
    }
}

/* Root mean square of the leave-one-out errors. */
static double left_out(const struct kriging *surface, size_t points) {
  OWNED double *errors = calloc(points, sizeof *errors);
  double squares = 0;
  if (!errors)
    return NAN;
  kriging_left_out(surface, errors);
  for (size_t i = 0; i < points; i++)
    squares += errors[i] * errors[i] / (double)points;
  return sqrt(squares);
}

static status fit_output(const struct surfaces_runs *runs, const bool *bounded, size_t k, struct surfaces *out,
                         struct error *error) {
  PART part = {0};
  TRY(part_make(runs, bounded, k, &part, error));
  TRY(seed_scatter_fit(&part.runs, runs->shared_seeds, &out->scatter[k], error));
  seed_scatter_of_means(&part.runs, &out->scatter[k], part.noise);
  const struct kriging_data data = {part.runs.points, runs->inputs, part.x, part.mean, part.noise};
  TRY(kriging_fit(&data, &out->surface[k], error));
  out->left_out[k] = left_out(out->surface[k], part.runs.points);
  out->used[k] = part.runs.points;
  return STATUS_OK;
}

status surfaces_fit(const struct surfaces_runs *runs, const struct posterior_datum *data, const bool *bounded,
                    struct surfaces *out, struct error *error) {
  *out = (struct surfaces){.model = {.inputs = runs->inputs, .outputs = runs->outputs}};
  memcpy(out->model.bounded, bounded, runs->inputs * sizeof *bounded);
  status code = STATUS_OK;
  for (size_t k = 0; code == STATUS_OK && k < runs->outputs; k++) {
    code = fit_output(runs, bounded, k, out, error);
    out->data[k] = data[k];
    out->data[k].surface = out->surface[k];
    out->data[k].scatter = &out->scatter[k];
  }
  find_correlations(runs, out->correlation);
  out->model.data = out->data;
  out->model.correlation = out->correlation;
  if (code != STATUS_OK)
    surfaces_clear(out);
  return code;
}

void surfaces_clear(struct surfaces *surfaces) {
  for (size_t k = 0; k < INFERENCE_OUTPUTS; k++) {
    kriging_free(surfaces->surface[k]);
    surfaces->surface[k] = NULL;
  }
}

status surfaces_errors(const struct surfaces_runs *runs, const struct posterior_datum *data, const bool *bounded,
                       size_t members, double *gamma, struct error *error) {
  const size_t d = runs->outputs;
  double z[INFERENCE_INPUTS] = {0}, x[INFERENCE_INPUTS], deviation[INFERENCE_OUTPUTS];
  struct posterior_model place = {.inputs = runs->inputs};
  memcpy(place.bounded, bounded, runs->inputs * sizeof *bounded);
  for (size_t i = runs->points - members; i < runs->points; i++) /* the mean position of the last points */
    for (size_t a = 0; a < runs->inputs; a++)
      z[a] += runs->z[i * runs->inputs + a] / (double)members;
  posterior_place(&place, z, x);
  find_correlations(runs, gamma);
  for (size_t k = 0; k < d; k++) {
    PART part = {0};
    struct seed_scatter scatter;
    TRY(part_make(runs, bounded, k, &part, error));
    TRY(seed_scatter_fit(&part.runs, false, &scatter, error));
    deviation[k] = sqrt(seed_scatter_variance(&scatter, x) / (double)data[k].specimens);
  }
  for (size_t k = 0; k < d; k++)
    for (size_t l = 0; l < d; l++) {
      double *g = &gamma[k * d + l];
      *g *= data[k].shot == data[l].shot ? deviation[k] * deviation[l] : 0;
      if (k == l)
        *g += data[k].error * data[k].error + data[k].resolution * data[k].resolution;
    }
  return STATUS_OK;
}
