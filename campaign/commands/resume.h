/* A run that can be stopped and gone on with: SIGINT, SIGTERM and SIGHUP write its restart file and end the command,
 * which then exits 75; every few minutes the file is written anew, against harder ends. */
#ifndef CLAST_CAMPAIGN_COMMANDS_RESUME_H
#define CLAST_CAMPAIGN_COMMANDS_RESUME_H

#include "engine/engine.h"

struct resume {
  const char *path; /* of the restart file */
  double saved;     /* s, monotonic: when it was last written */
};

/* From now on signals are noted, not obeyed; a second one ends the process at once. */
void resume_begin(struct resume *resume, const char *path);
/* Between blocks of steps. STATUS_STOPPED after a signal, the file written; what save returns. */
status resume_look(struct resume *resume, const struct engine_kind *kind, void *run, struct error *error);
/* The run came to its end: the file is removed. */
void resume_end(const char *path);

#endif
