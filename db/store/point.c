/* Finds a point by its scene, and reads its runs, for a driver that resumes and for stopping rules. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/paths.h"
#include "db/store/schema.h"

/* A point's hash is a run's identity without seed and results_version: a point stays the same when results_version
 * changes. */
void store_point_hash(const struct scene *scene, uint8_t hash[16]) {
  struct engine_kind kind = *scene->kind;
  struct scene unversioned = *scene;
  kind.results_version = 0;
  unversioned.kind = &kind;
  scene_identity(&unversioned, 0, hash);
}

status store_point_find(struct store *store, const struct scene *scene, int64_t *point_id, struct error *error) {
  static const char doing[] = "looking for a point";
  uint8_t hash[16];
  status result = sql_prepare_once(store->db, &store->point_find, "SELECT point_id FROM point WHERE hash = ?1", doing,
                                   error);
  if (result != STATUS_OK)
    return result;
  store_point_hash(scene, hash);
  sqlite3_bind_blob(store->point_find, 1, hash, 16, SQLITE_STATIC);
  int code = sqlite3_step(store->point_find);
  *point_id = code == SQLITE_ROW ? sqlite3_column_int64(store->point_find, 0) : 0;
  sqlite3_reset(store->point_find);
  return code == SQLITE_ROW || code == SQLITE_DONE ? STATUS_OK : sql_fail(store->db, code, doing, error);
}

static int state_of(const struct field *states, const char *name) {
  for (int k = 0; name && states->choices[k]; k++)
    if (strcmp(states->choices[k], name) == 0)
      return k;
  return OUTCOME_INVALID;
}

/* The row of a run as the query of store_point_runs() gives it. */
static struct store_point_run read_run(const struct store *store, const struct field *states, sqlite3_stmt *statement) {
  struct store_point_run run = {
      .replicate = sqlite3_column_int64(statement, 0),
      .seed = (uint64_t)sqlite3_column_int64(statement, 9),
      .surplus = sqlite3_column_int(statement, 2) != 0,
      .state = state_of(states, (const char *)sqlite3_column_text(statement, 3)),
      .value = sqlite3_column_type(statement, 4) == SQLITE_NULL ? (double)NAN : sqlite3_column_double(statement, 4),
      .wall_s = sqlite3_column_double(statement, 5),
      .cpu_s = sqlite3_column_double(statement, 6),
      .peak_memory = sqlite3_column_int64(statement, 7),
      .fields_path = (const char *)sqlite3_column_text(statement, 8),
  };
  run.fields_missing = run.fields_path && !paths_readable(store->path, run.fields_path);
  if (sqlite3_column_bytes(statement, 1) == 16)
    memcpy(run.identity, sqlite3_column_blob(statement, 1), 16);
  return run;
}

status store_point_runs(struct store *store, int64_t point_id, const struct engine_kind *kind, const struct field *row,
                        bool of_outcome, void (*each)(void *context, const struct store_point_run *run), void *context,
                        struct error *error) {
  static const char doing[] = "reading a point's runs";
  char column[SCHEMA_NAME_SIZE];
  sqlite3_stmt *statement = NULL;
  field_column_name(row->path, column, sizeof column);
  status result =
      sql_preparef(store->db, &statement, doing, error,
                   "SELECT r.replicate, r.identity, r.surplus, r.state, %s.\"%w\", r.wall_time, r.cpu_time, "
                   "r.peak_memory, r.fields_path, r.seed FROM run r %s%w%s WHERE r.point_id = ?1 AND r.results_version "
                   "= ?2 ORDER BY r.replicate, r.seed",
                   of_outcome ? "r" : "e", column, of_outcome ? "" : "LEFT JOIN result_", of_outcome ? "" : kind->name,
                   of_outcome ? "" : " e ON e.run_id = r.run_id");
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_int64(statement, 1, point_id);
  sqlite3_bind_int(statement, 2, kind->results_version);
  const struct field *states = field_find(&outcome_table, "state", NULL);
  while (sql_next(statement, &result, doing, error)) {
    const struct store_point_run run = read_run(store, states, statement);
    each(context, &run);
  }
  sqlite3_finalize(statement);
  return result;
}
