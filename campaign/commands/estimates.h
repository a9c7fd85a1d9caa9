/* What a campaign found, read from its store: the table `clast run` ends with and `clast estimates` prints again. */
#ifndef CLAST_CAMPAIGN_COMMANDS_ESTIMATES_H
#define CLAST_CAMPAIGN_COMMANDS_ESTIMATES_H

#include "campaign/terminal/table.h"
#include "db/store/store.h"

/* Which points: 0 = all. resamples: of the runs, for the errors of the exponents; 0 = none. */
struct estimates_choice {
  int64_t campaign, point;
  int64_t resamples;
};

/* One row per point and window: the point's varied inputs, its runs, M_1/M with the half width of its 95 % interval,
 * and the exponents by each method with their errors from resampling runs. Only runs that count, of the newest
 * results_version of the point. */
status estimates_rows(struct store *store, const struct estimates_choice *choice, enum table_format format, FILE *out,
                      struct error *error);

/* Points that estimates_rows would print. */
status estimates_points(struct store *store, const struct estimates_choice *choice, int64_t *points,
                        struct error *error);

extern const char *const estimates_legend; /* what the columns of the aligned table mean */

#endif
