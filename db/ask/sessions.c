/* Reads provenance from a store. */
#include "db/ask/sessions.h"

#include <stdio.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

status ask_sessions(struct store *store, const struct query_sink *sink, struct error *error) {
  bool named = false; /* sessions of older programs do not name their campaign */
  char sql[512];
  const status code = schema_has_column(store->db, "session", "campaign_id", &named, error);
  if (code)
    return code;
  snprintf(sql, sizeof sql,
           "SELECT session_id, %s, started_at, ended_at, outcome, facts ->> '$.version', facts ->> '$.commit',"
           " (SELECT group_concat(value, ' ') FROM json_each(facts, '$.command')) FROM session ORDER BY session_id",
           named ? "campaign_id" : "NULL");
  return query_run(store, sql, 0, NULL, 0, sink, error);
}

status ask_sessions_campaigns(struct store *store, const struct query_sink *sink, struct error *error) {
  return query_run(store, "SELECT campaign_id, name, document FROM campaign ORDER BY campaign_id", 0, NULL, 0, sink,
                   error);
}
