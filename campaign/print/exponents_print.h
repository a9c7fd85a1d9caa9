/* A point's exponent under its four names, with the goodness of its fit, as a row. */
#ifndef CLAST_CAMPAIGN_PRINT_EXPONENTS_PRINT_H
#define CLAST_CAMPAIGN_PRINT_EXPONENTS_PRINT_H

#include "campaign/terminal/table.h"
#include "db/ask/pool.h"

struct exponents_print {
  struct table *table;
  size_t draws; /* number of bootstrap samples */
};

void exponents_print_headings(struct table *table);
/* An ask_pool_each of ask_pools; the context is a struct exponents_print. Points without estimates have no row. */
status exponents_print_pool(void *context, const struct ask_pool *pool, struct error *error);

#endif
