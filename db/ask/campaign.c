/* The state of the campaigns of a store. */
#include "db/ask/campaign.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"

/* Sessions with their campaigns. The last one has the largest number: clocks are set back at times. A read-only store
 * of an older program does not name the campaign: it is then one of the campaigns of the session's runs. */
static const char sessions_named[] = "SELECT campaign_id, session_id, started_at, ended_at, outcome FROM session";
static const char sessions_of_runs[] =
    "SELECT max(c.campaign_id) AS campaign_id, session_id, started_at, ended_at, outcome FROM"
    " (SELECT DISTINCT session_id, point_id FROM run) JOIN session USING (session_id) JOIN campaign_point p USING "
    "(point_id) JOIN campaign c ON"
    " c.campaign_id = p.campaign_id WHERE ended_at IS NULL OR substr(c.added_at, 1, 19) <= substr(ended_at, 1, 19)"
    " GROUP BY session_id";

status ask_campaign_progress(struct store *store, bool writing, const struct query_sink *sink, struct error *error) {
  bool named = false;
  char sql[3600];
  const status code = schema_has_column(store->db, "session", "campaign_id", &named, error);
  if (code != STATUS_OK)
    return code;
  snprintf(
      sql, sizeof sql,
      "WITH done AS (SELECT campaign_id, count(*) AS runs, sum(counts) AS counted,"
      "   sum(counts AND state = 'end-time') AS censored,"
      "   sum(state NOT IN ('completed', 'end-time')) AS failed, sum(surplus) AS surplus, sum(cpu_time) AS cpu_time"
      "   FROM campaign_point JOIN run USING (point_id) GROUP BY campaign_id),"
      " tried AS (SELECT campaign_id, count(*) AS failed_attempts"
      "   FROM campaign_point JOIN attempt USING (point_id) GROUP BY campaign_id),"
      " given_up AS (SELECT campaign_id, count(DISTINCT attempt.identity) AS without_result"
      "   FROM campaign_point JOIN attempt USING (point_id)"
      "   WHERE NOT EXISTS (SELECT 1 FROM run WHERE run.identity = attempt.identity) GROUP BY campaign_id),"
      " sessions AS (%s),"
      " last AS (SELECT campaign_id, max(session_id) AS session_id, started_at, ended_at, outcome FROM sessions"
      "   GROUP BY campaign_id),"
      " planned AS (SELECT campaign_id, plan ->> '$.points' AS points, plan ->> '$.replicates_least' AS least,"
      "   plan ->> '$.replicates_most' AS most FROM campaign WHERE json_valid(plan)),"
      " filled AS (SELECT campaign_id, count(*) AS points FROM (SELECT campaign_id, point_id, count(DISTINCT seed) AS n"
      "   FROM campaign_point JOIN run USING (point_id) GROUP BY campaign_id, point_id) JOIN planned"
      "   USING (campaign_id) WHERE n >= least AND least = most GROUP BY campaign_id)"
      " SELECT campaign_id AS campaign, name,"
      "   CASE WHEN %d AND last.ended_at IS NULL AND last.session_id = (SELECT max(session_id) FROM session)"
      "     THEN 'running'"
      "   WHEN last.outcome = 'finished' OR filled.points = planned.points THEN 'finished'"
      "   WHEN last.outcome IS NOT NULL THEN last.outcome WHEN last.started_at IS NULL THEN 'not known'"
      "   ELSE 'killed' END AS state,"
      "   (SELECT count(*) FROM campaign_point AS p WHERE p.campaign_id = campaign.campaign_id) AS points,"
      "   coalesce(runs, 0) AS runs, coalesce(counted, 0) AS counted, coalesce(censored, 0) AS censored,"
      "   coalesce(failed, 0) AS failed, coalesce(surplus, 0) AS surplus,"
      "   coalesce(failed_attempts, 0) AS failed_attempts, coalesce(without_result, 0) AS without_result,"
      "   coalesce(cpu_time, 0.0) AS cpu_time, last.started_at AS last_started, last.ended_at AS last_ended"
      " FROM campaign LEFT JOIN done USING (campaign_id) LEFT JOIN tried USING (campaign_id)"
      " LEFT JOIN given_up USING (campaign_id) LEFT JOIN last USING (campaign_id) LEFT JOIN planned"
      " USING (campaign_id) LEFT JOIN filled USING (campaign_id) ORDER BY campaign_id",
      named ? sessions_named : sessions_of_runs, writing);
  return query_run(store, sql, 0, NULL, 0, sink, error);
}

struct document {
  char *name, *text;
};

static status take_document(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct document *document = context;
  if (count != 2 || values[0].kind != QUERY_TEXT || values[1].kind != QUERY_TEXT)
    return status_fail(error, STATUS_CONTENT, "the store keeps no campaign document");
  document->name = strdup(values[0].text);
  document->text = strdup(values[1].text);
  if (!document->name || !document->text)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  return STATUS_OK;
}

status ask_campaign_document(struct store *store, int64_t campaign, char **name, char **document, struct error *error) {
  struct document found = {0};
  const struct query_sink sink = {.context = &found, .row = take_document};
  char sql[256];
  snprintf(sql, sizeof sql,
           "SELECT name, document FROM campaign WHERE %lld IN (0, campaign_id) ORDER BY campaign_id DESC LIMIT 1",
           (long long)campaign);
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *name = found.name;
  *document = found.text;
  return code;
}

status ask_campaign_attempts(struct store *store, int64_t *attempts, struct error *error) {
  double most = NAN;
  status code = query_number(store,
                             "SELECT max(n) FROM (SELECT count(*) AS n FROM attempt WHERE NOT EXISTS"
                             " (SELECT 1 FROM run WHERE run.identity = attempt.identity) GROUP BY identity)",
                             0, NULL, &most, error);
  *attempts = isnan(most) ? 0 : (int64_t)most;
  return code;
}
