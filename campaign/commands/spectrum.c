/* `clast spectrum STORE`: fragment mass spectra, pooled over the seeds of each point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/text_plot.h"
#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/point.h"

struct options {
  int64_t point;
  const char *where, *picture;
  bool plot, ascii;
  struct table_options table;
};

/* From the bins of single runs, so that any condition on runs can choose them. The scatter between runs gives the
 * error: fragments of one run are not independent. */
static const char
    sql_start[] = "with chosen as (select r.run_id, r.point_id, r.results_version, (select total_mass from run where "
                  "run_id = r.run_id) as m"
                  "   from run as r where r.counts and r.results_version ="
                  "   (select max(results_version) from run as newest where newest.point_id = r.point_id)",
    sql_end[] = "), total as (select point_id, count(*) as n, sum(m) as mass from chosen group by point_id),"
                " pooled as (select point_id, bin, sum(count) as s1, sum(count * count) as s2, sum(mass) as mass"
                "   from chosen join spectrum using (run_id) group by point_id, bin)"
                " select point_id, lower, upper, n as runs, s1 as fragments,"
                "   s1 / (n * (upper - lower)) as density,"
                "   case when n > 1 then sqrt(max(0.0, (1.0 * s2 - 1.0 * s1 * s1 / n) / (n - 1) / n)) / (upper - "
                "lower) end as density_error,"
                "   pooled.mass / total.mass as mass_share"
                " from pooled join total using (point_id) join bin using (bin) order by point_id, bin";

enum { POINTS_MAXIMUM = 8, WIDTH = 900, COLUMNS = 100 }; /* more curves in one picture cannot be told apart */

struct chosen {
  int64_t points[POINTS_MAXIMUM];
  size_t count, there;
};

static status take_point(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct chosen *chosen = context;
  chosen->there++;
  if (chosen->count < POINTS_MAXIMUM)
    chosen->points[chosen->count++] = values[0].integer;
  return STATUS_OK;
}

/* Whether a pure power law is enough, by likelihood ratios in the same windows. */
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

/* "strain 0.03, angle 0.0698 rad, 20 runs": the varied inputs by the last words of their paths. */
struct label {
  char text[128];
  size_t used;
};

static status add_input(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct label *label = context;
  const char *word = strrchr(values[0].text, '.');
  char value[64];
  if (values[1].kind == QUERY_TEXT)
    snprintf(value, sizeof value, "%s", values[1].text);
  else
    snprintf(value, sizeof value, "%.3g", values[1].real);
  bool unit = values[2].kind == QUERY_TEXT && strcmp(values[2].text, "1") != 0;
  char item[128];
  int size = snprintf(item, sizeof item, "%s %s%s%s, ", word ? word + 1 : values[0].text, value, unit ? " " : "",
                      unit ? values[2].text : "");
  if (size > 0 &&
      label->used + (size_t)size + sizeof "20000 runs" < sizeof label->text) { /* what does not fit is left out */
    memcpy(label->text + label->used, item, (size_t)size + 1);
    label->used += (size_t)size;
  }
  return STATUS_OK;
}

static status label_of(struct store *store, int64_t point, size_t runs, struct label *label, struct error *error) {
  char number[32];
  snprintf(number, sizeof number, "%lld", (long long)point);
  const struct query_parameter parameter = {"point", number};
  const struct query_sink sink = {label, NULL, add_input};
  *label = (struct label){0};
  status code = query_run(store,
                          "select path, value, unit from point_input join axis using (path) where point_id = :point "
                          "order by path desc",
                          1, &parameter, 0, &sink, error);
  if (label->used == 0) /* nothing was varied */
    label->used = (size_t)snprintf(label->text, sizeof label->text, "point %lld, ", (long long)point);
  snprintf(label->text + label->used, sizeof label->text - label->used, "%zu run%s", runs, runs == 1 ? "" : "s");
  return code;
}

static status draw(struct store *store, const struct options *options, struct error *error) {
  struct chosen chosen = {.points = {options->point}, .count = options->point ? 1 : 0};
  struct query_sink sink = {&chosen, NULL, take_point};
  struct point_curve curves[POINTS_MAXIMUM] = {0};
  struct pooled_rivals rivals[POINTS_MAXIMUM] = {0};
  struct picture_series series[POINTS_MAXIMUM];
  status code = STATUS_OK;
  if (!options->point)
    code = query_run(store, "select point_id from point_total where runs > 0 group by point_id order by point_id", 0,
                     NULL, 0, &sink, error);
  for (size_t i = 0; !code && i < chosen.count; i++) {
    struct point_data point;
    code = point_read(store, chosen.points[i], 0, &point, error);
    struct label label;
    if (!code)
      code = label_of(store, chosen.points[i], point.runs.count, &label, error);
    if (!code)
      code = point_curve_make(&point, label.text, &curves[i], error);
    double lower = point_window(&point, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
    if (!code && options->plot && lower > 0)
      code = pooled_rivals(&point.runs, lower, &rivals[i], error);
    point_release(&point);
    series[i] = point_curve_series(&curves[i]);
  }
  if (!code && chosen.count == 0)
    code = status_fail(error, STATUS_USAGE, "the store has no finished runs to draw");
  if (!code && options->picture)
    code = picture_spectrum(options->picture, WIDTH, "fragment mass spectrum", "kg", chosen.count, series, error);
  for (size_t i = 0; !code && options->plot && i < chosen.count; i++) {
    printf("%s%s\n", i ? "\n" : "", series[i].label);
    text_plot_spectrum(stdout, COLUMNS, !options->ascii, "kg", &series[i]);
    print_rivals(&rivals[i]);
  }
  if (!code && chosen.there > chosen.count)
    fprintf(stderr, "clast: the first %zu of %zu points are drawn; --point N draws one\n", chosen.count, chosen.there);
  for (size_t i = 0; i < chosen.count; i++)
    point_curve_release(&curves[i]);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  char *sql = NULL;
  size_t size = 0;
  status code = table_choose(&options->table, &format, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  FILE *text = options->plot ? NULL : open_memstream(&sql, &size);
  if (text) {
    fputs(sql_start, text);
    if (options->point)
      fprintf(text, " and r.point_id = %lld", (long long)options->point);
    if (options->where)
      fprintf(text, " and r.run_id in (select run_id from runs where %s\n)", options->where);
    fputs(sql_end, text);
    fclose(text);
  }
  if (!options->plot)
    code = sql ? rows_print(store, sql, 0, NULL, format, stdout, error)
               : status_fail(error, STATUS_MEMORY, "out of memory");
  free(sql);
  if (!code && (options->picture || options->plot))
    code = draw(store, options, error);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"point", 'p', OPTION_INTEGER, "N", offsetof(struct options, point), 0, INT64_MAX, "0",
     "Only this point (point_id in the view points); 0 is all."},
    {"where", 'w', OPTION_TEXT, "SQL", offsetof(struct options, where), 0, 0, NULL,
     "Only runs for which this holds, on the view runs: \"threshold_strain > 0.02\"."},
    {"picture", 0, OPTION_TEXT, "FILE.png", offsetof(struct options, picture), 0, 0, NULL,
     "Draw F(m) with the fitted power law too: of --point, or of the first eight points. PNG or SVG by the ending."},
    {"plot", 0, OPTION_FLAG, NULL, offsetof(struct options, plot), 0, 0, NULL,
     "Plot F(m) as text instead of the table: of --point, or of the first eight points."},
    {"ascii", 0, OPTION_FLAG, NULL, offsetof(struct options, ascii), 0, 0, NULL, "The plot in ASCII characters only."},
    TABLE_OPTIONS(struct options, table),
};

const struct command spectrum_command = {
    .name = "spectrum",
    .group = "results",
    .arguments = "STORE",
    .summary = "fragment mass spectra of the points, with errors from run to run",
    .doc =
        "Prints for each point and each mass bin that holds something the fragments of all runs that count, the\n"
        "density F(m) (fragments per kg and run) with its standard error from the scatter between runs, and the share\n"
        "of the mass. F(m) is differential: a power law m^-beta has this slope on it, N(>m) has beta - 1.",
    .examples = "clast spectrum out.db --point 1 --plot\nclast spectrum out.db --csv --picture spectrum.svg",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
