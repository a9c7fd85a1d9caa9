/* A store of real scenes: the scene stored with a point is enough to compute the identity of every run again. */
#include <sqlite3.h>

#include "analysis/statistics/statistics.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

static void line(void *context, const char *text) {
  size_t used = strlen(context);
  snprintf((char *)context + used, 4000 - used, "%s\n", text);
}

/* One run of every built-in scene, with the results of a run that has only two fragments. */
static void populate(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  for (size_t i = 0; i < scene_builtin_count(); i++) {
    SCENE scene = NULL;
    int64_t point = 0, again = 0;
    OK(scene_load(scene_builtin_name(i), NULL, &scene, &error));
    OK(store_add_point(store, 0, scene, 0, NULL, &point, &error));
    OK(store_add_point(store, 0, scene, 0, NULL, &again, &error));
    assert_true(point == again);
    struct fragment fragments[2] = {{.mass = 3, .count = 3}, {.mass = 1, .count = 1}};
    struct outcome outcome = {.state = OUTCOME_COMPLETED};
    OWNED void *result = calloc(1, scene->kind->results->size);
    struct estimate estimates[ESTIMATES_COUNT];
    field_defaults(scene->kind->results, result);
    outcome_fragments(&outcome, 2, fragments, &(struct outcome_small){.dust = NAN});
    OK(estimates_make(2, fragments, 0, estimates, &error));
    struct store_run run = {.point_id = point,
                            .seed = 7 + i,
                            .kind = scene->kind,
                            .outcome = &outcome,
                            .result = result,
                            .fragments = fragments,
                            .fragment_count = 2,
                            .estimates = estimates,
                            .estimate_count = ESTIMATES_COUNT,
                            .attempt = 1};
    scene_identity(scene, run.seed, run.identity);
    OK(store_add_run(store, &run, &error));
  }
  OK(store_close(store, &error));
}

TEST(identities_follow_from_the_scenes) {
  char path[64], problems[4000] = "";
  struct store *store = NULL;
  assert_true(scene_builtin_count() > 0);
  populate(fixture_path(path, "scene"));
  OK(store_open_reader(path, &store, &error));
  if (store_check(store, line, problems, &error) != STATUS_OK)
    fail_msg("%s", problems);
  double inputs = 0;
  OK(answer_number(store, &inputs, &error,
                   "SELECT min((SELECT count(*) FROM point_input i WHERE i.point_id = p.point_id)) FROM point p"));
  assert_true(inputs > 10);
  store_close(store, NULL);
}

TEST(a_changed_seed_or_scene_is_found) {
  static const char *const damages[] =
      {"UPDATE run SET seed = seed + 1 WHERE run_id = 1", "UPDATE run SET identity = randomblob(16) WHERE run_id = 1",
       "UPDATE point SET scene = '{\"engine\": \"dem\", \"nonsense\": 1}' WHERE point_id = 1"};
  for (size_t i = 0; i < sizeof damages / sizeof damages[0]; i++) {
    char path[64], problems[4000] = "";
    struct store *store = NULL;
    populate(fixture_path(path, "scene-changed"));
    sqlite3 *db = NULL;
    sqlite3_open(path, &db);
    assert_int_equal(sqlite3_exec(db, damages[i], NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    OK(store_open_reader(path, &store, &error));
    assert_int_equal(store_check(store, line, problems, &error), STATUS_CONTENT);
    assert_non_null(strstr(problems, i < 2 ? "run 1: its identity" : "point 1: its scene cannot be read"));
    store_close(store, NULL);
  }
}

/* A share above 1 is found in common results and in an engine's own results. Runs that do not count and runs of another
 * version are not checked. */
TEST(results_out_of_range_are_found) {
  static const struct {
    const char *damage, *word; /* NULL: no message of that kind */
  } cases[] = {
      {"UPDATE run SET second_fraction = 1.0000001 WHERE run_id = 1",
       "run 1, out of range: second_fraction is 1.0000001\n"},
      {"UPDATE result_sph SET limited_courant = 1.5, limited_force = -0.25",
       ", out of range: limited_courant is 1.5 limited_force is -0.25\n"},
      {"UPDATE result_sph SET limited_courant = NULL, limited_force = 1", NULL},
      {"UPDATE result_sph SET compaction_mass_fraction = 1 + 5e-15, limited_force = -5e-15", NULL}, /* rounding */
      {"UPDATE run SET second_fraction = 2, results_version = results_version + 1000", NULL},
      {"UPDATE run SET second_fraction = 2, counts = 0, state = 'energy'", NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char path[64], problems[4000] = "";
    struct store *store = NULL;
    populate(fixture_path(path, "scene-range"));
    sqlite3 *db = NULL;
    sqlite3_open(path, &db);
    assert_int_equal(sqlite3_exec(db, cases[i].damage, NULL, NULL, NULL), SQLITE_OK);
    assert_true(sqlite3_changes(db) > 0);
    sqlite3_close(db);
    OK(store_open_reader(path, &store, &error));
    const status code = store_check(store, line, problems, &error);
    if (cases[i].word ? code != STATUS_CONTENT || !strstr(problems, cases[i].word) : strstr(problems, "range") != NULL)
      fail_msg("%s: said '%s'", cases[i].damage, problems);
    store_close(store, NULL);
  }
}
