/* Adding rows: campaigns, points, runs, attempts. Nothing is made into text or JSON per run, and every statement is
 * prepared once. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"

static const char adding_run[] = "adding a run", adding_point[] = "adding a point";

static double wall_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void bind_text(sqlite3_stmt *statement, int index, const char *text) {
  if (text)
    sqlite3_bind_text(statement, index, text, -1, SQLITE_STATIC);
  else
    sqlite3_bind_null(statement, index);
}

/* INSERT of `fixed` columns followed by a field table's columns. */
static status prepare_insert(struct store *store, sqlite3_stmt **statement, const char *table, const char *fixed,
                             const struct field_table *fields, const char *doing, struct error *error) {
  if (*statement)
    return STATUS_OK;
  char *sql = NULL;
  size_t size = 0, columns = 1;
  FILE *out = open_memstream(&sql, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  for (const char *c = fixed; *c; c++)
    columns += *c == ',';
  fprintf(out, "INSERT INTO %s (%s", table, fixed);
  for (size_t i = 0; fields && i < fields->count; i++, columns++) {
    char name[SCHEMA_NAME_SIZE];
    field_column_name(fields->rows[i].path, name, sizeof name);
    fprintf(out, ", \"%s\"", name);
  }
  for (size_t i = 0; i < columns; i++)
    fputs(i ? ", ?" : ") VALUES (?", out);
  fputs(")", out);
  fclose(out);
  status result = sql ? sql_prepare(store->db, sql, statement, doing, error)
                      : status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  free(sql);
  return result;
}

static void bind_fields(sqlite3_stmt *statement, int index, const struct field_table *fields, const void *object) {
  for (size_t i = 0; i < fields->count; i++, index++) {
    const struct field *row = &fields->rows[i];
    if (row->when && !field_is_active(fields, row, object))
      sqlite3_bind_null(statement, index);
    else
      sql_bind_field(statement, index, row, object, false);
  }
}

status store_add_campaign(struct store *store, const char *name, const char *document_text, const char *plan_json,
                          int64_t *campaign_id, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = sql_prepare(store->db, "SELECT campaign_id FROM campaign WHERE name = ?1 AND document = ?2", &statement,
                       "adding a campaign", error);
  if (result == STATUS_OK) {
    bind_text(statement, 1, name);
    bind_text(statement, 2, document_text);
    *campaign_id = sqlite3_step(statement) == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
    sqlite3_finalize(statement);
    statement = NULL;
  }
  if (result == STATUS_OK && *campaign_id == 0) {
    result = sql_prepare(store->db,
                         "INSERT INTO campaign (name, document, plan, added_at) VALUES (?1, ?2, ?3, "
                         "strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))",
                         &statement, "adding a campaign", error);
    if (result == STATUS_OK) {
      bind_text(statement, 1, name);
      bind_text(statement, 2, document_text);
      bind_text(statement, 3, plan_json);
      result = sql_run(statement, "adding a campaign", error);
      *campaign_id = sqlite3_last_insert_rowid(store->db);
    }
    sqlite3_finalize(statement);
  }
  return store_end(store, result, 1, error);
}

/* A point's hash is a run's identity without seed and results_version: a point outlives a change of result bits. */
static void point_hash(const struct scene *scene, uint8_t hash[16]) {
  struct engine_kind kind = *scene->kind;
  struct scene unversioned = *scene;
  kind.results_version = 0;
  unversioned.kind = &kind;
  scene_identity(&unversioned, 0, hash);
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
    bind_text(store->point_input, 2, row->path);
    sql_bind_field(store->point_input, 3, row, scene->inputs, true);
    result = sql_run(store->point_input, adding_point, error);
  }
  return result;
}

static status find_or_add_point(struct store *store, const struct scene *scene, int64_t *point_id,
                                struct error *error) {
  uint8_t hash[16];
  char *json = NULL;
  point_hash(scene, hash);
  status result = sql_prepare_once(store->db, &store->point_find, "SELECT point_id FROM point WHERE hash = ?1",
                                   adding_point, error);
  if (result == STATUS_OK)
    result = sql_prepare_once(store->db, &store->point,
                              "INSERT INTO point (hash, engine, scene_name, scene) VALUES (?1, ?2, ?3, ?4)",
                              adding_point, error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_blob(store->point_find, 1, hash, 16, SQLITE_STATIC);
  int code = sqlite3_step(store->point_find);
  *point_id = code == SQLITE_ROW ? sqlite3_column_int64(store->point_find, 0) : 0;
  sqlite3_reset(store->point_find);
  if (code == SQLITE_ROW)
    return STATUS_OK;
  if (code != SQLITE_DONE)
    return sql_fail(store->db, code, adding_point, error);
  if (!(json = scene_json(scene)))
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_point);
  sqlite3_bind_blob(store->point, 1, hash, 16, SQLITE_STATIC);
  bind_text(store->point, 2, scene->kind->name);
  bind_text(store->point, 3, scene->name);
  bind_text(store->point, 4, json);
  result = sql_run(store->point, adding_point, error);
  *point_id = sqlite3_last_insert_rowid(store->db);
  free(json);
  return result == STATUS_OK ? add_inputs(store, *point_id, scene, error) : result;
}

/* *grown: the views need another column. */
static status add_axis(struct store *store, const struct scene *scene, const char *path, bool *grown,
                       struct error *error) {
  status result = sql_prepare_once(store->db, &store->axis_find, "SELECT 1 FROM axis WHERE path = ?1", adding_point,
                                   error);
  if (result != STATUS_OK)
    return result;
  const struct field *row = field_find(scene->kind->inputs, path, error);
  if (!row)
    return STATUS_CONTENT;
  bind_text(store->axis_find, 1, row->path);
  bool known = sqlite3_step(store->axis_find) == SQLITE_ROW;
  sqlite3_reset(store->axis_find);
  if (known)
    return STATUS_OK;
  char name[SCHEMA_NAME_SIZE];
  result = views_axis_column(store->db, row->path, name, sizeof name, error);
  if (result == STATUS_OK)
    result = sql_executef(store->db, adding_point, error,
                          "INSERT INTO axis (path, column_name, unit, meaning) VALUES (%Q, %Q, %Q, %Q)", row->path,
                          name, row->unit, row->doc ? row->doc : "");
  *grown = true;
  return result;
}

/* The engine's statement, its result table made when this store has met no such engine yet. */
static status find_kind(struct store *store, const struct engine_kind *kind, struct store_kind **found, bool *grown,
                        struct error *error) {
  for (size_t i = 0; i < store->kind_count; i++)
    if (store->kinds[i].kind == kind) {
      *found = &store->kinds[i];
      return STATUS_OK;
    }
  if (store->kind_count == STORE_KINDS)
    return status_fail(error, STATUS_INTERNAL, "more than %d engines in one store", STORE_KINDS);
  struct schema_table table = schema_result_table(kind);
  struct store_kind *entry = &store->kinds[store->kind_count];
  int64_t before = 0, after = 0;
  status result = sql_integer(store->db, "PRAGMA schema_version", 0, &before, error);
  if (result == STATUS_OK)
    result = schema_complete(store->db, &table, error);
  if (result == STATUS_OK)
    result = sql_integer(store->db, "PRAGMA schema_version", 0, &after, error);
  if (result == STATUS_OK)
    result = prepare_insert(store, &entry->insert, table.name, "run_id", kind->results, adding_run, error);
  if (result != STATUS_OK)
    return result;
  *grown = *grown || before != after;
  entry->kind = kind;
  store->kind_count++;
  *found = entry;
  return STATUS_OK;
}

status store_add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                       const char *const *varied_paths, int64_t *point_id, struct error *error) {
  bool grown = false;
  struct store_kind *kind = NULL;
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = find_kind(store, scene->kind, &kind, &grown, error);
  if (result == STATUS_OK)
    result = find_or_add_point(store, scene, point_id, error);
  if (result == STATUS_OK && campaign_id > 0) {
    result = sql_prepare_once(store->db, &store->campaign_point,
                              "INSERT OR IGNORE INTO campaign_point (campaign_id, point_id) VALUES (?1, ?2)",
                              adding_point, error);
    if (result == STATUS_OK) {
      sqlite3_bind_int64(store->campaign_point, 1, campaign_id);
      sqlite3_bind_int64(store->campaign_point, 2, *point_id);
      result = sql_run(store->campaign_point, adding_point, error);
    }
  }
  for (size_t i = 0; result == STATUS_OK && i < varied_count; i++)
    result = add_axis(store, scene, varied_paths[i], &grown, error);
  if (result == STATUS_OK && grown)
    result = views_regenerate(store->db, error);
  return store_end(store, result, 1, error);
}

static status add_row(struct store *store, const struct store_run *run, int64_t *run_id, struct error *error) {
  status result =
      prepare_insert(store, &store->run, "run",
                     "point_id, session_id, identity, replicate, seed, results_version, surplus, counts, attempt, "
                     "wall_time, cpu_time, peak_memory, host, rank, finished_at, fields_path",
                     &outcome_table, adding_run, error);
  if (result != STATUS_OK)
    return result;
  sqlite3_stmt *statement = store->run;
  sqlite3_bind_int64(statement, 1, run->point_id);
  if (run->session_id > 0)
    sqlite3_bind_int64(statement, 2, run->session_id);
  else
    sqlite3_bind_null(statement, 2);
  sqlite3_bind_blob(statement, 3, run->identity, 16, SQLITE_STATIC);
  sqlite3_bind_int64(statement, 4, run->replicate);
  sqlite3_bind_int64(statement, 5, (int64_t)run->seed);
  sqlite3_bind_int(statement, 6, run->kind->results_version);
  sqlite3_bind_int(statement, 7, run->surplus);
  sqlite3_bind_int(statement, 8, store_run_counts(run));
  sqlite3_bind_int(statement, 9, run->attempt);
  sqlite3_bind_double(statement, 10, run->wall_s);
  sqlite3_bind_double(statement, 11, run->cpu_s);
  sqlite3_bind_int64(statement, 12, run->peak_memory);
  bind_text(statement, 13, run->host);
  sqlite3_bind_int(statement, 14, run->rank);
  sqlite3_bind_double(statement, 15, wall_clock());
  bind_text(statement, 16, run->fields_path);
  bind_fields(statement, 17, &outcome_table, run->outcome);
  result = sql_run(statement, adding_run, error);
  *run_id = sqlite3_last_insert_rowid(store->db);
  return result;
}

status store_add_run(struct store *store, const struct store_run *run, struct error *error) {
  if (store_has_run(store, run->identity))
    return STATUS_OK;
  bool grown = false;
  int64_t run_id = 0;
  struct store_kind *kind = NULL;
  struct identities_entry *entry = NULL;
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = find_kind(store, run->kind, &kind, &grown, error);
  if (result == STATUS_OK && grown)
    result = views_regenerate(store->db, error);
  if (result == STATUS_OK)
    result = add_row(store, run, &run_id, error);
  if (result == STATUS_OK && run->result) {
    sqlite3_bind_int64(kind->insert, 1, run_id);
    bind_fields(kind->insert, 2, run->kind->results, run->result);
    result = sql_run(kind->insert, adding_run, error);
  }
  if (result == STATUS_OK)
    result = store_fragments_add(store, run_id, run, error);
  if (result == STATUS_OK && run->estimate_count)
    result = store_set_estimates_rows(store, run_id, run->estimate_count, run->estimates, error);
  if (result == STATUS_OK && !(entry = identities_add(&store->identities, run->identity)))
    result = status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
  if (result == STATUS_OK) {
    entry->stored = true;
    memcpy(store->batch_identities[store->batch_identity_count++], run->identity, 16);
  }
  return store_end(store, result, 1, error);
}

status store_add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error) {
  static const char doing[] = "adding an attempt";
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result =
      prepare_insert(store, &store->attempt, "attempt",
                     "identity, point_id, replicate, seed, session_id, number, reason, exit_code, signal, wall_time, "
                     "peak_memory, limited_to, message, host, rank, failed_at",
                     NULL, doing, error);
  struct identities_entry *entry = NULL;
  if (result == STATUS_OK && !(entry = identities_add(&store->identities, attempt->identity)))
    result = status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  if (result == STATUS_OK) {
    sqlite3_stmt *statement = store->attempt;
    sqlite3_bind_blob(statement, 1, attempt->identity, 16, SQLITE_STATIC);
    sqlite3_bind_int64(statement, 2, attempt->point_id);
    sqlite3_bind_int64(statement, 3, attempt->replicate);
    sqlite3_bind_int64(statement, 4, (int64_t)attempt->seed);
    if (attempt->session_id > 0)
      sqlite3_bind_int64(statement, 5, attempt->session_id);
    else
      sqlite3_bind_null(statement, 5);
    sqlite3_bind_int(statement, 6, attempt->attempt);
    bind_text(statement, 7, attempt->reason ? attempt->reason : "exit");
    sqlite3_bind_int(statement, 8, attempt->exit_code);
    sqlite3_bind_int(statement, 9, attempt->signal);
    sqlite3_bind_double(statement, 10, attempt->wall_s);
    sqlite3_bind_int64(statement, 11, attempt->peak_memory);
    sqlite3_bind_double(statement, 12, attempt->limit);
    bind_text(statement, 13, attempt->message ? attempt->message : "");
    bind_text(statement, 14, attempt->host);
    sqlite3_bind_int(statement, 15, attempt->rank);
    sqlite3_bind_double(statement, 16, wall_clock());
    result = sql_run(statement, doing, error);
    if (result == STATUS_OK)
      entry->attempts++;
  }
  return store_end(store, result, 1, error);
}
