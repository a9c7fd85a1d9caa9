/* Predicts a campaign: times trial runs, walks the design, and prints what it found. */
#include "campaign/scheduler/scheduler.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/ladder.h"
#include "campaign/scheduler/point.h"
#include "campaign/terminal/words.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

/* ---- trials ---- */

enum { HALVINGS = 20 };

static void mark(struct plan_trial *run) {
  if (run->marks == PLAN_MARKS) { /* keep every other one */
    for (size_t i = 0; i < PLAN_MARKS / 2; i++) {
      run->mark_steps[i] = run->mark_steps[2 * i + 1];
      run->mark_progress[i] = run->mark_progress[2 * i + 1];
    }
    run->marks = PLAN_MARKS / 2;
  }
  run->mark_steps[run->marks] = run->steps;
  run->mark_progress[run->marks++] = run->progress;
}

static status step(const struct engine_kind *kind, void *state, double until, struct plan_trial *run,
                   struct error *error) {
  uint64_t block = 1;
  status code = STATUS_OK;
  while (code == STATUS_OK && !run->finished && clock_cpu_with_children_s() < until) {
    const double from = clock_cpu_with_children_s();
    code = kind->step(state, block, &run->finished, error);
    const double took = clock_cpu_with_children_s() - from;
    run->step_s += took;
    run->steps += (double)block;
    run->progress = kind->progress ? kind->progress(state) : (double)NAN;
    mark(run);
    if (took < 0.002 && block < UINT64_C(1) << 40)
      block *= 2;
  }
  return code;
}

status plan_try(const struct scene *scene, uint64_t seed, double seconds, struct plan_trial *run, struct error *error) {
  const struct engine_kind *kind = scene->kind;
  void *state = NULL;
  OWNED void *result = NULL;
  OWNED struct fragment *list = NULL;
  struct outcome outcome;
  const double begin = clock_cpu_with_children_s();
  *run = (struct plan_trial){.expected = kind->steps ? kind->steps(scene->inputs) : (double)NAN};
  SCENE alone = scene_copy(scene); /* one thread: the processor time of several includes their waiting */
  if (kind->threads)
    *kind->threads(alone->inputs) = 1;
  TRY(kind->prepare(alone->inputs, seed, &state, error));
  run->prepare_s = clock_cpu_with_children_s() - begin;
  status code = step(kind, state, begin + seconds, run, error);
  if (code == STATUS_OK) {
    const double stepped = clock_cpu_with_children_s();
    result = memory_small(1, kind->results->size);
    code = kind->finish(state, &outcome, result, &list, &run->fragments, error);
    run->finish_s = clock_cpu_with_children_s() - stepped;
  }
  kind->free(state);
  return code;
}

/* Number of steps that the run had made at this progress. NaN: the run did not reach it. */
static double steps_at(const struct plan_trial *run, double progress) {
  double steps = 0, before = 0;
  for (size_t i = 0; i < run->marks; i++) {
    if (run->mark_progress[i] >= progress)
      return steps + (run->mark_steps[i] - steps) * (progress - before) / (run->mark_progress[i] - before);
    steps = run->mark_steps[i];
    before = run->mark_progress[i];
  }
  return NAN;
}

double plan_whole(const struct plan_trial *piece, const struct plan_trial *coarse) {
  const double steps = steps_at(coarse, piece->progress);
  if (!coarse->finished || !(steps > 0))
    return NAN;
  return piece->prepare_s + piece->step_s * coarse->steps / steps + piece->finish_s;
}

double plan_to_hard_end(const struct plan_trial *piece) {
  /* The first steps of an impact are the shortest: then the engine's number of steps tells more than the time reached.
   */
  const double pieces = fmin(1 / piece->progress, piece->expected / piece->steps);
  return piece->prepare_s + piece->step_s * fmax(pieces, 1) + piece->finish_s;
}

/* The first knob of the engine with a step that applies to the scene: its number of particles or grains. */
static const struct knob *size_knob(const struct scene *scene, double *own) {
  for (const struct knob *knob = scene->kind->knobs; knob && knob->name; knob++) {
    if (knob->step_power == 0)
      continue;
    struct field_value value;
    const struct field *row = field_find(scene->kind->inputs, knob->inputs[0].path, NULL);
    if (!row || !field_is_active(scene->kind->inputs, row, scene->inputs))
      return NULL;
    field_get(row, scene->inputs, &value);
    *own = field_number(&value);
    return knob;
  }
  return NULL;
}

void plan_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]) {
  double own = NAN;
  const struct knob *knob = scene->kind->work ? size_knob(scene, &own) : NULL;
  *coarse = NULL;
  setting[0] = '\0';
  for (int i = 1; knob && i < HALVINGS; i++) {
    char text[64];
    const double value = knob->step_power < 0 ? own / pow(2, i) : own * pow(2, 0.5 * i);
    snprintf(text, sizeof text, "%.4g", value >= 100 ? round(value) : value);
    struct scene *next = plan_coarsen_like(scene, text);
    if (!next)
      return;
    scene_free(*coarse);
    *coarse = next;
    snprintf(setting, 64, "%s", text);
    if (next->kind->work(next->inputs) * rate <= seconds)
      return;
  }
}

struct scene *plan_coarsen_like(const struct scene *scene, const char *setting) {
  double own;
  struct error ignored;
  const struct knob *knob = size_knob(scene, &own);
  struct scene *copy = knob ? scene_copy(scene) : NULL;
  if (copy && ladder_turn(knob, copy, setting, &ignored) != STATUS_OK) {
    scene_free(copy);
    return NULL;
  }
  return copy;
}

/* ---- the plan ---- */

enum { LOOKED_AT = 4096, WALKED = 4000000, ASKED = 50000, SAMPLED = PLAN_SAMPLES };
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
  struct scene *costliest;    /* the point with the most work; owned */
  uint64_t asked, there;      /* runs looked up in the store */
  uint64_t timed;             /* of those that are there, with their times: */
  double wall_s, wall_s_most; /* sum and longest */
  double cpu_s;               /* sum of processor time */
  /* With `until`: runs that the rule needs by those in the store, and how many of these are there; points that ended.
   */
  uint64_t least, most, judged_there, ended;
  uint8_t seen[LOOKED_AT][16]; /* identities of the points' first runs */
  size_t seen_count;
};

/* Equal points of a list or a file are computed once. */
static bool is_new(const struct campaign *campaign, const struct scene *scene, struct looking *looking) {
  uint8_t *identity = looking->seen[looking->seen_count];
  scene_identity(scene, campaign_seed(campaign, scene, 0), identity);
  for (size_t i = 0; i < looking->seen_count; i++)
    if (memcmp(looking->seen[i], identity, sizeof looking->seen[i]) == 0)
      return false;
  looking->seen_count++;
  return true;
}

/* Looks up the point's runs in the store, at most ASKED runs for all points together. */
static void ask(const struct campaign *campaign, const struct scene *scene, struct store *store,
                struct looking *looking) {
  for (int64_t r = 0; store && r < campaign_replicates_least(campaign) && looking->asked < ASKED; r++) {
    uint8_t identity[16];
    scene_identity(scene, campaign_seed(campaign, scene, r), identity);
    looking->asked++;
    double seconds, cpu_s;
    struct error ignored;
    if (!store_has_run(store, identity))
      continue;
    looking->there++;
    if (ask_run_wall_time(store, identity, &seconds, &cpu_s, &ignored) || isnan(seconds))
      continue;
    looking->timed++;
    looking->wall_s += seconds;
    looking->cpu_s += cpu_s;
    looking->wall_s_most = fmax(looking->wall_s_most, seconds);
  }
}

/* Applies the stopping rule to the point's runs in the store. */
static status judge(const struct campaign *campaign, const struct scene *scene, struct store *store,
                    struct looking *looking, struct error *error) {
  const struct engine_kind *kind = scene->kind;
  struct point *point = point_create(campaign, scene_copy(scene));
  int64_t id = 0;
  bool of_outcome;
  const struct field *row = campaign_quantity(kind, campaign->until_quantity, &of_outcome, error);
  status code = !row ? STATUS_CONTENT : store ? store_point_find(store, scene, &id, error) : STATUS_OK;
  if (code == STATUS_OK && id) {
    ANSWER stored = ask_run_of_point(store, id, kind, row, of_outcome, error);
    for (struct ask_run_of_point run; ask_run_of_point_next(&stored, &run);) {
      const int64_t r = scheduler_replicate(campaign, scene, &run);
      if (r >= 0 && r < campaign_replicates_most(campaign) && point_reserve(point, r))
        point_finish_replicate(point, r, POINT_DONE, point_value(point, row, &run));
    }
    code = answer_end(&stored);
  }
  point_judge(point);
  const int64_t rule = campaign_replicates_least(campaign),
                least = point->decided || point->prefix > rule ? point->prefix : rule;
  for (int64_t r = 0; r < least && r < point->capacity; r++)
    looking->judged_there += point->replicates[r].state == POINT_DONE;
  looking->ended += point->decided;
  looking->least += (uint64_t)least;
  looking->most += (uint64_t)(point->decided ? least : campaign_replicates_most(campaign));
  point_free(point);
  return code;
}

static double work_of(const struct scene *scene) {
  return scene->kind->work ? scene->kind->work(scene->inputs) : 1;
}

/* Counts a point. Keeps a copy of it as a sample, and the point itself if it is the most expensive one. Takes ownership
 * of the scene. */
static void take_point(struct plan *plan, struct looking *looking, struct scene *scene, bool sample) {
  const double work = work_of(scene);
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

bool plan_is_sample(uint64_t i, uint64_t points, size_t before) {
  return before < SAMPLED && 2 * SAMPLED * (i + 1) > (2 * before + 1) * points;
}

/* Samples points evenly spread over the part of the design that can be generated in a short time. */
static status look(const struct campaign *campaign, struct store *store, struct plan *plan, struct looking *looking,
                   struct error *error) {
  CAMPAIGN_WALK walk = {0};
  struct error first = {0};
  TRY(campaign_walk_begin(&walk, campaign, error));
  plan->points = design_points(walk.design);
  const uint64_t walked = plan->points < WALKED ? plan->points : WALKED;
  const uint64_t stride = (walked + LOOKED_AT - 1) / LOOKED_AT;
  for (uint64_t i = 0; i < walked && campaign_walk_next(&walk); i++) {
    struct scene *scene = i % stride ? NULL : campaign_walk_scene(&walk, &first);
    if (!scene)
      continue;
    if (stride == 1 && !is_new(campaign, scene, looking)) {
      plan->points--;
      scene_free(scene);
      continue;
    }
    ask(campaign, scene, store, looking);
    if (campaign->per_point == 0 && stride == 1)
      TRY(judge(campaign, scene, store, looking, error));
    take_point(plan, looking, scene, plan_is_sample(i, walked, looking->sampled));
  }
  return looking->costliest
             ? STATUS_OK
             : status_fail(error, STATUS_CONTENT, "no point of the design can be run: %s", first.message);
}

static double whole_s(const struct plan_trial *run) {
  return run->prepare_s + run->step_s + run->finish_s;
}

double plan_mean(const struct plan_samples *samples, double mean_work) {
  return samples->work > 0 ? samples->seconds / samples->work * mean_work : (double)NAN;
}

/* Times whole runs of the sampled points, or coarse ones if a setting is given, until the time is used up. */
static void time_points(const struct campaign *campaign, const struct looking *looking, const char *setting,
                        double until, struct plan_samples *samples) {
  for (size_t i = 0; i < looking->sampled && clock_cpu_with_children_s() < until; i++) {
    struct error ignored;
    struct plan_trial run = {0};
    const struct scene *point = looking->sample[i];
    struct scene *coarse = setting ? plan_coarsen_like(point, setting) : NULL;
    if (setting && !coarse)
      continue;
    const uint64_t seed = campaign_seed(campaign, point, 0);
    const status code = plan_try(coarse ? coarse : point, seed, until - clock_cpu_with_children_s(), &run, &ignored);
    scene_free(coarse);
    if (code != STATUS_OK || !run.finished)
      continue;
    samples->seconds += whole_s(&run);
    samples->work += work_of(point);
    samples->most = fmax(samples->most, whole_s(&run));
  }
}

/* For a trial that did not end: estimates the time of the whole run, and gives the setting and time of a coarse run
 * that ended. */
static void extrapolate(const struct looking *looking, uint64_t seed, double seconds, const struct plan_trial *run,
                        struct plan *plan, char setting[64], double *one) {
  struct error ignored;
  struct scene *coarse = NULL;
  struct plan_trial coarse_run = {0};
  plan->run_s_most = plan_to_hard_end(run);
  if (looking->work_most > 0)
    plan_coarsen(looking->costliest, plan->run_s_most / looking->work_most, seconds / 4, &coarse, setting);
  if (coarse && plan_try(coarse, seed, seconds / 2, &coarse_run, &ignored) == STATUS_OK) {
    const double whole = plan_whole(run, &coarse_run);
    plan->trial_whole = !isnan(whole);
    plan->run_s_most = plan->trial_whole ? whole : plan->run_s_most;
    *one = whole_s(&coarse_run);
  }
  scene_free(coarse);
}

/* Runs the most expensive point for half of the time. If the run does not end, a coarse run of the same point tells
 * which share of the steps was made. Without a coarse run the time is extrapolated to the hard end, which most runs do
 * not reach. The rest of the time is used for runs of other points. */
static status try_run(const struct campaign *campaign, const struct looking *looking, double seconds, struct plan *plan,
                      size_t *fragments, struct error *error) {
  const struct scene *scene = looking->costliest;
  const uint64_t seed = campaign_seed(campaign, scene, 0);
  const double begin = clock_cpu_with_children_s();
  char setting[64] = "";
  struct plan_trial run = {0};
  TRY(plan_try(scene, seed, seconds / 2, &run, error));
  plan->trial_made = true;
  if (scene->kind->threads)
    plan->threads = (double)*scene->kind->threads(scene->inputs);
  plan->trial_finished = plan->trial_whole = run.finished;
  *fragments = run.fragments;
  plan->run_s_most = whole_s(&run);
  double one = plan->run_s_most;
  if (!run.finished)
    extrapolate(looking, seed, seconds, &run, plan, setting, &one);
  struct plan_samples samples = {0};
  if (plan->trial_whole)
    time_points(campaign, looking, run.finished ? NULL : setting, begin + seconds, &samples);
  const double whole = plan->run_s_most / one, mean_work = looking->work / (double)plan->points_looked_at;
  plan->run_s_mean = whole * plan_mean(&samples, mean_work);
  plan->run_s_most = fmax(plan->run_s_most, whole * samples.most);
  return STATUS_OK;
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
  return isnan(run_s) ? run_s : fmax(fmax(shared, (double)runs * MANAGER_S), run_s);
}

static void add_up(const struct campaign *campaign, const struct plan_options *options, const struct looking *looking,
                   size_t fragments, struct plan *plan) {
  double share = looking->asked ? (double)looking->there / (double)looking->asked : 0;
  double looked = (double)plan->points_looked_at;
  plan->runs_least = plan->points * (uint64_t)campaign_replicates_least(campaign);
  plan->runs_most = plan->points * (uint64_t)campaign_replicates_most(campaign);
  plan->runs_there = (uint64_t)llround(share * (double)plan->runs_least);
  if (looking->least && plan->points_looked_at == plan->points) {
    plan->runs_least = looking->least;
    plan->runs_most = looking->most;
    plan->runs_there = looking->judged_there;
    plan->points_ended = looking->ended;
  }
  if (plan->trial_made) {
    if (isnan(plan->run_s_mean)) /* no other point was timed */
      plan->run_s_mean = looking->work_most > 0 ? plan->run_s_most * looking->work / looked / looking->work_most
                                                : plan->run_s_most;
    plan->disk_bytes = (double)plan->runs_most * (BYTES_PER_RUN + BYTES_PER_FRAGMENT * (double)fragments);
  } else if (looking->timed) {
    plan->run_s_mean = looking->wall_s / (double)looking->timed;
    plan->run_s_most = looking->wall_s_most;
  }
  plan->run_s_most = fmax(plan->run_s_most, plan->run_s_mean); /* points are timed apart, with noise */
  /* Runs of the store have both times: on a busy machine the processor time is shorter. */
  const bool stored = !plan->trial_made && looking->timed && looking->cpu_s > 0;
  const double cpu_s = (stored ? looking->cpu_s / (double)looking->timed : plan->run_s_mean) + SLOT_S + MANAGER_S;
  plan->cpu_s_least = (double)(plan->runs_least - plan->runs_there) * cpu_s;
  plan->cpu_s_most = (double)(plan->runs_most - plan->runs_there) * cpu_s;
  const double run_wall_s = plan->run_s_mean / plan->threads;
  plan->wall_s_least = wall_time(plan->runs_least - plan->runs_there, run_wall_s, options->slots);
  plan->wall_s_most = wall_time(plan->runs_most - plan->runs_there, run_wall_s, options->slots);
  double kept = kept_runs(campaign, plan);
  plan->fields_bytes = kept > 0 ? kept * plan->memory_most : 0;
}

status plan_make(const struct campaign *campaign, const struct plan_options *options, struct plan *plan,
                 struct error *error) {
  *plan = (struct plan){.threads = 1, .run_s_mean = NOTHING, .run_s_most = NOTHING, .disk_bytes = NOTHING};
  struct looking looking = {0};
  struct store *store = NULL;
  struct error ignored = {0};
  size_t fragments = 0;
  const char *path = options->store_path ? options->store_path : campaign->store;
  plan->store = path;
  status code = store_open_reader(path, &store, error);
  plan->store_exists = code == STATUS_OK;
  if (code != STATUS_OK && code != STATUS_MISSING)
    return code;

  code = look(campaign, store, plan, &looking, error);
  const struct scene *scene = looking.costliest;
  const bool complete = looking.timed > 0 && looking.there == looking.asked &&
                        (campaign->per_point > 0 || looking.ended == plan->points); /* nothing is left to predict */
  const bool trial = !options->no_trial && !complete && (!scene || !engine_ready(scene->kind, scene->inputs, &ignored));
  if (code == STATUS_OK && trial)
    code = try_run(campaign, &looking, options->trial_s > 0 ? options->trial_s : 5, plan, &fragments, error);
  if (code == STATUS_OK && !trial && looking.timed == 0 && store &&
      !scene->kind->work) /* all points count as one work */
    code = ask_run_wall_times(store, scene->name, &looking.timed, &looking.wall_s, &looking.wall_s_most, &looking.cpu_s,
                              error);
  if (code == STATUS_OK) {
    plan->model = scene->kind->describe ? scene->kind->describe(scene->inputs, options->all) : NULL;
    if (scene->kind->work) /* else all points count as one work */
      design_axis_show_point(campaign->axis_count, campaign->axes, scene->inputs, plan->costliest,
                             sizeof plan->costliest);
    add_up(campaign, options, &looking, fragments, plan);
  }
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

/* ---- as text and as JSON ---- */

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
    return " (from runs in the store)";
  if (plan->trial_finished)
    return " (whole runs timed)";
  if (plan->trial_whole)
    return " (the first steps timed; a coarse run tells when it ends)";
  return " (extrapolated to stop.end_time; runs stop earlier when fracture has ceased)";
}

static void print_design(const struct campaign *campaign, const struct plan *plan, FILE *out) {
  static FIELD_WORDS(designs,
                     CAMPAIGN_DESIGNS, [CAMPAIGN_GRID] = "grid", [CAMPAIGN_LIST] = "list", [CAMPAIGN_RANDOM] = "random",
                     [CAMPAIGN_LATIN_HYPERCUBE] = "latin hypercube", [CAMPAIGN_SOBOL] = "Sobol");
  fprintf(out, "campaign  %s, scene %s\n", campaign->name, campaign->scene_reference);
  fprintf(out, "design    %s, %llu point%s", designs[campaign->design.kind], (unsigned long long)plan->points,
          plan->points == 1 ? "" : "s");
  fputc('\n', out);
  for (size_t i = 0; i < campaign->axis_count; i++) {
    OWNED char *values = NULL;
    FILE *text = text_open(&values);
    design_axis_describe(campaign->axes, i, text);
    text_close_small(text, &values);
    char shown[2000] = "";
    text_append(shown, sizeof shown, "%s", values);
    text_powers(shown, sizeof shown);
    words_print(out, i ? "          " : "over      ", "%s: %s", campaign->axes[i].row->path, shown);
  }
}

static void print_times(const struct plan *plan, int slots, FILE *out) {
  char a[64], b[64];
  if (isnan(plan->run_s_mean) && plan->runs_least > plan->runs_there) {
    fputs("time      not known without a trial run\n", out);
    return;
  }
  progress_duration(plan->run_s_mean, a, sizeof a);
  progress_duration(plan->run_s_most, b, sizeof b);
  words_print(out, "a run     ", "%s%s on average, %s for the most expensive%s",
              plan->trial_made && !plan->trial_whole ? "at most " : "", a, b, how_timed(plan));
  progress_duration(plan->wall_s_least, a, sizeof a);
  progress_duration(plan->wall_s_most, b, sizeof b);
  fprintf(out, "time      %s", a);
  if (plan->wall_s_most > plan->wall_s_least)
    fprintf(out, " to %s", b);
  fprintf(out, " on %d slot%s", slots, slots == 1 ? "" : "s");
  if (plan->threads > 1)
    fprintf(out, " of %.0f threads", plan->threads);
  progress_duration(plan->cpu_s_least, a, sizeof a);
  progress_duration(plan->cpu_s_most, b, sizeof b);
  fprintf(out, " (%s%s%s of processor time)\n", a, strcmp(a, b) ? " to " : "", strcmp(a, b) ? b : "");
}

static void print(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out) {
  char a[64], b[64], ended[64] = "", until[2 * FIELD_TEXT_SIZE] = "";
  print_design(campaign, plan, out);
  campaign_warn(campaign, "warning   ", out);

  if (plan->points_ended)
    snprintf(ended, sizeof ended, "; %llu of %llu points have ended", (unsigned long long)plan->points_ended,
             (unsigned long long)plan->points);
  if (plan->points_ended == plan->points)
    snprintf(until, sizeof until, " (every point has met seeds.until or has seeds.max runs)");
  else if (plan->runs_most != plan->runs_least)
    snprintf(until, sizeof until,
             " to %llu (%s to ±%g%s%s; at least %lld seeds a point, as few can be alike by chance%s)",
             (unsigned long long)plan->runs_most, campaign->until_quantity,
             campaign->until_half_width * campaign->until_scale, campaign->until_unit,
             campaign->until_of_value ? " of its mean" : "", (long long)campaign_replicates_least(campaign), ended);
  snprintf(a, sizeof a, plan->store_exists ? "%llu of them in the store" : "no store yet",
           (unsigned long long)plan->runs_there);
  words_print(out, "runs      ", "%llu%s, %s", (unsigned long long)plan->runs_least, until, a);
  print_times(plan, slots, out);
  if (plan->memory_most > 0)
    fprintf(out, "memory    %s per run, %s on all slots\n", bytes(plan->memory_most, a, sizeof a),
            bytes(plan->memory_most * slots, b, sizeof b));
  else
    fputs("memory    not known: the scene sets no limits: memory for its program\n", out);
  if (plan->runs_there < plan->runs_most) {
    fprintf(out, "disk      %s for the store %s", bytes(plan->disk_bytes, a, sizeof a), plan->store);
    if (campaign->keep != CAMPAIGN_KEEP_NONE)
      fprintf(out, ", at most %s for fields", bytes(plan->fields_bytes, b, sizeof b));
    fputc('\n', out);
  }
  if (plan->points_looked_at < plan->points)
    fprintf(out, "          (averages over %llu of the points)\n", (unsigned long long)plan->points_looked_at);

  if (plan->model) {
    fputc('\n', out);
    if (*plan->costliest)
      words_print(out, "", "the most expensive point, %s:", plan->costliest);
    text_wrap_lines(plan->model, 100, out);
  }
}

static void number(FILE *out, const char *name, double value) {
  if (isfinite(value))
    fprintf(out, ", \"%s\": %.17g", name, value);
  else
    fprintf(out, ", \"%s\": null", name);
}

static void axis_json(const struct campaign *campaign, size_t index, FILE *out) {
  OWNED char *values = NULL;
  FILE *text = text_open(&values);
  design_axis_describe(campaign->axes, index, text);
  const struct field *row = campaign->axes[index].row;
  fputs(index ? ", {\"path\": " : "{\"path\": ", out);
  text_json_string(row->path, out);
  fputs(", \"unit\": ", out);
  text_json_string(row->unit ? row->unit : "", out);
  fputs(", \"values\": ", out);
  text_json_string(text_close(text, &values) ? values : "", out);
  fputc('}', out);
}

char *plan_print_json(const struct campaign *campaign, const struct plan *plan, int slots) {
  char *text = NULL;
  FILE *out = text_open(&text);
  fputs("{\"campaign\": ", out);
  text_json_string(campaign->name, out);
  fputs(", \"scene\": ", out);
  text_json_string(campaign->scene_reference, out);
  fputs(", \"store\": ", out);
  text_json_string(plan->store, out);
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
  number(out, "memory_most_bytes", plan->memory_most > 0 ? plan->memory_most : (double)NAN);
  number(out, "disk_bytes", plan->disk_bytes);
  number(out, "fields_bytes", plan->fields_bytes);
  if (plan->alternatives)
    fprintf(out, ", \"alternatives\": %s", plan->alternatives);
  fputs(", \"model\": ", out);
  text_json_string(plan->model ? plan->model : "", out);
  fputs("}\n", out);
  return text_close(out, &text);
}

status plan_show(const struct campaign *campaign, const struct plan *plan, int slots, bool json, struct error *error) {
  OWNED char *text = json ? plan_print_json(campaign, plan, slots) : NULL;
  if (text)
    puts(text);
  else if (json)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  else
    print(campaign, plan, slots, stdout);
  return STATUS_OK;
}
