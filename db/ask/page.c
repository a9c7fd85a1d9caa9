/* The small file of a page: tables that are copied from the store, statistics of points, facts, labels, pictures. */
#include "db/ask/ask.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/sql.h"
#include "db/store/internal.h"
#include "db/store/views.h"
#include "engine/grow.h"
#include "schemas/memory.h"

static const char doing[] = "making the page";

/* Upper limits of a page, so that it stays below 3 MB with 10 000 runs. */
enum {
  RUNS = ASK_PAGE_RUNS, /* single runs */
  VALUES = 120000,      /* results of single runs */
  MEANS = 40000,        /* rows of the table means */
  SPECTRUM = 12000,     /* rows of the table spectra */
  QUANTILES = 200,      /* points with quantiles */
  JUDGED_RUNS = 100000, /* runs of a point in the test for two modes: the first ones */
  ATTEMPTS = 500,       /* failed attempts, and failed runs */
};

struct ask_page {
  struct store store; /* only a database in memory, for answers */
};

/* Tables that are copied, and the first column from which on numbers are rounded. */
static const struct {
  const char *name, *sql;
} tables[] = {
    {"campaign", "SELECT campaign_id, name, document, added_at FROM campaign ORDER BY campaign_id"},
    {"session", "SELECT * FROM session ORDER BY session_id DESC LIMIT 20"},
    {"resolution", "SELECT * FROM resolution"},
    {"axis", "SELECT * FROM axis ORDER BY path"},
    {"campaign_point", "SELECT campaign_id, point_id FROM campaign_point"},
    {"column_doc", "SELECT table_name, column_name, unit, meaning FROM column_doc WHERE table_name IN ('runs', "
                   "'points', 'spectra', 'estimates') ORDER BY table_name, column_name"},
    {"estimates", "SELECT * FROM estimates WHERE run_id IS NULL AND (headline OR (SELECT count(*) FROM point) <= 200) "
                  "ORDER BY point_id, ordinal"},
};

/* To single precision, if it has the number. */
static double single(double number) {
  const double size = fabs(number);
  return size < (double)FLT_MIN || size > (double)FLT_MAX ? number : (double)(float)number;
}

/* Prepares the insert of a row of so many values. */
static status prepare_row(struct ask_page *page, const char *table, size_t count, sqlite3_stmt **insert,
                          struct error *error) {
  sqlite3_str *marks = sqlite3_str_new(NULL);
  for (size_t i = 0; i < count; i++)
    sqlite3_str_appendall(marks, i ? ", ?" : "?");
  return sql_preparef(page->store.db, insert, doing, error, "INSERT INTO \"%w\" VALUES (%z)", table,
                      sqlite3_str_finish(marks));
}

/* ADD_ROW(page, error, "table", values...) adds a row to a table. */
#define ADD_ROW(page, error, table, ...)                                                                               \
  add_row(page, error, table, sizeof((const struct sql_value[]){__VA_ARGS__}) / sizeof(struct sql_value),              \
          (const struct sql_value[]){__VA_ARGS__})
static status add_row(struct ask_page *page, struct error *error, const char *table, size_t count,
                      const struct sql_value *values) {
  STATEMENT insert = NULL;
  TRY(prepare_row(page, table, count, &insert, error));
  sql_bind_all(insert, count, values);
  return sql_run(insert, doing, error);
}

/* Makes a table of the rows of an answer. Real numbers from column `rounded` (counted from 0) on are rounded to single
 * precision: 7 digits, and they compress well. */
enum { EXACT = 1000 }; /* no column is rounded */
static status copy(struct ask_page *page, struct answer asked, const char *table, size_t rounded) {
  ANSWER answer = asked;
  STATEMENT insert = NULL;
  const size_t count = answer_count(&answer);
  TRY(answer_status(&answer));
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < count; i++)
    sqlite3_str_appendf(columns, "%s\"%w\"", i ? ", " : "", answer_name(&answer, i));
  TRY(sql_executef(page->store.db, doing, answer.error, "CREATE TABLE \"%w\" (%z)", table,
                   sqlite3_str_finish(columns)));
  TRY(prepare_row(page, table, count, &insert, answer.error));
  while (answer_next(&answer)) {
    for (size_t i = 0; i < count; i++) {
      struct sql_value value = sql_of_column(answer.statement, (int)i);
      if (i >= rounded)
        value.real = single(value.real);
      sql_bind(insert, (int)i + 1, value);
    }
    TRY(sql_run(insert, doing, answer.error));
  }
  return answer_end(&answer);
}

static status set_fact(struct ask_page *page, const char *name, size_t value, struct error *error) {
  char text[32];
  snprintf(text, sizeof text, "%zu", value);
  return ask_page_fact(page, name, text, error);
}

/* Spectra of points, newest version only: of all points, or of every n-th point when there are more rows than the
 * limit. */
static status copy_spectra(struct ask_page *page, struct store *store, struct error *error) {
  double rows = 0;
  TRY(answer_number(store, &rows, error, "SELECT count(*) FROM point_spectrum"));
  const int every = (int)(rows / SPECTRUM) + 1;
  TRY(copy(page,
           answer_to(
               store, error,
               "SELECT point_id, results_version, n, bin, lower, upper, runs, count, count_mean, count_sd, count_hw95, "
               "density FROM spectra WHERE point_id %% %d = %d ORDER BY point_id, results_version, bin",
               every, every > 1 ? 1 : 0),
           "spectra", 8));
  return set_fact(page, "spectra_of_every_nth_point", (size_t)every, error);
}

/* ---- results whose runs have two modes at a point, by the rule of `clast scatter` ---- */

struct modes {
  size_t n;     /* values of the previous sample */
  double limit; /* dip above which a sample of that size has two modes */
};

/* One result of the counted runs of a point; sorts the values. */
static status add_modes(struct ask_page *page, struct modes *modes, int64_t point, const char *quantity, size_t n,
                        double *values, struct error *error) {
  struct scatter s = {.n = n, .sorted = values};
  if (n < SCATTER_SHAPE_RUNS)
    return STATUS_OK;
  qsort(values, n, sizeof *values, sample_ascending);
  if (!(values[n - 1] > values[0]) || scatter_in_steps(n, values))
    return STATUS_OK;
  if (n != modes->n) {
    modes->n = n;
    modes->limit = scatter_dip_limit(n);
  }
  if (!(scatter_dip(n, values) > modes->limit))
    return STATUS_OK;
  scatter_find_modes(&s);
  return ADD_ROW(page, error, "modes", sql_of_integer(point), sql_of_text(quantity), sql_of_real(s.lower_mode),
                 sql_of_real(s.upper_mode), sql_of_real(s.between), sql_of_real(s.upper_share),
                 sql_of_real(s.upper_low), sql_of_real(s.upper_high));
}

/* ---- the runs of a page, thinned, and the statistics of all of their results ---- */

enum { COLUMNS = 256, NAME = 128 };

struct column {
  char name[NAME];
  bool main;  /* of the view points */
  bool asked; /* the quantity of a campaign, by its document or its scene */
  struct sample_range range;
  bool number; /* has a value */
  double least, most;
  struct sample_moments moments; /* of the current point */
  double *values;                /* of the current point; owned */
  size_t values_count, values_room;
};

struct reading {
  struct ask_page *page;
  struct modes modes;
  size_t count;
  struct column column[COLUMNS];
  bool begun;
  int64_t point_id, results_version; /* the current ones */
  size_t runs;                       /* of the current point that count */
};

static bool varies(const struct column *column) {
  return column->most > column->least;
}

/* Results with the same value in all runs are left out. */
static bool is_told(const struct column *column) {
  return column->asked || varies(column);
}

static bool is_main(const char *name) {
  const char *names[VIEWS_STATISTICS_MAIN];
  const size_t count = views_statistics_main(names);
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i], name) == 0)
      return true;
  return false;
}

static struct sample_summary summary_of(const struct column *column) {
  struct sample_summary summary = sample_summarise_moments(&column->moments, 0.95);
  sample_in_range(&summary, &column->range, 0.95);
  return summary;
}

static struct sql_value rounded(double number) { /* NaN is NULL */
  return sql_of_real(single(number));
}

static status add_mean(struct reading *reading, const struct column *column, struct error *error) {
  const struct sample_summary summary = summary_of(column);
  return ADD_ROW(reading->page, error, "means", sql_of_integer(reading->point_id),
                 sql_of_integer(reading->results_version), sql_of_text(column->name),
                 sql_of_integer((int64_t)summary.n), rounded(summary.mean), rounded(summary.standard_deviation),
                 rounded(summary.half_width));
}

/* The view points has raw values: the mean of a main result leaves out those that are withheld. */
static status correct_point(struct reading *reading, const struct column *column, struct error *error) {
  STATEMENT update = NULL;
  const struct sample_summary of = summary_of(column);
  TRY(sql_preparef(
      reading->page->store.db, &update, doing, error,
      "UPDATE points SET \"%w_mean\" = ?1, \"%w_sd\" = ?2, \"%w_se\" = ?3, \"%w_hw95\" = ?4, \"%w_low95\" = "
      "?5, \"%w_high95\" = ?6 WHERE point_id = %lld AND results_version = %lld",
      column->name, column->name, column->name, column->name, column->name, column->name, (long long)reading->point_id,
      (long long)reading->results_version));
  SQL_BIND(update, rounded(of.mean), rounded(of.standard_deviation), rounded(of.standard_error), rounded(of.half_width),
           rounded(of.low), rounded(of.high));
  return sql_run(update, doing, error);
}

/* Writes the statistics of the current point: means of the results that the view points lacks, and modes of all
 * results. `newest`: the point has no newer version of results. */
static status end_point(struct reading *reading, bool newest, struct error *error) {
  for (size_t i = 0; reading->begun && i < reading->count; i++) {
    struct column *column = &reading->column[i];
    if (column->moments.n > 0 && !column->main)
      TRY(add_mean(reading, column, error));
    else if (column->main && column->moments.n < reading->runs)
      TRY(correct_point(reading, column, error));
    if (newest)
      TRY(add_modes(reading->page, &reading->modes, reading->point_id, column->name, column->values_count,
                    column->values, error));
    column->moments = (struct sample_moments){.n = 0};
    column->values_count = 0;
  }
  return STATUS_OK;
}

static status add_value(struct column *column, double value, struct error *error) {
  column->least = column->number ? fmin(column->least, value) : value;
  column->most = column->number ? fmax(column->most, value) : value;
  column->number = true;
  sample_add(&column->moments, value);
  if (column->values_count == JUDGED_RUNS)
    return STATUS_OK;
  TRY(grow_or_fail(&column->values, &column->values_room, column->values_count + 1, sizeof *column->values, "the page",
                   error));
  column->values[column->values_count++] = value;
  return STATUS_OK;
}

static status add_run(struct reading *reading, const struct answer *run, struct error *error) {
  const int64_t point = answer_integer(run, 0), version = answer_integer(run, 1);
  if (!reading->begun || point != reading->point_id || version != reading->results_version) {
    TRY(end_point(reading, point != reading->point_id, error));
    reading->begun = true;
    reading->runs = 0;
    reading->point_id = point;
    reading->results_version = version;
  }
  reading->runs++;
  for (size_t i = 0; i < reading->count; i++) {
    const double value = answer_real(run, 2 + i);
    if (isfinite(value))
      TRY(add_value(&reading->column[i], value, error));
  }
  return STATUS_OK;
}

/* One pass over all runs that count, point by point, in a fixed order of the runs. */
static status read_results(struct reading *reading, struct store *store, struct error *error) {
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < reading->count; i++)
    sqlite3_str_appendf(columns, ", \"%w\"", reading->column[i].name);
  ANSWER
  runs = answer_to(store, error,
                   "SELECT point_id, results_version%z FROM runs WHERE counts ORDER BY point_id, results_version, "
                   "replicate, seed",
                   sqlite3_str_finish(columns));
  while (answer_next(&runs))
    TRY(add_run(reading, &runs, error));
  TRY(answer_end(&runs));
  return end_point(reading, true, error);
}

/* The numbers of particles or grains of the runs, for the head of the page. */
static status tell_elements(struct reading *reading, struct error *error) {
  char text[128] = "";
  for (size_t i = 0; i < reading->count; i++) {
    const struct column *column = &reading->column[i];
    if (!(column->most > 0) || (strcmp(column->name, "particles") != 0 && strcmp(column->name, "grains") != 0))
      continue;
    text_append(text, sizeof text, "%s%.0f", *text ? ", " : "", column->least);
    if (varies(column))
      text_append(text, sizeof text, " to %.0f", column->most);
    text_append(text, sizeof text, " %s", column->name);
  }
  return ask_page_fact(reading->page, "elements", text, error);
}

/* The spectrum draws masses below it as incomplete. */
static bool spectrum_needs(const char *name) {
  return strcmp(name, OUTCOME_NAME(complete_mass)) == 0;
}

/* Removes results with the same value everywhere, and the last rows beyond the limit. */
static status thin_means(struct reading *reading, struct error *error) {
  sqlite3 *db = reading->page->store.db;
  TRY(tell_elements(reading, error));
  int64_t rows = 0, points = 0;
  for (size_t i = 0; i < reading->count; i++)
    if (reading->column[i].number && !is_told(&reading->column[i]) && !spectrum_needs(reading->column[i].name))
      TRY(sql_executef(db, doing, error, "DELETE FROM means WHERE quantity = %Q", reading->column[i].name));
  TRY(sql_integer(db, "SELECT count(*) FROM means", 0, &rows, error));
  TRY(sql_integer(db, "SELECT count(DISTINCT point_id) FROM means", 0, &points, error));
  for (size_t i = reading->count; rows > MEANS && i-- > 0;) {
    if (reading->column[i].main || reading->column[i].asked || !varies(&reading->column[i]) ||
        spectrum_needs(reading->column[i].name))
      continue;
    TRY(sql_executef(db, doing, error, "DELETE FROM means WHERE quantity = %Q", reading->column[i].name));
    rows -= points;
  }
  return STATUS_OK;
}

/* Chooses the runs to keep within the limit: the first `replicates` of every point or, with more points than the limit,
 * of every n-th point. */
static status choose_room(struct store *store, int *replicates, int *every, struct error *error) {
  double points = 0, kept = 0, runs = 0;
  TRY(answer_number(store, &points, error, "SELECT count(*) FROM point_total"));
  TRY(answer_number(store, &runs, error, "SELECT max(runs + failed) FROM point_total"));
  *every = (int)(points / RUNS) + 1;
  int low = 1, high = isfinite(runs) && runs > 1 ? (int)runs : 1; /* invariant: `low` fits, or is 1 */
  while (low < high) {
    const int middle = low + (high - low + 1) / 2;
    TRY(answer_number(store, &kept, error, "SELECT sum(min(runs + failed, %d)) FROM point_total", middle));
    if (kept / *every <= RUNS)
      low = middle;
    else
      high = middle - 1;
  }
  *replicates = low;
  return STATUS_OK;
}

/* Results of single runs: the main ones, then the others in their order, up to the limit. */
static void write_results(const struct reading *reading, double runs, sqlite3_str *sql, size_t *left_out) {
  size_t room = runs > 0 ? (size_t)(VALUES / runs) : COLUMNS;
  for (int main = 1; main >= 0; main--)
    for (size_t i = 0; i < reading->count; i++) {
      const struct column *column = &reading->column[i];
      if (column->main != main || (!main && !is_told(column)))
        continue;
      if (!main && room == 0) {
        ++*left_out;
        continue;
      }
      sqlite3_str_appendf(sql, ", \"%w\"", column->name);
      room -= room > 0;
    }
}

static status copy_runs(struct reading *reading, struct store *store, struct error *error) {
  int replicates = 1, every = 1;
  double all = 0, of_studies = 0;
  struct ask_column axes[COLUMNS];
  size_t axis_count = 0, left_out = 0;
  TRY(choose_room(store, &replicates, &every, error));
  TRY(answer_number(store, &all, error, "SELECT sum(runs + failed) FROM point_total"));
  TRY(answer_number(store, &of_studies, error, "%s",
                    "SELECT count(*) FROM main.run AS p WHERE " POINT_IS_OF_STUDY("main.")));
  TRY(ask_columns_axes(store, false, COLUMNS, axes, &axis_count, error));
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < axis_count; i++)
    sqlite3_str_appendf(columns, ", \"%w\"", axes[i].name);
  write_results(reading, fmin(all, RUNS), columns, &left_out);
  TRY(copy(
      reading->page,
      answer_to(store, error,
                "SELECT run_id, point_id, replicate, seed, results_version, counts, surplus, state, engine, scene, "
                "message, warnings, doubtful, session_id, host, attempt%z FROM runs WHERE run_id IN (SELECT run_id "
                "FROM (SELECT "
                "run_id, "
                "row_number() OVER (PARTITION BY point_id, results_version ORDER BY replicate, seed) AS place FROM run "
                "WHERE surplus = 0 AND point_id %% %d = %d) WHERE place <= %d) ORDER BY point_id, results_version, "
                "replicate, seed",
                sqlite3_str_finish(columns), every, every > 1 ? 1 : 0, replicates),
      "runs", 16 + axis_count));
  TRY(set_fact(reading->page, "runs", (size_t)all, error));
  TRY(set_fact(reading->page, "points_of_studies", (size_t)ask_choice_left_out(store), error));
  TRY(set_fact(reading->page, "runs_of_studies", (size_t)of_studies, error));
  TRY(set_fact(reading->page, "results_left_out", left_out, error));
  TRY(set_fact(reading->page, "modes_runs", SCATTER_SHAPE_RUNS, error));
  TRY(set_fact(reading->page, "replicates_kept", (size_t)replicates, error));
  return set_fact(reading->page, "runs_of_every_nth_point", (size_t)every, error);
}

/* ---- which runs are in doubt, and about what (engine/condition.h) ---- */

/* What the words of an engine's runs say of a result. */
static status add_mark(struct reading *reading, const struct answer *words, const char *quantity, const char *results,
                       struct error *error) {
  return sql_executef(
      reading->page->store.db, doing, error,
      "INSERT INTO doubt_mark SELECT engine, words, %Q, doubts(engine, words, %Q) AS marks, withheld(engine, "
      "words, %Q) FROM (SELECT %Q AS engine, %Q AS words) WHERE marks IS NOT NULL",
      quantity, results, results, answer_text(words, 0), answer_text(words, 1));
}

static status add_sentences(struct reading *reading, struct error *error) {
  for (size_t e = 0; e < engine_count(); e++)
    for (const struct condition *c = engine_at(e)->conditions; c && c->word; c++) {
      char says[CONDITION_SAYS];
      OWNED char *text = NULL;
      if (asprintf(&text, "%s: %s; %s", condition_says(c, says), c->doubt, c->remedy) < 0)
        memory_refused();
      TRY(ADD_ROW(reading->page, error, "doubt_word", sql_of_text(engine_at(e)->name), sql_of_text(c->word),
                  sql_of_text(text), sql_of_text(c->results), sql_of_integer(c->withheld)));
    }
  return STATUS_OK;
}

static status add_doubts(struct reading *reading, struct store *store, struct error *error) {
  TRY(ask_register_functions(&reading->page->store, error));
  TRY(copy(
      reading->page,
      answer_to(store, error,
                "SELECT point_id, engine, warnings AS words, count(*) AS runs FROM runs WHERE counts AND warnings <> "
                "'' AND results_version = (SELECT max(results_version) FROM point_total t WHERE t.point_id = "
                "runs.point_id AND t.runs > 0) GROUP BY point_id, engine, warnings"),
      "doubt", EXACT));
  ANSWER words = answer_to(&reading->page->store, error,
                           "SELECT DISTINCT engine, words FROM doubt ORDER BY engine, words");
  while (answer_next(&words)) {
    for (size_t i = 0; i < reading->count; i++)
      TRY(add_mark(reading, &words, reading->column[i].name, reading->column[i].name, error));
    TRY(add_mark(reading, &words, "beta", OUTCOME_NAME(mean_fragment_mass), error));
  }
  TRY(answer_end(&words));
  return add_sentences(reading, error);
}

static status find_asked(struct reading *reading, struct store *store, struct error *error) {
  char name[ASK_GROUP_NAME];
  ANSWER names = answer_to(store, error, "SELECT DISTINCT plan ->> '$.quantity' FROM campaign WHERE json_valid(plan)");
  while (answer_next(&names))
    if (ask_group_quantity(store, answer_text(&names, 0), name, NULL) == STATUS_OK)
      for (size_t i = 0; i < reading->count; i++)
        reading->column[i].asked |= strcmp(reading->column[i].name, name) == 0;
  return answer_end(&names);
}

static status fill_runs(struct reading *reading, struct store *store, struct error *error) {
  TRY(ask_register_functions(store, error));
  ANSWER names = ask_group_quantities(store, error);
  while (reading->count < COLUMNS && answer_next(&names)) {
    struct column *column = &reading->column[reading->count++];
    snprintf(column->name, NAME, "%s", answer_text(&names, 0));
    column->main = is_main(column->name);
    column->range = views_range(column->name);
  }
  TRY(answer_end(&names));
  TRY(find_asked(reading, store, error));
  TRY(read_results(reading, store, error));
  TRY(thin_means(reading, error));
  TRY(add_doubts(reading, store, error));
  return copy_runs(reading, store, error);
}

/* Fills in `runs`, `means`, `modes` and the tables of doubts. */
static status add_runs(struct ask_page *page, struct store *store, struct error *error) {
  struct reading *reading = memory_small(1, sizeof *reading);
  reading->page = page;
  reading->modes.limit = NAN;
  const status code = fill_runs(reading, store, error);
  for (size_t i = 0; i < reading->count; i++)
    free(reading->column[i].values);
  free(reading);
  return code;
}

/* ---- quantiles of the first main result, the mass share of the largest fragment, at every point, as `clast scatter`
 * gives them; other results and further points are left out to keep the page small ---- */

static status add_quantiles(struct ask_page *page, struct store *store, struct error *error) {
  double points = 0;
  TRY(sql_execute(page->store.db, "CREATE TABLE quantile (point_id, quantity, share, value, low, high)", doing, error));
  TRY(answer_number(store, &points, error, "SELECT count(*) FROM point"));
  if (points > QUANTILES)
    return STATUS_OK;
  ASK_POOLS pools = ask_pools(store, &(struct ask_pool_choice){0}, OUTCOME_DEFAULT, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    SCATTER scatter = {0};
    TRY(scatter_make(pool->data.runs.count, pool->value, &scatter, error));
    for (size_t i = 0; scatter.n > 1 && i < SCATTER_QUANTILES; i++) {
      const struct scatter_quantile *quantile = &scatter.quantile[i];
      TRY(ADD_ROW(page, error, "quantile", sql_of_integer(pool->point[0]), sql_of_text(OUTCOME_DEFAULT),
                  sql_of_real(scatter_shares[i]), sql_of_real(quantile->value), sql_of_real(quantile->low),
                  sql_of_real(quantile->high)));
    }
  }
  return ask_pools_end(&pools);
}

/* The canned queries that the page's tables can answer. */
static status add_questions(struct ask_page *page, struct error *error) {
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *query = ask_canned_at(i);
    STATEMENT trial = NULL;
    if (sqlite3_prepare_v2(page->store.db, query->sql, -1, &trial, NULL) != SQLITE_OK)
      continue;
    TRY(ADD_ROW(page, error, "question", sql_of_text(query->name), sql_of_text(query->doc), sql_of_text(query->sql),
                sql_of_text(query->parameters)));
  }
  return STATUS_OK;
}

static status fill(struct ask_page *page, struct store *store, struct error *error) {
  double axes = 0;
  TRY(sql_execute(page->store.db,
                  "PRAGMA page_size = 4096;"
                  "CREATE TABLE fact (name TEXT PRIMARY KEY, value) WITHOUT ROWID;"
                  "CREATE TABLE label (column_name TEXT PRIMARY KEY, label, unit, factor, share, least, most) "
                  "WITHOUT ROWID;"
                  "CREATE TABLE question (name, doc, sql, parameters);"
                  "CREATE TABLE picture (run_id, point_id, quantile, png);"
                  "CREATE TABLE difference (quantity, first_point, point_id, pairs, difference, hw95);"
                  "BEGIN",
                  doing, error));
  for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++)
    TRY(copy(page, answer_to(store, error, "%s", tables[i].sql), tables[i].name, EXACT));
  /* exact inputs, which come first in the view behind point_id, engine, scene, study; rounded statistics */
  TRY(answer_number(store, &axes, error, "SELECT count(*) FROM main.axis"));
  TRY(copy(page, answer_to(store, error, "SELECT * FROM points"), "points", 4 + (size_t)axes));
  TRY(copy_spectra(page, store, error));
  TRY(copy(
      page,
      answer_to(
          store, error,
          "SELECT point_id, replicate, seed, session_id, number, reason, exit_code, signal, wall_time, limited_to, "
          "message, host FROM attempt ORDER BY attempt_id DESC LIMIT %d",
          ATTEMPTS),
      "attempt", EXACT));
  TRY(sql_execute(page->store.db,
                  "CREATE TABLE means (point_id, results_version, quantity, n, mean, sd, hw95);"
                  "CREATE TABLE modes (point_id, quantity, lower_mode, upper_mode, between_modes, upper_share, "
                  "upper_low, upper_high);"
                  "CREATE TABLE doubt_mark (engine, words, quantity, marks, withheld);"
                  "CREATE TABLE doubt_word (engine, word, sentence, results, withheld)",
                  doing, error));
  TRY(add_runs(page, store, error));
  TRY(add_quantiles(page, store, error));
  /* a question to the store may have the table's name */
  TRY(sql_execute(page->store.db, "CREATE VIEW run AS SELECT * FROM runs", doing, error));
  return add_questions(page, error);
}

status ask_page_make(struct store *store, struct ask_page **out, struct error *error) {
  struct ask_page *page = *out = memory_small(1, sizeof *page);
  status code = sqlite3_open(":memory:", &page->store.db) == SQLITE_OK
                    ? sql_execute(store->db, "BEGIN", doing,
                                  error) /* one consistent state of a store that another process writes */
                    : status_fail(error, STATUS_MEMORY, "no memory for the page");
  if (code == STATUS_OK) {
    code = fill(page, store, error);
    sqlite3_exec(store->db, "COMMIT", NULL, NULL, NULL);
  }
  if (code) {
    ask_page_free(page);
    *out = NULL;
  }
  return code;
}

void ask_page_free(struct ask_page *page) {
  if (!page)
    return;
  sqlite3_close(page->store.db);
  free(page);
}

status ask_page_fact(struct ask_page *page, const char *name, const char *value, struct error *error) {
  return sql_executef(page->store.db, doing, error, "INSERT OR REPLACE INTO fact VALUES (%Q, %Q)", name, value);
}

status ask_page_label(struct ask_page *page, const char *column, const char *label, const char *unit, double factor,
                      struct error *error) {
  const struct sample_range range = views_range(column);
  return sql_executef(page->store.db, doing, error,
                      "INSERT OR REPLACE INTO label VALUES (%Q, %Q, %Q, %!.17g, %d, iif(%d, %!.17g, NULL), iif(%d, "
                      "%!.17g, NULL))",
                      column, label, unit, factor, (int)range.share, (int)isfinite(range.least),
                      isfinite(range.least) ? range.least : 0, (int)isfinite(range.most),
                      isfinite(range.most) ? range.most : 0);
}

status ask_page_fixed(struct ask_page *page, struct store *store, size_t count, const struct ask_column input[],
                      struct error *error) {
  sqlite3_str *names = sqlite3_str_new(NULL);
  for (size_t i = 0; i < count; i++)
    sqlite3_str_appendf(names, "%s%Q", i ? ", " : "", input[i].name);
  return copy(page,
              answer_to(store, error,
                        "SELECT * FROM main.axis WHERE path NOT IN (SELECT path FROM axis) AND column_name IN (%z)",
                        sqlite3_str_finish(names)),
              "fixed_axis", EXACT);
}

struct answer ask_page_columns(struct ask_page *page, struct error *error) {
  return answer_to(&page->store, error,
                   "SELECT column_name FROM axis UNION SELECT quantity FROM means UNION SELECT name FROM "
                   "pragma_table_info('runs') EXCEPT SELECT column_name FROM label");
}

struct answer ask_page_kept(struct store *store, struct error *error) {
  return answer_to(
      store, error,
      "WITH ranked AS (SELECT run_id, point_id, fields_path, row_number() OVER point - 1 AS place, count(*) OVER "
      "(PARTITION BY point_id) - 1 AS last, max(%s) OVER (PARTITION BY point_id) > min(%s) OVER (PARTITION BY point_id)"
      " AS differ FROM run WHERE counts AND results_version = (SELECT max(results_version) "
      "FROM run AS newest WHERE newest.point_id = run.point_id) WINDOW point AS (PARTITION BY point_id ORDER BY %s, "
      "run_id)) SELECT run_id, point_id, CASE WHEN differ IS 1 AND place IN (0, (last + 1) / 2, last) "
      "THEN 1.0 * place / last END AS quantile, fields_path FROM ranked WHERE typeof(fields_path) = 'text' "
      "ORDER BY quantile IS NULL, abs(quantile - 0.5) > 0.25, point_id, quantile, run_id",
      OUTCOME_DEFAULT, OUTCOME_DEFAULT, OUTCOME_DEFAULT);
}

status ask_page_picture(struct ask_page *page, const struct answer *kept, const void *png, size_t size,
                        struct error *error) {
  return ADD_ROW(page, error, "picture", sql_of_integer(answer_integer(kept, 0)),
                 sql_of_integer(answer_integer(kept, 1)), sql_of_real(answer_real(kept, 2)), sql_of_bytes(png, size));
}

status ask_page_difference(struct ask_page *page, const char *quantity, int64_t first_point, int64_t point,
                           const struct difference *difference, struct error *error) {
  return ADD_ROW(page, error, "difference", sql_of_text(quantity), sql_of_integer(first_point), sql_of_integer(point),
                 sql_of_integer((int64_t)difference->pairs), sql_of_real(difference->difference),
                 sql_of_real(difference->half_width));
}

status ask_page_file(struct ask_page *page, unsigned char **bytes, size_t *size, struct error *error) {
  sqlite3_int64 length = 0;
  *bytes = NULL;
  TRY(sql_execute(page->store.db, "COMMIT; VACUUM; BEGIN", doing, error));
  unsigned char *file = sqlite3_serialize(page->store.db, "main", &length, 0);
  if (file)
    *bytes = malloc((size_t)length);
  if (*bytes)
    memcpy(*bytes, file, (size_t)length);
  sqlite3_free(file);
  *size = (size_t)length;
  return *bytes ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the page");
}
