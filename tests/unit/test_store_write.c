/* Writing and reading back: every column, blobs, running sums, batches, identities, surplus, views. */
#include <sqlite3.h>

#include "analysis/statistics/statistics.h"
#include "db/store/internal.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

static struct store *writer(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  return store;
}

TEST(every_value_comes_back) {
  char path[64];
  struct store *store = writer(fixture_path(path, "values"));
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 9, 1e33);
  struct fixture_run f;
  int64_t campaign, session, point;
  OK(store_add_campaign(store, "c", "text", "{}", &campaign, &error));
  OK(store_begin_session(store, "{\"a\":1}", &session, &error));
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, &point, &error));
  fixture_fill(&f, &scene, point, session, 4, 5);
  f.run.fields_path = "fields/4.h5";
  f.run.rank = 2;
  f.run.seed = UINT64_MAX;
  const double lengths[2][3] = {{0.3, 0.2, 0.1}, {0.2, 0.2, 0.1}}; /* of the second fragment and the fourth of five */
  memcpy(f.fragments[1].length, lengths[0], sizeof lengths[0]);
  memcpy(f.fragments[3].length, lengths[1], sizeof lengths[1]);
  OK(store_add_run(store, &f.run, &error));
  OK(store_flush(store, &error));
  assert_near(number(store, "SELECT total_mass FROM run"), f.outcome.total_mass, 0);
  assert_near(number(store, "SELECT steps FROM run"), 1004, 0);
  assert_near(number(store, "SELECT kinetic_energy_share IS NULL FROM run"), 1, 0);
  assert_near(number(store, "SELECT seed = -1 AND rank = 2 AND fields_path = 'fields/4.h5' AND state = 'completed' "
                            "AND host = 'testhost' AND attempt = 1 AND results_version = 3 FROM run"),
              1, 0);
  assert_near(number(store, "SELECT broken_count = 12 AND hardest = 2.0 FROM result_fake"), 1, 0);
  assert_near(number(store, "SELECT length(masses) FROM fragment_mass"), 40, 0);
  assert_near(number(store, "SELECT count(*) FROM estimate WHERE run_id = 1"), 2, 0);
  assert_near(number(store, "SELECT beta FROM estimates WHERE \"window\" = 'from_2'"), 1.54, 1e-15);
  assert_near(number(store, "SELECT beta IS NULL FROM estimates WHERE \"window\" = 'from_5'"), 1, 0);
  assert_near(number(store, "SELECT value FROM point_input WHERE path = 'material.k'"), 1e33, 0);
  assert_near(number(store, "SELECT value = 'off' FROM point_input WHERE path = 'material.threshold'"), 1, 0);
  assert_near(number(store, "SELECT count(*) FROM point_input WHERE path = 'depth'"), 0, 0); /* inactive */
  assert_near(number(store, "SELECT material_m = 9 AND material_k = 1e33 FROM runs"), 1, 0);
  assert_near(number(store, "SELECT json_extract(scene, '$.material.m') FROM point"), 9, 0);
  assert_near(number(store, "SELECT count(*) FROM campaign_point"), 1, 0);

  /* masses: little-endian float64, descending */
  sqlite3_stmt *statement;
  sqlite3_prepare_v2(store->db, "SELECT masses, lengths FROM fragment_mass", -1, &statement, NULL);
  assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
  const double stored[4][3] = {{0}, {0.3, 0.2, 0.1}, {0}, {0.2, 0.2, 0.1}};
  assert_int_equal(sqlite3_column_bytes(statement, 1), sizeof stored);
  assert_memory_equal(sqlite3_column_blob(statement, 1), stored, sizeof stored);
  double masses[5];
  memcpy(masses, sqlite3_column_blob(statement, 0), sizeof masses);
  for (int i = 0; i < 5; i++)
    assert_true(masses[i] == f.fragments[i].mass);
  sqlite3_finalize(statement);
  OK(store_close(store, &error));
}

/* In a graded body thousands of coarse single particles can be heavier than the lightest fragment that is measured. */
TEST(lengths_behind_many_fragments) {
  enum { MANY = 5000 };
  static struct fragment fragments[MANY];
  struct fixture_run f;
  char path[64];
  struct store *store = writer(fixture_path(path, "lengths"));
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 9, 1e33);
  int64_t campaign, session, point;
  OK(store_add_campaign(store, "c", "text", "{}", &campaign, &error));
  OK(store_begin_session(store, "{}", &session, &error));
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, &point, &error));
  fixture_fill(&f, &scene, point, session, 1, 5);
  for (size_t i = 0; i < MANY; i++)
    fragments[i] = (struct fragment){.mass = 1, .count = 1};
  fragments[MANY - 1].length[0] = 3;
  f.run.fragments = fragments;
  f.run.fragment_count = MANY;
  OK(store_add_run(store, &f.run, &error));
  OK(store_flush(store, &error));
  assert_near(number(store, "SELECT length(lengths) FROM fragment_mass"), MANY * 24, 0);
  OK(store_close(store, &error));
}

TEST(same_run_is_stored_once) {
  char path[64];
  struct store *store = writer(fixture_path(path, "once"));
  OK(fixture_populate(store, 1, 1, 20, false, &error));
  OK(fixture_populate(store, 1, 1, 20, false, &error));
  assert_near(number(store, "SELECT count(*) FROM run"), 20, 0);
  assert_near(number(store, "SELECT count(*) FROM point"), 1, 0);
  assert_near(number(store, "SELECT count(*) FROM campaign"), 1, 0);
  assert_near(number(store, "SELECT runs FROM point_total"), 20, 0);
  OK(store_close(store, &error));
  store = writer(path);
  OK(fixture_populate(store, 1, 1, 25, false, &error)); /* resumed: identities come from the file */
  assert_near(number(store, "SELECT count(*) FROM run"), 25, 0);
  OK(store_close(store, &error));
}

TEST(a_full_disk_takes_no_campaign) {
  char path[64];
  static char document[1 << 20];
  struct store *store = writer(fixture_path(path, "full"));
  int64_t campaign;
  memset(document, '#', sizeof document - 1);
  sqlite3_exec(store->db, "PRAGMA max_page_count = 1", NULL, NULL, NULL); /* = as many as there are */
  assert_int_equal(store_add_campaign(store, "c", document, "{}", &campaign, &error), STATUS_IO);
  store_close(store, NULL);
}

TEST(batches_commit_by_count_and_close) {
  char path[64];
  struct store *store = writer(fixture_path(path, "batch")), *reader = NULL;
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  struct fixture_run f;
  int64_t point;
  OK(store_add_point(store, 0, &scene, 0, NULL, &point, &error));
  OK(store_flush(store, &error));
  OK(store_open_reader(path, &reader, &error));
  for (int r = 0; r < 499; r++) {
    fixture_fill(&f, &scene, point, 0, r, 3);
    OK(store_add_run(store, &f.run, &error));
  }
  double seen = number(reader, "SELECT count(*) FROM run");
  assert_near(seen, 0, 0);
  fixture_fill(&f, &scene, point, 0, 499, 3);
  OK(store_add_run(store, &f.run, &error));
  assert_near(number(reader, "SELECT count(*) FROM run"), 500, 0);
  fixture_fill(&f, &scene, point, 0, 500, 3);
  OK(store_add_run(store, &f.run, &error));
  assert_near(number(reader, "SELECT count(*) FROM run"), 500, 0);
  usleep(1050000); /* a batch is at most 1 s old */
  OK(store_tick(store, &error));
  assert_near(number(reader, "SELECT count(*) FROM run"), 501, 0);
  OK(store_close(reader, &error));
  fixture_fill(&f, &scene, point, 0, 501, 3);
  OK(store_add_run(store, &f.run, &error));
  OK(store_close(store, &error));
  OK(store_open_reader(path, &reader, &error));
  assert_near(number(reader, "SELECT count(*) FROM run"), 502, 0);
  assert_near(number(reader, "SELECT count(*) FROM holder"), 0, 0);
  OK(store_close(reader, &error));
  char log[80];
  snprintf(log, sizeof log, "%s-wal", path);
  assert_int_not_equal(access(log, F_OK), 0); /* a clean end leaves one file */
}

TEST(sums_are_those_of_the_rows) {
  char path[64];
  struct store *store = writer(fixture_path(path, "sums"));
  OK(fixture_populate(store, 2, 3, 30, true, &error));
  static const char different[] =
      "SELECT count(*) FROM (SELECT r.point_id, s.bin, count(*) AS runs, sum(s.count) AS n, sum(s.count * s.count) AS "
      "q "
      "FROM run r JOIN spectrum s USING (run_id) WHERE r.counts GROUP BY 1, 2) a FULL JOIN point_spectrum b ON "
      "a.point_id "
      "= b.point_id AND a.bin = b.bin WHERE (a.runs, a.n, a.q) IS NOT (b.runs, b.count, b.count_squared)";
  assert_near(number(store, different), 0, 0);
  assert_near(number(store, "SELECT sum(fragments) FROM point_total"), 6 * 30 * FIXTURE_FRAGMENTS, 0);
  /* a stopping prefix leaves replicates out, and includes them again */
  OK(store_set_prefix(store, 2, 12, &error));
  assert_near(number(store, "SELECT runs = 12 AND surplus = 18 FROM point_total WHERE point_id = 2"), 1, 0);
  assert_near(number(store, different), 0, 0);
  assert_near(number(store, "SELECT n = 12 AND surplus = 18 FROM points WHERE point_id = 2"), 1, 0);
  OK(store_set_prefix(store, 2, 20, &error));
  assert_near(number(store, "SELECT n = 20 AND surplus = 10 FROM points WHERE point_id = 2"), 1, 0);
  assert_near(number(store, different), 0, 0);
  OK(store_close(store, &error));
}

TEST(failed_and_censored_are_counted_apart) {
  char path[64];
  struct store *store = writer(fixture_path(path, "failed"));
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  struct fixture_run f;
  int64_t point;
  OK(store_add_point(store, 0, &scene, 1, fixture_axes, &point, &error));
  for (int r = 0; r < 10; r++) {
    fixture_fill(&f, &scene, point, 0, r < 9 ? r : 10, 4);
    if (r == 3)
      f.outcome.state = OUTCOME_NOT_FINITE;
    if (r == 4 || r == 5)
      f.outcome.state = OUTCOME_END_TIME;
    if (r == 9)
      f.run.surplus = true;
    OK(store_add_run(store, &f.run, &error));
  }
  OK(store_flush(store, &error));
  assert_near(number(store, "SELECT n = 8 AND failed = 1 AND censored = 2 AND surplus = 1 FROM points"), 1, 0);
  assert_near(number(store, "SELECT sum(counts) FROM run"), 8, 0);
  assert_near(number(store, "SELECT sum(count) FROM point_spectrum"), 32, 0);
  struct store_attempt attempt = {.point_id = point,
                                  .replicate = 20,
                                  .seed = 5,
                                  .identity = {7},
                                  .attempt = 1,
                                  .reason = "time_limit",
                                  .limit = 10,
                                  .message = "too long"};
  OK(store_add_attempt(store, &attempt, &error));
  attempt.reason = "crash";
  attempt.signal = 11;
  OK(store_add_attempt(store, &attempt, &error));
  assert_int_equal(store_attempts(store, attempt.identity, 10, 0), 2);
  assert_int_equal(store_attempts(store, attempt.identity, 20, 0), 1); /* a raised limit */
  assert_int_equal(store_attempts(store, attempt.identity, 0, 0), 1);  /* no limit now */
  assert_int_equal(store_attempts(store, f.run.identity, 10, 0), 0);
  assert_near(number(store, "SELECT json_valid('{}') AND NOT json_valid('{') AND json_valid(NULL) IS NULL"), 1, 0);
  struct store_attempt died = {.point_id = point, .replicate = 6, .seed = 77, .identity = {9}, .reason = "lost"};
  OK(store_add_attempt(store, &died, &error));
  died.reason = "exit";
  died.seed = f.run.seed; /* computed later */
  OK(store_add_attempt(store, &died, &error));
  assert_near(number(store, "SELECT failed = 1 FROM points"), 1, 0); /* seed 5 lies beyond the prefix of the rule */
  died.seed = 78;
  for (died.attempt = 1; died.attempt <= 2; died.attempt++)
    OK(store_add_attempt(store, &died, &error));
  assert_near(number(store, "SELECT n = 8 AND failed = 2 FROM points"), 1, 0);
  died.seed = 79;
  died.replicate = 9; /* the first one beyond the prefix */
  OK(store_add_attempt(store, &died, &error));
  assert_near(number(store, "SELECT n = 8 AND failed = 2 FROM points"), 1, 0);
  const struct store_attempt silent = {.point_id = point, .replicate = 21, .identity = {8}, .attempt = 1};
  OK(store_add_attempt(store, &silent, &error));
  assert_near(number(store, "SELECT count(*) FROM attempt WHERE replicate = 21 AND reason = 'exit' AND message = ''"),
              1, 0);
  OK(store_close(store, &error));
  OK(store_open_reader(path, &store, &error));
  assert_int_equal(store_attempts(store, attempt.identity, 10, 0), 2);
  assert_true(store_has_run(store, f.run.identity));
  assert_false(store_has_run(store, attempt.identity));
  OK(store_close(store, &error));
}

/* Adds up the values of a point's runs; returns the number of runs. */
static int sum_runs(struct store *store, int64_t point, const struct field *row, bool of_outcome, double *sum) {
  int count = 0;
  *sum = 0;
  ANSWER runs = ask_run_of_point(store, point, &fixture_kind, row, of_outcome, &error);
  for (struct ask_run_of_point run; ask_run_of_point_next(&runs, &run); count++) {
    assert_true(run.replicate == count);
    assert_int_equal(run.state, OUTCOME_COMPLETED);
    *sum += run.value;
  }
  OK(answer_end(&runs));
  return count;
}

TEST(runs_of_a_point_in_order) {
  char path[64];
  struct store *store = writer(fixture_path(path, "point"));
  OK(fixture_populate(store, 1, 2, 10, true, &error));
  double sum;
  assert_int_equal(sum_runs(store, 2, &fixture_result_rows[0], false, &sum), 10);
  assert_near(sum, 3 * 45, 0);
  const struct field *steps = field_find(&outcome_table, "steps", &error);
  assert_int_equal(sum_runs(store, 1, steps, true, &sum), 10);
  assert_near(sum, 10 * 1000 + 45, 0);
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  uint8_t identity[16];
  scene_identity(&scene, 1003, identity);
  OK(store_set_fields(store, identity, "x.h5", NULL, &error));
  assert_near(number(store, "SELECT replicate FROM run WHERE fields_path = 'x.h5'"), 3, 0);
  identity[0] ^= 1;
  assert_int_equal(store_set_fields(store, identity, "x.h5", NULL, &error), STATUS_INTERNAL);
  store_close(store, NULL);
}

TEST(estimates_are_replaced) {
  char path[64];
  struct store *store = writer(fixture_path(path, "estimates"));
  OK(fixture_populate(store, 1, 1, 3, false, &error));
  struct estimate rows[2] = {{.window = ESTIMATES_FROM_2, .fit.beta = 2}, {.window = ESTIMATES_FROM_5, .fit.beta = 3}};
  OK(store_set_estimates(store, 1, 3, 2, rows, &error));
  rows[0].fit.beta = 4;
  OK(store_set_estimates(store, 1, 3, 1, rows, &error));
  assert_near(number(store, "SELECT count(*) FROM estimates WHERE run_id IS NULL"), 1, 0);
  assert_near(number(store, "SELECT beta FROM estimates WHERE run_id IS NULL"), 4, 0);
  assert_near(number(store, "SELECT count(*) FROM estimates"), 7, 0);
  OK(store_close(store, &error));
}
