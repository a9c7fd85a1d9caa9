/* Answers of a store, pulled row by row. */
#include "db/ask/answer.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "schemas/clock.h"

enum { STEPS_BETWEEN_LOOKS = 10000 };

/* SQLite calls this during long steps; true interrupts. */
static int is_late(void *context) {
  const struct store *store = context;
  return clock_s() > store->deadline;
}

/* A pragma that describes the database. journal_mode with a value would change it. */
static bool describes(const char *pragma, const char *value) {
  static const char *const describing[] = {"table_info",     "table_xinfo",       "table_list",       "index_list",
                                           "index_info",     "index_xinfo",       "foreign_key_list", "database_list",
                                           "application_id", "schema_version",    "user_version",     "page_count",
                                           "page_size",      "function_list",     "compile_options",  "integrity_check",
                                           "quick_check",    "foreign_key_check", "encoding",         NULL};
  return strcmp(pragma, "journal_mode") == 0 ? !value : text_is_one_of(pragma, describing);
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
  bool *refused = context;
  (void)database, (void)trigger;
  if (only_reads(action, first, second))
    return SQLITE_OK;
  *refused = true;
  return SQLITE_DENY;
}

/* Is the SQL text at fault, and not the store or the program? Too big a value and a value of the wrong type are the
 * results of an expression. */
static bool is_of_sql(int code) {
  const int kind = code & 0xff;
  return kind == SQLITE_ERROR || kind == SQLITE_TOOBIG || kind == SQLITE_MISMATCH || kind == SQLITE_RANGE;
}

static const char between_statements[] = " \t\n\v\f\r;";

/* SQLite says that there is no column X: names the columns of the view runs that end in it ("strain" or
 * "threshold.strain" for threshold_strain, "material" for target_material_name), as tables and --by call them. */
static void suggest_columns(sqlite3 *db, const char *message, char *names, size_t size) {
  static const char no_column[] = "no such column: ";
  char typed[128], found[400] = "";
  STATEMENT columns = NULL;
  struct error ignored;
  if (strncmp(message, no_column, strlen(no_column)) != 0)
    return;
  snprintf(typed, sizeof typed, "_%.120s", message + strlen(no_column));
  for (char *dot = typed; (dot = strchr(dot, '.'));)
    *dot = '_';
  if (sql_prepare(
          db,
          "SELECT name FROM pragma_table_info('runs') WHERE ?1 IN (substr('_' || name, -length(?1)), substr('_' || "
          "replace(name || '$', '_name$', ''), -length(?1))) LIMIT 4",
          &columns, "looking for a column", &ignored))
    return;
  sqlite3_bind_text(columns, 1, typed, -1, SQLITE_STATIC);
  while (sqlite3_step(columns) == SQLITE_ROW)
    text_append(found, sizeof found, "%s%s", *found ? ", " : "", (const char *)sqlite3_column_text(columns, 0));
  if (*found)
    snprintf(names, size, ". The view runs has %s", found);
}

static status refuse_sql(sqlite3 *db, const char *sql, struct error *error) {
  const int offset = sqlite3_error_offset(db);
  char message[400], place[240] = "", names[440] = "";
  snprintf(message, sizeof message, "%s", sqlite3_errmsg(db));
  const size_t line = offset >= 0 && (size_t)offset < strlen(sql) ? strcspn(sql + offset, "\n") : 0;
  if (line > 0)
    snprintf(place, sizeof place, ", at: %.*s", line < 200 ? (int)line : 200, sql + offset);
  suggest_columns(db, message, names, sizeof names);
  return status_fail(error, STATUS_USAGE, "SQL error: %s%s%s", message, place, names);
}

/* Prepares one statement that only reads. SQLite compiles it again when the tables change meanwhile; what it then names
 * can only be other tables or views, which cannot write. */
static status prepare(struct store *store, const char *sql, sqlite3_stmt **statement, struct error *error) {
  const char *tail = "";
  bool refused = false;
  if (!*sql_skip(sql, between_statements))
    return status_fail(error, STATUS_USAGE, "The query is empty: give one SELECT.");
  sqlite3_set_authorizer(store->db, authorize, &refused);
  const int code = sqlite3_prepare_v2(store->db, sql, -1, statement, &tail);
  sqlite3_set_authorizer(store->db, NULL, NULL);
  if (code == SQLITE_AUTH || refused || (*statement && !sqlite3_stmt_readonly(*statement)))
    return status_fail(error, STATUS_USAGE,
                       "A query may only read (SELECT): this statement would change something, or open another file.");
  if (is_of_sql(code))
    return refuse_sql(store->db, sql, error);
  if (code != SQLITE_OK)
    return sql_fail(store->db, code, "the query", error);
  if (*sql_skip(tail, between_statements))
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

struct answer answer_to_user(struct store *store, const char *sql, size_t parameter_count,
                             const struct query_parameter *parameters, double time_limit_s, struct error *error) {
  struct answer answer = {.store = store, .error = error, .limited = time_limit_s > 0};
  answer.code = prepare(store, sql, &answer.statement, error);
  if (answer.code == STATUS_OK)
    answer.code = bind(answer.statement, parameter_count, parameters, error);
  if (answer.limited) {
    store->deadline = clock_s() + time_limit_s;
    sqlite3_progress_handler(store->db, STEPS_BETWEEN_LOOKS, is_late, store);
  }
  return answer;
}

struct answer answer_to(struct store *store, struct error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  return answer_to_user(store, sql, 0, NULL, 0, error);
}

struct answer answer_failed(status code, struct error *error) {
  return (struct answer){.error = error, .code = code};
}

/* Finds out why there was no next row. */
static status judge_end(const struct answer *answer, int code) {
  sqlite3 *db = answer->store->db;
  if (code == SQLITE_DONE)
    return STATUS_OK;
  if (code == SQLITE_INTERRUPT && answer->limited)
    return status_fail(answer->error, STATUS_STOPPED,
                       "The query took longer than its time limit and was stopped: narrow it, or "
                       "raise the limit.");
  if (sql_values_are_wrong(db, code))
    return status_fail(answer->error, STATUS_CONTENT,
                       "SQL error: %s. A value in the store, or in the SQL text, is not usable.", sqlite3_errmsg(db));
  if ((code & 0xff) == SQLITE_TOOBIG)
    return status_fail(answer->error, STATUS_USAGE,
                       "SQL error: %s. A value may have %d MiB: ask for less, or for a part of it (substr).",
                       sqlite3_errmsg(db), sqlite3_limit(db, SQLITE_LIMIT_LENGTH, -1) >> 20);
  if (is_of_sql(code))
    return status_fail(answer->error, STATUS_USAGE, "SQL error: %s", sqlite3_errmsg(db));
  return sql_fail(db, code, "the query", answer->error);
}

bool answer_next(struct answer *answer) {
  if (answer->code || !answer->statement)
    return false;
  const int code = sqlite3_step(answer->statement);
  if (code == SQLITE_ROW)
    return true;
  answer->code = judge_end(answer, code);
  if (answer->code == STATUS_OK)
    (void)answer_end(answer); /* a step beyond the end would begin anew */
  return false;
}

status answer_end(struct answer *answer) {
  sqlite3_finalize(answer->statement);
  answer->statement = NULL;
  if (answer->limited)
    sqlite3_progress_handler(answer->store->db, 0, NULL, NULL);
  answer->limited = false;
  return answer->code;
}

status answer_status(const struct answer *answer) {
  return answer->code;
}

size_t answer_count(const struct answer *answer) {
  return answer->statement ? (size_t)sqlite3_column_count(answer->statement) : 0;
}

const char *answer_name(const struct answer *answer, size_t column) {
  return sqlite3_column_name(answer->statement, (int)column);
}

struct query_value answer_value(const struct answer *answer, size_t column) {
  sqlite3_stmt *statement = answer->statement;
  const int i = (int)column;
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

int64_t answer_integer(const struct answer *answer, size_t column) {
  return answer_value(answer, column).integer;
}

double answer_real(const struct answer *answer, size_t column) {
  return answer_value(answer, column).real;
}

const char *answer_text(const struct answer *answer, size_t column) {
  const struct query_value value = answer_value(answer, column);
  return value.text ? value.text : "";
}

bool answer_masses(struct answer *answer, size_t column, const char *of, const void **masses, size_t *count) {
  const struct query_value value = answer_value(answer, column);
  *masses = value.blob;
  *count = value.size / sizeof(double);
  if (value.kind == QUERY_BLOB && value.size % sizeof(double) == 0)
    return true;
  answer->code = status_fail(answer->error, STATUS_CONTENT,
                             "the fragment masses of %s are damaged; `clast check` tells more", of);
  return false;
}

status answer_number(struct store *store, double *number, struct error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  SQL_TEXT sql = sql_format_of(format, arguments);
  va_end(arguments);
  struct answer answer = answer_to_user(store, sql, 0, NULL, 0, error);
  *number = answer_next(&answer) ? answer_real(&answer, 0) : (double)NAN;
  return answer_end(&answer);
}
