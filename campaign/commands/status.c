/* `clast status STORE`: the progress of each campaign of a store. */
#include "campaign/commands/commands.h"
#include "campaign/terminal/progress.h"

enum { SILENT_S = 10 }; /* shorter silences tell nothing */

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const bool writing = store_is_being_written(line->arguments[0]);
  TRY(table_answer(ask_campaign_progress(store, writing, line->format != TABLE_TEXT, error), true, line->format,
                   stdout));
  const double silence = ask_campaign_silence(store);
  if (table_for_people(line->format) && writing && silence >= SILENT_S) {
    char time[32];
    progress_duration(silence, time, sizeof time);
    fprintf(stderr, "clast: no sign of life for %s: no run was stored since then\n", time);
  }
  if (table_for_people(line->format) && ask_campaign_shared(store))
    fputs("clast: campaigns share points: all runs of a shared point count in each of them\n", stderr);
  return STATUS_OK;
}

COMMAND(status, "results", "STORE", .chooses_runs = true, .lists_campaigns = true, .has_table = true, .ask = ask);
