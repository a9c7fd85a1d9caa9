/* Inspects a file and upgrades an older store. */
#include "db/store/migrate.h"

#include <unistd.h>

#include "db/store/digest.h"
#include "db/store/guard.h"
#include "db/store/schema.h"
#include "db/store/sums.h"
#include "db/store/views.h"
#include "schemas/file.h"

/* The file's application id, version, how many tables, indexes and views it has, and whether its texts are UTF-8. */
struct header {
  int64_t application, version, things, utf8;
};

static status read_header(sqlite3 *db, struct header *header, struct error *error) {
  status result = sql_integer(db, "PRAGMA application_id", 0, &header->application, error);
  if (result != STATUS_OK)
    return result;
  result = sql_integer(db, "PRAGMA user_version", 0, &header->version, error);
  if (result != STATUS_OK)
    return result;
  result = sql_integer(db, "SELECT encoding = 'UTF-8' FROM pragma_encoding", 0, &header->utf8, error);
  if (result != STATUS_OK)
    return result;
  return sql_integer(db, "SELECT count(*) FROM sqlite_schema", 0, &header->things, error);
}

status migrate_inspect(sqlite3 *db, const char *path, int *version, struct error *error) {
  struct header header;
  status result = read_header(db, &header, error);
  if (result == STATUS_CONTENT && (sqlite3_errcode(db) & 0xff) == SQLITE_NOTADB)
    return status_fail(
        error, STATUS_CONTENT,
        "%s is no SQLite database, so it is no store of clast. Name another file; this file did not change.", path);
  if (result == STATUS_CONTENT) /* SQLite compares the file's length with the length in its header */
    return status_fail(error, STATUS_CONTENT,
                       "%s is damaged, perhaps cut short: %s. Restore a copy, or recover a part with `sqlite3 FILE "
                       ".recover`.",
                       path, sqlite3_errmsg(db));
  if (result != STATUS_OK)
    return result;
  if (header.application == 0 && header.version == 0 && header.things == 0) {
    *version = -1;
    return STATUS_OK;
  }
  if (header.application != SCHEMA_APPLICATION_ID)
    return status_fail(error, STATUS_CONTENT,
                       "%s is a database of another program (application id 0x%08llx), not a store of clast. Name "
                       "another file; this file did not change.",
                       path, (unsigned long long)header.application);
  if (header.version > SCHEMA_VERSION || header.version < 0)
    return status_fail(error, STATUS_CONTENT,
                       "%s was written by a newer clast (store version %lld; this program knows up to %d). Use that "
                       "newer program; the file did not change.",
                       path, (long long)header.version, SCHEMA_VERSION);
  if (!header.utf8)
    return status_fail(
        error, STATUS_CONTENT,
        "%s keeps its texts in UTF-16, but stores of clast are in UTF-8: another program made or changed "
        "this file. It did not change now.",
        path);
  *version = (int)header.version;
  return guard_schema(db, path, *version, error);
}

/* Version 0 had no running sums and no table of bin edges. */
static status to_version_1(sqlite3 *db, struct error *error) {
  status result = sums_cover_all_bins(db, error);
  return result == STATUS_OK ? sums_rebuild(db, 0, error) : result;
}

/* Earlier programs made a table of the fragments' motion, which no command could fill. An empty one is dropped; rows,
 * if any, are left alone. */
static status drop_empty_motion(sqlite3 *db, struct error *error) {
  int64_t there = 0, filled = 0;
  status result = sql_integer(db, "SELECT count(*) FROM sqlite_schema WHERE name = 'fragment_motion'", 0, &there,
                              error);
  if (result != STATUS_OK || !there)
    return result;
  result = sql_integer(db, "SELECT EXISTS (SELECT 1 FROM fragment_motion)", 0, &filled, error);
  if (result != STATUS_OK || filled)
    return result;
  return sql_execute(db, "DROP TABLE fragment_motion; DELETE FROM column_doc WHERE table_name = 'fragment_motion'",
                     "bringing the store forward", error);
}

/* Version 1 had no digests. New digests protect the rows from now on; they cannot show earlier damage. */
static status to_version_2(sqlite3 *db, struct error *error) {
  status result = digest_rows_fill_missing(db, DIGEST_RUNS, 0, error);
  return result == STATUS_OK ? digest_rows_fill_missing(db, DIGEST_POINTS, 0, error) : result;
}

/* Version 2 did not say which campaign a session computed. */
static status to_version_3(sqlite3 *db, struct error *error) {
  return sql_execute(db, schema_sessions_sql, "bringing the store forward", error);
}

static status (*const steps[SCHEMA_VERSION])(sqlite3 *, struct error *) = {to_version_1, to_version_2, to_version_3};

static status back_up(sqlite3 *db, const char *path, int version, struct error *error) {
  static const char doing[] = "keeping a copy before bringing the store forward";
  struct file_output file;
  char *copy = NULL;
  for (int i = 0; i < 100; i++) { /* an earlier attempt may have left a copy */
    sqlite3_free(copy);
    copy = i ? sqlite3_mprintf("%s.version%d.%d", path, version, i) : sqlite3_mprintf("%s.version%d", path, version);
    if (!copy)
      return status_fail(error, STATUS_MEMORY, "%s: memory ran out", path);
    if (access(copy, F_OK) != 0)
      break;
  }
  status result = file_begin(&file, copy, "copy of the store", error);
  if (result == STATUS_OK)
    result = file_end(&file, guard_vacuum_into(db, file.temporary, doing, error), error);
  sqlite3_free(copy);
  return result;
}

/* Within a transaction. version: -1 for a new file. */
static status bring_forward(sqlite3 *db, int version, struct error *error) {
  status result = schema_complete_all(db, error);
  for (int i = version; version >= 0 && result == STATUS_OK && i < SCHEMA_VERSION; i++)
    result = steps[i](db, error);
  if (result != STATUS_OK)
    return result;
  result = drop_empty_motion(db, error);
  if (result != STATUS_OK)
    return result;
  result = views_regenerate(db, error);
  if (result != STATUS_OK)
    return result;
  return sql_executef(db, "opening for writing", error, "PRAGMA application_id = %d; PRAGMA user_version = %d; COMMIT",
                      SCHEMA_APPLICATION_ID, SCHEMA_VERSION);
}

status migrate_bring_forward(sqlite3 *db, const char *path, int version, struct error *error) {
  status result = version >= 0 && version < SCHEMA_VERSION ? back_up(db, path, version, error) : STATUS_OK;
  if (result != STATUS_OK)
    return result;
  result = sql_execute(db, "BEGIN IMMEDIATE", "opening for writing", error);
  if (result != STATUS_OK)
    return result;
  result = bring_forward(db, version, error);
  if (result != STATUS_OK)
    sqlite3_exec(db, "ROLLBACK", NULL, NULL, NULL);
  return result;
}
