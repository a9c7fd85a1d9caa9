/* The tables as data: one row per column with its meaning and unit. The CREATE statements (with a comment on every
 * column), the rows of column_doc and schemas/results.sql follow from them. Columns that are results come from the
 * field tables. */
#pragma once

#include <stdio.h>

#include "db/sql.h"
#include "engine/engine.h"

enum {
  SCHEMA_APPLICATION_ID = 0x434c5354, /* "CLST" */
  SCHEMA_VERSION = 5,                 /* added table ejecta, column lengths */
  SCHEMA_DIGESTS = 4,                 /* added table_digest */
  SCHEMA_OLDEST = 3,                  /* the oldest version that is read and brought forward */
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
  bool has_digest;                  /* table_digest has the number and the digest of its rows */
};

struct schema_index {
  const char *table, *name, *columns;
  bool with_main_results; /* add columns of the main results at the end */
};

/* The tables that are not results of one engine, in the order of their creation, and the indexes. */
extern const struct schema_table schema_tables[];
extern const size_t schema_tables_count;
extern const struct schema_index schema_indexes[];
extern const size_t schema_indexes_count;

struct schema_table schema_result_table(const struct engine_kind *kind); /* result_<engine> */
/* All tables in the order of their creation: the engines' results come last. */
size_t schema_table_count(void);
struct schema_table schema_table_at(size_t index);
/* Their CREATE statements, with a semicolon and a line break at the end. */
void schema_write_table(const struct schema_table *table, FILE *out);
void schema_write_index(const struct schema_index *index, FILE *out);
/* Writes the declaration of a column, without comment. False: the table has none of this name. */
bool schema_write_column(const struct schema_table *table, const char *name, FILE *out);

/* Writes the SQL condition that a row of table run is part of the statistics: not surplus, a usable state, every main
 * result a number. `not_surplus`: "surplus = 0", or another expression for it. It matches store_run_counts(). */
void schema_write_counts(const char *not_surplus, FILE *out);

/* Refuses a table with two columns of one name, and names both. Paths of rows become names of columns
 * (schemas/field.h), so largest.speed and largest_speed are the same column. STATUS_INTERNAL. */
status schema_check_names(const struct schema_table *table, struct error *error);

/* Does this table have this column (NULL: does the table exist)? */
bool schema_has_column(sqlite3 *db, const char *table, const char *column);
/* May a store that is read lack this column? Versions before 5 lack some, and some came without a new version: readers
 * do without them, a writer adds them (NULL in old rows), and programs that do not know them leave them as they are. */
bool schema_may_lack(const char *table, const char *column);
/* Has the database all tables and columns but those, and those that only one engine reports? An older program's may
 * lack some. */
bool schema_is_complete(sqlite3 *db);
/* Creates missing parts in the database: the table, or columns that its field table has gained (NULL in old rows), and
 * their rows of column_doc. */
status schema_complete(sqlite3 *db, const struct schema_table *table, struct error *error);
/* Writes the rows of column_doc (temp.column_doc, if there is one) of all columns that the database has. */
status schema_document_all(sqlite3 *db, struct error *error);
/* schema_complete of every table. Within the caller's transaction. */
status schema_complete_all(sqlite3 *db, struct error *error);
