/* `clast extremes STORE`: which runs of a store are safe, warned or refused, and why. */
#include "campaign/charts/extremes_map.h"
#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/campaign.h"

enum { PICTURE_WIDTH = 1200 };

struct options {
  const char *picture;
  bool why;
  struct table_options table;
};

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  const struct options *options = line->options;
  const bool both = format == TABLE_TEXT; /* programs get one table */
  if (both || !options->why)
    TRY(rows_print(ask_campaign_extremes(store, error), false, format, stdout));
  if (both)
    putchar('\n');
  if (both || options->why)
    TRY(rows_print(ask_campaign_reasons(store, error), false, format, stdout));
  return options->picture ? extremes_map_draw(store, options->picture, PICTURE_WIDTH, error) : STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return commands_ask(line, &options->table, ask, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_OUTPUT(
        OPTION_PICTURE, "picture", 'p', "FILE.png", struct options, picture,
        "Draw the map: a row of tiles for each varied input, divided into safe, warned and refused runs."),
    OPTION_ROW_FLAG("why", 0, struct options, why, "With --json or --csv: print the reasons instead of the campaigns."),
    TABLE_OPTIONS(struct options, table),
};

const struct command extremes_command = {
    .name = "extremes",
    .group = "results",
    .arguments = "STORE",
    .summary = "which runs are safe, warned or refused, and why",
    .doc =
        "Prints one row per campaign: the numbers of safe runs, of runs with words in the result `warnings`, and of\n"
        "runs refused by their state; the largest drift of energy of usable runs, and how many of these drift by more\n"
        "than 1 % without a warning. Then it prints one row per reason, with a message. Use it for campaigns over\n"
        "extreme inputs.",
    .examples = "clast extremes out.db\nclast extremes out.db --picture map.png",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
