/* The campaigns and sessions of a store, and how safe their runs are. */
#include "db/ask/campaign.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/outcome.h"

/* Sessions with their campaigns. The last one has the largest number: clocks are set back at times. A read-only store
 * of an older program does not name the campaign: it is then one of the campaigns of the session's runs. */
static const char sessions_named[] = "SELECT campaign_id, session_id, started_at, ended_at, outcome FROM session";
static const char sessions_of_runs[] =
    "SELECT max(c.campaign_id) AS campaign_id, session_id, started_at, ended_at, outcome FROM"
    " (SELECT DISTINCT session_id, point_id FROM run) JOIN session USING (session_id) JOIN campaign_point p USING "
    "(point_id) JOIN campaign c ON"
    " c.campaign_id = p.campaign_id WHERE ended_at IS NULL OR substr(c.added_at, 1, 19) <= substr(ended_at, 1, 19)"
    " GROUP BY session_id";

struct answer ask_campaign_progress(struct store *store, bool writing, struct error *error) {
  bool named = false;
  const status code = schema_has_column(store->db, "session", "campaign_id", &named, error);
  if (code)
    return answer_failed(code, error);
  return answer_to(
      store, error,
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
}

status ask_campaign_document(struct store *store, int64_t campaign, char **name, char **document, struct error *error) {
  ANSWER
  answer = answer_to(store, error,
                     "SELECT name, document FROM campaign WHERE %lld IN (0, campaign_id) ORDER BY campaign_id DESC "
                     "LIMIT 1",
                     (long long)campaign);
  *name = *document = NULL;
  if (!answer_next(&answer))
    return answer_end(&answer);
  if (answer_value(&answer, 0).kind != QUERY_TEXT || answer_value(&answer, 1).kind != QUERY_TEXT)
    return status_fail(error, STATUS_CONTENT, "the store keeps no campaign document");
  *name = strdup(answer_text(&answer, 0));
  *document = strdup(answer_text(&answer, 1));
  return *name && *document ? STATUS_OK : status_fail(error, STATUS_MEMORY, "out of memory");
}

status ask_campaign_attempts(struct store *store, int64_t *attempts, struct error *error) {
  double most = NAN;
  const status code = answer_number(store, &most, error,
                                    "SELECT max(n) FROM (SELECT count(*) AS n FROM attempt WHERE NOT EXISTS"
                                    " (SELECT 1 FROM run WHERE run.identity = attempt.identity) GROUP BY identity)");
  *attempts = isnan(most) ? 0 : (int64_t)most;
  return code;
}

struct answer ask_campaign_sessions(struct store *store, struct error *error) {
  bool named = false; /* sessions of older programs do not name their campaign */
  const status code = schema_has_column(store->db, "session", "campaign_id", &named, error);
  if (code)
    return answer_failed(code, error);
  return answer_to(
      store, error,
      "SELECT session_id, %s, started_at, ended_at, outcome, facts ->> '$.version', facts ->> '$.commit',"
      " (SELECT group_concat(value, ' ') FROM json_each(facts, '$.command')) FROM session ORDER BY session_id",
      named ? "campaign_id" : "NULL");
}

struct answer ask_campaign_documents(struct store *store, struct error *error) {
  return answer_to(store, error, "SELECT campaign_id, name, document FROM campaign ORDER BY campaign_id");
}

/* The runs of each campaign with their class: safe (usable, no warnings), warned (usable, with warnings), refused
 * (another state). A store of an older program has no warnings. */
static const char judged[] =
    "WITH judged AS (SELECT campaign_id, point_id, identity, state, message, %s AS drift, %g AS drift_allowed, %s AS "
    "warnings,"
    " CASE WHEN state NOT IN ('completed', 'end-time') THEN 'refused' WHEN %s <> '' THEN 'warned' ELSE 'safe' END"
    " AS class FROM campaign_point JOIN run USING (point_id))";

/* `question` has no format. */
static struct answer ask_judged(struct store *store, const char *question, struct error *error) {
  bool warns = false;
  const status code = schema_has_column(store->db, "run", "warnings", &warns, error);
  if (code)
    return answer_failed(code, error);
  const char *warnings = warns ? "coalesce(warnings, '')" : "''";
  char *with = sqlite3_mprintf(judged, OUTCOME_NAME(energy_error), WARNINGS_LARGEST_DRIFT, warnings, warnings);
  struct answer answer = with ? answer_to(store, error, "%s %s", with, question)
                              : answer_failed(status_fail(error, STATUS_MEMORY, "no memory for a question"), error);
  sqlite3_free(with);
  return answer;
}

struct answer ask_campaign_extremes(struct store *store, struct error *error) {
  return ask_judged(
      store,
      "SELECT name AS campaign, count(*) AS runs, sum(class = 'safe') AS safe, sum(class = 'warned') AS warned,"
      " sum(class = 'refused') AS refused, (SELECT count(DISTINCT attempt.identity) FROM campaign_point"
      "   JOIN attempt USING (point_id) WHERE campaign_point.campaign_id = judged.campaign_id AND NOT EXISTS"
      "   (SELECT 1 FROM run WHERE run.identity = attempt.identity)) AS given_up,"
      " max(CASE WHEN class <> 'refused' THEN drift END) AS largest_drift,"
      " sum(class = 'safe' AND coalesce(drift, 0) > drift_allowed) AS silent_drift"
      " FROM judged JOIN campaign USING (campaign_id) GROUP BY campaign_id ORDER BY campaign_id",
      error);
}

struct answer ask_campaign_reasons(struct store *store, struct error *error) {
  return ask_judged(store,
                    "SELECT name AS campaign, class, CASE class WHEN 'refused' THEN state ELSE warnings END AS why,"
                    " count(*) AS runs, min(message) AS example FROM judged JOIN campaign USING (campaign_id)"
                    " WHERE class <> 'safe' GROUP BY campaign_id, class, why ORDER BY campaign_id, runs DESC, why",
                    error);
}

struct answer ask_campaign_values(struct store *store, struct error *error) {
  return ask_judged(
      store,
      ", input AS (SELECT campaign_id, path, value, class FROM judged JOIN point_input USING (point_id)"
      " WHERE path IN (SELECT path FROM axis)),"
      " varied AS (SELECT campaign_id, path FROM input GROUP BY campaign_id, path"
      "   HAVING count(DISTINCT value) > 1)"
      " SELECT name AS campaign, path, value, sum(class = 'safe') AS safe, sum(class = 'warned') AS warned,"
      " sum(class = 'refused') AS refused FROM input JOIN varied USING (campaign_id, path)"
      " JOIN campaign USING (campaign_id) GROUP BY campaign_id, path, value ORDER BY campaign_id, path, value",
      error);
}
