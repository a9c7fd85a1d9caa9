/* Opening, closing, batches and sessions of a store. */
#include "db/store/store.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "db/store/guard.h"
#include "db/store/internal.h"
#include "db/store/lock.h"
#include "db/store/migrate.h"
#include "db/store/place.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "schemas/clock.h"
#include "schemas/file.h"

static const char lacks_wal_text[] =
    "has no -wal file, or an empty one. If it is a copy, it was copied while it was being written, and its last runs "
    "are missing: copy both files, or make a copy with `clast export`. If clast was killed here when it had just "
    "begun, nothing is missing. `clast run`, or `clast merge` into this store, goes on with what is there.";

enum { EMPTY_STORE = 4096 }; /* bytes: SQLite's first page, without any table */

static struct store *allocate(const char *path) {
  struct store *store = calloc(1, sizeof *store);
  if (!store)
    return NULL;
  store->lock = -1;
  store->lowest_bin = 1;
  store->path = strdup(path);
  if (store->path)
    return store;
  free(store);
  return NULL;
}

static void release(struct store *store) {
  sqlite3_stmt *const statements[] = {
      store->run.statement, store->attempt.statement, store->estimate.statement, store->masses,
      store->spectrum,      store->spectrum_together, store->point_find,         store->point,
      store->point_input,   store->campaign_point,    store->axis_find,
  };
  for (size_t i = 0; i < sizeof statements / sizeof statements[0]; i++)
    sqlite3_finalize(statements[i]);
  for (size_t i = 0; i < STORE_KINDS; i++) {
    sqlite3_finalize(store->kinds[i].insert.statement);
    digest_names_clear(&store->kinds[i].names);
  }
  digest_names_clear(&store->outcome_names);
  digest_names_clear(&store->estimate_names);
  sums_clear(&store->sums);
  identities_clear(&store->identities);
  assert(!store->db || !sqlite3_next_stmt(store->db, NULL)); /* every statement and answer was ended */
  sqlite3_close(store->db);
  if (store->lock >= 0)
    close(store->lock); /* after SQLite has closed the file (db/store/lock.h) */
  free(store->blob);
  free(store->bins);
  free(store->path);
  free(store);
}

static status open_database(struct store *store, int flags, struct error *error) {
  int code = sqlite3_open_v2(store->path, &store->db,
                             flags | SQLITE_OPEN_URI | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_NOMUTEX, NULL);
  if (code != SQLITE_OK)
    return sql_fail(store->db, code, "opening", error);
  sqlite3_busy_timeout(store->db, 10000);
  guard_connection(store->db);
  return sql_execute(store->db, "PRAGMA cell_size_check = ON", "opening", error);
}

/* Refuses the store. The message names the lock's holder if its row is already written. */
static status refuse_held(const char *path, struct error *error) {
  struct store *store = NULL;
  sqlite3_stmt *statement = NULL;
  char holder[512] = "";
  if (store_open_reader(path, &store, NULL) == STATUS_OK &&
      sqlite3_prepare_v2(store->db, "SELECT host, pid, since FROM holder", -1, &statement, NULL) == SQLITE_OK &&
      sqlite3_step(statement) == SQLITE_ROW)
    snprintf(holder, sizeof holder, " on host %s, process %lld, since %s", sqlite3_column_text(statement, 0),
             (long long)sqlite3_column_int64(statement, 1), sqlite3_column_text(statement, 2));
  sqlite3_finalize(statement);
  store_close(store, NULL);
  return status_fail(
      error, STATUS_IO,
      "%s: the store is being written by another clast%s. Wait until it ends, or stop it; or name another store.", path,
      holder);
}

bool store_is_being_written(const char *path) {
  return lock_is_held(path);
}

static status write_holder(struct store *store, struct error *error) {
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  return sql_executef(store->db, "writing who holds the store", error,
                      "INSERT OR REPLACE INTO holder VALUES (1, %Q, %lld, strftime('%%Y-%%m-%%dT%%H:%%M:%%SZ', 'now'))",
                      host, (long long)getpid());
}

/* A copy of a store that was being written contains its writer's row in table holder. Stores that an older clast began
 * have no tables at first. */
static bool is_partial_copy(const struct store *store, int version) {
  int64_t holders = 0;
  if (!store->lacks_wal || version < 0)
    return store->lacks_wal;
  /* a journal that was rolled back has taken the file out of WAL mode */
  return sql_integer(store->db, "SELECT count(*) FROM holder, pragma_journal_mode WHERE journal_mode = 'wal'", 0,
                     &holders, NULL) == STATUS_OK &&
         holders > 0;
}

/* The tables and the holder are written before WAL mode: until then, the file of a killed program does not look like a
 * copy without its -wal file, and afterwards every copy shows its holder. */
static status prepare_file(struct store *store, int version, struct error *error) {
  status result = migrate_bring_forward(store->db, store->path, version, error);
  return result == STATUS_OK ? write_holder(store, error) : result;
}

/* With the file locked: opens it, upgrades it and reads the data that a writer needs. */
static status open_locked(struct store *store, struct error *error) {
  int version = -1;
  status result = open_database(store, SQLITE_OPEN_READWRITE, error);
  if (result != STATUS_OK)
    return result;
  result = migrate_inspect(store->db, store->path, &version, error);
  if (result != STATUS_OK)
    return result;
  store->lacks_wal = is_partial_copy(store, version);
  result = sql_execute(store->db,
                       "PRAGMA synchronous = FULL; PRAGMA foreign_keys = OFF; PRAGMA temp_store = MEMORY; "
                       "PRAGMA cache_size = -32768; PRAGMA wal_autocheckpoint = 4000",
                       "opening for writing", error);
  if (result == STATUS_OK)
    result = prepare_file(store, version, error);
  if (result == STATUS_OK)
    result = sql_execute(store->db, "PRAGMA journal_mode = WAL", "opening for writing", error);
  if (result == STATUS_OK)
    result = write_holder(store, error); /* the first page of the -wal file */
  return result == STATUS_OK ? identities_load(store, error) : result;
}

/* Undoes a failed call that made no table: leaves no file or an empty one, as before. `before`: bytes of the
 * file, -1 if there was none. */
static void leave_empty(const char *path, off_t before) {
  struct stat file;
  if (before > 0 || stat(path, &file) != 0 || file.st_size > EMPTY_STORE)
    return;
  if (before < 0 || truncate(path, 0) != 0)
    unlink(path);
}

/* Writes a warning about a store that could be opened; "" if there is none. */
static void write_warning(const struct store *store, char *warning, size_t size) {
  const char *network = lock_network_file_system(store->lock);
  if (size == 0)
    return;
  if (store->lacks_wal)
    snprintf(warning, size, "warning: %s %s", store->path, lacks_wal_text);
  else if (network)
    snprintf(warning, size,
             "warning: %s is on a network file system (%s), where locks and shared memory may fail and damage a store: "
             "write to a local disk and copy the file when it is done.",
             store->path, network);
  else
    warning[0] = '\0';
}

status store_open_writer(const char *path, struct store **out, char *warning, size_t warning_size,
                         struct error *error) {
  bool held = false;
  *out = NULL;
  if (warning_size)
    warning[0] = '\0';
  if (place_refused(path))
    return status_fail(error, STATUS_USAGE, "%s: %s", path, place_refused(path));
  TRY(file_input(path, error));
  TRY(place_is_file(path, error));
  struct store *store = allocate(path);
  if (!store)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", path);
  store->writer = true;
  struct stat file;
  const off_t before = stat(path, &file) == 0 ? file.st_size : -1;
  store->lacks_wal = place_lacks_wal(path);
  status result = lock_take(path, &store->lock, &held, error);
  if (result != STATUS_OK) {
    release(store);
    return held ? refuse_held(path, error) : result;
  }

  result = open_locked(store, error);
  write_warning(store, warning, warning_size);
  if (result != STATUS_OK) {
    release(store);
    leave_empty(path, before);
    return result;
  }
  *out = store;
  return STATUS_OK;
}

static status make_readable(struct store *store, struct error *error) {
  status result = sql_execute(store->db, "PRAGMA temp_store = MEMORY", "opening", error);
  if (result == STATUS_OK)
    result = views_make_temporary(store->db, error);
  return result == STATUS_OK ? sql_execute(store->db, "PRAGMA query_only = ON", "opening", error) : result;
}

/* Is it a store that this program can read? */
static status check_version(const struct store *store, int version, struct error *error) {
  if (store->lacks_wal)
    return status_fail(error, STATUS_CONTENT, "%s %s", store->path, lacks_wal_text);
  if (version >= SCHEMA_READABLE)
    return STATUS_OK;
  if (version >= 0)
    return status_fail(
        error, STATUS_CONTENT,
        "%s was written by an older clast (store version %d, now %d). Run its campaign once more, or merge it into a "
        "new store (`clast merge NEW.db FILE`): opening for writing upgrades it and keeps a copy.",
        store->path, version, SCHEMA_VERSION);
  return status_fail(error, STATUS_CONTENT, "%s is empty: no campaign was stored in it yet.", store->path);
}

static status open_readable(struct store *store, struct error *error) {
  int version = -1;
  status result = open_database(store, SQLITE_OPEN_READONLY, error);
  if (result == STATUS_OK)
    result = migrate_inspect(store->db, store->path, &version, error);
  if (result != STATUS_OK)
    return result;
  store->lacks_wal = is_partial_copy(store, version);
  result = check_version(store, version, error);
  return result == STATUS_OK ? make_readable(store, error) : result;
}

status store_open_reader(const char *path, struct store **out, struct error *error) {
  *out = NULL;
  if (access(path, F_OK) != 0)
    return status_fail(error, STATUS_MISSING, "%s: there is no such store. Check the name and the current folder.",
                       path);
  TRY(file_input(path, error));
  TRY(place_is_file(path, error));
  struct store *store = allocate(path);
  if (!store)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", path);
  store->lacks_wal = place_lacks_wal(path);
  const status result = open_readable(store, error);
  if (result == STATUS_OK)
    *out = store;
  else
    release(store);
  return result;
}

status store_close(struct store *store, struct error *error) {
  if (!store)
    return STATUS_OK;
  status result = STATUS_OK;
  if (store->writer) {
    result = store_flush(store, error);
    if (result == STATUS_OK)
      result = sql_execute(store->db, "DELETE FROM holder", "closing", error);
    /* If a reader is in the middle of a query, the file stays in WAL mode, complete and readable. */
    sqlite3_busy_timeout(store->db, 1000);
    sqlite3_exec(store->db, "PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE", NULL, NULL, NULL);
  }
  release(store);
  return result;
}

/* Undoes the open batch. */
static void roll_back(struct store *store) {
  sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL); /* SQLite may have done so already */
  for (size_t i = 0; i < store->batch_identity_count; i++) {
    struct identities_state *entry = identities_find(&store->identities, store->batch_identities[i]);
    if (entry)
      entry->stored = false;
  }
  sums_forget(&store->sums);
  store->in_batch = false;
  store->batch_identity_count = 0;
  store->broken = true;
}

status store_begin(struct store *store, struct error *error) {
  if (!store->writer)
    return status_fail(error, STATUS_INTERNAL, "%s is open for reading only", store->path);
  if (store->broken)
    return status_fail(error, STATUS_IO,
                       "%s: an earlier write failed, so clast writes nothing more. Committed runs are safe; give the "
                       "same command again to compute the rest.",
                       store->path);
  if (store->in_batch)
    return STATUS_OK;
  status result = sql_execute(store->db, "BEGIN IMMEDIATE", "beginning to write", error);
  if (result != STATUS_OK) {
    store->broken = true;
    return result;
  }
  store->in_batch = true;
  store->batch_rows = 0;
  store->batch_identity_count = 0;
  store->batch_started = clock_s();
  return STATUS_OK;
}

status store_end(struct store *store, status result, int rows, struct error *error) {
  if (result != STATUS_OK) {
    if (store->in_batch)
      roll_back(store);
    return result;
  }
  store->batch_rows += rows;
  return store->batch_rows >= STORE_BATCH_ROWS ? store_flush(store, error) : store_tick(store, error);
}

status store_flush(struct store *store, struct error *error) {
  if (!store->in_batch)
    return STATUS_OK;
  status result = place_check(store->db, store->path, error);
  if (result == STATUS_OK)
    result = sums_write(&store->sums, store->db, error);
  if (result == STATUS_OK)
    result = sql_execute(store->db, "COMMIT", "committing", error);
  if (result != STATUS_OK) {
    roll_back(store);
    return result;
  }
  store->in_batch = false;
  store->batch_identity_count = 0;
  return STATUS_OK;
}

status store_tick(struct store *store, struct error *error) {
  if (!store->in_batch)
    return place_check(store->db, store->path, error);
  return clock_s() - store->batch_started >= STORE_BATCH_SECONDS ? store_flush(store, error) : STATUS_OK;
}

status store_begin_session(struct store *store, const char *facts_json, int64_t *session_id, struct error *error) {
  char host[256] = "unknown";
  gethostname(host, sizeof host - 1);
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result =
      sql_executef(store->db, "beginning a session", error,
                   "INSERT INTO session (started_at, host, pid, facts) VALUES (strftime('%%Y-%%m-%%dT%%H:%%M:%%fZ', "
                   "'now'), %Q, %lld, %Q)",
                   host, (long long)getpid(), facts_json ? facts_json : "{}");
  *session_id = sqlite3_last_insert_rowid(store->db);
  result = store_end(store, result, 1, error);
  return result == STATUS_OK ? store_flush(store, error) : result;
}

status store_set_session(struct store *store, int64_t session_id, int64_t campaign_id, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = sql_executef(store->db, "beginning a session", error,
                        "UPDATE session SET campaign_id = %lld WHERE session_id = %lld", (long long)campaign_id,
                        (long long)session_id);
  return store_end(store, result, 1, error);
}

status store_end_session(struct store *store, int64_t session_id, const char *outcome, struct error *error) {
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  result = sql_executef(store->db, "ending a session", error,
                        "UPDATE session SET ended_at = strftime('%%Y-%%m-%%dT%%H:%%M:%%fZ', 'now'), outcome = %Q WHERE "
                        "session_id = %lld",
                        outcome, (long long)session_id);
  result = store_end(store, result, 1, error);
  return result == STATUS_OK ? store_flush(store, error) : result;
}

bool store_has_run(struct store *store, const uint8_t identity[16]) {
  if (!store->identities_loaded && identities_load(store, NULL) != STATUS_OK)
    return false;
  const struct identities_state *entry = identities_find(&store->identities, identity);
  return entry && entry->stored;
}

int store_attempts(struct store *store, const uint8_t identity[16], double time_limit, double memory_limit) {
  if (!store->identities_loaded && identities_load(store, NULL) != STATUS_OK)
    return 0;
  const struct identities_state *entry = identities_find(&store->identities, identity);
  if (!entry || entry->attempts == 0)
    return 0; /* the usual case needs no query */
  sqlite3_stmt *statement = NULL;
  int count = (int)entry->attempts;
  if (sql_prepare(store->db,
                  "SELECT count(*) FROM attempt WHERE identity = ?1 AND reason <> 'lost' AND NOT (reason = "
                  "'time_limit' AND (?2 = 0 OR "
                  "limited_to < ?2)) AND NOT (reason = 'memory_limit' AND (?3 = 0 OR limited_to < ?3))",
                  &statement, "counting attempts", NULL) == STATUS_OK) {
    sqlite3_bind_blob(statement, 1, identity, 16, SQLITE_STATIC);
    sqlite3_bind_double(statement, 2, time_limit);
    sqlite3_bind_double(statement, 3, memory_limit);
    if (sqlite3_step(statement) == SQLITE_ROW)
      count = sqlite3_column_int(statement, 0);
  }
  sqlite3_finalize(statement);
  return count;
}
