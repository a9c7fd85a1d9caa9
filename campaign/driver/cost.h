/* Predicts the cost of a run from the finished runs: the engine's measure of work times a fitted rate, corrected by the
 * mean of the point's own runs. The prediction gives the order of the runs (most expensive first, so that no long run
 * starts last) and the time left. It is never part of a result. */
#ifndef CLAST_CAMPAIGN_DRIVER_COST_H
#define CLAST_CAMPAIGN_DRIVER_COST_H

#include <stdint.h>

struct cost_model {     /* zero-initialised */
  double seconds, work; /* sums over finished runs: the rate is their ratio */
  int64_t runs;
};
struct cost_point { /* costs of one point's runs; the caller sets `work` and zeroes the rest */
  double work, seconds;
  int64_t runs;
};

void cost_learn(struct cost_model *model, struct cost_point *point, double wall_s);
/* Seconds of the point's next run. Before any run has finished: its work in the engine's unit, which gives the same
 * order. */
double cost_predict(const struct cost_model *model, const struct cost_point *point);

/* Input of the estimate of the time left, in wall seconds. */
struct cost_left {
  double missing_s;   /* predicted total for all unfinished runs, started or not */
  double under_way_s; /* time spent so far on running runs, for each at most its predicted time */
  double finished_s;  /* total time of the runs that finished during the last `elapsed_s` */
  double elapsed_s;
  double longest_s; /* largest remaining time of a running run */
  int slots;
};
/* Slots are not always busy: a run of a millisecond waits longer for its process and for the store than it computes.
 * The share of the slots' time that runs used so far is assumed for the remaining runs. */
double cost_time_left(const struct cost_left *left);

#endif
