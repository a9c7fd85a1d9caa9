/* What the driver's files share: its state, and the window of points under way. For driver*.c only. */
#ifndef CLAST_CAMPAIGN_DRIVER_PRIVATE_H
#define CLAST_CAMPAIGN_DRIVER_PRIVATE_H

#include <math.h>

#include "analysis/statistics/sample.h"
#include "campaign/design/design.h"
#include "campaign/driver.h"
#include "campaign/point.h"

#define DRIVER_NOTHING ((double)NAN)

/* Points looked at together: "dearest first" is exact for campaigns of up to this many points, and a window for larger
 * ones, whose points are made as they are needed. Filling it may take this long before the first run starts. */
enum { DRIVER_WINDOW = 1024 };
#define DRIVER_FILL_S 0.05

struct flight {        /* a task on a slot */
  struct point *point; /* NULL: this place is free */
  int64_t replicate;
  int attempt;
  bool replay; /* only for its fields */
  uint8_t identity[16];
  uint64_t seed;
};

struct driver {
  const struct campaign *campaign;
  struct store *store;
  struct driver_options options;
  struct driver_summary summary;
  struct design *design;
  struct field_value *values; /* of one design point */
  const char **paths;         /* of the axes, for the store */
  const struct field *row;    /* main quantity */
  bool row_of_outcome;
  struct point **points; /* the window */
  size_t point_count;
  uint64_t expanded; /* design points taken */
  struct flight *flights;
  size_t flight_count;
  int64_t *seen; /* ids of points met: open addressing, 0 = free */
  size_t seen_size, seen_count;
  uint8_t *task; /* bytes of the last task given out */
  struct cost_model cost;
  struct sample_moments moments;    /* of the main quantity */
  int64_t first_done, first_failed; /* of the first CAMPAIGN_FIRST_RUNS of this invocation */
  int64_t started_done;             /* runs finished now, for the rate */
  double begin, last_left, seconds_left;
  int64_t wanted;     /* runs to complete in points met */
  struct error error; /* of a callback that cannot return one */
};

void driver_note(struct driver *driver, const char *text);

/* ---- the window: driver_window.c ---- */

/* Takes the next design point into the window, with what the store has of it. False: the window is full, the design has
 * no more, or an error (see *code). */
bool driver_window_expand(struct driver *driver, status *code, struct error *error);
/* Judges the point's prefixes; moves the store's; marks the fields it wants once it is decided. */
status driver_window_judge(struct driver *driver, struct point *point, struct error *error);
void driver_window_drop(struct driver *driver, struct point *point); /* frees it */

#endif
