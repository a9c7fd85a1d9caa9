/* Rows of a store on stdout, as status, stats, spectrum, query and export print them. */
#ifndef CLAST_CAMPAIGN_TERMINAL_ROWS_H
#define CLAST_CAMPAIGN_TERMINAL_ROWS_H

#include "campaign/terminal/table.h"
#include "db/ask/columns.h"

/* Prints all rows of an answer as a table, and ends the answer. Headings have the units of the store's table
 * column_doc; with `written`, a table for people shows varied inputs in the campaign's units. A closed pipe is not an
 * error. */
status rows_print(struct answer answer, bool written, enum table_format format, FILE *out);

/* Adds one cell: number, text or missing. Not for QUERY_BLOB. */
void rows_cell(struct table *table, const struct query_value *value);

#endif
