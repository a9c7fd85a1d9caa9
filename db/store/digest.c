/* Digests of values before they are stored, of stored rows, and of fields files. */
#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "schemas/memory.h"

/* Both lanes are one to one in the word and in the state: an odd factor has an inverse, and so has x ^= x >> k. The
 * factors are those of splitmix64. */
static struct digest step(struct digest state, uint64_t word) {
  state.a = (state.a ^ word) * 0xbf58476d1ce4e5b9u;
  state.a ^= state.a >> 31;
  state.b = (state.b + word) * 0x94d049bb133111ebu;
  state.b ^= state.b >> 29;
  return state;
}

/* Up to 8 bytes, little-endian; missing bytes are 0. */
static uint64_t word_at(const uint8_t *bytes, size_t size) {
  uint64_t word = 0;
  memcpy(&word, bytes, size);
  return le64toh(word);
}

static struct digest step_bytes(struct digest state, const void *bytes, size_t size) {
  const uint8_t *at = bytes;
  state = step(state, size);
  for (; size >= 8; size -= 8, at += 8)
    state = step(state, word_at(at, 8));
  return size ? step(state, word_at(at, size)) : state;
}

static const struct digest start = {0x9e3779b97f4a7c15u, 0x6a09e667f3bcc909u};

struct digest digest_name(const char *table, const char *column) {
  return step_bytes(step_bytes(start, table, strlen(table)), column, strlen(column));
}

uint64_t digest_row(const char *text, size_t size) {
  return step_bytes(step_bytes(start, "", 0), text, size).a;
}

void digest_add(struct digest *sum, struct digest name, uint64_t row, struct sql_value value) {
  struct digest state = step(name, row << 8 | (unsigned)value.type);
  if (value.type == SQLITE_NULL)
    return;
  if (value.type == SQLITE_FLOAT) {
    uint64_t bits;
    const double real = value.real == 0 ? 0 : value.real; /* SQLite does not keep the sign of -0 */
    memcpy(&bits, &real, sizeof bits);
    state = step(state, bits);
  } else {
    state = value.type == SQLITE_INTEGER ? step(state, (uint64_t)value.integer)
                                         : step_bytes(state, value.bytes, value.size);
  }
  sum->a += state.a;
  sum->b += state.b;
}

void digest_names_make(struct digest **names, const char *table, const struct field_table *fields) {
  if (*names)
    return;
  *names = memory_small(fields->count + 1, sizeof **names);
  for (size_t i = 0; i < fields->count; i++) {
    char column[FIELD_TEXT_SIZE];
    field_column_name(fields->rows[i].path, column, sizeof column);
    (*names)[i] = digest_name(table, column);
  }
}

void digest_add_fields(struct digest *sum, const struct digest *names, const struct field_table *fields, uint64_t row,
                       const void *object) {
  for (size_t i = 0; i < fields->count; i++)
    if (!fields->rows[i].when || field_is_active(fields, &fields->rows[i], object))
      digest_add(sum, names[i], row, sql_of_field(&fields->rows[i], object, false));
}

void digest_write(struct digest sum, uint8_t bytes[16]) {
  for (int i = 0; i < 8; i++) {
    bytes[i] = (uint8_t)(sum.a >> 8 * i);
    bytes[8 + i] = (uint8_t)(sum.b >> 8 * i);
  }
}

/* ---- fields files ---- */

enum { CHUNK = 1 << 16 };

/* Reads until the chunk is full or the file ends. -1: it cannot be read. */
static ssize_t read_chunk(int file, uint8_t *bytes) {
  size_t size = 0;
  while (size < CHUNK) {
    const ssize_t count = read(file, bytes + size, CHUNK - size);
    if (count < 0 && errno == EINTR)
      continue;
    if (count < 0)
      return -1;
    if (count == 0)
      break;
    size += (size_t)count;
  }
  return (ssize_t)size;
}

/* A store may name a pipe or a device: it is no fields file, and reading it may never end. */
status store_digest_fields(const char *path, char digest[STORE_DIGEST_SIZE], struct error *error) {
  struct stat kind;
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "the fields file '%s' cannot be read: %s",
                       path, strerror(errno));
  uint8_t *bytes = memory_small(1, CHUNK);
  struct digest state = digest_name("fields", "");
  ssize_t size = fstat(file, &kind) == 0 && S_ISREG(kind.st_mode) ? CHUNK : -1;
  while (size == CHUNK) {
    size = read_chunk(file, bytes);
    if (size > 0)
      state = step_bytes(state, bytes, (size_t)size);
  }
  free(bytes);
  close(file);
  if (size < 0)
    return status_fail(error, STATUS_IO, "the fields file '%s' cannot be read", path);
  uint8_t sum[16];
  digest_write(state, sum);
  text_hex(sum, sizeof sum, digest);
  return STATUS_OK;
}

/* ---- digests of tables ---- */

static const char keeping[] = "keeping digests of tables";

/* table, column, value, column, value, ...: the digest of a row. A last step binds its values together. */
static bool of_row(int count, sqlite3_value **values, struct digest *row) {
  const char *table = (const char *)sqlite3_value_text(values[0]);
  struct digest sum = {0};
  for (int i = 1; i + 1 < count; i += 2) {
    const char *column = (const char *)sqlite3_value_text(values[i]);
    if (!table || !column)
      return false;
    digest_add(&sum, digest_name(table, column), 0, sql_of_argument(values[i + 1]));
  }
  *row = step(step(digest_name("row", ""), sum.a), sum.b);
  return table != NULL;
}

/* rows_digest(table, column, value, ...): of all rows. Their order does not matter. */
static void add_row(sqlite3_context *context, int count, sqlite3_value **values) {
  struct digest *sum = sqlite3_aggregate_context(context, sizeof *sum), row;
  if (!sum || !of_row(count, values, &row)) {
    sqlite3_result_error_nomem(context);
    return;
  }
  sum->a += row.a;
  sum->b += row.b;
}

static void end_rows(sqlite3_context *context) {
  const struct digest *sum = sqlite3_aggregate_context(context, 0);
  uint8_t bytes[16];
  digest_write(sum ? *sum : (struct digest){0}, bytes);
  sqlite3_result_blob(context, bytes, sizeof bytes, SQLITE_TRANSIENT);
}

void digest_function(sqlite3 *db) {
  sqlite3_create_function(db, "rows_digest", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY, NULL, NULL,
                          add_row, end_rows);
}

/* row_changed(k, 1 or -1, table, column, value, ...): a row of the k-th table came or went. */
static void row_changed(sqlite3_context *context, int count, sqlite3_value **values) {
  struct digest_tables *tables = sqlite3_user_data(context);
  struct digest row;
  if (!of_row(count - 2, values + 2, &row)) {
    sqlite3_result_error_nomem(context);
    return;
  }
  struct digest_of_table *table = &tables->now[sqlite3_value_int(values[0])];
  const int sign = sqlite3_value_int(values[1]);
  table->rows = (int64_t)((uint64_t)table->rows + (uint64_t)sign); /* a store from elsewhere may say any number */
  table->sum.a += sign > 0 ? row.a : -row.a;
  table->sum.b += sign > 0 ? row.b : -row.b;
}

/* *sql: the arguments of rows_digest() for the columns of a table; `prefix`: NEW., OLD. or "". */
static status list_values(sqlite3 *db, const char *table, const char *prefix, char **sql, struct error *error) {
  return sql_textf(db, sql, keeping, error,
                   "SELECT format('%%Q, %%s', %Q, group_concat(format('%%Q, %s\"%%w\"', name, name), ', ')) FROM "
                   "pragma_table_info(%Q, 'main')",
                   table, prefix, table);
}

status digest_of_rows(sqlite3 *db, const char *table, char **sql, struct error *error) {
  SQL_TEXT values = NULL;
  TRY(list_values(db, table, "", &values, error));
  *sql = sql_format("SELECT %Q AS table_name, count(*) AS row_count, rows_digest(%s) AS digest FROM main.\"%w\"", table,
                    values, table);
  return STATUS_OK;
}

status digest_tables_fill(sqlite3 *db, struct error *error) {
  for (size_t i = 0; i < schema_tables_count; i++) {
    SQL_TEXT rows = NULL;
    if (!schema_tables[i].has_digest)
      continue;
    TRY(digest_of_rows(db, schema_tables[i].name, &rows, error));
    TRY(sql_executef(db, keeping, error, "INSERT OR REPLACE INTO table_digest (table_name, row_count, digest) %s",
                     rows));
  }
  return STATUS_OK;
}

static status read_table(sqlite3 *db, const char *name, struct digest_of_table *table, struct error *error) {
  STATEMENT row = NULL;
  status result = sql_preparef(db, &row, keeping, error,
                               "SELECT row_count, digest FROM main.table_digest WHERE table_name = %Q", name);
  if (!sql_next(row, &result, keeping, error))
    return result;
  const uint8_t *bytes = sqlite3_column_blob(row, 1);
  table->rows = sqlite3_column_int64(row, 0);
  if (sqlite3_column_bytes(row, 1) == 16)
    table->sum = (struct digest){word_at(bytes, 8), word_at(bytes + 8, 8)};
  return STATUS_OK;
}

static status make_triggers(sqlite3 *db, const char *table, int index, struct error *error) {
  SQL_TEXT before = NULL;
  SQL_TEXT after = NULL;
  TRY(list_values(db, table, "OLD.", &before, error));
  TRY(list_values(db, table, "NEW.", &after, error));
  return sql_executef(
      db, keeping, error,
      "CREATE TEMP TRIGGER \"add_%w\" AFTER INSERT ON main.\"%w\" BEGIN SELECT row_changed(%d, 1, %s); END;"
      "CREATE TEMP TRIGGER \"remove_%w\" AFTER DELETE ON main.\"%w\" BEGIN SELECT row_changed(%d, -1, %s); "
      "END;"
      "CREATE TEMP TRIGGER \"change_%w\" AFTER UPDATE ON main.\"%w\" BEGIN SELECT row_changed(%d, -1, %s), "
      "row_changed(%d, 1, %s); END",
      table, table, index, after, table, table, index, before, table, table, index, before, index, after);
}

status digest_tables_follow(sqlite3 *db, struct digest_tables *tables, struct error *error) {
  *tables = (struct digest_tables){.now = {{0}}};
  if (schema_tables_count > DIGEST_TABLES)
    return status_fail(error, STATUS_INTERNAL, "more than %d tables", DIGEST_TABLES);
  if (!schema_has_column(db, "table_digest", NULL)) /* a copy of a store of version 3 */
    return STATUS_OK;
  sqlite3_create_function(db, "row_changed", -1, SQLITE_UTF8 | SQLITE_DIRECTONLY, tables, row_changed, NULL, NULL);
  for (size_t i = 0; i < schema_tables_count; i++) {
    if (!schema_tables[i].has_digest)
      continue;
    TRY(read_table(db, schema_tables[i].name, &tables->now[i], error));
    TRY(make_triggers(db, schema_tables[i].name, (int)i, error));
  }
  digest_tables_end(tables, true);
  return STATUS_OK;
}

status digest_tables_write(sqlite3 *db, const struct digest_tables *tables, struct error *error) {
  STATEMENT row = NULL;
  for (size_t i = 0; i < schema_tables_count; i++) {
    const struct digest_of_table *now = &tables->now[i];
    uint8_t bytes[16];
    if (memcmp(now, &tables->stored[i], sizeof *now) == 0)
      continue;
    TRY(sql_prepare_once(db, &row,
                         "INSERT OR REPLACE INTO main.table_digest (table_name, row_count, digest) VALUES (?1, ?2, ?3)",
                         keeping, error));
    digest_write(now->sum, bytes);
    SQL_BIND(row, sql_of_text(schema_tables[i].name), sql_of_integer(now->rows), sql_of_bytes(bytes, sizeof bytes));
    TRY(sql_run(row, keeping, error));
  }
  return STATUS_OK;
}

void digest_tables_end(struct digest_tables *tables, bool committed) {
  memcpy(committed ? tables->stored : tables->now, committed ? tables->now : tables->stored, sizeof tables->now);
}

/* ---- stored rows ---- */

static const char doing[] = "reading digests";

enum { NAME = 160 };

/* A table whose rows go into the digest. `row` distinguishes the rows of one run or point; `but`: columns left out. */
struct source {
  char table[NAME];
  const char *row, *but;
};

/* All values that follow from inputs, seed and results_version, and the digest of the fields file, which printed
 * digests leave out: a campaign need not keep fields. Left out: times, hosts and ids within the store, and the values
 * that stopping rules and people change (surplus, counts, excluded). The spectrum follows from the masses, bit by bit.
 */
static const struct source of_runs[] = {
    {"run", "0",
     "'run_id', 'point_id', 'session_id', 'surplus', 'counts', 'attempt', 'wall_time', 'cpu_time', 'peak_memory', "
     "'host', 'rank', 'finished_at', 'fields_path', 'excluded', 'excluded_at', 'digest'"},
    {"fragment_mass", "0", "'run_id'"},
    {"estimate", "ordinal", "'run_id', 'ordinal'"},
    {"ejecta", "bin", "'run_id', 'bin'"},
};
static const struct source of_points[] = {
    {"point", "0", "'point_id', 'digest'"},
    {"point_input", "path", "'point_id', 'path'"},
};

static status open_table(struct digest_rows *rows, const struct source *source, bool to_print, struct error *error) {
  if (rows->count == DIGEST_TABLES)
    return status_fail(error, STATUS_CONTENT, "more than %d tables of results in one store", DIGEST_TABLES);
  if (!schema_has_column(rows->db, source->table, NULL) && schema_may_lack(source->table, ""))
    return STATUS_OK; /* an older store */
  SQL_TEXT columns = NULL;
  TRY(sql_textf(rows->db, &columns, doing, rows->error,
                "SELECT group_concat(format(', \"%%w\"', name), '') FROM pragma_table_info(%Q, 'main') WHERE name NOT "
                "IN (%s%s)",
                source->table, source->but, to_print ? ", 'fields_digest'" : ""));
  struct digest_table *table = &rows->tables[rows->count++];
  TRY(sql_preparef(rows->db, &table->rows, doing, error, "SELECT %s%s FROM main.\"%w\" WHERE %s = ?1", source->row,
                   columns, source->table, rows->key));
  const int count = sqlite3_column_count(table->rows);
  table->names = memory_small((size_t)count, sizeof *table->names);
  for (int i = 1; i < count; i++)
    table->names[i] = digest_name(source->table, sqlite3_column_name(table->rows, i));
  return STATUS_OK;
}

/* Opens the result tables of all engines: each run has a row in the table of its engine. */
static status open_results(struct digest_rows *rows, bool to_print, struct error *error) {
  STATEMENT names = NULL;
  status result = sql_prepare(rows->db,
                              "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name GLOB 'result_*'",
                              &names, doing, error);
  while (sql_next(names, &result, doing, error)) {
    struct source source = {.row = "0", .but = "'run_id'"};
    snprintf(source.table, sizeof source.table, "%s", sql_text(names, 0));
    result = open_table(rows, &source, to_print, error);
  }
  return result;
}

static status open_rows(struct digest_rows *rows, enum digest_kind kind, int64_t only, bool to_print,
                        struct error *error) {
  const bool runs = kind == DIGEST_RUNS;
  const char *hash = runs ? "identity" : "hash", *counted = runs ? " AND surplus = 0" : "";
  rows->table = runs ? "run" : "point";
  rows->key = runs ? "run_id" : "point_id";
  const size_t count = runs ? sizeof of_runs / sizeof of_runs[0] : sizeof of_points / sizeof of_points[0];
  for (size_t i = 0; i < count; i++)
    TRY(open_table(rows, runs ? &of_runs[i] : &of_points[i], to_print, error));
  if (runs)
    TRY(open_results(rows, to_print, error));
  return sql_preparef(rows->db, &rows->numbers, doing, error,
                      "SELECT %s, digest, lower(hex(%s)) FROM main.%s WHERE %s BETWEEN %lld AND %lld%s%s%s", rows->key,
                      hash, rows->table, rows->key, (long long)(only ? only : INT64_MIN),
                      (long long)(only ? only : INT64_MAX), to_print ? counted : "", to_print ? " ORDER BY " : "",
                      to_print ? hash : "");
}

struct digest_rows digest_rows(sqlite3 *db, enum digest_kind kind, int64_t only, bool to_print, struct error *error) {
  struct digest_rows rows = {.db = db, .error = error};
  rows.code = open_rows(&rows, kind, only, to_print, error);
  return rows;
}

static status read_digest(struct digest_rows *rows, struct digest *sum) {
  status result = STATUS_OK;
  for (size_t i = 0; i < rows->count; i++) {
    const struct digest_table *table = &rows->tables[i];
    sqlite3_bind_int64(table->rows, 1, rows->number);
    while (sql_next(table->rows, &result, doing, rows->error)) {
      const uint64_t row = sqlite3_column_type(table->rows, 0) == SQLITE_TEXT
                               ? digest_row(sql_text(table->rows, 0), (size_t)sqlite3_column_bytes(table->rows, 0))
                               : (uint64_t)sqlite3_column_int64(table->rows, 0);
      for (int k = 1; k < sqlite3_column_count(table->rows); k++)
        digest_add(sum, table->names[k], row, sql_of_column(table->rows, k));
    }
    sqlite3_reset(table->rows);
  }
  return result;
}

bool digest_rows_next(struct digest_rows *rows) {
  struct digest sum = {0};
  if (!sql_next(rows->numbers, &rows->code, doing, rows->error))
    return false;
  rows->number = sqlite3_column_int64(rows->numbers, 0);
  rows->code = read_digest(rows, &sum);
  digest_write(sum, rows->digest);
  rows->whole = sqlite3_column_bytes(rows->numbers, 1) == sizeof rows->digest &&
                memcmp(rows->digest, sqlite3_column_blob(rows->numbers, 1), sizeof rows->digest) == 0;
  return rows->code == STATUS_OK;
}

status digest_rows_end(struct digest_rows *rows) {
  for (size_t i = 0; i < rows->count; i++) {
    sqlite3_finalize(rows->tables[i].rows);
    free(rows->tables[i].names);
  }
  sqlite3_finalize(rows->numbers);
  rows->numbers = NULL;
  rows->count = 0;
  return rows->code;
}

status digest_set_fields(sqlite3 *db, int64_t run_id, const char *path, struct sql_value digest, struct error *error) {
  static const char noting[] = "noting a fields file";
  const struct digest name = digest_name("run", "fields_digest");
  STATEMENT run = NULL;
  STATEMENT update = NULL;
  struct digest sum = {0}, before = {0};
  uint8_t bytes[16];
  TRY(sql_prepare(db, "SELECT digest, fields_digest FROM main.run WHERE run_id = ?1", &run, noting, error));
  TRY(sql_prepare(db, "UPDATE main.run SET fields_path = ?2, fields_digest = ?3, digest = ?4 WHERE run_id = ?1",
                  &update, noting, error));
  sqlite3_bind_int64(run, 1, run_id);
  status result = STATUS_OK;
  if (!sql_next(run, &result, noting, error))
    return result;
  SQL_BIND(update, sql_of_integer(run_id), sql_of_text(path), digest);
  if (sqlite3_column_bytes(run, 0) == sizeof bytes) {
    const uint8_t *stored = sqlite3_column_blob(run, 0);
    sum = (struct digest){word_at(stored, 8), word_at(stored + 8, 8)};
    digest_add(&before, name, 0, sql_of_column(run, 1));
    sum.a -= before.a;
    sum.b -= before.b;
    digest_add(&sum, name, 0, digest);
    digest_write(sum, bytes);
    sqlite3_bind_blob(update, 4, bytes, sizeof bytes, SQLITE_STATIC);
  }
  return sql_run(update, noting, error);
}

status digest_rows_print(sqlite3 *db, enum digest_kind kind, FILE *out, struct error *error) {
  DIGEST_ROWS rows = digest_rows(db, kind, 0, true, error);
  while (digest_rows_next(&rows)) {
    char digest[2 * sizeof rows.digest + 1];
    text_hex(rows.digest, sizeof rows.digest, digest);
    fprintf(out, "%s %s %s\n", rows.table, sql_text(rows.numbers, 2), digest);
  }
  if (rows.code == STATUS_OK && ferror(out))
    return status_fail(error, STATUS_IO, "writing the digests failed: %s", strerror(errno));
  return digest_rows_end(&rows);
}
