/* What a run will cost, from the runs that have finished: the engine's own measure of work times a fitted rate,
 * corrected by the mean of the point's own runs. It gives the order of the runs (most expensive first, so that no long
 * one is left for the end) and the time left. It is never part of a result. */
#ifndef CLAST_CAMPAIGN_DRIVER_COST_H
#define CLAST_CAMPAIGN_DRIVER_COST_H

#include <stdint.h>

struct cost_model {     /* zero-initialised */
  double seconds, work; /* sums over finished runs: the rate is their ratio */
  int64_t runs;
};
struct cost_point { /* one point's own record; `work` set by the caller, the rest zero */
  double work, seconds;
  int64_t runs;
};

void cost_learn(struct cost_model *model, struct cost_point *point, double wall_s);
/* Seconds of the point's next run. Before any run has finished: its work in the engine's unit, which gives the same
 * order. */
double cost_predict(const struct cost_model *model, const struct cost_point *point);

/* What the time left follows from, in wall seconds. */
struct cost_left {
  double missing_s;   /* predicted, of all runs that are not finished, those under way included */
  double under_way_s; /* spent on those under way so far, at most what was predicted of each */
  double finished_s;  /* of the runs finished since `elapsed_s` ago */
  double elapsed_s;
  double longest_s; /* the most that one run under way still needs */
  int slots;
};
/* Slots are not busy all the time: a run of a millisecond waits longer for its process and for the store than it takes.
 * So the share of the slots' time that runs have had until now is the share that they will have. */
double cost_time_left(const struct cost_left *left);

#endif
