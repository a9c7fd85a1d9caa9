/* What the columns of a store are: the inputs that campaigns varied, units, and whole views. */
#ifndef CLAST_DB_ASK_COLUMNS_H
#define CLAST_DB_ASK_COLUMNS_H

#include "db/ask/query.h"

/* A column of the views and its unit. */
struct ask_column {
  char name[128];
  char unit[64]; /* "" when the store does not tell it; "1" for a pure number */
};

/* The columns of the varied inputs, in the order of their paths; at most `most` of them. */
status ask_columns_axes(struct store *store, size_t most, struct ask_column *axes, size_t *count, struct error *error);

/* Unit of one column in `unit`; "" for a pure number or an unknown column. */
status ask_columns_unit(struct store *store, const char *column, char *unit, size_t size, struct error *error);

/* All columns with a unit, in *columns (to be freed by the caller). A column that has different units in different
 * tables is left out. STATUS_MEMORY. */
status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error);

/* All rows of a view: runs, points, spectra, estimates, or of the table column_doc. The name is not checked. */
status ask_columns_view(struct store *store, const char *view, const struct query_sink *sink, struct error *error);

#endif
