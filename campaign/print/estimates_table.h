/* Results of a campaign from its store: the table that `clast run` prints at its end, and `clast estimates` prints
 * again. */
#ifndef CLAST_CAMPAIGN_PRINT_ESTIMATES_TABLE_H
#define CLAST_CAMPAIGN_PRINT_ESTIMATES_TABLE_H

#include "campaign/terminal/table.h"
#include "db/ask/points.h"

/* One row per point and window: the point's varied inputs, its runs, M_1/M and the exponents by each method, all with
 * the half widths of their 95 % intervals. Only runs that count, of the point's newest results_version. */
status estimates_table_print(struct store *store, const struct ask_points_choice *choice, enum table_format format,
                             FILE *out, struct error *error);

/* Explains on stderr the columns of the aligned table, its intervals, and the known errors of the resolution. */
void estimates_table_explain(struct store *store);

#endif
