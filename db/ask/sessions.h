/* The sessions of a store (invocations that wrote to it) and its campaigns, for provenance. */
#ifndef CLAST_DB_ASK_SESSIONS_H
#define CLAST_DB_ASK_SESSIONS_H

#include "db/ask/query.h"

/* One row per session: session, campaign (number; may be NULL), started, ended (may be NULL), outcome (may be NULL),
 * version, commit, command (words with spaces between them). */
status ask_sessions(struct store *store, const struct query_sink *sink, struct error *error);

/* One row per campaign: campaign, name, document. */
status ask_sessions_campaigns(struct store *store, const struct query_sink *sink, struct error *error);

#endif
