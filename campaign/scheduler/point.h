/* One point of a campaign that is being computed: the states of its replicates, its prefix, and what its runs cost. For
 * driver.c only. */
#pragma once

#include "campaign/document/campaign.h"
#include "db/ask/ask.h"

/* ---- cost ----
 *
 * Predicts the cost of a run from the finished runs: the engine's measure of work times a fitted rate, corrected by the
 * mean of the point's own runs. The prediction gives the order of the runs (most expensive first, so that no long run
 * starts last) and the time left. It is never part of a result. */

struct point_cost_model { /* zero-initialised */
  double seconds, work;   /* sums over finished runs: the rate is their ratio */
  int64_t runs;
};
struct point_cost { /* costs of one point's runs; the caller sets `work` and zeroes the rest */
  double work, seconds;
  int64_t runs;
};

void point_cost_learn(struct point_cost_model *model, struct point_cost *point, double wall_s);
/* Seconds of the point's next run. Before any run has finished: its work in the engine's unit, which gives the same
 * order. */
double point_cost_predict(const struct point_cost_model *model, const struct point_cost *point);

/* Input of the estimate of the time left, in wall seconds. */
struct point_cost_left {
  double missing_s;   /* predicted total for all unfinished runs, started or not */
  double under_way_s; /* time spent so far on running runs, for each at most its predicted time */
  double finished_s;  /* total time of the runs that finished during the last `elapsed_s` */
  double elapsed_s;
  double longest_s; /* largest remaining time of a running run */
  int slots;
};
/* Slots are not always busy: a run of a millisecond waits longer for its process and for the store than it computes.
 * The share of the slots' time that runs used so far is assumed for the remaining runs. */
double point_cost_time_left(const struct point_cost_left *left);

/* ---- replicates ---- */

/* POINT_LEFT: the machine ended all attempts; the next invocation tries the run again. The point stays undecided. */
enum point_state { POINT_WANTED, POINT_OUT, POINT_DONE, POINT_FAILED, POINT_LEFT };

struct point_replicate {
  unsigned char state;    /* enum point_state */
  bool surplus;           /* stored with surplus = 1 */
  bool warned, doubtful;  /* a usable run whose words mark some result; the main quantity */
  bool fields;            /* its HDF5 file exists, or there is nothing to write: an invalid run has no body */
  bool replay, replaying; /* its HDF5 file is still to be computed; is being computed */
  int lost;               /* attempts of this invocation that the machine ended */
};

struct point {
  struct scene *scene; /* owned */
  int64_t id;          /* in the store */
  struct design_stopping rule;
  int64_t prefix;      /* replicates that are to be complete */
  int64_t complete;    /* replicates below this are done or failed */
  int64_t wanted_from; /* no replicate below this is in state POINT_WANTED */
  double reached;      /* half width of the rule when it was last tested; NaN: not yet */
  bool decided;
  enum design_verdict verdict;
  int64_t capacity; /* of the arrays */
  struct point_replicate *replicates;
  double *values;  /* main quantity by replicate; NaN = failed or not computed */
  int64_t left;    /* replicates in state POINT_LEFT */
  int64_t out;     /* runs and replays on slots */
  int64_t replays; /* replays wanted and not yet started */
  struct point_cost cost;
};

/* The value of a stored run for the rule. NaN: failed, excluded, or withheld. */
double point_value(const struct point *point, const struct field *row, const struct ask_run_of_point *run);
/* Takes ownership of the scene. Never NULL. */
struct point *point_create(const struct campaign *campaign, struct scene *scene);
void point_free(struct point *point); /* NULL is fine */

/* Makes space for replicate r. False when memory is refused. */
bool point_reserve(struct point *point, int64_t replicate);
void point_want_again(struct point *point, int64_t replicate); /* a failed attempt that may be repeated */
void point_finish_replicate(struct point *point, int64_t replicate, enum point_state state, double value);
/* Judges complete prefixes until a prefix is incomplete or the point is decided. True when the prefix or the decision
 * changed. */
bool point_judge(struct point *point);
/* The lowest replicate to send out now, -1: none. With `ahead` up to one batch beyond the prefix. */
int64_t point_next(struct point *point, bool ahead);
/* After the decision: marks which replicates' fields are to be computed again. */
void point_want_fields(struct point *point, const struct campaign *campaign);
/* Leaves the replicate to the next invocation. */
void point_leave(struct point *point, int64_t replicate);
/* True when the point has nothing to send out and nothing is out. */
bool point_over(struct point *point);
/* Number of runs of the prefix that are neither done nor failed. */
int64_t point_missing(const struct point *point);
