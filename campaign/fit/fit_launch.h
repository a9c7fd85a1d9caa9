/* From the two documents of a fit to its report: farm, rounds, posterior. */
#ifndef CLAST_CAMPAIGN_FIT_FIT_LAUNCH_H
#define CLAST_CAMPAIGN_FIT_FIT_LAUNCH_H

#include "campaign/charts/charts.h"
#include "campaign/fit/fit.h"
#include "campaign/launch/launch.h"

struct fit_launch_options {
  struct launch_options launch;
  struct chart_options chart;
  const char *store, *picture;
  int64_t rounds, check, seed;
};

/* Reads both documents (line->arguments), runs the rounds, prints the report on rank 0. */
status fit_launch(const struct command_line *line, const struct fit_launch_options *options, enum table_format format,
                  struct error *error);

#endif
