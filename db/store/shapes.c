/* Stores each shape file once. */
#include "db/store/shapes.h"

#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "engine/scene.h"

status shapes_add(struct store *store, const struct scene *scene, struct error *error) {
  static const char doing[] = "adding a shape file";
  const struct mesh_file *files[SCENE_FILES_MOST];
  const size_t count = scene_files_of(scene->kind->inputs, scene->inputs, files);
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < count; i++) {
    sqlite3_stmt *statement = NULL;
    result = sql_prepare(store->db, "INSERT OR IGNORE INTO shape_file (hash, bytes) VALUES (?1, ?2)", &statement, doing,
                         error);
    if (result == STATUS_OK) {
      sql_bind_text(statement, 1, files[i]->hash);
      sqlite3_bind_blob(statement, 2, files[i]->bytes, (int)files[i]->size, SQLITE_STATIC);
      result = sql_run(statement, doing, error);
    }
    sqlite3_finalize(statement);
  }
  return result;
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

status shapes_load(struct store *store, int64_t run_id, struct error *error) {
  static const char doing[] = "reading shape files";
  bool has = false;
  status result = schema_has_column(store->db, "shape_file", "hash", &has, error);
  if (result != STATUS_OK || !has) /* a store of an earlier program */
    return result;
  sqlite3_stmt *files = NULL;
  result = sql_prepare(store->db,
                       "SELECT hash, bytes FROM shape_file WHERE ?1 = 0 OR hash IN (SELECT value FROM point_input JOIN "
                       "run USING (point_id) WHERE run_id = ?1)",
                       &files, doing, error);
  if (result == STATUS_OK)
    sqlite3_bind_int64(files, 1, run_id);
  while (sql_next(files, &result, doing, error)) {
    const void *bytes = sqlite3_column_blob(files, 1);
    result = load(sql_text(files, 0), bytes ? bytes : "", (size_t)sqlite3_column_bytes(files, 1), error);
    if (result != STATUS_OK)
      break;
  }
  sqlite3_finalize(files);
  return result;
}

status shapes_merge(sqlite3 *db, struct error *error) {
  static const char doing[] = "merging shape files";
  int64_t there = 0;
  status result = sql_integer(db, "SELECT count(*) FROM pragma_table_info('shape_file', 'other')", 0, &there, error);
  if (result != STATUS_OK || !there)
    return result;
  return sql_execute(db, "INSERT OR IGNORE INTO main.shape_file (hash, bytes) SELECT hash, bytes FROM other.shape_file",
                     doing, error);
}
