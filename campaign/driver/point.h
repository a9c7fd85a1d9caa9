/* One point of a campaign that is being computed: the states of its replicates, its prefix, its cost. For the driver
 * only. */
#ifndef CLAST_CAMPAIGN_DRIVER_POINT_H
#define CLAST_CAMPAIGN_DRIVER_POINT_H

#include "campaign/design/stopping.h"
#include "campaign/document/campaign.h"
#include "campaign/driver/cost.h"

/* POINT_LEFT: the machine ended all attempts; the next invocation tries the run again. The point stays undecided. */
enum point_state { POINT_WANTED, POINT_OUT, POINT_DONE, POINT_FAILED, POINT_LEFT };

struct point_replicate {
  unsigned char state;    /* enum point_state */
  bool surplus;           /* stored with surplus = 1 */
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
  bool decided;
  enum design_verdict verdict;
  int64_t capacity; /* of the arrays */
  struct point_replicate *replicates;
  double *values;  /* main quantity by replicate; NaN = failed or not computed */
  int64_t left;    /* replicates in state POINT_LEFT */
  int64_t out;     /* runs and replays on slots */
  int64_t replays; /* replays wanted and not yet started */
  struct cost_point cost;
};

/* Takes ownership of the scene. NULL when memory is out (the scene is freed). */
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

#endif
