/* Changes after runs are stored: estimates, the part in the statistics, fields files, studies of convergence. */
#include <stdlib.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "schemas/text.h"

static const char writing[] = "writing estimates";

/* The key of an estimate. The estimates of a run have no results_version. */
struct estimate_key {
  int64_t owner, ordinal;
  int results_version;
};
#define KEY(name_, kind_, member_)                                                                                     \
  { name_, SQL_COLUMN_##kind_, offsetof(struct estimate_key, member_) }
static const struct sql_column of_run[] = {KEY("run_id", INTEGER, owner), KEY("ordinal", INTEGER, ordinal)};
static const struct sql_column of_point[] = {KEY("point_id", INTEGER, owner),
                                             KEY("results_version", INT, results_version),
                                             KEY("ordinal", INTEGER, ordinal)};

/* One statement inserts all rows of a run: every run has the same number of them. */
status store_set_estimates_rows(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                                struct error *error) {
  TRY(sql_insert_prepare(store->db, &store->estimate, "estimate", 2, of_run, &estimates_table, count, writing, error));
  for (size_t i = 0; i < count; i++)
    sql_insert_bind(&store->estimate, i, &(struct estimate_key){.owner = run_id, .ordinal = (int64_t)i}, &rows[i]);
  return sql_run(store->estimate.statement, writing, error);
}

static status set_of_run(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                         struct error *error) {
  TRY(sql_executef(store->db, writing, error, "DELETE FROM estimate WHERE run_id = %lld", (long long)run_id));
  if (count)
    TRY(store_set_estimates_rows(store, run_id, count, rows, error));
  return digest_rows_fill(store->db, run_id, error);
}

status store_insert_estimates(sqlite3 *db, const char *table, int64_t point_id, int64_t results_version, size_t count,
                              const struct estimate *rows, struct error *error) {
  struct sql_insert insert = {0};
  TRY(sql_insert_prepare(db, &insert, table, 3, of_point, &estimates_table, 1, writing, error));
  STATEMENT statement = insert.statement;
  for (size_t i = 0; i < count; i++) {
    const struct estimate_key key = {point_id, (int64_t)i, (int)results_version};
    sql_insert_bind(&insert, 0, &key, &rows[i]);
    TRY(sql_run(statement, writing, error));
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

status store_set_estimates(struct store *store, int64_t point_id, int64_t run_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store,
                   run_id > 0 ? set_of_run(store, run_id, count, rows, error)
                              : set_of_point(store, point_id, results_version, count, rows, error),
                   1, error);
}

/* Replicates from `prefix` on become surplus. */
static status set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  static const char doing[] = "moving a stopping prefix";
  char *counts = NULL, inside[64];
  size_t size = 0;
  FILE *out = text_open(&counts, &size);
  TRY(sums_write(&store->sums, store->db, error));
  snprintf(inside, sizeof inside, "surplus < 2 AND replicate < %lld", (long long)prefix);
  if (out)
    schema_write_counts(inside, out);
  if (!out || !text_close(out, &counts))
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  const status
      result = sql_executef(store->db, doing, error,
                            "UPDATE run SET surplus = (surplus & 2) + (replicate >= %lld), counts = %s WHERE point_id "
                            "= %lld AND surplus & 1 <> (replicate >= %lld)",
                            (long long)prefix, counts, (long long)point_id, (long long)prefix);
  free(counts);
  TRY(result);
  return sqlite3_changes64(store->db) > 0 ? sums_rebuild(store->db, point_id, error) : STATUS_OK;
}

status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, set_prefix(store, point_id, prefix, error), 1, error);
}

/* ---- runs that a person excludes ---- */

static const char excluding[] = "excluding a run";

/* SQL of `counts` of a run that is excluded no more; sqlite3_free() frees it. NULL: no memory. */
static char *counts_again(void) {
  char *counts = NULL, *sql = NULL;
  size_t size = 0;
  FILE *out = text_open(&counts, &size);
  if (out)
    schema_write_counts("surplus & 1 = 0", out);
  if (out && text_close(out, &counts))
    sql = sqlite3_mprintf("surplus = surplus & 1, counts = (%s), excluded = NULL, excluded_at = NULL", counts);
  free(counts);
  return sql;
}

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
  if (!reason && surplus < 2)
    return status_fail(error, STATUS_USAGE, "run %lld is not excluded; `clast exclude %s` lists those that are", run,
                       store->path);
  SQL_TEXT change = NULL;
  change = reason ? sqlite3_mprintf("surplus = surplus | 2, counts = 0, excluded = %Q, excluded_at = "
                                    "strftime('%%Y-%%m-%%dT%%H:%%M:%%SZ', 'now')",
                                    reason)
                  : counts_again();
  if (!change)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", excluding);
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

struct level_key {
  int64_t base_point_id, level, point_id;
  int results_version;
};
#define LEVEL(name_, kind_, member_)                                                                                   \
  { name_, SQL_COLUMN_##kind_, offsetof(struct level_key, member_) }
static const struct sql_column of_level[] = {LEVEL("base_point_id", INTEGER, base_point_id),
                                             LEVEL("results_version", INT, results_version),
                                             LEVEL("level", INTEGER, level), LEVEL("point_id", INTEGER, point_id)};
enum { LEVEL_COLUMNS = 4, LIMIT_COLUMNS = 2 }; /* of a limit: the first two */

/* Replaces the rows that `where` selects, those of the knob and quantity of this scene, in a table: by `count` rows of
 * `size` bytes that `fields` describes. */
static status replace_rows(struct store *store, const struct store_convergence *study, const char *where,
                           const char *table, size_t columns, const struct field_table *fields, size_t count,
                           size_t size, const void *rows, struct error *error) {
  struct sql_insert insert = {0};
  TRY(sql_executef(store->db, writing_study, error, "DELETE FROM \"%w\" WHERE %s", table, where));
  TRY(sql_insert_prepare(store->db, &insert, table, columns, of_level, fields, 1, writing_study, error));
  STATEMENT statement = insert.statement;
  for (size_t i = 0; i < count; i++) {
    const struct level_key key = {study->base_point_id, (int64_t)i, study->count ? study->point_ids[i] : 0,
                                  study->results_version};
    sql_insert_bind(&insert, 0, &key, (const char *)rows + i * size);
    TRY(sql_run(statement, writing_study, error));
  }
  return STATUS_OK;
}

static status replace_study(struct store *store, const struct store_convergence *study, struct error *error) {
  SQL_TEXT where = sqlite3_mprintf("base_point_id = %lld AND results_version = %d AND knob = %Q AND quantity = %Q",
                                   (long long)study->base_point_id, study->results_version, study->limit->knob,
                                   study->limit->quantity);
  if (!where)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", writing_study);
  TRY(replace_rows(store, study, where, "convergence", LEVEL_COLUMNS, &convergence_table, study->count,
                   sizeof *study->rows, study->rows, error));
  return replace_rows(store, study, where, "convergence_limit", LIMIT_COLUMNS, &convergence_limit_table, 1, 0,
                      study->limit, error);
}

status store_set_convergence(struct store *store, const struct store_convergence *study, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, replace_study(store, study, error), (int)study->count + 1, error);
}
