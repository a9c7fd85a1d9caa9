/* One stored run: its inputs and seed, its results and its fragment masses. Also the wall time of all runs, and the
 * runs whose fields are kept as files. */
#ifndef CLAST_DB_ASK_RUN_H
#define CLAST_DB_ASK_RUN_H

#include "db/ask/answer.h"

struct ask_run {
  char *scene; /* resolved scene as JSON; owned. NULL: the store has no such run */
  uint64_t seed;
  int64_t results_version;
  /* The program and machine that computed the run. "" where the session does not tell. */
  char cpu_class[16];              /* baseline, v3 or v4 */
  char version[64], compiler[128]; /* of the program */
  char commit[96];                 /* followed by " with local changes" if the program had any */
};
status ask_run_read(struct store *store, int64_t run_id, struct ask_run *run, struct error *error);
void ask_run_release(struct ask_run *run); /* a zeroed one is fine */

/* One row: all columns of the tables run and result_<engine>. */
struct answer ask_run_results(struct store *store, int64_t run_id, const char *engine, struct error *error);

/* Did the program that computed this run store a value in a column of run or result_<engine>, for this run or another
 * one of the same session? If not, it may not have had that result. */
status ask_run_column_used(struct store *store, int64_t run_id, const char *engine, const char *column, bool *used,
                           struct error *error);

/* Fragment masses in kg, largest first; the caller frees them. NULL: the store has none. */
status ask_run_masses(struct store *store, int64_t run_id, double **masses, size_t *count, struct error *error);

/* Wall time of all stored runs in s: mean and longest. NaN: there are none. */
status ask_run_wall_times(struct store *store, double *mean, double *longest, struct error *error);

/* One row per run that counts and has its fields kept, of each point's newest results_version: run_id, point_id, seed,
 * the varied inputs, the main results, and last `fields`. */
struct answer ask_run_kept(struct store *store, struct error *error);
/* The path of the file that a row names in this column, as this process can open it: the store holds it relative to its
 * own folder. The caller frees it; NULL: no memory. */
char *ask_run_fields(const struct answer *answer, size_t column);

#endif
