/* `clast exponents STORE`: the exponent of every point under its four names, and a test of the power law. */
#include <stdio.h>

#include "campaign/commands/commands.h"
#include "campaign/print/exponents_print.h"
#include "db/ask/points.h"

struct options {
  int64_t point, draws;
  const char *where;
};

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const struct ask_pool_choice choice = {.point = options->point, .where = options->where};
  TRY(ask_points_known(store, options->point, error));
  struct table *table = table_new(line->format, stdout);
  exponents_print_headings(table);
  ASK_POOLS pools = ask_pools(store, &choice, NULL, error);
  status code = STATUS_OK;
  for (const struct ask_pool *pool; code == STATUS_OK && !table_broken(table) && (pool = ask_pools_next(&pools));)
    code = exponents_print_pool(table, (size_t)options->draws, pool, error);
  if (code == STATUS_OK)
    code = ask_pools_end(&pools);
  if (code && !table_broken(table)) {
    table_drop(table);
    return code;
  }
  code = table_end(table, error);
  if (code == STATUS_OK && line->format == TABLE_TEXT)
    fputs("clast: exponents by maximum likelihood on masses, from `from` on, which is never below the complete mass. "
          "p below 0.1: a power law does not fit; cutoff_p, lognormal_p below 0.05: these fit better\n",
          stderr);
  return code;
}

static const struct option_row option_rows[] = {
    COMMANDS_POINT(struct options, point),
    COMMANDS_WHERE(struct options, where),
    OPTION_ROW_INTEGER(
        "draws", 0, "N", struct options, draws, 100, 1000000, "2500",
        "Samples of the bootstrap; 2500 give p within 0.01. The bootstrap ends earlier when p is large."),
};

const struct command exponents_command = {
    .name = "exponents",
    .group = "results",
    .arguments = "STORE",
    .text = exponents_text,
    COMMAND_OPTIONS(struct options, option_rows),
    .has_table = true,
    .ask = ask,
};
