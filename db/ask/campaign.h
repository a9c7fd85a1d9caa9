/* The campaigns of a store: their progress, and the document of one of them. */
#ifndef CLAST_DB_ASK_CAMPAIGN_H
#define CLAST_DB_ASK_CAMPAIGN_H

#include "db/ask/query.h"

/* One row per campaign: campaign, name, state, points, runs, counted, censored, failed, surplus, failed_attempts,
 * without_result, cpu_time (s), and start and end of its last session. `writing`: a process is writing the store
 * (store_is_being_written). */
status ask_campaign_progress(struct store *store, bool writing, const struct query_sink *sink, struct error *error);

/* Name and YAML text of a campaign (0: the last one); the caller frees both. Both NULL: the store has no campaign. */
status ask_campaign_document(struct store *store, int64_t campaign, char **name, char **document, struct error *error);

/* Attempts of the run that failed most often among those that have no result. 0: every run has a result. */
status ask_campaign_attempts(struct store *store, int64_t *attempts, struct error *error);

#endif
