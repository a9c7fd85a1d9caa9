/* The store: every result of a campaign in one SQLite file that any tool can read (design: joint 5).
 *
 * One writer under an OS lock that dies with it; many readers that never block it (WAL while running; a clean end
 * leaves journal_mode=DELETE). STRICT tables, foreign keys, application_id, user_version. The schema is in
 * schemas/results.sql, made from the field tables plus db/store/schema_tables.c; `point.scene` (resolved JSON) and
 * `point_input` are the truth, the views runs, points, spectra, estimates are regenerated when the set of varied paths
 * grows. */
#ifndef CLAST_DB_STORE_STORE_H
#define CLAST_DB_STORE_STORE_H

#include <stdio.h>

#include "analysis/statistics/estimates.h"
#include "engine/outcome.h"
#include "engine/scene.h"
#include "schemas/status.h"

struct store;

/* Open for writing: creates the file when absent, migrates an older one (after VACUUM INTO a backup), refuses a newer
 * or foreign one. STATUS_IO: read-only, disk full, locked (the message names the holder's host and process).
 * STATUS_CONTENT: not a clast store, damaged, newer. *warning (may be NULL) receives a sentence to print (network file
 * system), or "". The lock dies with the process; a child forked while the store is open shares it until it ends or
 * executes another program. */
status store_open_writer(const char *path, struct store **out, char *warning, size_t warning_size, struct error *error);
/* Read-only (SQLITE_OPEN_READONLY + query_only): STATUS_MISSING when absent. Never blocks the writer. Questions are
 * asked through db/ask/query.h, which works on a writer too (and sees its open batch). */
status store_open_reader(const char *path, struct store **out, struct error *error);
/* Commits, checkpoints, back to journal_mode=DELETE when writing. NULL is fine. */
status store_close(struct store *store, struct error *error);

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
  bool surplus; /* beyond a stopping prefix: kept, left out of statistics */
  const struct engine_kind *kind;
  const struct outcome *outcome;
  const void *result;               /* kind->results->size bytes */
  const struct fragment *fragments; /* descending mass */
  size_t fragment_count;
  const struct estimate *estimates; /* NULL when there are none */
  size_t estimate_count;
  double wall_s, cpu_s;
  int64_t peak_memory; /* bytes */
  int attempt;         /* 1.. */
  const char *host;
  int rank;
  const char *fields_path; /* HDF5 file kept, or NULL */
};
/* Adds run, result_<engine>, masses, spectrum rows and the running point sums in one transaction with its batch (500
 * rows or 1 s, BEGIN IMMEDIATE). Adding an identity that is there already is STATUS_OK and changes nothing. */
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
  double limit; /* the limit that ended it: s (time_limit) or bytes (memory_limit); 0 for the other reasons */
  const char *message, *host;
  int rank;
};
status store_add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error);

/* The estimates of a run (run_id > 0) or of a whole point (run_id = 0, pooled): replaces those of the same owner and
 * results_version. Joins the open batch. */
status store_set_estimates(struct store *store, int64_t point_id, int64_t run_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error);
/* A stopping rule has spoken: the point's replicates below `prefix` are its statistics, the others are surplus. Running
 * sums follow. Joins the open batch. */
status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error);

status store_flush(struct store *store, struct error *error); /* commit the open batch now */
status store_tick(struct store *store, struct error *error);  /* commit when the batch is older than 1 s */

/* What is there already: is this identity stored (resume)? */
bool store_has_run(struct store *store, const uint8_t identity[16]);
/* Failed attempts so far of an identity that still count: those ended by a time or memory limit below the limits given
 * (s, bytes; 0 = no limit now) do not, so that raising a limit retries them. */
int store_attempts(struct store *store, const uint8_t identity[16], double time_limit, double memory_limit);

/* The stored runs of a point, for a driver that resumes and for stopping rules; in order of replicate. `row` names the
 * quantity wanted: of outcome_table, or else of the engine's results. Borrowed for the call. */
struct store_point_run {
  int64_t replicate;
  uint64_t seed;
  uint8_t identity[16];
  bool surplus;
  int state;    /* enum outcome_state */
  double value; /* of `row`, NaN when NULL in the store */
  double wall_s, cpu_s;
  int64_t peak_memory;
  const char *fields_path; /* NULL when none was kept */
};
status store_point_runs(struct store *store, int64_t point_id, const struct engine_kind *kind, const struct field *row,
                        bool of_outcome, void (*each)(void *context, const struct store_point_run *run), void *context,
                        struct error *error);
/* The HDF5 file kept of a stored run (written by a replay after the run, when a campaign asks for it later). */
status store_set_fields(struct store *store, const uint8_t identity[16], const char *fields_path, struct error *error);

/* Checks integrity, foreign keys, orphans, missing field files, running sums and spectra against the masses, masses
 * against the total mass, identities against the scenes; each problem as a line to `line`. STATUS_CONTENT when any. For
 * a reader or a writer. */
status store_check(struct store *store, void (*line)(void *context, const char *text), void *context,
                   struct error *error);
/* All of `source` that `store` (a writer) lacks, one transaction per source; *added counts the runs. Of a run that both
 * hold, ours stays. Merging twice adds nothing. */
/* *differing: runs that both have with other masses or another state. Ours stay; whoever calls must say so. */
status store_merge(struct store *store, const char *source, int64_t *added, int64_t *differing, struct error *error);
/* One compact file for hand-over (VACUUM INTO); refuses to overwrite. */
status store_export(struct store *store, const char *path, struct error *error);

/* What a determinism test compares: every run by identity with all its deterministic values (%a), masses and spectrum;
 * no time, host or session, no surplus run. Same text whatever the number of workers. */
status store_dump(struct store *store, FILE *out, struct error *error);

#endif
