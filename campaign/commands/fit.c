/* `clast fit MEASURED CAMPAIGN`: finds the inputs of a campaign that reproduce the measured values. */

#include "campaign/commands/commands.h"
#include "campaign/fit/fit_launch.h"

static status run(const struct command_line *line, struct error *error) {
  const struct fit_launch_options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->launch.table, &format, error);
  if (code == STATUS_OK)
    code = fit_launch(line, options, format, error);
  return launch_quiet_ranks(code, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("rounds", 'r', "N", struct fit_launch_options, rounds, 3, FIT_MOST_ROUNDS, "8",
                       "Maximum number of rounds: all but two move the ensemble, one runs at its last points, one at "
                       "points drawn from the posterior."),
    OPTION_ROW_INTEGER("check", 0, "N", struct fit_launch_options, check, 0, 100000, "0",
                       "Then fit again by approximate Bayesian computation with N particles (100 or more), each a "
                       "specimen of its own: for results with two modes. 0: no check."),
    OPTION_ROW_INTEGER("seed", 0, "N", struct fit_launch_options, seed, 0, INT64_MAX, "1",
                       "Seed of the fit's random numbers. The seeds of the runs are the campaign's."),
    OPTION_ROW_TEXT("store", 0, "FILE", struct fit_launch_options, store, NULL,
                    "Store of the runs. Default: the campaign's."),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct fit_launch_options, picture,
                      "Draw the measurements beside the prediction for one more experiment (.png, .svg, .pdf)."),
    CHART_OPTIONS(struct fit_launch_options, chart),
    LAUNCH_OPTIONS(struct fit_launch_options, launch),
    TABLE_OPTIONS(struct fit_launch_options, launch.table),
};

const struct command fit_command = {
    .name = "fit",
    .group = "running",
    .arguments = "MEASURED.yaml CAMPAIGN.yaml",
    .summary = "which inputs give what was measured, with intervals",
    .doc =
        "The campaign has the unknown inputs: each law in its `vary` is the prior of an input, its sampled `design` "
        "is\n"
        "the first ensemble (20 to 100 points), and `seeds: {per_point: N}` are the seeds of each point (at least 2).\n"
        "The other document has the measurements, for example:\n"
        "\n"
        "  name: basalt sphere\n"
        "  source: who measured it, and where it is printed\n"
        "  shots:\n"
        "    - name: shot 1\n"
        "      set: {impact.speed: 3.2 km/s}\n"
        "      measured:\n"
        "        - {quantity: " OUTCOME_DEFAULT ", value: 0.31, error: 0.01, resolution: 0.05}\n"
        "        - {quantity: count_above, share: 0.01, value: 7}\n"
        "    - fragments: {total: 302 g, complete: 0.5 g, masses: [94 g, 31 g, 12 g]}\n"
        "\n"
        "A quantity is any result of a run, beta or beta_METHOD_WINDOW, count_above (number of fragments heavier than\n"
        "`share` of the body), or share_above (their share of its mass, as a sieve measures it). `error` is the\n"
        "standard deviation of the measurement, `resolution` that of the error of the resolution (if it is absent, a\n"
        "study by `clast converge` in the store gives it). `specimens: N` in a shot: its values are means of N. `set`\n"
        "has the inputs of one shot. A list of masses becomes the largest fragment and the numbers above up to four\n"
        "masses.\n"
        "\n"
        "Ensemble Kalman inversion moves the ensemble towards the data. Kriging fits surfaces to all means with the\n"
        "scatter of the seeds. The posterior is on a grid for up to four inputs, and sampled for more. The report "
        "says\n"
        "which combinations of inputs the data determine and which they do not. The runs are ordinary runs of the\n"
        "store: after a stop the same command continues, and more seeds or rounds keep the old runs.",
    .examples = "clast fit measured.yaml campaign.yaml --picture predicted.png\nclast fit measured.yaml campaign.yaml "
                "--rounds 4 --check 200 --json",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .has_runs = true,
    COMMAND_OPTIONS(struct fit_launch_options, rows),
    .run = run,
};
