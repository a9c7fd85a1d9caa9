/* The rows that follow from a run's fragments: masses, spectrum, and their part of the point's running sums. */
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "engine/grow.h"

static const char adding_run[] = "adding a run";

static bool reserve_blob(struct store *store, size_t size) {
  return grow_room(&store->blob, &store->blob_capacity, size, sizeof *store->blob);
}

static void put_little_endian(uint8_t *place, uint64_t bits) {
  for (int i = 0; i < 8; i++)
    place[i] = (uint8_t)(bits >> 8 * i);
}

status store_fragments_encode(struct store *store, const struct store_run *run, struct error *error) {
  if (!reserve_blob(store, 8 * run->fragment_count + 8))
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
  for (size_t i = 0; i < run->fragment_count; i++) {
    uint64_t bits;
    memcpy(&bits, &run->fragments[i].mass, sizeof bits);
    put_little_endian(store->blob + 8 * i, bits);
  }
  return STATUS_OK;
}

static status add_masses(struct store *store, int64_t run_id, const struct store_run *run, struct error *error) {
  status result = sql_prepare_once(store->db, &store->masses,
                                   "INSERT INTO fragment_mass (run_id, masses) VALUES (?1, ?2)", adding_run, error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_int64(store->masses, 1, run_id);
  sqlite3_bind_blob64(store->masses, 2, store->blob, 8 * run->fragment_count, SQLITE_STATIC);
  return sql_run(store->masses, adding_run, error);
}

/* Fills store->bins with the bins of the run. */
static status fill_bins(struct store *store, size_t *count, const struct store_run *run, struct error *error) {
  double *masses = malloc((run->fragment_count + 1) * sizeof *masses);
  if (!masses)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
  for (size_t i = 0; i < run->fragment_count; i++)
    masses[i] = run->fragments[i].mass;
  *count = spectrum_fill(run->fragment_count, masses, store->bins, store->bin_capacity);
  if (*count > store->bin_capacity) {
    free(store->bins);
    store->bin_capacity = *count + 64;
    store->bins = calloc(store->bin_capacity, sizeof *store->bins);
    if (store->bins)
      *count = spectrum_fill(run->fragment_count, masses, store->bins, store->bin_capacity);
    else
      store->bin_capacity = 0;
  }
  free(masses);
  return store->bins || *count == 0 ? STATUS_OK : status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
}

static status cover_bins(struct store *store, int64_t lowest, int64_t highest, struct error *error) {
  bool none = store->lowest_bin > store->highest_bin;
  if (!none && lowest >= store->lowest_bin && highest <= store->highest_bin)
    return STATUS_OK;
  if (!none && store->lowest_bin < lowest)
    lowest = store->lowest_bin;
  if (!none && store->highest_bin > highest)
    highest = store->highest_bin;
  status result = sums_cover_bins(store->db, lowest, highest, error);
  store->lowest_bin = lowest;
  store->highest_bin = highest;
  return result;
}

enum { TOGETHER = 10 }; /* rows per INSERT: starting a statement costs as much as inserting three rows */

static void bind_bin(sqlite3_stmt *statement, int index, int64_t run_id, const struct spectrum_bin_row *bin) {
  sqlite3_bind_int64(statement, index, run_id);
  sqlite3_bind_int(statement, index + 1, bin->bin);
  sqlite3_bind_int64(statement, index + 2, bin->count);
  sqlite3_bind_double(statement, index + 3, bin->mass);
}

static status insert_bins(struct store *store, int64_t run_id, size_t count, struct error *error) {
#define INSERT_SPECTRUM "INSERT INTO spectrum (run_id, bin, count, mass) VALUES (?, ?, ?, ?)"
#define TWO_MORE        ", (?, ?, ?, ?), (?, ?, ?, ?)"
  status result = sql_prepare_once(store->db, &store->spectrum, INSERT_SPECTRUM, adding_run, error);
  if (result == STATUS_OK)
    result = sql_prepare_once(store->db, &store->spectrum_together,
                              INSERT_SPECTRUM TWO_MORE TWO_MORE TWO_MORE TWO_MORE ", (?, ?, ?, ?)", adding_run, error);
  size_t i = 0;
  for (; result == STATUS_OK && i + TOGETHER <= count; i += TOGETHER) {
    for (int k = 0; k < TOGETHER; k++)
      bind_bin(store->spectrum_together, 1 + 4 * k, run_id, &store->bins[i + (size_t)k]);
    result = sql_run(store->spectrum_together, adding_run, error);
  }
  for (; result == STATUS_OK && i < count; i++) {
    bind_bin(store->spectrum, 1, run_id, &store->bins[i]);
    result = sql_run(store->spectrum, adding_run, error);
  }
  return result;
}

/* Adds the run to its point's running sums. */
static status add_sums(struct store *store, const struct store_run *run, size_t count, struct error *error) {
  bool counted = store_run_counts(run);
  int version = run->kind->results_version;
  int64_t fragments = 0;
  double mass = 0;
  for (size_t i = 0; counted && i < count; i++) {
    const struct spectrum_bin_row *bin = &store->bins[i];
    struct sums_row *row = sums_at(&store->sums, run->point_id, version, bin->bin);
    if (!row)
      return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
    row->runs++;
    row->count += bin->count;
    row->count_squared += bin->count * bin->count;
    row->mass += bin->mass;
    fragments += bin->count;
    mass += bin->mass;
  }
  struct sums_row *total = sums_at(&store->sums, run->point_id, version, SPECTRUM_NO_BIN);
  if (!total)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
  total->runs += counted;
  total->censored += counted && run->outcome->state == OUTCOME_END_TIME;
  total->surplus += run->surplus;
  total->failed += !counted && !run->surplus;
  total->count += fragments;
  total->mass += mass;
  return STATUS_OK;
}

static status add_spectrum(struct store *store, int64_t run_id, const struct store_run *run, struct error *error) {
  size_t count = 0;
  status result = fill_bins(store, &count, run, error);
  if (result == STATUS_OK && count)
    result = cover_bins(store, store->bins[0].bin, store->bins[count - 1].bin, error);
  if (result == STATUS_OK)
    result = insert_bins(store, run_id, count, error);
  return result == STATUS_OK ? add_sums(store, run, count, error) : result;
}

status store_fragments_add(struct store *store, int64_t run_id, const struct store_run *run, struct error *error) {
  status result = add_masses(store, run_id, run, error);
  return result == STATUS_OK ? add_spectrum(store, run_id, run, error) : result;
}
