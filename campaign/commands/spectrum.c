/* `clast spectrum STORE`: fragment mass spectra, pooled over the seeds of each point. */
#include <math.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "campaign/commands/commands.h"
#include "campaign/terminal/chart_option.h"
#include "campaign/terminal/rows.h"
#include "db/ask/point.h"
#include "db/ask/points.h"
#include "db/ask/spectrum.h"

struct options {
  int64_t point;
  const char *where, *picture;
  bool plot, ascii;
  struct table_options table;
  struct chart_options chart;
};

enum { POINTS_MAXIMUM = 8, COLUMNS = 100 }; /* more curves in one picture cannot be told apart */

/* Is a pure power law enough? Likelihood ratios against two rivals, in the same windows. */
static void print_rivals(const struct pooled_rivals *rivals) {
  if (rivals->n == 0 || !isfinite(rivals->cutoff_beta))
    return;
  printf("  exponential cut-off: ");
  if (isfinite(rivals->cutoff_mass))
    printf("beta %.2f, cut-off mass %.3g kg, 2 dlnL %.1f, p %.2g\n", rivals->cutoff_beta, rivals->cutoff_mass,
           rivals->cutoff_ratio, rivals->cutoff_p);
  else
    printf("none\n");
  printf("  lognormal: 2 dlnL %.1f, p %.2g (small p: better than the pure power law)\n", rivals->lognormal_ratio,
         rivals->lognormal_p);
}

struct drawing {
  int64_t points[POINTS_MAXIMUM];
  size_t count, there; /* points drawn; points with runs */
  struct point_curve curves[POINTS_MAXIMUM];
  struct pooled_rivals rivals[POINTS_MAXIMUM];
  struct picture_series series[POINTS_MAXIMUM];
};

static status choose_points(struct store *store, int64_t point, struct drawing *drawing, struct error *error) {
  if (point) {
    drawing->points[0] = point;
    drawing->count = 1;
    return STATUS_OK;
  }
  status code = ask_points_with_runs(store, POINTS_MAXIMUM, drawing->points, &drawing->there, error);
  if (code)
    return code;
  drawing->count = drawing->there < POINTS_MAXIMUM ? drawing->there : POINTS_MAXIMUM;
  if (drawing->count == 0)
    return status_fail(error, STATUS_USAGE, "the store has no finished runs to draw");
  return STATUS_OK;
}

static status make_series(struct store *store, bool with_rivals, struct drawing *drawing, size_t i,
                          struct error *error) {
  struct point_data point;
  char inputs[112], label[128];
  status code = ask_points_label(store, drawing->points[i], inputs, sizeof inputs, error);
  if (code)
    return code;
  code = point_read(store, drawing->points[i], 0, &point, error);
  if (code)
    return code;
  snprintf(label, sizeof label, "%s, %zu run%s", inputs, point.runs.count, point.runs.count == 1 ? "" : "s");
  code = point_curve_make(&point, label, &drawing->curves[i], error);
  const double lower = point_window(&point, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  if (code == STATUS_OK && with_rivals && lower > 0)
    code = pooled_rivals(&point.runs, lower, &drawing->rivals[i], error);
  point_release(&point);
  drawing->series[i] = point_curve_series(&drawing->curves[i]);
  return code;
}

static status draw_picture(const struct options *options, const struct drawing *drawing, struct error *error) {
  const struct picture_page page = chart_option_page(options->picture, &options->chart);
  const struct picture_words words =
      {"Fragment mass spectrum, pooled over seeds",
       "Bars: 95 % intervals over seeds. Grey: fragments are missing (too few particles)", "fragment mass m (kg)",
       "F(m), fragments per run and kg"};
  return picture_spectrum(&page, &words, drawing->count, drawing->series, error);
}

static status draw(struct store *store, const struct options *options, struct error *error) {
  struct drawing drawing = {0};
  status code = choose_points(store, options->point, &drawing, error);
  for (size_t i = 0; code == STATUS_OK && i < drawing.count; i++)
    code = make_series(store, options->plot, &drawing, i, error);
  if (code == STATUS_OK && options->picture)
    code = draw_picture(options, &drawing, error);
  for (size_t i = 0; code == STATUS_OK && options->plot && i < drawing.count; i++) {
    printf("%s%s\n", i ? "\n" : "", drawing.series[i].label);
    text_plot_spectrum(stdout, COLUMNS, !options->ascii, "kg", &drawing.series[i]);
    print_rivals(&drawing.rivals[i]);
  }
  if (code == STATUS_OK && drawing.there > drawing.count)
    fprintf(stderr, "clast: the first %zu of %zu points are drawn; --point N draws one\n", drawing.count,
            drawing.there);
  for (size_t i = 0; i < drawing.count; i++)
    point_curve_release(&drawing.curves[i]);
  return code;
}

static status print_rows(struct store *store, const struct options *options, enum table_format format,
                         struct error *error) {
  struct rows rows;
  const struct query_sink sink = rows_sink(&rows, store, format, stdout);
  return rows_end(&rows, ask_spectrum(store, options->point, options->where, &sink, error), error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
  code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = ask_points_known(store, options->point, error);
  if (code == STATUS_OK && !options->plot)
    code = print_rows(store, options, format, error);
  if (code == STATUS_OK && (options->picture || options->plot))
    code = draw(store, options, error);
  store_close(store, NULL);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_INTEGER("point", 'p', "N", struct options, point, 0, INT64_MAX, "0",
                       "Only this point (point_id in the view points); 0: all."),
    OPTION_ROW_TEXT("where", 'w', "SQL", struct options, where, NULL,
                    "Only runs that meet this SQL condition on the view runs: \"threshold_strain > 0.02\"."),
    OPTION_ROW_TEXT(
        "picture", 0, "FILE.png", struct options, picture, NULL,
        "Also draw F(m) with the fitted power law, of --point or of the first eight points. PNG or SVG by the ending."),
    OPTION_ROW_FLAG("plot", 0, struct options, plot,
                    "Plot F(m) as text instead of the table, of --point or of the first eight points."),
    OPTION_ROW_FLAG("ascii", 0, struct options, ascii, "Use ASCII characters only in the plot."),
    CHART_OPTIONS(struct options, chart),
    TABLE_OPTIONS(struct options, table),
};

const struct command spectrum_command = {
    .name = "spectrum",
    .group = "results",
    .arguments = "STORE",
    .summary = "fragment mass spectra of the points, with errors from run to run",
    .doc =
        "Prints one row per point and mass bin that has fragments: the fragments of all runs that count, the density\n"
        "F(m) (fragments per kg and run) with its standard error from the scatter between runs, and the share of the\n"
        "mass. F(m) is differential: where F(m) ~ m^-beta, N(>m) has the exponent beta - 1.",
    .examples = "clast spectrum out.db --point 1 --plot\nclast spectrum out.db --csv --picture spectrum.svg",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
