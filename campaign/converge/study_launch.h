/* A study of convergence from its farm to its tables. */
#ifndef CLAST_CAMPAIGN_CONVERGE_STUDY_LAUNCH_H
#define CLAST_CAMPAIGN_CONVERGE_STUDY_LAUNCH_H

#include "campaign/converge/study.h"
#include "campaign/terminal/table.h"

struct study_launch {
  int slots; /* 0: one per core */
  bool in_process, quiet;
  enum table_format format;
  const char *picture, *frontier; /* of means, of errors; NULL: none */
  int argc;                       /* the command line, for provenance */
  char *const *argv;
};

/* Starts the farm, runs the study and, on rank 0, prints what was found and draws the picture. What study_rounds_run
 * returns. */
status study_launch(struct study *study, const struct study_launch *launch, struct error *error);

#endif
