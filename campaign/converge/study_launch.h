/* A study of convergence from its farm to its tables. */
#ifndef CLAST_CAMPAIGN_CONVERGE_STUDY_LAUNCH_H
#define CLAST_CAMPAIGN_CONVERGE_STUDY_LAUNCH_H

#include "campaign/converge/study.h"
#include "campaign/launch/launch.h"

struct study_launch {
  const struct launch_options *options;
  const struct command_line *line;
  enum table_format format;
  const char *picture, *frontier; /* pictures of means and of errors; NULL: none */
};

/* Starts the farm, runs the study and, on rank 0, prints the results and draws the pictures. Returns the status of
 * study_rounds_run. */
status study_launch(struct study *study, const struct study_launch *asked, struct error *error);

#endif
