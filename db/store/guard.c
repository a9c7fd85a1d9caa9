/* A store may come from an untrusted source, so its contents are treated as data. This file defines what a store may
 * contain: the tables, indexes and views of db/store/schema.h, and result tables of engines that this program lacks.
 * Anything else is refused with its name. SQLite itself lists the objects and columns of the file. It does not list
 * CHECKs and constraints: so the text of a table must be the one that this program writes for the file's columns. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/memory.h"

enum { LONGEST_VALUE = 1 << 28 }; /* bytes of a text or blob: the masses of 3e7 fragments */

/* json_valid() for the CHECKs of a store. SQLite (3.40) does not count its own one among the functions that an
 * untrusted schema may call. json() fails for what is no JSON. */
static void json_valid(sqlite3_context *context, int count, sqlite3_value **values) {
  STATEMENT statement = NULL;
  (void)count;
  if (sqlite3_value_type(values[0]) == SQLITE_NULL)
    return;
  if (sqlite3_prepare_v2(sqlite3_context_db_handle(context), "SELECT json(?1)", -1, &statement, NULL) == SQLITE_OK)
    sqlite3_bind_value(statement, 1, values[0]);
  sqlite3_result_int(context, statement && sqlite3_step(statement) == SQLITE_ROW);
}

static void finalize(void *statement) {
  sqlite3_finalize(statement);
}

static void close_own(void *own) {
  sqlite3_close(own);
}

/* printf() and format(). Those of SQLite (3.40) answer NULL for a text beyond the limit, as if there were none; these
 * end the query. The user data is a connection that has SQLite's own. They answer NULL for an empty text too: so the
 * text that they make begins with an x, which is taken off. */
static void format_within_limit(sqlite3_context *context, int count, sqlite3_value **values) {
  if (count == 0 || sqlite3_value_type(values[0]) == SQLITE_NULL)
    return;
  sqlite3_stmt *statement = sqlite3_get_auxdata(context, 0);
  const bool known = statement != NULL;
  if (!known) {
    sqlite3_str *sql = sqlite3_str_new(NULL);
    sqlite3_str_appendall(sql, "SELECT format('x' || ?1");
    for (int i = 2; i <= count; i++)
      sqlite3_str_appendf(sql, ", ?%d", i);
    char *text = sqlite3_mprintf("%z)", sqlite3_str_finish(sql));
    if (text)
      sqlite3_prepare_v2(sqlite3_user_data(context), text, -1, &statement, NULL);
    sqlite3_free(text);
  }
  for (int i = 0; statement && i < count; i++)
    sqlite3_bind_value(statement, i + 1, values[i]);
  if (!statement || sqlite3_step(statement) != SQLITE_ROW)
    sqlite3_result_error_nomem(context);
  else if (sqlite3_column_type(statement, 0) == SQLITE_NULL)
    sqlite3_result_error_toobig(context);
  else if (sqlite3_column_bytes(statement, 0) > 1)
    sqlite3_result_text(context, (const char *)sqlite3_column_text(statement, 0) + 1,
                        sqlite3_column_bytes(statement, 0) - 1, SQLITE_TRANSIENT);
  sqlite3_reset(statement);
  if (!known)
    sqlite3_set_auxdata(context, 0, statement, finalize);
}

static void bound_format(sqlite3 *db, const char *name) {
  sqlite3 *own = NULL;
  if (sqlite3_open(":memory:", &own) != SQLITE_OK) {
    sqlite3_close(own);
    return;
  }
  sqlite3_limit(own, SQLITE_LIMIT_LENGTH, LONGEST_VALUE);
  sqlite3_create_function_v2(db, name, -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS, own,
                             format_within_limit, NULL, NULL, close_own);
}

void guard_connection(sqlite3 *db) {
  static const struct {
    int option, value;
  } options[] = {
      {SQLITE_DBCONFIG_DEFENSIVE, 1},      {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
      {SQLITE_DBCONFIG_ENABLE_VIEW, 0}, /* disables views of the file, but not temporary ones: db/store/views.h */
      {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
  };
  for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
    sqlite3_db_config(db, options[i].option, options[i].value, NULL);
  sqlite3_create_function(db, "json_valid", 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS, NULL, json_valid,
                          NULL, NULL);
  bound_format(db, "printf");
  bound_format(db, "format");
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, LONGEST_VALUE);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
}

static void allow_attach(sqlite3 *db, bool allow) {
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, allow ? 1 : 0);
}

status guard_attach(sqlite3 *db, const char *source, const char *doing, struct error *error) {
  sqlite3_str *uri = sqlite3_str_new(NULL);
  sqlite3_str_appendall(uri, "file:");
  for (const unsigned char *c = (const unsigned char *)source; *c; c++)
    sqlite3_str_appendf(uri, isalnum(*c) || strchr("/._-", *c) ? "%c" : "%%%02x", *c);
  sqlite3_str_appendall(uri, "?mode=ro");
  char *text = sqlite3_str_finish(uri);
  if (!text)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  allow_attach(db, true);
  const status result = sql_executef(db, doing, error, "ATTACH %Q AS other", text);
  allow_attach(db, false);
  sqlite3_free(text);
  return result;
}

/* VACUUM attaches the new file and needs SQLite's own json_valid(). */
status guard_vacuum_into(sqlite3 *db, const char *path, const char *doing, struct error *error) {
  allow_attach(db, true);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 1, NULL);
  const status result = sql_executef(db, doing, error, "VACUUM INTO %Q", path);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
  allow_attach(db, false);
  return result;
}

static const char reading[] = "reading the schema";

struct guard {
  sqlite3 *db;
  FILE *out; /* what is not as clast makes it */
  size_t strangers;
};

/* Writes a text from the file without characters that move a terminal's cursor. */
static void write_name(const char *name, FILE *out) {
  fputc('"', out);
  for (size_t i = 0; name[i] && i < 100; i++)
    fputc((unsigned char)name[i] < ' ' || name[i] == 127 ? '?' : name[i], out);
  fputc('"', out);
}

static void refuse(struct guard *guard, const char *what, const char *name, const char *table) {
  if (guard->strangers++ >= 50)
    return;
  fprintf(guard->out, "%s%s ", guard->strangers > 1 ? ", " : "", what);
  write_name(name, guard->out);
  if (table) {
    fputs(" of ", guard->out);
    write_name(table, guard->out);
  }
}

/* Letters, digits and underscores: a name that needs no quotes. */
static bool is_plain(const char *name, size_t length) {
  for (size_t i = 0; i < length; i++)
    if (!isalnum((unsigned char)name[i]) && name[i] != '_')
      return false;
  return length > 0;
}

/* Finds the table that `name` should be. False: clast has no such table. */
static bool find_table(const char *name, struct schema_table *table) {
  for (size_t i = 0; i < schema_table_count(); i++) {
    *table = schema_table_at(i);
    if (strcmp(table->name, name) == 0)
      return true;
  }
  if (strncmp(name, "result_", 7) != 0 || !is_plain(name, strlen(name)) || strlen(name) >= sizeof table->name)
    return false;
  const struct engine_kind unknown = {.name = name + 7}; /* an engine that this program lacks */
  *table = schema_result_table(&unknown);
  return true;
}

/* Is it an object that clast or SQLite makes? SQLite makes the indexes of keys, which have no text, and the tables of
 * ANALYZE. Nothing is asked of a table before this: a question to a virtual table would run code of its module. */
static bool is_known(const char *type, const char *name, const char *table, const char *sql) {
  struct schema_table ours;
  if (strcmp(type, "index") == 0 && !*sql)
    return strncmp(name, "sqlite_autoindex_", 17) == 0;
  if (strcmp(sql, "CREATE TABLE sqlite_stat1(tbl,idx,stat)") == 0 ||
      strcmp(sql, "CREATE TABLE sqlite_stat4(tbl,idx,neq,nlt,ndlt,sample)") == 0)
    return true;
  if (strcmp(type, "table") == 0)
    return strncmp(sql, "CREATE TABLE ", 13) == 0 && find_table(name, &ours);
  for (size_t i = 0; strcmp(type, "index") == 0 && i < schema_indexes_count; i++)
    if (strcmp(name, schema_indexes[i].name) == 0)
      return strcmp(table, schema_indexes[i].table) == 0;
  for (size_t i = 0; strcmp(type, "view") == 0 && i < VIEWS_COUNT; i++) {
    char begin[80];
    snprintf(begin, sizeof begin, "CREATE VIEW %s AS", views_names[i]);
    if (strcmp(name, views_names[i]) == 0)
      return strncmp(sql, begin, strlen(begin)) == 0;
  }
  return false;
}

static status judge_objects(struct guard *guard, struct error *error) {
  STATEMENT rows = NULL;
  status result = sql_prepare(guard->db, "SELECT type, name, tbl_name, sql FROM main.sqlite_schema ORDER BY name",
                              &rows, reading, error);
  while (sql_next(rows, &result, reading, error))
    if (!is_known(sql_text(rows, 0), sql_text(rows, 1), sql_text(rows, 2), sql_text(rows, 3)))
      refuse(guard, sql_text(rows, 0), sql_text(rows, 1), NULL);
  return result;
}

/* An index lists columns, perhaps other main results than ours; it is neither unique nor partial, and has no
 * expression. */
static status judge_indexes(struct guard *guard, struct error *error) {
  STATEMENT rows = NULL;
  status result = sql_prepare(
      guard->db,
      "SELECT s.name FROM main.sqlite_schema s WHERE s.type = 'index' AND s.sql IS NOT NULL AND (NOT EXISTS "
      "(SELECT 1 FROM pragma_index_list(s.tbl_name, 'main') l WHERE l.name = s.name AND NOT l.\"unique\" "
      "AND NOT l.partial) OR EXISTS (SELECT 1 FROM pragma_index_xinfo(s.name, 'main') x WHERE x.key AND "
      "(x.cid < 0 OR x.desc OR x.coll <> 'BINARY')))",
      &rows, reading, error);
  while (sql_next(rows, &result, reading, error))
    refuse(guard, "index", sql_text(rows, 0), NULL);
  return result;
}

/* Length of the word, quoted text or single character at `at`. */
static size_t word_length(const char *at) {
  size_t length = 0;
  if (*at == '\'' || *at == '"' || *at == '`') {
    for (length = 1; at[length]; length++)
      if (at[length] == *at && at[++length] != *at)
        return length;
    return length;
  }
  while (isalnum((unsigned char)at[length]) || at[length] == '_' || at[length] == '.' || (at[length] & 0x80))
    length++;
  return length ? length : 1;
}

/* A text of SQL that can be compared: no comments, a blank after each word, no quotes around plain names. The caller
 * frees it. NULL: no memory. */
static char *comparable(const char *sql) {
  static const char blanks[] = " \t\r\n\f";
  char *text = malloc(2 * strlen(sql) + 1), *to = text;
  for (const char *at = sql_skip(sql, blanks); text && *at; at = sql_skip(at, blanks)) {
    const size_t length = word_length(at);
    const bool quoted = *at == '"' && length > 2 && is_plain(at + 1, length - 2);
    memcpy(to, at + quoted, length - 2 * quoted);
    to += length - 2 * quoted;
    *to++ = ' ';
    at += length;
  }
  if (text)
    *to = '\0';
  return text;
}

/* Takes the main results out of the rule that selects runs that count: an older store keeps its own (`.main_rank` in
 * schemas/field.h). */
static void forget_main_results(char *text) {
  const struct field *row;
  char word[SCHEMA_NAME_SIZE];
  for (size_t i = 0; (row = outcome_main(i)); i++) {
    snprintf(word, sizeof word, " AND %s IS NOT NULL ", row->path);
    for (char *at; (at = strstr(text, word));)
      memmove(at + 1, at + strlen(word), strlen(at + strlen(word)) + 1);
  }
}

/* Writes the text that this program would give the table with the columns that the file has, and refuses columns that
 * no version of the program makes. Those of another version are plain names and types. */
static status write_table(struct guard *guard, const struct schema_table *table, FILE *out, struct error *error) {
  STATEMENT columns = NULL;
  status result = sql_preparef(guard->db, &columns, reading, error,
                               "SELECT name, type, type IN ('REAL', 'INTEGER', 'TEXT') AND NOT \"notnull\" AND NOT pk "
                               "AND NOT hidden AND dflt_value IS NULL FROM pragma_table_xinfo(%Q, 'main')",
                               table->name);
  const bool may_grow = table->fields || strncmp(table->name, "result_", 7) == 0;
  const char *before = "";
  fprintf(out, "CREATE TABLE %s (", table->name);
  while (sql_next(columns, &result, reading, error)) {
    const char *name = sql_text(columns, 0);
    fputs(before, out);
    before = ", ";
    if (schema_write_column(table, name, out))
      continue;
    fprintf(out, "%s %s", name, sql_text(columns, 1));
    if (!may_grow || !is_plain(name, strlen(name)) || !sqlite3_column_int(columns, 2))
      refuse(guard, "column", name, table->name);
  }
  fprintf(out, "%s%s) %s", table->tail ? ", " : "", table->tail ? table->tail : "", table->options);
  return result;
}

/* `ours` and `sql`, which the file has, are texts of the table. */
static status compare(struct guard *guard, const char *table, const char *ours, const char *sql, struct error *error) {
  OWNED char *expected = comparable(ours), *found = comparable(sql);
  size_t same = 0;
  if (!expected || !found)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", reading);
  forget_main_results(expected);
  forget_main_results(found);
  while (found[same] && found[same] == expected[same])
    same++;
  if (found[same] || expected[same]) /* a part that begins before the difference */
    refuse(guard, "the text", found + (same > 70 ? same - 70 : 0), table);
  return STATUS_OK;
}

static status judge_table(struct guard *guard, const struct schema_table *table, const char *sql, struct error *error) {
  const size_t before = guard->strangers;
  OWNED char *ours = NULL;
  FILE *out = text_open(&ours);
  status result = write_table(guard, table, out, error);
  text_close_small(out, &ours);
  for (size_t i = 0; i < table->count; i++)
    if (!schema_may_lack(table->name, table->columns[i].name) &&
        !schema_has_column(guard->db, table->name, table->columns[i].name))
      refuse(guard, "the lack of column", table->columns[i].name, table->name);
  return result || guard->strangers != before ? result : compare(guard, table->name, ours, sql, error);
}

static status judge_tables(struct guard *guard, struct error *error) {
  STATEMENT rows = NULL;
  struct schema_table table;
  status result = sql_prepare(guard->db, "SELECT name, sql FROM main.sqlite_schema WHERE type = 'table' ORDER BY name",
                              &rows, reading, error);
  while (sql_next(rows, &result, reading, error))
    if (find_table(sql_text(rows, 0), &table))
      result = judge_table(guard, &table, sql_text(rows, 1), error);
  return result;
}

/* Rows of table axis name columns of the views: by the names that views_axis_column() gives. */
static status judge_axes(struct guard *guard, struct error *error) {
  STATEMENT rows = NULL;
  int count = 0;
  status result = sql_prepare(guard->db, "SELECT path, column_name FROM main.axis", &rows, reading, error);
  while (sql_next(rows, &result, reading, error)) {
    char plain[SCHEMA_NAME_SIZE];
    const char *path = sql_text(rows, 0), *name = sql_text(rows, 1);
    field_column_name(path, plain, sizeof plain);
    if (++count > LIMITS_AXES_OF_STORE || !is_plain(name, strlen(name)) ||
        (strcmp(name, plain) != 0 && (strncmp(name, "input_", 6) != 0 || strcmp(name + 6, plain) != 0)))
      refuse(guard, "the column of axis", path, NULL);
  }
  return result;
}

static status judge(struct guard *guard, struct error *error) {
  TRY(judge_objects(guard, error));
  if (guard->strangers == 0) {
    TRY(judge_indexes(guard, error));
    TRY(judge_tables(guard, error));
  }
  return guard->strangers == 0 && schema_has_column(guard->db, "axis", NULL) ? judge_axes(guard, error) : STATUS_OK;
}

status guard_schema(sqlite3 *db, const char *path, struct error *error) {
  OWNED char *names = NULL;
  struct guard guard = {.db = db, .out = text_open(&names)};
  const status result = judge(&guard, error);
  text_close_small(guard.out, &names);
  if (result || guard.strangers == 0)
    return result;
  return status_fail(error, STATUS_CONTENT,
                     "%s is not as clast makes its stores: %.6000s%s. clast ran and changed nothing. Remove your "
                     "own additions (`sqlite3 FILE`, then DROP ...; keep views of your own in another file that "
                     "attaches this one). Do not use the file if you do not know where that comes from.",
                     path, names, guard.strangers > 50 ? " and more" : "");
}
