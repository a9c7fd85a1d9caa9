/* Checks a source of a merge in a thread: its pages, then its digests. */
#include "db/store/inspect.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "db/store/internal.h"

static const char doing[] = "merging";

struct inspection {
  const char *source; /* borrowed */
  struct store *store;
  pthread_t thread;
  bool has_thread;    /* false: no thread could be started, and the check is already done */
  atomic_bool failed; /* set by the thread while the caller copies */
  status result;
  struct error error;
};

struct damage {
  int64_t first, count;
};

static void take_damage(void *context, int64_t number) {
  struct damage *damage = context;
  if (damage->count++ == 0)
    damage->first = number;
}

static status refuse_damaged(const char *source, const char *what, const struct damage *damage, struct error *error) {
  return damage->count == 0
             ? STATUS_OK
             : status_fail(error, STATUS_CONTENT,
                           "%s: %s %lld is damaged: a bit has changed since it was stored; %lld in all. Nothing was "
                           "taken from it; `clast check` lists them. Restore a copy.",
                           source, what, (long long)damage->first, (long long)damage->count);
}

/* Checks all pages and the types of all rows. Rows of table spectrum, the longest table, are checked one by one when
 * they are copied. */
static status check_pages(struct store *other, const char *source, struct error *error) {
  sqlite3_stmt *rows = NULL;
  status result = sql_prepare(other->db,
                              "SELECT c.quick_check FROM main.sqlite_schema s JOIN pragma_quick_check(s.name) c WHERE "
                              "s.type = 'table' AND s.name <> 'spectrum' AND c.quick_check <> 'ok' LIMIT 1",
                              &rows, doing, error);
  if (sql_next(rows, &result, doing, error))
    result = status_fail(error, STATUS_CONTENT,
                         "%s is damaged: %.500s. Nothing was taken from it; `clast check` tells more. Restore a copy.",
                         source, sql_text(rows, 0));
  sqlite3_finalize(rows);
  return result;
}

static status compare(const struct inspection *inspection, enum digest_kind kind, const char *what,
                      struct error *error) {
  struct damage damage = {0};
  const status result = digest_rows_compare(inspection->store->db, kind, 0, take_damage, &damage, error);
  return result == STATUS_OK ? refuse_damaged(inspection->source, what, &damage, error) : result;
}

static void *check_all(void *context) {
  struct inspection *inspection = context;
  inspection->result = check_pages(inspection->store, inspection->source, &inspection->error);
  if (inspection->result == STATUS_OK)
    inspection->result = compare(inspection, DIGEST_RUNS, "run", &inspection->error);
  if (inspection->result == STATUS_OK)
    inspection->result = compare(inspection, DIGEST_POINTS, "point", &inspection->error);
  inspection->failed = inspection->result != STATUS_OK;
  return NULL;
}

int inspect_failed(void *inspection) {
  return ((struct inspection *)inspection)->failed;
}

status inspect_begin(const char *source, struct inspection **out, struct error *error) {
  struct store *store = NULL;
  *out = NULL;
  status result = store_open_reader(source, &store, error);
  if (result != STATUS_OK)
    return result;
  struct inspection *inspection = calloc(1, sizeof *inspection);
  if (!inspection) {
    store_close(store, NULL);
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  }
  *inspection = (struct inspection){.source = source, .store = store};
  inspection->has_thread = pthread_create(&inspection->thread, NULL, check_all, inspection) == 0;
  if (!inspection->has_thread)
    check_all(inspection);
  *out = inspection;
  return STATUS_OK;
}

status inspect_end(struct inspection *inspection, struct error *error) {
  if (!inspection)
    return STATUS_OK;
  if (inspection->has_thread)
    pthread_join(inspection->thread, NULL);
  const status result = inspection->result;
  if (result != STATUS_OK && error)
    *error = inspection->error;
  const status closed = store_close(inspection->store, result == STATUS_OK ? error : NULL);
  free(inspection);
  return result == STATUS_OK ? closed : result;
}
