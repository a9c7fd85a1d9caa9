/* Chooses the runs that all further questions to a store see. The tables that questions read get temporary views of the
 * same names, which SQLite finds first; so no question knows of the choice. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "db/ask/ask.h"
#include "db/store/internal.h"
#include "db/store/views.h"

static const char doing[] = "choosing runs";

/* Tables with a row per point or per point and something else. */
static const char *const of_points[] = {"point",          "campaign_point", "attempt",
                                        "point_estimate", "point_total",    "point_spectrum"};
enum { OF_POINTS = sizeof of_points / sizeof of_points[0], SUMMED = OF_POINTS - 3 }; /* from there: sums over runs */

static status forget(sqlite3 *db, struct error *error) {
  for (size_t i = 0; i < OF_POINTS; i++)
    TRY(sql_executef(db, doing, error, "DROP VIEW IF EXISTS temp.%s; DROP TABLE IF EXISTS temp.chosen_%s", of_points[i],
                     of_points[i])); /* also chosen_point */
  return sql_execute(db,
                     "DROP VIEW IF EXISTS temp.axis; DROP TABLE IF EXISTS temp.chosen_axis; DROP VIEW IF EXISTS "
                     "temp.run; DROP VIEW IF EXISTS temp.campaign; DROP TABLE IF EXISTS "
                     "temp.chosen_campaign; DROP TABLE IF EXISTS temp.chosen_run",
                     doing, error);
}

static status choose_campaigns(struct store *store, const char *campaign, int64_t session, struct error *error) {
  int64_t count = 0;
  TRY(sql_executef(store->db, doing, error,
                   "CREATE TEMP TABLE chosen_campaign AS SELECT campaign_id FROM main.campaign WHERE name = %Q OR "
                   "CAST(campaign_id AS TEXT) = %Q OR (%d AND campaign_id IN (SELECT campaign_id FROM main.session "
                   "WHERE session_id >= %lld))",
                   campaign, campaign, session > 0, (long long)session));
  TRY(sql_integer(store->db, "SELECT count(*) FROM temp.chosen_campaign", 0, &count, error));
  if (count == 0 && campaign)
    return status_fail(error, STATUS_USAGE, "the store has no campaign '%.128s'; `clast status` lists them", campaign);
  TRY(sql_execute(store->db,
                  "DELETE FROM temp.chosen_point WHERE point_id NOT IN (SELECT point_id FROM main.campaign_point JOIN "
                  "temp.chosen_campaign USING (campaign_id))",
                  doing, error));
  return sql_execute(store->db,
                     "CREATE TEMP VIEW campaign AS SELECT * FROM main.campaign WHERE campaign_id IN (SELECT "
                     "campaign_id FROM temp.chosen_campaign)",
                     doing, error);
}

static status choose_campaigns_alone(struct store *store, struct error *error) {
  TRY(sql_execute(store->db,
                  "DELETE FROM temp.chosen_point AS p WHERE point_id NOT IN (SELECT point_id FROM campaign_point) "
                  "AND " POINT_IS_OF_STUDY("main.") "; DELETE FROM temp.chosen_point AS p WHERE " POINT_IS_OF_STUDY(
                      "main."),
                  doing, error)); /* those that a study had planned and did not begin are not told */
  store->left_out = sqlite3_changes64(store->db);
  return STATUS_OK;
}

/* Before the columns of the view runs, the inputs of axes under their short names, as --by takes them and tables show
 * them: "threshold_strain AS strain, ". A short name that an engine's result has, too, means the input; one of two
 * axes, or of another column, means none. */
static status write_short_names(struct store *store, sqlite3_str *columns, struct error *error) {
  ANSWER
  names = answer_to(store, error,
                    "WITH RECURSIVE known AS (SELECT name FROM pragma_table_info('runs') WHERE name NOT IN"
                    "   (SELECT column_name FROM column_doc WHERE table_name GLOB 'result_*') OR name IN"
                    "   (SELECT column_name FROM main.axis)),"
                    " tail AS (SELECT column_name, iif(path LIKE '%%.name', substr(path, 1, length(path) - 5), path)"
                    "   AS name FROM main.axis WHERE column_name IN known UNION ALL"
                    "   SELECT column_name, substr(name, instr(name, '.') + 1) FROM tail WHERE instr(name, '.'))"
                    " SELECT min(column_name), replace(name, '.', '_') AS short FROM tail WHERE short NOT IN known"
                    " GROUP BY short HAVING count(DISTINCT column_name) = 1");
  while (answer_next(&names))
    sqlite3_str_appendf(columns, "\"%w\" AS \"%w\", ", answer_text(&names, 0), answer_text(&names, 1));
  return answer_end(&names);
}

/* The condition comes from the command line: it is asked as a question, which can only read. It is asked alone first:
 * a message about its end then shows nothing of ours. */
static status choose_runs(struct store *store, const char *where, struct error *error) {
  STATEMENT insert = NULL;
  SQL_TEXT short_names = NULL;
  sqlite3_str *columns = sqlite3_str_new(NULL);
  const status listed = write_short_names(store, columns, error);
  short_names = sqlite3_str_finish(columns);
  TRY(listed);
  ANSWER alone = answer_to(store, error, "SELECT run_id FROM (SELECT %s* FROM runs) WHERE %s",
                           short_names ? short_names : "", where);
  TRY(answer_end(&alone));
  TRY(sql_execute(store->db, "CREATE TEMP TABLE chosen_run (run_id INTEGER PRIMARY KEY)", doing, error));
  TRY(sql_prepare(store->db, "INSERT INTO temp.chosen_run VALUES (?1)", &insert, doing, error));
  ANSWER
  runs = answer_to(
      store, error,
      "SELECT run_id FROM (SELECT %s* FROM runs) WHERE point_id IN (SELECT point_id FROM temp.chosen_point) AND (%s\n)",
      short_names ? short_names : "", where);
  while (answer_next(&runs)) {
    sqlite3_bind_int64(insert, 1, answer_integer(&runs, 0));
    TRY(sql_run(insert, doing, error));
  }
  TRY(answer_end(&runs));
  int64_t none = 0;
  TRY(sql_integer(store->db, "SELECT EXISTS (SELECT 1 FROM main.run) AND NOT EXISTS (SELECT 1 FROM temp.chosen_run)", 0,
                  &none, error));
  if (none) {
    const char *file = sqlite3_db_filename(store->db, "main"), *name = strrchr(file, '/');
    return status_fail(error, STATUS_USAGE, "%.200s: none of the runs meets --where \"%.200s\"%s",
                       name ? name + 1 : file, where, store->left_out ? "; those of studies need --studies" : "");
  }
  TRY(sql_execute(store->db,
                  "DELETE FROM temp.chosen_point WHERE point_id NOT IN (SELECT point_id FROM main.run JOIN "
                  "temp.chosen_run USING (run_id)); CREATE TEMP VIEW run AS SELECT * FROM main.run WHERE run_id IN "
                  "(SELECT run_id FROM temp.chosen_run)",
                  doing, error));
  return sums_choose(store->db, error);
}

static status make_views(sqlite3 *db, bool summed, struct error *error) {
  for (size_t i = 0; i < OF_POINTS; i++)
    TRY(sql_executef(db, doing, error,
                     "CREATE TEMP VIEW %s AS SELECT * FROM %s%s WHERE point_id IN (SELECT point_id FROM "
                     "temp.chosen_point)",
                     of_points[i], summed && i >= SUMMED ? "temp.chosen_" : "main.", of_points[i]));
  return STATUS_OK;
}

/* The inputs that tables show and charts choose from. `choice` has its views already. edited: inputs that no campaign
 * varies; they are axes because a file of a campaign was changed. derived: an input that a campaign does not vary, and
 * that differs within it: a default that follows from the varied and the edited inputs. */
static status choose_axes(sqlite3 *db, const struct ask_choice *choice, struct error *error) {
  return sql_executef(
      db, doing, error,
      "CREATE TEMP TABLE chosen_axis AS WITH"
      " varied AS (SELECT j.value AS path FROM campaign, json_each(iif(json_valid(plan), plan, '{}'), '$.axes') AS j"
      "   WHERE %d OR NOT %s),"
      " edited AS (SELECT path FROM main.axis WHERE path NOT IN (SELECT j.value FROM main.campaign, "
      "   json_each(iif(json_valid(plan), plan, '{}'), '$.axes') AS j)),"
      " counted AS MATERIALIZED (SELECT point_id FROM point p WHERE EXISTS (SELECT 1 FROM run WHERE run.point_id = "
      "   p.point_id)),"
      " given AS MATERIALIZED (SELECT path, point_id, (SELECT quote(value) FROM main.point_input i WHERE i.point_id ="
      "   c.point_id AND i.path = axis.path) AS value FROM main.axis, counted c WHERE path NOT IN (SELECT path FROM "
      "   varied) OR path LIKE '%%.name'),"
      " other AS (SELECT path FROM given WHERE path NOT IN (SELECT path FROM varied) GROUP BY path"
      "   HAVING count(DISTINCT ifnull(value, '')) > 1),"
      " follows AS (SELECT path, name FROM other JOIN (SELECT DISTINCT path AS name FROM given WHERE path LIKE "
      "   '%%.name') ON path <> name AND substr(path, 1, length(name) - 4) = substr(name, 1, length(name) - 4)"
      "   WHERE NOT EXISTS (SELECT 1 FROM given v JOIN given n USING (point_id) WHERE v.path = other.path AND n.path ="
      "   name GROUP BY n.value HAVING count(DISTINCT ifnull(v.value, '')) > 1)),"
      " place AS MATERIALIZED (SELECT point_id, (SELECT group_concat(v) FROM (SELECT path || quote(value) AS v FROM "
      "   main.point_input i WHERE i.point_id = c.point_id AND (path IN varied OR path IN edited) ORDER BY path)) AS "
      "   inputs FROM counted c),"
      " derived AS (SELECT path FROM other WHERE path NOT IN edited AND EXISTS (SELECT 1 FROM given JOIN "
      "campaign_point USING (point_id) JOIN "
      "   campaign USING (campaign_id) WHERE given.path = other.path AND (%d OR NOT %s) GROUP BY campaign_id HAVING "
      "   count(DISTINCT ifnull(value, '')) > 1) AND NOT EXISTS (SELECT 1 FROM given JOIN place USING (point_id) WHERE "
      "   given.path = other.path GROUP BY inputs HAVING count(DISTINCT ifnull(value, '')) > 1))"
      " SELECT path FROM main.axis WHERE path IN (SELECT path FROM varied) OR (path IN (SELECT path FROM other) AND "
      "path NOT IN (SELECT path FROM follows UNION SELECT path FROM derived));"
      "CREATE TEMP VIEW axis AS SELECT * FROM main.axis WHERE path IN (SELECT path FROM temp.chosen_axis)",
      choice->campaign != NULL, CAMPAIGN_IS_ROUND, choice->campaign != NULL, CAMPAIGN_IS_ROUND);
}

static status choose(struct store *store, const struct ask_choice *choice, struct error *error) {
  TRY(sql_executef(
      store->db, doing, error,
      "CREATE TEMP TABLE chosen_point (point_id INTEGER PRIMARY KEY); INSERT INTO temp.chosen_point SELECT "
      "point_id FROM main.point WHERE %lld IN (0, point_id)",
      (long long)choice->point));
  if (choice->campaign || choice->session)
    TRY(choose_campaigns(store, choice->campaign, choice->session, error));
  else if (choice->campaigns_alone && choice->point == 0)
    TRY(choose_campaigns_alone(store, error));
  if (choice->where)
    TRY(choose_runs(store, choice->where, error));
  else
    TRY(sql_execute(store->db,
                    "CREATE TEMP VIEW run AS SELECT * FROM main.run WHERE point_id IN (SELECT point_id FROM "
                    "temp.chosen_point)",
                    doing, error));
  TRY(make_views(store->db, choice->where, error));
  return choose_axes(store->db, choice, error);
}

status ask_choose(struct store *store, const struct ask_choice *choice, struct error *error) {
  TRY(ask_points_known(store, choice->point, error));
  sqlite3_exec(store->db, "PRAGMA query_only = OFF", NULL, NULL, NULL); /* it covers temporary tables, too */
  status code = forget(store->db, error);
  store->left_out = 0;
  if (code == STATUS_OK)
    code = ask_register_functions(store, error);
  if (code == STATUS_OK && (choice->point || choice->campaign || choice->session || choice->where ||
                            choice->campaigns_alone || choice->axes))
    code = choose(store, choice, error);
  store->chosen[0] = '\0';
  if (choice->campaign)
    text_append(store->chosen, sizeof store->chosen, "campaign %s", choice->campaign);
  if (choice->where)
    text_append(store->chosen, sizeof store->chosen, "%s%s", choice->campaign ? ", " : "", choice->where);
  if (!store->writer)
    sqlite3_exec(store->db, "PRAGMA query_only = ON", NULL, NULL, NULL);
  return code;
}

void ask_choose_operand(const char *operand, char *path, size_t size, struct ask_choice *choice) {
  const char *colon = strrchr(operand, ':');
  snprintf(path, size, "%s", operand);
  if (!colon || access(operand, F_OK) == 0)
    return;
  snprintf(path, size, "%.*s", (int)(colon - operand), operand);
  char *end = NULL;
  const int64_t point = strtoll(colon + 1, &end, 10);
  if (*end || point < 1)
    choice->campaign = colon + 1;
  else
    choice->point = point;
}

const char *ask_chosen(const struct store *store) {
  return store->chosen;
}

status ask_choice_others(struct store *store, int64_t *runs, struct error *error) {
  int64_t chosen = 0;
  *runs = 0;
  TRY(sql_integer(store->db, "SELECT count(*) FROM temp.sqlite_schema WHERE name = 'chosen_campaign'", 0, &chosen,
                  error));
  return chosen ? sql_integer(store->db,
                              "SELECT count(*) FROM run JOIN session USING (session_id) WHERE counts AND campaign_id "
                              "NOT IN (SELECT campaign_id FROM temp.chosen_campaign)",
                              0, runs, error)
                : STATUS_OK;
}

int64_t ask_choice_left_out(const struct store *store) {
  return store->left_out;
}

static status fit_point(struct store *store, const struct ask_points_version *which, struct error *error) {
  POINT_DATA point = {0};
  struct point_estimate fits[POINT_ESTIMATES];
  struct estimate rows[POINT_ESTIMATES];
  TRY(point_read(store, which->point_id, which->results_version, &point, error));
  TRY(point_estimates(&point, 0.95, fits, error));
  point_estimate_rows(fits, rows);
  return store_insert_estimates(store->db, "chosen_point_estimate", which->point_id, which->results_version,
                                POINT_ESTIMATES, rows, error);
}

status ask_choose_estimates(struct store *store, struct error *error) {
  struct ask_points_version *points = NULL;
  size_t count = 0;
  int64_t chosen = 0;
  TRY(sql_integer(store->db, "SELECT count(*) FROM temp.sqlite_schema WHERE name = 'chosen_point_estimate'", 0, &chosen,
                  error));
  if (chosen == 0)
    return STATUS_OK;
  status code = ask_points_without_estimates(store, 0, &points, &count, error);
  sqlite3_exec(store->db, "PRAGMA query_only = OFF", NULL, NULL, NULL);
  for (size_t i = 0; code == STATUS_OK && i < count; i++)
    code = fit_point(store, &points[i], error);
  sqlite3_exec(store->db, "PRAGMA query_only = ON", NULL, NULL, NULL);
  free(points);
  return code;
}
