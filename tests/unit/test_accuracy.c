/* Which settings and how many seeds reach an accuracy: known answers from invented studies. */

#include "analysis/statistics/statistics.h"
#include "campaign/converge/accuracy.h"
#include "campaign/converge/ladder.h"
#include "tests/support/check.h"
#include "tests/support/store_fixture.h"

static char path[64];

TEST(seeds_for_a_margin) {
  /* t(n - 1) s/sqrt n at n = 10: 2.262157/3.162278 = 0.715357 */
  assert_int_equal(accuracy_seeds(0.5, 1, 0.71536, false), 10);
  assert_int_equal(accuracy_seeds(0.5, 1, 0.71535, false), 11);
  assert_int_equal(accuracy_seeds(0.5, 1, 100, false), 3);
  assert_int_equal(accuracy_seeds(0.5, 0, 1e-9, false), 3);
  assert_int_equal(accuracy_seeds(0.5, 1, 0, false), 0);
  assert_int_equal(accuracy_seeds(0.5, 1, 0.0195, false), 0); /* more than 10 000 */
  assert_int_equal(accuracy_seeds(0.5, NAN, 1, false), 0);
  for (double margin = 0.5; margin > 0.02; margin /= 1.7) {
    const size_t n = (size_t)accuracy_seeds(0.5, 1, margin, false);
    assert_true(sample_student(n, 0.95) / sqrt((double)n) <= margin);
    assert_true(sample_student(n - 1, 0.95) / sqrt((double)(n - 1)) > margin);
  }
}

/* A table shows no wider interval than was reckoned with: that of a share. Equal runs have their bound. */
TEST(seeds_of_a_share) {
  for (double mean = 0.9; mean < 1; mean += 0.03) {
    const size_t n = (size_t)accuracy_seeds(mean, 0.1, 0.02, true);
    struct sample_summary of = {.n = n, .mean = mean, .standard_deviation = 0.1};
    of.half_width = sample_student(n, 0.95) * 0.1 / sqrt((double)n);
    sample_of_share(&of, 0.95);
    assert_true(of.half_width <= 0.02 && n > (size_t)accuracy_seeds(mean, 0.1, 0.02, false));
  }
  /* Equal runs: so many that an outcome of a share p of all runs, 0.95 of the chance, is among them, and p 0.9 <= 0.02.
   */
  const double seeds = (double)accuracy_seeds(0.9, 0, 0.02, true);
  assert_true(0.9 * (1 - pow(0.05, 1 / seeds)) <= 0.02 && 0.9 * (1 - pow(0.05, 1 / (seeds - 1))) > 0.02);
  assert_int_equal(accuracy_seeds(0.9, 0, 0.95, true), 3);
}

static struct campaign *campaign_of(const char *text) {
  struct campaign *campaign = NULL;
  if (campaign_parse("t.yaml", text, strlen(text), NULL, &campaign, &error) != STATUS_OK)
    fail_msg("%s", error.message);
  return campaign;
}

struct level {
  const char *setting;
  double resolution, deviation, cpu; /* cpu NaN: finer than the finest level with runs */
  bool base, open;
  double step;
};

/* The error of a level is its own resolution and that of the scene's own level of every other knob. means: NULL: 0.3 */
static void add_study_of(struct store *store, const struct campaign *campaign, const char *knob, size_t count,
                         const struct level *levels, const double *means) {
  struct convergence_row rows[8];
  struct convergence_limit_row limit;
  int64_t points[8], point;
  OK(store_add_point(store, 0, campaign->scene, 0, NULL, &point, &error));
  field_defaults(&convergence_limit_table, &limit);
  snprintf(limit.knob, sizeof limit.knob, "%s", knob);
  strcpy(limit.quantity, "largest_fraction");
  for (size_t i = 0; i < count; i++) {
    field_defaults(&convergence_table, &rows[i]);
    snprintf(rows[i].knob, sizeof rows[i].knob, "%s", knob);
    snprintf(rows[i].setting, sizeof rows[i].setting, "%s", levels[i].setting);
    strcpy(rows[i].quantity, "largest_fraction");
    rows[i].n = 10;
    rows[i].mean = means ? means[i] : 0.3;
    rows[i].bias = rows[i].resolution = levels[i].resolution;
    rows[i].bias_half_width = 0;
    rows[i].deviation = levels[i].deviation;
    rows[i].cpu = levels[i].cpu;
    rows[i].base = levels[i].base;
    rows[i].open = levels[i].open;
    rows[i].step = levels[i].step > 0 ? levels[i].step : (double)NAN;
    rows[i].reference = i + 1 == count || (!isnan(levels[i].cpu) && isnan(levels[i + 1].cpu));
    if (isnan(levels[i].cpu)) {
      rows[i].n = 0;
      rows[i].mean = rows[i].bias = rows[i].bias_half_width = NAN;
      rows[i].reference = false;
    }
    SCENE scene = scene_copy(campaign->scene);
    if (!levels[i].base)
      assert_int_equal(ladder_turn(engine_knob(scene->kind, knob, &error), scene, levels[i].setting, &error),
                       STATUS_OK);
    OK(store_add_point(store, 0, scene, 0, NULL, &points[i], &error));
  }
  const struct store_convergence study = {point, engine_find("dem", &error)->results_version, count, points, rows,
                                          &limit};
  OK(store_set_convergence(store, &study, &error));
}

static void add_study(struct store *store, const struct campaign *campaign, const char *knob, size_t count,
                      const struct level *levels) {
  add_study_of(store, campaign, knob, count, levels, NULL);
}

/* Own setting: 10 s, error 0.03. Twice the time step: 5 s, error 0.04. A quarter: 40 s, error 0.01. A cheaper model is
 * not a candidate. */
static void store_study(const struct campaign *campaign, bool open) {
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "accuracy"), &store, NULL, 0, &error));
  add_study(store, campaign, "time_step", 3,
            (const struct level[]){{"2e-6", 0.03, 0.02, 5, false, open, 0},
                                   {"1e-6", 0.02, 0.02, 10, true, open, 0},
                                   {"2.5e-7", 0, 0.02, 40, false, open, 0}});
  add_study(store, campaign, "grains", 1, (const struct level[]){{"0.01069", 0.01, 0.02, 10, true, false, 0}});
  add_study(store, campaign, "contact_law", 2,
            (const struct level[]){{"off", NAN, 0.02, 1, false, false, 0}, {"printed", NAN, 0.02, 10, true, false, 0}});
  OK(store_close(store, &error));
}

#define HEAD "name: t\nscene: disc-explosion\n"

TEST(the_cheapest_that_reaches_it) {
  struct accuracy accuracy;
  struct campaign *campaign = campaign_of(HEAD "accuracy: {within: 0.06}\n");
  store_study(campaign, false);
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 3);
  /* margins 0.02, 0.03, 0.05 at a scatter of 0.02 need 7, 5, 3 seeds: 35, 50 and 120 s */
  assert_int_equal(accuracy.chosen, 0);
  assert_string_equal(accuracy.options[0].setting, "2e-6");
  assert_int_equal(accuracy.options[0].seeds, 7);
  assert_true(accuracy.options[0].cpu_s == 35 && accuracy.options[1].cpu_s == 50 && accuracy.options[1].own);
  assert_int_equal(accuracy.reference, 2);
  accuracy_clear(&accuracy);
  OK(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error));
  assert_int_equal(campaign->per_point, 7);
  struct field_value value;
  field_get(field_find(campaign->scene->kind->inputs, "fidelity.time_step", &error), campaign->scene->inputs, &value);
  assert_true(value.number == 2e-6);
  campaign_free(campaign);

  /* A smaller margin: only the finest setting reaches it. */
  campaign = campaign_of(HEAD "accuracy: {quantity: largest_fraction, within: 0.025}\n");
  OK(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error));
  field_get(field_find(campaign->scene->kind->inputs, "fidelity.time_step", &error), campaign->scene->inputs, &value);
  assert_true(value.number == 2.5e-7);
  campaign_free(campaign);

  /* No setting reaches it, and a setting without a bound of its error does not count. */
  campaign = campaign_of(HEAD "accuracy: {within: 0.01}\n");
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "0.01"));
  campaign->accuracy_within = 0.06;
  store_study(campaign, true);
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  campaign_free(campaign);
}

/* A law goes on beyond the finest level: with order 0.5 at least, at a cost by the engine's measure of work. */
TEST(finer_than_any_level) {
  CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.02}\n");
  struct store *store = NULL;
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  OK(store_open_writer(fixture_path(path, "finer"), &store, NULL, 0, &error));
  add_study(store, campaign, "time_step", 4,
            (const struct level[]){{"2e-6", 0.03, 1e-4, 5, false, false, 2e-6},
                                   {"1e-6", 0.02, 1e-4, 10, true, false, 1e-6},
                                   {"5e-07", 0.02 * sqrt(0.5), NAN, NAN, false, false, 5e-7},
                                   {"2.5e-07", 0.02 * 0.5, NAN, NAN, false, false, 2.5e-7}});
  add_study(store, campaign, "grains", 1, (const struct level[]){{"0.01069", 0.005, 1e-4, 10, true, false, 0}});
  OK(store_close(store, &error));
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 4);
  const struct accuracy_option *chosen = &accuracy.options[accuracy.chosen];
  assert_true(chosen->extrapolated && !chosen->own); /* 0.005 + 0.02 sqrt(1/2) = 0.0191 is within 0.02; no level is */
  assert_string_equal(chosen->setting, "5e-07");
  assert_true(fabs(chosen->error - (0.005 + 0.02 * sqrt(0.5))) < 1e-12);
  assert_true(chosen->run_s > 15 && chosen->run_s < 25);
  OK(accuracy_apply(&accuracy, campaign, &error));
}

/* `within: 5 %` is 5 % of the mean that a setting gives, not of that with the scene's own ones. The mean of the finer
 * level is three times as large, so that its error is small enough; where the own mean is the larger one, the cheaper
 * level with the same error is not near enough. */
TEST(a_share_is_one_of_the_settings_own_mean) {
  static const struct {
    struct level levels[2];
    double means[2];
    const char *chosen;
  } cases[] =
      {{{{"1e-6", 0.02, 1e-4, 10, true, false, 0}, {"5e-07", 0.02, 1e-4, 20, false, false, 0}}, {0.3, 0.9}, "5e-07"},
       {{{"2e-06", 0.03, 1e-4, 5, false, false, 0}, {"1e-6", 0.03, 1e-4, 10, true, false, 0}}, {0.3, 0.9}, "1e-6"}};
  for (size_t i = 0; i < 2; i++) {
    CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 5 %}\n");
    struct store *store = NULL;
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    OK(store_open_writer(fixture_path(path, "shares"), &store, NULL, 0, &error));
    add_study_of(store, campaign, "time_step", 2, cases[i].levels, cases[i].means);
    OK(store_close(store, &error));
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_true(accuracy.count == 2 && accuracy.chosen == 0);
    assert_string_equal(accuracy.options[0].setting, cases[i].chosen);
    assert_true(accuracy.options[0].total <= 0.05 * 0.9);
  }
}

/* No error of a share is larger than its distance from the farther end, here 0.7: also of settings that nothing ran. */
TEST(no_error_is_larger_than_a_share_can_move) {
  CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.02}\n");
  struct store *store = NULL;
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  OK(store_open_writer(fixture_path(path, "capped"), &store, NULL, 0, &error));
  add_study_of(store, campaign, "time_step", 3,
               (const struct level[]){{"2e-6", 0.5, 1e-4, 5, false, false, 2e-6},
                                      {"1e-6", 0.5, 1e-4, 10, true, false, 1e-6},
                                      {"5e-07", 0.4, NAN, NAN, false, false, 5e-7}},
               (const double[]){0.4, 0.3, NAN});
  add_study(store, campaign, "grains", 1, (const struct level[]){{"0.01069", 0.5, 1e-4, 10, true, false, 0}});
  OK(store_close(store, &error));
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 3);
  for (size_t i = 0; i < accuracy.count; i++)
    assert_true(fabs(accuracy.options[i].error - (strcmp(accuracy.options[i].setting, "2e-6") ? 0.7 : 0.6)) < 1e-12);
  assert_string_equal(accuracy.options[accuracy.reference].setting, "2e-6"); /* by the number, as the table shows it */
}

/* The scene with a step of 5e-7 s has a study of finer grains, and its level 0.00759 m is the named settings
 * `reference` of the scene with 1e-6 s. The study with the finest level counts, also there. */
TEST(the_study_with_the_finest_level_counts) {
  struct campaign *first = campaign_of(HEAD "accuracy: {within: 0.02}\n"),
                  *second = campaign_of(HEAD "set: {fidelity.time_step: 0.5 us}\naccuracy: {within: 0.02}\n");
  struct store *store = NULL;
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  OK(store_open_writer(fixture_path(path, "kin"), &store, NULL, 0, &error));
  add_study(store, first, "grains", 2,
            (const struct level[]){{"0.01069", 0.4, 1e-4, 5, true, false, 0.01069},
                                   {"0.00759", 0.35, 1e-4, 10, false, false, 0.00759}});
  add_study(store, first, "time_step", 2,
            (const struct level[]){{"1e-6", 0.03, 1e-4, 5, true, false, 1e-6},
                                   {"5e-07", 0.02, 1e-4, 10, false, false, 5e-7}});
  add_study(store, first, "settings", 2,
            (const struct level[]){{"standard", NAN, 1e-4, 5, true, false, 0},
                                   {"reference", 0, 1e-4, 20, false, false, 0}});
  add_study(store, second, "grains", 3,
            (const struct level[]){{"0.01069", 0.2, 1e-4, 10, true, false, 0.01069},
                                   {"0.00759", 0.1, 1e-4, 20, false, false, 0.00759},
                                   {"0.003795", 0.05, 1e-4, 40, false, false, 0.003795}});
  OK(store_close(store, &error));
  OK(accuracy_find(second, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 3);
  for (size_t i = 0; i < 3; i++) /* least error first */
    assert_true(fabs(accuracy.options[i].error - (const double[]){0.07, 0.12, 0.22}[i]) < 1e-12);
  campaign_free(first);
  campaign_free(second);
}

/* Every setting has the parts of all knobs of its studies, with a bound or without. A time step that a study had no
 * time for, or that lies between its levels, or is finer than all of them, has the error of the next coarser level,
 * which is a bound where that level has one; one that is coarser than all has the largest, which is none. */
TEST(every_setting_has_the_parts_of_all_knobs) {
  static const struct {
    const char *step;
    double left, beyond;
  } cases[] = {{"0.5 us", 0.03, 0.04 / (sqrt(2) - 1)},
               {"0.7 us", 0.03, 0.04 / (sqrt(2) - 1)},
               {"0.25 us", 0.03, 0.04 / (sqrt(2) - 1)},
               {"2 us", 0.04, 0.04 / (sqrt(2) - 1)},
               {"8 us", 0.05, NAN}};
  const size_t count = sizeof cases / sizeof cases[0];
  for (size_t c = 0; c < 2 * count; c++) {
    const size_t i = c % count;
    const bool no_limit = c < count;
    char text[200];
    snprintf(text, sizeof text, HEAD "set: {fidelity.time_step: %s}\naccuracy: {within: 0.3}\n", cases[i].step);
    struct campaign *first = campaign_of(HEAD "accuracy: {within: 0.3}\n"), *second = campaign_of(text);
    struct store *store = NULL;
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    OK(store_open_writer(fixture_path(path, "all-knobs"), &store, NULL, 0, &error));
    add_study(store, first, "time_step", 4,
              (const struct level[]){{"4e-6", 0.05, 1e-4, 3, false, no_limit, 4e-6},
                                     {"2e-6", 0.04, 1e-4, 5, false, no_limit, 2e-6},
                                     {"1e-6", 0.03, 1e-4, 10, true, no_limit, 1e-6},
                                     {"5e-7", NAN, NAN, NAN, false, no_limit, 5e-7}});
    add_study(store, second, "grains", 3,
              (const struct level[]){{"0.02", 0.3, 1e-4, 5, false, false, 0.02},
                                     {"0.01069", 0.2, 1e-4, 10, true, false, 0.01069},
                                     {"0.0075", 0.1, 1e-4, 20, false, false, 0.0075}});
    OK(store_close(store, &error));
    OK(accuracy_find(second, "t.yaml", path, &accuracy, &error));
    assert_int_equal(accuracy.count, 3);
    for (size_t o = 0; o < 3; o++) {
      const struct accuracy_option *option = &accuracy.options[o];
      const double grains = option->own ? 0.2 : strcmp(option->setting, "0.02") == 0 ? 0.3 : 0.1;
      const bool bound = !no_limit && !isnan(cases[i].beyond);
      assert_true(option->open == !bound && fabs(option->error - grains - cases[i].left) < 1e-12);
      assert_true(bound                    ? option->beyond == 0
                  : isnan(cases[i].beyond) ? isnan(option->beyond)
                                           : fabs(option->beyond - cases[i].beyond) < 1e-12);
    }
    campaign_free(first);
    campaign_free(second);
  }
}

/* The study that needs most decides for all points. Its levels take the place of advised ones that are within 2 %. */
TEST(the_point_that_needs_most_decides) {
  for (int hard = 0; hard < 2; hard++) {
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    CAMPAIGN campaign = campaign_of(HEAD "vary: {threshold.strain: [1 %, 4 %]}\naccuracy: {within: 0.06}\n");
    struct store *store = NULL;
    OK(store_open_writer(fixture_path(path, "needs-most"), &store, NULL, 0, &error));
    for (int i = 0; i < 2; i++) {
      CAMPAIGN point = campaign_of(i ? HEAD "set: {threshold.strain: 4 %}\n" : HEAD "set: {threshold.strain: 1 %}\n");
      const double finest = i == hard ? 0.05 : 0.01;
      add_study(store, point, "grains", 3,
                (const struct level[]){{"0.01507", 0.3, 1e-3, 5, false, false, 0.01507},
                                       {"0.01069", 0.2, 1e-3, 10, true, false, 0.01069},
                                       {"0.00759", finest, 1e-3, 20, false, false, 0.00759}});
    }
    OK(store_close(store, &error));
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_true(accuracy.chosen == 0 && accuracy.options[0].error == 0.05 && !accuracy.some_studied);
    accuracy_clear(&accuracy);
    campaign->accuracy_within = 0.04;
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_true(accuracy.chosen == accuracy.count && strstr(accuracy.place, hard ? "point 2" : "point 1"));
    assert_non_null(strstr(accuracy.advice, "--knob grains=0.01507m,0.00759m,0.003795m,0.01069m"));
  }
}

/* The advice names the knob that leaves most of the smallest error, which is one with the scene's own grains (the finer
 * ones have too few results), and what it leaves there. What may lie beyond the levels of the time step, 0.03/(sqrt 2 -
 * 1) = 0.07, counts to it. */
TEST(the_knob_that_leaves_most_is_advised) {
  static const struct {
    double grains;
    const char *advice;
  } cases[] = {{0.2, "Finer levels of grains, which leaves most of it (0.2), may narrow it"},
               {0.06, "Finer levels of time_step, which leaves most of it (0.1), may narrow it"}};
  for (size_t i = 0; i < 2; i++) {
    CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.02}\n");
    struct store *store = NULL;
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    OK(store_open_writer(fixture_path(path, "widest"), &store, NULL, 0, &error));
    add_study(store, campaign, "time_step", 3,
              (const struct level[]){{"2e-6", 0.03, 1e-4, 5, false, true, 2e-6},
                                     {"1e-6", 0.03, 1e-4, 10, true, true, 1e-6},
                                     {"5e-7", 0.03, 1e-4, 20, false, true, 5e-7}});
    add_study(store, campaign, "grains", 3,
              (const struct level[]){{"0.02", 0.3, 1e-4, 5, false, false, 0.02},
                                     {"0.01069", cases[i].grains, 1e-4, 10, true, false, 0.01069},
                                     {"0.008", 0.05, NAN, 20, false, false, 0.008}});
    OK(store_close(store, &error));
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_int_equal(accuracy_apply(&accuracy, campaign, &error), STATUS_CONTENT);
    if (!strstr(error.message, cases[i].advice) || !strstr(error.message, i ? "--knob time_step=" : "--knob grains="))
      fail_msg("%s", error.message);
  }
}

/* No limit is seen, and the levels differ little: the slowest law, of order 0.5, leaves at the finest level the larger
 * of 0.012/(sqrt 4 - 1) and 0.004/(sqrt 2 - 1) = 0.0097. */
TEST(levels_that_differ_little_are_enough) {
  CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.02}\n");
  struct store *store = NULL;
  struct accuracy accuracy;
  OK(store_open_writer(fixture_path(path, "flat"), &store, NULL, 0, &error));
  add_study(store, campaign, "time_step", 3,
            (const struct level[]){{"2e-6", 0.012, 1e-4, 5, false, true, 2e-6},
                                   {"1e-6", 0.004, 1e-4, 10, true, true, 1e-6},
                                   {"5e-7", 0.004, 1e-4, 20, false, true, 5e-7}});
  /* A knob whose other levels had no time or no result says nothing, and is no part of the error. */
  add_study(store, campaign, "integrator", 1, (const struct level[]){{"verlet", NAN, 1e-4, 10, true, true, 0}});
  OK(store_close(store, &error));
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  const struct accuracy_option *chosen = &accuracy.options[accuracy.chosen];
  assert_true(accuracy.count == 3 && accuracy.chosen == 0 && chosen->own && chosen->open);
  assert_true(chosen->error == 0.004 && fabs(chosen->beyond - fmax(0.012, 0.004 / (sqrt(2) - 1))) < 1e-12);
  assert_true(chosen->total > chosen->error + chosen->beyond && chosen->part_count == 1);
  accuracy_clear(&accuracy);
  campaign->accuracy_within = 0.012;
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "no limit is seen"));
  assert_non_null(strstr(error.message, "allow more"));
}

/* A study without time for the scene's own level, which is finer than all: the slowest law bounds what it may change,
 * too. Coarser than all it may be anywhere. */
TEST(an_own_level_that_did_not_run) {
  static const struct level levels[2][5] = {{{"8e-6", 0.012, 1e-4, 5, false, true, 8e-6},
                                             {"4e-6", 0.004, 1e-4, 10, false, true, 4e-6},
                                             {"2e-6", 0.004, 1e-4, 20, false, true, 2e-6},
                                             {"1e-6", 0.004, NAN, NAN, true, true, 1e-6},
                                             {"5e-7", NAN, NAN, NAN, false, true, 5e-7}},
                                            {{"1e-6", 0.012, NAN, NAN, true, true, 1e-6},
                                             {"5e-7", 0.012, 1e-4, 5, false, true, 5e-7},
                                             {"2.5e-7", 0.004, 1e-4, 10, false, true, 2.5e-7},
                                             {"1.2e-7", 0.004, 1e-4, 20, false, true, 1.2e-7}}};
  for (size_t coarser = 0; coarser < 2; coarser++) {
    CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.05}\n");
    struct store *store = NULL;
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    OK(store_open_writer(fixture_path(path, "left-out"), &store, NULL, 0, &error));
    add_study(store, campaign, "time_step", coarser ? 4 : 5, levels[coarser]);
    OK(store_close(store, &error));
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_true(accuracy.chosen < accuracy.count); /* a level has an error of its own */
    for (size_t i = 0; coarser && i < accuracy.count; i++)
      assert_true(!accuracy.options[i].own);
    campaign->accuracy_within = 1e-3; /* the advice goes on with these levels, which are the user's own */
    accuracy_clear(&accuracy);
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    assert_true(coarser || (strstr(accuracy.advice, "The study had no time for time_step = 1e-6, 5e-7: ") &&
                            strstr(accuracy.advice, "--knob time_step=8e-6s,4e-6s,2e-6s,1e-6s,5e-7s` goes on")));
  }
}

/* A knob of two levels has no known rest, which stops the answer only if it moves the result. */
TEST(a_knob_of_two_levels_that_moves_stops_the_answer) {
  static const double moves[] = {1e-5, 0.02};
  for (size_t i = 0; i < 2; i++) {
    CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.1}\n");
    struct store *store = NULL;
    OK(store_open_writer(fixture_path(path, "two-levels"), &store, NULL, 0, &error));
    add_study(store, campaign, "time_step", 2,
              (const struct level[]){{"1e-6", moves[i], 1e-4, 10, true, true, 1e-6},
                                     {"5e-7", moves[i], 1e-4, 20, false, true, 5e-7}});
    add_study(store, campaign, "grains", 2,
              (const struct level[]){{"0.01069", 0.06, 1e-4, 10, true, false, 0.01069},
                                     {"0.008", 0.05, 1e-4, 20, false, false, 0.008}});
    OK(store_close(store, &error));
    assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error),
                     i == 0 ? STATUS_OK : STATUS_CONTENT);
  }
}

/* Grains finer than any level, with the same time step: those whose step is above a quarter of the longest stable one
 * (engine/dem/scene/conditions.c) would be marked, so they are no options. With 0.0056 m it is a
 * fifth. */
TEST(a_finer_setting_that_would_be_marked_is_none) {
  CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.02}\n");
  struct store *store = NULL;
  struct accuracy accuracy;
  OK(store_open_writer(fixture_path(path, "grains"), &store, NULL, 0, &error));
  add_study(store, campaign, "grains", 5,
            (const struct level[]){{"0.0112", 0.03, 1e-4, 5, true, false, 0.0112},
                                   {"0.008", 0.02, 1e-4, 10, false, false, 0.008},
                                   {"0.0056", 0.014, NAN, NAN, false, false, 0.0056},
                                   {"0.002", 0.01, NAN, NAN, false, false, 0.002},
                                   {"0.001", 0.007, NAN, NAN, false, false, 0.001}});
  OK(store_close(store, &error));
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 3);
  for (size_t i = 0; i < accuracy.count; i++)
    assert_true(!accuracy.options[i].extrapolated || strcmp(accuracy.options[i].setting, "0.0056") == 0);
  accuracy_clear(&accuracy);
  /* Advice of finer levels has the shorter step that they need: at 0.004 m it is 0.28 of the stable one. */
  campaign->accuracy_within = 0.001;
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "clast converge t.yaml --set fidelity.time_step='5e-07 s' --knob "
                                        "grains=0.016m,0.008m,0.004m,0.01069m --seeds 10`"));
  /* With that study in the store it is not advised again. */
  CAMPAIGN shorter = campaign_of(HEAD "set: {fidelity.time_step: 5e-07 s}\naccuracy: {within: 0.001}\n");
  OK(store_open_writer(path, &store, NULL, 0, &error));
  add_study(store, shorter, "grains", 2,
            (const struct level[]){{"0.008", 0.02, 1e-4, 5, true, false, 0.008},
                                   {"0.004", 0.01, 1e-4, 10, false, false, 0.004}});
  OK(store_close(store, &error));
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "`clast plan t.yaml --set fidelity.time_step='5e-07 s'` goes on there"));
}

/* A later study of the grains lacks the scene's own: no setting with these grains is known to be accurate, though the
 * time step is, and none is told a smaller error than the levels of grains have. With the own level all is known. */
TEST(a_study_without_the_scenes_own_level) {
  for (int own = 0; own < 2; own++) {
    CAMPAIGN campaign = campaign_of(HEAD "accuracy: {within: 0.1}\n");
    struct store *store = NULL;
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    OK(store_open_writer(fixture_path(path, "unstudied"), &store, NULL, 0, &error));
    add_study(store, campaign, "time_step", 2,
              (const struct level[]){{"2e-6", 0.02, 1e-4, 5, false, false, 0},
                                     {"1e-6", 0.01, 1e-4, 10, true, false, 0}});
    const struct level levels[] = {{"0.015", 0.2, 1e-4, 5, false, false, 0},
                                   {"0.01069", 0.05, 1e-4, 10, true, false, 0},
                                   {"0.0075", 0.12, 1e-4, 20, false, false, 0}};
    add_study(store, campaign, "grains", own ? 3 : 1, own ? levels : levels + 2);
    OK(store_close(store, &error));
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    for (size_t i = 0; i < accuracy.count; i++) {
      const struct accuracy_option *option = &accuracy.options[i];
      const bool of_grains = strcmp(option->knob, "grains") == 0 && !option->own;
      assert_true(option->open == (!own && !of_grains) && isnan(option->beyond) == option->open);
      if (option->own)
        assert_true(fabs(option->error - (own ? 0.06 : 0.13)) < 1e-12);
    }
    assert_int_equal(accuracy.chosen < accuracy.count, own);
  }
}

static void check_time(const char *time, const char *setting, int64_t seeds, double error_of_resolution) {
  char text[256];
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  snprintf(text, sizeof text, HEAD "accuracy: {processor_time: %s}\n", time);
  CAMPAIGN campaign = campaign_of(text);
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  const struct accuracy_option *chosen = &accuracy.options[accuracy.chosen];
  assert_string_equal(chosen->own ? "own" : chosen->setting, setting);
  assert_int_equal(chosen->seeds, seeds);
  const double total = error_of_resolution + sample_share_half_width((size_t)seeds, 0.3, 0.02, 0.95);
  assert_true(fabs(chosen->total - total) < 1e-12);
  bool open = true;
  assert_true(chosen->total == accuracy_least(&accuracy, accuracy.point_s, &open) && !open);
  OK(accuracy_apply(&accuracy, campaign, &error));
  assert_int_equal(campaign->per_point, seeds);
}

/* Half widths of a mean 0.3 are 1.025 times t(n - 1) 0.02/sqrt n: n = 3 0.0497, 4 0.0318, 6 0.0210, 8 0.0167, 16
 * 0.0107, 24 0.00845, 48 0.00581 (sums below without the 1.025). */
TEST(the_least_error_in_a_time) {
  struct campaign *campaign = campaign_of(HEAD "accuracy: {processor_time: 5 s}\n");
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  store_study(campaign, false);
  check_time("15 s", "2e-6", 3, 0.04);    /* nothing else can be run three times */
  check_time("30 s", "2e-6", 6, 0.04);    /* 0.0610; the scene's own: 3 seeds, 0.0797 */
  check_time("80 s", "own", 8, 0.03);     /* 0.0467; with 16 seeds of the coarser one 0.0507 */
  check_time("240 s", "2.5e-7", 6, 0.01); /* 0.0310; with 24 of its own 0.0384 */

  /* Too short for all. */
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "15 s"));
  campaign_free(campaign);

  /* Two points share the time. */
  campaign = campaign_of(HEAD "vary: {threshold.strain: [1 %, 3 %]}\naccuracy: {processor_time: 60 s}\n");
  store_study(campaign, true);
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_true(accuracy.point_s == 30 && accuracy.options[accuracy.chosen].open);
  assert_int_equal(accuracy.options[accuracy.chosen].seeds, 6);
  bool no_limit = false;
  assert_true(isnan(accuracy_least(&accuracy, 14, &no_limit)));
  assert_true(accuracy_least(&accuracy, 30, &no_limit) == accuracy.options[accuracy.chosen].total && no_limit);
  campaign_free(campaign);
}

/* Points share a time by what their runs take: at the second one, the own settings take 30 s by its study, so that the
 * coarser ones, which it has not studied, take 15 s; the third point has no study, and the nearest work is that of the
 * second one. */
TEST(points_cost_what_their_own_runs_cost) {
  struct store *store = NULL;
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  CAMPAIGN own = campaign_of(HEAD "accuracy: {processor_time: 210 s}\n");
  CAMPAIGN second = campaign_of(HEAD "set: {body.diameter: 50 cm}\naccuracy: {within: 1}\n");
  CAMPAIGN campaign = campaign_of(HEAD "vary: {body.diameter: [40 cm, 50 cm, 52 cm]}\n"
                                       "accuracy: {processor_time: 210 s}\n");
  store_study(own, false);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  add_study(store, second, "time_step", 1, (const struct level[]){{"1e-6", 0.02, 0.02, 30, true, false, 0}});
  OK(store_close(store, &error));
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  const struct engine_kind *kind = campaign->scene->kind;
  SCENE third = scene_copy(second->scene);
  OK(scene_set_text(third, "body.diameter", "52 cm", &error));
  OK(scene_check(third, &error));
  const double nearest = kind->work(third->inputs) / kind->work(second->scene->inputs);
  for (size_t i = 0; i < accuracy.count; i++) {
    const struct accuracy_option *option = &accuracy.options[i];
    const double studied = option->own ? 10 : strcmp(option->setting, "2e-6") == 0 ? 5 : 40;
    assert_true(fabs(option->run_s - studied * (1 + 3 + 3 * nearest) / 3) < 1e-9 * studied);
    assert_true(option->seeds == 0 || (double)option->seeds * 3 * option->run_s <= 210);
  }
}

/* Settings without a bound of their error count by its number, as all others: more time gives no larger error, and half
 * and twice of the time tell what these times give. */
TEST(more_time_gives_no_larger_error) {
  CAMPAIGN campaign = campaign_of(HEAD "accuracy: {processor_time: 5 s}\n");
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "more-time"), &store, NULL, 0, &error));
  add_study(store, campaign, "time_step", 2,
            (const struct level[]){{"2e-6", 0.02, 0.02, 5, false, false, 0}, {"1e-6", 0.01, 0.02, 10, true, false, 0}});
  add_study(store, campaign, "grains", 1, (const struct level[]){{"0.0075", 0.12, 0.02, 20, false, false, 0}});
  OK(store_close(store, &error));
  double twice = HUGE_VAL; /* of the time before */
  for (campaign->accuracy_time = 15; campaign->accuracy_time < 4000; campaign->accuracy_time *= 2) {
    OWNED_BY(accuracy_clear) struct accuracy accuracy;
    bool open = false;
    OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
    const double total = accuracy.options[accuracy.chosen].total;
    assert_true(total <= twice && (total == twice || twice == HUGE_VAL));
    twice = accuracy_least(&accuracy, 2 * accuracy.point_s, &open);
    assert_true(twice <= total);
    for (size_t i = 0; i < accuracy.count; i++)
      assert_true(accuracy.options[i].seeds == 0 || accuracy.options[i].total >= total);
  }
}

TEST(a_varied_input_is_no_choice) {
  OWNED_BY(accuracy_clear) struct accuracy accuracy;
  CAMPAIGN campaign = campaign_of(HEAD "vary: {fidelity.time_step: [1e-6 s, 5e-7 s]}\naccuracy: {within: 0.06}\n");
  store_study(campaign, false);
  OK(accuracy_find(campaign, "t.yaml", path, &accuracy, &error));
  assert_int_equal(accuracy.count, 1);
  assert_true(accuracy.options[0].own);
}

TEST(without_a_study_the_command_is_named) {
  struct campaign *campaign = campaign_of(HEAD "set: {contact.friction: 0.3}\naccuracy: {within: 0.06}\n");
  assert_int_equal(accuracy_settle(campaign, "t.yaml", "no-such.db", ACCURACY_SILENT, NULL, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "clast converge t.yaml --quantity largest_fraction`"));
  assert_int_equal(accuracy_settle(campaign, "t.yaml", path, ACCURACY_SILENT, NULL, &error),
                   STATUS_CONTENT); /* of another scene */
  assert_non_null(strstr(error.message, "clast converge"));
  campaign_free(campaign);
  static const char *const wrong[] = {"accuracy: {quantity: largest_fraction}\n",
                                      "accuracy: {within: 0}\n",
                                      "accuracy: {within: 0.1, quantity: nonsense}\n",
                                      "accuracy: {within: 0.1}\nseeds: {per_point: 3}\n",
                                      "accuracy: {within: 0.1, processor_time: 1 h}\n",
                                      "accuracy: {processor_time: 1 h}\nseeds: 3\n",
                                      "accuracy: {processor_time: 1}\n",
                                      "accuracy: {within: 0.1}\nseeds: {until: {half_width: 0.1}}\n"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    char text[256];
    campaign = NULL;
    snprintf(text, sizeof text, HEAD "%s", wrong[i]);
    error = (struct error){0};
    assert_int_equal(campaign_parse("t.yaml", text, strlen(text), NULL, &campaign, &error), STATUS_CONTENT);
    assert_non_null(strstr(error.message, "accuracy"));
  }
}
