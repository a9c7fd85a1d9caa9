/* What a campaign found, read from its store: the table `clast run` ends with. */
#ifndef CLAST_CAMPAIGN_COMMANDS_ESTIMATES_H
#define CLAST_CAMPAIGN_COMMANDS_ESTIMATES_H

#include "campaign/commands/table.h"

/* Per point of the campaign (0: of the whole store) the share of the largest fragment and the exponents, methods by
 * windows, pooled over seeds, with their errors. */
status estimates_print(const char *store, int64_t campaign_id, enum table_format format, FILE *out, struct error *error);

#endif
