/* Ensemble Kalman inversion: moves an ensemble of inputs from the prior towards the measured data, and uses the
 * ensemble's own covariances in place of derivatives (Iglesias, Law & Stuart 2013, doi 10.1088/0266-5611/29/4/045001).
 *
 * The data are used in parts. A step uses the part 1/alpha that the scatter of the misfits allows, until the parts sum
 * to 1 (data misfit controller of Iglesias & Yang 2021, doi 10.1088/1361-6420/abd29b). For a linear model with normal
 * errors the last ensemble is a sample of the posterior; for other models it approximates one. Inputs are in normal
 * coordinates: the prior of each is the standard normal law. */
#ifndef CLAST_ANALYSIS_INFERENCE_ENSEMBLE_KALMAN_H
#define CLAST_ANALYSIS_INFERENCE_ENSEMBLE_KALMAN_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

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

#endif
