/* Walks the design, times trial runs, and prints the plan as text or JSON. */
#include "campaign/driver/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/document/campaign_walk.h"
#include "campaign/document/campaign_warn.h"
#include "campaign/driver/pilot.h"
#include "campaign/terminal/progress.h"
#include "db/ask/run.h"
#include "db/store/store.h"
#include "schemas/clock.h"
#include "schemas/text.h"

enum { LOOKED_AT = 4096, WALKED = 4000000, ASKED = 50000, SAMPLED = 8 };
#define NOTHING ((double)NAN)

/* Bytes of a run's rows besides its masses: run and result row, eleven estimates, some twenty bins of its spectrum.
 * Measured on stores of thousands of runs; good to a factor of 1.5. */
#define BYTES_PER_RUN      3500.0
#define BYTES_PER_FRAGMENT 8.0

/* What a run costs besides itself, in s: its process (twice: of the slot, and pages of the child that the run touches),
 * and the manager's part, which one process does for all slots. Measured with 4500 runs of 0.3 ms and 70 fragments. */
#define SLOT_S    0.7e-3
#define MANAGER_S 0.8e-3

struct looking {
  double work, work_most;
  struct scene *sample[SAMPLED]; /* points spread over the design; owned */
  size_t sampled;
  struct scene *costliest; /* the point with the most work; owned */
  uint64_t asked, there;   /* runs looked up in the store */
};

/* Looks the point's runs up in the store, up to ASKED of them in all. */
static void ask(const struct campaign *campaign, const struct scene *scene, struct store *store,
                struct looking *looking) {
  for (int64_t r = 0; store && r < campaign_replicates_least(campaign) && looking->asked < ASKED; r++) {
    uint8_t identity[16];
    scene_identity(scene, campaign_seed(campaign, scene, r), identity);
    looking->asked++;
    looking->there += store_has_run(store, identity);
  }
}

static status look(const struct campaign *campaign, struct store *store, struct plan *plan, struct looking *looking,
                   struct error *error) {
  struct campaign_walk walk;
  status code = campaign_walk_begin(&walk, campaign, error);
  if (code != STATUS_OK)
    goto cleanup;
  plan->points = design_points(walk.design);
  /* Points evenly spread over the design, as far as it can be walked in a moment. */
  uint64_t walked = plan->points < WALKED ? plan->points : WALKED, stride = (walked + LOOKED_AT - 1) / LOOKED_AT;
  struct error first = {0};
  for (uint64_t i = 0; i < walked && campaign_walk_next(&walk); i++) {
    struct scene *scene = i % stride ? NULL : campaign_walk_scene(&walk, &first);
    if (!scene)
      continue;
    double work = scene->kind->work ? scene->kind->work(scene->inputs) : 1;
    double memory = scene->kind->memory ? (double)scene->kind->memory(scene->inputs) : 0;
    plan->points_looked_at++;
    looking->work += work;
    plan->memory_most = fmax(plan->memory_most, memory);
    ask(campaign, scene, store, looking);
    if (looking->sampled < SAMPLED && i >= looking->sampled * (walked / SAMPLED))
      looking->sample[looking->sampled] = scene_copy(scene);
    looking->sampled += looking->sampled < SAMPLED && looking->sample[looking->sampled];
    if (!looking->costliest || work > looking->work_most) {
      looking->work_most = work;
      scene_free(looking->costliest);
      looking->costliest = scene;
    } else {
      scene_free(scene);
    }
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

/* A run's time over the whole design, from sampled points: whole runs, or with a setting coarse ones, as long as there
 * is time. `one`: such a run of the most expensive point. Returns the mean over points divided by that. NaN: no point.
 */
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

/* Steps the most expensive point for half of the time. If it does not end, a coarse run of the same point tells which
 * share of the steps that was; if there is none, the time is extrapolated to the hard end, which most runs do not
 * reach. The rest of the time tells how other points differ. */
static status try_run(const struct campaign *campaign, const struct looking *looking, double seconds, struct plan *plan,
                      size_t *fragments, struct error *error) {
  const struct scene *scene = looking->costliest;
  const uint64_t seed = campaign_seed(campaign, scene, 0);
  const double begin = clock_cpu_s();
  struct pilot_run *run = calloc(2, sizeof *run), *coarse_run = run + 1;
  struct scene *coarse = NULL;
  char setting[64] = "";
  if (!run)
    return status_fail(error, STATUS_MEMORY, "no memory for the trial");
  status code = pilot_try(scene, seed, seconds / 2, run, error);
  if (code != STATUS_OK)
    goto cleanup;
  plan->trial_made = true;
  plan->trial_finished = plan->trial_whole = run->finished;
  plan->trial_progress = run->finished ? 1 : run->progress;
  *fragments = run->fragments;
  plan->run_s_most = whole_s(run);
  double one = plan->run_s_most;
  if (!run->finished) {
    plan->run_s_most = run->prepare_s + run->step_s / run->progress + run->finish_s;
    if (looking->work_most > 0)
      pilot_coarsen(scene, plan->run_s_most / looking->work_most, seconds / 4, &coarse, setting);
    if (coarse && pilot_try(coarse, seed, seconds / 2, coarse_run, error) == STATUS_OK) {
      const double whole = pilot_whole(run, coarse_run);
      plan->trial_whole = !isnan(whole);
      plan->run_s_most = plan->trial_whole ? whole : plan->run_s_most;
      one = whole_s(coarse_run);
    }
  }
  if (plan->trial_whole)
    plan->share_of_most = time_points(campaign, looking, run->finished ? NULL : setting, one, begin + seconds);
  plan->trial_s = clock_cpu_s() - begin;
cleanup:
  scene_free(coarse);
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

/* No sooner than one run alone, however many slots, and no faster than the one manager. */
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
  plan->wall_s_least = wall_time(plan->runs_least - plan->runs_there, plan->run_s_mean, options->slots);
  plan->wall_s_most = wall_time(plan->runs_most - plan->runs_there, plan->run_s_mean, options->slots);
  double kept = kept_runs(campaign, plan);
  plan->fields_bytes = kept > 0 ? kept * plan->memory_most : 0;
}

status plan_make(const struct campaign *campaign, const struct plan_options *options, struct plan *plan,
                 struct error *error) {
  *plan = (struct plan){.run_s_mean = NOTHING, .run_s_most = NOTHING, .disk_bytes = NOTHING, .share_of_most = NOTHING};
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

static const char *bytes(double count, char *buffer, size_t size) {
  static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  int unit = 0;
  if (isnan(count))
    return "?";
  for (; count >= 999.5 && unit < 5; unit++)
    count /= 1000;
  snprintf(buffer, size, unit ? "%.3g %s" : "%.0f %s", count, units[unit]);
  return buffer;
}

/* Where the times of a run come from. */
static const char *how_timed(const struct plan *plan) {
  if (!plan->trial_made)
    return isnan(plan->run_s_mean) ? " (no trial run)" : " (from runs in the store)";
  if (plan->trial_finished)
    return " (whole runs timed)";
  if (plan->trial_whole)
    return " (the first steps timed; a coarse run tells when it ends)";
  return " (extrapolated to the hard end; runs stop earlier when fracture has ceased)";
}

void plan_print(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out) {
  static const char *const designs[] = {"grid", "list", "random", "latin hypercube", "Sobol"};
  char a[64], b[64];
  bool range = plan->runs_most != plan->runs_least;
  fprintf(out, "campaign  %s, scene %s\n", campaign->name, campaign->scene_reference);
  fprintf(out, "design    %s, %llu point%s", designs[campaign->design.kind], (unsigned long long)plan->points,
          plan->points == 1 ? "" : "s");
  for (size_t i = 0; i < campaign->axis_count; i++) {
    fprintf(out, "\n%-8s  %s: ", i ? "" : "over", campaign->axes[i].row->path);
    design_axis_describe(campaign->axes, i, out);
  }
  fputc('\n', out);
  campaign_warn(campaign, "warning   ", out);
  fprintf(out, "runs      %llu", (unsigned long long)plan->runs_least);
  if (range)
    fprintf(out, " to %llu (%s to ±%g)", (unsigned long long)plan->runs_most, campaign->until_quantity,
            campaign->until_half_width);
  fprintf(out, ", %llu of them in the store%s\n", (unsigned long long)plan->runs_there,
          plan->store_exists ? "" : " (there is none yet)");
  progress_duration(plan->run_s_mean, a, sizeof a);
  progress_duration(plan->run_s_most, b, sizeof b);
  fprintf(out, "a run     %s%s on average, %s for the most expensive%s\n",
          plan->trial_made && !plan->trial_whole ? "at most " : "", a, b, how_timed(plan));
  progress_duration(plan->wall_s_least, a, sizeof a);
  progress_duration(plan->wall_s_most, b, sizeof b);
  fprintf(out, "time      %s", a);
  if (range)
    fprintf(out, " to %s", b);
  progress_duration(plan->cpu_s_most, a, sizeof a);
  fprintf(out, " on %d slot%s (%s of processor time)\n", slots, slots == 1 ? "" : "s", a);
  fprintf(out, "memory    %s per run", bytes(plan->memory_most, a, sizeof a));
  fprintf(out, ", %s on all slots\n", bytes(plan->memory_most * slots, a, sizeof a));
  fprintf(out, "disk      %s for the store %s", bytes(plan->disk_bytes, a, sizeof a), campaign->store);
  if (campaign->keep != CAMPAIGN_KEEP_NONE)
    fprintf(out, ", at most %s for fields", bytes(plan->fields_bytes, b, sizeof b));
  fputc('\n', out);
  if (plan->points_looked_at < plan->points)
    fprintf(out, "          (averages over %llu of the points)\n", (unsigned long long)plan->points_looked_at);
  if (plan->model)
    fprintf(out, "\n%s%s", plan->model, plan->model[0] && plan->model[strlen(plan->model) - 1] == '\n' ? "" : "\n");
}

static void number(FILE *out, const char *name, double value) {
  if (isfinite(value))
    fprintf(out, ", \"%s\": %.17g", name, value);
  else
    fprintf(out, ", \"%s\": null", name);
}

static void axis_json(const struct campaign *campaign, size_t index, FILE *out) {
  char *values = NULL;
  size_t size = 0;
  FILE *text = open_memstream(&values, &size);
  if (!text)
    return;
  design_axis_describe(campaign->axes, index, text);
  const struct field *row = campaign->axes[index].row;
  fputs(index ? ", {\"path\": " : "{\"path\": ", out);
  text_json_string(row->path, out);
  fputs(", \"unit\": ", out);
  text_json_string(row->unit ? row->unit : "", out);
  fputs(", \"values\": ", out);
  text_json_string(fclose(text) == 0 ? values : "", out);
  fputc('}', out);
  free(values);
}

char *plan_json(const struct campaign *campaign, const struct plan *plan, int slots) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  fputs("{\"campaign\": ", out);
  text_json_string(campaign->name, out);
  fputs(", \"scene\": ", out);
  text_json_string(campaign->scene_reference, out);
  fputs(", \"store\": ", out);
  text_json_string(campaign->store, out);
  fputs(", \"axes\": [", out);
  for (size_t i = 0; i < campaign->axis_count; i++)
    axis_json(campaign, i, out);
  fprintf(out,
          "], \"points\": %llu, \"points_looked_at\": %llu, \"runs_least\": %llu, \"runs_most\": %llu, \"runs_there\": "
          "%llu",
          (unsigned long long)plan->points, (unsigned long long)plan->points_looked_at,
          (unsigned long long)plan->runs_least, (unsigned long long)plan->runs_most,
          (unsigned long long)plan->runs_there);
  fprintf(out, ", \"store_exists\": %s, \"trial_made\": %s, \"trial_finished\": %s, \"slots\": %d",
          plan->store_exists ? "true" : "false", plan->trial_made ? "true" : "false",
          plan->trial_finished ? "true" : "false", slots);
  number(out, "run_s_mean", plan->run_s_mean);
  number(out, "run_s_most", plan->run_s_most);
  number(out, "cpu_s_least", plan->cpu_s_least);
  number(out, "cpu_s_most", plan->cpu_s_most);
  number(out, "wall_s_least", plan->wall_s_least);
  number(out, "wall_s_most", plan->wall_s_most);
  number(out, "memory_most_bytes", plan->memory_most);
  number(out, "disk_bytes", plan->disk_bytes);
  number(out, "fields_bytes", plan->fields_bytes);
  if (plan->alternatives)
    fprintf(out, ", \"alternatives\": %s", plan->alternatives);
  fputs(", \"model\": ", out);
  text_json_string(plan->model ? plan->model : "", out);
  fputs("}\n", out);
  return text_close(out, &text);
}
