/* `clast plot STORE PICTURE`: a result or an exponent over one varied input, a line for each value of another. */
#include "campaign/charts/plot_lines.h"
#include "campaign/commands/commands.h"

struct options {
  const char *x, *by, *quantity;
  struct chart_options chart;
};

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  const struct options *options = line->options;
  const struct picture_page page = chart_option_page(line->arguments[1], &options->chart);
  (void)format;
  return plot_lines_draw(store, options->x, options->by, options->quantity, &page, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x)
    return status_fail(error, STATUS_USAGE, "a plot needs --x, an input that the campaign varied");
  return commands_ask(line, NULL, ask, error);
}

static const struct option_row rows[] = {
    QUANTITY_AXIS_OPTION(struct options, x),
    OPTION_ROW_TEXT("by", 'b', "AXIS", struct options, by, NULL,
                    "Another varied input, with one line for each of its values, at most 8."),
    QUANTITY_OPTION(struct options, quantity),
    CHART_OPTIONS(struct options, chart),
};

const struct command plot_command = {
    .name = "plot",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over one varied input as lines with error bars",
    .doc =
        "Draws the mean of a result over seeds against a varied input, with the 95 % interval of the mean (Student's "
        "t)\n"
        "where there are two runs or more. A second varied input gives one line for each of its values. `clast stats`\n"
        "prints the same numbers. If other inputs also vary, the mean is over them, too, and the title names them; "
        "the\n"
        "interval is then over points. For an exponent it draws the fit to the runs of each point, with its 95 %\n"
        "interval. An axis over a factor of 20 or more is logarithmic. gnuplot draws the chart; the ending chooses "
        "the\n"
        "format: .png, .svg or .pdf.",
    .examples =
        "clast plot out.db largest.png -x strain --by angle\nclast plot out.db beta.svg -x strain --by angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
