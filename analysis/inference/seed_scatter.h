/* The scatter of a model's outputs over seeds, as a function of the inputs. One experiment is one specimen, so a
 * measurement differs from the model's mean by this scatter, not by the standard error of a mean. */
#ifndef CLAST_ANALYSIS_INFERENCE_SEED_SCATTER_H
#define CLAST_ANALYSIS_INFERENCE_SEED_SCATTER_H

#include <stddef.h>

#include "schemas/status.h"

enum { SEED_SCATTER_INPUTS = 16 };

/* Runs of one output at several points. */
struct seed_scatter_runs {
  size_t points, inputs, replicates;
  const double *x; /* points x inputs, of the order of 1 */
  const double
      *values; /* points x replicates; NaN: no run. With shared seeds, column r has the same seed at all points */
};

struct seed_scatter {
  double constant, slope[SEED_SCATTER_INPUTS]; /* ln(variance) = constant + slope . x */
  size_t inputs;
  double shared;   /* correlation of two points' runs of the same seed, 0 to 1 */
  double skewness; /* skewness of the runs about their points' means, in standard deviations */
  double excess;   /* excess kurtosis of the same; below -1: the runs form two clusters */
  size_t freedom;  /* degrees of freedom of all values above: runs minus points */
};

/* Fits the variance: a line through ln(s^2) of the points, whose expectation and variance under chi-square are known
 * (digamma, trigamma), with a prior of width 1 on each slope. shared_seeds false: `shared` is 0. STATUS_CONTENT: no
 * point has two or more runs. */
status seed_scatter_fit(const struct seed_scatter_runs *runs, int shared_seeds, struct seed_scatter *out,
                        struct error *error);
double seed_scatter_variance(const struct seed_scatter *scatter, const double *x);

/* The covariance of the points' means, points x points. For points i and j it is sigma_i sigma_j / (n_i n_j) times
 * `shared` times the number of seeds that both have (the common correlation of Chen, Ankenman & Nelson 2012, doi
 * 10.1145/2133390.2133391). On the diagonal it is sigma^2 / n. */
void seed_scatter_of_means(const struct seed_scatter_runs *runs, const struct seed_scatter *scatter, double *noise);

/* Correlation of two outputs over the seeds of the same points. */
double seed_scatter_correlation(const struct seed_scatter_runs *a, const struct seed_scatter_runs *b);

#endif
