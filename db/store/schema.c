/* Writes tables, columns and indexes from their rows, and adds those that an older store lacks. */
#include "db/store/schema.h"

#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

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

/* A store is also read without clast, so the meaning of a column names the choices. */
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

void schema_write_index(const struct schema_index *index, FILE *out) {
  const struct field *row;
  fprintf(out, "CREATE INDEX %s ON %s (%s", index->name, index->table, index->columns);
  for (size_t i = 0; index->with_main_results && (row = outcome_main(i)); i++)
    fprintf(out, ", %s", row->path);
  fputs(");\n", out);
}

/* A column of a table: of its own, or one that a field makes. */
struct column {
  char name[SCHEMA_NAME_SIZE];
  const char *source; /* for a developer: the name, or the path of the field row */
  const char *declaration, *unit;
  const char *meaning;     /* of the table's own */
  const struct field *row; /* of a field; else NULL */
};

static size_t column_count(const struct schema_table *table) {
  return table->count + (table->fields ? table->fields->count : 0);
}

/* The table's own columns come first. */
static struct column column_at(const struct schema_table *table, size_t index) {
  struct column column = {.row = NULL};
  if (index < table->count) {
    const struct schema_column *own = &table->columns[index];
    column.source = own->name;
    column.declaration = own->declaration;
    column.unit = own->unit;
    column.meaning = own->meaning;
    snprintf(column.name, sizeof column.name, "%s", own->name);
    return column;
  }
  column.row = &table->fields->rows[index - table->count];
  column.source = column.row->path;
  column.declaration = sql_type(column.row);
  column.unit = column.row->unit;
  field_column_name(column.row->path, column.name, sizeof column.name);
  return column;
}

static void write_column_meaning(const struct column *column, FILE *out) {
  if (column->row)
    write_meaning(column->row, out);
  else
    fputs(column->meaning, out);
}

static void write_column(const struct column *column, bool last, FILE *out) {
  fprintf(out, "  %s %s", column->name, column->declaration);
  if (strcmp(column->name, "counts") == 0) { /* of table run */
    fprintf(out, " CHECK (%s = (", column->name);
    schema_write_counts("surplus = 0", out);
    fputs("))", out);
  }
  fputs(last ? " -- " : ", -- ", out);
  if (column->unit)
    fprintf(out, "[%s] ", column->unit);
  write_column_meaning(column, out);
  fputc('\n', out);
}

void schema_write_table(const struct schema_table *table, FILE *out) {
  const size_t count = column_count(table);
  fprintf(out, "CREATE TABLE %s ( -- %s\n", table->name, table->meaning);
  for (size_t i = 0; i < count; i++) {
    const struct column column = column_at(table, i);
    write_column(&column, i + 1 == count && !table->tail, out);
  }
  if (table->tail)
    fprintf(out, "  %s\n", table->tail);
  fprintf(out, ") %s;\n", table->options);
}

status schema_check_names(const struct schema_table *table, struct error *error) {
  for (size_t i = 0; i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    for (size_t j = 0; j < i; j++) {
      const struct column earlier = column_at(table, j);
      if (sqlite3_stricmp(column.name, earlier.name) == 0)
        return status_fail(
            error, STATUS_INTERNAL,
            "'%s' and '%s' would be one column of table %s, %s: give one of them another name in its row",
            earlier.source, column.source, table->name, column.name);
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

/* Results must be deterministic; the table's own columns may differ from machine to machine. */
static status write_doc(sqlite3 *db, const char *table, const struct column *column, struct error *error) {
  char *meaning = NULL;
  size_t size = 0;
  FILE *out = text_open(&meaning, &size);
  if (out)
    write_column_meaning(column, out);
  if (!out || !text_close(out, &meaning))
    return status_fail(error, STATUS_MEMORY, "documenting columns: memory ran out");
  const status result = sql_executef(db, "documenting columns", error,
                                     "INSERT OR REPLACE INTO column_doc (table_name, column_name, unit, meaning, "
                                     "deterministic) VALUES (%Q, %Q, %Q, %Q, %d)",
                                     table, column->name, column->unit, meaning, column->row != NULL);
  free(meaning);
  return result;
}

static status write_docs(sqlite3 *db, const struct schema_table *table, struct error *error) {
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    result = write_doc(db, table->name, &column, error);
  }
  return result;
}

static status create(sqlite3 *db, const struct schema_table *table, struct error *error) {
  char *sql = NULL;
  size_t size = 0;
  FILE *text = text_open(&sql, &size);
  if (!text)
    return status_fail(error, STATUS_MEMORY, "creating tables: memory ran out");
  schema_write_table(table, text);
  for (size_t i = 0; i < schema_tables_indexes_count; i++)
    if (strcmp(schema_tables_indexes[i].table, table->name) == 0)
      schema_write_index(&schema_tables_indexes[i], text);
  status result = text_close(text, &sql) ? sql_execute(db, sql, "creating tables", error)
                                         : status_fail(error, STATUS_MEMORY, "creating tables: memory ran out");
  free(sql);
  return result;
}

static status add_missing(sqlite3 *db, const struct schema_table *table, bool *grown, struct error *error) {
  for (size_t i = 0; i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    bool has = false;
    status result = schema_has_column(db, table->name, column.name, &has, error);
    if (result == STATUS_OK && !has)
      result = sql_executef(db, "adding a column", error, "ALTER TABLE \"%w\" ADD COLUMN \"%w\" %s", table->name,
                            column.name, column.declaration);
    if (result != STATUS_OK)
      return result;
    *grown = *grown || !has;
  }
  return STATUS_OK;
}

status schema_complete(sqlite3 *db, const struct schema_table *table, struct error *error) {
  bool has = false, grown = false;
  status result = schema_check_names(table, error);
  if (result == STATUS_OK)
    result = schema_has_column(db, table->name, "", &has, error);
  if (result != STATUS_OK)
    return result;
  result = has ? add_missing(db, table, &grown, error) : create(db, table, error);
  return result == STATUS_OK && (grown || !has) ? write_docs(db, table, error) : result;
}

status schema_complete_all(sqlite3 *db, struct error *error) {
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < schema_table_count(); i++) {
    struct schema_table table = schema_table_at(i);
    result = schema_complete(db, &table, error);
  }
  return result;
}
