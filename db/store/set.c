/* What may change after a run is stored: its estimates, and whether it is part of the statistics. */
#include <stdlib.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

static const char writing[] = "writing estimates";

/* INSERT of `key` columns and the estimate's own, `rows` rows at once. */
static status prepare(struct store *store, sqlite3_stmt **statement, const char *table, const char *key, size_t rows,
                      struct error *error) {
  if (*statement)
    return STATUS_OK;
  char *sql = NULL;
  size_t size = 0, columns = estimates_table.count + 1;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", writing);
  for (const char *c = key; *c; c++)
    columns += *c == ',';
  fprintf(out, "INSERT INTO %s (%s", table, key);
  for (size_t i = 0; i < estimates_table.count; i++) {
    char name[SCHEMA_NAME_SIZE];
    field_column_name(estimates_table.rows[i].path, name, sizeof name);
    fprintf(out, ", \"%s\"", name);
  }
  fputs(") VALUES ", out);
  for (size_t row = 0; row < rows; row++)
    for (size_t i = 0; i < columns; i++)
      fputs(i ? ", ?" : row ? "), (?" : "(?", out);
  fputs(")", out);
  fclose(out);
  status result = sql ? sql_prepare(store->db, sql, statement, writing, error)
                      : status_fail(error, STATUS_MEMORY, "%s: memory ran out", writing);
  free(sql);
  return result;
}

static void bind_estimate(sqlite3_stmt *statement, int index, const struct estimate *estimate) {
  for (size_t k = 0; k < estimates_table.count; k++)
    sql_bind_field(statement, index + (int)k, &estimates_table.rows[k], estimate, false);
}

/* All rows of a run go in with one statement: every run has the same number of them. */
status store_set_estimates_rows(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                                struct error *error) {
  if (store->estimate && store->estimate_rows != count) {
    sqlite3_finalize(store->estimate);
    store->estimate = NULL;
  }
  status result = prepare(store, &store->estimate, "estimate", "run_id, ordinal", count, error);
  if (result != STATUS_OK)
    return result;
  store->estimate_rows = count;
  for (size_t i = 0; i < count; i++) {
    int index = 1 + (int)(i * (2 + estimates_table.count));
    sqlite3_bind_int64(store->estimate, index, run_id);
    sqlite3_bind_int64(store->estimate, index + 1, (int64_t)i);
    bind_estimate(store->estimate, index + 2, &rows[i]);
  }
  return sql_run(store->estimate, writing, error);
}

static status add_point_estimates(struct store *store, int64_t point_id, int results_version, size_t count,
                                  const struct estimate *rows, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = prepare(store, &statement, "point_estimate", "point_id, results_version, ordinal", 1, error);
  for (size_t i = 0; result == STATUS_OK && i < count; i++) {
    sqlite3_bind_int64(statement, 1, point_id);
    sqlite3_bind_int(statement, 2, results_version);
    sqlite3_bind_int64(statement, 3, (int64_t)i);
    bind_estimate(statement, 4, &rows[i]);
    result = sql_run(statement, writing, error);
  }
  sqlite3_finalize(statement);
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
  } else {
    result = sql_executef(store->db, writing, error,
                          "DELETE FROM point_estimate WHERE point_id = %lld AND results_version = %d",
                          (long long)point_id, results_version);
    if (result == STATUS_OK)
      result = add_point_estimates(store, point_id, results_version, count, rows, error);
  }
  return store_end(store, result, 1, error);
}

/* UPDATE that makes replicates from `prefix` on surplus. malloc'd; NULL when out of memory. */
static char *prefix_sql(int64_t point_id, int64_t prefix) {
  char *sql = NULL, inside[64];
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return NULL;
  snprintf(inside, sizeof inside, "replicate < %lld", (long long)prefix);
  fprintf(out, "UPDATE run SET surplus = replicate >= %lld, counts = ", (long long)prefix);
  schema_write_counts(inside, out);
  fprintf(out, " WHERE point_id = %lld AND surplus <> (replicate >= %lld)", (long long)point_id, (long long)prefix);
  fclose(out);
  return sql;
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
