/* Changes after a run is stored: its estimates, its part in the statistics, its fields file. */
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
  status result = sql_insert_prepare(store->db, &store->estimate, "estimate", 2, of_run, &estimates_table, count,
                                     writing, error);
  if (result != STATUS_OK)
    return result;
  for (size_t i = 0; i < count; i++)
    sql_insert_bind(&store->estimate, i, &(struct estimate_key){.owner = run_id, .ordinal = (int64_t)i}, &rows[i]);
  return sql_run(store->estimate.statement, writing, error);
}

static status add_point_estimates(struct store *store, int64_t point_id, int results_version, size_t count,
                                  const struct estimate *rows, struct error *error) {
  struct sql_insert insert = {0};
  status result = sql_insert_prepare(store->db, &insert, "point_estimate", 3, of_point, &estimates_table, 1, writing,
                                     error);
  for (size_t i = 0; result == STATUS_OK && i < count; i++) {
    const struct estimate_key key = {point_id, (int64_t)i, results_version};
    sql_insert_bind(&insert, 0, &key, &rows[i]);
    result = sql_run(insert.statement, writing, error);
  }
  sqlite3_finalize(insert.statement);
  return result;
}

status store_set_estimates(struct store *store, int64_t point_id, int64_t run_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  if (run_id > 0) {
    result = sql_executef(store->db, writing, error, "DELETE FROM estimate WHERE run_id = %lld", (long long)run_id);
    if (result == STATUS_OK && count)
      result = store_set_estimates_rows(store, run_id, count, rows, error);
    if (result == STATUS_OK)
      result = digest_rows_fill(store->db, DIGEST_RUNS, run_id, error);
  } else {
    result = sql_executef(store->db, writing, error,
                          "DELETE FROM point_estimate WHERE point_id = %lld AND results_version = %d",
                          (long long)point_id, results_version);
    if (result == STATUS_OK)
      result = add_point_estimates(store, point_id, results_version, count, rows, error);
  }
  return store_end(store, result, 1, error);
}

/* UPDATE that makes replicates from `prefix` on surplus. The caller frees it; NULL when memory ran out. */
static char *prefix_sql(int64_t point_id, int64_t prefix) {
  char *sql = NULL, inside[64];
  size_t size = 0;
  FILE *out = text_open(&sql, &size);
  if (!out)
    return NULL;
  snprintf(inside, sizeof inside, "replicate < %lld", (long long)prefix);
  fprintf(out, "UPDATE run SET surplus = replicate >= %lld, counts = ", (long long)prefix);
  schema_write_counts(inside, out);
  fprintf(out, " WHERE point_id = %lld AND surplus <> (replicate >= %lld)", (long long)point_id, (long long)prefix);
  return text_close(out, &sql);
}

status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  static const char doing[] = "moving a stopping prefix";
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  char *sql = prefix_sql(point_id, prefix);
  result = sql ? sums_write(&store->sums, store->db, error)
               : status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  if (result == STATUS_OK)
    result = sql_execute(store->db, sql, doing, error);
  if (result == STATUS_OK && sqlite3_changes64(store->db) > 0)
    result = sums_rebuild(store->db, point_id, error);
  free(sql);
  return store_end(store, result, 1, error);
}

status store_set_fields(struct store *store, const uint8_t identity[16], const char *fields_path, struct error *error) {
  static const char doing[] = "noting a fields file";
  sqlite3_stmt *statement = NULL;
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = sql_prepare(store->db, "UPDATE run SET fields_path = ?2 WHERE identity = ?1", &statement, doing, error);
  if (result == STATUS_OK) {
    sqlite3_bind_blob(statement, 1, identity, 16, SQLITE_STATIC);
    if (fields_path)
      sqlite3_bind_text(statement, 2, fields_path, -1, SQLITE_STATIC);
    result = sql_run(statement, doing, error);
    if (result == STATUS_OK && sqlite3_changes(store->db) == 0)
      result = status_fail(error, STATUS_INTERNAL, "%s: no such run is stored", doing);
  }
  sqlite3_finalize(statement);
  return store_end(store, result, 1, error);
}
