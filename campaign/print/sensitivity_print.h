/* Sensitivity indices of a result from a store. */
#ifndef CLAST_CAMPAIGN_PRINT_SENSITIVITY_PRINT_H
#define CLAST_CAMPAIGN_PRINT_SENSITIVITY_PRINT_H

#include "campaign/terminal/table.h"
#include "db/store/store.h"

/* campaign: path of the campaign whose runs are in the store. Prints a row for each input and one for the seed. Blocks
 * of the design that lack a point are left out and reported. STATUS_USAGE: the campaign's points are not such a design,
 * or the store lacks them. */
status sensitivity_print(struct store *store, const char *campaign, const char *quantity, enum table_format format,
                         struct error *error);

#endif
