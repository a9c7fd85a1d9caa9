/* A stored run beside the same run computed again: every result and every fragment mass, bit by bit. */
#ifndef CLAST_CAMPAIGN_COMMANDS_REPLAY_COMPARE_H
#define CLAST_CAMPAIGN_COMMANDS_REPLAY_COMPARE_H

#include "campaign/driver/run.h"
#include "campaign/terminal/table.h"
#include "db/store/store.h"

struct replay_compare {
  size_t compared, different; /* results; the fragment masses together are one of them */
  size_t absent;              /* results that the program that stored the run did not know, as it seems: not compared */
  char absent_names[256];     /* the first of them */
};

/* Each difference is a row of `table`: name, stored, recomputed. STATUS_CONTENT: the store has no results of this run.
 */
status replay_compare(struct store *store, int64_t run_id, const struct engine_kind *kind,
                      const struct run_result *result, struct table *table, struct replay_compare *out,
                      struct error *error);

#endif
