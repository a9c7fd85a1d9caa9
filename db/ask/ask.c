/* Questions to a store: campaigns and sessions, columns, resolution, lists of points, single runs. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "db/store/internal.h"
#include "db/store/views.h"
#include "engine/grow.h"
#include "engine/scene.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

/* ---- campaigns and sessions ---- */

extern const char progress_sql[]; /* db/ask/progress.sql, which the build embeds */

/* The earlier forms of campaigns: those whose points a later campaign of the name has. */
#define EARLIER                                                                                                        \
  "earlier AS (SELECT campaign_id FROM campaign WHERE EXISTS (SELECT 1 FROM campaign AS later WHERE later.name = "     \
  "campaign.name AND later.campaign_id > campaign.campaign_id AND NOT EXISTS (SELECT 1 FROM campaign_point AS p "      \
  "WHERE p.campaign_id = campaign.campaign_id AND p.point_id NOT IN (SELECT point_id FROM campaign_point AS q WHERE "  \
  "q.campaign_id = later.campaign_id))))"

struct answer ask_campaign_progress(struct store *store, bool writing, bool earlier, struct error *error) {
  const struct query_parameter parameters[] = {{"writing", writing ? "1" : "0"}, {"earlier", earlier ? "1" : "0"}};
  SQL_TEXT sql = sql_format("WITH " EARLIER ",\n%s", progress_sql);
  return answer_to_user(store, sql, 2, parameters, 0, error);
}

double ask_campaign_silence(struct store *store) {
  double seconds = NAN;
  (void)answer_number(store, &seconds, NULL,
                      "SELECT unixepoch('now') - max(coalesce((SELECT max(finished_at) FROM run), 0), "
                      "coalesce((SELECT max(unixepoch(started_at)) FROM session), 0))");
  return seconds;
}

void ask_campaign_overlaps(struct store *store, int64_t *earlier, int64_t *shared, int64_t *runs) {
  struct error error;
  *earlier = *shared = *runs = 0;
  ANSWER answer = answer_to(
      store, &error,
      "WITH " EARLIER ",\n"
      "shared AS (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE campaign_id NOT IN "
      "earlier GROUP BY point_id HAVING count(DISTINCT iif(%s, name, campaign_id)) > 1)\n"
      "SELECT (SELECT count(*) FROM earlier JOIN campaign USING (campaign_id) WHERE NOT %s), (SELECT count(*) FROM "
      "shared), (SELECT count(*) FROM run WHERE point_id IN (SELECT point_id FROM campaign_point))",
      CAMPAIGN_IS_ROUND, CAMPAIGN_IS_ROUND);
  if (!answer_next(&answer))
    return;
  *earlier = answer_integer(&answer, 0);
  *shared = answer_integer(&answer, 1);
  *runs = answer_integer(&answer, 2);
}

int64_t ask_campaign_levels(struct store *store) {
  double points = 0;
  const status code = answer_number(
      store, &points, NULL,
      "SELECT count(*) FROM points AS p WHERE n > 0 AND point_id IN (SELECT point_id FROM campaign_point) AND %s",
      POINT_IS_OF_NO_CAMPAIGN(""));
  return code == STATUS_OK ? (int64_t)points : 0;
}

/* min(point_id) stands for a campaign: inputs that it does not vary are those of all its points. */
status ask_campaign_namesakes(struct store *store, const char *name, char *numbers, size_t size, struct error *error) {
  int64_t count = 0;
  *numbers = '\0';
  TRY(sql_integerf(store->db, &count, error,
                   "SELECT count(*) - count(DISTINCT name) FROM campaign WHERE (%Q IS NULL OR name = %Q) AND NOT %s",
                   name, name, CAMPAIGN_IS_ROUND));
  if (count == 0)
    return STATUS_OK;
  ANSWER answer = answer_to(
      store, error,
      "WITH " EARLIER ",\n"
      "form AS MATERIALIZED (SELECT campaign_id, name, (SELECT group_concat(path) FROM (SELECT j.value AS path FROM "
      "json_each(iif(json_valid(plan), plan, '{}'), '$.axes') AS j ORDER BY 1)) AS axes, (SELECT min(point_id) FROM "
      "main.campaign_point AS c WHERE c.campaign_id = campaign.campaign_id) AS first FROM campaign WHERE (%Q IS NULL "
      "OR name = %Q) AND NOT %s AND campaign_id NOT IN earlier)\n"
      "SELECT group_concat(campaign_id, ', ') FROM (SELECT * FROM form ORDER BY campaign_id) AS f GROUP BY name HAVING "
      "count(*) > 1 AND (count(DISTINCT ifnull(axes, '')) > 1 OR EXISTS (SELECT 1 FROM main.axis AS a JOIN form AS g "
      "WHERE g.name = f.name AND instr(',' || ifnull(g.axes, '') || ',', ',' || a.path || ',') = 0 GROUP BY a.path "
      "HAVING "
      "count(DISTINCT ifnull((SELECT quote(value) FROM main.point_input AS i WHERE i.point_id = g.first AND i.path = "
      "a.path), '')) > 1)) ORDER BY min(campaign_id) LIMIT 1",
      name, name, CAMPAIGN_IS_ROUND);
  if (!answer_next(&answer))
    return answer_end(&answer);
  const char *all = answer_text(&answer, 0);
  if ((size_t)snprintf(numbers, size, "%s", all) >= size) /* whole numbers only */
    for (size_t end = size - sizeof ", ..."; end > 0; end--)
      if (numbers[end] == ',') {
        numbers[end] = '\0';
        text_append(numbers, size, ", ...");
        break;
      }
  return STATUS_OK;
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
  *attempts = 0;
  return sql_integerf(store->db, attempts, error,
                      "SELECT max(n) FROM (SELECT count(*) AS n FROM attempt WHERE NOT EXISTS (SELECT 1 FROM run WHERE "
                      "run.identity = attempt.identity) GROUP BY identity)");
}

status ask_campaign_runs(struct store *store, const char *name, int64_t *runs, struct error *error) {
  return sql_integerf(store->db, runs, error,
                      "SELECT count(DISTINCT run_id) FROM campaign JOIN campaign_point USING (campaign_id) JOIN run "
                      "USING (point_id) WHERE name = %Q",
                      name);
}

struct answer ask_campaign_sessions(struct store *store, struct error *error) {
  return answer_to(
      store, error,
      "SELECT session_id, campaign_id, started_at, ended_at, outcome, facts ->> '$.version', facts ->> '$.commit',"
      " (SELECT group_concat(value, ' ') FROM json_each(facts, '$.command')) FROM session ORDER BY session_id");
}

/* Do most of the runs that count have this result? Not after a merge of stores of several engines. */
static bool most_have(struct store *store, const char *name) {
  int64_t runs = 0, having = 0;
  ANSWER kinds = answer_to(store, NULL, "SELECT engine, count(*) FROM runs WHERE counts = 1 GROUP BY engine");
  while (answer_next(&kinds)) {
    runs += answer_integer(&kinds, 1);
    having += views_has_result(engine_find(answer_text(&kinds, 0), NULL), name) ? answer_integer(&kinds, 1) : 0;
  }
  return 2 * having >= runs;
}

status ask_quantity_main(struct store *store, char name[ASK_GROUP_NAME], const char **quantity, struct error *error) {
  if (*quantity)
    return STATUS_OK;
  ANSWER found = answer_to(store, error,
                           "SELECT plan ->> '$.quantity' FROM campaign WHERE json_valid(plan) ORDER BY %s, "
                           "campaign_id DESC LIMIT 1",
                           CAMPAIGN_IS_ROUND);
  const bool has = answer_next(&found) && answer_value(&found, 0).kind == QUERY_TEXT &&
                   ask_group_quantity(store, answer_text(&found, 0), name, NULL) == STATUS_OK && most_have(store, name);
  if (!has)
    snprintf(name, ASK_GROUP_NAME, "%s", OUTCOME_DEFAULT);
  *quantity = name;
  return answer_end(&found);
}

struct answer ask_campaign_documents(struct store *store, struct error *error) {
  return answer_to(store, error, "SELECT campaign_id, name, document FROM campaign ORDER BY campaign_id");
}

/* SQL that is true where `path` belongs to something with a name, such as a material, and the name differs between the
 * points `a` and `b`: the value follows from it. */
#define FOLLOWS_A_NAME(path, a, b)                                                                                     \
  "EXISTS (SELECT 1 FROM point_input n LEFT JOIN point_input m ON m.point_id = " b " AND m.path = n.path WHERE "       \
  "n.point_id = " a " AND n.path LIKE '%%.name' AND n.path <> " path " AND substr(" path ", 1, length(n.path) - 4) = " \
  "substr(n.path, 1, length(n.path) - 4) AND m.value IS NOT n.value)"

struct answer ask_campaign_hidden_inputs(struct store *store, int64_t campaign, int64_t point, struct error *error) {
  return answer_to(
      store, error,
      "WITH this (campaign_id, point_id) AS (VALUES (%lld, %lld)),"
      " mine AS MATERIALIZED (SELECT path, value FROM point_input JOIN this USING (point_id)),"
      " keys AS MATERIALIZED (SELECT *, path LIKE '%%.name' AS names FROM mine WHERE path LIKE '%%.name' OR path IN "
      "(SELECT j.value FROM campaign JOIN this USING (campaign_id), json_each(iif(json_valid(plan), plan, '{}'), "
      "'$.axes') AS j)),"
      " its AS (SELECT campaign_id, campaign_id = (SELECT campaign_id FROM this) AS own, min(point_id) AS first FROM "
      "campaign JOIN campaign_point USING (campaign_id) GROUP BY campaign_id HAVING name = (SELECT name FROM campaign "
      "JOIN this USING (campaign_id)) OR (SELECT engine || scene_name FROM point WHERE point_id = first) = (SELECT "
      "engine || scene_name FROM point JOIN this USING (point_id))),"
      " alike AS (SELECT *, (SELECT point_id FROM campaign_point c WHERE c.campaign_id = its.campaign_id AND NOT (own "
      "AND point_id IN (SELECT point_id FROM this)) AND NOT EXISTS (SELECT 1 FROM keys JOIN point_input i USING (path) "
      "WHERE i.point_id = c.point_id AND i.value IS NOT keys.value AND (own OR names)) ORDER BY point_id DESC LIMIT 1) "
      "AS point_id FROM its),"
      " other AS (SELECT campaign_id, own, iif(own, point_id, ifnull(point_id, first)) AS first FROM alike)"
      " SELECT mine.path, theirs.value, (SELECT scene FROM point WHERE point_id = first), own, max(campaign_id + own * "
      "1e9) FROM other JOIN mine ON first IS NOT NULL LEFT JOIN point_input theirs ON theirs.point_id = first AND "
      "theirs.path = mine.path WHERE theirs.value IS NOT mine.value AND mine.path NOT IN (SELECT path FROM axis) AND "
      "NOT " FOLLOWS_A_NAME("mine.path", "(SELECT point_id FROM this)", "first") " GROUP BY mine.path ORDER BY "
                                                                                 "mine.path",
      (long long)campaign, (long long)point);
}

struct answer ask_campaign_different_inputs(struct store *store, struct error *error) {
  return answer_to(
      store, error,
      "WITH varied AS MATERIALIZED (SELECT campaign_id, j.value AS path FROM campaign, json_each(iif(json_valid(plan), "
      "plan, '{}'), '$.axes') AS j),"
      " place AS MATERIALIZED (SELECT campaign_id, point_id, (SELECT group_concat(v) FROM (SELECT path || quote(value) "
      "AS v FROM varied v JOIN point_input i USING (path) WHERE v.campaign_id = c.campaign_id AND i.point_id = "
      "c.point_id ORDER BY path)) AS inputs, (SELECT group_concat(v) FROM (SELECT quote(value) AS v FROM varied v JOIN "
      "point_input i USING (path) WHERE v.campaign_id = c.campaign_id AND i.point_id = c.point_id AND path LIKE "
      "'%%.name' ORDER BY path)) AS names FROM campaign_point c),"
      " form AS (SELECT format('%%d %%s', campaign_id, inputs) AS one, point_id, count(*) OVER its AS forms, "
      "row_number() OVER (its ORDER BY point_id) AS number FROM place WINDOW its AS (PARTITION BY campaign_id, "
      "inputs)),"
      " known AS (SELECT DISTINCT one, point_id, engine, scene_name, scene FROM point JOIN (SELECT NULL AS one, "
      "min(point_id) AS point_id FROM place GROUP BY campaign_id, names UNION ALL SELECT one, point_id FROM form WHERE "
      "forms > 1 AND (number <= 8 OR number = forms)) USING (point_id)),"
      " given AS (SELECT one, engine, scene_name, path, value, (SELECT n.value FROM point_input n WHERE n.point_id = "
      "known.point_id AND n.path LIKE '%%.name' AND n.path <> i.path AND substr(i.path, 1, length(n.path) - 4) = "
      "substr(n.path, 1, length(n.path) - 4)) AS its_name FROM known JOIN point_input i USING (point_id) WHERE path "
      "NOT IN (SELECT path FROM axis)),"
      " different AS (SELECT DISTINCT one, engine, scene_name, path FROM given GROUP BY one, engine, scene_name, path, "
      "its_name HAVING count(DISTINCT value) > 1)"
      " SELECT engine, path, scene FROM different JOIN known USING (engine, scene_name) WHERE known.one IS "
      "different.one AND EXISTS (SELECT 1 FROM point_input AS its WHERE its.point_id = known.point_id AND its.path = "
      "different.path) ORDER BY engine, path, point_id");
}

/* The runs of each campaign with their class: safe (usable, no warnings), warned (usable, with warnings), refused
 * (another state). `question` has no format. */
static struct answer ask_judged(struct store *store, const char *question, struct error *error) {
  return answer_to(
      store, error,
      "WITH " EARLIER ", judged AS (SELECT campaign_id, point_id, identity, state, message, %s AS drift, %g AS "
      "drift_allowed, coalesce(warnings, '') AS warnings, CASE WHEN state NOT IN ('completed', 'end-time') "
      "THEN 'refused' WHEN doubtful THEN 'warned' ELSE 'safe' END AS class FROM "
      "campaign_point JOIN runs USING (point_id) WHERE surplus < 2 AND campaign_id NOT IN earlier) %s",
      OUTCOME_NAME(energy_error), CONDITION_LARGEST_DRIFT, question);
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

/* ---- columns ---- */

/* SQL: the unit for people of a row of table axis. */
#define WRITTEN_UNIT "ifnull(written_unit, iif(unit = 'rad', 'deg', NULL))"

/* Reads a column from a row of name, SI unit and written unit, of which the last two may be missing. */
static void read_column(const struct answer *answer, struct ask_column *column) {
  *column = (struct ask_column){.factor = 1};
  snprintf(column->name, sizeof column->name, "%s", answer_text(answer, 0));
  snprintf(column->unit, sizeof column->unit, "%s", answer_text(answer, 1));
  if (answer_value(answer, 2).kind == QUERY_TEXT)
    ask_columns_write_in(column, answer_text(answer, 2));
}

/* A written unit comes from the file. It is used only if it is a valid unit of the input's dimension. */
void ask_columns_write_in(struct ask_column *column, const char *written) {
  struct unit own, other;
  if (unit_parse(*column->unit ? column->unit : "1", &own, NULL) || unit_parse(written, &other, NULL) ||
      !unit_same_dimension(&own, &other) || strlen(written) >= sizeof column->unit)
    return;
  snprintf(column->unit, sizeof column->unit, "%s", written);
  column->factor = other.factor / own.factor;
}

/* Does the path of another axis end like this? */
static bool is_ambiguous(const struct ask_column *axes, size_t count, size_t axis, const char *tail) {
  const size_t end = strlen(tail);
  for (size_t i = 0; i < count; i++) {
    const size_t length = strlen(axes[i].word);
    if (i != axis && length >= end && strcmp(axes[i].word + length - end, tail) == 0 &&
        (length == end || axes[i].word[length - end - 1] == '.'))
      return true;
  }
  return false;
}

/* The shortest end of an axis' path (in `word`) that no other has. "name" or "fraction" alone says too little. */
static const char *short_word(const struct ask_column *axes, size_t count, size_t axis) {
  const char *const path = axes[axis].word, *word = path + strlen(path);
  while (word > path && (word[-1] != '.' || strcmp(word, "name") == 0 || strcmp(word, "fraction") == 0 ||
                         is_ambiguous(axes, count, axis, word)))
    word--;
  return word;
}

status ask_columns_axes(struct store *store, bool written, size_t most, struct ask_column *axes, size_t *count,
                        struct error *error) {
  const char *word[LIMITS_AXES_OF_STORE];
  ANSWER answer = answer_to(
      store, error,
      "SELECT column_name, unit, %s, path, place >= 2e18 FROM (SELECT *, ifnull((SELECT min(iif(%s, 2e18, 0) + "
      "campaign_id * 1000 + key) FROM campaign, json_each(iif(json_valid(plan), plan, '{}'), '$.axes') AS j WHERE "
      "j.value = axis.path), 1e18) AS place FROM axis%s) ORDER BY %spath",
      written ? WRITTEN_UNIT : "NULL", CAMPAIGN_IS_ROUND,
      written ? " UNION ALL SELECT 'scene', 'scene', NULL, NULL, '', 1.5e18 WHERE " STORE_HAS_SCENES : "",
      written ? "place, " : "");
  for (*count = 0; *count < most && answer_next(&answer); ++*count) {
    read_column(&answer, &axes[*count]);
    snprintf(axes[*count].word, sizeof axes->word, "%s", answer_text(&answer, 3));
    axes[*count].of_studies = answer_integer(&answer, 4) != 0;
  }
  for (size_t i = 0; i < *count; i++)
    word[i] = short_word(axes, *count, i);
  for (size_t i = 0; i < *count; i++)
    memmove(axes[i].word, word[i], strlen(word[i]) + 1);
  for (size_t i = 0; i < *count; i++) /* "material" says enough of material.name */
    if (strlen(axes[i].word) > 5 && strcmp(strchr(axes[i].word, 0) - 5, ".name") == 0)
      axes[i].word[strlen(axes[i].word) - 5] = '\0';
  return answer_end(&answer);
}

status ask_columns_written(struct store *store, const char *column, struct ask_column *out, struct error *error) {
  ANSWER answer = answer_to(store, error,
                            "SELECT column_name, unit, " WRITTEN_UNIT " FROM main.axis WHERE column_name = %Q", column);
  *out = (struct ask_column){.factor = 1};
  snprintf(out->name, sizeof out->name, "%s", column);
  if (!answer_next(&answer) && answer_status(&answer) == STATUS_OK)
    return ask_columns_unit(store, column, out->unit, sizeof out->unit, error);
  if (answer_status(&answer) == STATUS_OK)
    read_column(&answer, out);
  return answer_end(&answer);
}

struct query_value ask_columns_value(const struct ask_column *column, const struct query_value *value) {
  struct query_value shown = *value;
  if (column->factor == 1 || (value->kind != QUERY_REAL && value->kind != QUERY_INTEGER))
    return shown;
  shown.kind = QUERY_REAL;
  shown.real = value->real / column->factor;
  return shown;
}

void ask_columns_show(const struct ask_column *column, const struct query_value *value, char *text, size_t size) {
  const struct query_value shown = ask_columns_value(column, value);
  if (shown.kind == QUERY_TEXT || shown.kind == QUERY_NULL) {
    snprintf(text, size, "%s", shown.kind == QUERY_TEXT ? shown.text : "off");
    return;
  }
  const bool whole = shown.real == rint(shown.real) && fabs(shown.real) < 1e6;
  const char *unit = strcmp(column->unit, "1") == 0 ? "" : column->unit;
  snprintf(text, size, whole ? "%.0f%s%s" : "%.3g%s%s", shown.real, *unit ? " " : "", unit);
  text_powers(text, size);
}

/* In stores whose column_doc an older build wrote, masses of an engine in the plane are in kg. They are per metre of
 * thickness, and densities over them are, too. With runs of both kinds the column has no unit. */
static status per_metre(struct store *store, char *unit, size_t size, struct error *error) {
  bool plane = false, other = false;
  const bool inverse = strcmp(unit, "1/kg") == 0;
  if (!inverse && strcmp(unit, "kg") != 0)
    return STATUS_OK;
  ANSWER answer = answer_to(store, error, "SELECT DISTINCT engine FROM point");
  while (answer_next(&answer)) {
    const struct engine_kind *kind = engine_find(answer_text(&answer, 0), NULL);
    *(kind && kind->dimensions == 2 ? &plane : &other) = true;
  }
  const char *one = inverse ? ask_pool_per_mass_unit(plane ? 2 : 3) : ask_pool_mass_unit(plane ? 2 : 3);
  snprintf(unit, size, "%s", plane && other ? "" : one);
  return answer_end(&answer);
}

/* Units by column, of the one or of all. A result that several engines have is in the unit of the store's engine; a
 * column with different units in different tables has none. */
static struct answer ask_units(struct store *store, const char *column, struct error *error) {
  return answer_to(
      store, error,
      "SELECT column_name, ifnull((SELECT min(unit) FROM column_doc r WHERE r.column_name = d.column_name "
      "AND r.table_name IN (SELECT 'result_' || engine FROM point)), min(unit)), NULL FROM column_doc d WHERE "
      "unit NOT IN ('1', 'kg or kg/m', '1/kg or m/kg') AND table_name NOT LIKE 'result\\_%%' ESCAPE '\\' AND "
      "column_name = ifnull(%Q, column_name) GROUP BY column_name HAVING count(DISTINCT unit) = 1",
      column);
}

status ask_columns_unit(struct store *store, const char *column, char *unit, size_t size, struct error *error) {
  ANSWER answer = ask_units(store, column, error);
  snprintf(unit, size, "%s", answer_next(&answer) ? answer_text(&answer, 1) : "");
  TRY(answer_end(&answer));
  return per_metre(store, unit, size, error);
}

status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error) {
  size_t room = 0;
  ANSWER answer = ask_units(store, NULL, error);
  *columns = NULL;
  for (*count = 0; answer_next(&answer);) {
    TRY(grow_or_fail(columns, &room, *count + 1, sizeof **columns, "the units of the columns", error));
    read_column(&answer, &(*columns)[(*count)++]);
  }
  TRY(answer_end(&answer));
  for (size_t i = 0; i < *count; i++)
    TRY(per_metre(store, (*columns)[i].unit, sizeof(*columns)[i].unit, error));
  return STATUS_OK;
}

struct answer ask_columns_view(struct store *store, const char *view, struct error *error) {
  if (strcmp(view, "resolution") == 0) /* it knows of no choice, since a study's points are those of its levels */
    return answer_to(store, error,
                     "SELECT * FROM resolution WHERE point_id IN (SELECT point_id FROM point) ORDER BY point_id, "
                     "results_version, quantity");
  return answer_to(store, error, "SELECT * FROM \"%w\" ORDER BY 1", view);
}

/* ---- resolution ---- */

const char *const ask_resolution_names[] = {[ASK_RESOLUTION_NOT_STUDIED] = "not-studied",
                                            [ASK_RESOLUTION_KNOWN] = "known",
                                            [ASK_RESOLUTION_NO_DIFFERENCE] = "no-difference",
                                            [ASK_RESOLUTION_AT_LEAST] = "at-least",
                                            [ASK_RESOLUTION_DIVERGES] = "diverges"};

enum ask_resolution_verdict ask_resolution_verdict(const char *verdict) {
  for (int i = ASK_RESOLUTION_KNOWN; i <= ASK_RESOLUTION_DIVERGES; i++)
    if (verdict && strcmp(verdict, ask_resolution_names[i]) == 0)
      return (enum ask_resolution_verdict)i;
  return ASK_RESOLUTION_NOT_STUDIED;
}

/* The command names its file, the last word, as it was called where the command ran. From another folder it is the file
 * beside the store, with --store; none: no command. */
static void call_from_here(const char *store_path, const char *file, char *command, size_t size) {
  char word[TEXT_WORD];
  const char *slash = strrchr(store_path, '/'), *name = text_word(file, word);
  const size_t length = strlen(command), last = strlen(name);
  if (!*command || scene_builtin_text(file) || strchr(file, '@') || access(file, F_OK) == 0)
    return;
  OWNED char *folder = slash ? memory_small_text(store_path) : NULL;
  if (folder)
    folder[slash - store_path + (slash == store_path)] = '\0';
  OWNED char *whole = folder ? file_name_in(folder, file) : NULL;
  const bool same = length >= last && strcmp(command + length - last, name) == 0;
  if (!whole || !same || access(whole, F_OK) != 0 || strstr(command, "--store")) {
    *command = '\0';
    return;
  }
  command[length - last] = '\0';
  text_append(command, size, "%s --store", text_word(whole, word));
  text_append_word(command, size, store_path);
}

/* What `clast converge` takes so that its levels belong to these points: the file or the scene that computed them, with
 * the inputs and the store of that command line. A campaign is preferred to a study of one of its points. Several
 * files: no command. */
static status find_command(struct store *store, long long id, const char *quantity, struct ask_resolution *out,
                           struct error *error) {
  ANSWER found = answer_to(
      store, error,
      "SELECT DISTINCT json_extract(facts, '$.command[1]') AS verb, (SELECT group_concat(iif(value GLOB "
      "'*[^-A-Za-z0-9_./=,:%%+]*', '''' || replace(value, '''', '''\\''''') || '''', value), ' ') FROM "
      "json_each(facts, "
      "'$.command') WHERE key = json_array_length(facts, '$.command') - 1 OR value GLOB '--set=*' OR value GLOB "
      "'--store=*' OR value IN ('-s', '--set', '--store') OR json_extract(facts, '$.command[' || max(key - 1, 0) || "
      "']') IN "
      "('-s', '--set', '--store')), json_extract(facts, '$.command[#-1]') FROM session WHERE verb IN ('run', 'fit', "
      "'find', 'converge') AND (%lld = 0 OR "
      "campaign_id IN "
      "(SELECT campaign_id FROM campaign_point WHERE point_id = %lld)) ORDER BY verb DESC LIMIT 2",
      id, id);
  char verb[16] = "", command[512] = "";
  while (answer_next(&found) && strcmp(answer_text(&found, 0), verb) >= 0) {
    snprintf(command, sizeof command, "%s", *verb ? "" : answer_text(&found, 1));
    call_from_here(store->path, answer_text(&found, 2), command, sizeof command);
    text_append(command, sizeof command, " -Q %s", quantity);
    snprintf(verb, sizeof verb, "%s", answer_text(&found, 0));
  }
  if (*command > ' ' && strlen(command) < sizeof out->command)
    memcpy(out->command, command, strlen(command) + 1);
  text_make_plain(out->command, "");
  return answer_end(&found);
}

/* The text of a question about the parts. */
static char *of_parts(const char *question) {
  char *text = NULL;
  FILE *out = text_open(&text);
  views_resolution_parts(out);
  fputs(question, out);
  return text_close_small(out, &text);
}

status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error) {
  *out = (struct ask_resolution){.verdict = ASK_RESOLUTION_NOT_STUDIED, .half_width = NAN};
  if (!store)
    return STATUS_OK;
  const long long id = point_id;
  quantity = estimates_short_name(quantity);

  TRY(find_command(store, id, quantity, out, error));

  ANSWER found =
      answer_to(store, error,
                "SELECT count(*), count(half_width), total(verdict = 'diverges'), total(verdict = 'at-least'), "
                "total(verdict = 'known'), ifnull(max(iif(verdict <> 'diverges', half_width, NULL)), max(half_width)) "
                "FROM (SELECT point_id, max(results_version) AS results_version FROM "
                "point_total"
                "   WHERE runs > 0 AND %lld IN (0, point_id) GROUP BY point_id)"
                " LEFT JOIN (SELECT * FROM resolution WHERE quantity = %Q) USING (point_id, results_version)",
                id, quantity);
  if (answer_next(&found)) {
    out->points = answer_integer(&found, 0);
    out->studied = answer_integer(&found, 1);
    out->diverging = (int64_t)answer_real(&found, 2);
    out->at_least = (int64_t)answer_real(&found, 3);
    if (out->studied > 0)
      out->verdict = out->diverging               ? ASK_RESOLUTION_DIVERGES
                     : out->at_least              ? ASK_RESOLUTION_AT_LEAST
                     : answer_real(&found, 4) > 0 ? ASK_RESOLUTION_KNOWN
                                                  : ASK_RESOLUTION_NO_DIFFERENCE;
    out->half_width = answer_real(&found, 5);
  }
  TRY(answer_end(&found));
  if (out->studied == 0)
    return STATUS_OK;

  OWNED char *question = of_parts("SELECT group_concat(knob, ', ') FROM (SELECT knob FROM part WHERE quantity = ");
  ANSWER
  knobs = answer_to(store, error,
                    "%s%Q AND error IS NOT NULL AND point_id IN (SELECT point_id FROM point_total WHERE runs > 0 AND "
                    "%lld IN (0, point_id)) GROUP BY knob ORDER BY knob)",
                    question, quantity, id);
  if (answer_next(&knobs))
    snprintf(out->knobs, sizeof out->knobs, "%s", answer_text(&knobs, 0));
  text_make_plain(out->knobs, "");
  return answer_end(&knobs);
}

status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error) {
  double count = 0;
  const status code = answer_number(store, &count, error,
                                    "SELECT count(*) FROM resolution WHERE quantity GLOB 'beta*'");
  *studied = count > 0;
  return code;
}

struct answer ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                                     bool errors, struct error *error) {
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < convergence_table.count; i++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(convergence_table.rows[i].path, name, sizeof name);
    sqlite3_str_appendf(columns, "%sc.\"%w\"", i ? ", " : "", name);
  }
  char *list = sqlite3_str_finish(columns); /* NULL, no memory, is an empty list: the question then fails */
  OWNED char *told = errors ? of_parts("") : memory_small_text("");
  return answer_to(
      store, error,
      "%s SELECT %z, %s WHERE %lld IN (0, c.base_point_id) AND c.results_version = %d AND c.quantity = %Q ORDER BY "
      "c.base_point_id, c.knob, c.level",
      told, list,
      errors
          ? "t.half_width, t.verdict, c.point_id, c.base_point_id FROM convergence c LEFT JOIN told t USING (point_id, "
            "results_version, quantity)"
          : "NULL, NULL, c.point_id, c.base_point_id FROM convergence c",
      (long long)base_point, results_version, quantity);
}

bool ask_convergence_next(struct answer *answer, struct convergence_row *row) {
  if (!answer_next(answer))
    return false;
  field_defaults(&convergence_table, row);
  for (size_t i = 0; i < convergence_table.count; i++) {
    const struct field *field = &convergence_table.rows[i];
    const struct query_value stored = answer_value(answer, i);
    struct field_value value = {.kind = field->kind, .number = stored.real, .integer = stored.integer};
    if (field->kind == FIELD_TEXT)
      field_copy_text(value.text, stored.kind == QUERY_TEXT ? stored.text : "");
    field_set_unchecked(field, row, &value);
  }
  row->error = answer_real(answer, convergence_table.count);
  row->at_least = ask_resolution_verdict(answer_text(answer, convergence_table.count + 1)) > ASK_RESOLUTION_KNOWN;
  row->point = answer_integer(answer, convergence_table.count + 2);
  row->base_point = answer_integer(answer, convergence_table.count + 3);
  return true;
}

struct answer ask_parts(struct store *store, int64_t base_point, int results_version, const char *quantity,
                        struct error *error) {
  OWNED char *question = of_parts(
      "SELECT point_id, knob, error, open, beyond, left_by_seeds, coarser, finest, seeds FROM "
      "part WHERE point_id IN (SELECT point_id FROM convergence WHERE base_point_id = ");
  return answer_to(
      store, error,
      "%s%lld UNION SELECT %lld) AND results_version = %d AND quantity = %Q ORDER BY point_id, error DESC, "
      "knob",
      question, (long long)base_point, (long long)base_point, results_version, quantity);
}

bool ask_parts_next(struct answer *answer, struct ask_part *part) {
  if (!answer_next(answer))
    return false;
  *part = (struct ask_part){.point = answer_integer(answer, 0),
                            .knob = answer_text(answer, 1),
                            .error = answer_real(answer, 2),
                            .open = answer_integer(answer, 3) > 0,
                            .beyond = answer_real(answer, 4),
                            .left_by_seeds = answer_real(answer, 5),
                            .coarser = answer_integer(answer, 6),
                            .finest = answer_text(answer, 7),
                            .seeds = answer_integer(answer, 8)};
  return true;
}

/* ---- lists of points ---- */

enum { FIRST_INPUT = 11 }; /* column of the first input in the query of ask_points_rows */

status ask_points_count(struct store *store, int64_t *points, struct error *error) {
  return sql_integer(store->db, "SELECT count(*) FROM point", 0, points, error);
}

status ask_points_known(struct store *store, int64_t point, struct error *error) {
  if (point == 0)
    return STATUS_OK;
  ANSWER answer =
      answer_to(store, error,
                "SELECT count(*) FILTER (WHERE point_id = %lld), ifnull(min(point_id), 0), ifnull(max(point_id), "
                "0) FROM point",
                (long long)point);
  if (!answer_next(&answer) || answer_integer(&answer, 0) > 0)
    return answer_end(&answer);
  if (answer_integer(&answer, 2) == 0)
    return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has no points yet", (long long)point);
  return status_fail(error, STATUS_USAGE, "there is no point %lld: the store has the points %lld to %lld",
                     (long long)point, (long long)answer_integer(&answer, 1), (long long)answer_integer(&answer, 2));
}

struct answer ask_points_rows(struct store *store, bool newest, size_t input_count, const char *const *inputs,
                              struct error *error) {
  sqlite3_str *sql = sqlite3_str_new(NULL);
  sqlite3_str_appendall(sql, "SELECT point_id, results_version, n, failed, largest_fraction_mean, "
                             "largest_fraction_hw95, largest_fraction_low95, largest_fraction_high95, "
                             "ifnull(largest_fraction_weak, 0), largest_fraction_resolution, "
                             "largest_fraction_resolution_verdict");
  for (size_t i = 0; i < input_count && i < LIMITS_AXES_OF_POOL; i++)
    sqlite3_str_appendf(sql, ", \"%w\"", inputs[i]);
  return answer_to(store, error,
                   "%z FROM points AS p WHERE %d OR results_version IS NULL OR results_version = (SELECT "
                   "max(results_version) FROM point_total AS t WHERE t.point_id = p.point_id) ORDER BY point_id, "
                   "results_version",
                   sqlite3_str_finish(sql), !newest);
}

bool ask_points_next(struct answer *answer, struct ask_points_row *row) {
  if (!answer_next(answer))
    return false;
  *row = (struct ask_points_row){.point_id = answer_integer(answer, 0),
                                 .results_version = answer_integer(answer, 1),
                                 .n = answer_integer(answer, 2),
                                 .failed = answer_integer(answer, 3),
                                 .mean = answer_real(answer, 4),
                                 .half_width = answer_real(answer, 5),
                                 .low = answer_real(answer, 6),
                                 .high = answer_real(answer, 7),
                                 .weak = answer_integer(answer, 8) != 0,
                                 .resolution = answer_real(answer, 9),
                                 .resolution_verdict = ask_resolution_verdict(answer_text(answer, 10)),
                                 .input_count = answer_count(answer) - FIRST_INPUT};
  for (size_t i = 0; i < row->input_count; i++)
    row->inputs[i] = answer_value(answer, FIRST_INPUT + i);
  const struct ask_doubts_choice choice = {.point = row->point_id};
  answer->code = ask_doubts(answer->store, &choice, OUTCOME_DEFAULT, &row->doubts, answer->error);
  return answer->code == STATUS_OK;
}

status ask_points_label(struct store *store, struct store *units, int64_t point_id, char *text, size_t size,
                        struct error *error) {
  snprintf(text, size, "point %lld", (long long)point_id);
  ANSWER
  answer = answer_to(
      store, error,
      "WITH mine AS (SELECT *, replace(name, rtrim(name, replace(name, '.', '')), '') AS word FROM (SELECT "
      "iif(path LIKE '%%.name', substr(path, 1, length(path) - 5), path) AS name, path, value, unit, " WRITTEN_UNIT
      " AS written_unit FROM point_input JOIN axis USING (path) WHERE point_id = %lld)) "
      "SELECT name, value, unit, written_unit, (SELECT count(*) FROM mine o WHERE o.word = m.word) = 1 "
      "FROM mine m ORDER BY path DESC",
      (long long)point_id);
  for (size_t used = 0; answer_next(&answer);) {
    const char *path = answer_text(&answer, 0), *word = answer_integer(&answer, 4) ? strrchr(path, '.') : NULL;
    struct ask_column column = {.factor = 1};
    snprintf(column.unit, sizeof column.unit, "%s", answer_text(&answer, 2));
    ANSWER other = {.code = STATUS_OK};
    if (units != store)
      other = answer_to(units, error, "SELECT " WRITTEN_UNIT " FROM main.axis WHERE path = %Q", path);
    const struct answer *written = units != store && answer_next(&other) ? &other : &answer;
    const size_t place = written == &other ? 0 : 3;
    if (answer_value(written, place).kind == QUERY_TEXT)
      ask_columns_write_in(&column, answer_text(written, place));
    TRY(answer_status(&other));
    const struct query_value value = answer_value(&answer, 1);
    char shown[128], item[256];
    ask_columns_show(&column, &value, shown, sizeof shown);
    const int length = snprintf(item, sizeof item, "%s%s %s", used ? ", " : "", word ? word + 1 : path, shown);
    if (length <= 0 || (size_t)length >= sizeof item || used + (size_t)length >= size)
      continue; /* inputs that do not fit are left out */
    memcpy(text + used, item, (size_t)length + 1);
    used += (size_t)length;
  }
  return answer_end(&answer);
}

status ask_points_scenes(struct store *store, char *names, size_t size, struct error *error) {
  ANSWER answer = answer_to(
      store, error, "SELECT group_concat(scene_name, ', ') FROM (SELECT DISTINCT scene_name FROM point ORDER BY 1)");
  snprintf(names, size, "%s", answer_next(&answer) ? answer_text(&answer, 0) : "");
  text_make_plain(names, "");
  return answer_end(&answer);
}

status ask_points_without_estimates(struct store *store, int64_t campaign, struct ask_points_version **list,
                                    size_t *count, struct error *error) {
  size_t room = 0;
  *list = NULL;
  *count = 0;
  ANSWER
  answer =
      answer_to(store, error,
                "SELECT point_id, results_version FROM point_total AS t WHERE runs > 0 AND (%lld = 0 OR point_id IN"
                " (SELECT point_id FROM campaign_point WHERE campaign_id = %lld)) AND NOT EXISTS (SELECT 1 FROM"
                " point_estimate AS e WHERE e.point_id = t.point_id AND e.results_version = t.results_version)"
                " ORDER BY point_id, results_version",
                (long long)campaign, (long long)campaign);
  while (answer_next(&answer)) {
    TRY(grow_or_fail(list, &room, *count + 1, sizeof **list, "the list of points", error));
    (*list)[(*count)++] = (struct ask_points_version){answer_integer(&answer, 0), (int)answer_integer(&answer, 1)};
  }
  return answer_end(&answer);
}

/* ---- single runs ---- */

status ask_run_read(struct store *store, int64_t run_id, struct ask_run *run, struct error *error) {
  *run = (struct ask_run){0};
  ANSWER answer = answer_to(
      store, error,
      "SELECT scene, seed, results_version, json_extract(facts, '$.cpu_class'), json_extract(facts, '$.version'), "
      "json_extract(facts, '$.commit') || iif(json_extract(facts, '$.dirty'), ' with local changes', ''), "
      "json_extract(facts, '$.compiler') FROM run JOIN point USING (point_id) LEFT JOIN session USING "
      "(session_id) WHERE run_id = %lld",
      (long long)run_id);
  if (answer_next(&answer)) {
    if (answer_value(&answer, 0).kind != QUERY_TEXT)
      return status_fail(error, STATUS_CONTENT, "the store has no scene for this run");
    run->scene = strdup(answer_text(&answer, 0));
    if (!run->scene)
      return status_fail(error, STATUS_MEMORY, "out of memory");
    run->seed = (uint64_t)answer_integer(&answer, 1);
    run->results_version = answer_integer(&answer, 2);
    snprintf(run->cpu_class, sizeof run->cpu_class, "%s", answer_text(&answer, 3));
    snprintf(run->version, sizeof run->version, "%s", answer_text(&answer, 4));
    snprintf(run->commit, sizeof run->commit, "%s", answer_text(&answer, 5));
    snprintf(run->compiler, sizeof run->compiler, "%s", answer_text(&answer, 6));
  }
  TRY(answer_end(&answer));
  return store_point_shapes(store, run_id, error);
}

void ask_scene_of_fields(const char *fields, char *name, size_t size) {
  static const char ending[] = "-fields";
  OWNED char *path = realpath(fields, NULL);
  char *base = path ? strrchr(path, '/') : NULL, store_path[LIMITS_PATH];
  struct error ignored;
  STORE store = NULL;
  *name = '\0';
  if (!base || strspn(base + 1, "0123456789abcdef") != 32 || base - path < (ptrdiff_t)strlen(ending))
    return;
  *base = '\0';
  char *end = base - strlen(ending);
  if (strcmp(end, ending) != 0)
    return;
  snprintf(store_path, sizeof store_path, "%.*s.db", (int)(end - path), path);
  if (store_open_reader(store_path, &store, &ignored) != STATUS_OK)
    return;
  ANSWER answer = answer_to(store, &ignored,
                            "SELECT scene_name FROM run JOIN point USING (point_id) WHERE identity = x'%.32q'",
                            base + 1);
  if (answer_next(&answer))
    snprintf(name, size, "%s", answer_text(&answer, 0));
  text_make_plain(name, "");
}

void ask_run_release(struct ask_run *run) {
  free(run->scene);
  run->scene = NULL;
}

struct answer ask_run_results(struct store *store, int64_t run_id, const char *engine, struct error *error) {
  return answer_to(store, error, "SELECT * FROM run JOIN \"result_%w\" USING (run_id) WHERE run_id = %lld", engine,
                   (long long)run_id);
}

status ask_run_column_used(struct store *store, int64_t run_id, const char *engine, const char *column, bool *used,
                           struct error *error) {
  double count = 0;
  const status code = answer_number(
      store, &count, error,
      "SELECT count(\"%w\") FROM run JOIN \"result_%w\" USING (run_id) WHERE session_id IS (SELECT session_id "
      "FROM run WHERE run_id = %lld)",
      column, engine, (long long)run_id);
  *used = count > 0;
  return code;
}

/* An older store lacks the columns, and has no such run. */
struct answer ask_run_excluded(struct store *store, struct error *error) {
  const bool has = sqlite3_table_column_metadata(store->db, "main", "run", "excluded", NULL, NULL, NULL, NULL, NULL) ==
                   SQLITE_OK;
  return answer_to(store, error,
                   "SELECT run_id, point_id, seed, %s AS date, %s AS reason FROM run WHERE surplus > 1 ORDER BY run_id",
                   has ? "excluded_at" : "''", has ? "excluded" : "''");
}

status ask_run_excluded_count(struct store *store, int64_t *count, struct error *error) {
  *count = 0;
  return sql_integerf(store->db, count, error, "SELECT count(*) FROM run WHERE counts = 0 AND surplus > 1");
}

status ask_run_missing(struct store *store, int64_t *missing, int64_t *wanted, struct error *error) {
  ANSWER sum = answer_to(store, error,
                         "SELECT total(missing), total(missing + runs) FROM (SELECT ifnull(t.runs, 0) AS runs, "
                         "ifnull(t.failed, 0) + " POINT_DIED(
                             POINT_RUNS_ARE_ALL) " AS missing FROM point p LEFT JOIN point_total "
                                                 "t ON t.point_id = p.point_id AND t.results_version = (SELECT "
                                                 "max(v.results_version) FROM "
                                                 "point_total v WHERE v.point_id = p.point_id))");
  *missing = *wanted = 0;
  if (answer_next(&sum)) {
    *missing = (int64_t)answer_real(&sum, 0);
    *wanted = (int64_t)answer_real(&sum, 1);
  }
  return answer_end(&sum);
}

status ask_run_masses(struct store *store, int64_t run_id, double **masses, size_t *count, struct error *error) {
  const void *stored;
  *masses = NULL;
  *count = 0;
  ANSWER answer = answer_to(store, error, "SELECT masses FROM fragment_mass WHERE run_id = %lld", (long long)run_id);
  if (!answer_next(&answer) || !answer_masses(&answer, 0, "this run", &stored, count))
    return answer_end(&answer);
  TRY(memory_array(masses, *count, sizeof **masses, "the masses", error));
  if (*count > 0)
    memcpy(*masses, stored, *count * sizeof **masses);
  return STATUS_OK;
}

status ask_run_wall_time(struct store *store, const uint8_t identity[16], double *seconds, double *cpu_s,
                         struct error *error) {
  char hexadecimal[33];
  text_hex(identity, 16, hexadecimal);
  ANSWER answer = answer_to(store, error, "SELECT wall_time, cpu_time FROM run WHERE identity = x'%s'", hexadecimal);
  *seconds = *cpu_s = NAN;
  if (answer_next(&answer)) {
    *seconds = answer_real(&answer, 0);
    *cpu_s = answer_real(&answer, 1);
  }
  return answer_end(&answer);
}

struct answer ask_run_costs(struct store *store, int results_version, struct error *error) {
  return answer_to(store, error, "SELECT point_id, avg(cpu_time) FROM run WHERE results_version = %d GROUP BY point_id",
                   results_version);
}

status ask_run_wall_times(struct store *store, const char *scene, uint64_t *count, double *sum, double *most,
                          double *cpu_s, struct error *error) {
  ANSWER answer = answer_to(store, error,
                            "SELECT count(wall_time), sum(wall_time), max(wall_time), sum(cpu_time) FROM run JOIN "
                            "point USING (point_id) WHERE scene_name = %Q",
                            scene);
  if (answer_next(&answer)) {
    *count = (uint64_t)answer_integer(&answer, 0);
    *sum = answer_real(&answer, 1);
    *most = answer_real(&answer, 2);
    *cpu_s = answer_real(&answer, 3);
  }
  return answer_end(&answer);
}

char *ask_run_fields(const struct answer *answer, size_t column) {
  return paths_of_fields(answer->store->path, answer_text(answer, column));
}

static int state_of(const char *name) {
  const struct field *states = field_find(&outcome_table, "state", NULL);
  for (int k = 0; states->choices[k]; k++)
    if (strcmp(states->choices[k], name) == 0)
      return k;
  return OUTCOME_INVALID;
}

struct answer ask_run_of_point(struct store *store, int64_t point_id, const struct engine_kind *kind,
                               const struct field *row, bool of_outcome, struct error *error) {
  char column[FIELD_TEXT_SIZE], table[FIELD_TEXT_SIZE] = "run";
  field_column_name(row->path, column, sizeof column);
  if (!of_outcome)
    snprintf(table, sizeof table, "result_%s", kind->name);
  const status code = ask_register_functions(store, error);
  if (code)
    return answer_failed(code, error);
  return answer_to(store, error,
                   "SELECT replicate, seed, identity, surplus, state, \"%w\".\"%w\", wall_time, cpu_time, peak_memory, "
                   "fields_path, withheld(%Q, warnings, %Q), warnings, %Q FROM run%s%w%s WHERE point_id = "
                   "%lld AND results_version = %d ORDER BY replicate, seed",
                   table, column, kind->name, column, kind->name, of_outcome ? "" : " LEFT JOIN \"",
                   of_outcome ? "" : table, of_outcome ? "" : "\" USING (run_id)", (long long)point_id,
                   kind->results_version);
}

bool ask_run_of_point_next(struct answer *answer, struct ask_run_of_point *run) {
  if (!answer_next(answer))
    return false;
  const struct query_value identity = answer_value(answer, 2);
  *run = (struct ask_run_of_point){
      .replicate = answer_integer(answer, 0),
      .seed = (uint64_t)answer_integer(answer, 1),
      .surplus = answer_integer(answer, 3) & 1,
      .excluded = answer_integer(answer, 3) > 1,
      .state = state_of(answer_text(answer, 4)),
      .value = answer_real(answer, 5),
      .withheld = answer_integer(answer, 10) != 0,
      .warnings = answer_text(answer, 11),
      .wall_s = answer_real(answer, 6),
      .cpu_s = answer_real(answer, 7),
      .peak_memory = answer_integer(answer, 8),
      .fields_path = answer_value(answer, 9).text,
  };
  run->fields_missing = run->fields_path && !paths_readable(answer->store->path, run->fields_path);
  if (identity.kind == QUERY_BLOB && identity.size == sizeof run->identity)
    memcpy(run->identity, identity.blob, sizeof run->identity);
  return true;
}

/* The number, or the share of the mass, of fragments heavier than a share of the body. */
static double heavier(const struct ask_specimens_quantity *quantity, size_t n, const void *masses) {
  double total = 0, number = 0, heavy = 0, mass;
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)masses + i * sizeof mass, sizeof mass);
    total += mass;
  }
  for (size_t i = 0; i < n; i++) {
    memcpy(&mass, (const char *)masses + i * sizeof mass, sizeof mass);
    if (mass > (1 + 1e-12) * quantity->share * total) { /* rounding of the sum must not make a fragment heavier */
      number++;
      heavy += mass;
    }
  }
  return quantity->kind == ASK_SPECIMENS_COUNT ? number : heavy / total;
}

struct answer ask_specimens(struct store *store, int64_t point_id, const struct engine_kind *kind,
                            const struct ask_specimens_quantity *quantity, struct error *error) {
  if (quantity->kind == ASK_SPECIMENS_RESULT)
    return ask_run_of_point(store, point_id, kind, quantity->row, quantity->of_outcome, error);
  if (quantity->kind == ASK_SPECIMENS_EXPONENT)
    return answer_to(store, error,
                     "SELECT seed, beta, warnings, %Q FROM run JOIN estimate USING (run_id) WHERE point_id = %lld AND "
                     "results_version = %d AND counts = 1 AND method = %Q AND \"window\" = %Q ORDER BY replicate",
                     kind->name, (long long)point_id, kind->results_version, exponent_method_names[quantity->method],
                     estimates_window_names[quantity->window]);
  return answer_to(
      store, error,
      "SELECT seed, masses, warnings, %Q FROM run JOIN fragment_mass USING (run_id) WHERE point_id = %lld AND "
      "results_version = %d AND counts = 1 ORDER BY replicate",
      kind->name, (long long)point_id, kind->results_version);
}

const char *ask_specimens_result(const struct ask_specimens_quantity *quantity) {
  if (quantity->kind == ASK_SPECIMENS_RESULT)
    return quantity->row->path;
  return quantity->kind == ASK_SPECIMENS_SHARE ? OUTCOME_DEFAULT : OUTCOME_NAME(mean_fragment_mass);
}

bool ask_specimens_next(struct answer *answer, const struct ask_specimens_quantity *quantity, uint64_t *seed,
                        double *value, struct ask_doubts *doubts) {
  const void *masses;
  size_t count;
  if (quantity->kind == ASK_SPECIMENS_RESULT) {
    struct ask_run_of_point run;
    while (ask_run_of_point_next(answer, &run)) {
      *seed = run.seed;
      *value = run.withheld ? (double)NAN : run.value;
      if (run.surplus || run.excluded || !outcome_is_usable(run.state))
        continue;
      (void)ask_doubts_run(doubts, answer_text(answer, 12), run.warnings, ask_specimens_result(quantity), 1);
      return true;
    }
    return false;
  }
  if (!answer_next(answer))
    return false;
  *seed = (uint64_t)answer_integer(answer, 0);
  const enum condition_mark mark = ask_doubts_run(doubts, answer_text(answer, 3), answer_text(answer, 2),
                                                  ask_specimens_result(quantity), 1);
  if (quantity->kind == ASK_SPECIMENS_EXPONENT)
    *value = answer_real(answer, 1);
  else if (!answer_masses(answer, 1, "a run", &masses, &count))
    return false;
  else
    *value = mark == CONDITION_WITHHELD ? (double)NAN : heavier(quantity, count, masses);
  return true;
}
