/* The columns of a store: the inputs that campaigns varied, their units, and whole views. */
#ifndef CLAST_DB_ASK_COLUMNS_H
#define CLAST_DB_ASK_COLUMNS_H

#include "db/ask/answer.h"

/* A column of the views and its unit. */
struct ask_column {
  char name[128];
  char unit[64]; /* "" when the store does not give it; "1" for a pure number */
  double factor; /* SI value of one of this unit; values of the store are SI */
};

/* The columns of the varied inputs, in the order of their paths; at most `most` of them. `written`: in the units that
 * the campaign uses; else in SI units. */
status ask_columns_axes(struct store *store, bool written, size_t most, struct ask_column *axes, size_t *count,
                        struct error *error);
/* One column by name, with the campaign's unit if it is a varied input, else with its unit in the store. */
status ask_columns_written(struct store *store, const char *column, struct ask_column *out, struct error *error);
/* Replaces the column's SI unit by `unit` if both have the same dimension. */
void ask_columns_write_in(struct ask_column *column, const char *unit);
/* A value of the store in the unit of the column: numbers are divided by its factor; other kinds do not change. */
struct query_value ask_columns_value(const struct ask_column *column, const struct query_value *value);

/* Unit of one column in `unit`; "" for a pure number or an unknown column. */
status ask_columns_unit(struct store *store, const char *column, char *unit, size_t size, struct error *error);

/* All columns with a unit, in *columns (the caller frees it). A column that has different units in different tables is
 * left out. STATUS_MEMORY. */
status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error);

/* All rows of a view: runs, points, spectra, estimates, or of the table column_doc. */
struct answer ask_columns_view(struct store *store, const char *view, struct error *error);

#endif
