/* `clast plot STORE PICTURE`: a result over one varied input, a line for each value of another. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/picture.h"
#include "campaign/commands/commands.h"
#include "db/query.h"

/* Columns of query_group after the axes. */
enum { VERSION = 1, N = 2, MEAN = 5, HALF = 8, COLUMNS = 9 };
enum { WIDTH = 900, MOST_CURVES = 8, MOST_MEANS = 1000 };

struct options {
  const char *x, *by, *quantity;
};

struct plot {
  size_t axes;       /* 1, or 2 with --by */
  char name[3][256]; /* columns: the axes', and the quantity's */
  struct picture_curve curve[MOST_CURVES];
  struct picture_mean *mean[MOST_CURVES]; /* of the curves */
  char value[MOST_CURVES][200]; /* of the second axis; results of another version are other curves, never mixed */
  int64_t version[MOST_CURVES];
  char label[MOST_CURVES][600];
  size_t count;
};

static status take_columns(void *context, size_t count, const char *const *names, struct error *error) {
  struct plot *plot = context;
  if (count != plot->axes + COLUMNS || (plot->axes == 2 && strcmp(names[0], names[1]) == 0))
    return status_fail(error, STATUS_USAGE, "a plot has one axis below (--x), at most one input that tells its lines apart (--by, another "
                                            "one), and one quantity");
  for (size_t i = 0; i < plot->axes; i++)
    snprintf(plot->name[i], sizeof plot->name[i], "%s", names[i]);
  const char *mean = names[plot->axes + MEAN];
  snprintf(plot->name[2], sizeof plot->name[2], "%.*s", (int)(strlen(mean) - strlen("_mean")), mean);
  return STATUS_OK;
}

static status take_group(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct plot *plot = context;
  const struct query_value *x = &values[0], *rest = values + plot->axes;
  if (x->kind == QUERY_TEXT)
    return status_fail(error, STATUS_USAGE, "%s is no number: it can tell lines apart (--by), but is no axis", plot->name[0]);
  if (x->kind == QUERY_NULL)
    return STATUS_OK; /* off, or does not apply: no place on an axis of numbers */
  char value[sizeof plot->value[0]] = "";
  const int64_t version = rest[VERSION].integer;
  if (plot->axes == 2 && values[1].kind == QUERY_TEXT)
    snprintf(value, sizeof value, "%s", values[1].text);
  else if (plot->axes == 2 && values[1].kind != QUERY_NULL)
    snprintf(value, sizeof value, "%.6g", values[1].real);
  size_t c = 0;
  while (c < plot->count && (strcmp(plot->value[c], value) != 0 || plot->version[c] != version))
    c++;
  if (c == MOST_CURVES)
    return status_fail(error, STATUS_USAGE, "more than %d lines cannot be told apart: choose a --by with fewer values", MOST_CURVES);
  if (c == plot->count) {
    plot->mean[c] = malloc(MOST_MEANS * sizeof *plot->mean[c]);
    if (!plot->mean[c])
      return status_fail(error, STATUS_MEMORY, "out of memory");
    plot->curve[plot->count++].mean = plot->mean[c];
    memcpy(plot->value[c], value, sizeof value);
    plot->version[c] = version;
  }
  struct picture_curve *curve = &plot->curve[c];
  if (curve->count == MOST_MEANS)
    return status_fail(error, STATUS_USAGE, "a line of more than %d points cannot be read", MOST_MEANS);
  plot->mean[c][curve->count++] = (struct picture_mean){x->real, rest[MEAN].real, rest[N].integer > 1 ? rest[HALF].real : 0};
  return STATUS_OK;
}

static int ascending(const void *a, const void *b) {
  double x = ((const struct picture_mean *)a)->x, y = ((const struct picture_mean *)b)->x;
  return (x > y) - (x < y);
}

/* "weibull_k (1/m^3) = 5e+34"; the version is told only where there are several of them. */
static void finish(struct plot *plot, const char *by) {
  bool several = false;
  for (size_t c = 1; c < plot->count; c++)
    several |= plot->version[c] != plot->version[0];
  for (size_t c = 0; c < plot->count; c++) {
    char version[40] = "";
    const bool valued = *plot->value[c] != '\0';
    if (several)
      snprintf(version, sizeof version, "%sresults_version %lld", plot->axes == 2 ? ", " : "", (long long)plot->version[c]);
    snprintf(plot->label[c], sizeof plot->label[c], "%s%s%s%s", plot->axes == 2 ? by : "", valued ? " = " : plot->axes == 2 ? ": none" : "", plot->value[c], version);
    qsort(plot->mean[c], plot->curve[c].count, sizeof *plot->mean[c], ascending);
    plot->curve[c].label = *plot->label[c] ? plot->label[c] : NULL;
  }
}

static status take_unit(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  char *label = context;
  size_t length = strlen(label);
  if (values[0].kind == QUERY_TEXT)
    snprintf(label + length, 300 - length, " (%s)", values[0].text);
  return STATUS_OK;
}

/* The column and its unit. */
static status label_axis(struct store *store, const char *column, char label[300], struct error *error) {
  const struct query_parameter parameter = {"column", column};
  const struct query_sink sink = {label, NULL, take_unit};
  snprintf(label, 300, "%s", column);
  return query_run(store, "select min(unit) from column_doc where column_name = :column and unit <> '1'", 1, &parameter, 0, &sink, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x)
    return status_fail(error, STATUS_USAGE, "a plot needs --x, an input that the campaign varied");
  struct store *store = NULL;
  status code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  struct plot plot = {.axes = options->by ? 2 : 1};
  struct query_sink sink = {&plot, take_columns, take_group};
  char by[600], title[400], x_label[300], y_label[300], by_label[300];
  snprintf(by, sizeof by, "%s%s%s", options->x, options->by ? "," : "", options->by ? options->by : "");
  code = query_group(store, by, options->quantity, &sink, error);
  if (!code && !(code = label_axis(store, plot.name[0], x_label, error)) && !(code = label_axis(store, plot.name[1], by_label, error)) &&
      !(code = label_axis(store, plot.name[2], y_label, error))) {
    finish(&plot, by_label);
    snprintf(title, sizeof title, "%s, mean over seeds with 95 %% interval", plot.name[2]);
    code = picture_curves(line->arguments[1], WIDTH, title, x_label, y_label, plot.count, plot.curve, error);
  }
  for (size_t c = 0; c < plot.count; c++)
    free(plot.mean[c]);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"x", 'x', OPTION_TEXT, "AXIS", offsetof(struct options, x), 0, 0, NULL, "Varied input along the bottom: a path or its unique ending."},
    {"by", 'b', OPTION_TEXT, "AXIS", offsetof(struct options, by), 0, 0, NULL, "Another varied input: a line for each of its values, at most 8."},
    {"quantity", 'q', OPTION_TEXT, "NAME", offsetof(struct options, quantity), 0, 0, "largest_fraction",
     "Result to show: a column of the view runs."},
};

const struct command plot_command = {
    .name = "plot",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over one varied input as lines with error bars",
    .doc = "Draws the mean over seeds of a result against a varied input, with the 95 % interval of the mean (Student t) where\n"
           "there are two runs or more, and a line for each value of a second one; `clast stats` prints the same numbers. An\n"
           "axis over a factor of 20 and more is logarithmic. The ending chooses the format, .png or .svg.",
    .examples = "clast plot out.db largest.png -x strain --by angle\nclast plot out.db dust.svg -x strain -q dust_fraction",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
