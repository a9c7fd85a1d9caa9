/* The deterministic content of a store as text, to compare two stores of the same campaign: sorted by identity, doubles
 * in hexadecimal. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

static const char doing[] = "writing the deterministic content";

/* Buffered text for the file. A store of 1e5 runs gives 600 MB of text: one stdio call per value took half of the
 * time. */
struct text {
  FILE *out;
  int problem; /* errno of the first write that failed; 0: none */
  size_t used;
  char bytes[1 << 16];
};

static void write_bytes(struct text *text, const char *bytes, size_t size) {
  if (fwrite(bytes, 1, size, text->out) != size && !text->problem)
    text->problem = errno;
}

static void flush(struct text *text) {
  write_bytes(text, text->bytes, text->used);
  text->used = 0;
}

static void put(struct text *text, const char *bytes, size_t size) {
  if (size > sizeof text->bytes - text->used)
    flush(text);
  if (size > sizeof text->bytes) {
    write_bytes(text, bytes, size);
    return;
  }
  memcpy(text->bytes + text->used, bytes, size);
  text->used += size;
}

static const char digits[] = "0123456789abcdef";

static void put_hex(struct text *text, const unsigned char *bytes, size_t size) {
  char pair[2];
  for (size_t i = 0; i < size; i++) {
    pair[0] = digits[bytes[i] >> 4];
    pair[1] = digits[bytes[i] & 15];
    put(text, pair, sizeof pair);
  }
}

static void put_integer(struct text *text, int64_t value) {
  char number[24];
  size_t at = sizeof number;
  uint64_t left = value < 0 ? -(uint64_t)value : (uint64_t)value;
  do
    number[--at] = (char)('0' + left % 10);
  while ((left /= 10) > 0);
  if (value < 0)
    number[--at] = '-';
  put(text, number + at, sizeof number - at);
}

/* The same text as printf's %a, which takes ten times as long. */
static void put_real(struct text *text, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  char number[40];
  size_t at = 0;
  if (!isnormal(value)) { /* 0, and rare values such as subnormals */
    snprintf(number, sizeof number, "%a", value);
    put(text, number, strlen(number));
    return;
  }
  if (value < 0)
    number[at++] = '-';
  memcpy(number + at, "0x1", 3);
  at += 3;
  uint64_t fraction = bits << 12;
  if (fraction)
    number[at++] = '.';
  for (; fraction; fraction <<= 4)
    number[at++] = digits[fraction >> 60];
  const int64_t exponent = (int64_t)(bits >> 52 & 0x7ff) - 1023;
  number[at++] = 'p';
  if (exponent >= 0)
    number[at++] = '+';
  put(text, number, at);
  put_integer(text, exponent);
}

static void put_value(struct text *text, sqlite3_stmt *row, int column) {
  switch (sqlite3_column_type(row, column)) {
  case SQLITE_INTEGER: put_integer(text, sqlite3_column_int64(row, column)); break;
  case SQLITE_FLOAT: put_real(text, sqlite3_column_double(row, column)); break;
  case SQLITE_TEXT: {
    const char *words = (const char *)sqlite3_column_text(row, column);
    put(text, "'", 1);
    put(text, words, strlen(words));
    put(text, "'", 1);
    break;
  }
  case SQLITE_BLOB: {
    const unsigned char *bytes = sqlite3_column_blob(row, column);
    put_hex(text, bytes, (size_t)sqlite3_column_bytes(row, column));
    break;
  }
  default: put(text, "null", 4);
  }
}

enum { HEAD = 2 * SCHEMA_NAME_SIZE };

/* A query, and the prefix of each value of its rows: ` name=`. */
struct rows {
  sqlite3_stmt *statement;
  char (*heads)[HEAD];
  size_t *lengths;
};

static void close_rows(struct rows *rows) {
  sqlite3_finalize(rows->statement);
  free(rows->heads);
  free(rows->lengths);
  *rows = (struct rows){0};
}

static status name_columns(struct rows *rows, struct error *error) {
  const size_t count = (size_t)sqlite3_column_count(rows->statement);
  rows->heads = calloc(count + 1, sizeof *rows->heads);
  rows->lengths = calloc(count + 1, sizeof *rows->lengths);
  if (!rows->heads || !rows->lengths)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  for (size_t i = 0; i < count; i++) {
    const int length = snprintf(rows->heads[i], HEAD, " %s=", sqlite3_column_name(rows->statement, (int)i));
    if (length >= HEAD)
      return status_fail(error, STATUS_CONTENT, "%s: the name of a column is too long: %s", doing, rows->heads[i]);
    rows->lengths[i] = (size_t)length;
  }
  return STATUS_OK;
}

static status prepare_rows(sqlite3 *db, const char *sql, struct rows *rows, struct error *error) {
  status result = sql_prepare(db, sql, &rows->statement, doing, error);
  return result == STATUS_OK ? name_columns(rows, error) : result;
}

/* Prints each row as ` name=value` pairs on one line that begins with `head`. Parameter 1, if any, is run_id. The
 * statement is reset at the end. */
static status print_rows(sqlite3 *db, const struct rows *rows, int64_t run_id, const char *head, struct text *text,
                         struct error *error) {
  sqlite3_stmt *statement = rows->statement;
  if (sqlite3_bind_parameter_count(statement))
    sqlite3_bind_int64(statement, 1, run_id);
  const int columns = sqlite3_column_count(statement);
  const size_t head_length = strlen(head);
  int code;
  while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
    put(text, head, head_length);
    for (int i = 0; i < columns; i++) {
      put(text, rows->heads[i], rows->lengths[i]);
      put_value(text, statement, i);
    }
    put(text, "\n", 1);
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
static status prepare_columns(sqlite3 *db, const char *table, const char *before, const char *after, struct rows *rows,
                              struct error *error) {
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
  status result = prepare_rows(db, sql, rows, error);
  sqlite3_free(sql);
  return result;
}

/* The queries about one run, prepared once. */
struct dump {
  sqlite3 *db;
  struct text *text;
  struct rows run, masses, spectrum, estimates;
  struct {
    char engine[SCHEMA_NAME_SIZE];
    struct rows rows;
  } results[STORE_KINDS];
  size_t result_count;
};

static status prepare(struct dump *dump, struct error *error) {
  status result = prepare_columns(dump->db, "run",
                                  "hex(identity) AS identity, (SELECT hex(hash) FROM point p WHERE p.point_id = "
                                  "run.point_id) AS point, replicate, seed, results_version",
                                  "WHERE run_id = ?1", &dump->run, error);
  if (result == STATUS_OK)
    result = prepare_rows(dump->db, "SELECT masses FROM fragment_mass WHERE run_id = ?1", &dump->masses, error);
  if (result == STATUS_OK)
    result = prepare_rows(dump->db, "SELECT bin, count, mass FROM spectrum WHERE run_id = ?1 ORDER BY bin",
                          &dump->spectrum, error);
  if (result == STATUS_OK)
    result = prepare_columns(dump->db, "estimate", "ordinal", "WHERE run_id = ?1 ORDER BY ordinal", &dump->estimates,
                             error);
  return result;
}

static void forget(struct dump *dump) {
  close_rows(&dump->run);
  close_rows(&dump->masses);
  close_rows(&dump->spectrum);
  close_rows(&dump->estimates);
  for (size_t i = 0; i < dump->result_count; i++)
    close_rows(&dump->results[i].rows);
}

/* The query about the engine's own results. */
static status find_results(struct dump *dump, const char *engine, const struct rows **rows, struct error *error) {
  char table[SCHEMA_NAME_SIZE];
  bool has = false;
  for (size_t i = 0; i < dump->result_count; i++)
    if (strcmp(dump->results[i].engine, engine) == 0) {
      *rows = &dump->results[i].rows;
      return STATUS_OK;
    }
  if (dump->result_count == STORE_KINDS)
    return status_fail(error, STATUS_CONTENT, "%s: more than %d engines in one store", doing, STORE_KINDS);
  snprintf(table, sizeof table, "result_%s", engine);
  status code = schema_has_column(dump->db, table, "run_id", &has, error);
  if (code == STATUS_OK && !has)
    code = status_fail(error, STATUS_CONTENT, "%s: the store has no table %s, but a point of that engine", doing,
                       table);
  if (code)
    return code;
  struct rows *own = &dump->results[dump->result_count++].rows;
  snprintf(dump->results[dump->result_count - 1].engine, SCHEMA_NAME_SIZE, "%s", engine);
  *rows = own;
  return prepare_columns(dump->db, table, "", "WHERE run_id = ?1", own, error);
}

static status print_run(struct dump *dump, int64_t run_id, const char *engine, struct error *error) {
  const struct rows *results = NULL;
  status code = find_results(dump, engine ? engine : "", &results, error);
  const struct {
    const struct rows *rows;
    const char *head;
  } parts[] = {{&dump->run, "run"},
               {results, " result"},
               {&dump->masses, " fragments"},
               {&dump->spectrum, " spectrum"},
               {&dump->estimates, " estimate"}};
  for (size_t i = 0; code == STATUS_OK && i < sizeof parts / sizeof parts[0]; i++)
    code = print_rows(dump->db, parts[i].rows, run_id, parts[i].head, dump->text, error);
  return code;
}

static status print_points(struct dump *dump, struct error *error) {
  struct rows rows = {0};
  status result = prepare_rows(dump->db, "SELECT hex(hash) AS hash, engine, scene FROM point ORDER BY hash", &rows,
                               error);
  if (result == STATUS_OK)
    result = print_rows(dump->db, &rows, 0, "point", dump->text, error);
  close_rows(&rows);
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
  struct text *text = malloc(sizeof *text);
  if (!text)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  text->out = out;
  text->problem = 0;
  text->used = 0;
  struct dump dump = {.db = store->db, .text = text};
  status result = print_points(&dump, error);
  if (result == STATUS_OK)
    result = prepare(&dump, error);
  if (result == STATUS_OK)
    result = print_runs(&dump, error);
  forget(&dump);
  flush(text);
  if (result == STATUS_OK && text->problem)
    result = status_fail(error, STATUS_IO, "%s failed: %s", doing, strerror(text->problem));
  free(text);
  return result;
}
