/* `clast status STORE`: the progress of each campaign of a store. */
#include <inttypes.h>

#include "campaign/commands/commands.h"

enum { SILENT_S = 10 }; /* shorter silences tell nothing */

/* Why numbers of campaigns are missing, and why their runs are more than those of the store. */
static void tell_campaigns(struct store *store, enum table_format format) {
  int64_t earlier = 0, shared = 0, runs = 0;
  ask_campaign_overlaps(store, &earlier, &shared, &runs);
  if (earlier > 0 && format == TABLE_TEXT)
    fprintf(stderr, "clast: left out: %" PRId64 " earlier form%s of a campaign, whose points a later one has (--all)\n",
            earlier, text_plural(earlier));
  if (shared > 0)
    fprintf(stderr,
            "clast: campaigns share %" PRId64 " point%s: all runs of a shared point count in each of them, whatever "
            "seeds it asked for; together they have %" PRId64 " runs\n",
            shared, text_plural(shared), runs);
}

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
  if (table_for_people(line->format))
    tell_campaigns(store, line->format);
  return STATUS_OK;
}

COMMAND(status, "results", "STORE", .chooses_runs = true, .lists_campaigns = true, .has_table = true, .ask = ask);
