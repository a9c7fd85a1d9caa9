/* Runs one read-only statement with a time limit. */
#include "db/ask/query.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* A pragma that describes the database. journal_mode with a value would change it. */
static bool describes(const char *pragma, const char *value) {
  static const char *const describing[] = {"table_info",     "table_xinfo",       "table_list",       "index_list",
                                           "index_info",     "index_xinfo",       "foreign_key_list", "database_list",
                                           "application_id", "schema_version",    "user_version",     "page_count",
                                           "page_size",      "function_list",     "compile_options",  "integrity_check",
                                           "quick_check",    "foreign_key_check", "encoding"};
  if (strcmp(pragma, "journal_mode") == 0)
    return !value;
  for (size_t i = 0; i < sizeof describing / sizeof describing[0]; i++)
    if (strcmp(pragma, describing[i]) == 0)
      return true;
  return false;
}

static bool only_reads(int action, const char *first, const char *second) {
  switch (action) {
  case SQLITE_SELECT:
  case SQLITE_READ:
  case SQLITE_RECURSIVE: return true;
  /* SQLite declares json_each and the like this way; a real update is refused because it is not read-only */
  case SQLITE_UPDATE: return first && strcmp(first, "sqlite_master") == 0;
  case SQLITE_FUNCTION: return !second || strcmp(second, "load_extension") != 0;
  case SQLITE_PRAGMA: return first && describes(first, second);
  default: return false;
  }
}

/* Allows reading only: no change, no other file, no transaction, and only pragmas that describe the database. */
static int authorize(void *context, int action, const char *first, const char *second, const char *database,
                     const char *trigger) {
  struct watch *watch = context;
  (void)database, (void)trigger;
  if (only_reads(action, first, second))
    return SQLITE_OK;
  watch->writes = true;
  return SQLITE_DENY;
}

/* Skips blanks, semicolons and comments. */
static const char *skip_space(const char *text) {
  for (;;) {
    text += strspn(text, " \t\n\v\f\r;");
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

static status refuse_sql(sqlite3 *db, const char *sql, struct error *error) {
  const int offset = sqlite3_error_offset(db);
  if (offset >= 0 && (size_t)offset < strlen(sql))
    return status_fail(error, STATUS_USAGE, "SQL error: %s, at: %.40s", sqlite3_errmsg(db), sql + offset);
  return status_fail(error, STATUS_USAGE, "SQL error: %s", sqlite3_errmsg(db));
}

static status prepare(struct store *store, const char *sql, struct watch *watch, sqlite3_stmt **statement,
                      struct error *error) {
  const char *tail = "";
  if (!*skip_space(sql))
    return status_fail(error, STATUS_USAGE, "The query is empty: give one SELECT.");
  const int code = sqlite3_prepare_v2(store->db, sql, -1, statement, &tail);
  const bool writes = code == SQLITE_AUTH || watch->writes || (*statement && !sqlite3_stmt_readonly(*statement));
  if (writes)
    return status_fail(error, STATUS_USAGE,
                       "A query may only read (SELECT): this statement would change something, or open another file.");
  if ((code & 0xff) == SQLITE_ERROR)
    return refuse_sql(store->db, sql, error);
  if (code != SQLITE_OK)
    return sql_fail(store->db, code, "the query", error);
  if (*skip_space(tail))
    return status_fail(error, STATUS_USAGE, "A query is one statement; a second one begins at: %.40s", tail);
  return STATUS_OK;
}

/* Binds the value as SQL reads a literal: an integer, a number, else text. */
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

/* The last value given for the statement's index-th parameter; NULL: none. */
static const struct query_parameter *value_for(sqlite3_stmt *statement, int index, size_t count,
                                               const struct query_parameter *parameters) {
  const char *name = sqlite3_bind_parameter_name(statement, index);
  while (name && count-- > 0)
    if (strcmp(parameters[count].name, name + 1) == 0)
      return &parameters[count];
  return NULL;
}

static bool is_used(sqlite3_stmt *statement, const struct query_parameter *parameter) {
  const int wanted = sqlite3_bind_parameter_count(statement);
  for (int i = 1; i <= wanted; i++)
    if (value_for(statement, i, 1, parameter))
      return true;
  return false;
}

static status bind(sqlite3_stmt *statement, size_t count, const struct query_parameter *parameters,
                   struct error *error) {
  const int wanted = sqlite3_bind_parameter_count(statement);
  for (int i = 1; i <= wanted; i++) {
    const struct query_parameter *parameter = value_for(statement, i, count, parameters);
    const char *name = sqlite3_bind_parameter_name(statement, i);
    if (!parameter)
      return status_fail(error, STATUS_USAGE, "The query needs a value for %s: give --with %s=VALUE.",
                         name ? name : "?", name ? name + 1 : "NAME");
    bind_text_or_number(statement, i, parameter->value);
  }
  for (size_t k = 0; k < count; k++)
    if (!is_used(statement, &parameters[k]))
      return status_fail(error, STATUS_USAGE, "The query has no parameter :%s.", parameters[k].name);
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

/* Finds out why there was no next row. */
static status judge_end(sqlite3_stmt *statement, int code, const struct watch *watch, struct error *error) {
  sqlite3 *db = sqlite3_db_handle(statement);
  if (code == SQLITE_DONE)
    return STATUS_OK;
  if (watch->late)
    return status_fail(error, STATUS_STOPPED,
                       "The query took longer than its time limit and was stopped: narrow it, or "
                       "raise the limit.");
  if ((code & 0xff) == SQLITE_ERROR)
    return status_fail(error, STATUS_USAGE, "SQL error: %s", sqlite3_errmsg(db));
  return sql_fail(db, code, "the query", error);
}

static status give_names(sqlite3_stmt *statement, size_t columns, const struct query_sink *sink, struct error *error) {
  if (!sink->columns)
    return STATUS_OK;
  const char **names = calloc(columns + 1, sizeof *names);
  if (!names)
    return status_fail(error, STATUS_MEMORY, "the query: memory ran out");
  for (size_t i = 0; i < columns; i++)
    names[i] = sqlite3_column_name(statement, (int)i);
  const status result = sink->columns(sink->context, columns, names, error);
  free(names);
  return result;
}

static status give_rows(sqlite3_stmt *statement, const struct query_sink *sink, const struct watch *watch,
                        struct error *error) {
  const size_t columns = (size_t)sqlite3_column_count(statement);
  status result = give_names(statement, columns, sink, error);
  if (result != STATUS_OK)
    return result;
  struct query_value *values = calloc(columns + 1, sizeof *values);
  if (!values)
    return status_fail(error, STATUS_MEMORY, "the query: memory ran out");
  int code = SQLITE_DONE;
  while (result == STATUS_OK && (code = sqlite3_step(statement)) == SQLITE_ROW) {
    for (size_t i = 0; i < columns; i++)
      values[i] = value_of(statement, (int)i);
    if (sink->row)
      result = sink->row(sink->context, columns, values, error);
  }
  free(values);
  return result == STATUS_OK ? judge_end(statement, code, watch, error) : result;
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
