/* From runs to inputs: which inputs of the model give the measured data.
 *
 * A fit moves an ensemble of inputs towards the data (ensemble Kalman inversion). The runs of all its rounds then give
 * the scatter over seeds and a surface through the means of each output (surfaces), with which the likelihood of any
 * inputs is known without a run: the posterior, and the directions of inputs that the data determine.
 *
 * Inputs are in normal coordinates z: the prior of each is the standard normal law. Call analysis_init() first. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { INFERENCE_INPUTS = 16, INFERENCE_OUTPUTS = 32 }; /* most of a fit */

/* ---- seed scatter ----
 *
 * The scatter of a model's outputs over seeds, as a function of the inputs. One experiment is one specimen, so a
 * measurement differs from the model's mean by this scatter, not by the standard error of a mean. */

/* Runs of one output at several points. */
struct seed_scatter_runs {
  size_t points, inputs, replicates;
  const double *x; /* points x inputs, of the order of 1 */
  /* points x replicates; NaN: no run. With shared seeds, column r has the same seed at all points */
  const double *values;
};

struct seed_scatter {
  double constant, slope[INFERENCE_INPUTS]; /* ln(variance) = constant + slope . x */
  size_t inputs;
  double shared;   /* correlation of two points' runs of the same seed, 0 to 1 */
  double skewness; /* skewness of the runs about their points' means, in standard deviations */
  double excess;   /* excess kurtosis of the same; below -1: the runs form two clusters */
  size_t freedom;  /* degrees of freedom of all values above: runs minus points */
};

/* Fits the variance: the line of greatest likelihood of the points' s^2 under chi-square, with a prior of width 1 on
 * each slope and a small part of the mean variance in every s^2. shared_seeds false: `shared` is 0. STATUS_CONTENT: no
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

/* ---- surfaces through means ----
 *
 * Stochastic kriging: a smooth surface through means over seeds, which includes the noise of the seeds (Ankenman,
 * Nelson & Staum 2010, doi 10.1287/opre.1090.0754). The surface is a Gaussian process with a linear trend and a Matern
 * covariance of order 5/2, whose variance and lengths maximise the posterior density under weak priors. It predicts its
 * own error at every place. */

struct kriging_data {
  size_t points, inputs;
  const double *x;     /* points x inputs, of the order of 1 */
  const double *mean;  /* of each point */
  const double *noise; /* points x points: covariance of the means */
};

struct kriging; /* opaque */

/* STATUS_CONTENT: fewer than three points, or more than INFERENCE_INPUTS inputs. STATUS_MEMORY. */
status kriging_fit(const struct kriging_data *data, struct kriging **out, struct error *error);
void kriging_free(struct kriging *kriging); /* NULL is fine */

/* Mean and variance of the model's mean over seeds at x. variance may be NULL. Not thread-safe for one `kriging`. */
double kriging_predict(struct kriging *kriging, const double *x, double *variance);

/* For each point: the error of predicting it from the other points, divided by the predicted standard error. `errors`
 * receives one value per point, in closed form (Dubrule 1983). The root mean square is about 1 when the predicted
 * errors are right. */
void kriging_left_out(const struct kriging *kriging, double *errors);

/* ---- posterior ----
 *
 * The posterior of a model's inputs, given the measured data, as weighted nodes. The nodes are a grid for up to four
 * inputs, and a sample for more inputs or where a grid is too coarse.
 *
 * The value of an input is the quantile Phi(z) of its own prior. Surfaces and scatter are functions of x. For laws
 * without bounds x is z; for laws with two bounds x is the quantile on a line of width sqrt(12) (posterior_place). */

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
  bool bounded[INFERENCE_INPUTS];     /* the prior has two bounds (uniform laws) */
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
/* The share of such experiments below a value, in the unit of the data. */
double posterior_below(const struct posterior_model *model, const struct posterior *posterior, size_t k, double value);

/* ---- what the data determine ----
 *
 * In some directions of the space of inputs the data contain more information than the
 * prior. Along ridges, several inputs change together and the measured quantities do not change. */

/* A direction in normal coordinates. */
struct identify_direction {
  double along[INFERENCE_INPUTS]; /* unit vector; its largest component is positive */
  double information; /* of the data, relative to the prior's: 1: equal; 0: none. Median over the posterior */
  double deviation;   /* standard deviation of the posterior along it; that of the prior is 1 */
};

struct identify {
  size_t inputs;
  double centre[INFERENCE_INPUTS];                       /* mean of the posterior */
  double kept[INFERENCE_INPUTS];                         /* width of the 90 % interval over that of the prior */
  struct identify_direction direction[INFERENCE_INPUTS]; /* in descending order of information */
  size_t determined; /* number of directions with more information from the data than from the prior */
  double widest; /* largest standard deviation of the posterior along any direction: slopes, of which the information
                    is made, have the wiggles of a surface's noise, whose squares add up; this width has not */
};

/* The information is J^T C^-1 J, with J the slopes of the surfaces and C the covariance of the data about them. It is
 * evaluated at nodes of the posterior, so a bent ridge is found, too. */
void identify_find(const struct posterior_model *model, const struct posterior *posterior, struct identify *out);

/* Is this input part of a direction that the data do not determine? */
bool identify_mixed(const struct identify *found, size_t direction, size_t input);

/* ---- from runs to the model ----
 *
 * Turns the runs of all rounds into the model for the posterior: scatter over seeds, surfaces through the means, and
 * the difference to expect between a measurement and the surfaces. */

/* The runs of `points` points: values of every output, NaN where a run is missing. */
struct surfaces_runs {
  size_t points, inputs, outputs, replicates;
  const double *z;      /* points x inputs, normal coordinates */
  const double *values; /* outputs x points x replicates */
  bool shared_seeds;    /* replicate r has the same seed at all points */
};

struct surfaces {
  struct posterior_model model; /* input of posterior_make; it points to the members below */
  struct posterior_datum data[INFERENCE_OUTPUTS];
  struct seed_scatter scatter[INFERENCE_OUTPUTS];
  struct kriging *surface[INFERENCE_OUTPUTS]; /* owned */
  double correlation[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  double left_out[INFERENCE_OUTPUTS]; /* leave-one-out rms error divided by the predicted error */
  size_t used[INFERENCE_OUTPUTS];     /* points with two runs or more */
};

/* data: value, error, resolution, specimens and shot of each output; bounded: of each input. An output's surface leaves
 * out points with fewer than two runs of it. If there are more than SURFACES_POINTS points, the last ones are used
 * (they are nearest to the data), and every second one of the first quarter. Statuses as kriging_fit() and
 * seed_scatter_fit(). *out must not move afterwards. */
enum { SURFACES_POINTS = 200 };
status surfaces_fit(const struct surfaces_runs *runs, const struct posterior_datum *data, const bool *bounded,
                    struct surfaces *out, struct error *error);
void surfaces_clear(struct surfaces *surfaces); /* a zeroed one is fine */

/* Without surfaces: the covariance of the data about the model's means (outputs x outputs), with the scatter at the
 * middle of the last `members` points. For ensemble_kalman_step(). */
status surfaces_errors(const struct surfaces_runs *runs, const struct posterior_datum *data, const bool *bounded,
                       size_t members, double *gamma, struct error *error);
/* Mean of a point's runs; NaN: the point has no run. */
double surfaces_mean(const struct surfaces_runs *runs, size_t output, size_t point);

/* ---- ensemble Kalman inversion ----
 *
 * Moves an ensemble of inputs from the prior towards the measured data, and uses the
 * ensemble's own covariances in place of derivatives (Iglesias, Law & Stuart 2013, doi 10.1088/0266-5611/29/4/045001).
 *
 * The data are used in parts. A step uses the part 1/alpha that the scatter of the misfits allows, until the parts sum
 * to 1 (data misfit controller of Iglesias & Yang 2021, doi 10.1088/1361-6420/abd29b). For a linear model with normal
 * errors the last ensemble is a sample of the posterior; for other models it approximates one. */

struct ensemble_kalman {
  size_t members, inputs, outputs;
  double *z;            /* members x inputs, normal coordinates. Borrowed; changed by a step */
  const double *g;      /* members x outputs: results of the model. A row with NaN is a member that failed */
  const double *y;      /* outputs: measured data */
  const double *gamma;  /* outputs x outputs: covariance of the measurement, including seed scatter and all errors */
  uint64_t seed, round; /* select the random numbers of the perturbed measurements */
  double least;         /* smallest part of a step, so that the remaining rounds suffice; 0: no limit */
  double tempered;      /* sum of the parts used so far, 0 to 1; a step adds to it */
};

/* Makes one step. A failed member is moved next to a member with results. STATUS_CONTENT: fewer than three members have
 * results. STATUS_MEMORY. */
status ensemble_kalman_step(struct ensemble_kalman *ensemble, struct error *error);

/* ---- covariance matrices ----
 *
 * Cholesky factors of covariance matrices, row-major arrays of n x n, by GSL. */

/* Writes the lower factor L into the lower triangle of *matrix; elements above the diagonal do not change. False: the
 * matrix is not positive definite. Call analysis_init() first. */
bool covariance_factor(size_t n, double *matrix);
/* The logarithm of the determinant of L L^T. */
double covariance_log_determinant(size_t n, const double *factor);
/* x = (L L^T)^-1 b; x may be b. */
void covariance_solve(size_t n, const double *factor, const double *b, double *x);
/* Returns b^T (L L^T)^-1 b. `half` is an array of n; it receives L^-1 b. */
double covariance_distance(size_t n, const double *factor, const double *b, double *half);
/* Writes the whole inverse of L L^T into *inverse, n x n. */
void covariance_inverse(size_t n, const double *factor, double *inverse);
/* Eigenvalues in descending order, and the eigenvectors as rows, of a symmetric matrix of at most COVARIANCE_MOST rows.
 */
enum { COVARIANCE_MOST = 32 };
void covariance_eigen(size_t n, const double *matrix, double *values, double *vectors);
