/* What a campaign found, read from its store: the table `clast run` ends with and `clast estimates` prints again. */
#ifndef CLAST_CAMPAIGN_PRINT_ESTIMATES_TABLE_H
#define CLAST_CAMPAIGN_PRINT_ESTIMATES_TABLE_H

#include "campaign/terminal/table.h"
#include "db/ask/points.h"

/* One row per point and window: the point's varied inputs, its runs, M_1/M with the half width of its 95 % interval,
 * and the exponents by each method with theirs. Only runs that count, of the newest results_version of the point. */
status estimates_table_print(struct store *store, const struct ask_points_choice *choice, enum table_format format,
                             FILE *out, struct error *error);

/* On stderr: what the columns of the aligned table mean, what its intervals hold, what is known of the resolution. */
void estimates_table_explain(struct store *store);

#endif
