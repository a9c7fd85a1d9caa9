/* One run outside of a farm, in this process: what `clast simulate` does between its options and its results. */
#ifndef CLAST_CAMPAIGN_ONE_RUN_ONE_RUN_H
#define CLAST_CAMPAIGN_ONE_RUN_ONE_RUN_H

#include "campaign/scheduler/run.h"
#include "engine/scene.h"

/* Files that are NULL are not written. */
struct one_run_options {
  int64_t seed, snapshots; /* number of fields files during the run */
  const char *fields;      /* fields at the end */
  const char *picture;     /* picture of the end */
  const char *restart;     /* if it exists, the run goes on from it; written every few minutes and after a signal */
  bool quiet;              /* no percentage on the terminal */
};

/* The caller owns *result, also on errors: if only the picture
 * failed, it holds the results. STATUS_STOPPED after a signal, with a restart file; also the statuses of
 * run_simulate. */
status one_run(const struct scene *scene, const struct one_run_options *options, struct run_result *result,
               struct error *error);

#endif
