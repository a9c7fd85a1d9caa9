/* The state of an open store. For db/ only. */
#ifndef CLAST_DB_STORE_INTERNAL_H
#define CLAST_DB_STORE_INTERNAL_H

#include <time.h>

#include "db/sql.h"
#include "db/store/digest.h"
#include "db/store/identities.h"
#include "db/store/store.h"
#include "db/store/sums.h"

enum { STORE_BATCH_ROWS = 500, STORE_KINDS = 16 };
#define STORE_BATCH_SECONDS 1.0

struct store_kind { /* fills result_<engine> */
  const struct engine_kind *kind;
  bool first; /* no run of this engine is stored yet: the views have no columns for its results */
  struct sql_insert insert;
  struct digest_names names;
};

struct store {
  sqlite3 *db;
  bool writer, functions;
  char *path;
  int lock;        /* descriptor, -1 for readers */
  double deadline; /* s, monotonic: end of the time limit of a user's query (db/ask/answer.c) */
  bool lacks_wal;  /* in WAL mode without its -wal file when it was opened (db/store/place.h) */

  struct identities identities; /* a writer reads them when it opens, a reader at first use */
  bool identities_loaded;
  struct sums sums;
  int64_t lowest_bin, highest_bin; /* range covered by table bin; lowest > highest: none */

  bool in_batch, broken;
  int batch_rows;
  double batch_started; /* s, monotonic */
  uint8_t batch_identities[STORE_BATCH_ROWS][16];
  size_t batch_identity_count;

  struct digest_names outcome_names, estimate_names;
  struct {
    struct digest identity, replicate, seed, results_version, masses;
  } name_of; /* columns of a run's digest */
  struct sql_insert run, attempt, estimate;
  sqlite3_stmt *masses, *spectrum, *spectrum_together;
  sqlite3_stmt *point_find, *point, *point_input, *campaign_point, *axis_find;
  struct store_kind kinds[STORE_KINDS];
  size_t kind_count;

  uint8_t *blob; /* scratch for masses */
  size_t blob_capacity;
  struct spectrum_bin_row *bins;
  size_t bin_capacity;
};

/* s since 1970-01-01 UTC */
static inline double store_wall_clock(void) {
  struct timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Call before the first row of a batch: begins the transaction. Refuses readers and stores after a failed write. */
status store_begin(struct store *store, struct error *error);
/* Call after `rows` more rows: commits when the batch is large or old enough. When `result` is not OK, the whole batch
 * is rolled back and the store refuses further writing. Returns `result`, or the status of the commit. */
status store_end(struct store *store, status result, int rows, struct error *error);

/* Gives the store's entry for the engine in *found. Creates the engine's result table when the store has none; *grown
 * becomes true when the views need another column. */
status store_add_run_kind(struct store *store, const struct engine_kind *kind, struct store_kind **found, bool *grown,
                          struct error *error);

/* Is the run part of the statistics? schema_write_counts() writes the same condition in SQL. */
static inline bool store_run_counts(const struct store_run *run) {
  return !run->surplus && outcome_counts(run->outcome);
}

/* Fills store->blob with the masses of a run, little-endian float64. */
status store_fragments_encode(struct store *store, const struct store_run *run, struct error *error);
/* Call after store_fragments_encode(), within the open batch. Adds the masses, the spectrum and the running sums of a
 * run whose row is already written. */
status store_fragments_add(struct store *store, int64_t run_id, const struct store_run *run, struct error *error);

/* The hash that identifies a point. */
void store_point_hash(const struct scene *scene, uint8_t hash[16]);

/* Inserts the estimates of a run that has none yet, within the open batch. */
status store_set_estimates_rows(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                                struct error *error);

#endif
