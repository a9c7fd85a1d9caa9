/* What may change after a run is stored: its estimates, and whether it is part of the statistics. */
#include <stdlib.h>

#include "db/schema.h"
#include "db/store/internal.h"

static const char writing[] = "writing estimates";

static status prepare(struct store *store, struct error *error) {
  if (store->estimate) return STATUS_OK;
  if (!store->estimate_table)
    return status_fail(error, STATUS_INTERNAL, "%s: estimates came, but the store was opened without their table",
                       store->path);
  char *sql = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&sql, &size);
  if (!out) return status_fail(error, STATUS_MEMORY, "%s: memory ran out", writing);
  fputs("INSERT INTO estimate (point_id, run_id, results_version, ordinal", out);
  for (size_t i = 0; i < store->estimate_table->count; i++) {
    char name[SCHEMA_NAME_SIZE];
    sql_column_name(store->estimate_table->rows[i].path, name, sizeof name);
    fprintf(out, ", \"%s\"", name);
  }
  fputs(") VALUES (?, ?, ?, ?", out);
  for (size_t i = 0; i < store->estimate_table->count; i++)
    fputs(", ?", out);
  fputs(")", out);
  fclose(out);
  status result = sql ? sql_prepare(store->db, sql, &store->estimate, writing, error)
                      : status_fail(error, STATUS_MEMORY, "%s: memory ran out", writing);
  free(sql);
  return result;
}

status store_set_estimates_rows(struct store *store, int64_t point_id, int64_t run_id, int results_version,
                                size_t count, const void *rows, struct error *error) {
  status result = prepare(store, error);
  for (size_t i = 0; result == STATUS_OK && i < count; i++) {
    const struct field_table *table = store->estimate_table;
    const void *object = (const char *)rows + i * table->size;
    sqlite3_bind_int64(store->estimate, 1, point_id);
    if (run_id > 0)
      sqlite3_bind_int64(store->estimate, 2, run_id);
    else
      sqlite3_bind_null(store->estimate, 2);
    sqlite3_bind_int(store->estimate, 3, results_version);
    sqlite3_bind_int64(store->estimate, 4, (int64_t)i);
    for (size_t k = 0; k < table->count; k++)
      sql_bind_field(store->estimate, 5 + (int)k, &table->rows[k], object, false);
    result = sql_run(store->estimate, writing, error);
  }
  return result;
}

status store_set_estimates(struct store *store, int64_t point_id, int64_t run_id, int results_version, size_t count,
                           const void *rows, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK) return result;
  if (run_id > 0)
    result = sql_executef(store->db, writing, error, "DELETE FROM estimate WHERE run_id = %lld", (long long)run_id);
  else
    result = sql_executef(store->db, writing, error,
                          "DELETE FROM estimate WHERE run_id IS NULL AND point_id = %lld AND results_version = %d",
                          (long long)point_id, results_version);
  if (result == STATUS_OK)
    result = store_set_estimates_rows(store, point_id, run_id, results_version, count, rows, error);
  return store_end(store, result, 1, error);
}

status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error) {
  static const char doing[] = "moving a stopping prefix";
  status result = store_begin(store, error);
  if (result != STATUS_OK) return result;
  result = sums_write(&store->sums, store->db, error);
  if (result == STATUS_OK)
    result =
        sql_executef(store->db, doing, error,
                     "UPDATE run SET surplus = replicate >= %lld WHERE point_id = %lld AND surplus <> (replicate >= "
                     "%lld)",
                     (long long)prefix, (long long)point_id, (long long)prefix);
  if (result == STATUS_OK && sqlite3_changes64(store->db) > 0) result = sums_rebuild(store->db, point_id, error);
  return store_end(store, result, 1, error);
}

status store_set_fields(struct store *store, const uint8_t identity[16], const char *fields_path, struct error *error) {
  static const char doing[] = "noting a fields file";
  sqlite3_stmt *statement = NULL;
  status result = store_begin(store, error);
  if (result != STATUS_OK) return result;
  result = sql_prepare(store->db, "UPDATE run SET fields_path = ?2 WHERE identity = ?1", &statement, doing, error);
  if (result == STATUS_OK) {
    sqlite3_bind_blob(statement, 1, identity, 16, SQLITE_STATIC);
    if (fields_path) sqlite3_bind_text(statement, 2, fields_path, -1, SQLITE_STATIC);
    result = sql_run(statement, doing, error);
    if (result == STATUS_OK && sqlite3_changes(store->db) == 0)
      result = status_fail(error, STATUS_INTERNAL, "%s: no such run is stored", doing);
  }
  sqlite3_finalize(statement);
  return store_end(store, result, 1, error);
}
