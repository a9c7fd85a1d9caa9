/* Copies the spectra of runs in a merge, and adds to their running sums. Digests protect the masses, and a spectrum
 * must match its masses: a changed one is refused here. Each row of the source is read once: the INSERT that copies it
 * calls our function to check it. (Rebuilding all sums would sort the spectra of all runs: three quarters of the time
 * of a merge.) */
#include "db/store/sums.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

static const char doing[] = "copying spectra";

enum { RUNS_AT_ONCE = 1000, SUMS_AT_ONCE = 200000, MOST_BINS = 512 };

static status refuse(int64_t run_id, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s: the spectrum of run %lld is not that of its masses. The source is damaged: restore a copy.",
                     doing, (long long)run_id);
}

static const char of_runs[] = "SELECT run_id, point_id, results_version, counts, state = 'end-time', surplus, masses "
                              "FROM main.run LEFT JOIN main.fragment_mass USING (run_id) WHERE run_id >= ?1 ORDER BY "
                              "run_id";
enum { RUN, POINT, VERSION, COUNTS, CENSORED, SURPLUS, MASSES };
/* OR FAIL: the merge rolls back as a whole, so no single statement has to be undone. */
static const char copy_rows[] = "INSERT OR FAIL INTO main.spectrum (run_id, bin, count, mass) SELECT m.ours, o.bin, "
                                "o.count, o.mass FROM temp.merge_run m CROSS JOIN other.spectrum o ON o.run_id = "
                                "m.theirs WHERE m.ours BETWEEN ?1 AND ?2 AND is_of_masses(m.ours, o.bin, o.count, "
                                "o.mass) ORDER BY m.ours, o.bin";

struct copying {
  struct sums *sums;
  sqlite3_stmt *runs, *rows;
  int64_t last;           /* the current run of `runs`; 0: before the first one */
  bool counts;            /* is it part of the statistics? */
  struct sums_row *total; /* running sums of the run's point */
  double *masses;         /* masses of the run */
  size_t capacity;        /* bytes of `masses` */
  struct spectrum_bin_row bins[MOST_BINS];
  size_t count, seen;      /* bins of the run's masses; rows of the run read so far */
  size_t gathered;         /* sums gathered since the last write; bounds their number in memory */
  int64_t lowest, highest; /* bins of all runs; lowest > highest: none */
  status result;           /* status of is_of_masses() */
  struct error error;      /* error of is_of_masses() */
};

static struct sums_row *add_run(struct sums *sums, sqlite3_stmt *run) {
  const bool counts = sqlite3_column_int(run, COUNTS) != 0, surplus = sqlite3_column_int(run, SURPLUS) != 0;
  struct sums_row *total = sums_at(sums, sqlite3_column_int64(run, POINT), sqlite3_column_int(run, VERSION),
                                   SPECTRUM_NO_BIN);
  if (!total)
    return NULL;
  total->runs += counts;
  total->censored += counts && sqlite3_column_int(run, CENSORED) != 0;
  total->surplus += surplus;
  total->failed += !counts && !surplus;
  return total;
}

/* Computes the spectrum from the masses of the run. */
static status make_bins(struct copying *copying, struct error *error) {
  const void *bytes = sqlite3_column_blob(copying->runs, MASSES);
  const size_t size = (size_t)sqlite3_column_bytes(copying->runs, MASSES);
  if (size > copying->capacity) {
    free(copying->masses);
    copying->capacity = 0;
    copying->masses = malloc(2 * size);
    if (!copying->masses)
      return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
    copying->capacity = 2 * size;
  }
  for (size_t i = 0; i < size / 8; i++) {
    uint64_t word;
    memcpy(&word, (const char *)bytes + 8 * i, sizeof word);
    word = le64toh(word);
    memcpy(&copying->masses[i], &word, sizeof word);
  }
  copying->count = spectrum_fill(size / 8, copying->masses, copying->bins, MOST_BINS);
  return copying->count > MOST_BINS ? refuse(copying->last, error) : STATUS_OK;
}

static status add_bin(struct copying *copying, const struct spectrum_bin_row *bin, struct error *error) {
  struct sums_row *total = copying->total;
  struct sums_row *row = sums_at(copying->sums, total->key.point_id, total->key.results_version, bin->bin);
  if (!row)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  row->runs++;
  row->count += bin->count;
  row->count_squared += bin->count * bin->count;
  row->mass += bin->mass;
  total->count += bin->count;
  total->mass += bin->mass;
  return STATUS_OK;
}

/* Adds the bins of the current run of `runs` to the sums. */
static status take_run(struct copying *copying, struct error *error) {
  copying->last = sqlite3_column_int64(copying->runs, RUN);
  copying->counts = sqlite3_column_int(copying->runs, COUNTS) != 0;
  copying->seen = 0;
  copying->total = add_run(copying->sums, copying->runs);
  if (!copying->total)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  status result = make_bins(copying, error);
  copying->gathered += 1 + copying->count;
  for (size_t i = 0; result == STATUS_OK && copying->counts && i < copying->count; i++)
    result = add_bin(copying, &copying->bins[i], error);
  if (result != STATUS_OK || copying->count == 0)
    return result;
  if (copying->bins[0].bin < copying->lowest)
    copying->lowest = copying->bins[0].bin;
  if (copying->bins[copying->count - 1].bin > copying->highest)
    copying->highest = copying->bins[copying->count - 1].bin;
  return STATUS_OK;
}

/* Advances to this run. All rows of the runs before it must have been read. */
static status go_to(struct copying *copying, int64_t run, struct error *error) {
  status result = STATUS_OK;
  while (result == STATUS_OK && copying->last < run) {
    if (copying->seen < copying->count)
      return refuse(copying->last, error);
    if (!sql_next(copying->runs, &result, doing, error))
      return result;
    result = take_run(copying, error);
  }
  return result;
}

/* is_of_masses(run_id, bin, count, mass): is this the next row of the run's spectrum? Fails otherwise. */
static void is_of_masses(sqlite3_context *context, int count, sqlite3_value **values) {
  struct copying *copying = sqlite3_user_data(context);
  const int64_t run = sqlite3_value_int64(values[0]);
  (void)count;
  if (run != copying->last)
    copying->result = go_to(copying, run, &copying->error);
  const struct spectrum_bin_row *bin = &copying->bins[copying->seen];
  if (copying->result == STATUS_OK &&
      (run != copying->last || copying->seen >= copying->count || sqlite3_value_int64(values[1]) != bin->bin ||
       sqlite3_value_int64(values[2]) != bin->count || sqlite3_value_double(values[3]) != bin->mass))
    copying->result = refuse(run, &copying->error);
  copying->seen++;
  if (copying->result == STATUS_OK)
    sqlite3_result_int(context, 1);
  else
    sqlite3_result_error_code(context, SQLITE_ABORT);
}

/* Copies the spectra of the runs first..last. */
static status copy_some(struct copying *copying, int64_t first, int64_t last, struct error *error) {
  sqlite3_bind_int64(copying->rows, 1, first);
  sqlite3_bind_int64(copying->rows, 2, last);
  status result = sql_run(copying->rows, doing, error);
  if (copying->result != STATUS_OK && error)
    *error = copying->error;
  if (copying->result != STATUS_OK)
    return copying->result;
  if (result == STATUS_OK)
    result = go_to(copying, last, error);
  if (result == STATUS_OK && copying->seen < copying->count)
    return refuse(copying->last, error);
  if (result != STATUS_OK || copying->gathered < SUMS_AT_ONCE)
    return result;
  copying->gathered = 0;
  return sums_write(copying->sums, sqlite3_db_handle(copying->runs), error);
}

static status begin(struct copying *copying, sqlite3 *db, int64_t first, struct error *error) {
  const int code = sqlite3_create_function(db, "is_of_masses", 4, SQLITE_UTF8 | SQLITE_DIRECTONLY, copying,
                                           is_of_masses, NULL, NULL);
  if (code != SQLITE_OK)
    return sql_fail(db, code, doing, error);
  status result = sql_prepare(db, of_runs, &copying->runs, doing, error);
  if (result == STATUS_OK)
    result = sql_prepare(db, copy_rows, &copying->rows, doing, error);
  sqlite3_bind_int64(copying->runs, 1, first);
  return result;
}

static status copy_all(struct copying *copying, sqlite3 *db, int64_t first, int64_t last, struct error *error) {
  status result = begin(copying, db, first, error);
  for (; result == STATUS_OK && first <= last; first += RUNS_AT_ONCE)
    result = copy_some(copying, first, last - first < RUNS_AT_ONCE ? last : first + RUNS_AT_ONCE - 1, error);
  if (result == STATUS_OK)
    result = sums_write(copying->sums, db, error);
  sqlite3_finalize(copying->runs);
  sqlite3_finalize(copying->rows);
  sqlite3_create_function(db, "is_of_masses", 4, SQLITE_UTF8, NULL, NULL, NULL, NULL);
  free(copying->masses);
  if (result == STATUS_OK && copying->lowest <= copying->highest)
    return sums_cover_bins(db, copying->lowest, copying->highest, error);
  return result;
}

status sums_runs_copy(struct sums *sums, sqlite3 *db, int64_t first, int64_t last, struct error *error) {
  struct copying *copying = calloc(1, sizeof *copying);
  if (!copying)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  copying->sums = sums;
  copying->lowest = INT64_MAX;
  copying->highest = INT64_MIN;
  const status result = copy_all(copying, db, first, last, error);
  free(copying);
  if (result != STATUS_OK)
    sums_forget(sums);
  return result;
}
