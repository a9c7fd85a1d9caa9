/* The table of estimates: for programs with a column for every number, for people with values and their intervals. */
#include <math.h>
#include <string.h>

#include "campaign/print/print.h"
#include "campaign/terminal/words.h"

/* What of the legend occurs in the table for people. */
struct seen {
  bool failed, single, interval, ends, weak, all_one, unknown, beta, same;
  char untold[400]; /* why exponents are not told */
  char open[200];   /* why those of several runs have no interval */
};

struct printing {
  struct seen seen;
  struct store *store;
  enum table_format format;
  struct table *table;
  bool studied; /* some exponent has a study; otherwise no point's study is read */
  size_t axes;
  struct ask_column axis[LIMITS_AXES_OF_POOL];
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
    static const char *const ends[] = {"", "_hw95", "_untold", "_resolution", "_resolution_verdict"};
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
  table_reals(table, 4, (const double[]){row->mean, row->half_width, row->low, row->high});
  table_integer(table, row->weak);
  table_real(table, row->resolution);
  table_text(table, ask_resolution_names[row->resolution_verdict]);
  table_text(table, estimates_window_names[window]);
  table_integer(table, fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n);
  for (int m = 0; m < METHODS; m++) {
    const struct pooled_exponent *fit = &fits[m * ESTIMATES_WINDOWS + window].exponent;
    struct ask_resolution resolution;
    TRY(read_resolution(printing, row, m, window, &resolution, error));
    const char *untold = pooled_exponent_untold(fit);
    table_reals(table, 2, (const double[]){fit->fit.beta, fit->interval.half_width});
    table_text(table, untold ? untold : "");
    table_real(table, resolution.half_width);
    table_text(table, ask_resolution_names[resolution.verdict]);
  }
  table_doubt_cells(table, &doubts->all);
  return STATUS_OK;
}

/* ---- for people: values with their intervals. The last columns are the least wanted. ---- */

static void columns_for_people(struct printing *printing) {
  struct table *table = printing->table;
  for (size_t i = 0; i < printing->axes; i++)
    table_key(table, &printing->axis[i]);
  table_columns(table, (const char *const[]){"point_id", "runs", "M_1/M", "\xc2\xb1res M_1/M", "window", "n", "beta ML",
                                             "beta ML_hw95", "beta ML_weak", "\xc2\xb1res beta", "beta LSQ",
                                             "beta LSQ_hw95", "beta LSQ_weak", NULL});
}

/* "0.928 ± 0.009", "0.928 ± 0.009~" when the interval is weak, "1.000 ≥ 0.905" when all runs are equal. */
static void mean_cell(struct printing *printing, const struct ask_points_row *row) {
  struct table *table = printing->table;
  struct seen *seen = &printing->seen;
  char text[UNCERTAINTY_TEXT + 4] = "";
  if (isnan(row->mean)) {
    table_missing(table);
    return;
  }
  const struct sample_range share = {0, 1, true};
  if (uncertainty_all_one(row->mean, row->half_width, row->low, &share, text))
    seen->all_one = true;
  else
    uncertainty_cell(row->mean, row->half_width, &share, text);
  seen->ends |= strchr(text, '(') != NULL;
  seen->interval |= strstr(text, "\xc2\xb1") != NULL;
  seen->single |= row->n == 1;
  seen->weak |= row->weak;
  if (row->weak)
    text_append(text, sizeof text, "~");
  table_text(table, text);
}

static void resolution_cell(struct printing *printing, enum ask_resolution_verdict verdict, double half_width) {
  char text[UNCERTAINTY_TEXT];
  printing->seen.unknown |= verdict == ASK_RESOLUTION_NOT_STUDIED;
  if (verdict == ASK_RESOLUTION_NOT_STUDIED)
    snprintf(text, sizeof text, "?");
  else
    uncertainty_resolution_cell(verdict, half_width, text);
  table_text(printing->table, text);
}

static status row_for_people(struct printing *printing, const struct ask_points_row *row, int window,
                             const struct point_estimate *fits, const struct doubts *doubts, struct error *error) {
  struct table *table = printing->table;
  const bool first = window == 0; /* only the point's first row shows its inputs and runs */
  if (first) {
    char runs[64] = "";
    for (size_t i = 0; i < printing->axes; i++)
      table_value(table, &row->inputs[i]);
    table_integer(table, row->point_id);
    text_append(runs, sizeof runs, "%lld", (long long)row->n);
    printing->seen.failed |= row->failed > 0;
    if (row->failed)
      text_append(runs, sizeof runs, "/%.0f", (double)row->n + (double)row->failed); /* a sum that cannot overflow */
    table_text(table, runs);
    table_rests_on(table, &row->doubts);
    mean_cell(printing, row);
    resolution_cell(printing, row->resolution_verdict, row->resolution);
  }
  for (size_t i = 0; !first && i < printing->axes + 4; i++)
    table_text(table, "");
  table_text(table, estimates_window_names[window]);
  table_integer(table, fits[MASSES * ESTIMATES_WINDOWS + window].exponent.fit.n);
  for (int m = METHODS; m-- > 0;) {
    const struct pooled_exponent *fit = &fits[m * ESTIMATES_WINDOWS + window].exponent;
    table_rests_on(table, &doubts->masses);
    const char *untold = pooled_exponent_untold(fit);
    const bool tells = !untold, has = isfinite(fit->interval.half_width);
    const bool weak = tells && !has && row->n > 1;
    printing->seen.beta |= tells;
    const char *open = weak ? pooled_exponent_no_interval(fit) : NULL;
    if (open && !strstr(printing->seen.open, open))
      text_append(printing->seen.open, sizeof printing->seen.open, "%s%s", *printing->seen.open ? ", or " : "", open);
    pooled_exponent_tell(untold, printing->seen.untold, sizeof printing->seen.untold);
    table_fixed(table, tells ? fit->fit.beta : (double)NAN, pooled_exponent_decimals(fit));
    table_real(table, fit->interval.half_width);
    table_integer(table, weak);
    if (m != MASSES)
      continue;
    struct ask_resolution resolution;
    TRY(read_resolution(printing, row, MASSES, window, &resolution, error));
    resolution_cell(printing, resolution.verdict, resolution.half_width);
  }
  return STATUS_OK;
}

static status print_point(struct printing *printing, const struct ask_points_row *row, struct error *error) {
  struct point_estimate fits[POINT_ESTIMATES];
  __attribute__((cleanup(point_release))) struct point_data point = {0};
  struct doubts doubts = {0};
  const struct ask_doubts_choice choice = {.point = row->point_id};
  char all[ASK_DOUBTS_RESULTS];
  TRY(ask_doubts_results(printing->store, OUTCOME_DEFAULT ",beta", all, error));
  TRY(ask_doubts(printing->store, &choice, OUTCOME_NAME(mean_fragment_mass), &doubts.masses, error));
  TRY(ask_doubts(printing->store, &choice, all, &doubts.all, error));
  TRY(point_read(printing->store, row->point_id, row->results_version, &point, error));
  TRY(point_estimates(&point, 0.95, fits, error));
  const struct point_estimate *masses = &fits[MASSES * ESTIMATES_WINDOWS];
  struct ask_points_row shown = *row;
  if (point.runs.first[point.runs.count] == 0) /* a program tells no fragments: the store has 0 */
    shown.mean = NAN;
  for (int window = 0; window < ESTIMATES_WINDOWS; window++) {
    const bool same = window &&
                      fabs(masses[window].exponent.fit.lower / masses[window - 1].exponent.fit.lower - 1) < 1e-9;
    if (!table_for_people(printing->format))
      TRY(row_for_programs(printing, row, window, fits, &doubts, error));
    else if (window == 0 || (masses[window].exponent.fit.n > 0 && !same))
      TRY(row_for_people(printing, &shown, window, fits, &doubts, error)); /* people do not need an empty row */
    printing->seen.same |= same && masses[window].exponent.fit.n > 0;
  }
  return STATUS_OK;
}

/* What occurs in the table. */
static void print_legend(const struct printing *printing, FILE *out) {
  const struct seen *seen = &printing->seen;
  char text[1024] = "M_1/M: mass share of the largest fragment";
  if (seen->interval)
    text_append(text, sizeof text, ", \xc2\xb1 half width of its 95 %% interval over seeds");
  if (seen->ends)
    text_append(text, sizeof text, "; (a to b): the ends of the interval, where it reaches 0 or 1");
  if (seen->weak)
    text_append(text, sizeof text, "; ~: weak, too few runs");
  if (seen->all_one)
    text_append(text, sizeof text, "; %s", UNCERTAINTY_ALL_ONE);
  if (seen->single)
    text_append(text, sizeof text, "; one run has no interval");
  text_append(text, sizeof text, ". \xc2\xb1res: how far finer settings may move the number before it%s",
              seen->unknown ? " (?: not studied)" : "");
  if (seen->failed)
    text_append(text, sizeof text, ". runs 19/20: one of 20 gave no result");
  if (seen->beta)
    text_append(text, sizeof text,
                ". beta: exponent of F(m) ~ m^-beta, of the n fragments that all runs of a point have in the window, "
                "without the largest of each run (ML). "
                "`clast explain WORD` tells of beta, ML, LSQ, window%s",
                seen->weak || *seen->open ? ", weak" : "");
  if (*seen->open)
    text_append(text, sizeof text, ". beta with ~: no interval, since %s", seen->open);
  if (*seen->untold)
    text_append(text, sizeof text, ". beta -: %s", seen->untold);
  if (seen->same)
    text_append(text, sizeof text,
                ". Windows that begin at the same mass, where the spectrum is complete, have one row: the first");
  words_print(out, "", "%s.", text);
  char main[ASK_GROUP_NAME], by[600] = "", word[TEXT_WORD];
  const char *quantity = NULL;
  if (ask_quantity_main(printing->store, main, &quantity, NULL) == STATUS_OK && strcmp(main, OUTCOME_DEFAULT) != 0) {
    for (size_t i = 0; i < printing->axes; i++)
      text_append(by, sizeof by, "%s%s", i ? "," : " --by ", printing->axis[i].name);
    fprintf(out, "clast: the main quantity of the campaign, %s, is no column here: `clast stats %s%s` has it\n", main,
            text_word(store_path(printing->store), word), by);
    quantity_tell_resolution(printing->store, main, NULL);
  }
  quantity_tell_resolution(printing->store, OUTCOME_DEFAULT, NULL);
  if (seen->beta)
    quantity_tell_resolution(printing->store, "beta", NULL);
}

/* The varied inputs, for programs in SI units; also the scene, where the store has several. */
static status read_axes(struct printing *printing, struct error *error) {
  struct ask_column written[LIMITS_AXES_OF_POOL];
  size_t count = 0;
  const bool people = table_for_people(printing->format);
  TRY(ask_columns_axes(printing->store, people, LIMITS_AXES_OF_POOL, printing->axis, &printing->axes, error));
  if (!people)
    TRY(ask_columns_axes(printing->store, true, LIMITS_AXES_OF_POOL, written, &count, error));
  for (size_t i = 0; i < count && printing->axes < LIMITS_AXES_OF_POOL; i++)
    if (strcmp(written[i].name, "scene") == 0)
      printing->axis[printing->axes++] = written[i];
  return STATUS_OK;
}

status print_estimates(struct store *store, enum table_format format, bool legend, struct error *error) {
  struct printing printing = {.store = store, .format = format};
  TRY(read_axes(&printing, error));
  TRY(ask_resolution_of_exponents(store, &printing.studied, error));
  const char *inputs[LIMITS_AXES_OF_POOL];
  for (size_t i = 0; i < printing.axes; i++)
    inputs[i] = printing.axis[i].name;

  TABLE table = table_new(format, stdout);
  printing.table = table;
  if (table_for_people(format))
    columns_for_people(&printing);
  else
    columns_for_programs(&printing);
  ANSWER points = ask_points_rows(store, true, printing.axes, inputs, error);
  size_t idle = 0; /* points without runs, such as finer settings that only a study knows */
  for (struct ask_points_row row; !table_broken(table) && ask_points_next(&points, &row);) {
    if (table_for_people(format) && row.n == 0 && row.failed == 0)
      idle++;
    else
      TRY(print_point(&printing, &row, error));
  }
  TRY(answer_end(&points));
  TRY(table_end(table, error));
  if (!table_for_people(format))
    return STATUS_OK;
  fflush(stdout); /* what follows comes below the table */
  if (idle && legend)
    fprintf(stderr,
            "clast: left out: %zu point%s without runs: not yet computed, or settings of a study that it did "
            "not run, since the law of the others tells them (--csv and --json have %s)\n",
            idle, idle == 1 ? "" : "s", idle == 1 ? "it" : "them");
  TRY(quantity_tell_doubts(store, OUTCOME_DEFAULT ",beta", error));
  if (legend)
    print_legend(&printing, stderr);
  return STATUS_OK;
}
