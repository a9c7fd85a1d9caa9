/* A point's exponent under its four names, with the goodness of its fit, as a row. */
#ifndef CLAST_CAMPAIGN_PRINT_EXPONENTS_PRINT_H
#define CLAST_CAMPAIGN_PRINT_EXPONENTS_PRINT_H

#include "campaign/terminal/table.h"
#include "db/ask/pool.h"

void exponents_print_headings(struct table *table);
/* The row of a pool, with `draws` samples of the bootstrap. Points without estimates have no row. */
status exponents_print_pool(struct table *table, size_t draws, const struct ask_pool *pool, struct error *error);

#endif
