/* Rows of a store on stdout: what status, stats, spectrum, query and the end of a campaign have in common. */
#ifndef CLAST_CAMPAIGN_COMMANDS_ROWS_H
#define CLAST_CAMPAIGN_COMMANDS_ROWS_H

#include "campaign/commands/table.h"
#include "db/query.h"

struct rows { /* a sink's context */
  struct store *store;
  struct table *table;
  enum table_format format;
  FILE *out;
  uint64_t count; /* rows printed */
};

/* A sink that prints what it gets; units in headings come from the store's table column_doc. End it with rows_end. */
struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out);
/* Ends the table, whatever `code` says; returns code, or what writing said. A reader that went away is fine. */
status rows_end(struct rows *rows, status code, struct error *error);

/* One SELECT, printed. */
status rows_print(struct store *store, const char *sql, size_t parameter_count, const struct query_parameter *parameters,
                  enum table_format format, FILE *out, struct error *error);

#endif
