/* Walks the design, times a trial run, and prints the plan as text or JSON. */
#include "campaign/driver/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/design/design.h"
#include "campaign/driver/run.h"
#include "campaign/terminal/progress.h"
#include "db/ask/run.h"
#include "db/store/store.h"
#include "schemas/clock.h"
#include "schemas/text.h"

enum { LOOKED_AT = 4096, WALKED = 4000000, ASKED = 50000 };
#define NOTHING ((double)NAN)

/* Bytes of a run's rows besides its masses: run and result row, eleven estimates, some twenty bins of its spectrum.
 * Measured on stores of thousands of runs; good to a factor of 1.5. */
#define BYTES_PER_RUN      3500.0
#define BYTES_PER_FRAGMENT 8.0

struct looking {
  double work, work_most;
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
  struct design *design = NULL;
  struct field_value *values = calloc(campaign->axis_count + 1, sizeof *values);
  if (!values)
    return status_fail(error, STATUS_MEMORY, "no memory for the plan");
  status code = design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                              (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &design, error);
  if (code != STATUS_OK)
    goto cleanup;
  plan->points = design_points(design);
  /* Points evenly spread over the design, as far as it can be walked in a moment. */
  uint64_t walked = plan->points < WALKED ? plan->points : WALKED, stride = (walked + LOOKED_AT - 1) / LOOKED_AT;
  struct error first = {0};
  for (uint64_t i = 0; i < walked && design_next(design, values); i++) {
    struct scene *scene = i % stride ? NULL : campaign_point_scene(campaign, values, &first);
    if (!scene)
      continue;
    double work = scene->kind->work ? scene->kind->work(scene->inputs) : 1;
    double memory = scene->kind->memory ? (double)scene->kind->memory(scene->inputs) : 0;
    plan->points_looked_at++;
    looking->work += work;
    plan->memory_most = fmax(plan->memory_most, memory);
    ask(campaign, scene, store, looking);
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
  design_free(design);
  free(values);
  return code;
}

/* Steps the most expensive point for a few seconds. A run that ends in this time is a measurement. Else the time is
 * extrapolated over the simulated time up to the hard end, which a run usually does not reach. */
static status try_run(const struct scene *scene, uint64_t seed, double seconds, struct plan *plan, size_t *fragments,
                      struct error *error) {
  const struct engine_kind *kind = scene->kind;
  void *run = NULL, *result = NULL;
  struct fragment *list = NULL;
  struct outcome outcome;
  double begin = clock_s(), prepared;
  uint64_t block = 1;
  bool finished = false;
  status code = kind->prepare(scene->inputs, seed, &run, error);
  if (code != STATUS_OK)
    return code;
  prepared = clock_s();
  while (code == STATUS_OK && !finished && clock_s() - begin < seconds) {
    double from = clock_s();
    code = kind->step(run, block, &finished, error);
    if (clock_s() - from < 0.02 && block < UINT64_C(1) << 40)
      block *= 2;
  }
  if (code != STATUS_OK)
    goto cleanup;
  plan->trial_made = true;
  plan->trial_finished = finished;
  plan->trial_progress = kind->progress ? kind->progress(run) : NOTHING;
  if (finished)
    plan->trial_progress = 1;
  double stepped = clock_s();
  result = calloc(1, kind->results->size);
  if (!result) {
    code = status_fail(error, STATUS_MEMORY, "no memory for the trial's result");
    goto cleanup;
  }
  code = kind->finish(run, &outcome, result, &list, fragments, error);
  plan->trial_s = clock_s() - begin;
  plan->run_s_most = plan->trial_progress > 0
                         ? (prepared - begin) + (stepped - prepared) / plan->trial_progress + (clock_s() - stepped)
                         : NOTHING;
cleanup:
  free(list);
  free(result);
  kind->free(run);
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
    plan->disk_bytes = (double)plan->runs_most * (BYTES_PER_RUN + BYTES_PER_FRAGMENT * (double)fragments);
  }
  plan->cpu_s_least = (double)(plan->runs_least - plan->runs_there) * plan->run_s_mean;
  plan->cpu_s_most = (double)(plan->runs_most - plan->runs_there) * plan->run_s_mean;
  int slots = options->slots > 0 ? options->slots : 1;
  /* No sooner than one run alone, however many slots. */
  plan->wall_s_least = fmax(plan->cpu_s_least / slots, plan->runs_least > plan->runs_there ? plan->run_s_mean : 0);
  plan->wall_s_most = fmax(plan->cpu_s_most / slots, plan->runs_most > plan->runs_there ? plan->run_s_mean : 0);
  double kept = kept_runs(campaign, plan);
  plan->fields_bytes = kept > 0 ? kept * plan->memory_most : 0;
}

status plan_make(const struct campaign *campaign, const struct plan_options *options, struct plan *plan,
                 struct error *error) {
  *plan = (struct plan){.run_s_mean = NOTHING, .run_s_most = NOTHING, .disk_bytes = NOTHING};
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
    const double trial_s = options->trial_s > 0 ? options->trial_s : 5;
    code = try_run(scene, campaign_seed(campaign, scene, 0), trial_s, plan, &fragments, error);
    if (code != STATUS_OK)
      goto cleanup;
  }
  if (scene->kind->describe)
    plan->model = scene->kind->describe(scene->inputs);
  add_up(campaign, options, &looking, fragments, plan);
cleanup:
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
    return " (one whole run timed)";
  return " (extrapolated to the hard end; runs stop earlier when fracture has ceased)";
}

void plan_print(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out) {
  static const char *const designs[] = {"grid", "list", "random", "latin hypercube", "Sobol"};
  char a[64], b[64];
  bool range = plan->runs_most != plan->runs_least;
  fprintf(out, "campaign  %s, scene %s\n", campaign->name, campaign->scene_reference);
  fprintf(out, "design    %s, %llu point%s", designs[campaign->design.kind], (unsigned long long)plan->points,
          plan->points == 1 ? "" : "s");
  for (size_t i = 0; i < campaign->axis_count; i++)
    fprintf(out, "%s%s", i ? ", " : " over ", campaign->axes[i].row->path);
  fprintf(out, "\nruns      %llu", (unsigned long long)plan->runs_least);
  if (range)
    fprintf(out, " to %llu (%s to ±%g)", (unsigned long long)plan->runs_most, campaign->until_quantity,
            campaign->until_half_width);
  fprintf(out, ", %llu of them in the store%s\n", (unsigned long long)plan->runs_there,
          plan->store_exists ? "" : " (there is none yet)");
  progress_duration(plan->run_s_mean, a, sizeof a);
  progress_duration(plan->run_s_most, b, sizeof b);
  fprintf(out, "a run     %s%s on average, %s for the most expensive%s\n",
          plan->trial_made && !plan->trial_finished ? "at most " : "", a, b, how_timed(plan));
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
  fprintf(
      out,
      ", \"points\": %llu, \"points_looked_at\": %llu, \"runs_least\": %llu, \"runs_most\": %llu, \"runs_there\": %llu",
      (unsigned long long)plan->points, (unsigned long long)plan->points_looked_at,
      (unsigned long long)plan->runs_least, (unsigned long long)plan->runs_most, (unsigned long long)plan->runs_there);
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
