/* The compact copy of a store for hand-over, and the digests that two stores of one campaign share. */
#include <stdlib.h>
#include <unistd.h>

#include "db/store/guard.h"
#include "db/store/internal.h"
#include "db/store/paths.h"
#include "db/store/place.h"
#include "schemas/file.h"

/* Fields files are not moved: the paths in the copy are made relative to the copy's folder. */
static status keep_paths(const struct store *store, const char *copy, struct error *error) {
  sqlite3 *db = NULL;
  char *way = paths_between(copy, store->path);
  if (!way)
    return status_fail(error, STATUS_IO, "%s: the path of its folder cannot be resolved", copy);
  status result = STATUS_OK;
  int code = *way ? sqlite3_open_v2(copy, &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_EXRESCODE, NULL) : SQLITE_OK;
  if (code != SQLITE_OK)
    result = sql_fail(db, code, "writing the hand-over file", error);
  else if (db) {
    guard_connection(db);
    result = sql_executef(db, "writing the hand-over file", error,
                          "UPDATE run SET fields_path = %Q || fields_path WHERE fields_path NOT LIKE '/%%'", way);
  }
  sqlite3_close(db);
  free(way);
  return result;
}

status store_export(struct store *store, const char *path, struct error *error) {
  struct file_output file;
  if (place_refused(path))
    return status_fail(error, STATUS_USAGE, "%s: %s", path, place_refused(path));
  if (access(path, F_OK) == 0)
    return status_fail(error, STATUS_IO, "%s exists already: name another file, or remove it first.", path);
  TRY(store_flush(store, error));
  TRY(file_begin(&file, path, "copy of the store", error));
  /* query_only refuses VACUUM INTO, although VACUUM INTO writes another file. */
  sqlite3_exec(store->db, "PRAGMA query_only = OFF", NULL, NULL, NULL);
  status result = guard_vacuum_into(store->db, file.temporary, "writing the hand-over file", error);
  if (!store->writer)
    sqlite3_exec(store->db, "PRAGMA query_only = ON", NULL, NULL, NULL);
  if (result == STATUS_OK)
    result = keep_paths(store, file.temporary, error);
  return file_end(&file, result, error);
}

status store_export_digests(struct store *store, FILE *out, struct error *error) {
  TRY(digest_rows_print(store->db, DIGEST_POINTS, out, error));
  return digest_rows_print(store->db, DIGEST_RUNS, out, error);
}
