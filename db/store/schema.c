/* Writes tables, columns and indexes from their rows, and completes those of an older store. */
#include "db/store/schema.h"

#include <stdlib.h>
#include <string.h>

const char schema_sessions_sql[] =
    "UPDATE session SET campaign_id = of.campaign_id FROM (SELECT s.session_id, max(c.campaign_id) AS campaign_id FROM"
    " (SELECT DISTINCT session_id, point_id FROM run) r JOIN session s USING (session_id) JOIN campaign_point p USING"
    " (point_id) JOIN campaign c ON c.campaign_id = p.campaign_id WHERE s.ended_at IS NULL OR substr(c.added_at, 1, "
    "19) <="
    " substr(s.ended_at, 1, 19) GROUP BY s.session_id) AS of WHERE of.session_id = session.session_id AND"
    " session.campaign_id IS NULL";

static const struct schema_column result_columns[] = {
    {"run_id", "INTEGER PRIMARY KEY REFERENCES run (run_id)", NULL, "the run"},
};

struct schema_table schema_result_table(const struct engine_kind *kind) {
  struct schema_table table = {.meaning = "What this engine reports beyond the columns of table run, one to one.",
                               .columns = result_columns,
                               .count = sizeof result_columns / sizeof result_columns[0],
                               .fields = kind->results,
                               .options = "STRICT"};
  snprintf(table.name, sizeof table.name, "result_%s", kind->name);
  return table;
}

size_t schema_table_count(void) {
  return schema_tables_count + engine_count();
}

struct schema_table schema_table_at(size_t index) {
  return index < schema_tables_count ? schema_tables[index]
                                     : schema_result_table(engine_at(index - schema_tables_count));
}

/* A column is read without the program, so its meaning names the choices. */
static void write_meaning(const struct field *row, FILE *out) {
  for (const char *c = row->doc ? row->doc : ""; *c; c++)
    fputc(*c == '\n' ? ' ' : *c, out);
  for (size_t i = 0; row->choices && row->choices[i]; i++)
    fprintf(out, "%s%s", i ? ", " : " One of: ", row->choices[i]);
}

void schema_write_counts(const char *not_surplus, FILE *out) {
  const struct field *state = field_find(&outcome_table, "state", NULL), *row;
  const char *before = "";
  fprintf(out, "%s AND state IN (", not_surplus);
  for (int i = 0; state->choices[i]; i++) {
    if (!outcome_is_usable(i))
      continue;
    fprintf(out, "%s'%s'", before, state->choices[i]);
    before = ", ";
  }
  fputs(")", out);
  for (size_t i = 0; (row = outcome_main(i)); i++)
    fprintf(out, " AND %s IS NOT NULL", row->path);
}

static void write_column(const char *name, const char *declaration, bool last, const char *unit, FILE *out) {
  fprintf(out, "  %s %s%s -- %s%s%s", name, declaration, last ? "" : ",", unit ? "[" : "", unit ? unit : "",
          unit ? "] " : "");
}

static void write_declaration(const struct schema_column *column, char *text, size_t size) {
  FILE *out = fmemopen(text, size, "w");
  text[0] = '\0';
  if (!out)
    return;
  fputs(column->declaration, out);
  if (strcmp(column->name, "counts") == 0) { /* of table run */
    fprintf(out, " CHECK (%s = (", column->name);
    schema_write_counts("surplus = 0", out);
    fputs("))", out);
  }
  fclose(out);
}

void schema_write_index(const struct schema_index *index, FILE *out) {
  const struct field *row;
  fprintf(out, "CREATE INDEX %s ON %s (%s", index->name, index->table, index->columns);
  for (size_t i = 0; index->with_main_results && (row = outcome_main(i)); i++)
    fprintf(out, ", %s", row->path);
  fputs(");\n", out);
}

void schema_write_table(const struct schema_table *table, FILE *out) {
  size_t fields = table->fields ? table->fields->count : 0;
  fprintf(out, "CREATE TABLE %s ( -- %s\n", table->name, table->meaning);
  for (size_t i = 0; i < table->count; i++) {
    const struct schema_column *column = &table->columns[i];
    char declaration[1024];
    write_declaration(column, declaration, sizeof declaration);
    write_column(column->name, declaration, i + 1 == table->count && fields == 0 && !table->tail, column->unit, out);
    fprintf(out, "%s\n", column->meaning);
  }
  for (size_t i = 0; i < fields; i++) {
    const struct field *row = &table->fields->rows[i];
    char name[SCHEMA_NAME_SIZE];
    field_column_name(row->path, name, sizeof name);
    write_column(name, sql_type(row), i + 1 == fields && !table->tail, row->unit, out);
    write_meaning(row, out);
    fputc('\n', out);
  }
  if (table->tail)
    fprintf(out, "  %s\n", table->tail);
  fprintf(out, ") %s;\n", table->options);
}

/* The index-th column of a table: its own columns come first, then those of its fields. Returns what a developer looks
 * for: the column, or the path of the row that makes it. */
static const char *column_at(const struct schema_table *table, size_t index, char name[SCHEMA_NAME_SIZE]) {
  const char *source = index < table->count ? table->columns[index].name
                                            : table->fields->rows[index - table->count].path;
  field_column_name(source, name, SCHEMA_NAME_SIZE);
  return source;
}

status schema_check_names(const struct schema_table *table, struct error *error) {
  const size_t count = table->count + (table->fields ? table->fields->count : 0);
  for (size_t i = 0; i < count; i++) {
    char name[SCHEMA_NAME_SIZE], other[SCHEMA_NAME_SIZE];
    const char *source = column_at(table, i, name);
    for (size_t j = 0; j < i; j++) {
      const char *earlier = column_at(table, j, other);
      if (sqlite3_stricmp(name, other) == 0)
        return status_fail(
            error, STATUS_INTERNAL,
            "'%s' and '%s' would be one column of table %s, %s: give one of them another name in its row", earlier,
            source, table->name, name);
    }
  }
  return STATUS_OK;
}

status schema_has_column(sqlite3 *db, const char *table, const char *column, bool *has, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(db, "SELECT 1 FROM pragma_table_xinfo(?1, 'main') WHERE name = ?2 OR ?2 = ''", &statement,
                              "reading the schema", error);
  if (result == STATUS_OK) {
    sqlite3_bind_text(statement, 1, table, -1, SQLITE_STATIC);
    sqlite3_bind_text(statement, 2, column, -1, SQLITE_STATIC);
    int code = sqlite3_step(statement);
    *has = code == SQLITE_ROW;
    if (code != SQLITE_ROW && code != SQLITE_DONE)
      result = sql_fail(db, code, "reading the schema", error);
  }
  sqlite3_finalize(statement);
  return result;
}

static status write_docs(sqlite3 *db, const struct schema_table *table, struct error *error) {
  static const char insert[] = "INSERT OR REPLACE INTO column_doc (table_name, column_name, unit, meaning, "
                               "deterministic) VALUES (%Q, %Q, %Q, %Q, %d)";
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < table->count; i++)
    result = sql_executef(db, "documenting columns", error, insert, table->name, table->columns[i].name,
                          table->columns[i].unit, table->columns[i].meaning, 0);
  for (size_t i = 0; result == STATUS_OK && table->fields && i < table->fields->count; i++) {
    const struct field *row = &table->fields->rows[i];
    char name[SCHEMA_NAME_SIZE], *meaning = NULL;
    size_t size = 0;
    field_column_name(row->path, name, sizeof name);
    FILE *text = open_memstream(&meaning, &size);
    if (!text)
      return status_fail(error, STATUS_MEMORY, "documenting columns: memory ran out");
    write_meaning(row, text);
    fclose(text);
    result = sql_executef(db, "documenting columns", error, insert, table->name, name, row->unit, meaning, 1);
    free(meaning);
  }
  return result;
}

static status create(sqlite3 *db, const struct schema_table *table, struct error *error) {
  char *sql = NULL;
  size_t size = 0;
  FILE *text = open_memstream(&sql, &size);
  if (!text)
    return status_fail(error, STATUS_MEMORY, "creating tables: memory ran out");
  schema_write_table(table, text);
  for (size_t i = 0; i < schema_tables_indexes_count; i++)
    if (strcmp(schema_tables_indexes[i].table, table->name) == 0)
      schema_write_index(&schema_tables_indexes[i], text);
  fclose(text);
  status result = sql ? sql_execute(db, sql, "creating tables", error)
                      : status_fail(error, STATUS_MEMORY, "creating tables: memory ran out");
  free(sql);
  return result;
}

static status add_missing(sqlite3 *db, const char *table, const char *column, const char *declaration, bool *grown,
                          struct error *error) {
  bool has = false;
  status result = schema_has_column(db, table, column, &has, error);
  if (result != STATUS_OK || has)
    return result;
  *grown = true;
  return sql_executef(db, "adding a column", error, "ALTER TABLE \"%w\" ADD COLUMN \"%w\" %s", table, column,
                      declaration);
}

status schema_complete(sqlite3 *db, const struct schema_table *table, struct error *error) {
  bool has = false;
  status result = schema_check_names(table, error);
  if (result != STATUS_OK)
    return result;
  result = schema_has_column(db, table->name, "", &has, error);
  if (result != STATUS_OK)
    return result;
  if (!has) {
    result = create(db, table, error);
    return result == STATUS_OK ? write_docs(db, table, error) : result;
  }
  bool grown = false;
  for (size_t i = 0; result == STATUS_OK && i < table->count; i++)
    result = add_missing(db, table->name, table->columns[i].name, table->columns[i].declaration, &grown, error);
  for (size_t i = 0; result == STATUS_OK && table->fields && i < table->fields->count; i++) {
    char name[SCHEMA_NAME_SIZE];
    field_column_name(table->fields->rows[i].path, name, sizeof name);
    result = add_missing(db, table->name, name, sql_type(&table->fields->rows[i]), &grown, error);
  }
  return result == STATUS_OK && grown ? write_docs(db, table, error) : result;
}

status schema_complete_all(sqlite3 *db, struct error *error) {
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < schema_table_count(); i++) {
    struct schema_table table = schema_table_at(i);
    result = schema_complete(db, &table, error);
  }
  return result;
}
