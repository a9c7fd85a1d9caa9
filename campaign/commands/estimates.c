/* `clast estimates STORE`: the share of the largest fragment and the exponents of every point, pooled over seeds.
 * Computed from the masses in the store each time, so that they include all present runs. */
#include "campaign/commands/commands.h"

struct options {
  int64_t campaign, point;
};

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const struct ask_points_choice choice = {.campaign = options->campaign, .point = options->point};
  TRY(ask_points_known(store, options->point, error));
  TRY(print_estimates(store, &choice, line->format, stdout, error));
  if (table_for_people(line->format))
    print_estimates_legend(store);
  return STATUS_OK;
}

static const struct option_row option_rows[] = {
    COMMANDS_POINT(struct options, point),
    OPTION_ROW_INTEGER("campaign", 0, "N", struct options, campaign, 0, INT64_MAX, "0"),
};

COMMAND(estimates, "results", "STORE", COMMAND_OPTIONS(struct options, option_rows), .has_table = true, .ask = ask);
