/* The store: every result of a campaign in one SQLite file that any tool with SQLite 3.37 or later can read.
 * db/README.md describes it for users.
 *
 * One process writes, under an OS lock that ends with the process. Readers, in any number, never block it (WAL mode
 * while writing; a clean end leaves journal_mode=DELETE). The tables follow from db/store/schema.c and the field
 * tables; schemas/results.sql is a copy of the schema. `point.scene` (resolved JSON) and `point_input` define a point.
 * The views runs, points, spectra and estimates are made again when campaigns vary more inputs. */
#pragma once

#include <stdio.h>

#include "analysis/statistics/convergence.h"
#include "analysis/statistics/statistics.h"
#include "engine/outcome.h"
#include "engine/scene.h"
#include "schemas/status.h"

struct store;

/* Returns the reason why a name is refused as a store's; NULL: it is accepted. SQLite takes ":memory:", "file:..." and
 * "" for no file, or for a database in memory, so results would be lost at the end. It deletes and overwrites files
 * whose names end in -journal, -wal or -shm. */
const char *store_name_refused(const char *path);
/* What happens while a program that is not clast holds the file of a store, in every call that reads or writes: `wait`
 * is called up to every 50 ms, and says whether the call waits on; tell: once in each wait, after 1 s. Where it says
 * no, the call fails with STATUS_STOPPED. Call it when the program begins; without it calls wait for 10 s. */
void store_on_wait(bool (*wait)(const char *path, bool tell));
/* Opens for writing: creates the file when absent, upgrades an older one (and keeps a copy of it), refuses a newer or
 * foreign one. STATUS_IO: read-only, disk full, written by another clast (the message names its host and process).
 * STATUS_CONTENT: not a clast store, damaged, newer. STATUS_USAGE: the name is no file's (":memory:"). *warning (may be
 * NULL) receives a sentence to print (network file system, copied without its -wal file), or "". The lock ends with the
 * process; a child forked while the store is open shares it until the child ends or executes another program. */
status store_open_writer(const char *path, struct store **out, char *warning, size_t warning_size, struct error *error);
/* Opens for reading only; never blocks the writer. STATUS_MISSING when absent. The functions of db/ask read
 * from a store. They also accept a writer and then see its open batch. */
status store_open_reader(const char *path, struct store **out, struct error *error);
/* The path of the store's file: the given one, or where a symbolic link led. Fields files lie beside it. Borrowed. */
const char *store_path(const struct store *store);
/* Is a process writing this store? Call it before the store is opened: closing a descriptor of the file drops SQLite's
 * locks on it. */
bool store_is_being_written(const char *path);
/* Commits and leaves one plain file in journal_mode=DELETE when writing. NULL is fine. */
status store_close(struct store *store, struct error *error);
/* A store that is only read, and closes itself where its block is left: STORE store = NULL; */
#define STORE __attribute__((cleanup(store_drop))) struct store *
void store_drop(struct store **store); /* for STORE */

/* Provenance: one row per invocation of `clast run`. `facts` is a JSON object (version, commit, compiler, flags, cpu
 * class, libraries, host, ranks, slots, command line). */
status store_begin_session(struct store *store, const char *facts_json, int64_t *session_id, struct error *error);
/* Notes which campaign the session computes. */
status store_set_session(struct store *store, int64_t session_id, int64_t campaign_id, struct error *error);
/* Notes how many points of the campaign ended at seeds.max before seeds.until was met (key
 * points_unmet of `facts`). */
status store_set_session_unmet(struct store *store, int64_t session_id, int64_t points, struct error *error);
status store_end_session(struct store *store, int64_t session_id, const char *outcome, struct error *error);
status store_add_campaign(struct store *store, const char *name, const char *document_text, const char *plan_json,
                          int64_t *campaign_id, struct error *error);

/* Registers an input that a campaign varies, which is a column of the views. `unit`: the unit of the campaign's values,
 * "" for SI; the last campaign decides. */
status store_add_axis(struct store *store, const struct field *input, const char *unit, struct error *error);

/* Finds the point of this resolved scene (inputs, no seed) by its hash, or adds it. Varied paths become columns of the
 * views. */
status store_add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                       const char *const *varied_paths, int64_t *point_id, struct error *error);

/* Finds a point. *point_id: 0 when the store has none for this scene. For a reader or a writer. */
status store_point_find(struct store *store, const struct scene *scene, int64_t *point_id, struct error *error);

struct store_run {
  int64_t point_id, session_id;
  int64_t replicate;
  uint64_t seed;
  uint8_t identity[16];
  bool surplus; /* beyond the prefix of a stopping rule: kept, but left out of statistics */
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
  const char *fields_path;   /* HDF5 file kept, or NULL */
  const char *fields_digest; /* of store_digest_fields(); NULL: it is not known */
};
/* Adds the rows of run, result_<engine>, fragment_mass, spectrum, ejecta and estimate and the point's running sums, in
 * the transaction of its batch (500 rows or 1 s). If the identity is stored already, nothing changes and the status is
 * STATUS_OK. */
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

/* Replaces the estimates of a point for one results_version. Joins the open batch. */
status store_set_estimates(struct store *store, int64_t point_id, int results_version, size_t count,
                           const struct estimate *rows, struct error *error);
/* Call after a decision of a stopping rule: the point's replicates below `prefix` count in its statistics, the others
 * are surplus. The running sums follow. Joins the open batch. */
status store_set_prefix(struct store *store, int64_t point_id, int64_t prefix, struct error *error);
/* Excludes a run from all statistics (`reason`: why), or lets it count again (NULL). The running sums follow; the
 * pooled estimates of its point are gone. Joins the open batch. STATUS_USAGE: there is no such run, or it is not
 * excluded. */
status store_exclude(struct store *store, int64_t run_id, const char *reason, struct error *error);

/* One knob of a convergence study, for one quantity. All pointers are borrowed for the call. */
struct store_convergence {
  int64_t base_point_id;
  int results_version;
  size_t count; /* of levels */
  const int64_t *point_ids;
  const struct convergence_row *rows;
  const struct convergence_limit_row *limit;
};
/* Replaces the stored study of this scene, knob and quantity. Joins the open batch. */
status store_set_convergence(struct store *store, const struct store_convergence *study, struct error *error);
/* After studies: `error` of all levels is the sum of their parts. `frontier`: no other level of the scene and quantity
 * has an error and a processor time that are both not larger, and one of them smaller. */
status store_rank_convergence(struct store *store, struct error *error);

status store_flush(struct store *store, struct error *error); /* commit the open batch now */
/* Begins a batch, and waits for another program at most so long. False: it holds the store. Other faults are left to
 * the next write. */
bool store_begin_within(struct store *store, double seconds);
/* From now on, the calls of this store together wait at most so long for another program. */
void store_hurry(struct store *store, double seconds);
/* Commits when the batch is older than 1 s. STATUS_IO when the file was moved, removed or replaced. */
status store_tick(struct store *store, struct error *error);

/* Is a run of this identity stored? */
bool store_has_run(struct store *store, const uint8_t identity[16]);
/* Number of failed attempts of an identity. Attempts that ended at a lower time or memory limit than the given one (s,
 * bytes; 0: no limit) are not counted, so a raised limit allows another try. Lost attempts are not counted either: they
 * say nothing about the run. */
int store_attempts(struct store *store, const uint8_t identity[16], double time_limit, double memory_limit);

enum { STORE_DIGEST_SIZE = 33 }; /* 32 hexadecimal digits and the end */
/* The digest of a fields file, which changes when any bit of it changes. `path`: as this process can open it.
 * STATUS_MISSING, STATUS_IO: it cannot be read, or is no plain file. */
status store_digest_fields(const char *path, char digest[STORE_DIGEST_SIZE], struct error *error);
/* Stores the path and the digest of a run's HDF5 file: a replay may write the file after the run. */
status store_set_fields(struct store *store, const uint8_t identity[16], const char *fields_path,
                        const char *fields_digest, struct error *error);
/* *whole: the run's fields file has the digest that is stored. Also true when the store has no digest of it. Reads the
 * whole file. */
status store_check_fields(struct store *store, const uint8_t identity[16], bool *whole, struct error *error);

/* Checks the file's integrity, foreign keys, rows without an owner, fields files that are missing or not of their
 * digest, edges of bins, running sums and spectra against the masses, masses against the total mass, digests against
 * the rows, identities against the scenes. Each
 * problem is one call of `line`. STATUS_CONTENT when there are any. For a reader or a writer. */
status store_check(struct store *store, void (*line)(void *context, const char *text), void *context,
                   struct error *error);
/* *whole: the run's digest matches its rows. Also true when the store has no such run. */
status store_check_run(struct store *store, int64_t run_id, bool *whole, struct error *error);
/* Adds the runs of the store `source` that `store` (a writer) lacks, in one transaction. *added: how many. *differing:
 * runs present in both stores with different masses or states. The version of `store` is kept; the caller must report
 * them. Merging twice adds nothing. */
status store_merge(struct store *store, const char *source, int64_t *added, int64_t *differing, struct error *error);
/* Runs that the source of the last merge excludes and `store` (the target) does not, or (`here`) the other way round:
 * the caller must report them, too. */
int64_t store_merge_excluded(const struct store *store, bool here);
/* Writes a compact copy (VACUUM INTO); refuses to overwrite. */
status store_export(struct store *store, const char *path, struct error *error);

/* Writes a line for each point and each run that is not surplus, by identity, with the digest of its inputs, results,
 * masses and estimates as they are now. No times, hosts or sessions. The text is the same for any number of workers. */
status store_export_digests(struct store *store, FILE *out, struct error *error);
