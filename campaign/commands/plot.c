/* `clast plot STORE PICTURE`: a result or an exponent over one varied input, a line for each value of another. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/quantity.h"
#include "db/ask/columns.h"

enum { WIDTH = 900, MOST_LINES = 8, MOST_MEANS = 1000, LABEL = 600 };

struct options {
  const char *x, *by, *quantity;
};

struct line {
  char value[200]; /* of the input that tells the lines apart */
  int64_t version; /* results of another version are another line, they are never mixed */
  char label[LABEL];
  struct picture_mean *means; /* owned; room for MOST_MEANS */
  size_t count;
};

struct plot {
  struct quantity quantity;
  struct line line[MOST_LINES];
  size_t count;
};

/* The line of this value and version, made if it is new. */
static status find_line(struct plot *plot, const char *value, int64_t version, struct line **found,
                        struct error *error) {
  for (size_t i = 0; i < plot->count; i++) {
    *found = &plot->line[i];
    if (strcmp((*found)->value, value) == 0 && (*found)->version == version)
      return STATUS_OK;
  }
  if (plot->count == MOST_LINES)
    return status_fail(error, STATUS_USAGE, "more than %d lines cannot be told apart: choose a --by with fewer values",
                       MOST_LINES);

  struct line *line = &plot->line[plot->count];
  line->means = malloc(MOST_MEANS * sizeof *line->means);
  if (!line->means)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  snprintf(line->value, sizeof line->value, "%s", value);
  line->version = version;
  plot->count++;
  *found = line;
  return STATUS_OK;
}

static status add(void *context, const struct quantity_row *row, struct error *error) {
  struct plot *plot = context;
  const struct query_value *x = &row->input[0];
  if (x->kind == QUERY_TEXT)
    return status_fail(error, STATUS_USAGE, "%s is no number: it can tell lines apart (--by), but is no axis",
                       plot->quantity.column[0]);
  if (x->kind == QUERY_NULL)
    return STATUS_OK; /* off, or does not apply: it has no place on an axis of numbers */

  char value[sizeof plot->line[0].value] = "";
  if (plot->quantity.axes == 2 && row->input[1].kind == QUERY_TEXT)
    snprintf(value, sizeof value, "%s", row->input[1].text);
  else if (plot->quantity.axes == 2 && row->input[1].kind != QUERY_NULL)
    snprintf(value, sizeof value, "%.6g", row->input[1].real);

  struct line *line = NULL;
  status code = find_line(plot, value, row->results_version, &line, error);
  if (code)
    return code;
  if (line->count == MOST_MEANS)
    return status_fail(error, STATUS_USAGE, "a line of more than %d points cannot be read", MOST_MEANS);
  for (size_t i = 0; plot->quantity.exponent && i < line->count; i++)
    if (line->means[i].x == x->real)
      return status_fail(
          error, STATUS_USAGE,
          "several points share %s = %g and one line: their exponents are not averaged; tell them apart by --by",
          plot->quantity.column[0], x->real);
  line->means[line->count++] = (struct picture_mean){x->real, row->value, row->lower, row->upper};
  return STATUS_OK;
}

static int ascending(const void *a, const void *b) {
  double x = ((const struct picture_mean *)a)->x;
  double y = ((const struct picture_mean *)b)->x;
  return (x > y) - (x < y);
}

/* "weibull_k (1/m^3) = 5e+34"; the version is told only where there are several of them. */
static void label_lines(struct plot *plot, const char *by) {
  bool several = false;
  for (size_t i = 1; i < plot->count; i++)
    several |= plot->line[i].version != plot->line[0].version;

  const bool two = plot->quantity.axes == 2;
  for (size_t i = 0; i < plot->count; i++) {
    struct line *line = &plot->line[i];
    char version[40] = "";
    char input[LABEL - sizeof version] = "";
    if (two && *line->value)
      snprintf(input, sizeof input, "%s = %s", by, line->value);
    else if (two)
      snprintf(input, sizeof input, "%s: none", by);
    if (several)
      snprintf(version, sizeof version, "%sresults_version %lld", two ? ", " : "", (long long)line->version);
    snprintf(line->label, sizeof line->label, "%s%s", input, version);
    qsort(line->means, line->count, sizeof *line->means, ascending);
  }
}

/* A column's name and unit. */
static status label_axis(struct store *store, const char *column, char label[300], struct error *error) {
  char unit[64] = "";
  status code = ask_columns_unit(store, column, unit, sizeof unit, error);
  if (*unit)
    snprintf(label, 300, "%s (%s)", column, unit);
  else
    snprintf(label, 300, "%s", column);
  return code;
}

static status draw(struct store *store, struct plot *plot, const char *path, struct error *error) {
  const struct quantity *quantity = &plot->quantity;
  char x_label[300], by_label[300], y_label[300], title[ASK_GROUP_POOLED + 400];
  status code = label_axis(store, quantity->column[0], x_label, error);
  if (code)
    return code;
  code = label_axis(store, quantity->column[1], by_label, error);
  if (code)
    return code;
  code = label_axis(store, quantity->name, y_label, error);
  if (code)
    return code;

  label_lines(plot, by_label);
  struct picture_curve curves[MOST_LINES] = {0};
  for (size_t i = 0; i < plot->count; i++) {
    curves[i].label = *plot->line[i].label ? plot->line[i].label : NULL;
    curves[i].count = plot->line[i].count;
    curves[i].mean = plot->line[i].means;
  }
  snprintf(title, sizeof title, "%s, %s over seeds%s%s, 95 %% interval", quantity->name,
           quantity->exponent ? "pooled" : "mean", *quantity->pooled ? " and " : "", quantity->pooled);
  return picture_curves(path, WIDTH, title, x_label, y_label, plot->count, curves, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x)
    return status_fail(error, STATUS_USAGE, "a plot needs --x, an input that the campaign varied");

  struct store *store = NULL;
  status code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  const struct quantity_choice choice =
      {.axis = {options->x, options->by},
       .name = options->quantity,
       .refusal = "a plot has one axis below (--x), at most one input that tells its lines apart (--by, another one), "
                  "and one quantity"};
  struct plot plot = {0};
  code = quantity_read(store, &choice, &plot.quantity, add, &plot, error);
  if (code == STATUS_OK)
    code = draw(store, &plot, line->arguments[1], error);
  if (code == STATUS_OK)
    quantity_tell_resolution(store, plot.quantity.name, plot.quantity.pooled);
  for (size_t i = 0; i < plot.count; i++)
    free(plot.line[i].means);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    QUANTITY_AXIS_OPTION(struct options, x),
    OPTION_ROW_TEXT("by", 'b', "AXIS", struct options, by, NULL,
                    "Another varied input, with one line for each of its values, at most 8."),
    QUANTITY_OPTION(struct options, quantity),
};

const struct command plot_command = {
    .name = "plot",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over one varied input as lines with error bars",
    .doc =
        "Draws the mean of a result over seeds against a varied input, with the 95 % interval of the mean (Student's\n"
        "t) where there are two runs or more. A second varied input gives one line for each of its values. `clast\n"
        "stats` prints the same numbers. If other inputs vary as well, the mean is over them too, and the title says\n"
        "which; the interval then takes the points as units. For an exponent it draws the fit to the runs of each\n"
        "point, with its 95 % interval. An axis that spans a factor of 20 or more is logarithmic. The ending chooses\n"
        "the format: .png or .svg.",
    .examples =
        "clast plot out.db largest.png -x strain --by angle\nclast plot out.db beta.svg -x strain --by angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
