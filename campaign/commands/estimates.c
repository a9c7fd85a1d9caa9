/* `clast estimates STORE`: the share of the largest fragment and the exponents of every point, pooled over seeds.
 * Computed from the masses in the store each time, so that they include all present runs. */
#include "campaign/print/estimates_table.h"

#include "campaign/commands/commands.h"

struct options {
  int64_t campaign, point;
  struct table_options table;
};

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  const struct options *options = line->options;
  const struct ask_points_choice choice = {.campaign = options->campaign, .point = options->point};
  status code = ask_points_known(store, options->point, error);
  if (code == STATUS_OK)
    code = estimates_table_print(store, &choice, format, stdout, error);
  if (code == STATUS_OK && format == TABLE_TEXT)
    estimates_table_explain(store);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return commands_ask(line, &options->table, ask, error);
}

static const struct option_row option_rows[] = {
    COMMANDS_POINT(struct options, point),
    OPTION_ROW_INTEGER("campaign", 0, "N", struct options, campaign, 0, INT64_MAX, "0",
                       "Only the points of this campaign (`clast status` lists them); 0: all."),
    TABLE_OPTIONS(struct options, table),
};

const struct command estimates_command = {
    .name = "estimates",
    .group = "results",
    .arguments = "STORE",
    .summary = "largest fragment and exponents of every point, pooled over seeds, with errors",
    .doc =
        "Prints the table that `clast run` ends with. For every point: the mass share of the largest fragment, M_1/M,\n"
        "and the exponent beta of F(m) ~ m^-beta (differential) by two methods: least squares on logarithmic bins (as\n"
        "in the paper, over one decade), and maximum likelihood on masses. Each for three windows: fragments heavier\n"
        "than 1.5, 4.5 and 9.5 mean grains (or particles); maximum likelihood without the largest fragment of each "
        "run.\n"
        "Intervals are 95 % intervals over seeds; one run has none. Varied inputs are in the units of the campaign, "
        "and\n"
        "a table of many inputs leaves out least squares; --csv and --json print all columns, in SI units.",
    .examples = "clast estimates out.db\nclast estimates out.db --point 1 --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
