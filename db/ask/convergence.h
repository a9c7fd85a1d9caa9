/* Results of convergence studies: the rows of table convergence. */
#ifndef CLAST_DB_ASK_CONVERGENCE_H
#define CLAST_DB_ASK_CONVERGENCE_H

#include "analysis/statistics/convergence.h"
#include "db/ask/query.h"

/* A status other than STATUS_OK ends the query with that status. */
typedef status (*ask_convergence_each)(void *context, const struct convergence_row *row, struct error *error);

/* The levels of all knobs of the scene that was studied as `base_point`, for one quantity (a column of the view runs),
 * knob by knob, coarse to fine. No rows for a scene without a study, or a store of an earlier program. */
status ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                              ask_convergence_each each, void *context, struct error *error);

#endif
