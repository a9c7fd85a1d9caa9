/* check, merge, export, dump. */
#include <sqlite3.h>
#include <sys/stat.h>

#include "db/store/internal.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

static struct store *writer(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  return store;
}

static void populated(char path[64], const char *name, int m, int k, int64_t runs, bool by_replicate) {
  struct store *store = writer(fixture_path(path, name));
  OK(fixture_populate(store, m, k, runs, by_replicate, &error));
  OK(store_close(store, &error));
}

static void line(void *context, const char *text) {
  size_t used = strlen(context);
  snprintf((char *)context + used, 4000 - used, "%s\n", text);
}

TEST(dumps_agree_whatever_the_order) {
  char a[64], b[64];
  populated(a, "dump-a", 2, 2, 10, false);
  populated(b, "dump-b", 2, 2, 10, true);
  char *x = dump(a), *y = dump(b);
  assert_int_equal(strlen(x), 4 * strlen("point  \n") + 40 * strlen("run  \n") + 44 * 64); /* two numbers a line */
  assert_string_equal(x, y);
  free(y);
  /* one bit of one mass: found; a surplus run more: not found */
  struct store *store = writer(b);
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  struct fixture_run f;
  fixture_fill(&f, &scene, 1, 0, 99, 10);
  f.run.surplus = true;
  OK(store_add_run(store, &f.run, &error));
  OK(store_close(store, &error));
  y = dump(b);
  assert_string_equal(x, y);
  free(y);
  store = writer(b);
  assert_int_equal(sqlite3_exec(store->db,
                                "UPDATE run SET largest_fraction = largest_fraction + 1e-16 WHERE run_id = 7", NULL,
                                NULL, NULL),
                   SQLITE_OK);
  OK(store_close(store, &error));
  y = dump(b);
  assert_string_not_equal(x, y);
  free(x);
  free(y);
}

TEST(points_view_has_the_same_bits) {
  char a[64], b[64];
  populated(a, "bits-a", 2, 2, 40, false);
  populated(b, "bits-b", 2, 2, 40, true);
  struct store *one = NULL, *two = NULL;
  OK(store_open_reader(a, &one, &error));
  OK(store_open_reader(b, &two, &error));
  for (int m = 6; m < 8; m++) {
    char sql[200];
    snprintf(sql, sizeof sql, "SELECT mean_fragment_mass_sd FROM points WHERE material_m = %d AND material_k = 1e31",
             m);
    assert_true(number(one, sql) == number(two, sql));
  }
  store_close(one, NULL);
  store_close(two, NULL);
}

TEST(merge_takes_what_is_missing) {
  char a[64], b[64], whole[64];
  int64_t added = 0, differing = -1;
  populated(a, "merge-a", 1, 2, 12, false); /* m = 6 only, 12 replicates */
  populated(b, "merge-b", 2, 2, 10, true);  /* m = 6 and 7, 10 replicates: 20 of them shared */
  struct store *store = writer(a);
  OK(store_merge(store, b, &added, &differing, &error));
  assert_int_equal(added, 20);
  assert_int_equal(differing, 0);
  OK(store_merge(store, b, &added, &differing, &error));
  assert_int_equal(added, 0);
  assert_near(number(store, "SELECT count(*) FROM run"), 44, 0);
  assert_near(number(store, "SELECT count(*) FROM point"), 4, 0);
  assert_near(number(store, "SELECT count(*) FROM estimate"), 88, 0);
  assert_near(number(store, "SELECT count(*) FROM session"), 2, 0);
  assert_near(number(store, "SELECT count(*) FROM campaign"), 1, 0);
  char problem[4000] = "";
  if (store_check(store, line, problem, &error) != STATUS_OK)
    fail_msg("%s: %s", error.message, problem);
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 7, 1e31);
  uint8_t identity[16];
  scene_identity(&scene, 1003, identity);
  assert_true(store_has_run(store, identity));          /* also at once in memory */
  OK(fixture_populate(store, 2, 2, 12, false, &error)); /* the writer goes on */
  OK(store_close(store, &error));
  populated(whole, "merge-whole", 2, 2, 12, false);
  char *x = dump(a), *y = dump(whole);
  assert_string_equal(x, y);
  free(x);
  free(y);
  /* a run whose masses differ by one bit is counted, and the target's version is kept */
  sqlite3 *other = NULL;
  assert_int_equal(sqlite3_open(b, &other), SQLITE_OK);
  assert_int_equal(
      sqlite3_exec(other,
                   "UPDATE fragment_mass SET masses = CAST(substr(masses, 1, length(masses) - 1) || x'7f' AS BLOB) "
                   "WHERE run_id = 3",
                   NULL, NULL, NULL),
      SQLITE_OK);
  sqlite3_close(other);
  store = writer(b);
  fill_digest(store->db, 3); /* as if another machine had computed it with this result */
  OK(store_close(store, &error));
  store = writer(a);
  OK(store_merge(store, b, &added, &differing, &error));
  assert_int_equal(added, 0);
  assert_int_equal(differing, 1);
  OK(store_close(store, &error));
  x = dump(a);
  y = dump(whole);
  assert_string_equal(x, y);
  free(x);
  free(y);
  store = writer(a);
  assert_int_equal(store_merge(store, "nothing-here.db", &added, &differing, &error), STATUS_MISSING);
  OK(store_close(store, &error));
}

/* Runs of both stores: their fields file is taken only if ours cannot be read and theirs can; its path then leads from
 * our folder to theirs. */
TEST(merge_takes_paths_of_fields) {
  enum { RUNS = 6 };
  static const char *const ours[RUNS] = {"paths-ours.h5", NULL, "paths-lost.h5", "paths-ours.h5", NULL, NULL};
  static const char *const theirs[RUNS] = {"theirs.h5", "theirs.h5", "theirs.h5", "lost.h5", "lost.h5", NULL};
  static const char *const after[RUNS] =
      {"paths-ours.h5", "paths-folder/theirs.h5", "paths-folder/theirs.h5", "paths-ours.h5", "", ""};
  static const char theirs_path[] = "paths-folder/theirs.db";
  char a[64], b[64];
  populated(a, "paths-a", 1, 1, RUNS, false);
  populated(b, "paths-b", 1, 1, RUNS + 1, false); /* one run that is not ours */
  mkdir("paths-folder", 0777);
  unlink(theirs_path);
  assert_int_equal(rename(b, theirs_path), 0);
  fclose(fopen("paths-ours.h5", "w"));
  fclose(fopen("paths-folder/theirs.h5", "w"));
  for (int side = 0; side < 2; side++) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(side ? theirs_path : a, &db), SQLITE_OK);
    for (int r = 0; r < RUNS + side; r++) {
      char *sql = sqlite3_mprintf("UPDATE run SET fields_path = %Q WHERE replicate = %d",
                                  r == RUNS ? "theirs.h5"
                                  : side    ? theirs[r]
                                            : ours[r],
                                  r);
      assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
      sqlite3_free(sql);
    }
    sqlite3_close(db);
  }
  struct store *store = writer(a);
  int64_t added = 0, differing = -1;
  OK(store_merge(store, theirs_path, &added, &differing, &error));
  assert_true(added == 1 && differing == 0);
  for (int r = 0; r < RUNS + 1; r++) {
    char sql[200];
    snprintf(sql, sizeof sql, "SELECT count(*) FROM run WHERE replicate = %d AND ifnull(fields_path, '') = '%s'", r,
             r == RUNS ? "paths-folder/theirs.h5" : after[r]);
    if (number(store, sql) != 1)
      fail_msg("replicate %d: not the expected fields file", r);
  }
  OK(store_close(store, &error));
}

/* A store of one point: replicates from .. to - 1 with a few fragments, and a failed attempt of the first of them. */
static void one_point(const char *path, int64_t from, int64_t to) {
  struct fixture_inputs inputs;
  struct fixture_run f;
  int64_t point, session;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  struct store *store = writer(path);
  OK(store_begin_session(store, "{}", &session, &error));
  OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
  for (int64_t r = from; r < to; r++) {
    fixture_fill(&f, &scene, point, session, r, 4);
    if (r == from) {
      struct store_attempt attempt = {.point_id = point,
                                      .session_id = session,
                                      .replicate = r,
                                      .seed = f.run.seed,
                                      .attempt = 1,
                                      .reason = "crash",
                                      .signal = 11};
      memcpy(attempt.identity, f.run.identity, 16);
      OK(store_add_attempt(store, &attempt, &error));
    }
    OK(store_add_run(store, &f.run, &error));
  }
  OK(store_close(store, &error));
}

/* No batch, limit or page of merge is visible in what it adds, and nothing is added twice. */
TEST(merge_takes_any_number_of_runs) {
  static const int64_t counts[] = {1, 1000, 1001, 2001};
  char target[64], source[64], whole[64];
  for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
    int64_t added = 0, differing = -1;
    one_point(fixture_path(target, "many-target"), 0, 3);
    one_point(fixture_path(source, "many-source"), 2, 2 + counts[i]);
    one_point(fixture_path(whole, "many-whole"), 0, 2 + counts[i]);
    struct store *store = writer(target);
    for (int again = 0; again < 2; again++) {
      OK(store_merge(store, source, &added, &differing, &error));
      assert_int_equal(added, again ? 0 : counts[i] - 1); /* one run is in both */
      assert_int_equal(differing, 0);
      assert_near(number(store, "SELECT count(*) FROM run"), (double)(2 + counts[i]), 0);
      assert_near(number(store, "SELECT sum(runs) FROM point_total"), (double)(2 + counts[i]), 0);
      assert_near(number(store, "SELECT count(*) FROM attempt"), 2, 0); /* one of each store */
      assert_near(number(store, "SELECT count(*) FROM session"), 2, 0);
    }
    char problem[4000] = "";
    if (store_check(store, line, problem, &error) != STATUS_OK)
      fail_msg("%s", problem);
    OK(store_close(store, &error));
    OWNED char *x = dump(target), *y = dump(whole);
    assert_string_equal(x, y);
  }
}

TEST(check_finds) {
  static const struct {
    const char *damage, *word;
  } faults[] = {
      {"UPDATE point_spectrum SET count = count + 1 WHERE bin = -15", "running sums"},
      {"UPDATE point_total SET mass = mass * 1.000001", "running sums"},
      {"UPDATE spectrum SET count = count + 1 WHERE run_id = 3 AND bin = (SELECT max(bin) FROM spectrum)", "spectrum"},
      {"DELETE FROM fragment_mass WHERE run_id = 5", "run 5 has no fragment masses"},
      {"DELETE FROM result_fake WHERE run_id = 5", "run 5 has no row in result_fake"},
      {"UPDATE run SET total_mass = total_mass * 1.00001 WHERE run_id = 2", "run 2: its masses sum to"},
      {"UPDATE run SET fields_path = 'not-there.h5' WHERE run_id = 2", "not-there.h5"},
      {"UPDATE run SET point_id = 77 WHERE run_id = 4", "foreign key"},
      {"UPDATE fragment_mass SET masses = substr(masses, 9) WHERE run_id = 6", "run 6"},
      {"DELETE FROM bin WHERE bin = -15", "bin -15"},
      {"UPDATE point_total SET runs = runs + 1 WHERE point_id = 2", "running sums: 1 rows"},
      {"UPDATE point_total SET censored = censored + 1 WHERE point_id = 2", "running sums: 1 rows"},
      {"UPDATE point_total SET failed = failed + 1 WHERE point_id = 2", "running sums: 1 rows"},
      {"UPDATE point_total SET surplus = surplus + 1 WHERE point_id = 2", "running sums: 1 rows"},
      {"UPDATE point_total SET fragments = fragments + 1 WHERE point_id = 2", "running sums: 1 rows"},
      {"DELETE FROM point_total WHERE point_id = 2", "running sums: 1 rows"},
      {"UPDATE point_spectrum SET runs = runs + 1 WHERE point_id = 2 AND bin = -15", "running sums: 1 rows"},
      {"UPDATE point_spectrum SET count_squared = count_squared + 1 WHERE point_id = 2 AND bin = -15",
       "running sums: 1 rows"},
      {"UPDATE point_spectrum SET mass = mass * 1.000001 WHERE point_id = 2 AND bin = -15", "running sums: 1 rows"},
      {"UPDATE spectrum SET mass = mass * (1 + 1e-15) WHERE run_id = 3 AND bin = -15", "run 3: its spectrum"},
      {"DELETE FROM spectrum WHERE run_id = 3 AND bin = (SELECT max(bin) FROM spectrum WHERE run_id = 3)",
       "run 3: its spectrum"},
      {"UPDATE run SET fragment_count = fragment_count + 1 WHERE run_id = 2",
       "run 2: 60.0 masses, but fragment_count is 61"},
      {"UPDATE fragment_mass SET masses = CAST(substr(masses, 9, 8) || substr(masses, 1, 8) || substr(masses, 17) AS "
       "BLOB) WHERE run_id = 3",
       "run 3: its masses are not in descending order"},
      {"UPDATE fragment_mass SET masses = CAST(substr(masses, 1, 479) AS BLOB) WHERE run_id = 3",
       "run 3: its masses are not a list of float64"},
      {"UPDATE run SET largest_fraction = largest_fraction * (1 + 1e-15) WHERE run_id = 7",
       "run 7: a bit of its results"},
      {"UPDATE result_fake SET hardest = hardest + 1 WHERE run_id = 7", "run 7: a bit of its results"},
      {"UPDATE estimate SET beta = beta * (1 + 1e-15) WHERE run_id = 4 AND beta IS NOT NULL",
       "run 4: a bit of its results"},
      {"UPDATE run SET seed = seed + 1000 WHERE run_id = 7", "run 7: a bit of its results"},
      {"UPDATE point_input SET value = 7 WHERE point_id = 2 AND path = 'material.m'", "point 2: a bit of its scene"},
      {"DELETE FROM point_input WHERE point_id = 2", "point 2 has no inputs"},
      {"PRAGMA ignore_check_constraints = ON; UPDATE point SET scene = '{' WHERE point_id = 2",
       "point 2: its scene is no JSON"},
      {"PRAGMA ignore_check_constraints = ON; UPDATE session SET facts = '{'", "session 1: its facts are no JSON"},
  };
  char path[64], whole[64], command[200], problem[4000] = "";
  struct store *store = NULL;
  populated(whole, "check-whole", 1, 2, 5, false);
  OK(store_open_reader(whole, &store, &error));
  if (store_check(store, line, problem, &error) != STATUS_OK)
    fail_msg("a whole store: %s", problem);
  store_close(store, NULL);
  for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
    snprintf(command, sizeof command, "cp %s %s", whole, fixture_path(path, "check"));
    assert_int_equal(system(command), 0);
    sqlite3 *db;
    sqlite3_open(path, &db);
    assert_int_equal(sqlite3_exec(db, faults[i].damage, NULL, NULL, NULL), SQLITE_OK);
    assert_true(sqlite3_changes(db) > 0);
    sqlite3_close(db);
    OK(store_open_reader(path, &store, &error));
    problem[0] = 0;
    assert_int_equal(store_check(store, line, problem, &error), STATUS_CONTENT);
    if (!strstr(problem, faults[i].word))
      fail_msg("%s: said '%s'", faults[i].damage, problem);
    store_close(store, NULL);
  }
}

TEST(export_is_whole_and_single) {
  char path[64], copy[96];
  populated(path, "export", 1, 1, 5, false);
  snprintf(copy, sizeof copy, "%s.out", path);
  struct store *store = NULL;
  OK(store_open_reader(path, &store, &error));
  OK(store_export(store, copy, &error));
  assert_int_equal(store_export(store, copy, &error), STATUS_IO);
  assert_int_equal(store_export(store, "no-such-folder/x.db", &error), STATUS_IO);
  assert_int_equal(sqlite3_exec(store->db, "DELETE FROM run", NULL, NULL, NULL), SQLITE_READONLY);
  store_close(store, NULL);
  OWNED char *x = dump(path), *y = dump(copy);
  assert_string_equal(x, y);
  fixture_path(path, "export"); /* removes both files */
}
