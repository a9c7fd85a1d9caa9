/* `clast find CAMPAIGN`: where a result crosses a level along one input. */
#include "campaign/find/find.h"
#include "campaign/commands/commands.h"

static status run(const struct command_line *line, struct error *error) {
  return find_launch(line->options, line, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("quantity", 'Q', "NAME", struct find_request, quantity, NULL),
    OPTION_ROW_TEXT("level", 0, "VALUE", struct find_request, level, NULL),
    OPTION_ROW_TEXT("share", 0, "SHARE", struct find_request, share, NULL),
    OPTION_ROW_TEXT("input", 0, "PATH", struct find_request, input, NULL),
    OPTION_ROW_TEXT("from", 0, "VALUE", struct find_request, from, NULL),
    OPTION_ROW_TEXT("to", 0, "VALUE", struct find_request, to, NULL),
    OPTION_ROW_TEXT("within", 0, "WIDTH", struct find_request, within, "5 %"),
    OPTION_ROW_INTEGER("max-runs", 0, "N", struct find_request, most_runs, FIND_FEWEST_RUNS, FIND_MOST_RUNS, "400"),
    SCENE_OPTION_SET(struct find_request, set),
    OPTION_ROW_TEXT("store", 0, "FILE", struct find_request, store, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct find_request, picture),
    CHART_OPTIONS(struct find_request, chart),
    LAUNCH_OPTIONS(struct find_request, launch),
};

COMMAND(find, "running", "CAMPAIGN.yaml", .has_runs = true, .computes = true, .has_farm = true,
        COMMAND_OPTIONS(struct find_request, rows), .has_table = true, .run = run);
