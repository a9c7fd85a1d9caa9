/* `clast map STORE PICTURE`: a quantity over two varied inputs, as a picture. */
#include "campaign/charts/map_tiles.h"
#include "campaign/commands/commands.h"

struct options {
  const char *x, *y, *quantity;
  struct chart_options chart;
};

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  const struct options *options = line->options;
  const struct picture_page page = chart_option_page(line->arguments[1], &options->chart);
  (void)format;
  return map_tiles_draw(store, options->x, options->y, options->quantity, &page, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x || !options->y)
    return status_fail(error, STATUS_USAGE, "a map needs --x and --y, two inputs that the campaign varied");
  return commands_ask(line, NULL, ask, error);
}

static const struct option_row rows[] = {
    QUANTITY_AXIS_OPTION(struct options, x),
    OPTION_ROW_TEXT("y", 'y', "AXIS", struct options, y, NULL, "Varied input on the vertical axis."),
    QUANTITY_OPTION(struct options, quantity),
    CHART_OPTIONS(struct options, chart),
};

const struct command map_command = {
    .name = "map",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over two varied inputs as a picture",
    .doc = "Draws the mean of a result over seeds, or an exponent fitted to the runs of a point, as a tile for every "
           "pair\n"
           "of values of two varied inputs. A cross marks a pair without a usable run. The line under the title gives "
           "the\n"
           "widest 95 % interval. gnuplot draws the map; the ending chooses the format: .png, .svg or .pdf.",
    .examples = "clast map out.db map.png -x strain -y angle\nclast map out.db beta.svg -x strain -y angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
