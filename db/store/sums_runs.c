/* Running sums of runs that are stored already: a merge copies rows by the million, and sums what it copied. (Making
 * all sums anew sorts the spectra of all runs: three quarters of the time of a merge.) */
#include "db/store/sums.h"

static const char doing[] = "adding to running sums";

enum { MOST_AT_ONCE = 50000, LARGEST_COUNT = 1000000000 };

static status refuse(int64_t run_id, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s: the spectrum of run %lld cannot be one: its bins or numbers are out of range. The source is "
                     "damaged: restore a copy.",
                     doing, (long long)run_id);
}

/* A run that counts, with one of its bins. */
static bool add_bin(struct sums_row *total, struct sums_row *row, int64_t count, double mass) {
  int64_t squares = 0;
  if (count < 0 || count > LARGEST_COUNT || __builtin_add_overflow(row->count_squared, count * count, &squares))
    return false;
  row->runs++;
  row->count += count;
  row->count_squared = squares;
  row->mass += mass;
  total->count += count;
  total->mass += mass;
  return true;
}

/* A row of a run and one of its bins; a run without fragments has one row, without a bin. */
enum { RUN, POINT, VERSION, COUNTS, CENSORED, SURPLUS, BIN, COUNT, MASS };

static const char question[] =
    "SELECT r.run_id, r.point_id, r.results_version, r.counts, r.state = 'end-time', r.surplus, s.bin, s.count, s.mass "
    "FROM main.run r LEFT JOIN main.spectrum s ON s.run_id = r.run_id WHERE r.run_id >= ?1 ORDER BY r.run_id, s.bin";

static void add_run(struct sums_row *total, sqlite3_stmt *row) {
  const bool counts = sqlite3_column_int(row, COUNTS) != 0, surplus = sqlite3_column_int(row, SURPLUS) != 0;
  total->runs += counts;
  total->censored += counts && sqlite3_column_int(row, CENSORED) != 0;
  total->surplus += surplus;
  total->failed += !counts && !surplus;
}

struct adding {
  struct sums *sums;
  sqlite3_stmt *rows;
  int64_t run;             /* the last one, and the totals of its point */
  struct sums_row *total;  /* NULL after a write */
  int64_t lowest, highest; /* bins; lowest > highest: none */
  size_t gathered;
};

static status take_row(struct adding *adding, struct error *error) {
  sqlite3_stmt *rows = adding->rows;
  const int64_t run = sqlite3_column_int64(rows, RUN), point = sqlite3_column_int64(rows, POINT);
  const int version = sqlite3_column_int(rows, VERSION);
  if (run != adding->run || !adding->total)
    adding->total = sums_at(adding->sums, point, version, SPECTRUM_NO_BIN);
  if (!adding->total)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  if (run != adding->run)
    add_run(adding->total, rows);
  adding->run = run;
  adding->gathered++;
  if (sqlite3_column_type(rows, BIN) == SQLITE_NULL)
    return STATUS_OK;

  const int64_t bin = sqlite3_column_int64(rows, BIN);
  if (bin < -SUMS_BINS_LIMIT || bin > SUMS_BINS_LIMIT)
    return refuse(run, error);
  adding->lowest = bin < adding->lowest ? bin : adding->lowest;
  adding->highest = bin > adding->highest ? bin : adding->highest;
  if (sqlite3_column_int(rows, COUNTS) == 0)
    return STATUS_OK;
  struct sums_row *row = sums_at(adding->sums, point, version, (int)bin);
  if (!row)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  return add_bin(adding->total, row, sqlite3_column_int64(rows, COUNT), sqlite3_column_double(rows, MASS))
             ? STATUS_OK
             : refuse(run, error);
}

status sums_runs_add(struct sums *sums, sqlite3 *db, int64_t first, struct error *error) {
  struct adding adding = {.sums = sums, .run = INT64_MIN, .lowest = INT64_MAX, .highest = INT64_MIN};
  status result = sql_prepare(db, question, &adding.rows, doing, error);
  sqlite3_bind_int64(adding.rows, 1, first);
  while (sql_next(adding.rows, &result, doing, error)) {
    result = take_row(&adding, error);
    if (result == STATUS_OK && adding.gathered >= MOST_AT_ONCE) {
      result = sums_write(sums, db, error);
      adding.gathered = 0;
      adding.total = NULL;
    }
  }
  sqlite3_finalize(adding.rows);
  if (result == STATUS_OK)
    result = sums_write(sums, db, error);
  if (result == STATUS_OK && adding.lowest <= adding.highest)
    result = sums_cover_bins(db, adding.lowest, adding.highest, error);
  if (result != STATUS_OK)
    sums_forget(sums);
  return result;
}
