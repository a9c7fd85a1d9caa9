/* The deterministic content of a store as text, to compare two stores of the same campaign: sorted by identity, doubles
 * in hexadecimal. */
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

static const char doing[] = "writing the deterministic content";

static void print_bytes(FILE *out, const unsigned char *bytes, int size) {
  static const char digits[] = "0123456789abcdef";
  char text[1024];
  size_t used = 0;
  for (int i = 0; i < size; i++) {
    text[used++] = digits[bytes[i] >> 4];
    text[used++] = digits[bytes[i] & 15];
    if (used == sizeof text) {
      fwrite_unlocked(text, 1, used, out);
      used = 0;
    }
  }
  fwrite_unlocked(text, 1, used, out);
}

static void print_integer(FILE *out, int64_t value) {
  char text[24];
  size_t at = sizeof text;
  uint64_t left = value < 0 ? -(uint64_t)value : (uint64_t)value;
  do
    text[--at] = (char)('0' + left % 10);
  while ((left /= 10) > 0);
  if (value < 0)
    text[--at] = '-';
  fwrite_unlocked(text + at, 1, sizeof text - at, out);
}

static void print_value(FILE *out, sqlite3_stmt *row, int column) {
  switch (sqlite3_column_type(row, column)) {
  case SQLITE_INTEGER: print_integer(out, sqlite3_column_int64(row, column)); break;
  case SQLITE_FLOAT: fprintf(out, "%a", sqlite3_column_double(row, column)); break;
  case SQLITE_TEXT: fprintf(out, "'%s'", (const char *)sqlite3_column_text(row, column)); break;
  case SQLITE_BLOB: {
    const unsigned char *bytes = sqlite3_column_blob(row, column);
    print_bytes(out, bytes, sqlite3_column_bytes(row, column));
    break;
  }
  default: fputs_unlocked("null", out);
  }
}

/* Each row as ` name=value` pairs on one line that begins with `head`. Parameter 1, if any, is run_id. The statement is
 * left ready for another run. */
static status print_rows(sqlite3 *db, sqlite3_stmt *statement, int64_t run_id, const char *head, FILE *out,
                         struct error *error) {
  if (sqlite3_bind_parameter_count(statement))
    sqlite3_bind_int64(statement, 1, run_id);
  const int columns = sqlite3_column_count(statement);
  int code;
  while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
    fputs_unlocked(head, out);
    for (int i = 0; i < columns; i++) {
      putc_unlocked(' ', out);
      fputs_unlocked(sqlite3_column_name(statement, i), out);
      putc_unlocked('=', out);
      print_value(out, statement, i);
    }
    putc_unlocked('\n', out);
  }
  sqlite3_reset(statement);
  return code == SQLITE_DONE ? STATUS_OK : sql_fail(db, code, doing, error);
}

/* The deterministic columns of a table, each with a comma before it. sqlite3_free() it. */
static char *list_columns(sqlite3 *db, const char *table) {
  return sql_name_list(
      db, "SELECT column_name FROM column_doc WHERE table_name = ?1 AND deterministic ORDER BY column_name", table,
      NULL);
}

/* SELECT `before` and the deterministic columns of `table` for one run. */
static status prepare_columns(sqlite3 *db, const char *table, const char *before, const char *after,
                              sqlite3_stmt **statement, struct error *error) {
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
  status result = sql_prepare(db, sql, statement, doing, error);
  sqlite3_free(sql);
  return result;
}

/* The questions about one run, prepared once. */
struct dump {
  sqlite3 *db;
  FILE *out;
  sqlite3_stmt *run, *masses, *spectrum, *estimates;
  struct {
    char engine[SCHEMA_NAME_SIZE];
    sqlite3_stmt *statement;
  } results[STORE_KINDS];
  size_t result_count;
};

static status prepare(struct dump *dump, struct error *error) {
  status result = prepare_columns(dump->db, "run",
                                  "hex(identity) AS identity, (SELECT hex(hash) FROM point p WHERE p.point_id = "
                                  "run.point_id) AS point, replicate, seed, results_version",
                                  "WHERE run_id = ?1", &dump->run, error);
  if (result == STATUS_OK)
    result = sql_prepare(dump->db, "SELECT masses FROM fragment_mass WHERE run_id = ?1", &dump->masses, doing, error);
  if (result == STATUS_OK)
    result = sql_prepare(dump->db, "SELECT bin, count, mass FROM spectrum WHERE run_id = ?1 ORDER BY bin",
                         &dump->spectrum, doing, error);
  if (result == STATUS_OK)
    result = prepare_columns(dump->db, "estimate", "ordinal", "WHERE run_id = ?1 ORDER BY ordinal", &dump->estimates,
                             error);
  return result;
}

static void forget(struct dump *dump) {
  sqlite3_finalize(dump->run);
  sqlite3_finalize(dump->masses);
  sqlite3_finalize(dump->spectrum);
  sqlite3_finalize(dump->estimates);
  for (size_t i = 0; i < dump->result_count; i++)
    sqlite3_finalize(dump->results[i].statement);
}

/* The question about the engine's own results. */
static status find_results(struct dump *dump, const char *engine, sqlite3_stmt **statement, struct error *error) {
  char table[SCHEMA_NAME_SIZE];
  for (size_t i = 0; i < dump->result_count; i++)
    if (strcmp(dump->results[i].engine, engine) == 0) {
      *statement = dump->results[i].statement;
      return STATUS_OK;
    }
  if (dump->result_count == STORE_KINDS)
    return status_fail(error, STATUS_CONTENT, "%s: more than %d engines in one store", doing, STORE_KINDS);
  snprintf(table, sizeof table, "result_%s", engine);
  status result = prepare_columns(dump->db, table, "", "WHERE run_id = ?1", statement, error);
  if (result != STATUS_OK)
    return result;
  snprintf(dump->results[dump->result_count].engine, SCHEMA_NAME_SIZE, "%s", engine);
  dump->results[dump->result_count++].statement = *statement;
  return STATUS_OK;
}

static status print_run(struct dump *dump, int64_t run_id, const char *engine, struct error *error) {
  sqlite3_stmt *results = NULL;
  status code = find_results(dump, engine, &results, error);
  const struct {
    sqlite3_stmt *statement;
    const char *head;
  } parts[] = {{dump->run, "run"},
               {results, " result"},
               {dump->masses, " fragments"},
               {dump->spectrum, " spectrum"},
               {dump->estimates, " estimate"}};
  for (size_t i = 0; code == STATUS_OK && i < sizeof parts / sizeof parts[0]; i++)
    code = print_rows(dump->db, parts[i].statement, run_id, parts[i].head, dump->out, error);
  return code;
}

static status print_points(struct dump *dump, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(dump->db, "SELECT hex(hash) AS hash, engine, scene FROM point ORDER BY hash", &statement,
                              doing, error);
  if (result == STATUS_OK)
    result = print_rows(dump->db, statement, 0, "point", dump->out, error);
  sqlite3_finalize(statement);
  return result;
}

static status print_runs(struct dump *dump, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(
      dump->db, "SELECT run_id, engine FROM run JOIN point USING (point_id) WHERE surplus = 0 ORDER BY identity",
      &statement, doing, error);
  int code = SQLITE_DONE;
  while (result == STATUS_OK && (code = sqlite3_step(statement)) == SQLITE_ROW)
    result = print_run(dump, sqlite3_column_int64(statement, 0), (const char *)sqlite3_column_text(statement, 1),
                       error);
  if (result == STATUS_OK && code != SQLITE_DONE)
    result = sql_fail(dump->db, code, doing, error);
  sqlite3_finalize(statement);
  return result;
}

status store_dump(struct store *store, FILE *out, struct error *error) {
  struct dump dump = {.db = store->db, .out = out};
  status result = print_points(&dump, error);
  if (result == STATUS_OK)
    result = prepare(&dump, error);
  if (result == STATUS_OK)
    result = print_runs(&dump, error);
  forget(&dump);
  if (result == STATUS_OK && ferror(out))
    result = status_fail(error, STATUS_IO, "%s failed", doing);
  return result;
}
