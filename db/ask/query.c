/* Runs one statement that only reads, with a time limit. */
#include "db/ask/query.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "db/store/internal.h"
#include "schemas/clock.h"

enum { STEPS_BETWEEN_LOOKS = 10000 };

struct watch {     /* for the authorizer and the progress handler of a query */
  double deadline; /* s, monotonic; 0 = none */
  bool writes, late;
};

static int look(void *context) {
  struct watch *watch = context;
  watch->late = watch->deadline > 0 && clock_s() > watch->deadline;
  return watch->late;
}

/* Allows reading only: no change, no other file, no transaction, and only pragmas that describe. */
static int authorize(void *context, int action, const char *first, const char *second, const char *database,
                     const char *trigger) {
  static const char *const describing[] = {"table_info",     "table_xinfo",       "table_list",       "index_list",
                                           "index_info",     "index_xinfo",       "foreign_key_list", "database_list",
                                           "application_id", "schema_version",    "user_version",     "page_count",
                                           "page_size",      "function_list",     "compile_options",  "integrity_check",
                                           "quick_check",    "foreign_key_check", "journal_mode",     "encoding"};
  struct watch *watch = context;
  (void)database, (void)trigger;
  switch (action) {
  case SQLITE_SELECT:
  case SQLITE_READ:
  case SQLITE_RECURSIVE: return SQLITE_OK;
  case SQLITE_UPDATE: /* how SQLite declares json_each and the like; a real one is refused as not read-only */
    if (first && strcmp(first, "sqlite_master") == 0)
      return SQLITE_OK;
    break;
  case SQLITE_FUNCTION:
    if (second && strcmp(second, "load_extension") == 0)
      break;
    return SQLITE_OK;
  case SQLITE_PRAGMA:
    for (size_t i = 0; first && i < sizeof describing / sizeof describing[0]; i++)
      if (strcmp(first, describing[i]) == 0 && (strcmp(first, "journal_mode") != 0 || !second))
        return SQLITE_OK;
    break;
  default: break;
  }
  watch->writes = true;
  return SQLITE_DENY;
}

static bool only_space_and_comments(const char *text) {
  while (*text) {
    if (isspace((unsigned char)*text) || *text == ';')
      text++;
    else if (strncmp(text, "--", 2) == 0)
      text += strcspn(text, "\n");
    else if (strncmp(text, "/*", 2) == 0) {
      const char *end = strstr(text + 2, "*/");
      if (!end)
        return true;
      text = end + 2;
    } else
      return false;
  }
  return true;
}

static status prepare(struct store *store, const char *sql, struct watch *watch, sqlite3_stmt **statement,
                      struct error *error) {
  const char *tail = NULL;
  if (only_space_and_comments(sql))
    return status_fail(error, STATUS_USAGE, "The query is empty: give one SELECT.");
  int code = sqlite3_prepare_v2(store->db, sql, -1, statement, &tail);
  if (code == SQLITE_AUTH || watch->writes || (code == SQLITE_OK && *statement && !sqlite3_stmt_readonly(*statement)))
    return status_fail(error, STATUS_USAGE,
                       "A query may only read (SELECT): this statement would change something, or open another file.");
  if ((code & 0xff) == SQLITE_ERROR) {
    int offset = sqlite3_error_offset(store->db);
    if (offset >= 0 && (size_t)offset < strlen(sql))
      return status_fail(error, STATUS_USAGE, "SQL error: %s, at: %.40s", sqlite3_errmsg(store->db), sql + offset);
    return status_fail(error, STATUS_USAGE, "SQL error: %s", sqlite3_errmsg(store->db));
  }
  if (code != SQLITE_OK)
    return sql_fail(store->db, code, "the query", error);
  if (tail && !only_space_and_comments(tail))
    return status_fail(error, STATUS_USAGE, "A query is one statement; a second one begins at: %.40s", tail);
  return STATUS_OK;
}

/* As SQL would take the literal: an integer, a number, else text. */
static void bind_text_or_number(sqlite3_stmt *statement, int index, const char *value) {
  char *end = NULL;
  errno = 0;
  long long integer = strtoll(value, &end, 10);
  if (*value && *end == '\0' && errno == 0) {
    sqlite3_bind_int64(statement, index, integer);
    return;
  }
  double real = strtod(value, &end);
  if (*value && *end == '\0' && isfinite(real))
    sqlite3_bind_double(statement, index, real);
  else
    sqlite3_bind_text(statement, index, value, -1, SQLITE_TRANSIENT);
}

static status bind(sqlite3_stmt *statement, size_t count, const struct query_parameter *parameters,
                   struct error *error) {
  int wanted = sqlite3_bind_parameter_count(statement);
  for (int i = 1; i <= wanted; i++) {
    const char *name = sqlite3_bind_parameter_name(statement, i);
    bool found = false;
    for (size_t k = 0; k < count && name; k++)
      if (strcmp(parameters[k].name, name + 1) == 0) {
        bind_text_or_number(statement, i, parameters[k].value);
        found = true;
      }
    if (!found)
      return status_fail(error, STATUS_USAGE, "The query needs a value for %s: give --with %s=VALUE.",
                         name ? name : "?", name ? name + 1 : "NAME");
  }
  for (size_t k = 0; k < count; k++) {
    bool used = false;
    for (int i = 1; i <= wanted; i++) {
      const char *name = sqlite3_bind_parameter_name(statement, i);
      used = used || (name && strcmp(parameters[k].name, name + 1) == 0);
    }
    if (!used)
      return status_fail(error, STATUS_USAGE, "The query has no parameter :%s.", parameters[k].name);
  }
  return STATUS_OK;
}

static struct query_value value_of(sqlite3_stmt *statement, int i) {
  struct query_value value = {.real = (double)NAN};
  switch (sqlite3_column_type(statement, i)) {
  case SQLITE_INTEGER:
    value.kind = QUERY_INTEGER;
    value.integer = sqlite3_column_int64(statement, i);
    value.real = (double)value.integer;
    break;
  case SQLITE_FLOAT:
    value.kind = QUERY_REAL;
    value.real = sqlite3_column_double(statement, i);
    break;
  case SQLITE_TEXT:
    value.kind = QUERY_TEXT;
    value.text = (const char *)sqlite3_column_text(statement, i);
    break;
  case SQLITE_BLOB:
    value.kind = QUERY_BLOB;
    value.blob = sqlite3_column_blob(statement, i);
    break;
  default: break;
  }
  if (value.kind == QUERY_TEXT || value.kind == QUERY_BLOB)
    value.size = (size_t)sqlite3_column_bytes(statement, i);
  return value;
}

static status give_rows(sqlite3_stmt *statement, const struct query_sink *sink, const struct watch *watch,
                        struct error *error) {
  int columns = sqlite3_column_count(statement), code = SQLITE_DONE;
  status result = STATUS_OK;
  const char **names = calloc((size_t)columns + 1, sizeof *names);
  struct query_value *values = calloc((size_t)columns + 1, sizeof *values);
  if (!names || !values)
    result = status_fail(error, STATUS_MEMORY, "the query: memory ran out");
  for (int i = 0; result == STATUS_OK && i < columns; i++)
    names[i] = sqlite3_column_name(statement, i);
  if (result == STATUS_OK && sink->columns)
    result = sink->columns(sink->context, (size_t)columns, names, error);
  while (result == STATUS_OK && (code = sqlite3_step(statement)) == SQLITE_ROW) {
    for (int i = 0; i < columns; i++)
      values[i] = value_of(statement, i);
    if (sink->row)
      result = sink->row(sink->context, (size_t)columns, values, error);
  }
  if (result == STATUS_OK && code != SQLITE_DONE) {
    sqlite3 *db = sqlite3_db_handle(statement);
    if (watch->late)
      result = status_fail(error, STATUS_STOPPED,
                           "The query took longer than its time limit and was stopped: narrow it, or "
                           "raise the limit.");
    else if ((code & 0xff) == SQLITE_ERROR)
      result = status_fail(error, STATUS_USAGE, "SQL error: %s", sqlite3_errmsg(db));
    else
      result = sql_fail(db, code, "the query", error);
  }
  free(names);
  free(values);
  return result;
}

status query_run(struct store *store, const char *sql, size_t parameter_count, const struct query_parameter *parameters,
                 double time_limit_s, const struct query_sink *sink, struct error *error) {
  struct watch watch = {.deadline = time_limit_s > 0 ? clock_s() + time_limit_s : 0};
  sqlite3_stmt *statement = NULL;
  sqlite3_set_authorizer(store->db, authorize, &watch);
  sqlite3_progress_handler(store->db, STEPS_BETWEEN_LOOKS, time_limit_s > 0 ? look : NULL, &watch);
  status result = prepare(store, sql, &watch, &statement, error);
  if (result == STATUS_OK)
    result = bind(statement, parameter_count, parameters, error);
  if (result == STATUS_OK)
    result = give_rows(statement, sink, &watch, error);
  sqlite3_finalize(statement);
  sqlite3_progress_handler(store->db, 0, NULL, NULL);
  sqlite3_set_authorizer(store->db, NULL, NULL);
  return result;
}

static status keep_first(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct query_value *first = context;
  if (first->kind == QUERY_NULL && count > 0 && isnan(first->real))
    *first = values[0];
  return STATUS_OK;
}

status query_number(struct store *store, const char *sql, size_t parameter_count,
                    const struct query_parameter *parameters, double *number, struct error *error) {
  struct query_value first = {.real = (double)NAN};
  const struct query_sink sink = {.context = &first, .row = keep_first};
  status result = query_run(store, sql, parameter_count, parameters, 0, &sink, error);
  *number = first.real;
  return result;
}
