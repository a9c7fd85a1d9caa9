/* A run that can be stopped and resumed. SIGINT, SIGTERM and SIGHUP write its restart file and end the command with
 * exit code 75. The file is also written every few minutes, for ends without a signal. */
#ifndef CLAST_CAMPAIGN_ONE_RUN_RESUME_H
#define CLAST_CAMPAIGN_ONE_RUN_RESUME_H

#include "engine/engine.h"

struct resume {
  const char *path; /* path of the restart file */
  double saved;     /* s, monotonic: when it was last written */
};

/* From now on the first signal is only noted. A second one ends the process at once. */
void resume_begin(struct resume *resume, const char *path);
/* Must be called between blocks of steps. STATUS_STOPPED after a signal, when the file is written; or the status of
 * save. */
status resume_look(struct resume *resume, const struct engine_kind *kind, void *run, struct error *error);
/* Removes the file after the run has ended. */
void resume_end(const char *path);

#endif
