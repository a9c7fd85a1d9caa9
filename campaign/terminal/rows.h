/* Rows of a store on stdout, as status, stats, spectrum, query and export print them. */
#ifndef CLAST_CAMPAIGN_TERMINAL_ROWS_H
#define CLAST_CAMPAIGN_TERMINAL_ROWS_H

#include "campaign/terminal/table.h"
#include "db/ask/columns.h"

enum { ROWS_AXES = 64 };

struct rows { /* a sink's context */
  struct table *table;
  enum table_format format;
  FILE *out;
  struct ask_column *units; /* units of the columns; owned */
  size_t unit_count;
  struct ask_column written[ROWS_AXES]; /* varied inputs, in the campaign's units */
  size_t written_count;
  int *place; /* per column: index of `written`, or -1; owned */
};

/* A sink that prints its rows. Units in headings come from the store's table column_doc. They are read here, before the
 * query, because a query inside another one ends the outer one's time limit. Always call rows_end at the end. */
struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out);
/* The same, but a table for people shows varied inputs in the campaign's units. */
struct query_sink rows_sink_written(struct rows *rows, struct store *store, enum table_format format, FILE *out);
/* Ends the table, whatever `code` is. Returns `code`, or an error of writing. A closed pipe is not an error. */
status rows_end(struct rows *rows, status code, struct error *error);

/* Adds one cell: number, text or missing. Not for QUERY_BLOB. */
void rows_cell(struct table *table, const struct query_value *value);

#endif
