/* Turns the runs of all rounds into the model for the posterior: scatter over seeds, surfaces through the means, and
 * the difference to expect between a measurement and the surfaces. */
#ifndef CLAST_ANALYSIS_INFERENCE_SURFACES_H
#define CLAST_ANALYSIS_INFERENCE_SURFACES_H

#include "analysis/inference/posterior.h"

/* The runs of `points` points: values of every output, NaN where a run is missing. */
struct surfaces_runs {
  size_t points, inputs, outputs, replicates;
  const double *z;      /* points x inputs, normal coordinates */
  const double *values; /* outputs x points x replicates */
  bool shared_seeds;    /* replicate r has the same seed at all points */
};

struct surfaces {
  struct posterior_model model; /* input of posterior_make; it points to the members below */
  struct posterior_datum data[POSTERIOR_OUTPUTS];
  struct seed_scatter scatter[POSTERIOR_OUTPUTS];
  struct kriging *surface[POSTERIOR_OUTPUTS]; /* owned */
  double correlation[POSTERIOR_OUTPUTS * POSTERIOR_OUTPUTS];
  double left_out[POSTERIOR_OUTPUTS]; /* leave-one-out rms error divided by the predicted error */
  size_t used[POSTERIOR_OUTPUTS];     /* points with two runs or more */
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

#endif
