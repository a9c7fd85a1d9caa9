/* An engine without physics, for tests that need runs and not results: a stick whose pieces are drawn from its inputs
 * and the seed. A run can wait, so that a campaign lasts as long as a test needs and uses hardly any processor time. */
#pragma once

#include "engine/engine.h"

struct toy_inputs {
  struct {
    double strain, angle; /* scale of the masses, 1; changes nothing, rad */
    double coarse;        /* kg: mass of the largest piece that more steps take away: coarse / steps */
    bool trouble;         /* seed 13 is refused; of 50 seeds one ends as not finite, four at the hard end */
  } stick;
  double wait;   /* s of the clock that a run takes */
  int64_t steps; /* of a run; it waits between them */
};
struct toy_results {
  int64_t pieces;
};

extern struct engine_kind toy_engine; /* a test may replace its functions */
/* Its write_snapshot: a file with the run's seed. */
status toy_write_fields(void *run, const char *path, struct error *error);
