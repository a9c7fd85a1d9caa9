/* One flipped bit anywhere in a store: `check` finds it, or no result of a run has changed. CLAST_FULL=1 flips eighty
 * times as many. */
#include <sqlite3.h>

#include "db/store/internal.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

#ifdef __SANITIZE_ADDRESS__ /* SQLite takes long, and what check finds is the same */
enum { FLIPS = 40 };
#else
enum { FLIPS = 250 };
#endif

static struct store_file whole_store(char path[64]) {
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "flips"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 2, 6, false, &error));
  OK(store_close(store, &error));
  return store_file_read(path);
}

/* Columns that depend on the attempt, or that stopping rules change. */
static bool is_of_the_attempt(const char *column) {
  static const char *const names[] = {"session_id",  "surplus", "counts", "attempt", "wall_time",   "cpu_time",
                                      "peak_memory", "host",    "rank",   "digest",  "finished_at", "fields_path"};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
    if (strcmp(column, names[i]) == 0)
      return true;
  return false;
}

static void print_value(FILE *out, sqlite3_stmt *row, int column) {
  switch (sqlite3_column_type(row, column)) {
  case SQLITE_INTEGER: fprintf(out, " %lld", (long long)sqlite3_column_int64(row, column)); break;
  case SQLITE_FLOAT: fprintf(out, " %a", sqlite3_column_double(row, column)); break;
  case SQLITE_NULL: fputs(" null", out); break;
  default: {
    const uint8_t *bytes = sqlite3_column_blob(row, column);
    fprintf(out, " %d:", sqlite3_column_type(row, column));
    for (int i = 0; i < sqlite3_column_bytes(row, column); i++)
      fprintf(out, "%02x", bytes[i]);
  }
  }
}

/* All rows determined by runs, and their points, as text. */
static char *content(const char *path) {
  static const char *const questions[] = {
      "SELECT * FROM run NOT INDEXED ORDER BY run_id",     "SELECT * FROM result_fake ORDER BY run_id",
      "SELECT * FROM fragment_mass ORDER BY run_id",       "SELECT * FROM spectrum ORDER BY run_id, bin",
      "SELECT * FROM estimate ORDER BY run_id, ordinal",   "SELECT * FROM point NOT INDEXED ORDER BY point_id",
      "SELECT * FROM point_input ORDER BY point_id, path",
  };
  char *text = NULL;
  size_t size = 0;
  sqlite3 *db = NULL;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
  for (size_t i = 0; i < sizeof questions / sizeof questions[0]; i++) {
    sqlite3_stmt *rows = NULL;
    if (sqlite3_prepare_v2(db, questions[i], -1, &rows, NULL) != SQLITE_OK)
      fprintf(out, "%s\n", sqlite3_errmsg(db));
    while (sqlite3_step(rows) == SQLITE_ROW) {
      for (int k = 0; k < sqlite3_column_count(rows); k++)
        if (!is_of_the_attempt(sqlite3_column_name(rows, k)))
          print_value(out, rows, k);
      fputc('\n', out);
    }
    sqlite3_finalize(rows);
  }
  sqlite3_close(db);
  fclose(out);
  return text;
}

static bool check_is_content(const char *path) {
  struct store *store = NULL;
  status result = store_open_reader(path, &store, &error);
  if (result == STATUS_OK)
    result = store_check(store, NULL, NULL, &error);
  store_close(store, NULL);
  return result == STATUS_OK;
}

TEST(every_flipped_bit_is_found) {
  char path[64];
  struct store_file file = whole_store(path);
  OWNED char *whole = content(path);
  const int flips = getenv("CLAST_FULL") ? 80 * FLIPS : FLIPS;
  int missed = 0, harmless = 0;
  assert_true(check_is_content(path));
  for (int k = 0; k < flips; k++) {
    const size_t at = (size_t)(fixture_random(77, (uint64_t)k) * (double)file.size);
    const uint8_t bit = (uint8_t)(1 << (int)(8 * fixture_random(78, (uint64_t)k)));
    file.bytes[at] ^= bit;
    store_file_write(path, &file);
    if (check_is_content(path)) {
      OWNED char *text = content(path);
      const bool same = strcmp(text, whole) == 0;
      if (!same)
        print_error("bit %d of byte %zu changes a run, and check finds nothing\n", bit, at);
      missed += !same;
      harmless += same;
    }
    file.bytes[at] ^= bit;
  }
  print_message("%d of %d flips found; the others changed no run\n", flips - harmless - missed, flips);
  assert_int_equal(missed, 0);
  free(file.bytes);
}

/* The same for the rows alone: SQL changes one bit of each value of a run. */
TEST(every_value_of_a_run_is_found) {
  static const char *const changes[] = {
      "UPDATE run SET largest_fraction = largest_fraction * (1 + 2.3e-16) WHERE run_id = 3",
      "UPDATE run SET kinetic_energy_share = 0 WHERE run_id = 3",
      "UPDATE run SET steps = steps + 1 WHERE run_id = 3",
      "UPDATE run SET seed = seed + 1 WHERE run_id = 3",
      "UPDATE run SET replicate = replicate + 100 WHERE run_id = 3",
      "UPDATE run SET results_version = 4 WHERE run_id = 3",
      "UPDATE run SET identity = randomblob(16) WHERE run_id = 3",
      "UPDATE run SET digest = randomblob(16) WHERE run_id = 3",
      "UPDATE run SET digest = NULL WHERE run_id = 3",
      "UPDATE result_fake SET hardest = hardest + 1e-12 WHERE run_id = 3",
      "UPDATE estimate SET beta = beta * (1 + 2.3e-16) WHERE run_id = 3 AND ordinal = 0",
      "UPDATE estimate SET ordinal = 7 WHERE run_id = 3 AND ordinal = 1",
      "UPDATE spectrum SET mass = mass * (1 + 2.3e-16) WHERE run_id = 3",
      "UPDATE point SET scene = replace(scene, '100', '101') WHERE point_id = 2",
      "UPDATE point SET scene_name = 'other' WHERE point_id = 2",
      "UPDATE point_input SET value = value * (1 + 2.3e-16) WHERE point_id = 2 AND path = 'material.m'",
  };
  char path[64];
  struct store_file file = whole_store(path);
  for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
    sqlite3 *db = NULL;
    store_file_write(path, &file);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, changes[i], NULL, NULL, NULL) != SQLITE_OK || sqlite3_changes(db) == 0)
      fail_msg("%s: %s", changes[i], sqlite3_errmsg(db));
    sqlite3_close(db);
    if (check_is_content(path))
      fail_msg("not found: %s", changes[i]);
  }
  free(file.bytes);
}

/* A merge takes nothing from a source with a damaged run. */
static void merge_refuses(const char *change) {
  char path[64], target[64];
  struct store_file file = whole_store(path);
  struct store *store = NULL;
  sqlite3 *db = NULL;
  int64_t added = 0, differing = 0;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db, change, NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
  OK(store_open_writer(fixture_path(target, "flips-target"), &store, NULL, 0, &error));
  assert_int_equal(store_merge(store, path, &added, &differing, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "run 7"));
  assert_int_equal(added, 0);
  store_file_write(path, &file);
  OK(store_merge(store, path, &added, &differing, &error));
  assert_int_equal(added, 24);
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));
  free(file.bytes);
}

TEST(merge_refuses_a_damaged_run) {
  merge_refuses("UPDATE run SET time = time * 1.5 WHERE run_id = 7");
  merge_refuses("UPDATE spectrum SET mass = mass * (1 + 2.3e-16) WHERE run_id = 7");
  merge_refuses("UPDATE spectrum SET count = count + 1 WHERE run_id = 7");
  merge_refuses("DELETE FROM spectrum WHERE run_id = 7");
  merge_refuses("INSERT INTO spectrum (run_id, bin, count, mass) VALUES (7, 30, 1, 1000)");
}

TEST(one_damaged_run_is_told_from_whole_ones) {
  char path[64];
  struct store_file file = whole_store(path);
  struct store *store = NULL;
  sqlite3 *db = NULL;
  bool whole = false;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db, "UPDATE run SET time = time * 1.5 WHERE run_id = 7", NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
  OK(store_open_reader(path, &store, &error));
  OK(store_check_run(store, 6, &whole, &error));
  assert_true(whole);
  OK(store_check_run(store, 7, &whole, &error));
  assert_false(whole);
  OK(store_close(store, &error));
  free(file.bytes);
}
