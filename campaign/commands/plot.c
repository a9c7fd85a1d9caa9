/* `clast plot STORE PICTURE`: a result or an exponent over one varied input, a line for each value of another. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/point.h"

/* Columns of ask_group after the axes. */
enum { VERSION = 1, N = 2, MEAN = 5, HALF = 8, COLUMNS = 9 };
enum { WIDTH = 900, MOST_CURVES = 8, MOST_MEANS = 1000, RESAMPLES = 1000 };

struct options {
  const char *x, *by, *quantity;
};

struct plot {
  struct store *store;
  bool exponent; /* a fit to the runs of each point, no mean of a column */
  enum exponent_method method;
  enum estimates_window window;
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
    return status_fail(error, STATUS_USAGE,
                       "a plot has one axis below (--x), at most one input that tells its lines apart (--by, another "
                       "one), and one quantity");
  for (size_t i = 0; i < plot->axes; i++)
    snprintf(plot->name[i], sizeof plot->name[i], "%s", names[i]);
  const char *mean = names[plot->axes + MEAN];
  snprintf(plot->name[2], sizeof plot->name[2], "%.*s", (int)(strlen(mean) - strlen("_mean")), mean);
  return STATUS_OK;
}

/* keys: the axes' values. */
static status add(struct plot *plot, const struct query_value *keys, int64_t version, struct picture_mean mean,
                  struct error *error) {
  const struct query_value *x = &keys[0];
  if (x->kind == QUERY_TEXT)
    return status_fail(error, STATUS_USAGE, "%s is no number: it can tell lines apart (--by), but is no axis",
                       plot->name[0]);
  if (x->kind == QUERY_NULL)
    return STATUS_OK; /* off, or does not apply: no place on an axis of numbers */
  char value[sizeof plot->value[0]] = "";
  if (plot->axes == 2 && keys[1].kind == QUERY_TEXT)
    snprintf(value, sizeof value, "%s", keys[1].text);
  else if (plot->axes == 2 && keys[1].kind != QUERY_NULL)
    snprintf(value, sizeof value, "%.6g", keys[1].real);
  size_t c = 0;
  while (c < plot->count && (strcmp(plot->value[c], value) != 0 || plot->version[c] != version))
    c++;
  if (c == MOST_CURVES)
    return status_fail(error, STATUS_USAGE, "more than %d lines cannot be told apart: choose a --by with fewer values",
                       MOST_CURVES);
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
  mean.x = x->real;
  for (size_t i = 0; plot->exponent && i < curve->count; i++)
    if (plot->mean[c][i].x == mean.x)
      return status_fail(
          error, STATUS_USAGE,
          "several points share %s = %g and one line: their exponents are not averaged; tell them apart by --by",
          plot->name[0], mean.x);
  plot->mean[c][curve->count++] = mean;
  return STATUS_OK;
}

static status take_group(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct plot *plot = context;
  const struct query_value *rest = values + plot->axes;
  const double mean = rest[MEAN].real, half = rest[N].integer > 1 ? rest[HALF].real : (double)NAN;
  return add(plot, values, rest[VERSION].integer, (struct picture_mean){0, mean, mean - half, mean + half}, error);
}

/* The axes, point_id, results_version, n. */
static status take_point(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct plot *plot = context;
  const struct query_value *rest = values + plot->axes;
  struct pooled_exponent out;
  status code = point_exponent(plot->store, rest[0].integer, rest[1].integer, plot->method, plot->window, RESAMPLES,
                               0.95, &out, error);
  if (code)
    return code;
  const bool several = rest[2].integer > 1;
  const struct picture_mean mean = {0, out.fit.beta, several ? out.interval.lower : (double)NAN,
                                    several ? out.interval.upper : (double)NAN};
  return add(plot, values, rest[1].integer, mean, error);
}

static status fit_points(struct plot *plot, struct error *error) {
  const struct query_sink sink = {plot, NULL, take_point};
  char sql[1000];
  snprintf(
      sql, sizeof sql,
      "select \"%s\", %s%s%s point_id, results_version, n from points where n > 0 order by point_id, results_version",
      plot->name[0], plot->axes == 2 ? "\"" : "", plot->axes == 2 ? plot->name[1] : "", plot->axes == 2 ? "\"," : "");
  return query_run(plot->store, sql, 0, NULL, 0, &sink, error);
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
      snprintf(version, sizeof version, "%sresults_version %lld", plot->axes == 2 ? ", " : "",
               (long long)plot->version[c]);
    snprintf(plot->label[c], sizeof plot->label[c], "%s%s%s%s", plot->axes == 2 ? by : "",
             valued            ? " = "
             : plot->axes == 2 ? ": none"
                               : "",
             plot->value[c], version);
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
  return query_run(store, "select min(unit) from column_doc where column_name = :column and unit <> '1'", 1, &parameter,
                   0, &sink, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x)
    return status_fail(error, STATUS_USAGE, "a plot needs --x, an input that the campaign varied");
  struct plot plot = {.axes = options->by ? 2 : 1};
  status code = estimates_named(options->quantity, &plot.exponent, &plot.method, &plot.window, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &plot.store, error);
  if (code)
    return code;
  struct query_sink sink = {&plot, take_columns, plot.exponent ? NULL : take_group};
  char by[600], title[400], x_label[300], y_label[300], by_label[300];
  snprintf(by, sizeof by, "%s%s%s", options->x, options->by ? "," : "", options->by ? options->by : "");
  code = ask_group(plot.store, by, plot.exponent ? "largest_fraction" : options->quantity, &sink, error);
  if (!code && plot.exponent) {
    snprintf(plot.name[2], sizeof plot.name[2], "%s", options->quantity);
    code = fit_points(&plot, error);
  }
  bool pool = false;
  if (!code)
    code = rows_pool(plot.store, plot.name[0], plot.axes == 2 ? plot.name[1] : NULL, &pool, error);
  if (!code && !(code = label_axis(plot.store, plot.name[0], x_label, error)) &&
      !(code = label_axis(plot.store, plot.name[1], by_label, error)) &&
      !(code = label_axis(plot.store, plot.name[2], y_label, error))) {
    finish(&plot, by_label);
    snprintf(title, sizeof title, "%s, %s over seeds%s with 95 %% interval", plot.name[2],
             plot.exponent ? "pooled" : "mean", pool && !plot.exponent ? " and other inputs" : "");
    code = picture_curves(line->arguments[1], WIDTH, title, x_label, y_label, plot.count, plot.curve, error);
  }
  for (size_t c = 0; c < plot.count; c++)
    free(plot.mean[c]);
  store_close(plot.store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"x", 'x', OPTION_TEXT, "AXIS", offsetof(struct options, x), 0, 0, NULL,
     "Varied input along the bottom: a path or its unique ending."},
    {"by", 'b', OPTION_TEXT, "AXIS", offsetof(struct options, by), 0, 0, NULL,
     "Another varied input: a line for each of its values, at most 8."},
    {"quantity", 'q', OPTION_TEXT, "NAME", offsetof(struct options, quantity), 0, 0, "largest_fraction",
     "Result to show: a column of the view runs, or an exponent pooled over the runs of a point: beta, or "
     "beta_METHOD_WINDOW (beta_binned_from_2)."},
};

const struct command plot_command = {
    .name = "plot",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over one varied input as lines with error bars",
    .doc = "Draws the mean over seeds of a result against a varied input, with the 95 % interval of the mean (Student "
           "t) where\n"
           "there are two runs or more, and a line for each value of a second one; `clast stats` prints the same "
           "numbers.\n"
           "Where other inputs differ, too, it is a mean over them as well, and the title says so. Of an exponent\n"
           "(`clast estimates`) it draws the fit to each point's runs with the interval from resampling runs. An axis "
           "over a\n"
           "factor of 20 and more is logarithmic. The ending chooses the format, .png or .svg.",
    .examples =
        "clast plot out.db largest.png -x strain --by angle\nclast plot out.db beta.svg -x strain --by angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
