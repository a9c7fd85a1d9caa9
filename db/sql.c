/* SQLite errors as statuses with remedies, and statements bound from tables of columns. */
#include "db/sql.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

/* `system`: errno of the failed call, or 0 */
static const char *remedy(int code, int system) {
  if (system == EMFILE || system == ENFILE)
    return "Allow the process more open files (`ulimit -n 1024`), then give the same command again.";
  if (code == SQLITE_READONLY_ROLLBACK)
    return "A file with -journal after the store's name lies beside it: a program was stopped while it wrote the "
           "store, or the journal is another store's. Give that program's command again, such as `clast run`: it "
           "brings the store in order. If the journal is another store's, move it away.";
  switch (code & 0xff) {
  case SQLITE_FULL:
    return "The disk is full (or a quota or file size limit is reached). What was committed is safe; free some space "
           "and give the same command again.";
  case SQLITE_READONLY:
    return "The file or its folder cannot be written. Give yourself write permission, or copy the store elsewhere.";
  case SQLITE_PERM:
  case SQLITE_AUTH: return "Permission was refused. Look at the owner and the permissions of the file and its folder.";
  case SQLITE_CANTOPEN:
    return "It cannot be opened. Look whether its folder exists and may be written, and at the file's permissions.";
  case SQLITE_BUSY:
  case SQLITE_LOCKED:
    return "Another program holds the store. Close it there (a database browser with unsaved changes?), then give the "
           "same command again.";
  case SQLITE_IOERR:
    return "Reading or writing failed (disk full, quota, file size limit, or a disk or network file system in "
           "trouble). What was committed is safe; mend that and give the same command again.";
  case SQLITE_CORRUPT: return "The file is damaged. Restore a copy, or recover a part with `sqlite3 FILE .recover`.";
  case SQLITE_CONSTRAINT:
    return "A row breaks a rule of the store's tables: a file is damaged, or another program has changed it. `clast "
           "check` tells more.";
  case SQLITE_NOTADB: return "It is not an SQLite database.";
  case SQLITE_NOMEM: return "Memory ran out.";
  case SQLITE_TOOBIG:
    return "A value is longer than those that clast stores: the file is damaged, or another program has changed it. "
           "`clast check` tells more.";
  default: return "This is a bug in clast, or another program has changed the store's tables.";
  }
}

static status status_of(int code) {
  switch (code & 0xff) {
  case SQLITE_FULL:
  case SQLITE_READONLY:
  case SQLITE_PERM:
  case SQLITE_AUTH:
  case SQLITE_CANTOPEN:
  case SQLITE_LOCKED:
  case SQLITE_IOERR: return STATUS_IO;
  case SQLITE_BUSY: return STATUS_STOPPED;
  case SQLITE_CORRUPT:
  case SQLITE_CONSTRAINT:
  case SQLITE_TOOBIG:
  case SQLITE_NOTADB: return STATUS_CONTENT;
  case SQLITE_NOMEM: return STATUS_MEMORY;
  default: return STATUS_INTERNAL;
  }
}

bool sql_values_are_wrong(sqlite3 *db, int code) {
  const char *why = sqlite3_errmsg(db);
  return (code & 0xff) == SQLITE_ERROR && (strcmp(why, "integer overflow") == 0 || strcmp(why, "malformed JSON") == 0);
}

status sql_fail(sqlite3 *db, int code, const char *doing, struct error *error) {
  const char *path = db ? sqlite3_db_filename(db, "main") : NULL;
  const char *file = path && *path ? path : "(in memory)";
  int system = db ? sqlite3_system_errno(db) : 0;
  if (db && sql_values_are_wrong(db, code))
    return status_fail(error, STATUS_CONTENT,
                       "%s: %s failed: %s. Values in the store are none that clast writes: the file is damaged, or "
                       "another program has changed it. Restore a copy.",
                       file, doing, sqlite3_errmsg(db));
  return status_fail(error, status_of(code), "%s: %s failed: %s%s%s%s. %s", file, doing,
                     db ? sqlite3_errmsg(db) : sqlite3_errstr(code), system ? " (" : "", system ? strerror(system) : "",
                     system ? ")" : "", remedy(code, system));
}

void sql_finalize(sqlite3_stmt **statement) {
  sqlite3_finalize(*statement);
}

void sql_free_text(char **text) {
  sqlite3_free(*text);
}

const char *sql_skip(const char *text, const char *blanks) {
  for (;;) {
    text += strspn(text, blanks);
    if (strncmp(text, "--", 2) == 0) {
      text += strcspn(text, "\n");
    } else if (strncmp(text, "/*", 2) == 0) {
      const char *end = strstr(text + 2, "*/");
      text = end ? end + 2 : text + strlen(text);
    } else {
      return text;
    }
  }
}

status sql_execute(sqlite3 *db, const char *sql, const char *doing, struct error *error) {
  int code = sqlite3_exec(db, sql, NULL, NULL, NULL);
  return code == SQLITE_OK ? STATUS_OK : sql_fail(db, code, doing, error);
}

char *sql_format_of(const char *format, va_list arguments) {
  char *text = sqlite3_vmprintf(format, arguments);
  if (!text)
    memory_refused();
  return text;
}

char *sql_format(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char *text = sql_format_of(format, arguments);
  va_end(arguments);
  return text;
}

status sql_executef(sqlite3 *db, const char *doing, struct error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  return sql_execute(db, sql, doing, error);
}

status sql_preparef(sqlite3 *db, sqlite3_stmt **out, const char *doing, struct error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  return sql_prepare(db, sql, out, doing, error);
}

status sql_prepare(sqlite3 *db, const char *sql, sqlite3_stmt **out, const char *doing, struct error *error) {
  int code = sqlite3_prepare_v3(db, sql, -1, SQLITE_PREPARE_PERSISTENT, out, NULL);
  return code == SQLITE_OK ? STATUS_OK : sql_fail(db, code, doing, error);
}

status sql_prepare_once(sqlite3 *db, sqlite3_stmt **out, const char *sql, const char *doing, struct error *error) {
  return *out ? STATUS_OK : sql_prepare(db, sql, out, doing, error);
}

status sql_run(sqlite3_stmt *statement, const char *doing, struct error *error) {
  int code = sqlite3_step(statement);
  status result = code == SQLITE_DONE || code == SQLITE_ROW
                      ? STATUS_OK
                      : sql_fail(sqlite3_db_handle(statement), code, doing, error);
  sqlite3_reset(statement);
  return result;
}

bool sql_next(sqlite3_stmt *statement, status *result, const char *doing, struct error *error) {
  if (*result != STATUS_OK)
    return false;
  int code = sqlite3_step(statement);
  if (code != SQLITE_ROW && code != SQLITE_DONE)
    *result = sql_fail(sqlite3_db_handle(statement), code, doing, error);
  return code == SQLITE_ROW;
}

const char *sql_text(sqlite3_stmt *statement, int column) {
  const char *text = (const char *)sqlite3_column_text(statement, column);
  return text ? text : "";
}

status sql_integer(sqlite3 *db, const char *sql, int64_t otherwise, int64_t *out, struct error *error) {
  STATEMENT statement = NULL;
  status result = STATUS_OK;
  TRY(sql_prepare(db, sql, &statement, "reading", error));
  *out = otherwise;
  if (sql_next(statement, &result, "reading", error) && sqlite3_column_type(statement, 0) != SQLITE_NULL)
    *out = sqlite3_column_int64(statement, 0);
  return result;
}

status sql_integerf(sqlite3 *db, int64_t *out, struct error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  return sql_integer(db, sql, 0, out, error);
}

status sql_textf(sqlite3 *db, char **text, const char *doing, struct error *error, const char *format, ...) {
  STATEMENT statement = NULL;
  status result = STATUS_OK;
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  TRY(sql_prepare(db, sql, &statement, doing, error));
  const bool there = sql_next(statement, &result, doing, error);
  TRY(result);
  *text = sqlite3_mprintf("%s", there ? sql_text(statement, 0) : "");
  return *text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
}

void sql_write_name(const char *name, FILE *out) {
  fputc('"', out);
  for (; *name; name++) {
    if (*name == '"')
      fputc('"', out);
    fputc(*name, out);
  }
  fputc('"', out);
}

struct sql_value sql_of_text(const char *text) {
  if (!text)
    return (struct sql_value){.type = SQLITE_NULL};
  return (struct sql_value){.type = SQLITE_TEXT, .bytes = text, .size = strlen(text)};
}

struct sql_value sql_of_field(const struct field *row, const void *object, bool off_as_text) {
  const void *place = (const char *)object + row->offset;
  switch (row->kind) {
  case FIELD_REAL:
    if (!isnan(*(const double *)place))
      return sql_of_real(*(const double *)place);
    return off_as_text ? sql_of_text("off") : (struct sql_value){.type = SQLITE_NULL};
  case FIELD_INTEGER: return sql_of_integer(*(const int64_t *)place);
  case FIELD_BOOLEAN: return sql_of_integer(*(const bool *)place);
  case FIELD_CHOICE: return sql_of_text(row->choices[*(const int *)place]);
  case FIELD_TEXT: break;
  }
  return sql_of_text(place);
}

struct sql_value sql_of_argument(sqlite3_value *argument) {
  struct sql_value value = {.type = sqlite3_value_type(argument)};
  switch (value.type) {
  case SQLITE_INTEGER: value.integer = sqlite3_value_int64(argument); break;
  case SQLITE_FLOAT: value.real = sqlite3_value_double(argument); break;
  case SQLITE_TEXT: value.bytes = sqlite3_value_text(argument); break;
  case SQLITE_BLOB: value.bytes = sqlite3_value_blob(argument); break;
  default: return value;
  }
  if (value.bytes)
    value.size = (size_t)sqlite3_value_bytes(argument);
  return value;
}

void sql_bind(sqlite3_stmt *statement, int index, struct sql_value value) {
  switch (value.type) {
  case SQLITE_INTEGER: sqlite3_bind_int64(statement, index, value.integer); break;
  case SQLITE_FLOAT: sqlite3_bind_double(statement, index, value.real); break;
  case SQLITE_TEXT: sqlite3_bind_text64(statement, index, value.bytes, value.size, SQLITE_STATIC, SQLITE_UTF8); break;
  case SQLITE_BLOB: sqlite3_bind_blob64(statement, index, value.bytes, value.size, SQLITE_STATIC); break;
  default: sqlite3_bind_null(statement, index);
  }
}

int sql_bind_all(sqlite3_stmt *statement, size_t count, const struct sql_value *values) {
  for (size_t i = 0; i < count; i++)
    sql_bind(statement, (int)i + 1, values[i]);
  return (int)count + 1;
}

void sql_bind_text(sqlite3_stmt *statement, int index, const char *text) {
  sql_bind(statement, index, sql_of_text(text));
}

status sql_prepare_insert(sqlite3 *db, sqlite3_stmt **out, const char *table, const char *columns,
                          const struct field_table *fields, size_t rows, const char *doing, struct error *error) {
  size_t more = 0; /* parameters of a row behind the first one */
  if (*out)
    return STATUS_OK;
  sqlite3_str *sql = sqlite3_str_new(db);
  sqlite3_str_appendf(sql, "INSERT INTO \"%w\" (%s", table, columns);
  for (; fields && more < fields->count; more++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(fields->rows[more].path, name, sizeof name);
    sqlite3_str_appendf(sql, ", \"%w\"", name);
  }
  for (const char *comma = columns; (comma = strchr(comma, ',')); comma++)
    more++;
  sqlite3_str_appendall(sql, ") VALUES ");
  for (size_t row = 0; row < rows; row++) {
    sqlite3_str_appendall(sql, row ? "), (?" : "(?");
    for (size_t i = 0; i < more; i++)
      sqlite3_str_appendall(sql, ", ?");
  }
  return sql_preparef(db, out, doing, error, "%z)", sqlite3_str_finish(sql));
}

int sql_bind_fields(sqlite3_stmt *statement, int at, const struct field_table *fields, const void *object) {
  for (size_t i = 0; i < fields->count; i++, at++) {
    const struct field *row = &fields->rows[i];
    if (row->when && !field_is_active(fields, row, object))
      sqlite3_bind_null(statement, at);
    else
      sql_bind(statement, at, sql_of_field(row, object, false));
  }
  return at;
}

const char *sql_type(const struct field *row) {
  switch (row->kind) {
  case FIELD_REAL: return "REAL";
  case FIELD_INTEGER:
  case FIELD_BOOLEAN: return "INTEGER";
  case FIELD_CHOICE:
  case FIELD_TEXT: break;
  }
  return "TEXT";
}
