/* `clast scaling STORE`: critical value and exponents from runs of several sizes of one scene. */
#include "campaign/commands/commands.h"

struct options {
  struct scaling_choice choice;
  const char *picture;
  struct chart_options chart;
};

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const struct picture_page page = charts_page(options->picture, &options->chart);
  return print_scaling(store, &options->choice, line->format, options->picture ? &page : NULL, error);
}

static const struct option_row option_rows[] = {
    OPTION_ROW_TEXT("size", 0, "INPUT", struct options, choice.size, NULL),
    OPTION_ROW_TEXT("control", 0, "INPUT", struct options, choice.control, NULL),
    OPTION_ROW_TEXT("quantity", 'Q', "NAME", struct options, choice.quantity, OUTCOME_DEFAULT),
    OPTION_ROW_INTEGER("dimensions", 0, "D", struct options, choice.dimensions, 2, 2, 0),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE.png", struct options, picture),
    CHART_OPTIONS(struct options, chart),
};

COMMAND(scaling, "results", "STORE", .chooses_runs = true, COMMAND_OPTIONS(struct options, option_rows),
        .has_table = true, .ask = ask);
