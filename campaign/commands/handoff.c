/* `clast handoff FIELDS TARGET`: one run for other programs. */
#include "campaign/commands/commands.h"
#include "campaign/export/export.h"

static status run(const struct command_line *line, struct error *error) {
  TRY(export_run(line->arguments[0], line->arguments[1], error));
  fprintf(stderr, "%s written\n", line->arguments[1]);
  return STATUS_OK;
}

COMMAND(handoff, "results", "FIELDS.hdf TARGET.csv", .run = run);
