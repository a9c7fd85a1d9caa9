/* The tables, as data: one row per column with its meaning and unit, from which CREATE statements (with a comment on
 * every column), the rows of column_doc and schemas/results.sql are made. Columns that are results come from the field
 * tables. */
#ifndef CLAST_DB_STORE_SCHEMA_H
#define CLAST_DB_STORE_SCHEMA_H

#include <stdio.h>

#include "db/sql.h"
#include "engine/engine.h"

enum {
  SCHEMA_APPLICATION_ID = 0x434c5354, /* "CLST" */
  SCHEMA_VERSION = 1,
  SCHEMA_NAME_SIZE = 128,
};

struct schema_column {
  const char *name, *declaration, *unit, *meaning;
};

struct schema_table {
  char name[SCHEMA_NAME_SIZE];
  const char *meaning;
  const struct schema_column *columns;
  size_t count;
  const struct field_table *fields; /* further columns, or NULL */
  const char *tail;                 /* table constraints, or NULL */
  const char *options;              /* STRICT, perhaps WITHOUT ROWID */
};

struct schema_table schema_result_table(const struct engine_kind *kind); /* result_<engine> */

struct schema_index {
  const char *table, *name, *columns;
  bool with_main_results; /* columns of the main results after the others */
};

/* The condition that a row of table run is part of the statistics, as SQL: not surplus, a usable state, every main
 * result a number. `not_surplus`: "surplus = 0", or another expression for it. The same as store_run_counts(). */
void schema_write_counts(const char *not_surplus, FILE *out);

/* Create what the database lacks of this table: the table, or columns that its field table has gained (NULL in old
 * rows), and their docs. */
status schema_complete(sqlite3 *db, const struct schema_table *table, struct error *error);
/* schema_complete of every table. Within the caller's transaction. */
status schema_complete_all(sqlite3 *db, struct error *error);

#endif
