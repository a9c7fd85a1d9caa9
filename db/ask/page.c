/* The small file of a page: tables that are copied from the store, facts, labels, pictures. */
#include "db/ask/page.h"

#include <stdlib.h>
#include <string.h>

#include "db/ask/page_private.h"
#include "db/store/internal.h"
#include "db/store/paths.h"
#include "engine/outcome.h"
#include "schemas/text.h"

static const char doing[] = "making the page";

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

struct copying {
  struct ask_page *page;
  const char *table;
  size_t rounded;
  sqlite3_stmt *insert;
};

/* "a", "b", "c"; without names ?, ?, ?. NULL: no memory. */
static char *write_list(size_t count, const char *const *names) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  for (size_t i = 0; i < count; i++) {
    fputs(i ? ", " : "", out);
    if (names)
      sql_write_name(names[i], out);
    else
      fputc('?', out);
  }
  return text_close(out, &text);
}

static status make_table(void *context, size_t count, const char *const *names, struct error *error) {
  struct copying *copying = context;
  sqlite3 *db = copying->page->db;
  char *columns = write_list(count, names), *marks = write_list(count, NULL);
  status code = columns && marks ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the page");
  if (code == STATUS_OK)
    code = sql_executef(db, doing, error, "CREATE TABLE \"%w\" (%s)", copying->table, columns);
  if (code == STATUS_OK)
    code = sql_preparef(db, &copying->insert, doing, error, "INSERT INTO \"%w\" VALUES (%s)", copying->table, marks);
  free(columns);
  free(marks);
  return code;
}

static void bind_value(sqlite3_stmt *statement, int index, const struct query_value *value, bool rounded) {
  switch (value->kind) {
  case QUERY_NULL: sqlite3_bind_null(statement, index); break;
  case QUERY_INTEGER: sqlite3_bind_int64(statement, index, value->integer); break;
  case QUERY_REAL: sqlite3_bind_double(statement, index, rounded ? (double)(float)value->real : value->real); break;
  case QUERY_TEXT: sqlite3_bind_text(statement, index, value->text, (int)value->size, SQLITE_TRANSIENT); break;
  case QUERY_BLOB: sqlite3_bind_blob(statement, index, value->blob, (int)value->size, SQLITE_TRANSIENT); break;
  }
}

static status copy_row(void *context, size_t count, const struct query_value *values, struct error *error) {
  const struct copying *copying = context;
  for (size_t i = 0; i < count; i++)
    bind_value(copying->insert, (int)i + 1, &values[i], i >= copying->rounded);
  return sql_run(copying->insert, doing, error);
}

status ask_page_copy(struct ask_page *page, struct store *store, const char *table, const char *sql, size_t rounded,
                     struct error *error) {
  struct copying copying = {page, table, rounded, NULL};
  const struct query_sink sink = {&copying, make_table, copy_row};
  const status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  sqlite3_finalize(copying.insert);
  return code;
}

/* Spectra of points, newest version only: of all points, or of every n-th point when there are more rows than the
 * limit. */
static status copy_spectra(struct ask_page *page, struct store *store, struct error *error) {
  double rows = 0;
  char sql[400], number[32];
  status code = query_number(store, "SELECT count(*) FROM point_spectrum", 0, NULL, &rows, error);
  if (code)
    return code;
  const int every = (int)(rows / ASK_PAGE_SPECTRUM) + 1;
  snprintf(sql, sizeof sql,
           "SELECT point_id, results_version, n, bin, lower, upper, runs, count, count_mean, count_sd, count_hw95, "
           "density FROM spectra WHERE point_id %% %d = %d ORDER BY point_id, results_version, bin",
           every, every > 1 ? 1 : 0);
  code = ask_page_copy(page, store, "spectra", sql, 8, error);
  snprintf(number, sizeof number, "%d", every);
  return code ? code : ask_page_fact(page, "spectra_of_every_nth_point", number, error);
}

/* Points: exact inputs, rounded statistics. The inputs come first in the view. */
static status copy_points(struct ask_page *page, struct store *store, struct error *error) {
  double axes = 0;
  const status code = query_number(store, "SELECT count(*) FROM axis", 0, NULL, &axes, error);
  return code ? code : ask_page_copy(page, store, "points", "SELECT * FROM points", 3 + (size_t)axes, error);
}

static status copy_attempts(struct ask_page *page, struct store *store, struct error *error) {
  char sql[300];
  snprintf(sql, sizeof sql,
           "SELECT point_id, replicate, seed, session_id, number, reason, exit_code, signal, wall_time, limited_to, "
           "message, host FROM attempt ORDER BY attempt_id DESC LIMIT %d",
           ASK_PAGE_ATTEMPTS);
  return ask_page_copy(page, store, "attempt", sql, ASK_PAGE_EXACT, error);
}

/* The canned queries that the page's tables can answer. */
static status add_questions(struct ask_page *page, struct error *error) {
  sqlite3_stmt *insert = NULL;
  status code = sql_prepare(page->db, "INSERT INTO question VALUES (?1, ?2, ?3, ?4)", &insert, doing, error);
  for (size_t i = 0; code == STATUS_OK && i < ask_canned_count(); i++) {
    const struct query_canned *query = ask_canned_at(i);
    sqlite3_stmt *trial = NULL;
    const int works = sqlite3_prepare_v2(page->db, query->sql, -1, &trial, NULL);
    sqlite3_finalize(trial);
    if (works != SQLITE_OK)
      continue;
    sql_bind_text(insert, 1, query->name);
    sql_bind_text(insert, 2, query->doc);
    sql_bind_text(insert, 3, query->sql);
    sql_bind_text(insert, 4, query->parameters);
    code = sql_run(insert, doing, error);
  }
  sqlite3_finalize(insert);
  return code;
}

static status fill(struct ask_page *page, struct store *store, struct error *error) {
  status code = sql_execute(page->db,
                            "PRAGMA page_size = 4096;"
                            "CREATE TABLE fact (name TEXT PRIMARY KEY, value) WITHOUT ROWID;"
                            "CREATE TABLE label (column_name TEXT PRIMARY KEY, label, unit, factor) WITHOUT ROWID;"
                            "CREATE TABLE question (name, doc, sql, parameters);"
                            "CREATE TABLE picture (run_id, point_id, quantile, png);"
                            "CREATE TABLE difference (quantity, first_point, point_id, pairs, difference, hw95);"
                            "BEGIN",
                            doing, error);
  for (size_t i = 0; code == STATUS_OK && i < sizeof tables / sizeof tables[0]; i++)
    code = ask_page_copy(page, store, tables[i].name, tables[i].sql, ASK_PAGE_EXACT, error);
  if (code == STATUS_OK)
    code = copy_points(page, store, error);
  if (code == STATUS_OK)
    code = copy_spectra(page, store, error);
  if (code == STATUS_OK)
    code = copy_attempts(page, store, error);
  if (code == STATUS_OK)
    code = ask_page_runs(page, store, error);
  if (code == STATUS_OK)
    code = ask_page_scatter(page, store, error);
  if (code == STATUS_OK)
    code = ask_page_goodness(page, store, error);
  if (code == STATUS_OK) /* canned queries also use the table's name in the store */
    code = sql_execute(page->db, "CREATE VIEW run AS SELECT * FROM runs", doing, error);
  return code ? code : add_questions(page, error);
}

status ask_page_make(struct store *store, struct ask_page **out, struct error *error) {
  struct ask_page *page = *out = calloc(1, sizeof *page);
  if (!page)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  status code = sqlite3_open(":memory:", &page->db) == SQLITE_OK
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
  sqlite3_close(page->db);
  free(page);
}

status ask_page_fact(struct ask_page *page, const char *name, const char *value, struct error *error) {
  return sql_executef(page->db, doing, error, "INSERT OR REPLACE INTO fact VALUES (%Q, %Q)", name, value);
}

status ask_page_label(struct ask_page *page, const char *column, const char *label, const char *unit, double factor,
                      struct error *error) {
  return sql_executef(page->db, doing, error, "INSERT OR REPLACE INTO label VALUES (%Q, %Q, %Q, %!.17g)", column, label,
                      unit, factor);
}

status ask_page_columns(struct ask_page *page, status (*each)(void *context, const char *column, struct error *error),
                        void *context, struct error *error) {
  static const char sql[] = "SELECT column_name FROM axis UNION SELECT quantity FROM means UNION SELECT name FROM "
                            "pragma_table_info('runs') EXCEPT SELECT column_name FROM label";
  sqlite3_stmt *statement = NULL;
  status code = sql_prepare(page->db, sql, &statement, doing, error);
  while (sql_next(statement, &code, doing, error))
    code = each(context, sql_text(statement, 0), error);
  sqlite3_finalize(statement);
  return code;
}

struct giving {
  struct store *store;
  status (*each)(void *context, const struct ask_page_kept *run, struct error *error);
  void *context;
};

static status give_kept(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  const struct giving *giving = context;
  if (values[3].kind != QUERY_TEXT)
    return STATUS_OK;
  char *fields = paths_of_fields(giving->store->path, values[3].text);
  if (!fields)
    return status_fail(error, STATUS_MEMORY, "no memory for the page");
  const struct ask_page_kept run = {values[0].integer, values[1].integer, values[2].real, fields};
  const status code = giving->each(giving->context, &run, error);
  free(fields);
  return code;
}

status ask_page_kept(struct store *store, size_t most,
                     status (*each)(void *context, const struct ask_page_kept *run, struct error *error), void *context,
                     struct error *error) {
  static const char sql[] =
      "WITH ranked AS (SELECT run_id, point_id, fields_path, row_number() OVER point - 1 AS place, count(*) OVER "
      "(PARTITION BY point_id) - 1 AS last FROM run WHERE counts AND results_version = (SELECT max(results_version) "
      "FROM run AS newest WHERE newest.point_id = run.point_id) WINDOW point AS (PARTITION BY point_id ORDER BY %s, "
      "run_id)) SELECT run_id, point_id, iif(last = 0, 0.5, 1.0 * place / last) AS quantile, fields_path FROM ranked "
      "WHERE fields_path IS NOT NULL AND place IN (0, (last + 1) / 2, last) ORDER BY abs(quantile - 0.5) > 0.25, "
      "point_id, quantile LIMIT %zu";
  struct giving giving = {store, each, context};
  const struct query_sink sink = {.context = &giving, .row = give_kept};
  char text[900];
  snprintf(text, sizeof text, sql, OUTCOME_DEFAULT, most);
  return query_run(store, text, 0, NULL, 0, &sink, error);
}

status ask_page_picture(struct ask_page *page, const struct ask_page_kept *run, const void *png, size_t size,
                        struct error *error) {
  sqlite3_stmt *insert = NULL;
  status code = sql_prepare(page->db, "INSERT INTO picture VALUES (?1, ?2, ?3, ?4)", &insert, doing, error);
  if (code == STATUS_OK) {
    sqlite3_bind_int64(insert, 1, run->run_id);
    sqlite3_bind_int64(insert, 2, run->point_id);
    sqlite3_bind_double(insert, 3, run->quantile);
    sqlite3_bind_blob64(insert, 4, png, size, SQLITE_STATIC);
    code = sql_run(insert, doing, error);
  }
  sqlite3_finalize(insert);
  return code;
}

status ask_page_difference(struct ask_page *page, const char *quantity, int64_t first_point, int64_t point,
                           const struct difference *difference, struct error *error) {
  sqlite3_stmt *insert = NULL;
  status code = sql_prepare(page->db, "INSERT INTO difference VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &insert, doing, error);
  if (code == STATUS_OK) {
    sql_bind_text(insert, 1, quantity);
    sqlite3_bind_int64(insert, 2, first_point);
    sqlite3_bind_int64(insert, 3, point);
    sqlite3_bind_int64(insert, 4, (int64_t)difference->pairs);
    sqlite3_bind_double(insert, 5, difference->difference); /* NaN is NULL */
    sqlite3_bind_double(insert, 6, difference->half_width);
    code = sql_run(insert, doing, error);
  }
  sqlite3_finalize(insert);
  return code;
}

status ask_page_file(struct ask_page *page, unsigned char **bytes, size_t *size, struct error *error) {
  sqlite3_int64 length = 0;
  *bytes = NULL;
  status code = sql_execute(page->db, "COMMIT; VACUUM; BEGIN", doing, error);
  if (code)
    return code;
  unsigned char *file = sqlite3_serialize(page->db, "main", &length, 0);
  if (file)
    *bytes = malloc((size_t)length);
  if (*bytes)
    memcpy(*bytes, file, (size_t)length);
  sqlite3_free(file);
  *size = (size_t)length;
  return *bytes ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the page");
}
