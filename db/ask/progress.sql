-- The progress of campaigns, behind "WITH earlier AS (...)," of ask.c: the earlier forms of campaigns. :earlier is 0 for
-- those without them. :writing is 1 while a process writes the store. The last session has the largest number:
-- clocks are set back at times. Without earlier forms, the rounds of one search or study are one line, in which a point
-- that several of them have counts once.
last AS (SELECT campaign_id, max(session_id) AS session_id, started_at, ended_at, outcome,
  coalesce(facts ->> '$.points_unmet', facts ->> '$.points_too_wide') AS rule_unmet,
  (SELECT group_concat(value, ' ') FROM json_each(facts, '$.command')) AS command FROM session GROUP BY campaign_id),
planned AS (SELECT campaign_id, plan ->> '$.points' AS points, plan ->> '$.replicates_least' AS least,
  plan ->> '$.replicates_most' AS most FROM campaign WHERE json_valid(plan)),
filled AS (SELECT campaign_id, count(*) AS points FROM (SELECT campaign_id, point_id, count(DISTINCT seed) AS n
  FROM campaign_point JOIN run USING (point_id) GROUP BY campaign_id, point_id) JOIN planned
  USING (campaign_id) WHERE n >= least AND least = most GROUP BY campaign_id),
each AS (SELECT campaign_id, name, document LIKE '# Written by clast %' AS is_round,
  CASE WHEN :writing AND last.ended_at IS NULL AND last.session_id = (SELECT max(session_id) FROM session)
      THEN 'running'
    WHEN last.outcome = 'finished' OR filled.points = planned.points THEN 'finished'
    WHEN last.outcome IS NOT NULL THEN last.outcome
    WHEN last.started_at IS NULL THEN 'not known'
    ELSE 'killed' END AS state,
  last.started_at, last.ended_at, last.command, last.rule_unmet
FROM campaign LEFT JOIN last USING (campaign_id) LEFT JOIN planned USING (campaign_id)
  LEFT JOIN filled USING (campaign_id)
WHERE :earlier OR campaign_id NOT IN earlier),
lines AS (SELECT iif(is_round AND NOT :earlier, name || ' ' || state, campaign_id) AS line, * FROM each),
member AS (SELECT DISTINCT line, point_id FROM lines JOIN campaign_point USING (campaign_id)),
size AS (SELECT line, count(*) AS points FROM member GROUP BY line),
done AS (SELECT line, count(*) AS runs, sum(counts) AS counted,
  sum(counts AND state = 'end-time') AS censored, sum(counts AND doubtful) AS warned,
  sum(state NOT IN ('completed', 'end-time') AND surplus < 2) AS failed, sum(surplus = 1) AS surplus,
  sum(surplus > 1) AS excluded, sum(cpu_time) AS cpu_time
  FROM member JOIN runs USING (point_id) GROUP BY line),
tried AS (SELECT line, count(*) AS failed_attempts FROM member JOIN attempt USING (point_id) GROUP BY line),
given_up AS (SELECT line, count(DISTINCT attempt.identity) AS without_result
  FROM member JOIN attempt USING (point_id)
  WHERE NOT EXISTS (SELECT 1 FROM run WHERE run.identity = attempt.identity) GROUP BY line)
SELECT iif(count(*) = 1, campaign_id, NULL) AS campaign, name, lines.state, -- of several, the name is what --campaign takes
  coalesce(points, 0) AS points, coalesce(runs, 0) AS runs, coalesce(counted, 0) AS counted,
  coalesce(censored, 0) AS censored, coalesce(failed, 0) AS failed, coalesce(surplus, 0) AS surplus,
  coalesce(excluded, 0) AS excluded, coalesce(failed_attempts, 0) AS failed_attempts,
  coalesce(without_result, 0) AS without_result, coalesce(cpu_time, 0.0) AS cpu_time,
  min(started_at) AS last_started, max(ended_at) AS last_ended, coalesce(warned, 0) AS warned,
  max(command) AS command, coalesce(sum(rule_unmet), 0) AS rule_unmet
FROM lines LEFT JOIN size USING (line) LEFT JOIN done USING (line) LEFT JOIN tried USING (line)
  LEFT JOIN given_up USING (line)
GROUP BY lines.line ORDER BY min(campaign_id)
