/* The views `runs`, `points`, `spectra`, `estimates`, `resolution`: flat tables for any tool, one column per varied
 * input. Plain SQL only, so that a database browser or pandas can open them. clast itself never runs the views of a
 * file (db/store/guard.h): every connection makes temporary ones of the same names, which take precedence. */
#ifndef CLAST_DB_STORE_VIEWS_H
#define CLAST_DB_STORE_VIEWS_H

#include "db/sql.h"
#include "db/store/views_text.h"

extern const char *const views_names[VIEWS_COUNT];

/* Makes all views again, in the file and for this connection, and their rows in column_doc. Within the caller's
 * transaction. */
status views_regenerate(sqlite3 *db, struct error *error);
/* Makes the views of this connection only. Changes no file: for readers. */
status views_make_temporary(sqlite3 *db, struct error *error);

/* The column of a new axis: its path with underscores. "input_" goes in front when a view has such a column already:
 * SQL takes A and a for one name. */
status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error);

#endif
