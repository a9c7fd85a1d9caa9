/* The table of estimates: for programs with a column for every number, for people no wider than a terminal. */
#include <math.h>
#include <string.h>

#include "campaign/print/print.h"
#include "campaign/terminal/uncertainty.h"
#include "db/ask/ask.h"
#include "schemas/limits.h"
#include "schemas/text.h"

/* Columns of the table for people that can be left out, in this order: the least wanted first. Varied inputs stay, else
 * rows of different points look alike. */
enum { LEAST_SQUARES, BETA_RESOLUTION, FRAGMENTS, MEAN_RESOLUTION, LIKELIHOOD, OPTIONAL_COLUMNS };
static const struct {
  const char *name;
  size_t width; /* with the gap before the next column */
} optional[OPTIONAL_COLUMNS] = {{"beta LSQ", 11},
                                {"\xc2\xb1res of beta", 6},
                                {"n", 6},
                                {"\xc2\xb1res of M_1/M", 7},
                                {"beta ML with its window", 20}};

struct printing {
  struct store *store;
  enum table_format format;
  struct table *table;
  bool studied; /* some exponent has a study; otherwise no point's study is read */
  size_t axes;
  struct ask_column axis[LIMITS_AXES_OF_POOL];
  bool left_out[OPTIONAL_COLUMNS]; /* they do not fit into a terminal */
};

/* Order of the methods in point_estimates. */
static const enum exponent_method methods[] = {EXPONENT_LEAST_SQUARES, EXPONENT_MASSES};
enum { METHODS = sizeof methods / sizeof methods[0], MASSES = METHODS - 1 };

/* Of a point's runs: about the masses of the fragments, and about any number of its rows. */
struct doubts {
  struct ask_doubts masses, all;
};

/* ---- for programs: every number in a column of its own ---- */

static void columns_for_programs(struct printing *printing) {
  struct table *table = printing->table;
  table_column(table, "point_id", NULL);
  for (size_t i = 0; i < printing->axes; i++)
    table_column(table, printing->axis[i].name, printing->axis[i].unit);
  table_columns(table, (const char *const[]){"n", "failed", "largest_fraction_mean", "largest_fraction_hw95",
                                             "largest_fraction_low95", "largest_fraction_high95",
                                             "largest_fraction_weak", "largest_fraction_resolution",
                                             "largest_fraction_resolution_verdict", "window", "fragments", NULL});
  for (int m = 0; m < METHODS; m++) {
    static const char *const ends[] = {"", "_hw95", "_resolution", "_resolution_verdict"};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
      char name[64];
      snprintf(name, sizeof name, "beta_%s%s", exponent_method_names[methods[m]], ends[i]);
      table_column(table, name, NULL);
    }
  }
  table_doubt_columns(table);
}

/* Reads the possible change by finer settings of the exponent of a method and window at a point. */
static status read_resolution(const struct printing *printing, const struct ask_points_row *row, int method, int window,
                              struct ask_resolution *resolution, struct error *error) {
  char name[64];
  snprintf(name, sizeof name, "beta_%s_%s", exponent_method_names[methods[method]], estimates_window_names[window]);
  *resolution = (struct ask_resolution){.half_width = NAN};
  return printing->studied ? ask_resolution(printing->store, row->point_id, name, resolution, error) : STATUS_OK;
}

static status row_for_programs(struct printing *printing, const struct ask_points_row *row, int window,
                               const struct point_estimate *fits, const struct doubts *doubts, struct error *error) {
  struct table *table = printing->table;
  table_integer(table, row->point_id);
  for (size_t i = 0; i < row->input_count; i++)
    table_value(table, &row->inputs[i]);
  table_integer(table, row->n);
  table_integer(table, row->failed);
  table_real(table, row->mean);
  table_real(table, row->half_width);
  table_real(table, row->low);
  table_real(table, row->high);
  table_integer(table, row->weak);
  table_real(table, row->resolution);
  table_text(table, ask_resolution_names[row->resolution_verdict]);
  table_text(table, estimates_window_names[window]);
  table_integer(table, fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n);
  for (int m = 0; m < METHODS; m++) {
    const struct pooled_exponent *fit = &fits[m * ESTIMATES_WINDOWS + window].exponent;
    struct ask_resolution resolution;
    TRY(read_resolution(printing, row, m, window, &resolution, error));
    table_real(table, fit->fit.beta);
    table_real(table, fit->interval.half_width);
    table_real(table, resolution.half_width);
    table_text(table, ask_resolution_names[resolution.verdict]);
  }
  table_doubt_cells(table, &doubts->all);
  return STATUS_OK;
}

/* ---- for people: values with their intervals, and no wider than a terminal ---- */

/* Widths: the table; point, runs and M_1/M; the gap between columns; most values. */
enum { WIDTH = 100, FIXED = 26, GAP = 2, NUMBER = 5 };

/* Does the name of another axis end like this? */
static bool is_ambiguous(const struct printing *printing, size_t axis, const char *tail) {
  for (size_t i = 0; i < printing->axes; i++) {
    const size_t length = strlen(printing->axis[i].name), end = strlen(tail);
    if (i != axis && length >= end && strcmp(printing->axis[i].name + length - end, tail) == 0)
      return true;
  }
  return false;
}

/* A heading for the axis: the last words of its path that no other axis has. "m" and "k" alone are not clear enough. */
static const char *short_axis(const struct printing *printing, size_t axis) {
  const char *const name = printing->axis[axis].name, *word = name + strlen(name);
  while (word > name && (word[-1] != '_' || strlen(word) < 2 || is_ambiguous(printing, axis, word)))
    word--;
  return word;
}

static size_t axis_width(const struct printing *printing, size_t axis) {
  const char *unit = printing->axis[axis].unit;
  const size_t head = strlen(short_axis(printing, axis)), cell = NUMBER + (strcmp(unit, "1") ? strlen(unit) + 1 : 0);
  return (head > cell ? head : cell) + GAP;
}

/* "4 deg": the heading has no unit, so that it is short. */
static void axis_cell(struct table *table, const struct ask_column *axis, const struct query_value *value) {
  const struct query_value shown = ask_columns_value(axis, value);
  char text[sizeof axis->unit + 40];
  if ((shown.kind != QUERY_REAL && shown.kind != QUERY_INTEGER) || !*axis->unit || strcmp(axis->unit, "1") == 0) {
    table_value(table, &shown);
    return;
  }
  snprintf(text, sizeof text, "%.5g %s", shown.real, axis->unit);
  table_text(table, text);
}

/* Leaves columns out until the rest fits, or all are out that can be. */
static void choose_columns(struct printing *printing) {
  size_t used = FIXED;
  for (size_t i = 0; i < printing->axes; i++)
    used += axis_width(printing, i);
  for (int i = 0; i < OPTIONAL_COLUMNS; i++)
    used += optional[i].width;
  for (int i = 0; i < OPTIONAL_COLUMNS && used > WIDTH; i++) {
    printing->left_out[i] = true;
    used -= optional[i].width;
  }
}

static void tell_left_out(const struct printing *printing) {
  for (int i = 0; i < OPTIONAL_COLUMNS && printing->left_out[i]; i++)
    fprintf(stderr, "%s%s", i ? ", " : "clast: for lack of room these columns are left out: ", optional[i].name);
  if (printing->left_out[0])
    fputs("; --csv and --json have all\n", stderr);
}

static void columns_for_people(struct printing *printing) {
  struct table *table = printing->table;
  const bool *out = printing->left_out;
  choose_columns(printing);
  table_column(table, "point", NULL);
  for (size_t i = 0; i < printing->axes; i++)
    table_column(table, short_axis(printing, i), NULL);
  table_columns(table, (const char *const[]){"runs", "M_1/M", NULL});
  if (!out[MEAN_RESOLUTION])
    table_column(table, "\xc2\xb1res", NULL);
  if (!out[LIKELIHOOD])
    table_column(table, "window", NULL);
  if (!out[FRAGMENTS])
    table_column(table, "n", NULL);
  if (!out[LEAST_SQUARES])
    table_column(table, "beta LSQ", NULL);
  if (!out[LIKELIHOOD])
    table_column(table, out[LEAST_SQUARES] ? "beta ML" : "ML", NULL);
  if (!out[BETA_RESOLUTION])
    table_column(table, "\xc2\xb1res", NULL);
}

/* "2.01 \u00b1 0.13" without the blanks; the value alone when it has no interval; "-" for none. */
static void with_interval(struct table *table, double value, double half_width, int decimals, const char *mark) {
  char text[80] = "";
  if (isnan(value)) {
    table_missing(table);
    return;
  }
  text_append_fixed(text, sizeof text, value, decimals);
  if (!isnan(half_width)) {
    text_append(text, sizeof text, "\xc2\xb1");
    text_append_fixed(text, sizeof text, half_width, decimals);
    text_append(text, sizeof text, "%s", mark);
  }
  table_text(table, text);
}

/* "0.928\u00b10.009", "0.928\u00b10.009~" when the interval is weak, "1.000\u22650.905" when all runs are equal. */
static void mean_cell(struct table *table, const struct ask_points_row *row) {
  char text[80] = "";
  if (row->mean >= 1 && isnan(row->half_width) && isfinite(row->low)) {
    text_append_fixed(text, sizeof text, row->mean, 3);
    text_append(text, sizeof text, "\xe2\x89\xa5");
    text_append_fixed(text, sizeof text, row->low, 3);
    table_text(table, text);
    return;
  }
  with_interval(table, row->mean, row->half_width, 3, row->weak ? "~" : "");
}

static void resolution_cell(struct table *table, enum ask_resolution_verdict verdict, double half_width) {
  char text[UNCERTAINTY_TEXT];
  if (verdict == ASK_RESOLUTION_NOT_STUDIED)
    snprintf(text, sizeof text, "?");
  else
    uncertainty_resolution_cell(verdict, half_width, text);
  table_text(table, text);
}

static status row_for_people(struct printing *printing, const struct ask_points_row *row, int window,
                             const struct point_estimate *fits, const struct doubts *doubts, struct error *error) {
  struct table *table = printing->table;
  const bool *out = printing->left_out;
  if (window > 0) { /* only the point's first row shows its inputs and runs */
    for (size_t i = 0; i < printing->axes + 3 + !out[MEAN_RESOLUTION]; i++)
      table_text(table, "");
  } else {
    char runs[64] = "";
    table_integer(table, row->point_id);
    for (size_t i = 0; i < printing->axes; i++)
      axis_cell(table, &printing->axis[i], &row->inputs[i]);
    text_append(runs, sizeof runs, "%lld", (long long)row->n);
    if (row->failed)
      text_append(runs, sizeof runs, "/%.0f", (double)row->n + (double)row->failed); /* a sum that cannot overflow */
    table_text(table, runs);
    table_rests_on(table, &row->doubts);
    mean_cell(table, row);
    if (!out[MEAN_RESOLUTION])
      resolution_cell(table, row->resolution_verdict, row->resolution);
  }
  if (!out[LIKELIHOOD])
    table_text(table, estimates_window_names[window]);
  if (!out[FRAGMENTS])
    table_integer(table, fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n);
  for (int m = 0; m < METHODS; m++) {
    const struct pooled_exponent *fit = &fits[m * ESTIMATES_WINDOWS + window].exponent;
    if (out[m == MASSES ? LIKELIHOOD : LEAST_SQUARES])
      continue;
    table_rests_on(table, &doubts->masses);
    with_interval(table, fit->fit.beta, fit->interval.half_width, 2, "");
  }
  if (out[BETA_RESOLUTION])
    return STATUS_OK;
  struct ask_resolution resolution;
  const status code = read_resolution(printing, row, MASSES, window, &resolution, error);
  resolution_cell(table, resolution.verdict, resolution.half_width);
  return code;
}

static status print_point(struct printing *printing, const struct ask_points_row *row, struct error *error) {
  struct point_estimate fits[POINT_ESTIMATES];
  struct point_data point;
  struct doubts doubts = {0};
  const struct ask_doubts_choice choice = {.point = row->point_id};
  char all[ASK_DOUBTS_RESULTS];
  TRY(ask_doubts_results(printing->store, OUTCOME_DEFAULT ",beta", all, error));
  TRY(ask_doubts(printing->store, &choice, OUTCOME_NAME(mean_fragment_mass), &doubts.masses, error));
  TRY(ask_doubts(printing->store, &choice, all, &doubts.all, error));
  TRY(point_read(printing->store, row->point_id, row->results_version, &point, error));
  const status code = point_estimates(&point, 0.95, fits, error);
  point_release(&point);
  TRY(code);
  for (int window = 0; window < ESTIMATES_WINDOWS; window++) {
    if (printing->format != TABLE_TEXT)
      TRY(row_for_programs(printing, row, window, fits, &doubts, error));
    else if (window == 0 ||
             (!printing->left_out[LIKELIHOOD] && fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n > 0))
      TRY(row_for_people(printing, row, window, fits, &doubts, error)); /* people do not need an empty row */
  }
  return STATUS_OK;
}

static const char *const estimates_legend =
    "runs: those that count; 19/20: one of 20 failed. M_1/M: mass share of the largest fragment. !: in doubt.\n"
    "\xc2\xb1: half width of the 95 % interval over seeds; one run has none. ~: weak, too few runs for runs like "
    "these\n"
    "(`clast explain weak`). 1.000\xe2\x89\xa5"
    "0.905: all runs are 1, and the mean is at least 0.905. \xc2\xb1res: how far "
    "finer\nsettings may move M_1/M, and beta ML (`clast converge` measures it, with -q beta; ?: not studied).\n"
    "beta: exponent of F(m) ~ m^-beta (differential), of all runs of a point together. LSQ: least squares on\n"
    "logarithmic bins of one decade, as in the paper; it needs a fragment in every bin. ML: maximum\n"
    "likelihood, without the largest fragment of each run.\n"
    "window from_5: n fragments heavier than 4.5 mean grains (or particles), from_10: than 9.5, from_2: than 1.5.\n";

void print_estimates_legend(struct store *store) {
  fputs(estimates_legend, stderr);
  quantity_tell_resolution(store, OUTCOME_DEFAULT, "");
  quantity_tell_resolution(store, "beta", "");
}

status print_estimates(struct store *store, const struct ask_points_choice *choice, enum table_format format, FILE *out,
                       struct error *error) {
  struct printing printing = {.store = store, .format = format};
  TRY(ask_columns_axes(store, format == TABLE_TEXT, LIMITS_AXES_OF_POOL, printing.axis, &printing.axes, error));
  TRY(ask_resolution_of_exponents(store, &printing.studied, error));
  const char *inputs[LIMITS_AXES_OF_POOL];
  for (size_t i = 0; i < printing.axes; i++)
    inputs[i] = printing.axis[i].name;

  TABLE table = table_new(format, out);
  printing.table = table;
  if (format == TABLE_TEXT)
    columns_for_people(&printing);
  else
    columns_for_programs(&printing);
  ANSWER points = ask_points_rows(store, choice, true, printing.axes, inputs, error);
  for (struct ask_points_row row; !table_broken(table) && ask_points_next(&points, &row);)
    TRY(print_point(&printing, &row, error));
  TRY(answer_end(&points));
  TRY(table_end(table, error));
  tell_left_out(&printing);
  if (format != TABLE_TEXT)
    return STATUS_OK;
  const struct ask_doubts_choice doubts = {.campaign = choice->campaign, .point = choice->point};
  return quantity_tell_doubts(store, &doubts, OUTCOME_DEFAULT ",beta", error);
}
