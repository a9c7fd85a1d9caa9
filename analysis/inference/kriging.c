/* Stochastic kriging: hyperparameters by Nelder and Mead, predictions by the inverse of the covariance. */
#include "analysis/inference/inference.h"

#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

/* Prior variance of the trend's constant and slopes, in variances of the means: wide. */
static const double TREND = 10;
/* Prior of ln(length): a median of 2 units of x, within a factor e; of ln(variance of the process): within e^1.5. */
static const double LENGTH = 0.69, LENGTH_WIDTH = 1, VARIANCE_WIDTH = 1.5;
static const double JITTER = 1e-6; /* share of the variance of the means, added to the diagonal */
enum { MOST_STEPS = 160, MOST_POINTS = 80 /* limits of the search for hyperparameters: each try costs points^3 */ };

struct kriging {
  size_t points, inputs;
  double *x, *y, *noise;    /* y: means minus their mean, divided by their scale; noise divided by scale^2 */
  double *factor, *inverse; /* Cholesky factor and inverse of the covariance of y */
  double *weights, *near;   /* inverse . y; covariances between a place and the points */
  double middle, scale;
  double variance, length[INFERENCE_INPUTS];
  double numbers[]; /* memory of the arrays */
};

static double covariance_of(const struct kriging *k, const double *a, const double *b) {
  double distance = 0, trend = 1;
  for (size_t i = 0; i < k->inputs; i++) {
    const double step = (a[i] - b[i]) / k->length[i];
    distance += step * step;
    trend += a[i] * b[i];
  }
  const double r = sqrt(5 * distance); /* Rasmussen & Williams 2006, eq. 4.17 */
  return k->variance * (1 + r + r * r / 3) * exp(-r) + TREND * trend;
}

static bool factorise(struct kriging *k) {
  const size_t n = k->points;
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j <= i; j++)
      k->factor[i * n + j] = covariance_of(k, k->x + i * k->inputs, k->x + j * k->inputs) + k->noise[i * n + j];
    k->factor[i * n + i] += JITTER;
  }
  return covariance_factor(n, k->factor);
}

static void set_parameters(struct kriging *k, const gsl_vector *v) {
  k->variance = exp(gsl_vector_get(v, 0));
  for (size_t i = 0; i < k->inputs; i++)
    k->length[i] = exp(gsl_vector_get(v, i + 1));
}

/* Minus the logarithm of the posterior density of the hyperparameters. */
static double cost(const gsl_vector *v, void *context) {
  struct kriging *k = context;
  set_parameters(k, v);
  if (!factorise(k))
    return 1e30;
  double sum = covariance_distance(k->points, k->factor, k->y, k->near) / 2 +
               covariance_log_determinant(k->points, k->factor) / 2;
  const double s = gsl_vector_get(v, 0) / VARIANCE_WIDTH;
  sum += s * s / 2;
  for (size_t i = 0; i < k->inputs; i++) {
    const double l = (gsl_vector_get(v, i + 1) - LENGTH) / LENGTH_WIDTH;
    sum += l * l / 2;
  }
  return isfinite(sum) ? sum : 1e30;
}

static void maximise(struct kriging *k) {
  const size_t n = k->inputs + 1;
  gsl_vector *start = gsl_vector_alloc(n), *size = gsl_vector_alloc(n);
  gsl_multimin_fminimizer *m = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, n);
  if (!start || !size || !m)
    memory_refused(); /* a few numbers for each input */
  gsl_multimin_function f = {.f = cost, .n = n, .params = k};
  gsl_vector_set_all(start, LENGTH);
  gsl_vector_set(start, 0, 0);
  gsl_vector_set_all(size, 0.7);
  gsl_multimin_fminimizer_set(m, &f, start, size);
  for (int i = 0; i < MOST_STEPS && gsl_multimin_fminimizer_size(m) > 0.02; i++)
    if (gsl_multimin_fminimizer_iterate(m))
      break;
  set_parameters(k, gsl_multimin_fminimizer_x(m));
  gsl_multimin_fminimizer_free(m);
  gsl_vector_free(start);
  gsl_vector_free(size);
}

static status make(size_t n, size_t inputs, struct kriging **out, struct error *error) {
  const size_t numbers = n * inputs + 3 * n + 3 * n * n;
  TRY(memory_array(out, 1, sizeof **out + numbers * sizeof *(*out)->numbers, "a surface", error));
  struct kriging *k = *out;
  k->points = n;
  k->inputs = inputs;
  k->x = k->numbers;
  k->y = k->x + n * inputs;
  k->weights = k->y + n;
  k->near = k->weights + n;
  k->noise = k->near + n;
  k->factor = k->noise + n * n;
  k->inverse = k->factor + n * n;
  return STATUS_OK;
}

static void copy(const struct kriging_data *data, struct kriging *k) {
  const size_t n = data->points;
  memcpy(k->x, data->x, n * data->inputs * sizeof(double));
  double squares = 0;
  for (size_t i = 0; i < n; i++)
    k->middle += data->mean[i] / (double)n;
  for (size_t i = 0; i < n; i++)
    squares += (data->mean[i] - k->middle) * (data->mean[i] - k->middle);
  k->scale = squares > 0 ? sqrt(squares / (double)(n - 1)) : 1;
  for (size_t i = 0; i < n; i++)
    k->y[i] = (data->mean[i] - k->middle) / k->scale;
  for (size_t i = 0; i < n * n; i++)
    k->noise[i] = data->noise[i] / (k->scale * k->scale);
}

/* Finds hyperparameters from every s-th point, with s so large that the search is cheap. */
static status maximise_on_part(struct kriging *k, struct error *error) {
  const size_t step = (k->points + MOST_POINTS - 1) / MOST_POINTS, n = (k->points + step - 1) / step;
  OWNED struct kriging *part = NULL;
  TRY(make(n, k->inputs, &part, error));
  for (size_t i = 0; i < n; i++) {
    memcpy(part->x + i * k->inputs, k->x + i * step * k->inputs, k->inputs * sizeof(double));
    part->y[i] = k->y[i * step];
    for (size_t j = 0; j < n; j++)
      part->noise[i * n + j] = k->noise[i * step * k->points + j * step];
  }
  maximise(part);
  k->variance = part->variance;
  memcpy(k->length, part->length, sizeof k->length);
  return STATUS_OK;
}

status kriging_fit(const struct kriging_data *data, struct kriging **out, struct error *error) {
  *out = NULL;
  if (data->points < 3 || data->inputs == 0 || data->inputs > INFERENCE_INPUTS)
    return status_fail(error, STATUS_CONTENT,
                       "kriging needs three points or more, and 1 to %d inputs; there are %zu points and %zu inputs",
                       INFERENCE_INPUTS, data->points, data->inputs);
  OWNED struct kriging *k = NULL;
  TRY(make(data->points, data->inputs, &k, error));
  copy(data, k);
  TRY(maximise_on_part(k, error));
  if (!factorise(k))
    return status_fail(
        error, STATUS_INTERNAL,
        "the covariance of a kriging surface is not positive: points are too close together, or have no scatter");
  covariance_inverse(k->points, k->factor, k->inverse);
  covariance_solve(k->points, k->factor, k->y, k->weights);
  *out = k;
  k = NULL;
  return STATUS_OK;
}

void kriging_free(struct kriging *kriging) {
  free(kriging);
}

double kriging_predict(struct kriging *k, const double *x, double *variance) {
  const size_t n = k->points;
  double mean = 0, known = 0;
  for (size_t i = 0; i < n; i++) {
    k->near[i] = covariance_of(k, x, k->x + i * k->inputs);
    mean += k->near[i] * k->weights[i];
  }
  for (size_t i = 0; variance && i < n; i++) {
    const double *row = k->inverse + i * n;
    double sum = 0;
    for (size_t j = 0; j < i; j++)
      sum += row[j] * k->near[j];
    known += k->near[i] * (2 * sum + row[i] * k->near[i]);
  }
  if (variance)
    *variance = k->scale * k->scale * fmax(covariance_of(k, x, x) - known, 0);
  return k->middle + k->scale * mean;
}

void kriging_left_out(const struct kriging *kriging, double *errors) {
  for (size_t i = 0; i < kriging->points; i++)
    errors[i] = kriging->weights[i] / sqrt(kriging->inverse[i * kriging->points + i]);
}
