/* Changes after runs are stored: estimates, the part in the statistics, fields files, studies of convergence. */

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/memory.h"

static const char writing[] = "writing estimates";

/* One statement inserts all rows of a run: every run has the same number of them. */
status store_set_estimates_rows(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                                struct error *error) {
  if (store->estimate_rows != count) {
    sqlite3_finalize(store->estimate);
    store->estimate = NULL;
  }
  store->estimate_rows = count;
  TRY(sql_prepare_insert(store->db, &store->estimate, "estimate", "run_id, ordinal", &estimates_table, count, writing,
                         error));
  int at = 1;
  for (size_t i = 0; i < count; i++) {
    sql_bind(store->estimate, at++, sql_of_integer(run_id));
    sql_bind(store->estimate, at++, sql_of_integer((int64_t)i));
    at = sql_bind_fields(store->estimate, at, &estimates_table, &rows[i]);
  }
  return sql_run(store->estimate, writing, error);
}

status store_insert_estimates(sqlite3 *db, const char *table, int64_t point_id, int64_t results_version, size_t count,
                              const struct estimate *rows, struct error *error) {
  STATEMENT insert = NULL;
  TRY(sql_prepare_insert(db, &insert, table, "point_id, results_version, ordinal", &estimates_table, 1, writing,
                         error));
  for (size_t i = 0; i < count; i++) {
    const int behind = SQL_BIND(insert, sql_of_integer(point_id), sql_of_integer(results_version),
                                sql_of_integer((int64_t)i));
    sql_bind_fields(insert, behind, &estimates_table, &rows[i]);
    TRY(sql_run(insert, writing, error));
  }
  return STATUS_OK;
}

static status set_of_point(struct store *store, int64_t point_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error) {
  TRY(sql_executef(store->db, writing, error,
                   "DELETE FROM point_estimate WHERE point_id = %lld AND results_version = %d", (long long)point_id,
                   results_version));
  return store_insert_estimates(store->db, "point_estimate", point_id, results_version, count, rows, error);
}

status store_set_estimates(struct store *store, int64_t point_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, set_of_point(store, point_id, results_version, count, rows, error), 1, error);
}

/* SQL of `counts`, which the caller frees. */
static char *counts_of(const char *not_surplus) {
  char *counts = NULL;
  FILE *out = text_open(&counts);
  schema_write_counts(not_surplus, out);
  return text_close_small(out, &counts);
}

/* Replicates from `prefix` on become surplus. */
static status set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  static const char doing[] = "moving a stopping prefix";
  char inside[64];
  TRY(sums_write(&store->sums, store->db, error));
  snprintf(inside, sizeof inside, "surplus < 2 AND replicate < %lld", (long long)prefix);
  OWNED char *counts = counts_of(inside);
  TRY(sql_executef(
      store->db, doing, error,
      "UPDATE run SET surplus = (surplus & 2) + (replicate >= %lld), counts = %s WHERE point_id = %lld AND "
      "surplus & 1 <> (replicate >= %lld)",
      (long long)prefix, counts, (long long)point_id, (long long)prefix));
  return sqlite3_changes64(store->db) > 0 ? sums_rebuild(store->db, point_id, error) : STATUS_OK;
}

status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, set_prefix(store, point_id, prefix, error), 1, error);
}

/* ---- runs that a person excludes ---- */

static const char excluding[] = "excluding a run";

static status exclude(struct store *store, int64_t run_id, const char *reason, struct error *error) {
  const long long run = run_id;
  int64_t point = 0, last = 0, surplus = 0;
  TRY(sums_write(&store->sums, store->db, error));
  TRY(sql_integerf(store->db, &point, error, "SELECT ifnull(max(point_id), 0) FROM run WHERE run_id = %lld", run));
  TRY(sql_integer(store->db, "SELECT ifnull(max(run_id), 0) FROM run", 0, &last, error));
  if (point == 0)
    return status_fail(error, STATUS_USAGE,
                       "there is no run %lld: the last run of %s is %lld (run_id in the view runs)", run, store->path,
                       (long long)last);
  TRY(sql_integerf(store->db, &surplus, error, "SELECT surplus FROM run WHERE run_id = %lld", run));
  char word[TEXT_WORD];
  if (!reason && surplus < 2)
    return status_fail(error, STATUS_USAGE, "run %lld is not excluded; `clast exclude %s` lists those that are", run,
                       text_word(store->path, word));
  OWNED char *counts = counts_of("surplus & 1 = 0");
  SQL_TEXT change = reason ? sql_format("surplus = surplus | 2, counts = 0, excluded = %Q, excluded_at = "
                                        "strftime('%%Y-%%m-%%dT%%H:%%M:%%SZ', 'now')",
                                        reason)
                           : sql_format("surplus = surplus & 1, counts = (%s), excluded = NULL, excluded_at = NULL",
                                        counts);
  TRY(sql_executef(store->db, excluding, error, "UPDATE run SET %s WHERE run_id = %lld", change, run));
  return sums_rebuild(store->db, point, error);
}

status store_exclude(struct store *store, int64_t run_id, const char *reason, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, exclude(store, run_id, reason, error), 1, error);
}

static status set_fields(struct store *store, const uint8_t identity[16], const char *fields_path,
                         const char *fields_digest, struct error *error) {
  static const char doing[] = "noting a fields file";
  STATEMENT run = NULL;
  status result = sql_prepare(store->db, "SELECT run_id FROM run WHERE identity = ?1", &run, doing, error);
  sqlite3_bind_blob(run, 1, identity, 16, SQLITE_STATIC);
  if (sql_next(run, &result, doing, error))
    return digest_set_fields(store->db, sqlite3_column_int64(run, 0), fields_path,
                             fields_digest ? sql_of_text(fields_digest) : (struct sql_value){.type = SQLITE_NULL},
                             error);
  return result != STATUS_OK ? result : status_fail(error, STATUS_INTERNAL, "%s: no such run is stored", doing);
}

status store_set_fields(struct store *store, const uint8_t identity[16], const char *fields_path,
                        const char *fields_digest, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, set_fields(store, identity, fields_path, fields_digest, error), 1, error);
}

/* ---- studies of convergence ---- */

static const char writing_study[] = "writing a study of convergence";

/* Replaces the rows of the knob and quantity of this scene. */
static status replace_study(struct store *store, const struct store_convergence *study, struct error *error) {
  STATEMENT levels = NULL;
  STATEMENT limit = NULL;
  SQL_TEXT where = sql_format("base_point_id = %lld AND results_version = %d AND knob = %Q AND quantity = %Q",
                              (long long)study->base_point_id, study->results_version, study->limit->knob,
                              study->limit->quantity);
  TRY(sql_executef(store->db, writing_study, error,
                   "DELETE FROM convergence WHERE %s; DELETE FROM convergence_limit WHERE %s", where, where));
  TRY(sql_prepare_insert(store->db, &levels, "convergence", "base_point_id, results_version, level, point_id",
                         &convergence_table, 1, writing_study, error));
  for (size_t i = 0; i < study->count; i++) {
    const int behind = SQL_BIND(levels, sql_of_integer(study->base_point_id), sql_of_integer(study->results_version),
                                sql_of_integer((int64_t)i), sql_of_integer(study->point_ids[i]));
    sql_bind_fields(levels, behind, &convergence_table, &study->rows[i]);
    TRY(sql_run(levels, writing_study, error));
  }
  TRY(sql_prepare_insert(store->db, &limit, "convergence_limit", "base_point_id, results_version",
                         &convergence_limit_table, 1, writing_study, error));
  const int behind = SQL_BIND(limit, sql_of_integer(study->base_point_id), sql_of_integer(study->results_version));
  sql_bind_fields(limit, behind, &convergence_limit_table, study->limit);
  return sql_run(limit, writing_study, error);
}

status store_set_convergence(struct store *store, const struct store_convergence *study, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, replace_study(store, study, error), (int)study->count + 1, error);
}

status store_rank_convergence(struct store *store, struct error *error) {
  OWNED char *rank = NULL;
  FILE *out = text_open(&rank);
  views_resolution_parts(out);
  fputs("UPDATE convergence AS c SET error = t.half_width FROM convergence l LEFT JOIN told t\n"
        "  USING (point_id, results_version, quantity) WHERE (l.base_point_id, l.results_version,\n"
        "    l.knob, l.quantity, l.level) = (c.base_point_id, c.results_version, c.knob, c.quantity, c.level);\n"
        "UPDATE convergence AS c SET frontier = ifnull(cpu + error < 9e999, 0) AND NOT EXISTS (SELECT 1 FROM "
        "convergence o\n"
        "  WHERE (o.base_point_id, o.results_version, o.quantity) = (c.base_point_id, c.results_version, c.quantity)\n"
        "    AND o.error <= c.error AND o.cpu <= c.cpu AND (o.error < c.error OR o.cpu < c.cpu))",
        out);
  text_close_small(out, &rank);
  TRY(store_begin(store, error));
  const status code = sql_execute(store->db, rank, writing_study, error);
  return store_end(store, code, 1, error);
}
