/* One run outside of a farm, in this process: what `clast simulate` and `clast replay` do between options and results.
 */
#pragma once

#include "campaign/scheduler/run.h"
#include "campaign/terminal/table.h"
#include "db/ask/ask.h"
#include "engine/scene.h"

/* Files that are NULL are not written. */
struct one_run_options {
  int64_t seed, snapshots; /* number of fields files during the run */
  const char *fields;      /* fields at the end */
  const char *picture;     /* picture of the end */
  const char *restart;     /* if it exists, the run goes on from it; written every few minutes and after a signal */
  bool quiet;              /* no percentage on the terminal */
};

/* The caller owns *result, also on errors: if only the picture failed, it holds the results. STATUS_STOPPED after a
 * signal, with a restart file; also the statuses of run_simulate. */
status one_run(const struct scene *scene, const struct one_run_options *options, struct run_result *result,
               struct error *error);

/* Compares a stored run with the same run computed again: every result and every fragment mass, bit by bit. */

struct replay_compare {
  size_t compared, different; /* number of results; all fragment masses together count as one */
  size_t absent;              /* results that the storing program probably did not know: not compared */
  char absent_names[256];     /* names of the first ones */
};

/* Computes the run again. Its scene is parsed into *scene; the caller owns result and scene, also on errors. `fields`:
 * NULL, or the file for its fields. STATUS_USAGE: there is no such run; STATUS_CONTENT: another results_version than
 * this program's. */
status replay_compute(const struct ask_run *from, int64_t run_id, const char *fields, struct scene **scene,
                      struct run_result *result, struct error *error);

/* Each difference is a row of `table`: name, stored, recomputed. STATUS_CONTENT: the store has no results of this run.
 */
status replay_compare(struct store *store, int64_t run_id, const struct engine_kind *kind,
                      const struct run_result *result, struct table *table, struct replay_compare *out,
                      struct error *error);

/* STATUS_CONTENT: a bit of the run has changed since it was stored, or results differ although the same bits are
 * `promised`. Call it after the table of differences, which shows the stored values. */
status replay_verdict(struct store *store, int64_t run_id, const struct ask_run *stored,
                      const struct replay_compare *comparison, bool promised, struct error *error);
