/* Merging the stores of several machines. Points are the same when their hashes are, runs when their identities are. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/memory.h"

static const char doing[] = "merging";

/* Documents that the build embeds: db/store/merge_parents.sql, db/store/merge_rest.sql. */
extern const char merge_parents_sql[], merge_rest_sql[];

/* ---- inspecting the source: all pages, then the digests of all rows, before the first row is copied ---- */

/* Checks all pages and the types of all rows. Rows of table spectrum, the longest table, are checked one by one when
 * they are copied. */
static status check_pages(struct store *other, const char *source, struct error *error) {
  STATEMENT rows = NULL;
  status result = sql_prepare(other->db,
                              "SELECT c.quick_check FROM main.sqlite_schema s JOIN pragma_quick_check(s.name) c WHERE "
                              "s.type = 'table' AND s.name <> 'spectrum' AND c.quick_check <> 'ok' LIMIT 1",
                              &rows, doing, error);
  if (sql_next(rows, &result, doing, error))
    result = status_fail(error, STATUS_CONTENT,
                         "%s is damaged: %.500s. Nothing was taken from it; `clast check` tells more. Restore a copy.",
                         source, sql_text(rows, 0));
  return result;
}

static status compare(struct store *other, const char *source, enum digest_kind kind, struct error *error) {
  int64_t first = 0, count = 0;
  DIGEST_ROWS rows = digest_rows(other->db, kind, 0, false, error);
  while (digest_rows_next(&rows))
    if (!rows.whole && count++ == 0)
      first = rows.number;
  TRY(digest_rows_end(&rows));
  if (count == 0)
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "%s: %s %lld is damaged: a bit has changed since it was stored; %lld in all. Nothing was "
                     "taken from it; `clast check` lists them. Restore a copy.",
                     source, rows.table, (long long)first, (long long)count);
}

/* Also refuses a missing, foreign, newer or older file, and one with unexpected objects. */
static status inspect(const char *source, struct error *error) {
  STORE other = NULL;
  TRY(store_open_reader(source, &other, error));
  TRY(check_pages(other, source, error));
  TRY(compare(other, source, DIGEST_RUNS, error));
  return compare(other, source, DIGEST_POINTS, error);
}

/* ---- copying ---- */

struct merged {
  int64_t added;  /* number of runs */
  int64_t common; /* number of runs that both stores have */
};

/* The columns of a table that both stores have, but the listed ones ("'a', 'b'"), each with a comma before it. */
static status list_columns(sqlite3 *db, const char *table, const char *but, char **columns, struct error *error) {
  return sql_textf(db, columns, doing, error,
                   "SELECT group_concat(format(', \"%%w\"', a.name), '') FROM pragma_table_info(%Q, 'main') a JOIN "
                   "pragma_table_info(%Q, 'other') b USING (name) WHERE name NOT IN (%s)",
                   table, table, but);
}

/* Lists the runs that are missing here in the temporary table merge_run, with new numbers after the last one. Numbers
 * rise in both stores, so both orders agree and no sort is needed. */
static status find_runs(sqlite3 *db, struct merged *merged, struct error *error) {
  TRY(sql_execute(db,
                  "CREATE TEMP TABLE merge_run (ours INTEGER PRIMARY KEY, theirs INTEGER NOT NULL);"
                  "INSERT OR FAIL INTO merge_run SELECT (SELECT ifnull(max(run_id), 0) FROM main.run) + row_number() "
                  "OVER (ORDER BY b.run_id), b.run_id FROM other.run b WHERE b.identity NOT IN (SELECT identity FROM "
                  "main.run)",
                  doing, error));
  TRY(sql_integer(db, "SELECT count(*) FROM merge_run", 0, &merged->added, error));
  TRY(sql_integer(db, "SELECT count(*) FROM other.run", 0, &merged->common, error));
  merged->common -= merged->added;
  return STATUS_OK;
}

static const char copying_spectra[] = "copying spectra";

/* Makes the spectrum of a run that was copied from its masses, and refuses the source if it has another one: digests
 * protect the masses only. Columns of `run`: those of copy_spectra(). */
static status copy_spectrum(struct store *store, sqlite3_stmt *run, sqlite3_stmt *rows, size_t *count,
                            struct error *error) {
  const int64_t ours = sqlite3_column_int64(run, 0);
  const struct sums_run sums = {sqlite3_column_int64(run, 2), sqlite3_column_int(run, 3), sqlite3_column_int(run, 4),
                                sqlite3_column_int(run, 5), sqlite3_column_int(run, 6)};
  size_t masses = 0;
  bool same = false;
  TRY(store_take_masses(store, run, 7, &masses, error));
  TRY(store_make_bins(store, masses, count, error));
  TRY(store_compare_bins(store, rows, sqlite3_column_int64(run, 1), *count, &same, copying_spectra, error));
  if (!same)
    return status_fail(error, STATUS_CONTENT,
                       "%s: the spectrum of run %lld is not that of its masses. The source is damaged: restore a copy.",
                       copying_spectra, (long long)ours);
  return store_add_spectrum(store, ours, &sums, *count, error);
}

/* Copies the spectra of the new runs, and adds them to the running sums. (Rebuilding all sums would sort the spectra of
 * all runs: three quarters of the time of a merge.) */
static status copy_spectra(struct store *store, struct error *error) {
  enum { SUMS_AT_ONCE = 200000 }; /* bounds the sums in memory */
  STATEMENT runs = NULL;
  STATEMENT rows = NULL;
  size_t gathered = 0, count = 0;
  TRY(sql_prepare(
      store->db,
      "SELECT m.ours, m.theirs, point_id, results_version, counts, state = 'end-time', surplus, masses FROM "
      "merge_run m CROSS JOIN main.run r ON r.run_id = m.ours LEFT JOIN main.fragment_mass f ON f.run_id = "
      "m.ours ORDER BY m.ours",
      &runs, copying_spectra, error));
  TRY(sql_prepare(store->db, "SELECT bin, count, mass FROM other.spectrum WHERE run_id = ?1 ORDER BY bin", &rows,
                  copying_spectra, error));
  status result = STATUS_OK;
  while (sql_next(runs, &result, copying_spectra, error)) {
    result = copy_spectrum(store, runs, rows, &count, error);
    gathered += 1 + count;
    if (result != STATUS_OK || gathered < SUMS_AT_ONCE)
      continue;
    gathered = 0;
    result = sums_write(&store->sums, store->db, error);
  }
  TRY(result);
  return sums_write(&store->sums, store->db, error);
}

/* Creates result tables of engines that this program lacks from the list of their columns. No SQL text of the other
 * store is run: its names are quoted, and its types are compared with those that a store allows. */
static status make_tables(sqlite3 *db, struct error *error) {
  SQL_TEXT tables = NULL;
  TRY(sql_textf(
      db, &tables, doing, error,
      "SELECT group_concat(format('CREATE TABLE main.\"%%w\" (run_id INTEGER PRIMARY KEY REFERENCES run (run_id)', "
      "t.name) || (SELECT ifnull(group_concat(format(', \"%%w\" %%s', c.name, iif(c.type IN ('REAL', 'INTEGER'), "
      "c.type, 'TEXT')), ''), '') FROM pragma_table_info(t.name, 'other') c WHERE c.name <> 'run_id') || ') STRICT;', "
      "'') FROM other.sqlite_schema t WHERE t.type = 'table' AND t.name GLOB 'result_*' AND t.name NOT IN (SELECT name "
      "FROM main.sqlite_schema)"));
  return sql_execute(db, tables, doing, error);
}

/* Adds columns of results that scenes name themselves. */
static status add_columns(sqlite3 *db, const char *table, struct error *error) {
  SQL_TEXT columns = NULL;
  SQL_TEXT units = NULL;
  TRY(sql_textf(db, &units, doing, error,
                "SELECT ifnull((SELECT column_name FROM main.column_doc a JOIN other.column_doc b USING (table_name, "
                "column_name) WHERE table_name = %Q AND ifnull(a.unit, '1') <> ifnull(b.unit, '1')), '')",
                table));
  if (units && *units)
    return status_fail(error, STATUS_CONTENT, "result '%.100s' has different units in the two stores: keep them apart",
                       units);
  TRY(sql_textf(
      db, &columns, doing, error,
      "SELECT ifnull(group_concat(format('ALTER TABLE main.\"%%w\" ADD COLUMN \"%%w\" REAL;', %Q, name), ''), "
      "'') FROM pragma_table_info(%Q, 'other') WHERE name NOT IN (SELECT name FROM pragma_table_info(%Q, "
      "'main'))",
      table, table, table));
  return sql_execute(db, columns, doing, error);
}

/* Rows of tables that belong to the runs that were copied. */
static status copy_results(sqlite3 *db, struct error *error) {
  STATEMENT tables = NULL;
  status result = sql_prepare(db,
                              "SELECT 'fragment_mass' UNION ALL SELECT 'estimate' UNION ALL SELECT name FROM "
                              "other.sqlite_schema WHERE type = 'table' AND (name GLOB 'result_*' OR name = 'ejecta')",
                              &tables, doing, error);
  while (sql_next(tables, &result, doing, error)) {
    const char *table = sql_text(tables, 0);
    SQL_TEXT columns = NULL;
    TRY(list_columns(db, table, "'run_id'", &columns, error));
    TRY(sql_executef(db, doing, error,
                     "INSERT OR FAIL INTO main.\"%w\" (run_id%s) SELECT m.ours%s FROM merge_run m CROSS JOIN "
                     "other.\"%w\" o ON o.run_id = m.theirs ORDER BY m.ours",
                     table, columns, columns, table));
  }
  return result;
}

/* Copies tables, then rows in the order of their references. The pooled estimates of the points with new runs are stale
 * and go with the old sums. */
static status copy_all(struct store *store, struct error *error) {
  sqlite3 *db = store->db;
  SQL_TEXT columns = NULL;
  TRY(make_tables(db, error));
  for (size_t i = 0; i < engine_count(); i++)
    if (engine_at(i)->of_scene)
      TRY(add_columns(db, schema_result_table(engine_at(i)).name, error));
  TRY(sql_execute(db, merge_parents_sql, doing, error));
  TRY(list_columns(db, "run", "'run_id', 'point_id', 'session_id'", &columns, error));
  TRY(sql_executef(db, doing, error,
                   "INSERT OR FAIL INTO main.run (run_id, point_id, session_id%s) SELECT m.ours, (SELECT ours FROM "
                   "merge_point p WHERE p.theirs = o.point_id), (SELECT ours FROM merge_session s WHERE s.theirs = "
                   "o.session_id)%s FROM merge_run m CROSS JOIN other.run o ON o.run_id = m.theirs ORDER BY m.ours",
                   columns, columns));
  TRY(copy_results(db, error));
  TRY(copy_spectra(store, error));
  TRY(sql_execute(db, merge_rest_sql, doing, error));
  return views_regenerate(db, error);
}

/* For a run in both stores, only the other store may name a fields file, or only the other store's file may exist. */
static status take_paths(struct store *store, const char *way, struct error *error) {
  STATEMENT pairs = NULL;
  const bool digests = sqlite3_table_column_metadata(store->db, "other", "run", "fields_digest", NULL, NULL, NULL, NULL,
                                                     NULL) == SQLITE_OK;
  status result =
      sql_preparef(store->db, &pairs, doing, error,
                   "SELECT a.run_id, a.fields_path, iif(b.fields_path LIKE '/%%', '', ?1) || b.fields_path, %s "
                   "FROM other.run b CROSS JOIN main.run a USING (identity) WHERE b.fields_path IS NOT NULL AND "
                   "a.run_id NOT IN (SELECT ours FROM merge_run) ORDER BY a.run_id",
                   digests ? "b.fields_digest" : "NULL");
  if (result == STATUS_OK)
    sql_bind_text(pairs, 1, way);
  while (sql_next(pairs, &result, doing, error)) {
    const char *theirs = sql_text(pairs, 2);
    const bool here = sqlite3_column_type(pairs, 1) != SQLITE_NULL && paths_readable(store->path, sql_text(pairs, 1));
    if (here || !paths_readable(store->path, theirs))
      continue;
    result = digest_set_fields(store->db, sqlite3_column_int64(pairs, 0), theirs, sql_of_column(pairs, 3), error);
  }
  return result;
}

/* Fields files are not moved: the paths of the added runs are made relative to the folder of this store. */
static status merge_paths(struct store *store, const char *source, const struct merged *merged, struct error *error) {
  OWNED char *followed = paths_followed(source);
  OWNED char *way = paths_between(store->path, followed);
  if (!way)
    return status_fail(error, STATUS_IO, "%s: the path of its folder cannot be resolved", source);
  TRY(sql_executef(
      store->db, doing, error,
      "UPDATE main.run SET fields_path = %Q || fields_path WHERE run_id IN (SELECT ours FROM merge_run) AND "
      "fields_path NOT LIKE '/%%'",
      way));
  return merged->common ? take_paths(store, way, error) : STATUS_OK;
}

/* Copies what is missing, within a transaction that the caller ends. */
static status copy_missing(struct store *store, const char *source, struct merged *merged, int64_t *differing,
                           struct error *error) {
  TRY(find_runs(store->db, merged, error));
  for (int here = 0; here < 2; here++)
    TRY(sql_integerf(store->db, &store->excluded[here], error,
                     "SELECT count(*) FROM other.run b CROSS JOIN main.run a USING (identity) WHERE (a.surplus > 1, "
                     "b.surplus > 1) = (%d, %d)",
                     here, !here));
  if (merged->common) /* Runs of the same identity must have the same bits. A difference comes from another machine or a
                         bug */
    TRY(sql_integer(store->db,
                    "SELECT count(*) FROM other.run b CROSS JOIN main.run a USING (identity) WHERE a.state IS NOT "
                    "b.state OR (SELECT masses FROM main.fragment_mass m WHERE m.run_id = a.run_id) IS NOT (SELECT "
                    "masses FROM other.fragment_mass m WHERE m.run_id = b.run_id)",
                    0, differing, error));
  TRY(copy_all(store, error));
  return merge_paths(store, source, merged, error);
}

/* Where temporary tables are. SQLite drops all that is temporary, so the triggers are made again. */
static status keep_temporary(struct store *store, const char *place, struct error *error) {
  TRY(sql_executef(store->db, doing, error, "PRAGMA temp_store = %s", place));
  return digest_tables_follow(store->db, &store->tables, error);
}

/* Nothing is kept unless everything was copied. */
static status copy_at_once(struct store *store, const char *source, struct merged *merged, int64_t *differing,
                           struct error *error) {
  /* The sums of a million runs are sorted in files, not in memory. */
  TRY(guard_attach(store->db, source, doing, error));
  TRY(keep_temporary(store, "FILE", error));
  TRY(sql_execute(store->db, "BEGIN IMMEDIATE", doing, error));
  status result = copy_missing(store, source, merged, differing, error);
  if (result == STATUS_OK)
    result = digest_tables_write(store->db, &store->tables, error);
  if (result == STATUS_OK)
    result = sql_execute(store->db, "COMMIT", doing, error);
  if (result != STATUS_OK)
    sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL);
  digest_tables_end(&store->tables, result == STATUS_OK);
  return result;
}

/* A hard link is the same store. SQLite would take it for another file, and look for other journals. */
static status check_names(const struct store *store, const char *source, struct error *error) {
  struct stat ours, theirs;
  if (stat(store->path, &ours) != 0 || stat(source, &theirs) != 0 || ours.st_dev != theirs.st_dev ||
      ours.st_ino != theirs.st_ino)
    return STATUS_OK;
  char *one = realpath(store->path, NULL), *other = realpath(source, NULL);
  const bool same = one && other && strcmp(one, other) == 0;
  free(one);
  free(other);
  return same ? STATUS_OK
              : status_fail(error, STATUS_USAGE,
                            "%s is the same store as %s under a second name (a hard link): there is nothing to merge.",
                            source, store->path);
}

static status merge(struct store *store, const char *source, int64_t *added, int64_t *differing, struct error *error) {
  struct merged merged = {0};
  TRY(check_names(store, source, error));
  TRY(store_flush(store, error));
  TRY(inspect(source, error));
  TRY(copy_at_once(store, source, &merged, differing, error));
  *added = merged.added;
  return STATUS_OK;
}

int64_t store_merge_excluded(const struct store *store, bool here) {
  return store->excluded[here];
}

status store_merge(struct store *store, const char *source, int64_t *added, int64_t *differing, struct error *error) {
  *added = 0;
  *differing = 0;
  store->excluded[0] = store->excluded[1] = 0;
  const status result = merge(store, source, added, differing, error);
  sqlite3_exec(store->db,
               "DROP TABLE IF EXISTS temp.merge_point; DROP TABLE IF EXISTS temp.merge_session; DROP TABLE IF EXISTS "
               "temp.merge_run; DETACH other",
               NULL, NULL, NULL);
  const status back = keep_temporary(store, "MEMORY", result == STATUS_OK ? error : NULL);
  if (result != STATUS_OK)
    sums_forget(&store->sums);
  identities_clear(&store->identities); /* they are read again at the next use */
  store->identities_loaded = false;
  store->lowest_bin = 1; /* the same of table bin: none is known to be covered */
  store->highest_bin = 0;
  return result == STATUS_OK ? back : result;
}
