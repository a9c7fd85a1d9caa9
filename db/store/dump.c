/* The deterministic content of a store as text, to compare two stores of the same campaign: sorted by identity, doubles
 * in hexadecimal. */
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

static const char doing[] = "writing the deterministic content";

static void print_value(FILE *out, sqlite3_stmt *row, int column) {
  switch (sqlite3_column_type(row, column)) {
  case SQLITE_INTEGER: fprintf(out, "%lld", (long long)sqlite3_column_int64(row, column)); break;
  case SQLITE_FLOAT: fprintf(out, "%a", sqlite3_column_double(row, column)); break;
  case SQLITE_TEXT: fprintf(out, "'%s'", (const char *)sqlite3_column_text(row, column)); break;
  case SQLITE_BLOB: {
    const unsigned char *bytes = sqlite3_column_blob(row, column);
    for (int i = 0; i < sqlite3_column_bytes(row, column); i++)
      fprintf(out, "%02x", bytes[i]);
    break;
  }
  default: fputs("null", out);
  }
}

/* Each row as ` name=value` pairs on one line that begins with `head`. Parameter 1, if any, is run_id. */
static status print_rows(sqlite3 *db, const char *sql, int64_t run_id, const char *head, FILE *out,
                         struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(db, sql, &statement, doing, error);
  if (result != STATUS_OK)
    return result;
  if (sqlite3_bind_parameter_count(statement))
    sqlite3_bind_int64(statement, 1, run_id);
  int code;
  while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
    fputs(head, out);
    for (int i = 0; i < sqlite3_column_count(statement); i++) {
      fprintf(out, " %s=", sqlite3_column_name(statement, i));
      print_value(out, statement, i);
    }
    fputc('\n', out);
  }
  if (code != SQLITE_DONE)
    result = sql_fail(db, code, doing, error);
  sqlite3_finalize(statement);
  return result;
}

/* The deterministic columns of a table, each with a comma before it. sqlite3_free() it. */
static char *list_columns(sqlite3 *db, const char *table) {
  return sql_name_list(
      db, "SELECT column_name FROM column_doc WHERE table_name = ?1 AND deterministic ORDER BY column_name", table,
      NULL);
}

/* SELECT `before` and the deterministic columns of `table` for one run. */
static status print_columns(sqlite3 *db, const char *table, const char *before, const char *after, int64_t run_id,
                            const char *head, FILE *out, struct error *error) {
  char *columns = list_columns(db, table);
  if (!columns)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  const char *list = columns; /* begins with a comma */
  if (!*before)
    list = *columns ? columns + 2 : "NULL";
  char *sql = sqlite3_mprintf("SELECT %s%s FROM \"%w\" %s", before, list, table, after);
  sqlite3_free(columns);
  if (!sql)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  status result = print_rows(db, sql, run_id, head, out, error);
  sqlite3_free(sql);
  return result;
}

static status print_run(sqlite3 *db, int64_t run_id, const char *engine, FILE *out, struct error *error) {
  char table[SCHEMA_NAME_SIZE];
  snprintf(table, sizeof table, "result_%s", engine);
  status result =
      print_columns(db, "run",
                    "hex(identity) AS identity, (SELECT hex(hash) FROM point p WHERE p.point_id = run.point_id) "
                    "AS point, replicate, seed, results_version",
                    "WHERE run_id = ?1", run_id, "run", out, error);
  if (result != STATUS_OK)
    return result;
  result = print_columns(db, table, "", "WHERE run_id = ?1", run_id, " result", out, error);
  if (result != STATUS_OK)
    return result;
  result = print_rows(db, "SELECT masses FROM fragment_mass WHERE run_id = ?1", run_id, " fragments", out, error);
  if (result != STATUS_OK)
    return result;
  result = print_rows(db, "SELECT bin, count, mass FROM spectrum WHERE run_id = ?1 ORDER BY bin", run_id, " spectrum",
                      out, error);
  if (result != STATUS_OK)
    return result;
  return print_columns(db, "estimate", "ordinal", "WHERE run_id = ?1 ORDER BY ordinal", run_id, " estimate", out,
                       error);
}

status store_dump(struct store *store, FILE *out, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = print_rows(store->db, "SELECT hex(hash) AS hash, engine, scene FROM point ORDER BY hash", 0, "point",
                             out, error);
  if (result != STATUS_OK)
    return result;
  result = sql_prepare(store->db,
                       "SELECT run_id, engine FROM run JOIN point USING (point_id) WHERE surplus = 0 ORDER BY identity",
                       &statement, doing, error);
  int code = SQLITE_DONE;
  while (result == STATUS_OK && (code = sqlite3_step(statement)) == SQLITE_ROW)
    result = print_run(store->db, sqlite3_column_int64(statement, 0), (const char *)sqlite3_column_text(statement, 1),
                       out, error);
  if (result == STATUS_OK && code != SQLITE_DONE)
    result = sql_fail(store->db, code, doing, error);
  sqlite3_finalize(statement);
  if (result == STATUS_OK && ferror(out))
    result = status_fail(error, STATUS_IO, "%s failed", doing);
  return result;
}
