/* `clast estimates STORE`: the share of the largest fragment and the exponents of every point, pooled over seeds.
 * Made from the masses in the store each time, so that they are of the runs that are there now. */
#include "campaign/commands/estimates.h"

#include "campaign/commands/commands.h"
#include "campaign/commands/quantity.h"
#include "campaign/terminal/rows.h"
#include "campaign/terminal/uncertainty.h"
#include "db/ask/columns.h"
#include "db/ask/point.h"

enum { AXES_MAXIMUM = 16 };

struct options {
  int64_t campaign, point;
  struct table_options table;
};

struct printing {
  struct store *store;
  enum table_format format;
  struct table *table;
  size_t axes;
  struct ask_column axis[AXES_MAXIMUM];
};

/* Order of the methods in point_estimates. */
static const enum exponent_method methods[] = {EXPONENT_LEAST_SQUARES, EXPONENT_BINNED, EXPONENT_MASSES};
enum { METHODS = sizeof methods / sizeof methods[0], MASSES = METHODS - 1 };

/* The first cells of a row: the point and its runs. For people they are blank in all but the first row of a point. */
static void point_cells(struct printing *printing, const struct ask_points_row *row, bool blank) {
  struct table *table = printing->table;
  char text[UNCERTAINTY_TEXT];
  if (blank) {
    for (size_t i = 0; i < row->input_count + 6; i++)
      table_text(table, "");
    return;
  }
  table_integer(table, row->point_id);
  for (size_t i = 0; i < row->input_count; i++)
    rows_cell(table, &row->inputs[i]);
  table_integer(table, row->n);
  table_integer(table, row->failed);
  table_real(table, row->mean);
  table_real(table, row->half_width);
  if (printing->format == TABLE_TEXT) {
    uncertainty_resolution_cell(row->resolution_verdict, row->resolution, text);
    table_text(table, text);
    return;
  }
  table_real(table, row->resolution);
  table_text(table, ask_resolution_names[row->resolution_verdict]);
}

static void window_cells(struct table *table, int window, const struct point_estimate *fits) {
  table_text(table, estimates_window_names[window]);
  table_integer(table, fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n);
  for (int m = 0; m < METHODS; m++) {
    const struct pooled_exponent *fit = &fits[m * ESTIMATES_WINDOWS + window].exponent;
    table_fixed(table, fit->fit.beta, 2);
    table_fixed(table, fit->interval.half_width, 2);
  }
}

static status print_point(void *context, const struct ask_points_row *row, struct error *error) {
  struct printing *printing = context;
  struct point_estimate fits[POINT_ESTIMATES];
  struct point_data point;
  status code = point_read(printing->store, row->point_id, row->results_version, &point, error);
  if (code)
    return code;
  code = point_estimates(&point, 0.95, fits, error);
  point_release(&point);
  if (code)
    return code;

  for (int window = 0; window < ESTIMATES_WINDOWS; window++) {
    const bool later = printing->format == TABLE_TEXT && window > 0;
    if (later && fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n == 0)
      continue; /* an empty line tells people nothing */
    point_cells(printing, row, later);
    window_cells(printing->table, window, fits);
  }
  return table_broken(printing->table) ? STATUS_IO : STATUS_OK;
}

static void headings(struct printing *printing) {
  struct table *table = printing->table;
  const bool people = printing->format == TABLE_TEXT;
  static const char *const short_names[] = {"beta LSQ", "beta binned", "beta ML"};
  table_column(table, people ? "point" : "point_id", NULL);
  for (size_t i = 0; i < printing->axes; i++)
    table_column(table, printing->axis[i].name, printing->axis[i].unit);
  table_column(table, people ? "runs" : "n", NULL);
  table_column(table, "failed", NULL);
  table_column(table, people ? "M_1/M" : "largest_fraction_mean", NULL);
  table_column(table, people ? "+-95%" : "largest_fraction_hw95", NULL);
  table_column(table, people ? "+-resolution" : "largest_fraction_resolution", NULL);
  if (!people)
    table_column(table, "largest_fraction_resolution_verdict", NULL);
  table_columns(table, (const char *const[]){"window", "fragments", NULL});
  for (int m = 0; m < METHODS; m++) {
    char name[64];
    const char *method = exponent_method_names[methods[m]];
    snprintf(name, sizeof name, "beta_%s", method);
    table_column(table, people ? short_names[m] : name, NULL);
    snprintf(name, sizeof name, "beta_%s_hw95", method);
    table_column(table, people ? "+-95%" : name, NULL);
  }
}

static const char *const estimates_legend =
    "+-95%: half width of the 95 % interval over seeds (Student's t); one run has none.\n+-resolution: how far finer "
    "settings may move M_1/M (`clast converge` measures it).\nbeta: exponent of F(m) ~ m^-beta (differential), of all "
    "runs of a point together.\nLSQ: least "
    "squares on logarithmic bins of one decade, as in the paper; it needs a fragment in every bin.\nbinned, ML: "
    "maximum likelihood on bins and on masses, without the largest fragment of each run.\nWindows: from 1.5, 4.5, 9.5 "
    "mean masses of a grain or particle; the first holds single grains heavier than 1.5 means.\n";

void estimates_explain(struct store *store) {
  fputs(estimates_legend, stderr);
  quantity_tell_resolution(store, OUTCOME_DEFAULT, "");
  quantity_tell_resolution(store, "beta", "");
}

status estimates_print(struct store *store, const struct ask_points_choice *choice, enum table_format format, FILE *out,
                       struct error *error) {
  struct printing printing = {.store = store, .format = format};
  status code = ask_columns_axes(store, AXES_MAXIMUM, printing.axis, &printing.axes, error);
  if (code)
    return code;
  const char *inputs[AXES_MAXIMUM];
  for (size_t i = 0; i < printing.axes; i++)
    inputs[i] = printing.axis[i].name;

  printing.table = table_new(format, out);
  headings(&printing);
  code = ask_points_rows(store, choice, true, printing.axes, inputs, print_point, &printing, error);
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
  code = ask_points_known(store, options->point, error);
  const struct ask_points_choice choice = {.campaign = options->campaign, .point = options->point};
  if (!code)
    code = estimates_print(store, &choice, format, stdout, error);
  if (!code && format == TABLE_TEXT)
    estimates_explain(store);
  store_close(store, NULL);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_INTEGER("point", 'p', "N", struct options, point, 0, INT64_MAX, "0",
                       "Only this point (point_id in the view points); 0: all."),
    OPTION_ROW_INTEGER("campaign", 0, "N", struct options, campaign, 0, INT64_MAX, "0",
                       "Only the points of this campaign (`clast status` lists them); 0: all."),
    TABLE_OPTIONS(struct options, table),
};

const struct command estimates_command = {
    .name = "estimates",
    .group = "results",
    .arguments = "STORE",
    .summary = "largest fragment and exponents of every point, pooled over seeds, with errors",
    .doc =
        "Prints the table that `clast run` ends with. For every point: the mass share of the largest fragment, M_1/M,\n"
        "and the exponent beta of F(m) ~ m^-beta (differential) by three methods: least squares on logarithmic bins\n"
        "(as in the paper, over one decade), maximum likelihood on bins, and maximum likelihood on masses. Each in\n"
        "three windows: from fragments of 2, 5 and 10 mean masses of a grain or particle on; maximum likelihood\n"
        "without the largest fragment of each run. All with 95 % intervals over seeds; one run has none.",
    .examples = "clast estimates out.db\nclast estimates out.db --point 1 --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
