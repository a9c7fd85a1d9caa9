/* `clast status STORE`: the progress of each campaign of a store. */
#include "campaign/commands/commands.h"

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const bool writing = store_is_being_written(line->arguments[0]);
  return table_answer(ask_campaign_progress(store, writing, error), true, line->format, stdout);
}

COMMAND(status, "results", "STORE", .has_table = true, .ask = ask);
