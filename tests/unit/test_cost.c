/* Cost of runs: the remaining time of a campaign, and the time of a whole run predicted from a coarse one. */

#include "campaign/scheduler/point.h"
#include "campaign/scheduler/scheduler.h"
#include "tests/support/check.h"

#define NEAR(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

TEST(time_left) {
  /* Ten runs of 1 s on two busy slots, two of them half done: 9 s of work. */
  struct point_cost_left left = {.missing_s = 10, .under_way_s = 1, .finished_s = 9, .elapsed_s = 5, .slots = 2};
  NEAR(point_cost_time_left(&left), 4.5, 1e-12);
  /* Runs of 1 ms that take 10 ms in all: 1000 of them on one slot are 10 s and not 1 s. */
  left = (struct point_cost_left){.missing_s = 1, .finished_s = 0.2, .elapsed_s = 2, .slots = 1};
  NEAR(point_cost_time_left(&left), 10, 1e-12);
  /* One long run delays the end, however many slots are free. */
  left = (struct point_cost_left){.missing_s = 60,
                                  .under_way_s = 20,
                                  .finished_s = 380,
                                  .elapsed_s = 100,
                                  .longest_s = 40,
                                  .slots = 4};
  NEAR(point_cost_time_left(&left), 40, 1e-12);
  /* No run has finished: the estimate assumes busy slots. */
  left = (struct point_cost_left){.missing_s = 8, .elapsed_s = 3, .slots = 2};
  NEAR(point_cost_time_left(&left), 4, 1e-12);
}

/* Before any run: the work. Then the rate of all runs, which weighs as much as one run of the point itself. */
TEST(prediction) {
  struct point_cost_model model = {0};
  struct point_cost light = {.work = 10}, heavy = {.work = 40};
  NEAR(point_cost_predict(&model, &heavy), 40, 0);
  point_cost_learn(&model, &light, 5);
  point_cost_learn(&model, &light, NAN); /* an attempt without a time counts for nothing */
  NEAR(point_cost_predict(&model, &heavy), 20, 1e-12);
  NEAR(point_cost_predict(&model, &light), (5 + 5) / 2.0, 1e-12);
  point_cost_learn(&model, &heavy, 50); /* 55 s for 50 units of work: 44 s by the rate, 50 s by its own run */
  NEAR(point_cost_predict(&model, &heavy), (44 + 50) / 2.0, 1e-12);
  point_cost_learn(&model, &heavy, 32); /* 87 s for 90 */
  NEAR(point_cost_predict(&model, &heavy), (87 / 90.0 * 40 + 50 + 32) / 3, 1e-12);
}

/* The piece has reached a quarter of the hard end after 10 steps; the coarse run had made 5 steps there, and ended
 * after 20 steps at 0.6: the whole run takes 40 steps. */
TEST(whole_runs) {
  struct plan_trial *piece = calloc(2, sizeof *piece), *coarse = piece + 1;
  assert_non_null(piece);
  *piece = (struct plan_trial){.prepare_s = 1, .step_s = 2, .finish_s = 0.5, .steps = 10, .progress = 0.25};
  *coarse = (struct plan_trial){.steps = 20, .progress = 0.6, .finished = true, .marks = 3};
  const double steps[3] = {4, 6, 20}, progress[3] = {0.2, 0.3, 0.6};
  for (int i = 0; i < 3; i++) {
    coarse->mark_steps[i] = steps[i];
    coarse->mark_progress[i] = progress[i];
  }
  NEAR(plan_whole(piece, coarse), 1 + 2 * 20.0 / 5 + 0.5, 1e-12);
  piece->expected = NAN;
  NEAR(plan_to_hard_end(piece), 1 + 2 * 4 + 0.5, 1e-12); /* without a coarse run: four times the steps */
  piece->expected = 30;                                  /* the engine knows that later steps are longer */
  NEAR(plan_to_hard_end(piece), 1 + 2 * 3 + 0.5, 1e-12);
  piece->expected = 50;
  NEAR(plan_to_hard_end(piece), 1 + 2 * 4 + 0.5, 1e-12);
  piece->progress = 0.7;
  assert_true(isnan(plan_whole(piece, coarse)));
  piece->progress = 0.25;
  coarse->finished = false;
  assert_true(isnan(plan_whole(piece, coarse)));
  free(piece);
}

/* A piece of a real run, with its coarse version, predicts the number of steps of the whole run within a factor of 1.5.
 * Time is counted in steps: a step counts as a second. */
TEST(a_run_told_by_its_beginning) {
  struct scene *scene = NULL, *coarse = NULL;
  char setting[64];
  OWNED struct plan_trial *run = calloc(2, sizeof *run);
  assert_non_null(run);
  OK(scene_load("disc-explosion", NULL, &scene, &error));
  OK(scene_set_text(scene, "body.diameter", "0.2 m", &error));
  OK(scene_set_text(scene, "charge.energy", "1e4 J/m", &error));
  OK(plan_try(scene, 1, 1000, &run[0], &error));
  assert_true(run[0].finished);
  const double work = scene->kind->work(scene->inputs);
  plan_coarsen(scene, 1 / work, 1.0 / 3, &coarse, setting);
  assert_non_null(coarse);
  assert_true(coarse->kind->work(coarse->inputs) < work / 2);
  OK(plan_try(coarse, 1, 1000, &run[1], &error));

  const double whole = run[0].steps;
  size_t place = 0;
  while (run[0].mark_steps[place] < whole / 3)
    place++;
  const struct plan_trial piece = {.step_s = run[0].mark_steps[place],
                                   .steps = run[0].mark_steps[place],
                                   .progress = run[0].mark_progress[place]};
  const double told = plan_whole(&piece, &run[1]);
  assert_true(told < 1.5 * whole && told > whole / 1.5);
  scene_free(coarse);
  scene_free(scene);
}

/* Programs read these keys and their meanings. */
TEST(keys_of_a_plan) {
  static const char
      text[] = "name: keys\nscene: disc-explosion\nvary: {threshold.strain: [1 %, 2 %], contact.law: [off]}\n";
  CAMPAIGN campaign = NULL;
  OK(campaign_parse("keys.yaml", text, strlen(text), NULL, &campaign, &error));
  struct plan plan = {.store = "other.db",
                      .points = 1,
                      .points_looked_at = 2,
                      .runs_least = 3,
                      .runs_most = 4,
                      .runs_there = 5,
                      .store_exists = true,
                      .trial_finished = true,
                      .run_s_mean = 6,
                      .run_s_most = 7,
                      .cpu_s_least = 8,
                      .cpu_s_most = 9,
                      .wall_s_least = 10,
                      .wall_s_most = 11,
                      .memory_most = 12,
                      .disk_bytes = NAN,
                      .fields_bytes = 14};
  char model[] = "grains", *json = plan_print_json(campaign, &plan, 15);
  assert_string_equal(
      json,
      "{\"campaign\": \"keys\", \"scene\": \"disc-explosion\", \"store\": \"other.db\", \"axes\": [{\"path\": "
      "\"threshold.strain\", \"unit\": \"1\", \"values\": \"1 %, 2 %\"}, {\"path\": \"contact.law\", \"unit\": \"\", "
      "\"values\": \"off\"}], \"points\": 1, \"points_looked_at\": 2, \"runs_least\": 3, \"runs_most\": 4, "
      "\"runs_there\": 5, \"store_exists\": true, \"trial_made\": false, \"trial_finished\": true, \"slots\": 15, "
      "\"run_s_mean\": 6, \"run_s_most\": 7, \"cpu_s_least\": 8, \"cpu_s_most\": 9, \"wall_s_least\": 10, "
      "\"wall_s_most\": 11, \"memory_most_bytes\": 12, \"disk_bytes\": null, \"fields_bytes\": 14, \"model\": \"\"}\n");
  free(json);
  plan.model = model;
  char alternatives[] = "[16]";
  plan.alternatives = alternatives;
  json = plan_print_json(campaign, &plan, 15);
  assert_non_null(strstr(json, ", \"alternatives\": [16], \"model\": \"grains\"}\n"));
  free(json);
}

/* Four sizes at seven speeds, the sizes one after the other: two points of each are timed. A run takes 2 s for each
 * unit of work, and the time was used up before the last size: the mean is that of all 28 points. */
TEST(all_sizes_count_in_a_mean) {
  static const double work[] = {1, 4, 13, 46};
  size_t of_size[4] = {0}, before = 0;
  struct plan_samples samples = {0};
  for (uint64_t i = 0; i < 28; i++)
    if (plan_is_sample(i, 28, before)) {
      before++;
      of_size[i / 7]++;
      samples.seconds += i < 21 ? 2 * work[i / 7] : 0;
      samples.work += i < 21 ? work[i / 7] : 0;
    }
  for (int k = 0; k < 4; k++)
    assert_int_equal(of_size[k], 2);
  NEAR(plan_mean(&samples, 64 / 4.0), 2 * 64 / 4.0, 1e-9);
  assert_true(isnan(plan_mean(&(struct plan_samples){0}, 1)));
  for (uint64_t points = 1; points <= PLAN_SAMPLES; points++) /* few points: all of them */
    for (uint64_t i = 0; i < points; i++)
      assert_true(plan_is_sample(i, points, i));
}

/* A run of two threads takes half of its processor time; the trial itself runs on one. */
TEST(threads_share_the_time) {
  static const char
      text[] = "name: threads\nscene: basalt-sphere\nset: {fidelity.particles: 300, fidelity.threads: 2}\n"
               "seeds: {per_point: 1}\n";
  CAMPAIGN campaign = NULL;
  OWNED_BY(plan_clear) struct plan plan;
  FILE *file = fopen("threads.yaml", "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
  OK(campaign_load("threads.yaml", &campaign, &error));
  const struct plan_options options = {.store_path = "no-such-store.db", .slots = 1};
  OK(plan_make(campaign, &options, &plan, &error));
  NEAR(plan.threads, 2, 0);
  assert_true(plan.wall_s_least > 0.49 * plan.cpu_s_least && plan.wall_s_least < 0.6 * plan.cpu_s_least);
  remove("threads.yaml");
}
