/* The campaigns and sessions of a store: their progress, their documents, and which of their runs are safe (usable,
 * `warnings` is empty), warned (usable, with warnings) or refused (another state, which gives the reason). */
#ifndef CLAST_DB_ASK_CAMPAIGN_H
#define CLAST_DB_ASK_CAMPAIGN_H

#include "db/ask/answer.h"

/* One row per campaign: campaign, name, state, points, runs, counted, censored, failed, surplus, failed_attempts,
 * without_result, cpu_time (s), and start and end of its last session. `writing`: a process is writing the store
 * (store_is_being_written). */
struct answer ask_campaign_progress(struct store *store, bool writing, struct error *error);

/* Name and YAML text of a campaign (0: the last one); the caller frees both. Both NULL: the store has no campaign. */
status ask_campaign_document(struct store *store, int64_t campaign, char **name, char **document, struct error *error);

/* Attempts of the run that failed most often among those that have no result. 0: every run has a result. */
status ask_campaign_attempts(struct store *store, int64_t *attempts, struct error *error);

/* One row per session (invocation that wrote to the store): session, campaign (number; may be NULL), started, ended
 * (may be NULL), outcome (may be NULL), version, commit, command (words with spaces between them). */
struct answer ask_campaign_sessions(struct store *store, struct error *error);
/* One row per campaign: campaign, name, document. */
struct answer ask_campaign_documents(struct store *store, struct error *error);

/* A row per campaign: runs, safe, warned, refused, runs given up without a result, the largest energy_error of usable
 * runs, and the number of usable runs with an error above 1 % and no warning. */
struct answer ask_campaign_extremes(struct store *store, struct error *error);
/* A row per campaign and reason, the most frequent first: state or warnings, runs, one message. */
struct answer ask_campaign_reasons(struct store *store, struct error *error);
/* A row per value of each varied input, in ascending order within campaign and input: campaign, path, value, and the
 * numbers of safe, warned and refused runs. Inputs with only one value are left out. */
struct answer ask_campaign_values(struct store *store, struct error *error);

#endif
