/* The runs of a page, thinned, and the statistics of all of their results. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/sample.h"
#include "db/ask/columns.h"
#include "db/ask/page_private.h"
#include "db/store/views_statistics.h"
#include "engine/grow.h"
#include "schemas/text.h"

static const char doing[] = "making the page";

enum { COLUMNS = 256, NAME = 128 };

struct column {
  char name[NAME];
  bool main, number, varies; /* of the view points; has a value; has two values */
  double first;
  struct sample_moments moments; /* of the current point */
  double *values;                /* of the current point; owned */
  size_t values_count, values_room;
};

struct reading {
  struct ask_page *page;
  sqlite3_stmt *insert; /* into means */
  struct ask_page_modes modes;
  size_t count;
  struct column column[COLUMNS];
  bool begun;
  int64_t point_id, results_version; /* the current ones */
};

static bool is_main(const char *name) {
  const char *names[VIEWS_STATISTICS_MAIN];
  const size_t count = views_statistics_main(names);
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i], name) == 0)
      return true;
  return false;
}

static status take_name(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct reading *reading = context;
  if (reading->count == COLUMNS || values[0].kind != QUERY_TEXT)
    return STATUS_OK;
  struct column *column = &reading->column[reading->count++];
  snprintf(column->name, NAME, "%s", values[0].text);
  column->main = is_main(column->name);
  return STATUS_OK;
}

static status add_mean(struct reading *reading, const struct column *column, const struct sample_summary *summary,
                       struct error *error) {
  sqlite3_bind_int64(reading->insert, 1, reading->point_id);
  sqlite3_bind_int64(reading->insert, 2, reading->results_version);
  sqlite3_bind_text(reading->insert, 3, column->name, -1, SQLITE_STATIC);
  sqlite3_bind_int64(reading->insert, 4, (int64_t)summary->n);
  sqlite3_bind_double(reading->insert, 5, (double)(float)summary->mean); /* NaN is NULL */
  sqlite3_bind_double(reading->insert, 6, (double)(float)summary->standard_deviation);
  sqlite3_bind_double(reading->insert, 7, (double)(float)summary->half_width);
  return sql_run(reading->insert, doing, error);
}

/* Writes the statistics of the current point: means of the results that the view points lacks, and modes of all
 * results. `newest`: the point has no newer version of results. */
static status end_point(struct reading *reading, bool newest, struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && reading->begun && i < reading->count; i++) {
    struct column *column = &reading->column[i];
    const struct sample_summary summary = sample_summarise_moments(&column->moments, 0.95);
    if (summary.n > 0 && !column->main)
      code = add_mean(reading, column, &summary, error);
    if (code == STATUS_OK && newest)
      code = ask_page_modes_add(&reading->modes, reading->point_id, column->name, column->values_count, column->values,
                                error);
    column->moments = (struct sample_moments){.n = 0};
    column->values_count = 0;
  }
  return code;
}

static status add_value(struct column *column, double value, struct error *error) {
  if (!column->number)
    column->first = value;
  column->number = true;
  column->varies = column->varies || value != column->first;
  sample_add(&column->moments, value);
  if (column->values_count == ASK_PAGE_JUDGED_RUNS)
    return STATUS_OK;
  if (!grow_room(&column->values, &column->values_room, column->values_count + 1, sizeof *column->values))
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  column->values[column->values_count++] = value;
  return STATUS_OK;
}

static status take_run(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct reading *reading = context;
  const int64_t point = values[0].integer, version = values[1].integer;
  if (!reading->begun || point != reading->point_id || version != reading->results_version) {
    const status code = end_point(reading, point != reading->point_id, error);
    if (code)
      return code;
    reading->begun = true;
    reading->point_id = point;
    reading->results_version = version;
  }
  status code = STATUS_OK;
  for (size_t i = 2; code == STATUS_OK && i < count; i++)
    if (isfinite(values[i].real))
      code = add_value(&reading->column[i - 2], values[i].real, error);
  return code;
}

static void write_columns(const struct reading *reading, FILE *out) {
  for (size_t i = 0; i < reading->count; i++) {
    fputs(", ", out);
    sql_write_name(reading->column[i].name, out);
  }
}

/* One pass over all runs that count, point by point, in a fixed order of the runs. */
static status read_results(struct reading *reading, struct store *store, struct error *error) {
  const struct query_sink sink = {.context = reading, .row = take_run};
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  fputs("SELECT point_id, results_version", out);
  write_columns(reading, out);
  fputs(" FROM runs WHERE counts ORDER BY point_id, results_version, replicate, seed", out);
  if (!text_close(out, &sql))
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  free(sql);
  return code ? code : end_point(reading, true, error);
}

/* Removes results with the same value everywhere, and the last rows beyond the limit. */
static status thin_means(struct reading *reading, struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < reading->count; i++)
    if (reading->column[i].number && !reading->column[i].varies)
      code = sql_executef(reading->page->db, doing, error, "DELETE FROM means WHERE quantity = %Q",
                          reading->column[i].name);
  int64_t rows = 0, points = 0;
  if (code == STATUS_OK)
    code = sql_integer(reading->page->db, "SELECT count(*) FROM means", 0, &rows, error);
  if (code == STATUS_OK)
    code = sql_integer(reading->page->db, "SELECT count(DISTINCT point_id) FROM means", 0, &points, error);
  for (size_t i = reading->count; code == STATUS_OK && rows > ASK_PAGE_MEANS && i-- > 0;) {
    if (reading->column[i].main || !reading->column[i].varies)
      continue;
    code = sql_executef(reading->page->db, doing, error, "DELETE FROM means WHERE quantity = %Q",
                        reading->column[i].name);
    rows -= points;
  }
  return code;
}

/* Chooses the runs to keep within the limit: the first `replicates` of every point or, with more points than the limit,
 * of every n-th point. */
static status choose_room(struct store *store, int *replicates, int *every, struct error *error) {
  double points = 0, kept = 0, runs = 0;
  status code = query_number(store, "SELECT count(*) FROM point_total", 0, NULL, &points, error);
  if (code == STATUS_OK)
    code = query_number(store, "SELECT max(runs + failed) FROM point_total", 0, NULL, &runs, error);
  *every = (int)(points / ASK_PAGE_RUNS) + 1;
  int low = 1, high = isfinite(runs) && runs > 1 ? (int)runs : 1; /* invariant: `low` fits, or is 1 */
  while (code == STATUS_OK && low < high) {
    char sql[128];
    const int middle = low + (high - low + 1) / 2;
    snprintf(sql, sizeof sql, "SELECT sum(min(runs + failed, %d)) FROM point_total", middle);
    code = query_number(store, sql, 0, NULL, &kept, error);
    if (kept / *every <= ASK_PAGE_RUNS)
      low = middle;
    else
      high = middle - 1;
  }
  *replicates = low;
  return code;
}

/* Results of single runs: the main ones, then the others in their order, up to the limit. */
static void write_results(const struct reading *reading, double runs, FILE *out, size_t *left_out) {
  size_t room = runs > 0 ? (size_t)(ASK_PAGE_VALUES / runs) : COLUMNS;
  for (int main = 1; main >= 0; main--)
    for (size_t i = 0; i < reading->count; i++) {
      const struct column *column = &reading->column[i];
      if (column->main != main || (!main && !column->varies))
        continue;
      if (!main && room == 0) {
        ++*left_out;
        continue;
      }
      fputs(", ", out);
      sql_write_name(column->name, out);
      room -= room > 0;
    }
}

static void write_axes(const struct ask_column *axes, size_t count, FILE *out) {
  for (size_t i = 0; i < count; i++) {
    fputs(", ", out);
    sql_write_name(axes[i].name, out);
  }
}

static status copy_runs(struct reading *reading, struct store *store, struct error *error) {
  int replicates = 1, every = 1;
  double all = 0;
  struct ask_column axes[COLUMNS];
  size_t axis_count = 0;
  size_t size = 0, left_out = 0;
  char *sql = NULL, text[64];
  status code = choose_room(store, &replicates, &every, error);
  if (code == STATUS_OK)
    code = query_number(store, "SELECT sum(runs + failed) FROM point_total", 0, NULL, &all, error);
  if (code == STATUS_OK)
    code = ask_columns_axes(store, false, COLUMNS, axes, &axis_count, error);
  if (code)
    return code;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  fputs("SELECT run_id, point_id, replicate, seed, results_version, counts, surplus, state, engine, scene, message, "
        "session_id, host, attempt",
        out);
  write_axes(axes, axis_count, out);
  write_results(reading, fmin(all, ASK_PAGE_RUNS), out, &left_out);
  fprintf(out,
          " FROM runs WHERE run_id IN (SELECT run_id FROM (SELECT run_id, row_number() OVER (PARTITION BY point_id, "
          "results_version ORDER BY replicate, seed) AS place FROM run WHERE surplus = 0 AND point_id %% %d = %d) "
          "WHERE place <= %d) ORDER BY point_id, results_version, replicate, seed",
          every, every > 1 ? 1 : 0, replicates);
  if (!text_close(out, &sql))
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  code = ask_page_copy(reading->page, store, "runs", sql, 14 + axis_count, error);
  free(sql);
  snprintf(text, sizeof text, "%zu", left_out);
  if (code == STATUS_OK)
    code = ask_page_fact(reading->page, "results_left_out", text, error);
  snprintf(text, sizeof text, "%d", replicates);
  if (code == STATUS_OK)
    code = ask_page_fact(reading->page, "replicates_kept", text, error);
  snprintf(text, sizeof text, "%d", every);
  return code ? code : ask_page_fact(reading->page, "runs_of_every_nth_point", text, error);
}

status ask_page_runs(struct ask_page *page, struct store *store, struct error *error) {
  struct reading *reading = calloc(1, sizeof *reading);
  if (!reading)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  reading->page = page;
  const struct query_sink names = {.context = reading, .row = take_name};
  status code = sql_execute(page->db, "CREATE TABLE means (point_id, results_version, quantity, n, mean, sd, hw95)",
                            doing, error);
  if (code == STATUS_OK)
    code = sql_prepare(page->db, "INSERT INTO means VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)", &reading->insert, doing,
                       error);
  if (code == STATUS_OK)
    code = ask_page_modes_begin(page, &reading->modes, error);
  if (code == STATUS_OK)
    code = ask_group_quantities(store, &names, error);
  if (code == STATUS_OK)
    code = read_results(reading, store, error);
  sqlite3_finalize(reading->insert);
  sqlite3_finalize(reading->modes.insert);
  if (code == STATUS_OK)
    code = thin_means(reading, error);
  if (code == STATUS_OK)
    code = copy_runs(reading, store, error);
  for (size_t i = 0; i < reading->count; i++)
    free(reading->column[i].values);
  free(reading);
  return code;
}
