/* `clast estimates STORE`: the share of the largest fragment and the exponents of every point, pooled over seeds.
 * Made from the masses in the store each time, so that they are of the runs that are there now. */
#include "campaign/commands/estimates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/point.h"

enum { AXES_MAXIMUM = 16, RESAMPLE_SEED = 1 };
static const double level = 0.95;
static const enum exponent_method methods[] = {EXPONENT_LEAST_SQUARES, EXPONENT_BINNED, EXPONENT_MASSES};
enum { METHODS = sizeof methods / sizeof methods[0] };

struct options {
  int64_t campaign, point, resamples;
  struct table_options table;
};

struct printing {
  struct store *store;
  const struct estimates_choice *choice;
  enum table_format format;
  struct table *table;
  size_t axes;
  char axis[AXES_MAXIMUM][FIELD_TEXT_SIZE]; /* column names */
  char unit[AXES_MAXIMUM][64];
};

static void value_cell(struct table *table, const struct query_value *value, bool blank) {
  if (blank)
    table_text(table, "");
  else if (value->kind == QUERY_TEXT)
    table_text(table, value->text);
  else if (value->kind == QUERY_INTEGER)
    table_integer(table, value->integer);
  else if (value->kind == QUERY_REAL)
    table_real(table, value->real);
  else
    table_missing(table);
}

/* Column order of the query: point_id, results_version, n, failed, mean, half width, then the axes. */
static status point_row(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct printing *printing = context;
  struct point_data point;
  status code = point_read(printing->store, values[0].integer, values[1].integer, &point, error);
  for (int window = 0; !code && window < ESTIMATES_WINDOWS; window++) {
    double lower = point_window(&point, (enum estimates_window)window);
    struct pooled_exponent fits[METHODS];
    int64_t fragments = 0;
    for (int m = 0; m < METHODS; m++) {
      fits[m] = (struct pooled_exponent){.fit = {.beta = NAN, .standard_error = NAN},
                                         .interval = {.standard_error = NAN}};
      if (!code && lower > 0 && point.runs.count > 0)
        code = pooled_exponent(&point.runs, methods[m], lower, (size_t)printing->choice->resamples, level,
                               RESAMPLE_SEED, &fits[m], error);
      if (methods[m] == EXPONENT_MASSES)
        fragments = fits[m].fit.n;
    }
    if (code)
      break;
    if (printing->format == TABLE_TEXT && window > 0 && fragments == 0)
      continue;                                                /* an empty line tells people nothing */
    bool blank = printing->format == TABLE_TEXT && window > 0; /* people see each point's inputs once */
    value_cell(printing->table, &values[0], blank);
    for (size_t i = 6; i < count; i++)
      value_cell(printing->table, &values[i], blank);
    for (size_t i = 2; i < 6; i++)
      value_cell(printing->table, &values[i], blank);
    table_text(printing->table, estimates_window_names[window]);
    table_integer(printing->table, fragments);
    for (int m = 0; m < METHODS; m++) {
      table_fixed(printing->table, fits[m].fit.beta, 2);
      table_fixed(printing->table, fits[m].interval.standard_error, 2);
    }
  }
  point_release(&point);
  return code ? code : table_broken(printing->table) ? STATUS_IO : STATUS_OK;
}

static status take_axis(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct printing *printing = context;
  if (count != 2 || values[0].kind != QUERY_TEXT || printing->axes == AXES_MAXIMUM)
    return STATUS_OK;
  snprintf(printing->axis[printing->axes], FIELD_TEXT_SIZE, "%s", values[0].text);
  snprintf(printing->unit[printing->axes], sizeof printing->unit[0], "%s",
           values[1].kind == QUERY_TEXT ? values[1].text : "");
  printing->axes++;
  return STATUS_OK;
}

static void headings(struct printing *printing) {
  struct table *table = printing->table;
  bool people = printing->format == TABLE_TEXT;
  static const char *const short_names[] = {"beta LSQ", "beta binned", "beta ML"};
  table_column(table, people ? "point" : "point_id", NULL);
  for (size_t i = 0; i < printing->axes; i++)
    table_column(table, printing->axis[i], printing->unit[i]);
  table_column(table, people ? "runs" : "n", NULL);
  table_column(table, "failed", NULL);
  table_column(table, people ? "M_1/M" : "largest_fraction_mean", NULL);
  table_column(table, people ? "+-95%" : "largest_fraction_hw95", NULL);
  table_column(table, "window", NULL);
  table_column(table, "fragments", NULL);
  for (int m = 0; m < METHODS; m++) {
    char name[64];
    const char *method = exponent_method_names[methods[m]];
    snprintf(name, sizeof name, "beta_%s", method);
    table_column(table, people ? short_names[m] : name, NULL);
    snprintf(name, sizeof name, "beta_%s_se", method);
    table_column(table, people ? "+-" : name, NULL);
  }
}

#define CHOSEN                                                                                                         \
  " where (:campaign = 0 or point_id in (select point_id from campaign_point where campaign_id = :campaign))"          \
  " and (:point = 0 or point_id = :point)"

static void parameters_of(const struct estimates_choice *choice, char text[2][32],
                          struct query_parameter parameters[2]) {
  snprintf(text[0], 32, "%lld", (long long)choice->campaign);
  snprintf(text[1], 32, "%lld", (long long)choice->point);
  parameters[0] = (struct query_parameter){"campaign", text[0]};
  parameters[1] = (struct query_parameter){"point", text[1]};
}

status estimates_points(struct store *store, const struct estimates_choice *choice, int64_t *points,
                        struct error *error) {
  char text[2][32];
  struct query_parameter parameters[2];
  double number = 0;
  parameters_of(choice, text, parameters);
  status code = query_number(store, "select count(*) from point" CHOSEN, 2, parameters, &number, error);
  *points = isnan(number) ? 0 : (int64_t)number;
  return code;
}

const char *const estimates_legend =
    "beta: exponent of F(m) ~ m^-beta (differential), pooled over the runs of a point, each run's largest fragment "
    "left out.\n"
    "LSQ: least squares on log bins, the paper's way, biased; binned, ML: maximum likelihood on bins and on masses.\n"
    "Windows hold fragments of 2, 5, 10 mean masses of a grain or particle and more (from N - 1/2). Errors: one "
    "standard error, from resampling runs.\n";

status estimates_rows(struct store *store, const struct estimates_choice *choice, enum table_format format, FILE *out,
                      struct error *error) {
  struct printing printing = {.store = store, .choice = choice, .format = format};
  struct query_sink axes = {&printing, NULL, take_axis}, points = {&printing, NULL, point_row};
  status code = query_run(store, "select column_name, unit from axis order by path", 0, NULL, 0, &axes, error);
  if (code)
    return code;
  char *sql = NULL;
  size_t size = 0;
  FILE *text = open_memstream(&sql, &size);
  if (!text)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  fputs("select point_id, results_version, n, failed, largest_fraction_mean, largest_fraction_hw95", text);
  for (size_t i = 0; i < printing.axes; i++)
    fprintf(text, ", \"%s\"", printing.axis[i]);
  fputs(" from points as newest" CHOSEN " and (results_version is null or results_version ="
        " (select max(results_version) from point_total as t where t.point_id = newest.point_id)) order by point_id",
        text);
  fclose(text);
  char numbers[2][32];
  struct query_parameter parameters[2];
  parameters_of(choice, numbers, parameters);
  printing.table = table_new(format, out);
  headings(&printing);
  code = sql ? query_run(store, sql, 2, parameters, 0, &points, error)
             : status_fail(error, STATUS_MEMORY, "out of memory");
  free(sql);
  if (code && !table_broken(printing.table)) {
    table_drop(printing.table);
    return code;
  }
  return table_end(printing.table, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  status code = table_choose(&options->table, &format, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  struct estimates_choice choice = {options->campaign, options->point, options->resamples};
  code = estimates_rows(store, &choice, format, stdout, error);
  if (!code && format == TABLE_TEXT)
    fputs(estimates_legend, stderr);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"point", 'p', OPTION_INTEGER, "N", offsetof(struct options, point), 0, INT64_MAX, "0",
     "Only this point (point_id in the view points); 0 is all."},
    {"campaign", 0, OPTION_INTEGER, "N", offsetof(struct options, campaign), 0, INT64_MAX, "0",
     "Only the points of this campaign (`clast status`); 0 is all."},
    {"resamples", 0, OPTION_INTEGER, "N", offsetof(struct options, resamples), 0, 100000, "1000",
     "Resamples of the runs for the errors of the exponents; 0 is none."},
    TABLE_OPTIONS(struct options, table),
};

const struct command estimates_command = {
    .name = "estimates",
    .group = "results",
    .arguments = "STORE",
    .summary = "largest fragment and exponents of every point, pooled over seeds, with errors",
    .doc =
        "Prints what `clast run` ends with: for every point M_1/M with its 95 % interval, and the exponent beta of\n"
        "F(m) ~ m^-beta (differential) by three methods, least squares on log bins (the paper's way, biased), maximum\n"
        "likelihood on bins and on masses, in three windows (2, 5, 10 mean masses of a grain or particle\n"
        "and more, each run's largest fragment left out). Errors of the exponents come from resampling runs.",
    .examples = "clast estimates out.db\nclast estimates out.db --point 1 --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
