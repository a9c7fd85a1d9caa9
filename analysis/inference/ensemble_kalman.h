/* Ensemble Kalman inversion: moves an ensemble of inputs from the prior towards what was measured, with the ensemble's
 * own covariances in the place of derivatives (Iglesias, Law & Stuart 2013, doi 10.1088/0266-5611/29/4/045001).
 *
 * The data are taken in by parts. A step takes the part 1/alpha of them that the scatter of the misfits allows, until
 * the parts sum to 1 (data misfit controller of Iglesias & Yang 2021, doi 10.1088/1361-6420/abd29b). For a linear model
 * with normal errors the last ensemble is a sample of the posterior; for others it is near it. Inputs are in normal
 * coordinates: the prior of each is the standard normal law. */
#ifndef CLAST_ANALYSIS_INFERENCE_ENSEMBLE_KALMAN_H
#define CLAST_ANALYSIS_INFERENCE_ENSEMBLE_KALMAN_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct ensemble_kalman {
  size_t members, inputs, outputs;
  double *z;            /* members x inputs, normal coordinates. Borrowed; changed by a step */
  const double *g;      /* members x outputs: what the model gives. A row with NaN is a member that failed */
  const double *y;      /* outputs: what was measured */
  const double *gamma;  /* outputs x outputs: covariance of the measurement, seed scatter and all errors in it */
  uint64_t seed, round; /* of the perturbed measurements */
  double least;         /* part that a step takes at least, so that the rounds that are left suffice; 0: none */
  double tempered;      /* sum of the parts taken so far, 0 to 1; a step adds to it */
};

/* One step. A member that failed is put beside a member that did not. STATUS_CONTENT: fewer than three members have
 * results. STATUS_MEMORY. */
status ensemble_kalman_step(struct ensemble_kalman *ensemble, struct error *error);

#endif
