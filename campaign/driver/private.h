/* What the driver's files share: its state, and the window of points under way. For driver.c, window.c, send.c and
 * receive.c only. */
#ifndef CLAST_CAMPAIGN_DRIVER_PRIVATE_H
#define CLAST_CAMPAIGN_DRIVER_PRIVATE_H

#include <math.h>

#include "analysis/statistics/sample.h"
#include "campaign/document/campaign_walk.h"
#include "campaign/driver/driver.h"
#include "campaign/driver/point.h"

#define DRIVER_NOTHING ((double)NAN)

/* Most points in the window. Campaigns of up to this many points start all runs in order of cost, most expensive first;
 * a larger campaign orders only the points in the window. Filling the window may delay the first run by
 * DRIVER_FILL_S. */
enum { DRIVER_WINDOW = 1024 };
#define DRIVER_FILL_S 0.05

struct flight {        /* a task on a slot */
  struct point *point; /* NULL: this place is free */
  int64_t replicate;
  int attempt;
  bool replay;    /* only for its fields */
  double started; /* s, clock_s() */
  uint8_t identity[16];
  uint64_t seed;
};

struct driver {
  const struct campaign *campaign;
  struct store *store;
  struct driver_options options;   /* with a store_path */
  double time_limit, memory_limit; /* limits of an attempt, s and bytes; 0 = none */
  struct driver_summary summary;
  struct campaign_walk walk;
  const char **paths;      /* paths of the axes, for the store */
  const struct field *row; /* main quantity */
  bool row_of_outcome;
  struct point **points; /* the window */
  size_t point_count;
  uint64_t expanded; /* design points taken */
  struct flight *flights;
  size_t flight_count;
  struct driver_seen *seen; /* ids of the points met: a hash table of window.c */
  uint8_t *task;            /* bytes of the last task given out */
  struct cost_model cost;
  struct sample_moments moments;    /* of the main quantity */
  int64_t first_done, first_failed; /* of the first CAMPAIGN_FIRST_RUNS of this invocation */
  int64_t started_done;             /* runs finished in this invocation, for the rate */
  double finished_s;                /* their wall time */
  double begin, last_left, seconds_left;
  int64_t fields_missing; /* fields files of stored runs that no longer exist */
  int64_t wanted;         /* runs that the points met so far need */
  struct error error;     /* error of a callback that cannot return one */
  struct error stop;      /* reason why no new runs start; results of running ones are still stored */
};

void driver_note(struct driver *driver, const char *text);
/* The run has used up its attempts. */
void driver_give_up(struct driver *driver, struct point *point, int64_t replicate);
/* True when the run writes its fields itself. Runs with extreme values are known only afterwards; they are computed
 * again. */
bool driver_writes_fields(const struct driver *driver, const struct flight *flight);
/* Path of a run's fields: "results.db" gives "results-fields/<identity>.h5". It is relative to the store's folder, or
 * with `folder` begins with that folder. */
void driver_fields_path(const struct driver *driver, const uint8_t identity[16], bool folder, char *path, size_t size);

bool driver_send(void *context, struct farm_task *task); /* send.c: farm_manager's next */
/* receive.c: farm_manager's report */
status driver_receive(void *context, const struct farm_report *report, struct error *error);

/* ---- the window: window.c ---- */

/* Takes the next design point and its stored runs into the window. False: the window is full, the design has no more
 * points, or an error (see *code). */
bool driver_window_expand(struct driver *driver, status *code, struct error *error);
/* Judges the point's prefixes and updates the prefix in the store. When the point is decided, marks the runs whose
 * fields are wanted. */
status driver_window_judge(struct driver *driver, struct point *point, struct error *error);
void driver_window_drop(struct driver *driver, struct point *point); /* frees it */
void driver_window_forget(struct driver *driver);                    /* frees the ids of the points met */

#endif
