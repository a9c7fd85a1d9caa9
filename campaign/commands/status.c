/* `clast status STORE`: the progress of each campaign of a store. */
#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/campaign.h"

struct options {
  struct table_options table;
};

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  const bool writing = store_is_being_written(line->arguments[0]);
  return rows_print(ask_campaign_progress(store, writing, error), false, format, stdout);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return commands_ask(line, &options->table, ask, error);
}

static const struct option_row option_rows[] = {TABLE_OPTIONS(struct options, table)};

const struct command status_command = {
    .name = "status",
    .group = "results",
    .arguments = "STORE",
    .summary = "how far the campaigns of a store are, and what failed",
    .doc =
        "Prints one row per campaign: its state; its points, the runs stored, and how many of them count in "
        "statistics,\n"
        "are censored (ended at the end time), failed, or are surplus; failed attempts, and runs given up without a\n"
        "result. Works while a campaign is running. States: running; finished; stopped (by Ctrl-C or a signal; the "
        "same\n"
        "command continues); failed (an error ended it); killed (its process ended without a message; the same "
        "command\n"
        "continues); not known (an older program did not record it).",
    .examples = "clast status out.db\nclast status out.db --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
