/* clast check: each check is a query that must return no rows. */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/memory.h"

static const char checking[] = "checking";

struct report {
  struct store *store;
  void (*line)(void *context, const char *text);
  void *context;
  int64_t problems;
  bool pages_damaged;
};

static void say(struct report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(struct report *report, const char *format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  report->problems++;
  if (report->line)
    report->line(report->context, text);
}

/* Every row of `sql` is a problem; its first column is the sentence. */
static status no_rows(struct report *report, const char *sql, struct error *error) {
  STATEMENT statement = NULL;
  status result = sql_prepare(report->store->db, sql, &statement, checking, error);
  while (sql_next(statement, &result, checking, error))
    say(report, "%s", sql_text(statement, 0));
  return result;
}

static const char *const questions[] = {
    "SELECT 'foreign key: row ' || ifnull(rowid, '?') || ' of table ' || \"table\" || ' names a row of ' || parent || "
    "' that is not there' FROM pragma_foreign_key_check",
    "SELECT 'run ' || run_id || ' has no fragment masses' FROM run WHERE run_id NOT IN (SELECT run_id FROM "
    "fragment_mass)",
    /* SQLite does not evaluate CHECKs when it only reads a file. */
    "SELECT 'point ' || point_id || ': its scene is no JSON' FROM point WHERE NOT json_valid(scene)",
    "SELECT 'session ' || session_id || ': its facts are no JSON' FROM session WHERE NOT json_valid(facts)",
    "SELECT 'point ' || point_id || ' has no inputs' FROM point WHERE point_id NOT IN (SELECT point_id FROM "
    "point_input)",
    "SELECT 'bin ' || bin || ' has no edges' FROM (SELECT DISTINCT bin FROM point_spectrum) WHERE bin NOT IN (SELECT "
    "bin FROM bin)",
};

/* SQLite checks how the pages hang together first, then the rows. It stops at the first problem here: if pages are
 * damaged, a table can have rows without end. */
static status check_pages(struct report *report, struct error *error) {
  STATEMENT first = NULL;
  bool whole = true;
  status result = sql_prepare(report->store->db, "SELECT integrity_check FROM pragma_integrity_check(1)", &first,
                              checking, error);
  if (sql_next(first, &result, checking, error)) {
    const char *text = sql_text(first, 0);
    whole = strcmp(text, "ok") == 0;
    report->pages_damaged = strncmp(text, "*** in database", 15) == 0;
    if (report->pages_damaged)
      say(report, "database: %.700s. Nothing else was checked", text);
  }
  if (result != STATUS_OK || whole || report->pages_damaged)
    return result;
  return no_rows(report, "SELECT 'database: ' || integrity_check FROM pragma_integrity_check", error);
}

/* Every fragment of a run that counts has a mass. */
static status check_fragment_counts(struct report *report, struct error *error) {
  const char *count = OUTCOME_NAME(fragment_count);
  SQL_TEXT sql = sql_format("SELECT 'run ' || run_id || ': ' || (length(masses) / 8.0) || ' masses, but %s is ' || %s "
                            "FROM run JOIN fragment_mass USING (run_id) WHERE counts AND length(masses) <> 8 * %s",
                            count, count, count);
  return no_rows(report, sql, error);
}

/* Runs without a row in the table of their engine, for every engine in the store. */
static status check_results(struct report *report, struct error *error) {
  STATEMENT statement = NULL;
  status result =
      sql_prepare(report->store->db,
                  "SELECT format('SELECT ''run '' || run_id || '' has no row in %w'' FROM run JOIN point USING "
                  "(point_id) WHERE engine = %Q AND run_id NOT IN (SELECT run_id FROM \"%w\")', name, substr(name, "
                  "8), name) FROM sqlite_schema WHERE type = 'table' AND name GLOB 'result_*'",
                  &statement, checking, error);
  while (sql_next(statement, &result, checking, error))
    result = no_rows(report, sql_text(statement, 0), error);
  return result;
}

/* Writes an SQL expression that names a table's values out of range, such as ' largest_fraction is 1.2'. False: no
 * column of the table has a range. Older stores lack columns. */
static bool range_columns(struct store *store, const char *table, const struct field_table *fields, FILE *sql) {
  bool any = false;
  for (size_t k = 0; k < fields->count; k++) {
    const struct field *row = &fields->rows[k];
    char name[FIELD_TEXT_SIZE];
    if ((row->kind != FIELD_REAL && row->kind != FIELD_INTEGER) ||
        (row->minimum == -HUGE_VAL && row->maximum == HUGE_VAL))
      continue;
    field_column_name(row->path, name, sizeof name);
    if (!schema_has_column(store->db, table, name))
      continue;
    /* A share is a quotient of two sums over particles, and rounding alone can put it above 1: by 5e-15 for 200
     * particles, at most by their number times 1e-16. 1e-9 is enough for 1e7 particles. */
    const bool share = row->kind == FIELD_REAL && row->minimum == 0 && row->maximum == 1;
    const double rounding = share ? 1e-9 : 0;
    fprintf(sql, "%siif(\"%s\" < %.17g OR \"%s\" > %.17g, ' %s is ' || \"%s\", '')", any ? " || " : "", name,
            fmax(row->minimum - rounding, -DBL_MAX), name, fmin(row->maximum + rounding, DBL_MAX), name, name);
    any = true;
  }
  return any;
}

/* Results of runs that count must be in the ranges of their field rows; a share above 1 by more than rounding means an
 * error in the sums. Results of another results_version cannot be checked. */
static status check_ranges(struct report *report, struct error *error) {
  status result = STATUS_OK;
  for (size_t k = 0; result == STATUS_OK && k < 2 * engine_count(); k++) {
    const struct engine_kind *kind = engine_at(k / 2);
    const struct schema_table own = schema_result_table(kind);
    const char *name = k % 2 ? own.name : "run";
    OWNED char *sql = NULL;
    FILE *text = text_open(&sql);
    fputs("SELECT 'run ' || run_id || ', out of range:' || wrong FROM (SELECT run_id, ", text);
    const bool any = range_columns(report->store, name, k % 2 ? kind->results : &outcome_table, text);
    fprintf(text,
            " AS wrong FROM run JOIN point USING (point_id)%s%s%s WHERE counts AND engine = '%s' AND results_version = "
            "%d) WHERE wrong <> ''",
            k % 2 ? " JOIN \"" : "", k % 2 ? name : "", k % 2 ? "\" USING (run_id)" : "", kind->name,
            kind->results_version);
    text_close_small(text, &sql);
    if (any)
      result = no_rows(report, sql, error);
  }
  return result;
}

static status check_files(struct report *report, struct error *error) {
  struct error elsewhere = {0};
  if (store_check_folder(report->store, &elsewhere) != STATUS_OK) {
    say(report, "%s", elsewhere.message);
    return STATUS_OK;
  }
  const bool digests = schema_has_column(report->store->db, "run", "fields_digest");
  STATEMENT statement = NULL;
  status result = sql_preparef(report->store->db, &statement, checking, error,
                               "SELECT run_id, fields_path, %s FROM run WHERE fields_path IS NOT NULL",
                               digests ? "fields_digest" : "NULL");
  while (sql_next(statement, &result, checking, error)) {
    OWNED char *path = paths_of_fields(report->store->path, sql_text(statement, 1));
    const bool here = access(path, R_OK) == 0;
    if (!here || !paths_whole(path, sqlite3_column_type(statement, 2) == SQLITE_NULL ? NULL : sql_text(statement, 2)))
      say(report,
          "run %lld: its fields file %s is %s; `clast run` of a campaign with keep.fields makes it again, or "
          "`clast replay --fields`",
          (long long)sqlite3_column_int64(statement, 0), path, here ? "damaged" : "missing");
  }
  return result;
}

status store_compare_bins(const struct store *store, sqlite3_stmt *rows, int64_t run_id, size_t count, bool *same,
                          const char *doing, struct error *error) {
  size_t i = 0;
  status result = STATUS_OK;
  *same = true;
  sqlite3_bind_int64(rows, 1, run_id);
  for (; sql_next(rows, &result, doing, error); i++)
    *same = *same && i < count && sqlite3_column_int64(rows, 0) == store->bins[i].bin &&
            sqlite3_column_int64(rows, 1) == store->bins[i].count &&
            sqlite3_column_double(rows, 2) == store->bins[i].mass;
  sqlite3_reset(rows);
  *same = *same && i == count;
  return result;
}

/* Checks one run. Columns of `run`: run_id, masses, total mass, counts. */
static status check_run(struct report *report, sqlite3_stmt *run, sqlite3_stmt *spectrum, struct error *error) {
  const int64_t run_id = sqlite3_column_int64(run, 0);
  const double *masses;
  size_t n = 0, count = 0;
  if (sqlite3_column_type(run, 1) != SQLITE_BLOB || sqlite3_column_bytes(run, 1) % 8 != 0) {
    say(report, "run %lld: its masses are not a list of float64", (long long)run_id);
    return STATUS_OK;
  }
  TRY(store_take_masses(report->store, run, 1, &n, error));
  masses = report->store->masses;
  double total = 0, stored = sqlite3_column_double(run, 2);
  bool descending = true, same = false;
  for (size_t i = 0; i < n; i++) {
    total += masses[i];
    descending = descending && (i == 0 || masses[i] <= masses[i - 1]);
  }
  if (!descending)
    say(report, "run %lld: its masses are not in descending order", (long long)run_id);
  /* The engine may have summed in another order. Tolerance: n roundings of the total, with n below 1e6. */
  if (sqlite3_column_int(run, 3) && !(fabs(total - stored) <= 1e-9 * stored))
    say(report, "run %lld: its masses sum to %.17g kg, but its total mass is %.17g kg", (long long)run_id, total,
        stored);
  TRY(store_make_bins(report->store, n, &count, error));
  TRY(store_compare_bins(report->store, spectrum, run_id, count, &same, checking, error));
  if (!same)
    say(report, "run %lld: its spectrum is not that of its masses", (long long)run_id);
  return STATUS_OK;
}

static status check_masses(struct report *report, struct error *error) {
  STATEMENT runs = NULL;
  STATEMENT spectrum = NULL;
  TRY(sql_preparef(report->store->db, &runs, checking, error,
                   "SELECT run_id, masses, %s, counts FROM fragment_mass JOIN run USING (run_id)",
                   OUTCOME_NAME(total_mass)));
  TRY(sql_prepare(report->store->db, "SELECT bin, count, mass FROM spectrum WHERE run_id = ?1 ORDER BY bin", &spectrum,
                  checking, error));
  status result = STATUS_OK;
  while (sql_next(runs, &result, checking, error))
    result = check_run(report, runs, spectrum, error);
  return result;
}

/* A run's identity must follow from its point's scene and its seed. Runs of another results_version, or of an engine
 * that this program lacks, cannot be checked. */
static status check_identities(struct report *report, struct error *error) {
  STATEMENT points = NULL;
  STATEMENT runs = NULL;
  struct error damaged = {0};
  if (store_point_shapes(report->store, 0, &damaged) != STATUS_OK)
    say(report, "%.600s", damaged.message);
  TRY(sql_prepare(report->store->db, "SELECT point_id, scene, scene_name, engine FROM point", &points, checking,
                  error));
  TRY(sql_prepare(report->store->db,
                  "SELECT run_id, seed, identity FROM run WHERE point_id = ?1 AND results_version = ?2", &runs,
                  checking, error));
  status result = STATUS_OK;
  while (sql_next(points, &result, checking, error)) {
    struct scene *scene = NULL;
    struct error why = {0};
    int64_t point_id = sqlite3_column_int64(points, 0);
    if (!engine_find(sql_text(points, 3), NULL))
      continue;
    if (scene_parse_json(sql_text(points, 2), sql_text(points, 1), &scene, &why) != STATUS_OK) {
      say(report, "point %lld: its scene cannot be read: %.600s", (long long)point_id, why.message);
      continue;
    }
    SQL_BIND(runs, sql_of_integer(point_id), sql_of_integer(scene->kind->results_version));
    while (sql_next(runs, &result, checking, error)) {
      uint8_t identity[16];
      scene_identity(scene, (uint64_t)sqlite3_column_int64(runs, 1), identity);
      if (sqlite3_column_bytes(runs, 2) != 16 || memcmp(identity, sqlite3_column_blob(runs, 2), 16) != 0)
        say(report, "run %lld: its identity is not that of its scene and seed",
            (long long)sqlite3_column_int64(runs, 0));
    }
    sqlite3_reset(runs);
    scene_free(scene);
  }
  return result;
}

static status check_questions(struct report *report, struct error *error) {
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < sizeof questions / sizeof questions[0]; i++)
    result = no_rows(report, questions[i], error);
  return result;
}

static status check_digests(struct report *report, struct error *error) {
  DIGEST_ROWS runs = digest_rows(report->store->db, DIGEST_RUNS, 0, false, error);
  while (digest_rows_next(&runs))
    if (!runs.whole)
      say(report, "run %lld: a bit of its results, masses, estimates or identity has changed since it was stored",
          (long long)runs.number);
  TRY(digest_rows_end(&runs));
  DIGEST_ROWS points = digest_rows(report->store->db, DIGEST_POINTS, 0, false, error);
  while (digest_rows_next(&points))
    if (!points.whole)
      say(report, "point %lld: a bit of its scene or inputs has changed since it was stored", (long long)points.number);
  return digest_rows_end(&points);
}

status store_check_run(struct store *store, int64_t run_id, bool *whole, struct error *error) {
  DIGEST_ROWS runs = digest_rows(store->db, DIGEST_RUNS, run_id, false, error);
  *whole = !digest_rows_next(&runs) || runs.whole;
  return digest_rows_end(&runs);
}

/* Rows of tables that were changed, removed or added. Stores of version 3 lack their digests. */
static status check_rows(struct report *report, struct error *error) {
  sqlite3 *db = report->store->db;
  for (size_t i = 0; schema_has_column(db, "table_digest", NULL) && i < schema_tables_count; i++) {
    SQL_TEXT rows = NULL;
    if (!schema_tables[i].has_digest)
      continue;
    TRY(digest_of_rows(db, schema_tables[i].name, &rows, error));
    SQL_TEXT sql = sql_format(
        "SELECT format('table %%s: %%s', table_name, iif(d.row_count = r.row_count, 'a bit of its rows has changed "
        "since they were stored', format('%%s rows were stored, and %%d are there', ifnull(d.row_count, 'no number "
        "of'), r.row_count))) FROM (%s) r LEFT JOIN main.table_digest d USING (table_name) WHERE (d.row_count, "
        "d.digest) IS NOT (r.row_count, r.digest)",
        rows);
    TRY(no_rows(report, sql, error));
  }
  return STATUS_OK;
}

static status check_bins(struct report *report, struct error *error) {
  STATEMENT bins = NULL;
  status result = sql_prepare(report->store->db, "SELECT bin, lower, upper FROM bin", &bins, checking, error);
  while (sql_next(bins, &result, checking, error)) {
    const int64_t bin = sqlite3_column_int64(bins, 0);
    if (bin < -SUMS_BINS_LIMIT || bin > SUMS_BINS_LIMIT || sqlite3_column_double(bins, 1) != spectrum_edge((int)bin) ||
        sqlite3_column_double(bins, 2) != spectrum_edge((int)bin + 1))
      say(report, "bin %lld: its edges are not those of this number", (long long)bin);
  }
  return result;
}

/* Answers are told in the units of column_doc. Its rows are made again in a temporary table, which takes precedence;
 * columns that this program does not know are taken as they are. */
static status make_docs(sqlite3 *db, struct error *error) {
  TRY(sql_execute(db,
                  "CREATE TEMP TABLE column_doc (table_name TEXT, column_name TEXT, unit TEXT, meaning TEXT, "
                  "deterministic INTEGER DEFAULT 0, PRIMARY KEY (table_name, column_name)); "
                  "INSERT OR REPLACE INTO temp.column_doc SELECT table_name, column_name, unit, meaning, deterministic "
                  "FROM main.column_doc",
                  checking, error));
  TRY(schema_document_all(db, error));
  return views_document(db, error);
}

static status check_units(struct report *report, struct error *error) {
  sqlite3 *db = report->store->db;
  sqlite3_exec(db, "PRAGMA query_only = OFF", NULL, NULL, NULL); /* it covers temporary tables, too */
  status result = views_make_temporary(db,
                                       error); /* after a merge, SQLite cannot list the columns of the earlier ones */
  if (result == STATUS_OK)
    result = make_docs(db, error);
  if (result == STATUS_OK)
    result = no_rows(report,
                     "SELECT format('column %s of %s: its unit is %s, not %s', column_name, table_name, ifnull(a.unit, "
                     "'none'), ifnull(b.unit, 'none')) FROM temp.column_doc b LEFT JOIN main.column_doc a USING "
                     "(table_name, column_name) WHERE ifnull(a.unit, '1') <> ifnull(b.unit, '1') OR (a.table_name IS "
                     "NULL AND table_name NOT IN ('runs', 'points', 'spectra', 'estimates', 'resolution'))",
                     error);
  sqlite3_exec(db, "DROP TABLE IF EXISTS temp.column_doc", NULL, NULL, NULL);
  if (!report->store->writer)
    sqlite3_exec(db, "PRAGMA query_only = ON", NULL, NULL, NULL);
  return result;
}

static status check_sums(struct report *report, struct error *error) {
  int64_t wrong = 0;
  TRY(sums_mismatches(report->store->db, &wrong, error));
  if (wrong > 0)
    say(report, "running sums: %lld rows of point_total and point_spectrum differ from the runs they sum",
        (long long)wrong);
  return STATUS_OK;
}

status store_check(struct store *store, void (*line)(void *context, const char *text), void *context,
                   struct error *error) {
  static status (*const checks[])(struct report *,
                                  struct error *) = {check_pages,     check_questions, check_fragment_counts,
                                                     check_results,   check_ranges,    check_files,
                                                     check_bins,      check_sums,      check_masses,
                                                     check_digests,   check_rows,      check_units,
                                                     check_identities};
  struct report report = {.store = store, .line = line, .context = context};
  status result = store_flush(store, error);
  for (size_t i = 0; result == STATUS_OK && !report.pages_damaged && i < sizeof checks / sizeof checks[0]; i++) {
    struct error reason = {0};
    result = checks[i](&report, &reason);
    if (result == STATUS_CONTENT) { /* a check that the contents do not allow to end is a problem, too */
      say(&report, "%s", reason.message);
      result = STATUS_OK;
    } else if (result != STATUS_OK) {
      status_fail(error, result, "%s", reason.message);
    }
  }
  if (result != STATUS_OK || report.problems == 0)
    return result;
  return status_fail(error, STATUS_CONTENT, "%s: %lld problems found", store->path, (long long)report.problems);
}
