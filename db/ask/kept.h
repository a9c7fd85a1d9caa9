/* Runs whose fields are kept as files. */
#ifndef CLAST_DB_ASK_KEPT_H
#define CLAST_DB_ASK_KEPT_H

#include "db/ask/query.h"

/* One row per run that counts, of each point's newest results_version: run_id, point_id, seed, the varied inputs, the
 * main results, and last `fields` (text): the file's path as this process can open it. */
status ask_kept(struct store *store, const struct query_sink *sink, struct error *error);

#endif
