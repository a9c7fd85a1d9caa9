/* Finds a point by its scene, and its shape files. */
#include <string.h>

#include "db/store/internal.h"
#include "engine/scene.h"

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

static status load(const char *hash, const void *bytes, size_t size, struct error *error) {
  const struct mesh_file *file = NULL;
  char name[128];
  snprintf(name, sizeof name, "shape file %.12s of the store", hash);
  const status code = mesh_files_add(name, bytes, size, &file, error);
  if (code)
    return code;
  return strcmp(file->hash, hash) == 0
             ? STATUS_OK
             : status_fail(error, STATUS_CONTENT, "%s: its bytes have changed since it was stored; restore a copy",
                           name);
}

status store_point_shapes(struct store *store, int64_t run_id, struct error *error) {
  static const char doing[] = "reading shape files";
  STATEMENT files = NULL;
  TRY(sql_prepare(store->db,
                  "SELECT hash, bytes FROM shape_file WHERE ?1 = 0 OR hash IN (SELECT value FROM point_input JOIN "
                  "run USING (point_id) WHERE run_id = ?1)",
                  &files, doing, error));
  status result = STATUS_OK;
  sqlite3_bind_int64(files, 1, run_id);
  while (sql_next(files, &result, doing, error)) {
    const void *bytes = sqlite3_column_blob(files, 1);
    result = load(sql_text(files, 0), bytes ? bytes : "", (size_t)sqlite3_column_bytes(files, 1), error);
  }
  return result;
}
