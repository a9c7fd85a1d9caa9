/* Convergence studies of exponents: mean, interval and bias of a level are those of the pooled exponent of its runs,
 * and a difference that was put into the store is found. */
#include "campaign/converge/study.h"
#include "db/ask/ask.h"
#include "tests/support/check.h"
#include "tests/support/store_fixture.h"

enum { SEEDS = 8, FRAGMENTS = 60, LEVELS = 2 };
static const double coarse_beta = 2.0, fine_beta = 2.3;

static struct fragment fragment_of(double mass) {
  return (struct fragment){.mass = mass, .count = (uint32_t)lround(mass)};
}

/* A run with masses m^-beta from 4 to 4000, of as many grains: the windows begin inside. */
static void add_run(struct store *store, int64_t session, int64_t point, const struct scene *scene, uint64_t seed,
                    double beta) {
  struct fragment fragments[FRAGMENTS];
  struct estimate estimates[ESTIMATES_COUNT];
  struct outcome outcome = {.state = OUTCOME_COMPLETED, .fragment_count = FRAGMENTS, .kinetic_energy_share = NAN};
  OWNED void *result = calloc(1, scene->kind->results->size);
  assert_non_null(result);
  field_defaults(scene->kind->results, result);
  for (size_t i = 0; i < FRAGMENTS; i++) {
    const double u = fixture_random(seed * 1000 + i, (uint64_t)(10 * beta));
    fragments[i] = fragment_of(4 * pow(1 - u * (1 - pow(1000, 1 - beta)), 1 / (1 - beta)));
    outcome.total_mass += fragments[i].mass;
  }
  qsort(fragments, FRAGMENTS, sizeof fragments[0], fixture_by_mass);
  outcome.largest_fraction = fragments[0].mass / outcome.total_mass;
  OK(estimates_make(FRAGMENTS, fragments, NAN, estimates, &error));
  struct store_run run = {.point_id = point,
                          .session_id = session,
                          .replicate = (int64_t)seed - 1,
                          .seed = seed,
                          .kind = scene->kind,
                          .outcome = &outcome,
                          .result = result,
                          .fragments = fragments,
                          .fragment_count = FRAGMENTS,
                          .estimates = estimates,
                          .estimate_count = ESTIMATES_COUNT,
                          .wall_s = 1,
                          .cpu_s = 1,
                          .attempt = 1,
                          .host = "testhost"};
  scene_identity(scene, seed, run.identity);
  OK(store_add_run(store, &run, &error));
}

/* A study of two time steps, whose runs have exponents that differ by 0.3. Seeds begin at 1; `missing` has no run. */
struct fixture {
  struct store *store;
  struct scene *scene;
  struct study study;
  struct study_ladder *ladder;
};

static void set_up_levels(struct fixture *f, const char *file, const char *quantity, uint64_t missing,
                          const char *settings) {
  char path[64];
  struct ladder levels;
  OWNED char *notes = NULL;
  int64_t session = 0;
  *f = (struct fixture){.study = {.quantity_count = 1, .limits = {.first_seed = 1}}};
  f->study.rule = (struct study_rule){.within = NAN, .first_seeds = SEEDS, .most_seeds = SEEDS, .seconds = HUGE_VAL};
  OK(store_open_writer(fixture_path(path, file), &f->store, NULL, 0, &error));
  OK(scene_load("disc-explosion", NULL, &f->scene, &error));
  OK(study_quantity_find(f->scene->kind, quantity, &f->study.quantity[0], &error));
  assert_int_equal(ladder_make(engine_knob(f->scene->kind, "time_step", &error), f->scene, settings, &levels, &notes,
                               &error),
                   STATUS_OK);
  OK(study_add(&f->study, f->scene, &levels, &error));
  f->ladder = &f->study.ladder[0];
  f->ladder->seeds = SEEDS;
  OK(store_begin_session(f->store, "{\"version\":\"test\"}", &session, &error));
  for (size_t l = 0; l < f->ladder->levels.count; l++) {
    const struct scene *scene = f->ladder->levels.level[l].scene;
    int64_t point = 0;
    OK(store_add_point(f->store, 0, scene, 0, NULL, &point, &error));
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
      if (seed != missing && l < LEVELS)
        add_run(f->store, session, point, scene, seed, l ? fine_beta : coarse_beta);
  }
  OK(store_flush(f->store, &error));
  OK(study_read(&f->study, f->ladder, f->store, &error));
}

static void set_up(struct fixture *f, const char *file, const char *quantity, uint64_t missing) {
  set_up_levels(f, file, quantity, missing, "1 us,0.5 us");
}

static void tear_down(struct fixture *f) {
  study_clear(&f->study);
  scene_free(f->scene);
  OK(store_close(f->store, &error));
}

TEST(levels_have_the_pooled_exponent) {
  static const char *const names[] = {"beta", "beta_least_squares_from_5", "beta_masses_from_2"};
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    struct fixture f;
    struct study_found found;
    set_up(&f, "exponent-level", names[i], 0);
    const struct study_quantity *quantity = &f.study.quantity[0];
    study_find(&f.study, f.ladder, 0, &found);
    for (size_t l = 0; l < LEVELS; l++) {
      struct pooled_exponent fit;
      assert_int_equal(point_exponent(f.store, f.ladder->point[l], 0, quantity->method, quantity->window, 0.95, &fit,
                                      &error),
                       STATUS_OK);
      assert_true(fit.interval.half_width > 0);
      assert_int_equal(found.rows[l].n, SEEDS);
      assert_near(found.rows[l].mean, fit.fit.beta, 1e-12);
      assert_near(found.rows[l].half_width, fit.interval.half_width, 1e-9);
    }
    tear_down(&f);
  }
}

/* Both levels of a study, for the difference of their exponents in any choice of seeds. */
struct pair {
  struct point_data point[LEVELS];
};

static double exponent_of(const struct point_data *point, size_t n, const uint32_t *chosen) {
  size_t first[SEEDS + 1] = {0};
  double masses[SEEDS * FRAGMENTS];
  for (size_t i = 0; i < n; i++) {
    const size_t begin = point->runs.first[chosen[i]], count = point->runs.first[chosen[i] + 1] - begin;
    memcpy(masses + first[i], point->runs.masses + begin, count * sizeof *masses);
    first[i + 1] = first[i] + count;
  }
  const struct pooled_runs runs = {n, first, masses};
  struct pooled_exponent fit;
  OK(pooled_exponent(&runs, EXPONENT_MASSES, point_window(point, ESTIMATES_FROM_5), 0.95, &fit, &error));
  return fit.fit.beta;
}

static double difference_of(size_t n, const uint32_t *chosen, void *context) {
  const struct pair *pair = context;
  return exponent_of(&pair->point[0], n, chosen) - exponent_of(&pair->point[1], n, chosen);
}

/* The bias and its interval are those of the difference itself with one seed after another left out of both. */
TEST(the_bias_is_found) {
  struct fixture f;
  struct study_found found;
  struct pair pair;
  set_up(&f, "exponent-bias", "beta_masses_from_5", 0);
  assert_string_equal(f.study.quantity[0].column, "beta"); /* one name for one exponent */
  study_find(&f.study, f.ladder, 0, &found);
  const struct convergence_row *row = &found.rows[0];
  assert_true(row->base && row->paired && found.rows[1].reference);
  assert_true(row->bias + row->bias_half_width < 0); /* and it is not zero */
  for (size_t l = 0; l < LEVELS; l++)
    OK(point_read(f.store, f.ladder->point[l], 0, &pair.point[l], &error));
  const struct sample_interval want = sample_jackknife(SEEDS, 0.95, difference_of, &pair);
  assert_near(row->bias, want.estimate, 1e-9);
  assert_near(row->bias_half_width, want.half_width, 1e-9);
  for (size_t l = 0; l < LEVELS; l++)
    point_release(&pair.point[l]);
  tear_down(&f);
}

/* Then it is the second error of the exponent, under both its names, of both points. */
TEST(the_store_has_the_second_error) {
  struct fixture f;
  struct ask_resolution found;
  set_up(&f, "exponent-store", "beta", 0);
  OK(ask_resolution(f.store, f.ladder->point[0], "beta", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_NOT_STUDIED);
  OK(study_store(&f.study, f.store, &error));
  static const char *const names[] = {"beta", "beta_masses_from_5"};
  for (size_t i = 0; i < 2; i++) {
    OK(ask_resolution(f.store, f.ladder->point[0], names[i], &found, &error));
    assert_int_equal(found.verdict, ASK_RESOLUTION_AT_LEAST); /* two levels do not determine a limit */
    assert_true(found.half_width > fine_beta - coarse_beta - 0.1);
  }
  OK(ask_resolution(f.store, f.ladder->point[0], "beta_masses_from_2", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_NOT_STUDIED);
  tear_down(&f);
}

/* A seed without a run leaves its own place empty, so that levels are still compared seed by seed. */
TEST(a_missing_seed_keeps_its_place) {
  const uint64_t missing = 3;
  for (int result = 0; result < 2; result++) {
    struct fixture f;
    set_up(&f, result ? "result-missing" : "exponent-missing", result ? OUTCOME_DEFAULT : "beta", missing);
    for (int64_t s = 0; s < SEEDS; s++)
      assert_int_equal(isnan(f.ladder->values[0][0][s]), s == (int64_t)missing - 1);
    tear_down(&f);
  }
}

/* One run has no interval, so a study of one seed has no result for an exponent. */
TEST(one_seed_tells_nothing) {
  struct fixture f;
  struct study_found found;
  set_up(&f, "exponent-one", "beta", 0);
  f.ladder->seeds = 1;
  OK(study_read(&f.study, f.ladder, f.store, &error));
  study_find(&f.study, f.ladder, 0, &found);
  assert_true(isnan(found.rows[0].mean) && isnan(found.rows[0].bias));
  assert_true(f.ladder->ran[0][0]); /* but its run is known */
  tear_down(&f);
}

/* A level that the study had no time for is one of those that the law tells beyond the finest: it is there once. */
TEST(a_level_beyond_the_finest_is_there_once) {
  struct fixture f;
  double count, settings, known;
  set_up_levels(&f, "beyond", OUTCOME_DEFAULT, 0, "1 us,0.5 us,0.25 us,0.125 us");
  for (size_t l = 0; l < 4; l++)
    for (size_t s = 0; s < SEEDS; s++)
      f.ladder->values[0][l][s] = l == 3 ? (double)NAN : 0.3 + 0.1 * pow(0.5, (double)l) + 1e-4 * (double)(s * l % 3);
  f.ladder->left_out[3] = true;
  OK(study_store(&f.study, f.store, &error));
  assert_int_equal(answer_number(f.store, &count, &error, "SELECT count(*) FROM convergence"), STATUS_OK);
  assert_int_equal(answer_number(f.store, &settings, &error, "SELECT count(DISTINCT setting + 0) FROM convergence"),
                   STATUS_OK);
  assert_int_equal(answer_number(f.store, &known, &error, "SELECT count(resolution) FROM convergence"), STATUS_OK);
  assert_true(count == 6 && settings == count && known == count);
  tear_down(&f);
}
