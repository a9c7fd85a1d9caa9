/* Results of convergence studies: the rows of table convergence. */
#ifndef CLAST_DB_ASK_CONVERGENCE_H
#define CLAST_DB_ASK_CONVERGENCE_H

#include "analysis/statistics/convergence.h"
#include "db/ask/answer.h"

/* The levels of all knobs of the scene that was studied as `base_point`, for one quantity (a column of the view runs),
 * knob by knob, coarse to fine. No rows for a scene without a study, or a store of an earlier program. */
struct answer ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                                     struct error *error);
/* The next level. False at the end and after an error; then answer_end(). */
bool ask_convergence_next(struct answer *answer, struct convergence_row *row);

#endif
