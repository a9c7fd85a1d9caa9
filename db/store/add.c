/* Adding rows of campaigns, of axes, of points with their inputs, and of attempts. */
#include <stdlib.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/shapes.h"
#include "db/store/views.h"

static const char adding_point[] = "adding a point";
static const char adding_campaign[] = "adding a campaign";

/* *campaign_id: 0 when the campaign is not stored yet. */
static status find_campaign(struct store *store, const char *name, const char *document_text, int64_t *campaign_id,
                            struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(store->db, "SELECT campaign_id FROM campaign WHERE name = ?1 AND document = ?2",
                              &statement, adding_campaign, error);
  if (result != STATUS_OK)
    return result;
  sql_bind_text(statement, 1, name);
  sql_bind_text(statement, 2, document_text);
  *campaign_id = sqlite3_step(statement) == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
  sqlite3_finalize(statement);
  return STATUS_OK;
}

static status find_or_add_campaign(struct store *store, const char *name, const char *document_text,
                                   const char *plan_json, int64_t *campaign_id, struct error *error) {
  status result = find_campaign(store, name, document_text, campaign_id, error);
  if (result != STATUS_OK || *campaign_id != 0)
    return result;
  sqlite3_stmt *statement = NULL;
  result = sql_prepare(store->db,
                       "INSERT INTO campaign (name, document, plan, added_at) VALUES (?1, ?2, ?3, "
                       "strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))",
                       &statement, adding_campaign, error);
  if (result != STATUS_OK)
    return result;
  sql_bind_text(statement, 1, name);
  sql_bind_text(statement, 2, document_text);
  sql_bind_text(statement, 3, plan_json);
  result = sql_run(statement, adding_campaign, error);
  *campaign_id = sqlite3_last_insert_rowid(store->db);
  sqlite3_finalize(statement);
  return result;
}

status store_add_campaign(struct store *store, const char *name, const char *document_text, const char *plan_json,
                          int64_t *campaign_id, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = find_or_add_campaign(store, name, document_text, plan_json, campaign_id, error);
  return store_end(store, result, 1, error);
}

static status add_inputs(struct store *store, int64_t point_id, const struct scene *scene, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  status result = sql_prepare_once(store->db, &store->point_input,
                                   "INSERT INTO point_input (point_id, path, value) VALUES (?1, ?2, ?3)", adding_point,
                                   error);
  for (size_t i = 0; result == STATUS_OK && i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    if (!field_is_active(inputs, row, scene->inputs))
      continue;
    sqlite3_bind_int64(store->point_input, 1, point_id);
    sql_bind_text(store->point_input, 2, row->path);
    sql_bind_field(store->point_input, 3, row, scene->inputs, true);
    result = sql_run(store->point_input, adding_point, error);
  }
  return result;
}

/* The digest of the rows of a point that is about to be stored. */
static void digest_point(const struct scene *scene, const uint8_t hash[16], const char *json, uint8_t digest[16]) {
  const struct field_table *inputs = scene->kind->inputs;
  const struct digest value = digest_name("point_input", "value");
  struct digest sum = {0};
  digest_add_bytes(&sum, digest_name("point", "hash"), hash, 16);
  digest_add_text(&sum, digest_name("point", "engine"), scene->kind->name);
  digest_add_text(&sum, digest_name("point", "scene_name"), scene->name);
  digest_add_text(&sum, digest_name("point", "scene"), json);
  for (size_t i = 0; i < inputs->count; i++)
    if (field_is_active(inputs, &inputs->rows[i], scene->inputs))
      digest_add_field(&sum, value, digest_row(inputs->rows[i].path), &inputs->rows[i], scene->inputs, true);
  digest_write(sum, digest);
}

static status find_or_add_point(struct store *store, const struct scene *scene, int64_t *point_id,
                                struct error *error) {
  status result = store_point_find(store, scene, point_id, error);
  if (result != STATUS_OK || *point_id != 0)
    return result;
  uint8_t hash[16];
  store_point_hash(scene, hash);
  result = sql_prepare_once(store->db, &store->point,
                            "INSERT INTO point (hash, engine, scene_name, scene, digest) VALUES (?1, ?2, ?3, ?4, ?5)",
                            adding_point, error);
  if (result != STATUS_OK)
    return result;
  char *json = scene_json(scene);
  if (!json)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_point);
  uint8_t digest[16];
  digest_point(scene, hash, json, digest);

  sqlite3_bind_blob(store->point, 1, hash, 16, SQLITE_STATIC);
  sql_bind_text(store->point, 2, scene->kind->name);
  sql_bind_text(store->point, 3, scene->name);
  sql_bind_text(store->point, 4, json);
  sqlite3_bind_blob(store->point, 5, digest, sizeof digest, SQLITE_STATIC);
  result = sql_run(store->point, adding_point, error);
  *point_id = sqlite3_last_insert_rowid(store->db);
  free(json);
  if (result == STATUS_OK)
    result = add_inputs(store, *point_id, scene, error);
  return result == STATUS_OK ? shapes_add(store, scene, error) : result;
}

/* *grown: the views need another column. */
static status add_axis(struct store *store, const struct field *row, bool *grown, struct error *error) {
  status result = sql_prepare_once(store->db, &store->axis_find, "SELECT 1 FROM axis WHERE path = ?1", adding_point,
                                   error);
  if (result != STATUS_OK)
    return result;
  sql_bind_text(store->axis_find, 1, row->path);
  bool known = sqlite3_step(store->axis_find) == SQLITE_ROW;
  sqlite3_reset(store->axis_find);
  if (known)
    return STATUS_OK;
  char name[SCHEMA_NAME_SIZE];
  result = views_axis_column(store->db, row->path, name, sizeof name, error);
  if (result != STATUS_OK)
    return result;
  *grown = true;
  return sql_executef(store->db, adding_point, error,
                      "INSERT INTO axis (path, column_name, unit, meaning) VALUES (%Q, %Q, %Q, %Q)", row->path, name,
                      row->unit, row->doc ? row->doc : "");
}

static status add_axis_with_unit(struct store *store, const struct field *row, const char *unit, struct error *error) {
  bool grown = false;
  status result = add_axis(store, row, &grown, error);
  if (result == STATUS_OK)
    result = sql_executef(store->db, adding_point, error,
                          "UPDATE axis SET written_unit = nullif(%Q, '') WHERE path = %Q", unit, row->path);
  return result == STATUS_OK && grown ? views_regenerate(store->db, error) : result;
}

status store_add_axis(struct store *store, const struct field *row, const char *unit, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  return store_end(store, add_axis_with_unit(store, row, unit, error), 1, error);
}

static status add_to_campaign(struct store *store, int64_t campaign_id, int64_t point_id, struct error *error) {
  status result = sql_prepare_once(store->db, &store->campaign_point,
                                   "INSERT OR IGNORE INTO campaign_point (campaign_id, point_id) VALUES (?1, ?2)",
                                   adding_point, error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_int64(store->campaign_point, 1, campaign_id);
  sqlite3_bind_int64(store->campaign_point, 2, point_id);
  return sql_run(store->campaign_point, adding_point, error);
}

static status add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                        const char *const *varied_paths, int64_t *point_id, struct error *error) {
  bool grown = false;
  struct store_kind *kind = NULL;
  status result = store_add_run_kind(store, scene->kind, &kind, &grown, error);
  if (result != STATUS_OK)
    return result;
  result = find_or_add_point(store, scene, point_id, error);
  if (result == STATUS_OK && campaign_id > 0)
    result = add_to_campaign(store, campaign_id, *point_id, error);
  for (size_t i = 0; result == STATUS_OK && i < varied_count; i++) {
    const struct field *row = field_find(scene->kind->inputs, varied_paths[i], error);
    result = row ? add_axis(store, row, &grown, error) : STATUS_CONTENT;
  }
  return result == STATUS_OK && grown ? views_regenerate(store->db, error) : result;
}

status store_add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                       const char *const *varied_paths, int64_t *point_id, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = add_point(store, campaign_id, scene, varied_count, varied_paths, point_id, error);
  return store_end(store, result, 1, error);
}

struct attempt_row {
  struct store_attempt attempt;
  double failed_at;
};
#define ATTEMPT(name_, kind_, member_)                                                                                 \
  { name_, SQL_COLUMN_##kind_, offsetof(struct attempt_row, member_) }
static const struct sql_column attempt_columns[] = {
    ATTEMPT("identity", IDENTITY, attempt.identity),
    ATTEMPT("point_id", INTEGER, attempt.point_id),
    ATTEMPT("replicate", INTEGER, attempt.replicate),
    ATTEMPT("seed", INTEGER, attempt.seed),
    ATTEMPT("session_id", KEY, attempt.session_id),
    ATTEMPT("number", INT, attempt.attempt),
    ATTEMPT("reason", TEXT, attempt.reason),
    ATTEMPT("exit_code", INT, attempt.exit_code),
    ATTEMPT("signal", INT, attempt.signal),
    ATTEMPT("wall_time", REAL, attempt.wall_s),
    ATTEMPT("peak_memory", INTEGER, attempt.peak_memory),
    ATTEMPT("limited_to", REAL, attempt.limit),
    ATTEMPT("message", TEXT, attempt.message),
    ATTEMPT("host", TEXT, attempt.host),
    ATTEMPT("rank", INT, attempt.rank),
    ATTEMPT("failed_at", REAL, failed_at),
};

static status add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error) {
  static const char doing[] = "adding an attempt";
  status result = sql_insert_prepare(store->db, &store->attempt, "attempt",
                                     sizeof attempt_columns / sizeof attempt_columns[0], attempt_columns, NULL, 1,
                                     doing, error);
  if (result != STATUS_OK)
    return result;
  struct identities_state *state = identities_add(&store->identities, attempt->identity);
  if (!state)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);

  struct attempt_row row = {.attempt = *attempt, .failed_at = store_wall_clock()};
  if (!attempt->reason)
    row.attempt.reason = "exit";
  if (!attempt->message)
    row.attempt.message = "";
  sql_insert_bind(&store->attempt, 0, &row, NULL);
  result = sql_run(store->attempt.statement, doing, error);
  if (result == STATUS_OK)
    state->attempts++;
  return result;
}

status store_add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  return store_end(store, add_attempt(store, attempt, error), 1, error);
}
