/* The posterior of a model's inputs, given what was measured, as weighted nodes: a grid for up to four inputs, a sample
 * for more, or where a grid is too coarse.
 *
 * Inputs are in normal coordinates z: the prior of each is the standard normal law, and the quantile of its own prior
 * at Phi(z) is its value. Surfaces and scatter are functions of x, which is z for laws without bounds and the same
 * quantile on a line of width sqrt(12) for laws with two (posterior_place). */
#ifndef CLAST_ANALYSIS_INFERENCE_POSTERIOR_H
#define CLAST_ANALYSIS_INFERENCE_POSTERIOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "analysis/inference/kriging.h"
#include "analysis/inference/seed_scatter.h"

enum { POSTERIOR_INPUTS = 16, POSTERIOR_OUTPUTS = 32, POSTERIOR_GRID_INPUTS = 4 };

/* One number that was measured, and the model's output beside it. */
struct posterior_datum {
  double value;
  double error;                       /* standard deviation of the measurement */
  double resolution;                  /* standard deviation of what a finer resolution would change */
  size_t specimens;                   /* that `value` is the mean of: 1 for one experiment */
  size_t shot;                        /* data of one shot share the specimen, and so the scatter over seeds */
  struct kriging *surface;            /* borrowed */
  const struct seed_scatter *scatter; /* borrowed */
};

struct posterior_model {
  size_t inputs, outputs;
  bool bounded[POSTERIOR_INPUTS];     /* the prior has two bounds (uniform laws) */
  const struct posterior_datum *data; /* outputs */
  const double *correlation;          /* outputs x outputs: over seeds; used within a shot */
};

struct posterior {
  size_t count, inputs;
  double *z, *weight; /* count x inputs; count, of sum 1. Owned */
  bool sampled;       /* not a grid */
};

/* The share of a prior below a normal coordinate, and back; shares of 0 and 1 become 1e-12 and 1 - 1e-12. */
double posterior_share(double z);
double posterior_coordinate(double share);
/* The place of normal coordinates on the surfaces. */
void posterior_place(const struct posterior_model *model, const double *z, double *x);
/* Means of the outputs and their covariance about the data: scatter of the specimens, error of the measurement, error
 * of the resolution, error of the surface. outputs, outputs x outputs. */
void posterior_expect(const struct posterior_model *model, const double *z, double *mean, double *covariance);
/* Logarithm of the normal density of the data. */
double posterior_likelihood(const struct posterior_model *model, const double *z);

/* STATUS_CONTENT: too many inputs or outputs. STATUS_MEMORY. */
status posterior_make(const struct posterior_model *model, uint64_t seed, struct posterior *out, struct error *error);
void posterior_clear(struct posterior *posterior); /* a zeroed one is fine */

/* Quantile of one input's z, p in (0, 1); between nodes by a straight line. */
double posterior_quantile(const struct posterior *posterior, size_t input, double p);
/* Means of z, and their covariance (inputs x inputs). */
void posterior_moments(const struct posterior *posterior, double *mean, double *covariance);
/* The node whose share of the weight holds p: draws from the posterior without random numbers. */
size_t posterior_node(const struct posterior *posterior, double p);

/* Quantile of output k of one more experiment, measured like the first, over the posterior. */
double posterior_predicted(const struct posterior_model *model, const struct posterior *posterior, size_t k, double p);
/* The share of such experiments below what was measured. */
double posterior_below(const struct posterior_model *model, const struct posterior *posterior, size_t k);

#endif
