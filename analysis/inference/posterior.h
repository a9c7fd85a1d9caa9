/* The posterior of a model's inputs, given the measured data, as weighted nodes. The nodes are a grid for up to four
 * inputs, and a sample for more inputs or where a grid is too coarse.
 *
 * Inputs are in normal coordinates z: the prior of each is the standard normal law, and the value of an input is the
 * quantile Phi(z) of its own prior. Surfaces and scatter are functions of x. For laws without bounds x is z; for laws
 * with two bounds x is the quantile on a line of width sqrt(12) (posterior_place). */
#ifndef CLAST_ANALYSIS_INFERENCE_POSTERIOR_H
#define CLAST_ANALYSIS_INFERENCE_POSTERIOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "analysis/inference/kriging.h"
#include "analysis/inference/seed_scatter.h"

enum { POSTERIOR_INPUTS = 16, POSTERIOR_OUTPUTS = 32, POSTERIOR_GRID_INPUTS = 4 };

/* One measured number and the corresponding output of the model. */
struct posterior_datum {
  double value;
  double error;            /* standard deviation of the measurement */
  double resolution;       /* standard deviation of the error from the resolution */
  size_t specimens;        /* number of specimens that `value` is the mean of: 1 for one experiment */
  size_t shot;             /* data of one shot have the same specimen, and so correlated scatter over seeds */
  struct kriging *surface; /* borrowed */
  const struct seed_scatter *scatter; /* borrowed */
};

struct posterior_model {
  size_t inputs, outputs;
  bool bounded[POSTERIOR_INPUTS];     /* the prior has two bounds (uniform laws) */
  const struct posterior_datum *data; /* outputs */
  const double *correlation;          /* outputs x outputs: correlation over seeds; used within a shot */
};

struct posterior {
  size_t count, inputs;
  double *z, *weight; /* count x inputs; count, with sum 1. Owned */
  bool sampled;       /* true: a sample; false: a grid */
};

/* The share of a prior below a normal coordinate, and back; shares of 0 and 1 become 1e-12 and 1 - 1e-12. */
double posterior_share(double z);
double posterior_coordinate(double share);
/* Converts normal coordinates z to the coordinates x of the surfaces. */
void posterior_place(const struct posterior_model *model, const double *z, double *x);
/* Computes the means of the outputs (outputs) and their covariance about the data (outputs x outputs). The covariance
 * is a sum: scatter of the specimens, error of the measurement, error of the resolution, error of the surface. */
void posterior_expect(const struct posterior_model *model, const double *z, double *mean, double *covariance);
/* Logarithm of the normal density of the data. */
double posterior_likelihood(const struct posterior_model *model, const double *z);

/* STATUS_CONTENT: too many inputs or outputs. STATUS_MEMORY. */
status posterior_make(const struct posterior_model *model, uint64_t seed, struct posterior *out, struct error *error);
void posterior_clear(struct posterior *posterior); /* a zeroed one is fine */

/* Quantile of one input's z, p in (0, 1), with linear interpolation between nodes. */
double posterior_quantile(const struct posterior *posterior, size_t input, double p);
/* Means of z, and their covariance (inputs x inputs). */
void posterior_moments(const struct posterior *posterior, double *mean, double *covariance);
/* The node at share p of the cumulative weight. It gives draws from the posterior without random numbers. */
size_t posterior_node(const struct posterior *posterior, double p);

/* Quantile over the posterior of output k in one more experiment, measured like the first. */
double posterior_predicted(const struct posterior_model *model, const struct posterior *posterior, size_t k, double p);
/* The share of such experiments below the measured value. */
double posterior_below(const struct posterior_model *model, const struct posterior *posterior, size_t k);

#endif
