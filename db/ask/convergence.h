/* What studies of convergence found: the rows of table convergence. */
#ifndef CLAST_DB_ASK_CONVERGENCE_H
#define CLAST_DB_ASK_CONVERGENCE_H

#include "analysis/statistics/convergence.h"
#include "db/ask/query.h"

/* Anything but STATUS_OK ends the question with that status. */
typedef status (*ask_convergence_each)(void *context, const struct convergence_row *row, struct error *error);

/* The levels of all knobs of the scene that was studied as `base_point`, for one quantity (a column of the view runs),
 * knob by knob, coarse to fine. Nothing for a scene without a study, or a store of an earlier program. */
status ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                              ask_convergence_each each, void *context, struct error *error);

#endif
