/* The store: every result of a campaign in one SQLite file that any tool can read (design: joint 5).
 *
 * One writer under an OS lock that dies with it; many readers that never block it (WAL while running; a clean end leaves
 * journal_mode=DELETE). STRICT tables, foreign keys, application_id, user_version. The schema is in schemas/results.sql,
 * made from the field tables plus db/schema.sql; `point.scene` (resolved JSON) and `point_input` are the truth, the views
 * runs, points, spectra, estimates are regenerated when the set of varied paths grows. */
#ifndef CLAST_DB_STORE_H
#define CLAST_DB_STORE_H

#include "engine/outcome.h"
#include "engine/scene.h"
#include "schemas/status.h"

struct store;

/* Open for writing: creates the file when absent, migrates an older one (after VACUUM INTO a backup), refuses a newer or
 * foreign one. STATUS_IO: read-only, disk full, locked (the holder's host and pid are named), STATUS_CONTENT: not a clast
 * store, damaged, newer. *warning (may be NULL) receives a sentence to print (network file system). */
status store_open_writer(const char *path, struct store **out, char *warning, size_t warning_size, struct error *error);
/* Read-only (SQLITE_OPEN_READONLY + query_only): STATUS_MISSING when absent. */
status store_open_reader(const char *path, struct store **out, struct error *error);
/* Commits, checkpoints, back to journal_mode=DELETE when writing. NULL is fine. */
status store_close(struct store *store, struct error *error);
struct sqlite3 *store_handle(struct store *store); /* for analysis' queries; borrowed */

/* Provenance: one row per invocation of `clast run`. `facts` is a JSON object (version, commit, compiler, flags, cpu
 * class, libraries, host, ranks, slots, command line). */
status store_begin_session(struct store *store, const char *facts_json, int64_t *session_id, struct error *error);
status store_end_session(struct store *store, int64_t session_id, const char *outcome, struct error *error);
status store_add_campaign(struct store *store, const char *name, const char *document_text, const char *plan_json,
                          int64_t *campaign_id, struct error *error);

/* The point of this resolved scene (inputs, no seed), found by its hash or added; varied paths widen the views. */
status store_add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                       const char *const *varied_paths, int64_t *point_id, struct error *error);

struct store_run {
  int64_t point_id, session_id;
  int64_t replicate;
  uint64_t seed;
  uint8_t identity[16];
  bool surplus;             /* beyond a stopping prefix: kept, left out of statistics */
  const struct engine_kind *kind;
  const struct outcome *outcome;
  const void *result;       /* kind->results->size bytes */
  const struct fragment *fragments; /* descending mass */
  size_t fragment_count;
  const uint8_t *estimates; /* encoded rows of the table given to store_set_estimates, or NULL */
  size_t estimate_count;
  double wall_s, cpu_s;
  int64_t peak_memory;      /* bytes */
  int attempt;              /* 1.. */
  const char *host;
  int rank;
  const char *fields_path;  /* HDF5 file kept, or NULL */
};
/* Adds run, result_<engine>, masses, spectrum rows and the running point sums in one transaction with its batch (500 rows
 * or 1 s, BEGIN IMMEDIATE). Adding an identity that is there already is STATUS_OK and changes nothing. */
status store_add_run(struct store *store, const struct store_run *run, struct error *error);

struct store_attempt {
  int64_t point_id, replicate, session_id;
  uint64_t seed;
  uint8_t identity[16];
  int attempt;
  const char *reason; /* time_limit, memory_limit, crash, lost, exit */
  int exit_code, signal;
  double wall_s;
  int64_t peak_memory;
  const char *message, *host;
  int rank;
};
status store_add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error);
status store_flush(struct store *store, struct error *error); /* commit the open batch now */
status store_tick(struct store *store, struct error *error);  /* commit when the batch is older than 1 s */

/* What is there already: is this identity stored (resume)? */
bool store_has_run(struct store *store, const uint8_t identity[16]);
/* Failed attempts so far of an identity. */
int store_attempts(struct store *store, const uint8_t identity[16]);

/* Checks (PRAGMA integrity_check, foreign keys, orphans, missing field files, running sums against their rows); each
 * problem as a line to `line`. STATUS_CONTENT when any. */
status store_check(struct store *store, void (*line)(void *context, const char *text), void *context, struct error *error);
/* All of `source` that `store` lacks, one transaction per source; counts what was added. */
status store_merge(struct store *store, const char *source, int64_t *added, struct error *error);
/* VACUUM INTO. */
status store_export(struct store *store, const char *path, struct error *error);

/* The whole schema as SQL text (what schemas/results.sql must equal). malloc'd. */
char *store_schema_sql(void);

#endif
