/* The text of the views. For db/store/views.c. */
#ifndef CLAST_DB_STORE_VIEWS_TEXT_H
#define CLAST_DB_STORE_VIEWS_TEXT_H

#include <stdio.h>

#include "db/sql.h"

enum { VIEWS_COUNT = 5 };

/* Writes the text of the index-th view of views_names after CREATE VIEW and the schema's name: "runs AS SELECT ...;".
 * It lists the columns that this database has. */
status views_text_write(sqlite3 *db, size_t index, FILE *out, struct error *error);

#endif
