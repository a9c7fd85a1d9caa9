/* `clast map STORE PICTURE`: a quantity over two varied inputs, as a picture. */
#include "campaign/commands/commands.h"

struct options {
  const char *x, *y, *by, *quantity;
  struct chart_options chart;
};

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const struct picture_page page = charts_page(line->arguments[1], &options->chart);
  return quantity_map(store, options->x, options->y, options->by, options->quantity, &page, error);
}

static const struct option_row rows[] = {
    QUANTITY_AXIS_OPTION(struct options, x),
    OPTION_ROW_TEXT("y", 'y', "AXIS", struct options, y, NULL),
    OPTION_ROW_TEXT("by", 'b', "AXIS", struct options, by, NULL),
    QUANTITY_OPTION(struct options, quantity),
    CHART_OPTIONS(struct options, chart),
};

COMMAND(map, "results", "STORE PICTURE.png", .chooses_runs = true, COMMAND_OPTIONS(struct options, rows), .ask = ask);
