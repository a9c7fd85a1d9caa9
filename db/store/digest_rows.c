/* Digests of stored rows. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/digest.h"
#include "db/store/schema.h"

static const char doing[] = "reading digests";

enum { MOST_TABLES = 64, NAME = 160 };

/* A table whose rows go into the digest. `row` distinguishes the rows of one run or point; `but`: columns left out. */
struct source {
  char table[NAME];
  const char *row, *but;
};

/* All values that follow from inputs, seed and results_version. Left out: times, hosts and ids within the store, and
 * the values that stopping rules change (surplus, counts). The spectrum follows from the masses, bit by bit. */
static const struct source of_runs[] = {
    {"run", "0",
     "'run_id', 'point_id', 'session_id', 'surplus', 'counts', 'attempt', 'wall_time', 'cpu_time', 'peak_memory', "
     "'host', 'rank', 'finished_at', 'fields_path', 'digest'"},
    {"fragment_mass", "0", "'run_id'"},
    {"estimate", "ordinal", "'run_id', 'ordinal'"},
};
static const struct source of_points[] = {
    {"point", "0", "'point_id', 'digest'"},
    {"point_input", "path", "'point_id', 'path'"},
};

struct table {
  sqlite3_stmt *rows; /* parameter ?1: the number; first the column that distinguishes the rows, then the others */
  struct digest *names;
};

struct reader {
  sqlite3 *db;
  const char *table, *key;
  struct table tables[MOST_TABLES];
  size_t count;
};

static void close_reader(struct reader *reader) {
  for (size_t i = 0; i < reader->count; i++) {
    sqlite3_finalize(reader->tables[i].rows);
    free(reader->tables[i].names);
  }
}

static status open_table(struct reader *reader, const struct source *source, struct error *error) {
  if (reader->count == MOST_TABLES)
    return status_fail(error, STATUS_CONTENT, "more than %d tables of results in one store", MOST_TABLES);
  char *question = sqlite3_mprintf("SELECT name FROM pragma_table_info(?1, 'main') WHERE name NOT IN (%s)",
                                   source->but);
  char *columns = question ? sql_name_list(reader->db, question, source->table, NULL) : NULL;
  sqlite3_free(question);
  if (!columns)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  struct table *table = &reader->tables[reader->count++];
  const status result = sql_preparef(reader->db, &table->rows, doing, error,
                                     "SELECT %s%s FROM main.\"%w\" WHERE %s = ?1", source->row, columns, source->table,
                                     reader->key);
  sqlite3_free(columns);
  if (result != STATUS_OK)
    return result;
  const int count = sqlite3_column_count(table->rows);
  table->names = calloc((size_t)count, sizeof *table->names);
  if (!table->names)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  for (int i = 1; i < count; i++)
    table->names[i] = digest_name(source->table, sqlite3_column_name(table->rows, i));
  return STATUS_OK;
}

/* Opens the result tables of all engines: each run has a row in the table of its engine. */
static status open_results(struct reader *reader, struct error *error) {
  sqlite3_stmt *names = NULL;
  status result = sql_prepare(reader->db,
                              "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name GLOB 'result_*'",
                              &names, doing, error);
  while (sql_next(names, &result, doing, error)) {
    struct source source = {.row = "0", .but = "'run_id'"};
    snprintf(source.table, sizeof source.table, "%s", sql_text(names, 0));
    result = open_table(reader, &source, error);
  }
  sqlite3_finalize(names);
  return result;
}

static status open_reader(sqlite3 *db, enum digest_kind kind, struct reader *reader, struct error *error) {
  const bool runs = kind == DIGEST_RUNS;
  const struct source *sources = runs ? of_runs : of_points;
  const size_t count = runs ? sizeof of_runs / sizeof of_runs[0] : sizeof of_points / sizeof of_points[0];
  *reader = (struct reader){.db = db, .table = runs ? "run" : "point", .key = runs ? "run_id" : "point_id"};
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < count; i++)
    result = open_table(reader, &sources[i], error);
  return result == STATUS_OK && runs ? open_results(reader, error) : result;
}

static status read_digest(struct reader *reader, int64_t number, uint8_t bytes[16], struct error *error) {
  struct digest sum = {0};
  status result = STATUS_OK;
  for (size_t i = 0; i < reader->count; i++) {
    const struct table *table = &reader->tables[i];
    sqlite3_bind_int64(table->rows, 1, number);
    while (sql_next(table->rows, &result, doing, error)) {
      const uint64_t row = sqlite3_column_type(table->rows, 0) == SQLITE_TEXT
                               ? digest_row(sql_text(table->rows, 0))
                               : (uint64_t)sqlite3_column_int64(table->rows, 0);
      for (int k = 1; k < sqlite3_column_count(table->rows); k++)
        digest_add_stored(&sum, table->names[k], row, table->rows, k);
    }
    sqlite3_reset(table->rows);
  }
  digest_write(sum, bytes);
  return result;
}

/* Selects the numbers of the rows and, with `more`, further columns: the row `only`, or all rows that meet the
 * condition. */
static status prepare_numbers(sqlite3 *db, const struct reader *reader, const char *more, int64_t only,
                              const char *condition, sqlite3_stmt **numbers, struct error *error) {
  if (!only)
    return sql_preparef(db, numbers, doing, error, "SELECT %s%s FROM main.%s WHERE %s", reader->key, more,
                        reader->table, condition);
  const status result = sql_preparef(db, numbers, doing, error, "SELECT %s%s FROM main.%s WHERE %s = ?1", reader->key,
                                     more, reader->table, reader->key);
  if (result == STATUS_OK)
    sqlite3_bind_int64(*numbers, 1, only);
  return result;
}

static bool holds(sqlite3_stmt *row, int column, const uint8_t digest[16]) {
  return sqlite3_column_bytes(row, column) == 16 && memcmp(digest, sqlite3_column_blob(row, column), 16) == 0;
}

status digest_rows_compare(sqlite3 *db, enum digest_kind kind, int64_t only,
                           void (*each)(void *context, int64_t number), void *context, struct error *error) {
  struct reader reader;
  sqlite3_stmt *numbers = NULL;
  bool has = false;
  status result = schema_has_column(db, kind == DIGEST_RUNS ? "run" : "point", "digest", &has, error);
  if (result != STATUS_OK || !has)
    return result;
  result = open_reader(db, kind, &reader, error);
  if (result == STATUS_OK)
    result = prepare_numbers(db, &reader, ", digest", only, "true", &numbers, error);
  while (sql_next(numbers, &result, doing, error)) {
    uint8_t bytes[16];
    const int64_t number = sqlite3_column_int64(numbers, 0);
    result = read_digest(&reader, number, bytes, error);
    if (result == STATUS_OK && !holds(numbers, 1, bytes))
      each(context, number);
  }
  sqlite3_finalize(numbers);
  close_reader(&reader);
  return result;
}

static status write_digest(sqlite3_stmt *update, int64_t number, const uint8_t digest[16], struct error *error) {
  sqlite3_bind_int64(update, 1, number);
  sqlite3_bind_blob(update, 2, digest, 16, SQLITE_STATIC);
  return sql_run(update, doing, error);
}

/* Writes the digests of the rows of prepare_numbers(). */
static status fill(sqlite3 *db, enum digest_kind kind, int64_t only, const char *condition, struct error *error) {
  struct reader reader;
  sqlite3_stmt *numbers = NULL, *update = NULL;
  status result = open_reader(db, kind, &reader, error);
  if (result == STATUS_OK)
    result = prepare_numbers(db, &reader, "", only, condition, &numbers, error);
  if (result == STATUS_OK)
    result = sql_preparef(db, &update, doing, error, "UPDATE main.%s SET digest = ?2 WHERE %s = ?1", reader.table,
                          reader.key);
  while (sql_next(numbers, &result, doing, error)) {
    uint8_t bytes[16];
    const int64_t number = sqlite3_column_int64(numbers, 0);
    result = read_digest(&reader, number, bytes, error);
    if (result == STATUS_OK)
      result = write_digest(update, number, bytes, error);
  }
  sqlite3_finalize(numbers);
  sqlite3_finalize(update);
  close_reader(&reader);
  return result;
}

status digest_rows_fill(sqlite3 *db, enum digest_kind kind, int64_t number, struct error *error) {
  return fill(db, kind, number, "", error);
}

status digest_rows_fill_missing(sqlite3 *db, enum digest_kind kind, int64_t first, struct error *error) {
  char condition[80];
  snprintf(condition, sizeof condition, "%s >= %lld AND digest IS NULL", kind == DIGEST_RUNS ? "run_id" : "point_id",
           (long long)first);
  return fill(db, kind, 0, condition, error);
}

status digest_rows_print(sqlite3 *db, enum digest_kind kind, FILE *out, struct error *error) {
  const bool runs = kind == DIGEST_RUNS;
  struct reader reader;
  sqlite3_stmt *numbers = NULL;
  status result = open_reader(db, kind, &reader, error);
  if (result == STATUS_OK)
    result = prepare_numbers(db, &reader, runs ? ", lower(hex(identity))" : ", lower(hex(hash))", 0,
                             runs ? "surplus = 0 ORDER BY identity" : "true ORDER BY hash", &numbers, error);
  while (sql_next(numbers, &result, doing, error)) {
    uint8_t bytes[16];
    result = read_digest(&reader, sqlite3_column_int64(numbers, 0), bytes, error);
    fprintf(out, "%s %s ", reader.table, sql_text(numbers, 1));
    for (size_t i = 0; i < sizeof bytes; i++)
      fprintf(out, "%02x", bytes[i]);
    fputc('\n', out);
  }
  sqlite3_finalize(numbers);
  close_reader(&reader);
  if (result == STATUS_OK && ferror(out))
    return status_fail(error, STATUS_IO, "writing the digests failed: %s", strerror(errno));
  return result;
}
