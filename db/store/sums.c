/* Running sums of points: gathered in a hash table, written with the batch, rebuilt from the rows. */
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"

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

/* The row to add to, zeros when new; the totals with SPECTRUM_NO_BIN. NULL: memory ran out. */
static struct sums_row *row_at(struct sums *sums, const struct sums_run *run, int bin) {
  const struct sums_key key = {run->point_id, run->results_version, bin};
  struct sums_entry *entry;
  HASH_FIND(hh, sums->table, &key, sizeof key, entry);
  if (!entry) {
    entry = calloc(1, sizeof *entry);
    if (!entry)
      return NULL;
    entry->row.key = key;
    entry->is_added = true;
    HASH_ADD(hh, sums->table, row.key, sizeof key, entry);
    if (!entry->is_added) {
      free(entry);
      return NULL;
    }
    sums->sorted = false;
  }
  entry->changed = true;
  return &entry->row;
}

bool sums_add(struct sums *sums, const struct sums_run *run, size_t count, const struct spectrum_bin_row *bins) {
  struct sums_row *total = row_at(sums, run, SPECTRUM_NO_BIN);
  if (!total)
    return false;
  total->runs += run->counts;
  total->censored += run->counts && run->at_end_time;
  total->surplus += run->surplus == 1;
  total->failed += !run->counts && run->surplus == 0;
  double mass = 0; /* summed apart, as in SQL: the bits depend on the order */
  for (size_t i = 0; run->counts && i < count; i++) {
    struct sums_row *row = row_at(sums, run, bins[i].bin);
    if (!row)
      return false;
    row->runs++;
    row->count += bins[i].count;
    row->count_squared += bins[i].count * bins[i].count;
    row->mass += bins[i].mass;
    total->count += bins[i].count;
    mass += bins[i].mass;
  }
  total->mass += mass;
  return true;
}

static int by_key(const struct sums_entry *a, const struct sums_entry *b) {
  const struct sums_key *x = &a->row.key, *y = &b->row.key;
  if (x->point_id != y->point_id)
    return x->point_id < y->point_id ? -1 : 1;
  if (x->results_version != y->results_version)
    return x->results_version < y->results_version ? -1 : 1;
  return (x->bin > y->bin) - (x->bin < y->bin);
}

static const char keeping_sums[] = "keeping running sums", keeping_estimates[] = "keeping pooled estimates";

static status prepare(struct sums *sums, sqlite3 *db, struct error *error) {
  TRY(sql_prepare_once(db, &sums->total,
                       "INSERT INTO point_total (point_id, results_version, runs, censored, failed, surplus, "
                       "fragments, mass) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) ON CONFLICT DO UPDATE SET runs = runs "
                       "+ ?3, censored = censored + ?4, failed = failed + ?5, surplus = surplus + ?6, fragments = "
                       "fragments + ?7, mass = mass + ?8",
                       keeping_sums, error));
  TRY(sql_prepare_once(db, &sums->bin,
                       "INSERT INTO point_spectrum (point_id, results_version, bin, runs, count, count_squared, mass) "
                       "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7) ON CONFLICT DO UPDATE SET runs = runs + ?4, count = count "
                       "+ ?5, count_squared = count_squared + ?6, mass = mass + ?7",
                       keeping_sums, error));
  return sql_prepare_once(db, &sums->stale, "DELETE FROM point_estimate WHERE point_id = ?1 AND results_version = ?2",
                          keeping_estimates, error); /* the previous pooled estimates are stale */
}

static status write_row(struct sums *sums, const struct sums_row *row, struct error *error) {
  const struct sql_value point = sql_of_integer(row->key.point_id), version = sql_of_integer(row->key.results_version);
  const struct sql_value runs = sql_of_integer(row->runs), count = sql_of_integer(row->count);
  if (row->key.bin != SPECTRUM_NO_BIN) {
    SQL_BIND(sums->bin, point, version, sql_of_integer(row->key.bin), runs, count, sql_of_integer(row->count_squared),
             sql_of_real(row->mass));
    return sql_run(sums->bin, keeping_sums, error);
  }
  SQL_BIND(sums->total, point, version, runs, sql_of_integer(row->censored), sql_of_integer(row->failed),
           sql_of_integer(row->surplus), count, sql_of_real(row->mass));
  TRY(sql_run(sums->total, keeping_sums, error));
  SQL_BIND(sums->stale, point, version);
  return sql_run(sums->stale, keeping_estimates, error);
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
  struct sums_entry *entry, *next;
  HASH_ITER(hh, sums->table, entry, next) {
    HASH_DEL(sums->table, entry);
    free(entry);
  }
}

void sums_clear(struct sums *sums) {
  sums_forget(sums);
  sqlite3_finalize(sums->total);
  sqlite3_finalize(sums->bin);
  sqlite3_finalize(sums->stale);
  *sums = (struct sums){0};
}

#define TOTALS(where)                                                                                                  \
  "SELECT point_id, results_version, sum(counts) AS runs, sum(counts AND state = 'end-time') AS censored, "            \
  "sum(surplus = 0 AND counts = 0) AS failed, sum(surplus = 1) AS surplus, sum(iif(counts, fragments, 0)) AS "         \
  "fragments, "                                                                                                        \
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

static const char all_totals[] = TOTALS(""), all_bins[] = BINS("");

status sums_choose(sqlite3 *db, struct error *error) {
  return sql_executef(db, "choosing runs", error,
                      "CREATE TEMP TABLE chosen_point_total AS %s; CREATE TEMP TABLE chosen_point_spectrum AS %s; "
                      "CREATE TEMP TABLE chosen_point_estimate AS SELECT * FROM main.point_estimate WHERE false",
                      all_totals, all_bins);
}

/* Integers must agree; a sum of masses in another order agrees to n units in the last place, with n runs below 1e6. */
status sums_mismatches(sqlite3 *db, int64_t *count, struct error *error) {
  return sql_integerf(
      db, count, error,
      "SELECT (SELECT count(*) FROM (%s) a FULL JOIN point_total b USING (point_id, results_version) WHERE (a.runs, "
      "a.censored, a.failed, a.surplus, a.fragments) IS NOT (b.runs, b.censored, b.failed, b.surplus, b.fragments) OR "
      "abs(a.mass - b.mass) > 1e-10 * a.mass) + (SELECT count(*) FROM (%s) a FULL JOIN point_spectrum b USING "
      "(point_id, results_version, bin) WHERE (a.runs, a.count, a.count_squared) IS NOT (b.runs, b.count, "
      "b.count_squared) OR abs(a.mass - b.mass) > 1e-10 * a.mass)",
      all_totals, all_bins);
}

status sums_cover_bins(sqlite3 *db, int64_t lowest, int64_t highest, struct error *error) {
  static const char doing[] = "adding bin edges";
  STATEMENT statement = NULL;
  if (lowest < -SUMS_BINS_LIMIT || highest > SUMS_BINS_LIMIT)
    return status_fail(error, STATUS_CONTENT,
                       "%s: bins %lld to %lld are no bins of masses. The store is damaged: restore a copy.",
                       sqlite3_db_filename(db, "main"), (long long)lowest, (long long)highest);
  TRY(sql_prepare(db, "INSERT OR IGNORE INTO bin (bin, lower, upper) VALUES (?1, ?2, ?3)", &statement, doing, error));
  for (int bin = (int)lowest; bin <= highest; bin++) {
    SQL_BIND(statement, sql_of_integer(bin), sql_of_real(spectrum_edge(bin)), sql_of_real(spectrum_edge(bin + 1)));
    TRY(sql_run(statement, doing, error));
  }
  return STATUS_OK;
}
