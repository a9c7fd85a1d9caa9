/* Running sums of points: gathered in a hash table, written with the batch, rebuilt from the rows, copied in a merge.
 */
#include <endian.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "schemas/text.h"

/* A key is three small numbers: multiplying is enough, and cheaper than the library's own hash. A batch has thousands
 * of rows, so the table starts large. */
#define HASH_FUNCTION(key, size, hash) ((hash) = hash_of(key))
#define HASH_INITIAL_NUM_BUCKETS       4096U
#define HASH_INITIAL_NUM_BUCKETS_LOG2  12U
#define HASH_NONFATAL_OOM              1
#define uthash_nonfatal_oom(entry)     ((entry)->is_added = false)
#include <uthash.h>

static unsigned hash_of(const struct sums_key *key) {
  uint64_t x = (uint64_t)key->point_id * 0x9e3779b97f4a7c15u + (uint64_t)key->results_version;
  return (unsigned)(x >> 32) * 31u + (unsigned)key->bin;
}

struct sums_entry {
  UT_hash_handle hh;
  struct sums_row row;
  bool is_added;
  bool changed; /* in this batch */
};

enum { BLOCK = 1024 };
struct sums_block { /* entries are allocated in order, and all are released together */
  struct sums_block *next;
  struct sums_entry entries[BLOCK];
};

/* A zeroed entry of the first block; NULL when memory ran out. */
static struct sums_entry *new_entry(struct sums *sums) {
  if (!sums->blocks || sums->used == BLOCK) {
    struct sums_block *block = malloc(sizeof *block);
    if (!block)
      return NULL;
    block->next = sums->blocks;
    sums->blocks = block;
    sums->used = 0;
  }
  struct sums_entry *entry = &sums->blocks->entries[sums->used++];
  *entry = (struct sums_entry){.is_added = true};
  return entry;
}

struct sums_row *sums_at(struct sums *sums, int64_t point_id, int results_version, int bin) {
  const struct sums_key key = {point_id, results_version, bin};
  struct sums_entry *entry;
  HASH_FIND(hh, sums->table, &key, sizeof key, entry);
  if (!entry) {
    entry = new_entry(sums);
    if (!entry)
      return NULL;
    entry->row.key = key;
    HASH_ADD(hh, sums->table, row.key, sizeof key, entry);
    if (!entry->is_added)
      return NULL;
    sums->sorted = false;
  }
  entry->changed = true;
  return &entry->row;
}

static int by_key(const struct sums_entry *a, const struct sums_entry *b) {
  const struct sums_key *x = &a->row.key, *y = &b->row.key;
  if (x->point_id != y->point_id)
    return x->point_id < y->point_id ? -1 : 1;
  if (x->results_version != y->results_version)
    return x->results_version < y->results_version ? -1 : 1;
  return (x->bin > y->bin) - (x->bin < y->bin);
}

static status prepare(struct sums *sums, sqlite3 *db, struct error *error) {
  if (sums->bin)
    return STATUS_OK;
  status result = sql_prepare(db,
                              "INSERT INTO point_total (point_id, results_version, runs, censored, failed, surplus, "
                              "fragments, mass) VALUES (?1, "
                              "?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT DO UPDATE SET runs = runs + ?3, censored = "
                              "censored + ?4, failed = failed + "
                              "?5, surplus = surplus + ?6, fragments = fragments + ?7, mass = mass + ?8",
                              &sums->total, "keeping running sums", error);
  if (result == STATUS_OK)
    result = sql_prepare(db,
                         "INSERT INTO point_spectrum (point_id, results_version, bin, runs, count, count_squared, "
                         "mass) VALUES (?1, ?2, ?3, "
                         "?4, ?5, ?6, ?7) ON CONFLICT DO UPDATE SET runs = runs + ?4, count = count + ?5, "
                         "count_squared = count_squared + "
                         "?6, mass = mass + ?7",
                         &sums->bin, "keeping running sums", error);
  if (result == STATUS_OK) /* the previous pooled estimates are stale */
    result = sql_prepare(db, "DELETE FROM point_estimate WHERE point_id = ?1 AND results_version = ?2", &sums->stale,
                         "keeping pooled estimates", error);
  return result;
}

static sqlite3_stmt *bind(struct sums *sums, const struct sums_row *row) {
  bool total = row->key.bin == SPECTRUM_NO_BIN;
  sqlite3_stmt *statement = total ? sums->total : sums->bin;
  sqlite3_bind_int64(statement, 1, row->key.point_id);
  sqlite3_bind_int(statement, 2, row->key.results_version);
  if (total) {
    sqlite3_bind_int64(statement, 3, row->runs);
    sqlite3_bind_int64(statement, 4, row->censored);
    sqlite3_bind_int64(statement, 5, row->failed);
    sqlite3_bind_int64(statement, 6, row->surplus);
    sqlite3_bind_int64(statement, 7, row->count);
    sqlite3_bind_double(statement, 8, row->mass);
  } else {
    sqlite3_bind_int(statement, 3, row->key.bin);
    sqlite3_bind_int64(statement, 4, row->runs);
    sqlite3_bind_int64(statement, 5, row->count);
    sqlite3_bind_int64(statement, 6, row->count_squared);
    sqlite3_bind_double(statement, 7, row->mass);
  }
  return statement;
}

static status write_row(struct sums *sums, const struct sums_row *row, struct error *error) {
  TRY(sql_run(bind(sums, row), "keeping running sums", error));
  if (row->key.bin != SPECTRUM_NO_BIN)
    return STATUS_OK;
  sqlite3_bind_int64(sums->stale, 1, row->key.point_id);
  sqlite3_bind_int(sums->stale, 2, row->key.results_version);
  return sql_run(sums->stale, "keeping pooled estimates", error);
}

/* Batches return to the same points, so the rows stay in the table in order, set to zero, until there are too many. */
enum { ROWS_KEPT = 65536 };

status sums_write(struct sums *sums, sqlite3 *db, struct error *error) {
  if (!sums->table)
    return STATUS_OK;
  status result = prepare(sums, db, error);
  if (!sums->sorted)
    HASH_SRT(hh, sums->table, by_key);
  sums->sorted = true;
  for (struct sums_entry *entry = sums->table; result == STATUS_OK && entry; entry = entry->hh.next) {
    if (!entry->changed)
      continue;
    result = write_row(sums, &entry->row, error);
    entry->row = (struct sums_row){.key = entry->row.key};
    entry->changed = false;
  }
  if (result != STATUS_OK || HASH_COUNT(sums->table) > ROWS_KEPT)
    sums_forget(sums);
  return result;
}

void sums_forget(struct sums *sums) {
  HASH_CLEAR(hh, sums->table);
  while (sums->blocks && sums->blocks->next) { /* keep one block for the next batch */
    struct sums_block *block = sums->blocks;
    sums->blocks = block->next;
    free(block);
  }
  sums->used = 0;
}

void sums_clear(struct sums *sums) {
  sums_forget(sums);
  free(sums->blocks);
  sqlite3_finalize(sums->total);
  sqlite3_finalize(sums->bin);
  sqlite3_finalize(sums->stale);
  *sums = (struct sums){0};
}

#define TOTALS(where)                                                                                                  \
  "SELECT point_id, results_version, sum(counts) AS runs, sum(counts AND state = 'end-time') AS censored, "            \
  "sum(surplus = 0 AND counts = 0) AS failed, sum(surplus) AS surplus, sum(iif(counts, fragments, 0)) AS fragments, "  \
  "total(iif(counts, mass, 0)) AS mass FROM (SELECT r.point_id, r.results_version, r.counts, r.state, r.surplus, "     \
  "ifnull((SELECT sum(count) FROM spectrum s WHERE s.run_id = r.run_id), 0) AS fragments, (SELECT total(mass) FROM "   \
  "spectrum s WHERE s.run_id = r.run_id) AS mass FROM run r" where ") GROUP BY point_id, results_version"
#define BINS(and_where)                                                                                                \
  "SELECT r.point_id, r.results_version, s.bin, count(*) AS runs, sum(s.count) AS count, sum(s.count * s.count) AS "   \
  "count_squared, total(s.mass) AS mass FROM run r JOIN spectrum s ON s.run_id = r.run_id WHERE r.counts = "           \
  "1" and_where " GROUP BY r.point_id, r.results_version, s.bin"

status sums_rebuild(sqlite3 *db, int64_t point_id, struct error *error) {
  static const char doing[] = "making running sums";
  const long long point = point_id;
  TRY(sql_executef(db, doing, error,
                   "DELETE FROM point_total WHERE point_id = %lld; DELETE FROM point_spectrum WHERE point_id = %lld; "
                   "DELETE FROM point_estimate WHERE point_id = %lld",
                   point, point, point));
  TRY(sql_executef(db, doing, error,
                   "INSERT INTO point_total (point_id, results_version, runs, censored, failed, surplus, fragments, "
                   "mass) " TOTALS(" WHERE r.point_id = %lld"),
                   point));
  return sql_executef(db, doing, error,
                      "INSERT INTO point_spectrum (point_id, results_version, bin, runs, count, count_squared, "
                      "mass) " BINS(" AND r.point_id = %lld"),
                      point);
}

/* Integers must agree; a sum of masses in another order agrees to n units in the last place, with n runs below 1e6. */
status sums_mismatches(sqlite3 *db, int64_t *count, struct error *error) {
  return sql_integerf(db, count, error,
                      "SELECT (SELECT count(*) FROM (" TOTALS(
                          "") ") a FULL JOIN point_total b USING (point_id, results_version) WHERE (a.runs, "
                              "a.censored, a.failed, a.surplus, a.fragments) IS NOT (b.runs, b.censored, b.failed, "
                              "b.surplus, b.fragments) OR "
                              "abs(a.mass - b.mass) > 1e-10 * a.mass) + (SELECT count(*) FROM (" BINS(
                                  "") ") a FULL JOIN point_spectrum b USING "
                                      "(point_id, results_version, bin) WHERE (a.runs, a.count, a.count_squared) IS "
                                      "NOT (b.runs, b.count, "
                                      "b.count_squared) OR abs(a.mass - b.mass) > 1e-10 * a.mass)");
}

status sums_cover_bins(sqlite3 *db, int64_t lowest, int64_t highest, struct error *error) {
  static const char doing[] = "adding bin edges";
  STATEMENT statement = NULL;
  if (lowest < -SUMS_BINS_LIMIT || highest > SUMS_BINS_LIMIT)
    return status_fail(error, STATUS_CONTENT,
                       "%s: bins %lld to %lld are no bins of masses. The store is damaged: restore a copy.",
                       sqlite3_db_filename(db, "main"), (long long)lowest, (long long)highest);
  status result = sql_prepare(db, "INSERT OR IGNORE INTO bin (bin, lower, upper) VALUES (?1, ?2, ?3)", &statement,
                              doing, error);
  for (int bin = (int)lowest; result == STATUS_OK && bin <= highest; bin++) {
    sqlite3_bind_int(statement, 1, bin);
    sqlite3_bind_double(statement, 2, spectrum_edge(bin));
    sqlite3_bind_double(statement, 3, spectrum_edge(bin + 1));
    result = sql_run(statement, doing, error);
  }
  return result;
}

/* ---- the copy of spectra in a merge. Digests protect the masses, and a spectrum must match its masses: a changed one
 * is refused here. Each row of the source is read once: the INSERT that copies it calls our function to check it.
 * (Rebuilding all sums would sort the spectra of all runs: three quarters of the time of a merge.) ---- */

static const char copying_spectra[] = "copying spectra";

enum { RUNS_AT_ONCE = 1000, SUMS_AT_ONCE = 200000, MOST_BINS = 512 };

static status refuse(int64_t run_id, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s: the spectrum of run %lld is not that of its masses. The source is damaged: restore a copy.",
                     copying_spectra, (long long)run_id);
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
      return status_fail(error, STATUS_MEMORY, "%s: memory ran out", copying_spectra);
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
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", copying_spectra);
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
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", copying_spectra);
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
    if (!sql_next(copying->runs, &result, copying_spectra, error))
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
  status result = sql_run(copying->rows, copying_spectra, error);
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
    return sql_fail(db, code, copying_spectra, error);
  status result = sql_prepare(db, of_runs, &copying->runs, copying_spectra, error);
  if (result == STATUS_OK)
    result = sql_prepare(db, copy_rows, &copying->rows, copying_spectra, error);
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

status sums_copy(struct sums *sums, sqlite3 *db, int64_t first, int64_t last, struct error *error) {
  struct copying *copying = calloc(1, sizeof *copying);
  if (!copying)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", copying_spectra);
  copying->sums = sums;
  copying->lowest = INT64_MAX;
  copying->highest = INT64_MIN;
  const status result = copy_all(copying, db, first, last, error);
  free(copying);
  if (result != STATUS_OK)
    sums_forget(sums);
  return result;
}
