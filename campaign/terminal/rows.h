/* Rows of a store on stdout: what status, stats, spectrum, query and the end of a campaign have in common. */
#ifndef CLAST_CAMPAIGN_TERMINAL_ROWS_H
#define CLAST_CAMPAIGN_TERMINAL_ROWS_H

#include "campaign/terminal/table.h"
#include "db/ask/query.h"

struct rows { /* a sink's context */
  struct table *table;
  enum table_format format;
  FILE *out;
  struct rows_unit {
    char column[128], unit[64];
  } * units;
  size_t unit_count;
};

/* A sink that prints what it gets; units in headings come from the store's table column_doc (read here, before the
 * query: a query inside another one would end the outer one's time limit). End it with rows_end, in every case. */
struct query_sink rows_sink(struct rows *rows, struct store *store, enum table_format format, FILE *out);
/* Ends the table, whatever `code` says; returns code, or what writing said. A reader that went away is fine. */
status rows_end(struct rows *rows, status code, struct error *error);

/* Whether several points share one value of column `x` (and of `y`, unless it is NULL): what is averaged by these is so
 * over other inputs, too. */
status rows_pool(struct store *store, const char *x, const char *y, bool *pool, struct error *error);

/* One SELECT, printed. */
status rows_print(struct store *store, const char *sql, size_t parameter_count,
                  const struct query_parameter *parameters, enum table_format format, FILE *out, struct error *error);

#endif
