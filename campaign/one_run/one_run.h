/* One run outside of a farm, in this process: what `clast simulate` does between its options and its results. */
#ifndef CLAST_CAMPAIGN_ONE_RUN_ONE_RUN_H
#define CLAST_CAMPAIGN_ONE_RUN_ONE_RUN_H

#include "campaign/driver/run.h"
#include "engine/scene.h"

/* Files that are NULL are not written. */
struct one_run_options {
  int64_t seed, snapshots; /* so many fields files during the run */
  const char *fields;      /* at the end */
  const char *picture;     /* of the end */
  const char *restart;     /* goes on from it if it exists; written every few minutes and after a signal */
  bool quiet;              /* no percentage on the terminal */
};

/* Tries the files before the run. *result is the caller's, also on errors: a run whose picture could not be drawn has
 * its results. STATUS_STOPPED after a signal, with a restart file; what run_simulate returns. */
status one_run(const struct scene *scene, const struct one_run_options *options, struct run_result *result,
               struct error *error);

#endif
