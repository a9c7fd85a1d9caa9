/* What a store says of the limits of its scenes: which runs are safe (usable, no word in `warnings`), warned (usable,
 * with words) or refused (another state, which says why). */
#ifndef CLAST_DB_ASK_EXTREMES_H
#define CLAST_DB_ASK_EXTREMES_H

#include "db/ask/query.h"

/* A row per campaign: runs, safe, warned, refused, runs given up without a result, and of usable runs the largest
 * energy_error and how many drift by more than 1 % without a word. */
status ask_extremes_campaigns(struct store *store, const struct query_sink *sink, struct error *error);
/* A row per campaign and reason, the most frequent first: state or words, runs, one message. */
status ask_extremes_reasons(struct store *store, const struct query_sink *sink, struct error *error);
/* A row per value of each varied input, in ascending order within campaign and input: campaign, path, value, and the
 * numbers of safe, warned and refused runs. Inputs of one value are left out. */
status ask_extremes_values(struct store *store, const struct query_sink *sink, struct error *error);

#endif
