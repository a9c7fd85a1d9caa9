/* Safe, warned and refused runs, by campaign, reason and input. */
#include "db/ask/extremes.h"

#include <stdio.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/outcome.h"
#include "engine/warnings.h"

enum { SQL = 3000 };

/* The runs of each campaign with their class. A store of an older program has no warnings. */
static const char judged[] =
    "WITH judged AS (SELECT campaign_id, point_id, identity, state, message, %s AS drift, %s AS warnings,"
    " CASE WHEN state NOT IN ('completed', 'end-time') THEN 'refused' WHEN %s <> '' THEN 'warned' ELSE 'safe' END"
    " AS class FROM campaign_point JOIN run USING (point_id))";

static status ask(struct store *store, const char *question, const struct query_sink *sink, struct error *error) {
  bool warns = false;
  const status code = schema_has_column(store->db, "run", "warnings", &warns, error);
  if (code)
    return code;
  char with[SQL], sql[2 * SQL];
  const char *warnings = warns ? "coalesce(warnings, '')" : "''";
  snprintf(with, sizeof with, judged, OUTCOME_NAME(energy_error), warnings, warnings);
  snprintf(sql, sizeof sql, "%s %s", with, question);
  return query_run(store, sql, 0, NULL, 0, sink, error);
}

status ask_extremes_campaigns(struct store *store, const struct query_sink *sink, struct error *error) {
  char question[SQL];
  snprintf(question, sizeof question,
           "SELECT name AS campaign, count(*) AS runs, sum(class = 'safe') AS safe, sum(class = 'warned') AS warned,"
           " sum(class = 'refused') AS refused, (SELECT count(DISTINCT attempt.identity) FROM campaign_point"
           "   JOIN attempt USING (point_id) WHERE campaign_point.campaign_id = judged.campaign_id AND NOT EXISTS"
           "   (SELECT 1 FROM run WHERE run.identity = attempt.identity)) AS given_up,"
           " max(CASE WHEN class <> 'refused' THEN drift END) AS largest_drift,"
           " sum(class = 'safe' AND coalesce(drift, 0) > %g) AS silent_drift"
           " FROM judged JOIN campaign USING (campaign_id) GROUP BY campaign_id ORDER BY campaign_id",
           WARNINGS_LARGEST_DRIFT);
  return ask(store, question, sink, error);
}

status ask_extremes_reasons(struct store *store, const struct query_sink *sink, struct error *error) {
  return ask(store,
             "SELECT name AS campaign, class, CASE class WHEN 'refused' THEN state ELSE warnings END AS why,"
             " count(*) AS runs, min(message) AS example FROM judged JOIN campaign USING (campaign_id)"
             " WHERE class <> 'safe' GROUP BY campaign_id, class, why ORDER BY campaign_id, runs DESC, why",
             sink, error);
}

status ask_extremes_values(struct store *store, const struct query_sink *sink, struct error *error) {
  return ask(store,
             ", input AS (SELECT campaign_id, path, value, class FROM judged JOIN point_input USING (point_id)"
             " WHERE path IN (SELECT path FROM axis)),"
             " varied AS (SELECT campaign_id, path FROM input GROUP BY campaign_id, path"
             "   HAVING count(DISTINCT value) > 1)"
             " SELECT name AS campaign, path, value, sum(class = 'safe') AS safe, sum(class = 'warned') AS warned,"
             " sum(class = 'refused') AS refused FROM input JOIN varied USING (campaign_id, path)"
             " JOIN campaign USING (campaign_id) GROUP BY campaign_id, path, value ORDER BY campaign_id, path, value",
             sink, error);
}
