/* Running sums of points: tables point_total and point_spectrum. A point whose sums change loses its pooled estimates.
 * A batch gathers the sums in memory and writes each changed row once, in the transaction that adds the runs.
 * Rebuilding them from the rows gives the same. */
#ifndef CLAST_DB_STORE_SUMS_H
#define CLAST_DB_STORE_SUMS_H

#include "analysis/statistics/spectrum.h"
#include "db/sql.h"

enum { SUMS_BINS_LIMIT = 4000 }; /* ten bins per decade: no float64 lies further out */

struct sums_key { /* no padding: the hash table compares its bytes */
  int64_t point_id;
  int results_version, bin; /* SPECTRUM_NO_BIN: the point's totals */
};

struct sums_row {
  struct sums_key key;
  int64_t runs, count, count_squared; /* totals: count = fragments */
  int64_t censored, failed, surplus;  /* totals only */
  double mass;
};

struct sums { /* all zero: empty */
  struct sums_entry *table;
  struct sums_block *blocks; /* blocks of the entries, the one in use first */
  size_t used;               /* entries of the first block */
  bool sorted;
  sqlite3_stmt *total, *bin; /* upserts, prepared at first use */
  sqlite3_stmt *stale;       /* deletes the pooled estimates of a point with new runs */
};

/* The row to add to, zeros when new. NULL when memory ran out. Valid until the sums are written or forgotten. */
struct sums_row *sums_at(struct sums *sums, int64_t point_id, int results_version, int bin);
/* Writes everything gathered, in ascending order of its key, and sets it to zero. */
status sums_write(struct sums *sums, sqlite3 *db, struct error *error);
void sums_forget(struct sums *sums); /* what was gathered, after a rollback */
void sums_clear(struct sums *sums);  /* everything, statements too */

/* For a merge, within its transaction. The runs first..last and their masses are already copied; table temp.merge_run
 * maps their numbers (ours) to those in the attached store `other` (theirs). Copies their spectra, adds them to the
 * sums and covers their bins, with a bounded number of sums in memory. STATUS_CONTENT: a spectrum does not match the
 * masses. */
status sums_runs_copy(struct sums *sums, sqlite3 *db, int64_t first, int64_t last, struct error *error);
/* Rebuilds the sums of one point (0: of all) from the rows of run and spectrum. Within the caller's transaction. */
status sums_rebuild(sqlite3 *db, int64_t point_id, struct error *error);
/* *count: rows whose running sums differ from the sums of their rows (doubles: by more than rounding). */
status sums_mismatches(sqlite3 *db, int64_t *count, struct error *error);

/* Adds to table bin the edges of the bins lowest..highest that it lacks, so that spectra can be read without the
 * program. Within the caller's transaction. STATUS_CONTENT: no mass lies in such bins. */
status sums_cover_bins(sqlite3 *db, int64_t lowest, int64_t highest, struct error *error);
/* The same for all bins in table spectrum. */
status sums_cover_all_bins(sqlite3 *db, struct error *error);

#endif
