/* `clast extremes STORE`: which runs of a store are safe, warned or refused, and why. */
#include "campaign/commands/commands.h"

struct options {
  bool why;
};

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const bool both = table_for_people(line->format); /* programs get one table */
  if (both || !options->why)
    TRY(table_answer(ask_campaign_extremes(store, error), true, line->format, stdout));
  if (both)
    putchar('\n');
  if (both || options->why)
    TRY(table_answer(ask_campaign_reasons(store, error), true, line->format, stdout));
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_FLAG("why", 0, struct options, why),
};

COMMAND(extremes, "results", "STORE", .chooses_runs = true, .lists_campaigns = true,
        COMMAND_OPTIONS(struct options, rows), .has_table = true, .ask = ask);
