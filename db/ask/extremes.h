/* The limits of a store's scenes: which runs are safe (usable, `warnings` is empty), warned (usable, with warnings) or
 * refused (another state, which gives the reason). */
#ifndef CLAST_DB_ASK_EXTREMES_H
#define CLAST_DB_ASK_EXTREMES_H

#include "db/ask/query.h"

/* A row per campaign: runs, safe, warned, refused, runs given up without a result, the largest energy_error of usable
 * runs, and the number of usable runs with an error above 1 % and no warning. */
status ask_extremes_campaigns(struct store *store, const struct query_sink *sink, struct error *error);
/* A row per campaign and reason, the most frequent first: state or warnings, runs, one message. */
status ask_extremes_reasons(struct store *store, const struct query_sink *sink, struct error *error);
/* A row per value of each varied input, in ascending order within campaign and input: campaign, path, value, and the
 * numbers of safe, warned and refused runs. Inputs with only one value are left out. */
status ask_extremes_values(struct store *store, const struct query_sink *sink, struct error *error);

#endif
