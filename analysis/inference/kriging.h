/* Stochastic kriging: a smooth surface through means over seeds, which includes the noise of the seeds (Ankenman,
 * Nelson & Staum 2010, doi 10.1287/opre.1090.0754). The surface is a Gaussian process with a linear trend and a Matern
 * covariance of order 5/2, whose variance and lengths maximise the posterior density under weak priors. It predicts its
 * own error at every place. */
#ifndef CLAST_ANALYSIS_INFERENCE_KRIGING_H
#define CLAST_ANALYSIS_INFERENCE_KRIGING_H

#include <stddef.h>

#include "schemas/status.h"

enum { KRIGING_INPUTS = 16 };

struct kriging_data {
  size_t points, inputs;
  const double *x;     /* points x inputs, of the order of 1 */
  const double *mean;  /* of each point */
  const double *noise; /* points x points: covariance of the means */
};

struct kriging; /* opaque */

/* STATUS_CONTENT: fewer than three points, or more than KRIGING_INPUTS inputs. STATUS_MEMORY. */
status kriging_fit(const struct kriging_data *data, struct kriging **out, struct error *error);
void kriging_free(struct kriging *kriging); /* NULL is fine */

/* Mean and variance of the model's mean over seeds at x. variance may be NULL. Not thread-safe for one `kriging`. */
double kriging_predict(struct kriging *kriging, const double *x, double *variance);

/* For each point: the error of predicting it from the other points, divided by the predicted standard error. `errors`
 * receives one value per point, in closed form (Dubrule 1983). The root mean square is about 1 when the predicted
 * errors are right. */
void kriging_left_out(const struct kriging *kriging, double *errors);

#endif
