/* Walks the design and times trial runs. */
#include "campaign/scheduler/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_walk.h"
#include "campaign/scheduler/pilot.h"
#include "db/ask/ask.h"
#include "db/store/store.h"
#include "schemas/clock.h"

enum { LOOKED_AT = 4096, WALKED = 4000000, ASKED = 50000, SAMPLED = 8 };
#define NOTHING ((double)NAN)

/* Bytes of a run's rows without its masses: run and result row, estimates, about twenty bins of its spectrum.
 * Measured on stores of thousands of runs; accurate to a factor of 1.5. */
#define BYTES_PER_RUN      3500.0
#define BYTES_PER_FRAGMENT 8.0

/* Overhead of a run, s: its process (in the slot, and for the memory pages that the child writes), and the manager's
 * work, which one process does for all slots. Measured with 4500 runs of 0.3 ms and 70 fragments. */
#define SLOT_S    0.7e-3
#define MANAGER_S 0.8e-3

struct looking {
  double work, work_most;
  struct scene *sample[SAMPLED]; /* points spread over the design; owned */
  size_t sampled;
  struct scene *costliest; /* the point with the most work; owned */
  uint64_t asked, there;   /* runs looked up in the store */
};

/* Looks up the point's runs in the store, at most ASKED runs for all points together. */
static void ask(const struct campaign *campaign, const struct scene *scene, struct store *store,
                struct looking *looking) {
  for (int64_t r = 0; store && r < campaign_replicates_least(campaign) && looking->asked < ASKED; r++) {
    uint8_t identity[16];
    scene_identity(scene, campaign_seed(campaign, scene, r), identity);
    looking->asked++;
    looking->there += store_has_run(store, identity);
  }
}

/* Counts a point. Keeps a copy of it as a sample, and the point itself if it is the most expensive one. Takes ownership
 * of the scene. */
static void take_point(struct plan *plan, struct looking *looking, struct scene *scene, bool sample) {
  const double work = scene->kind->work ? scene->kind->work(scene->inputs) : 1;
  const double memory = scene->kind->memory ? (double)scene->kind->memory(scene->inputs) : 0;
  plan->points_looked_at++;
  plan->memory_most = fmax(plan->memory_most, memory);
  looking->work += work;
  struct scene *copy = sample ? scene_copy(scene) : NULL;
  if (copy)
    looking->sample[looking->sampled++] = copy;
  if (looking->costliest && work <= looking->work_most) {
    scene_free(scene);
    return;
  }
  scene_free(looking->costliest);
  looking->costliest = scene;
  looking->work_most = work;
}

/* Samples points evenly spread over the part of the design that can be generated in a short time. */
static status look(const struct campaign *campaign, struct store *store, struct plan *plan, struct looking *looking,
                   struct error *error) {
  struct campaign_walk walk;
  struct error first = {0};
  status code = campaign_walk_begin(&walk, campaign, error);
  if (code != STATUS_OK)
    goto cleanup;
  plan->points = design_points(walk.design);
  const uint64_t walked = plan->points < WALKED ? plan->points : WALKED;
  const uint64_t stride = (walked + LOOKED_AT - 1) / LOOKED_AT;
  for (uint64_t i = 0; i < walked && campaign_walk_next(&walk); i++) {
    struct scene *scene = i % stride ? NULL : campaign_walk_scene(&walk, &first);
    if (!scene)
      continue;
    ask(campaign, scene, store, looking);
    take_point(plan, looking, scene, looking->sampled < SAMPLED && i >= looking->sampled * (walked / SAMPLED));
  }
  if (!looking->costliest)
    code = status_fail(error, STATUS_CONTENT, "no point of the design can be run: %s", first.message);
cleanup:
  campaign_walk_end(&walk);
  return code;
}

static double whole_s(const struct pilot_run *run) {
  return run->prepare_s + run->step_s + run->finish_s;
}

/* Mean time of a run over the sampled points divided by `one`, the time of such a run of the most expensive point.
 * Times whole runs, or coarse ones if a setting is given, until the time is used up. NaN: no point was timed. */
static double time_points(const struct campaign *campaign, const struct looking *looking, const char *setting,
                          double one, double until) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < looking->sampled && clock_cpu_s() < until; i++) {
    struct error ignored;
    struct pilot_run run = {0};
    const struct scene *point = looking->sample[i];
    struct scene *coarse = setting ? pilot_coarsen_like(point, setting) : NULL;
    if (setting && !coarse)
      continue;
    const uint64_t seed = campaign_seed(campaign, point, 0);
    const status code = pilot_try(coarse ? coarse : point, seed, until - clock_cpu_s(), &run, &ignored);
    scene_free(coarse);
    if (code != STATUS_OK || !run.finished)
      continue;
    sum += whole_s(&run);
    count++;
  }
  return count ? sum / (double)count / one : (double)NAN;
}

/* For a trial that did not end: estimates the time of the whole run, and gives the setting and time of a coarse run
 * that ended. */
static void extrapolate(const struct looking *looking, uint64_t seed, double seconds, const struct pilot_run *run,
                        struct plan *plan, char setting[64], double *one) {
  struct error ignored;
  struct scene *coarse = NULL;
  struct pilot_run *coarse_run = calloc(1, sizeof *coarse_run);
  plan->run_s_most = pilot_to_hard_end(run);
  if (coarse_run && looking->work_most > 0)
    pilot_coarsen(looking->costliest, plan->run_s_most / looking->work_most, seconds / 4, &coarse, setting);
  if (coarse && pilot_try(coarse, seed, seconds / 2, coarse_run, &ignored) == STATUS_OK) {
    const double whole = pilot_whole(run, coarse_run);
    plan->trial_whole = !isnan(whole);
    plan->run_s_most = plan->trial_whole ? whole : plan->run_s_most;
    *one = whole_s(coarse_run);
  }
  scene_free(coarse);
  free(coarse_run);
}

/* Runs the most expensive point for half of the time. If the run does not end, a coarse run of the same point tells
 * which share of the steps was made. Without a coarse run the time is extrapolated to the hard end, which most runs do
 * not reach. The rest of the time is used for runs of other points. */
static status try_run(const struct campaign *campaign, const struct looking *looking, double seconds, struct plan *plan,
                      size_t *fragments, struct error *error) {
  const uint64_t seed = campaign_seed(campaign, looking->costliest, 0);
  const double begin = clock_cpu_s();
  char setting[64] = "";
  struct pilot_run *run = calloc(1, sizeof *run);
  if (!run)
    return status_fail(error, STATUS_MEMORY, "no memory for the trial");
  const status code = pilot_try(looking->costliest, seed, seconds / 2, run, error);
  if (code != STATUS_OK)
    goto cleanup;
  plan->trial_made = true;
  if (looking->costliest->kind->threads)
    plan->threads = (double)*looking->costliest->kind->threads(looking->costliest->inputs);
  plan->trial_finished = plan->trial_whole = run->finished;
  plan->trial_progress = run->finished ? 1 : run->progress;
  *fragments = run->fragments;
  plan->run_s_most = whole_s(run);
  double one = plan->run_s_most;
  if (!run->finished)
    extrapolate(looking, seed, seconds, run, plan, setting, &one);
  if (plan->trial_whole)
    plan->share_of_most = time_points(campaign, looking, run->finished ? NULL : setting, one, begin + seconds);
  plan->trial_s = clock_cpu_s() - begin;
cleanup:
  free(run);
  return code;
}

static double kept_runs(const struct campaign *campaign, const struct plan *plan) {
  double per_point = (double)campaign_replicates_most(campaign);
  switch (campaign->keep) {
  case CAMPAIGN_KEEP_ALL: return (double)plan->runs_most;
  case CAMPAIGN_KEEP_EXTREMES: return (double)plan->points * fmin(per_point, 2);
  case CAMPAIGN_KEEP_FIRST: return (double)plan->points * fmin(per_point, (double)campaign->keep_first);
  default: return 0;
  }
}

/* Wall time on the slots: at least that of one run, and at least the manager's work for all runs. */
static double wall_time(uint64_t runs, double run_s, int slots) {
  if (runs == 0)
    return 0;
  const double shared = (double)runs * (run_s + SLOT_S) / (slots > 0 ? slots : 1);
  return fmax(fmax(shared, (double)runs * MANAGER_S), run_s);
}

static void add_up(const struct campaign *campaign, const struct plan_options *options, const struct looking *looking,
                   size_t fragments, struct plan *plan) {
  double share = looking->asked ? (double)looking->there / (double)looking->asked : 0;
  double looked = (double)plan->points_looked_at;
  plan->runs_least = plan->points * (uint64_t)campaign_replicates_least(campaign);
  plan->runs_most = plan->points * (uint64_t)campaign_replicates_most(campaign);
  plan->runs_there = (uint64_t)llround(share * (double)plan->runs_least);
  if (plan->trial_made) {
    plan->run_s_mean = looking->work_most > 0 ? plan->run_s_most * looking->work / looked / looking->work_most
                                              : plan->run_s_most;
    if (!isnan(plan->share_of_most)) {
      plan->run_s_mean = plan->run_s_most * plan->share_of_most;
      plan->run_s_most = fmax(plan->run_s_most, plan->run_s_mean);
    }
    plan->disk_bytes = (double)plan->runs_most * (BYTES_PER_RUN + BYTES_PER_FRAGMENT * (double)fragments);
  }
  plan->cpu_s_least = (double)(plan->runs_least - plan->runs_there) * (plan->run_s_mean + SLOT_S + MANAGER_S);
  plan->cpu_s_most = (double)(plan->runs_most - plan->runs_there) * (plan->run_s_mean + SLOT_S + MANAGER_S);
  const double run_wall_s = plan->run_s_mean / plan->threads;
  plan->wall_s_least = wall_time(plan->runs_least - plan->runs_there, run_wall_s, options->slots);
  plan->wall_s_most = wall_time(plan->runs_most - plan->runs_there, run_wall_s, options->slots);
  double kept = kept_runs(campaign, plan);
  plan->fields_bytes = kept > 0 ? kept * plan->memory_most : 0;
}

status plan_make(const struct campaign *campaign, const struct plan_options *options, struct plan *plan,
                 struct error *error) {
  *plan = (struct plan){.threads = 1,
                        .run_s_mean = NOTHING,
                        .run_s_most = NOTHING,
                        .disk_bytes = NOTHING,
                        .share_of_most = NOTHING};
  struct looking looking = {0};
  struct store *store = NULL;
  struct error ignored = {0};
  size_t fragments = 0;
  const char *path = options->store_path ? options->store_path : campaign->store;
  status code = store_open_reader(path, &store, error);
  plan->store_exists = code == STATUS_OK;
  if (code != STATUS_OK && code != STATUS_MISSING)
    return code;

  code = look(campaign, store, plan, &looking, error);
  if (code != STATUS_OK)
    goto cleanup;
  const struct scene *scene = looking.costliest;
  if (options->no_trial) {
    if (store)
      ask_run_wall_times(store, &plan->run_s_mean, &plan->run_s_most, &ignored);
  } else {
    code = try_run(campaign, &looking, options->trial_s > 0 ? options->trial_s : 5, plan, &fragments, error);
    if (code != STATUS_OK)
      goto cleanup;
  }
  if (scene->kind->describe)
    plan->model = scene->kind->describe(scene->inputs);
  add_up(campaign, options, &looking, fragments, plan);
cleanup:
  for (size_t i = 0; i < looking.sampled; i++)
    scene_free(looking.sample[i]);
  scene_free(looking.costliest);
  store_close(store, &ignored);
  return code;
}

void plan_clear(struct plan *plan) {
  free(plan->model);
  free(plan->alternatives);
  plan->model = plan->alternatives = NULL;
}
