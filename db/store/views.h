/* The views `runs`, `points`, `spectra`, `estimates`: flat tables for any tool, one column per varied input. Plain SQL
 * only, so that a database browser or pandas can open them. */
#ifndef CLAST_DB_STORE_VIEWS_H
#define CLAST_DB_STORE_VIEWS_H

#include <stdio.h>

#include "db/sql.h"

/* Drop and create all four, and their rows in column_doc. Within the caller's transaction. */
status views_regenerate(sqlite3 *db, struct error *error);

/* The column of a new axis: its path with underscores, with "input_" before it when a view has such a column already.
 */
status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error);

/* Results whose mean and scatter the view `points` shows: columns of table run. NULL-terminated. */
extern const char *const views_quantities[];

/* SQL for the two-sided 95 % quantile of Student's t with `degrees` (an SQL expression) of freedom. */
void views_student(FILE *out, const char *degrees);

#endif
