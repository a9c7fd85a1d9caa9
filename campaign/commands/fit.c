/* `clast fit MEASURED CAMPAIGN`: finds the inputs of a campaign that reproduce the measured values. */

#include "campaign/commands/commands.h"
#include "campaign/fit/fit_launch.h"

static status run(const struct command_line *line, struct error *error) {
  const struct fit_launch_options *options = line->options;
  return launch_quiet_ranks(fit_launch(line, options, line->format, error), error);
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("rounds", 'r', "N", struct fit_launch_options, rounds, 3, FIT_MOST_ROUNDS, "8"),
    OPTION_ROW_INTEGER("check", 0, "N", struct fit_launch_options, check, 0, 100000, "0"),
    OPTION_ROW_INTEGER("seed", 0, "N", struct fit_launch_options, seed, 0, INT64_MAX, "1"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct fit_launch_options, store, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct fit_launch_options, picture),
    CHART_OPTIONS(struct fit_launch_options, chart),
    LAUNCH_OPTIONS(struct fit_launch_options, launch),
};

COMMAND(fit, "running", "MEASURED.yaml CAMPAIGN.yaml", .has_runs = true,
        COMMAND_OPTIONS(struct fit_launch_options, rows), .has_table = true, .run = run);
