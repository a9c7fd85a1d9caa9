/* `clast merge TARGET SOURCE...`: stores from several machines into one. */
#include <inttypes.h>

#include "analysis/estimates.h"
#include "campaign/commands/commands.h"
#include "db/store.h"

static status run(const struct command_line *line, struct error *error) {
  struct store *store = NULL;
  char warning[512] = "";
  status code = store_open_writer(line->arguments[0], &estimates_table, &store, warning, sizeof warning, error);
  if (code)
    return code;
  if (*warning)
    fprintf(stderr, "clast: warning: %s\n", warning);
  for (size_t i = 1; !code && i < line->count; i++) {
    int64_t added = 0;
    code = store_merge(store, line->arguments[i], &added, error);
    if (!code)
      fprintf(stderr, "%s: %" PRId64 " run%s added\n", line->arguments[i], added, added == 1 ? "" : "s");
  }
  status closed = store_close(store, code ? NULL : error);
  return code ? code : closed;
}

const struct command merge_command = {
    .name = "merge",
    .group = "the store",
    .arguments = "TARGET SOURCE...",
    .summary = "add the runs of other stores to one",
    .doc = "Adds to TARGET (made if absent) every run of the SOURCES that it lacks, with its point, masses, spectrum and\n"
           "provenance. Runs are known by identity: merging twice adds nothing, and of a run in both, TARGET's stays.",
    .examples = "clast merge all.db node1.db node2.db\nclast merge all.db part-*.db",
    .minimum_arguments = 2,
    .maximum_arguments = 10000,
    .run = run,
};
