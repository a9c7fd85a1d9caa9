/* `clast estimates STORE`: the share of the largest fragment and the exponents of every point, pooled over seeds.
 * Computed from the masses in the store each time, so that they include all present runs. */
#include "campaign/commands/commands.h"

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  return print_estimates(store, line->format, true, error);
}

COMMAND(estimates, "results", "STORE", .chooses_runs = true, .has_table = true, .ask = ask);
