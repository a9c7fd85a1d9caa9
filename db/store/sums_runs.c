/* Running sums of runs that are stored already: a merge copies rows by the million, and sums what it copied. (Making
 * all sums anew sorts the spectra of all runs: three quarters of the time of a merge.) Digests vouch for the masses,
 * and a spectrum must be that of its masses: a changed one is refused here. */
#include "db/store/sums.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

static const char doing[] = "adding to running sums";

enum { MOST_AT_ONCE = 50000, MOST_BINS = 512 };

static status refuse(int64_t run_id, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s: the spectrum of run %lld is not that of its masses. The source is damaged: restore a copy.",
                     doing, (long long)run_id);
}

/* Two questions side by side, both in the order of run_id: a join of them would read the long row of a run again for
 * each of its bins, and take twice as long. */
static const char of_runs[] = "SELECT run_id, point_id, results_version, counts, state = 'end-time', surplus, masses "
                              "FROM main.run LEFT JOIN main.fragment_mass USING (run_id) WHERE run_id >= ?1 ORDER BY "
                              "run_id";
enum { RUN, POINT, VERSION, COUNTS, CENSORED, SURPLUS, MASSES };
static const char of_bins[] = "SELECT run_id, bin, count, mass FROM main.spectrum WHERE run_id >= ?1 ORDER BY run_id, "
                              "bin";
enum { BIN = 1, COUNT, MASS };

struct adding {
  struct sums *sums;
  sqlite3_stmt *runs, *bins;
  bool more;               /* bins stands on a row */
  double *masses;          /* of a run */
  size_t capacity;         /* bytes of them */
  int64_t lowest, highest; /* bins; lowest > highest: none */
  size_t gathered;
};

static status next_bin(struct adding *adding, struct error *error) {
  status result = STATUS_OK;
  adding->more = sql_next(adding->bins, &result, doing, error);
  return result;
}

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

/* The spectrum that the masses of the run have: *count bins. */
static status make_bins(struct adding *adding, struct spectrum_bin_row bins[MOST_BINS], size_t *count,
                        struct error *error) {
  const void *bytes = sqlite3_column_blob(adding->runs, MASSES);
  const size_t size = (size_t)sqlite3_column_bytes(adding->runs, MASSES);
  if (size > adding->capacity) {
    free(adding->masses);
    adding->capacity = 0;
    adding->masses = malloc(2 * size);
    if (!adding->masses)
      return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
    adding->capacity = 2 * size;
  }
  for (size_t i = 0; i < size / 8; i++) {
    uint64_t word;
    memcpy(&word, (const char *)bytes + 8 * i, sizeof word);
    word = le64toh(word);
    memcpy(&adding->masses[i], &word, sizeof word);
  }
  *count = spectrum_fill(size / 8, adding->masses, bins, MOST_BINS);
  return STATUS_OK;
}

/* Does `bins` stand on this row? */
static bool is_row(const struct adding *adding, int64_t run, const struct spectrum_bin_row *bin) {
  sqlite3_stmt *row = adding->bins;
  return adding->more && sqlite3_column_int64(row, RUN) == run && sqlite3_column_int64(row, BIN) == bin->bin &&
         sqlite3_column_int64(row, COUNT) == bin->count && sqlite3_column_double(row, MASS) == bin->mass;
}

static status add_bin(struct adding *adding, struct sums_row *total, const struct spectrum_bin_row *bin,
                      struct error *error) {
  struct sums_row *row = sums_at(adding->sums, total->key.point_id, total->key.results_version, bin->bin);
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

/* Compares the row that `bins` stands on with this bin of the run, adds it to the sums (total NULL: the run does not
 * count), and goes to the next row. */
static status take_bin(struct adding *adding, int64_t run, const struct spectrum_bin_row *bin, struct sums_row *total,
                       struct error *error) {
  if (!is_row(adding, run, bin))
    return refuse(run, error);
  const status result = total ? add_bin(adding, total, bin, error) : STATUS_OK;
  return result == STATUS_OK ? next_bin(adding, error) : result;
}

/* Rows of runs that are not there are passed over. */
static status skip_to(struct adding *adding, int64_t run, struct error *error) {
  status result = STATUS_OK;
  while (result == STATUS_OK && adding->more && sqlite3_column_int64(adding->bins, RUN) < run)
    result = next_bin(adding, error);
  return result;
}

static void widen(struct adding *adding, const struct spectrum_bin_row *first, const struct spectrum_bin_row *last) {
  if (first->bin < adding->lowest)
    adding->lowest = first->bin;
  if (last->bin > adding->highest)
    adding->highest = last->bin;
}

/* Compares the rows of the run with its bins, and adds these. */
static status take_bins(struct adding *adding, int64_t run, struct sums_row *total, struct error *error) {
  struct spectrum_bin_row bins[MOST_BINS];
  size_t count = 0;
  status result = make_bins(adding, bins, &count, error);
  if (result == STATUS_OK)
    result = skip_to(adding, run, error);
  if (result != STATUS_OK)
    return result;
  if (count > MOST_BINS)
    return refuse(run, error);

  const bool counts = sqlite3_column_int(adding->runs, COUNTS) != 0;
  for (size_t i = 0; result == STATUS_OK && i < count; i++)
    result = take_bin(adding, run, &bins[i], counts ? total : NULL, error);
  if (result != STATUS_OK)
    return result;
  if (adding->more && sqlite3_column_int64(adding->bins, RUN) == run)
    return refuse(run, error);
  if (count > 0)
    widen(adding, &bins[0], &bins[count - 1]);
  adding->gathered += count;
  return STATUS_OK;
}

/* The run that `runs` stands on, with its bins. */
static status take_run(struct adding *adding, struct error *error) {
  struct sums_row *total = add_run(adding->sums, adding->runs);
  if (!total)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  const status result = take_bins(adding, sqlite3_column_int64(adding->runs, RUN), total, error);
  adding->gathered++;
  if (result != STATUS_OK || adding->gathered < MOST_AT_ONCE)
    return result;
  adding->gathered = 0;
  return sums_write(adding->sums, sqlite3_db_handle(adding->runs), error);
}

static status begin(struct adding *adding, sqlite3 *db, int64_t first, struct error *error) {
  status result = sql_prepare(db, of_runs, &adding->runs, doing, error);
  if (result == STATUS_OK)
    result = sql_prepare(db, of_bins, &adding->bins, doing, error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_int64(adding->runs, 1, first);
  sqlite3_bind_int64(adding->bins, 1, first);
  return next_bin(adding, error);
}

status sums_runs_add(struct sums *sums, sqlite3 *db, int64_t first, struct error *error) {
  struct adding adding = {.sums = sums, .lowest = INT64_MAX, .highest = INT64_MIN};
  status result = begin(&adding, db, first, error);
  while (sql_next(adding.runs, &result, doing, error))
    result = take_run(&adding, error);
  sqlite3_finalize(adding.runs);
  sqlite3_finalize(adding.bins);
  free(adding.masses);
  if (result == STATUS_OK)
    result = sums_write(sums, db, error);
  if (result == STATUS_OK && adding.lowest <= adding.highest)
    result = sums_cover_bins(db, adding.lowest, adding.highest, error);
  if (result != STATUS_OK)
    sums_forget(sums);
  return result;
}
