/* `clast fit MEASURED CAMPAIGN`: finds the inputs of a campaign that reproduce the measured values. */
#include "campaign/fit/fit.h"
#include "campaign/commands/commands.h"

static status run(const struct command_line *line, struct error *error) {
  return fit_rounds_launch(line, line->options, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("rounds", 'r', "N", struct fit_launch, rounds, 3, FIT_MOST_ROUNDS, "8"),
    OPTION_ROW_INTEGER("seed", 0, "N", struct fit_launch, seed, 0, INT64_MAX, "1"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct fit_launch, store, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct fit_launch, picture),
    CHART_OPTIONS(struct fit_launch, chart),
    LAUNCH_OPTIONS(struct fit_launch, launch),
};

COMMAND(fit, "running", "MEASURED.yaml CAMPAIGN.yaml", .has_runs = true, .computes = true, .has_farm = true,
        COMMAND_OPTIONS(struct fit_launch, rows), .has_table = true, .run = run);
