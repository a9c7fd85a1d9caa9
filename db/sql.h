/* SQLite with our errors: every failure becomes a status and sentences with a remedy. For db/ only. */
#ifndef CLAST_DB_SQL_H
#define CLAST_DB_SQL_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stdint.h>

#include "schemas/field.h"
#include "schemas/status.h"

/* What the connection's last error means to a person. `doing`: "adding a run". Returns the status that fits the code.
 */
status sql_fail(sqlite3 *db, int code, const char *doing, struct error *error);

/* Any number of statements. */
status sql_execute(sqlite3 *db, const char *sql, const char *doing, struct error *error);
/* The same, made by printf. Names and literals in it are ours: use %w and %Q of sqlite3_mprintf for others'. */
status sql_executef(sqlite3 *db, const char *doing, struct error *error, const char *format, ...);
status sql_prepare(sqlite3 *db, const char *sql, sqlite3_stmt **out, const char *doing, struct error *error);
/* The same unless *out is there already: for statements that live as long as the store. */
status sql_prepare_once(sqlite3 *db, sqlite3_stmt **out, const char *sql, const char *doing, struct error *error);
/* Step a statement that gives no rows, and reset it. */
status sql_run(sqlite3_stmt *statement, const char *doing, struct error *error);
/* First column of the first row as an integer; `otherwise` when there is no row or it is NULL. */
status sql_integer(sqlite3 *db, const char *sql, int64_t otherwise, int64_t *out, struct error *error);

/* Bind the value that `row` describes in *object: NaN as NULL (NaN as 'off' with off_as_text), choices
 * by name. Texts are bound by reference: *object must live until the statement has run. */
void sql_bind_field(sqlite3_stmt *statement, int index, const struct field *row, const void *object, bool off_as_text);
/* STRICT type of a row's column. */
const char *sql_type(const struct field *row);

#endif
