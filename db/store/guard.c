/* Compares the schema of a store with the schemas that programs of clast make. */
#include "db/store/guard.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/schema.h"
#include "db/store/schema_text.h"
#include "db/store/views.h"
#include "engine/outcome.h"
#include "schemas/text.h"

enum { LONGEST_VALUE = 1 << 28 }; /* bytes of a text or blob: the masses of 3e7 fragments */

/* json_valid() for the CHECKs of a store. SQLite (3.40) does not count its own one among the functions that an
 * untrusted schema may call. json() fails for what is no JSON. */
static void json_valid(sqlite3_context *context, int count, sqlite3_value **values) {
  sqlite3_stmt *statement = NULL;
  (void)count;
  if (sqlite3_value_type(values[0]) == SQLITE_NULL)
    return;
  if (sqlite3_prepare_v2(sqlite3_context_db_handle(context), "SELECT json(?1)", -1, &statement, NULL) == SQLITE_OK)
    sqlite3_bind_value(statement, 1, values[0]);
  sqlite3_result_int(context, statement && sqlite3_step(statement) == SQLITE_ROW);
  sqlite3_finalize(statement);
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
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, LONGEST_VALUE);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
}

static void allow_attach(sqlite3 *db, bool allow) {
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, allow ? 1 : 0);
}

status guard_attach(sqlite3 *db, const char *source, const char *doing, struct error *error) {
  char *uri = NULL;
  size_t size = 0;
  FILE *out = text_open(&uri, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  fputs("file:", out);
  for (const unsigned char *c = (const unsigned char *)source; *c; c++)
    fprintf(out, isalnum(*c) || strchr("/._-", *c) ? "%c" : "%%%02x", *c);
  fputs("?mode=ro", out);
  if (!text_close(out, &uri))
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  allow_attach(db, true);
  status result = sql_executef(db, doing, error, "ATTACH %Q AS other", uri);
  allow_attach(db, false);
  free(uri);
  return result;
}

/* VACUUM attaches the new file and needs SQLite's own json_valid(). */
status guard_vacuum_into(sqlite3 *db, const char *path, const char *doing, struct error *error) {
  allow_attach(db, true);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 1, NULL);
  status result = sql_executef(db, doing, error, "VACUUM INTO %Q", path);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
  allow_attach(db, false);
  return result;
}

struct guard {
  sqlite3 *db;
  int version;
  FILE *out; /* the names of unexpected objects */
  size_t strangers;
  bool out_of_memory;
};

/* Writes a name from the file without characters that move a terminal's cursor. */
static void write_name(const char *name, FILE *out) {
  fputc('"', out);
  for (size_t i = 0; name && name[i] && i < 100; i++)
    fputc((unsigned char)name[i] < ' ' || name[i] == 127 ? '?' : name[i], out);
  fputc('"', out);
}

static void stranger(struct guard *guard, const char *what, const char *name, const char *table) {
  if (guard->strangers++ >= 50)
    return;
  fprintf(guard->out, "%s%s ", guard->strangers > 1 ? ", " : "", what);
  write_name(name, guard->out);
  if (table) {
    fputs(" of ", guard->out);
    write_name(table, guard->out);
  }
}

/* Is `line` a column that another version of the program knew: a plain name and a type, and no more? */
static bool is_plain_column(const char *line) {
  static const char *const types[] = {"REAL", "INTEGER", "TEXT"};
  const size_t length = strcspn(line, " ");
  for (size_t i = 0; schema_text_is_plain(line, length) && i < sizeof types / sizeof types[0]; i++)
    if (line[length] == ' ' && strcmp(line + length + 1, types[i]) == 0)
      return true;
  return false;
}

/* Is it the rule that selects runs that count, with the main results of an older program (`.main_rank` in
 * schemas/field.h)? `ours` is the rule of this program. */
static bool is_older_rule(const char *line, const char *ours) {
  const char *states = strstr(ours, " IN ("), *from = states ? strstr(states, " AND ") : NULL;
  if (!from || strncmp(line, ours, (size_t)(from - ours)) != 0)
    return false;
  for (line += from - ours; strncmp(line, " AND ", 5) == 0;) {
    const struct field *row;
    const char *rest = NULL;
    for (size_t i = 0; !rest && (row = outcome_main(i)); i++)
      rest = schema_text_after(line + 5, row->path);
    if (!rest || strncmp(rest, "IS NOT NULL", 11) != 0)
      return false;
    line = rest + 11;
  }
  return strcmp(line, " ) )") == 0;
}

static bool same_first_word(const char *a, const char *b) {
  const size_t length = strcspn(a, " ");
  return strncmp(a, b, length) == 0 && (b[length] == ' ' || b[length] == '\0');
}

/* Is this line allowed in the table? */
static bool is_ours(const char *line, const struct schema_text *ours, bool may_grow) {
  for (size_t k = 1; k + 1 < ours->count; k++) {
    if (strcmp(line, ours->lines[k]) == 0)
      return true;
    if (same_first_word(line, ours->lines[k]))
      return schema_text_after(line, "counts") && is_older_rule(line, ours->lines[k]);
  }
  return may_grow && is_plain_column(line);
}

static bool has_line(const struct schema_text *text, const char *line) {
  for (size_t i = 1; i + 1 < text->count; i++)
    if (same_first_word(line, text->lines[i]))
      return true;
  return false;
}

static void compare_tables(struct guard *guard, const struct schema_table *table, const struct schema_text *found,
                           const struct schema_text *ours) {
  const bool may_grow = table->fields || strncmp(table->name, "result_", 7) == 0;
  if (found->count < 2 || strcmp(found->lines[0], ours->lines[0]) != 0 ||
      strcmp(found->lines[found->count - 1], ours->lines[ours->count - 1]) != 0)
    stranger(guard, "the text of table", table->name, NULL);
  for (size_t i = 1; i + 1 < found->count; i++) {
    char name[SCHEMA_NAME_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(found->lines[i], " "), found->lines[i]);
    if (!is_ours(found->lines[i], ours, may_grow))
      stranger(guard, "column", name, table->name);
  }
  for (size_t i = 1; guard->version == SCHEMA_VERSION && i <= table->count; i++)
    if (!has_line(found, ours->lines[i]))
      stranger(guard, "the lack of column", table->columns[i - 1].name, table->name);
}

/* Reads the text of both; `write` writes ours. */
static void read_both(struct guard *guard, const char *sql, const struct schema_table *table,
                      const struct schema_index *index, struct schema_text *found, struct schema_text *ours) {
  char *text = NULL;
  size_t size = 0;
  *found = *ours = (struct schema_text){.count = 0};
  FILE *out = text_open(&text, &size);
  if (out && table)
    schema_write_table(table, out);
  else if (out)
    schema_write_index(index, out);
  char *end = out && text_close(out, &text) ? strrchr(text, ';') : NULL;
  if (end)
    *end = '\0'; /* the schema keeps texts without it */
  guard->out_of_memory = guard->out_of_memory || !text || !schema_text_read(text, ours);
  if (!guard->out_of_memory && !schema_text_read(sql, found)) {
    guard->out_of_memory = !found->text;
    stranger(guard, "the text of", table ? table->name : index->name, NULL);
  }
  free(text);
}

static void judge_table(struct guard *guard, const struct schema_table *table, const char *sql) {
  struct schema_text *texts = calloc(2, sizeof *texts);
  if (!texts) {
    guard->out_of_memory = true;
    return;
  }
  read_both(guard, sql, table, NULL, &texts[0], &texts[1]);
  if (!guard->out_of_memory)
    compare_tables(guard, table, &texts[0], &texts[1]);
  schema_text_clear(&texts[0]);
  schema_text_clear(&texts[1]);
  free(texts);
}

/* Checks an index: it lists columns, perhaps other main results than ours; it is neither unique nor partial. */
static void judge_index(struct guard *guard, const struct schema_index *index, const char *sql) {
  struct schema_text *texts = calloc(2, sizeof *texts), *found = texts, *ours = texts + 1;
  if (!texts) {
    guard->out_of_memory = true;
    return;
  }
  read_both(guard, sql, NULL, index, found, ours);
  bool same = found->count > 2 && strcmp(found->lines[0], ours->lines[0]) == 0 &&
              strcmp(found->lines[found->count - 1], ours->lines[ours->count - 1]) == 0;
  for (size_t i = 1; same && i + 1 < found->count; i++)
    same = schema_text_is_plain(found->lines[i], strlen(found->lines[i]));
  if (!same && !guard->out_of_memory)
    stranger(guard, "index", index->name, NULL);
  schema_text_clear(found);
  schema_text_clear(ours);
  free(texts);
}

/* Tables that earlier programs made. */
static const struct schema_column motion_columns[] = {
    {"run_id", "INTEGER PRIMARY KEY REFERENCES run (run_id)", NULL, ""},
    {"motion", "BLOB NOT NULL", NULL, ""},
};
static const struct schema_table motion = {.name = "fragment_motion",
                                           .meaning = "",
                                           .columns = motion_columns,
                                           .count = 2,
                                           .options = "STRICT"};

/* Finds the table that `name` should be. False: clast has no such table. */
static bool find_table(const char *name, struct schema_table *table) {
  for (size_t i = 0; i < schema_table_count(); i++) {
    *table = schema_table_at(i);
    if (strcmp(table->name, name) == 0)
      return true;
  }
  if (strcmp(name, motion.name) == 0) {
    *table = motion;
    return true;
  }
  if (strncmp(name, "result_", 7) != 0 || !schema_text_is_plain(name, strlen(name)) ||
      strlen(name) >= sizeof table->name)
    return false;
  const struct engine_kind unknown = {.name = name + 7}; /* an engine that this program lacks */
  *table = schema_result_table(&unknown);
  return true;
}

static void judge_view(struct guard *guard, const char *name, const char *sql) {
  char begin[80];
  for (size_t i = 0; i < VIEWS_COUNT; i++) {
    snprintf(begin, sizeof begin, "CREATE VIEW %s AS", views_names[i]);
    if (strcmp(name, views_names[i]) == 0 && strncmp(sql, begin, strlen(begin)) == 0)
      return;
  }
  stranger(guard, "view", name, NULL);
}

/* SQLite makes these: the index of a key, whose text is part of its table's, and the tables of ANALYZE. */
static bool is_of_sqlite(const char *type, const char *name, const char *sql) {
  if (!sql)
    return strcmp(type, "index") == 0 && strncmp(name, "sqlite_autoindex_", 17) == 0;
  return strcmp(sql, "CREATE TABLE sqlite_stat1(tbl,idx,stat)") == 0 ||
         strcmp(sql, "CREATE TABLE sqlite_stat4(tbl,idx,neq,nlt,ndlt,sample)") == 0;
}

static const struct schema_index *find_index(const char *name) {
  for (size_t i = 0; i < schema_tables_indexes_count; i++)
    if (strcmp(schema_tables_indexes[i].name, name) == 0)
      return &schema_tables_indexes[i];
  return NULL;
}

static void judge_row(struct guard *guard, const char *type, const char *name, const char *sql) {
  struct schema_table table;
  if (!type || !name) {
    stranger(guard, "a row without a name in", "sqlite_schema", NULL);
    return;
  }
  if (is_of_sqlite(type, name, sql))
    return;
  const struct schema_index *index = strcmp(type, "index") == 0 ? find_index(name) : NULL;
  if (sql && index)
    judge_index(guard, index, sql);
  else if (sql && strcmp(type, "view") == 0)
    judge_view(guard, name, sql);
  else if (sql && strcmp(type, "table") == 0 && find_table(name, &table))
    judge_table(guard, &table, sql);
  else
    stranger(guard, type, name, NULL);
}

static status judge_objects(struct guard *guard, struct error *error) {
  sqlite3_stmt *rows = NULL;
  status result = sql_prepare(guard->db, "SELECT type, name, sql FROM main.sqlite_schema ORDER BY name", &rows,
                              "reading the schema", error);
  int code = SQLITE_DONE;
  while (result == STATUS_OK && (code = sqlite3_step(rows)) == SQLITE_ROW)
    judge_row(guard, (const char *)sqlite3_column_text(rows, 0), (const char *)sqlite3_column_text(rows, 1),
              (const char *)sqlite3_column_text(rows, 2));
  if (result == STATUS_OK && code != SQLITE_DONE)
    result = sql_fail(guard->db, code, "reading the schema", error);
  sqlite3_finalize(rows);
  return result;
}

enum { MOST_AXES = 1000 }; /* SQLite's views have 2000 columns */

/* Is it the name that views_axis_column() gives the column of this path? */
static bool is_axis_column(const char *path, const char *name) {
  char plain[SCHEMA_NAME_SIZE];
  if (!path || !name || !schema_text_is_plain(name, strlen(name)))
    return false;
  field_column_name(path, plain, sizeof plain);
  return strcmp(name, plain) == 0 || (strncmp(name, "input_", 6) == 0 && strcmp(name + 6, plain) == 0);
}

/* Rows of table axis name columns of the views. */
static status judge_axes(struct guard *guard, struct error *error) {
  sqlite3_stmt *rows = NULL;
  bool has = false;
  status result = schema_has_column(guard->db, "axis", "column_name", &has, error);
  if (result != STATUS_OK || !has)
    return result;
  result = sql_prepare(guard->db, "SELECT path, column_name FROM main.axis", &rows, "reading the axes", error);
  int code = SQLITE_DONE, count = 0;
  while (result == STATUS_OK && (code = sqlite3_step(rows)) == SQLITE_ROW) {
    const char *path = (const char *)sqlite3_column_text(rows, 0), *name = (const char *)sqlite3_column_text(rows, 1);
    if (++count > MOST_AXES || !is_axis_column(path, name))
      stranger(guard, "the column of axis", path, NULL);
  }
  if (result == STATUS_OK && code != SQLITE_DONE)
    result = sql_fail(guard->db, code, "reading the axes", error);
  sqlite3_finalize(rows);
  return result;
}

static status judge(struct guard *guard, struct error *error) {
  status result = judge_objects(guard, error);
  if (result != STATUS_OK || guard->strangers > 0)
    return result;
  return judge_axes(guard, error);
}

status guard_schema(sqlite3 *db, const char *path, int version, struct error *error) {
  char *names = NULL;
  size_t size = 0;
  struct guard guard = {.db = db, .version = version, .out = text_open(&names, &size)};
  if (!guard.out)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", path);
  status result = judge(&guard, error);
  if (!text_close(guard.out, &names) || guard.out_of_memory)
    result = status_fail(error, STATUS_MEMORY, "%s: memory ran out", path);
  else if (result == STATUS_OK && guard.strangers > 0)
    result = status_fail(error, STATUS_CONTENT,
                         "%s is not as clast makes its stores: %.6000s%s. clast ran and changed nothing. Remove your "
                         "own additions (`sqlite3 FILE`, then DROP ...; keep views of your own in another file that "
                         "attaches this one). Do not use the file if you do not know where that comes from.",
                         path, names, guard.strangers > 50 ? " and more" : "");
  free(names);
  return result;
}
