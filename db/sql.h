/* SQLite with our errors: every failure becomes a status and sentences with a remedy. For db/ only. */
#pragma once

#include <sqlite3.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "schemas/field.h"
#include "schemas/status.h"

/* Reports the connection's last error and its remedy in *error. `doing`: the activity, such as "adding a run". Returns
 * the status that fits the SQLite code. */
status sql_fail(sqlite3 *db, int code, const char *doing, struct error *error);

/* Did a statement fail because of the values in the rows? Sums leave 64 bits, a text is no JSON. No run gives such
 * values. */
bool sql_values_are_wrong(sqlite3 *db, int code);

/* A statement that is finalized where its block is left, so that TRY and return are allowed anywhere. */
#define STATEMENT __attribute__((cleanup(sql_finalize))) sqlite3_stmt *
void sql_finalize(sqlite3_stmt **statement); /* for STATEMENT */

/* A text of SQLite, such as one of sql_format(), that is freed where its block is left. */
#define SQL_TEXT __attribute__((cleanup(sql_free_text))) char *
void sql_free_text(char **text); /* for SQL_TEXT */
/* A text of SQL by sqlite3_mprintf(). Never NULL: without memory the process ends (schemas/memory.h). */
char *sql_format(const char *format, ...) __attribute__((returns_nonnull));
char *sql_format_of(const char *format, va_list arguments) __attribute__((returns_nonnull));

/* The first character of a text of SQL that is neither in `blanks` nor in a comment. */
const char *sql_skip(const char *text, const char *blanks);

/* Runs any number of statements. */
status sql_execute(sqlite3 *db, const char *sql, const char *doing, struct error *error);
/* The same, with the text made by sqlite3_mprintf: write names and literals that come from outside with %w and %Q. */
status sql_executef(sqlite3 *db, const char *doing, struct error *error, const char *format, ...);
status sql_prepare(sqlite3 *db, const char *sql, sqlite3_stmt **out, const char *doing, struct error *error);
/* The same, with the text made by sqlite3_mprintf. */
status sql_preparef(sqlite3 *db, sqlite3_stmt **out, const char *doing, struct error *error, const char *format, ...);
/* The same, but only if *out is NULL: for statements that are kept as long as the store is open. */
status sql_prepare_once(sqlite3 *db, sqlite3_stmt **out, const char *sql, const char *doing, struct error *error);
/* Steps a statement that gives no rows, and resets it. */
status sql_run(sqlite3_stmt *statement, const char *doing, struct error *error);
/* Steps to the next row while *result is STATUS_OK. Returns false at the end and after an error, whose status is then
 * in *result. */
bool sql_next(sqlite3_stmt *statement, status *result, const char *doing, struct error *error);
/* A column as text; "" where the row has NULL. Rows of a damaged or hostile file may have NULL anywhere. */
const char *sql_text(sqlite3_stmt *statement, int column);
/* First column of the first row as an integer; `otherwise` when there is no row or it is NULL. */
status sql_integer(sqlite3 *db, const char *sql, int64_t otherwise, int64_t *out, struct error *error);
/* The same, with 0 otherwise and the text made by sqlite3_mprintf. */
status sql_integerf(sqlite3 *db, int64_t *out, struct error *error, const char *format, ...);
/* *text: the first column of the first row, "" if there is none; free it with sqlite3_free(). The SQL is made by
 * sqlite3_mprintf. */
status sql_textf(sqlite3 *db, char **text, const char *doing, struct error *error, const char *format, ...);

/* Writes a name within double quotes; double quotes inside the name are doubled. */
void sql_write_name(const char *name, FILE *out);

/* A value of a row. */
struct sql_value {
  int type; /* SQLITE_NULL, SQLITE_INTEGER, SQLITE_FLOAT, SQLITE_TEXT or SQLITE_BLOB */
  int64_t integer;
  double real;
  const void *bytes; /* of a text or blob; borrowed */
  size_t size;
};
static inline struct sql_value sql_of_integer(int64_t value) {
  return (struct sql_value){.type = SQLITE_INTEGER, .integer = value};
}
static inline struct sql_value sql_of_key(int64_t key) { /* 0 is NULL */
  return key ? sql_of_integer(key) : (struct sql_value){.type = SQLITE_NULL};
}
static inline struct sql_value sql_of_real(double value) {
  return (struct sql_value){.type = SQLITE_FLOAT, .real = value}; /* SQLite stores NaN as NULL */
}
static inline struct sql_value sql_of_bytes(const void *bytes, size_t size) {
  return (struct sql_value){.type = SQLITE_BLOB, .bytes = bytes, .size = size};
}
struct sql_value sql_of_text(const char *text); /* NULL is NULL */
/* The value that `row` describes in *object: NaN as NULL (as the text 'off' with off_as_text), choices by name. Texts
 * are those of *object. */
struct sql_value sql_of_field(const struct field *row, const void *object, bool off_as_text);
/* An argument of a function, valid until it returns. */
struct sql_value sql_of_argument(sqlite3_value *argument);
/* A column of the current row, valid until the next step. */
static inline struct sql_value sql_of_column(sqlite3_stmt *statement, int column) {
  return sql_of_argument(sqlite3_column_value(statement, column)); /* one thread uses a connection: no lock is needed */
}
/* Binds it by reference: its bytes must stay valid until the statement has run. */
void sql_bind(sqlite3_stmt *statement, int index, struct sql_value value);
/* Binds values to the parameters from the first one on: SQL_BIND(statement, sql_of_integer(run_id), sql_of_text(name)).
 * The value is the parameter behind them. */
#define SQL_BIND(statement, ...)                                                                                       \
  sql_bind_all(statement, sizeof((const struct sql_value[]){__VA_ARGS__}) / sizeof(struct sql_value),                  \
               (const struct sql_value[]){__VA_ARGS__})
int sql_bind_all(sqlite3_stmt *statement, size_t count, const struct sql_value *values);
/* A text bound by reference; NULL binds NULL. */
void sql_bind_text(sqlite3_stmt *statement, int index, const char *text);

/* Prepares an INSERT of these columns ("run_id, ordinal"), followed by those of a field table (NULL: none), for so many
 * rows at once; but only if *out is NULL. */
status sql_prepare_insert(sqlite3 *db, sqlite3_stmt **out, const char *table, const char *columns,
                          const struct field_table *fields, size_t rows, const char *doing, struct error *error);
/* Binds what the table describes in *object, from parameter `at` on. Returns the parameter behind them. The object must
 * live until the statement has run. */
int sql_bind_fields(sqlite3_stmt *statement, int at, const struct field_table *fields, const void *object);

/* STRICT type of a row's column. */
const char *sql_type(const struct field *row);
