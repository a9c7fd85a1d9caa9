#include "db/store/sums.h"

#include <stdlib.h>
#include <string.h>

static uint64_t mix(int64_t point_id, int results_version, int bin) { /* finaliser of splitmix64 */
  uint64_t x = (uint64_t)point_id * 0x9e3779b97f4a7c15u + ((uint64_t)(uint32_t)results_version << 32 | (uint32_t)bin);
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

static size_t place(const struct sums_row *slots, size_t capacity, int64_t point_id, int results_version, int bin) {
  size_t at = (size_t)mix(point_id, results_version, bin) & (capacity - 1);
  while (slots[at].used &&
         !(slots[at].point_id == point_id && slots[at].results_version == results_version && slots[at].bin == bin))
    at = (at + 1) & (capacity - 1);
  return at;
}

static bool grow(struct sums *sums) {
  size_t capacity = sums->capacity ? 2 * sums->capacity : 4096;
  struct sums_row *slots = calloc(capacity, sizeof *slots);
  if (!slots)
    return false;
  for (size_t i = 0; i < sums->capacity; i++) {
    const struct sums_row *row = &sums->slots[i];
    if (row->used)
      slots[place(slots, capacity, row->point_id, row->results_version, row->bin)] = *row;
  }
  free(sums->slots);
  sums->slots = slots;
  sums->capacity = capacity;
  return true;
}

struct sums_row *sums_at(struct sums *sums, int64_t point_id, int results_version, int bin) {
  if (2 * (sums->count + 1) > sums->capacity && !grow(sums))
    return NULL;
  struct sums_row *row = &sums->slots[place(sums->slots, sums->capacity, point_id, results_version, bin)];
  if (!row->used) {
    *row = (struct sums_row){.point_id = point_id, .results_version = results_version, .bin = bin, .used = true};
    sums->count++;
  }
  return row;
}

static int by_key(const void *a, const void *b) {
  const struct sums_row *x = a, *y = b;
  if (x->point_id != y->point_id)
    return x->point_id < y->point_id ? -1 : 1;
  if (x->results_version != y->results_version)
    return x->results_version < y->results_version ? -1 : 1;
  return x->bin < y->bin ? -1 : x->bin > y->bin;
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
  if (result == STATUS_OK) /* what was pooled before these runs came is stale */
    result = sql_prepare(db, "DELETE FROM point_estimate WHERE point_id = ?1 AND results_version = ?2", &sums->stale,
                         "keeping pooled estimates", error);
  return result;
}

static sqlite3_stmt *bind(struct sums *sums, const struct sums_row *row) {
  bool total = row->bin == SPECTRUM_NO_BIN;
  sqlite3_stmt *statement = total ? sums->total : sums->bin;
  sqlite3_bind_int64(statement, 1, row->point_id);
  sqlite3_bind_int(statement, 2, row->results_version);
  if (total) {
    sqlite3_bind_int64(statement, 3, row->runs);
    sqlite3_bind_int64(statement, 4, row->censored);
    sqlite3_bind_int64(statement, 5, row->failed);
    sqlite3_bind_int64(statement, 6, row->surplus);
    sqlite3_bind_int64(statement, 7, row->count);
    sqlite3_bind_double(statement, 8, row->mass);
  } else {
    sqlite3_bind_int(statement, 3, row->bin);
    sqlite3_bind_int64(statement, 4, row->runs);
    sqlite3_bind_int64(statement, 5, row->count);
    sqlite3_bind_int64(statement, 6, row->count_squared);
    sqlite3_bind_double(statement, 7, row->mass);
  }
  return statement;
}

status sums_write(struct sums *sums, sqlite3 *db, struct error *error) {
  if (sums->count == 0)
    return STATUS_OK;
  status result = prepare(sums, db, error);
  for (size_t i = 0, used = 0; i < sums->capacity; i++) /* the table is not searched again before it is emptied */
    if (sums->slots[i].used)
      sums->slots[used++] = sums->slots[i];
  qsort(sums->slots, sums->count, sizeof *sums->slots, by_key);
  for (size_t i = 0; result == STATUS_OK && i < sums->count; i++) {
    const struct sums_row *row = &sums->slots[i];
    result = sql_run(bind(sums, row), "keeping running sums", error);
    if (result == STATUS_OK && row->bin == SPECTRUM_NO_BIN) {
      sqlite3_bind_int64(sums->stale, 1, row->point_id);
      sqlite3_bind_int(sums->stale, 2, row->results_version);
      result = sql_run(sums->stale, "keeping pooled estimates", error);
    }
  }
  sums_forget(sums);
  return result;
}

void sums_forget(struct sums *sums) {
  if (sums->slots)
    memset(sums->slots, 0, sums->capacity * sizeof *sums->slots);
  sums->count = 0;
}

void sums_clear(struct sums *sums) {
  sqlite3_finalize(sums->total);
  sqlite3_finalize(sums->bin);
  sqlite3_finalize(sums->stale);
  free(sums->slots);
  *sums = (struct sums){0};
}

#define TOTALS                                                                                                         \
  "SELECT point_id, results_version, sum(counts) AS runs, sum(counts AND state = 'end-time') AS censored, "            \
  "sum(surplus = 0 AND counts = 0) AS failed, sum(surplus) AS surplus, sum(iif(counts, fragments, 0)) AS fragments, "  \
  "total(iif(counts, mass, 0)) AS mass FROM (SELECT r.point_id, r.results_version, r.counts, r.state, r.surplus, "     \
  "ifnull((SELECT sum(count) FROM spectrum s WHERE s.run_id = r.run_id), 0) AS fragments, (SELECT total(mass) FROM "   \
  "spectrum s WHERE s.run_id = r.run_id) AS mass FROM run r%s) GROUP BY point_id, results_version"
#define BINS                                                                                                           \
  "SELECT r.point_id, r.results_version, s.bin, count(*) AS runs, sum(s.count) AS count, sum(s.count * s.count) AS "   \
  "count_squared, total(s.mass) AS mass FROM run r JOIN spectrum s ON s.run_id = r.run_id WHERE r.counts = 1%s GROUP " \
  "BY r.point_id, r.results_version, s.bin"

status sums_rebuild(sqlite3 *db, int64_t point_id, struct error *error) {
  char here[64] = "", total[64] = "", bins[64] = "";
  if (point_id) {
    snprintf(here, sizeof here, " WHERE point_id = %lld", (long long)point_id);
    snprintf(total, sizeof total, " WHERE r.point_id = %lld", (long long)point_id);
    snprintf(bins, sizeof bins, " AND r.point_id = %lld", (long long)point_id);
  }
  return sql_executef(
      db, "making running sums", error,
      "DELETE FROM point_total%s; DELETE FROM point_spectrum%s; DELETE FROM point_estimate%s;"
      "INSERT INTO point_total (point_id, results_version, runs, censored, failed, surplus, fragments, "
      "mass) " TOTALS ";"
      "INSERT INTO point_spectrum (point_id, results_version, bin, runs, count, count_squared, mass) " BINS,
      here, here, here, total, bins);
}

/* Integers must agree; a sum of masses in another order agrees to n units in the last place, with n runs below 1e6. */
status sums_mismatches(sqlite3 *db, int64_t *count, struct error *error) {
  char *sql = sqlite3_mprintf(
      "SELECT (SELECT count(*) FROM (" TOTALS
      ") a FULL JOIN point_total b USING (point_id, results_version) WHERE (a.runs, "
      "a.censored, a.failed, a.surplus, a.fragments) IS NOT (b.runs, b.censored, b.failed, b.surplus, b.fragments) OR "
      "abs(a.mass - b.mass) > 1e-10 * a.mass) + (SELECT count(*) FROM (" BINS ") a FULL JOIN point_spectrum b USING "
      "(point_id, results_version, bin) WHERE (a.runs, a.count, a.count_squared) IS NOT (b.runs, b.count, "
      "b.count_squared) OR abs(a.mass - b.mass) > 1e-10 * a.mass)",
      "", "");
  if (!sql)
    return status_fail(error, STATUS_MEMORY, "checking running sums: memory ran out");
  status result = sql_integer(db, sql, 0, count, error);
  sqlite3_free(sql);
  return result;
}
