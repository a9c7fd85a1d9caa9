/* Chooses the runs of a campaign: the window of points, the progress line, and campaigns in a series. */
#include "campaign/scheduler/scheduler.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HASH_NONFATAL_OOM         1
#define uthash_nonfatal_oom(seen) free(seen)
#include <uthash.h>

#include "campaign/scheduler/point.h"
#include "engine/grow.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

#define NOTHING ((double)NAN)

/* Most points in the window. Campaigns of up to this many points start all runs in order of cost, most expensive first;
 * a larger campaign orders only the points in the window. Filling the window may delay the first run by FILL_S. */
enum { WINDOW = 1024 };
#define FILL_S 0.05

struct seen {
  int64_t id;
  UT_hash_handle hh;
};

/* The runs of a series that gave no result, each once. */
struct failures {
  struct failure {
    int64_t point, replicate;
  } * run; /* owned */
  size_t count, room;
};

struct driver {
  const struct campaign *campaign;
  struct scheduler *scheduler;
  struct driver_summary summary;
  struct campaign_walk walk;
  const char **paths;      /* paths of the axes, for the store */
  const struct field *row; /* main quantity */
  bool row_of_outcome;
  struct point **points; /* the window: points enter it with their stored runs in the order of the design, and leave it
                            when they are finished */
  size_t point_count;
  uint64_t expanded; /* design points taken */
  uint64_t reason;   /* hash of why the last point that could not be run could not */
  struct seen *seen; /* ids of the points met; below 0: hashes of names */
  struct point_cost_model cost;
  struct sample_moments moments;    /* of the main quantity */
  int64_t first_done, first_failed; /* of the first CAMPAIGN_FIRST_RUNS of this invocation */
  int64_t started_done;             /* runs finished in this invocation, for the rate */
  double finished_s;                /* their wall time */
  double begin, last_left, seconds_left;
  int64_t failed_again;      /* of summary.runs_failed those that an earlier campaign of the series has counted */
  struct failures *failures; /* of the series, whose campaigns differ on purpose; borrowed. NULL: one campaign */
  int64_t fields_missing;    /* fields files of stored runs that no longer exist, or are damaged */
  int64_t wanted;            /* runs that the points met so far need */
};

struct driver *driver_new(const struct campaign *campaign) {
  struct driver *driver = memory_small(1, sizeof *driver);
  driver->campaign = campaign;
  return driver;
}

void driver_free(struct driver *driver) {
  if (!driver)
    return;
  for (size_t i = 0; i < driver->point_count; i++)
    point_free(driver->points[i]);
  struct seen *seen, *next;
  HASH_ITER(hh, driver->seen, seen, next) {
    HASH_DEL(driver->seen, seen);
    free(seen);
  }
  campaign_walk_end(&driver->walk);
  free(driver->paths);
  free(driver->points);
  free(driver);
}

struct driver_summary driver_summarise(const struct driver *driver) {
  return driver->summary;
}

/* Writes session and plan into the store, committed: readers see the campaign from its first second. */
static status begin(void *context, struct scheduler *scheduler, struct error *error) {
  struct driver *driver = context;
  const struct campaign *campaign = driver->campaign;
  driver->scheduler = scheduler;
  driver->begin = driver->last_left = clock_s();
  driver->seconds_left = NAN;
  driver->paths = memory_small(campaign->axis_count + 1, sizeof *driver->paths);
  driver->points = memory_small(WINDOW, sizeof *driver->points);
  for (size_t i = 0; i < campaign->axis_count; i++)
    driver->paths[i] = campaign->axes[i].row->path;
  const char *quantity = campaign->per_point ? campaign->quantity : campaign->until_quantity;
  driver->row = campaign_quantity(campaign->scene->kind, quantity, &driver->row_of_outcome, error);
  if (!driver->row)
    return STATUS_CONTENT;
  TRY(campaign_walk_begin(&driver->walk, campaign, error));

  char plan[4096];
  struct driver_summary *summary = &driver->summary;
  snprintf(plan, sizeof plan,
           "{\"design\": %d, \"points\": %llu, \"replicates_least\": %lld, \"replicates_most\": %lld, \"quantity\": "
           "\"%s\", \"axes\": [",
           campaign->design.kind, (unsigned long long)design_points(driver->walk.design),
           (long long)campaign_replicates_least(campaign), (long long)campaign_replicates_most(campaign),
           campaign->quantity);
  for (size_t i = 0; i < campaign->axis_count && strlen(plan) + 2 * FIELD_TEXT_SIZE < sizeof plan; i++)
    text_append(plan, sizeof plan, "%s\"%s\"", i ? ", " : "", driver->paths[i]); /* their order in tables */
  text_append(plan, sizeof plan, "]}");
  TRY(scheduler_announce(scheduler, campaign, plan, &summary->session_id, &summary->campaign_id, error));
  TRY(store_set_session(scheduler->store, summary->session_id, summary->campaign_id, error));
  return store_flush(scheduler->store, error);
}

/* ---- a point enters the window ---- */

/* True when the id is new. When memory is out a duplicate point is checked twice, which does no harm. */
static bool remember(struct driver *driver, int64_t id) {
  struct seen *seen = NULL;
  HASH_FIND(hh, driver->seen, &id, sizeof id, seen);
  if (seen)
    return false;
  seen = memory_small(1, sizeof *seen);
  seen->id = id;
  HASH_ADD(hh, driver->seen, id, sizeof seen->id, seen);
  return true;
}

static void count_doubts(struct driver *driver, const struct point_replicate *replicate) {
  driver->summary.runs_warned += replicate->warned;
  driver->summary.runs_doubtful += replicate->doubtful;
}

/* A run without a result. The next campaigns of a series find it in the store. */
static void count_failure(struct driver *driver, int64_t point, int64_t replicate) {
  struct failures *all = driver->failures;
  driver->summary.runs_failed++;
  for (size_t i = 0; all && i < all->count; i++)
    if (all->run[i].point == point && all->run[i].replicate == replicate) {
      driver->failed_again++;
      return;
    }
  if (all && grow_room(&all->run, &all->room, all->count + 1, sizeof *all->run))
    all->run[all->count++] = (struct failure){point, replicate};
}

/* Counts a run that has results, stored or new. */
static void count_run(struct driver *driver, struct point *point, int64_t r, const struct ask_run_of_point *run,
                      bool fields) {
  struct driver_summary *summary = &driver->summary;
  const bool usable = outcome_is_usable(run->state) && !run->excluded;
  const enum condition_mark mark = condition_mark(point->scene->kind->conditions, run->warnings, driver->row->path);
  const double value = point_value(point, driver->row, run);
  point_finish_replicate(point, r, POINT_DONE, value);
  point->replicates[r].surplus = run->surplus;
  point->replicates[r].fields = fields || run->state == OUTCOME_INVALID;
  point_cost_learn(&driver->cost, &point->cost, run->wall_s);
  sample_add(&driver->moments, value);
  if (!usable && !run->excluded)
    count_failure(driver, point->id, r);
  summary->runs_excluded += run->excluded;
  summary->runs_surplus += run->surplus;
  summary->runs_censored += usable && run->state == OUTCOME_END_TIME;
  point->replicates[r].warned = usable && condition_doubted(point->scene->kind->conditions, run->warnings);
  point->replicates[r].doubtful = usable && mark != CONDITION_SOUND;
  if (!run->surplus)
    count_doubts(driver, &point->replicates[r]);
}

/* Takes over a stored run. */
static status take_stored(struct driver *driver, struct point *point, const struct ask_run_of_point *run,
                          struct error *error) {
  const int64_t r = scheduler_replicate(driver->campaign, point->scene, run);
  if (r < 0 || r >= campaign_replicates_most(driver->campaign))
    return STATUS_OK;
  if (!point_reserve(point, r))
    return status_fail(error, STATUS_MEMORY, "no memory for a point's runs");
  const bool keeps = driver->campaign->keep != CAMPAIGN_KEEP_NONE;
  bool kept = run->fields_path && !run->fields_missing;
  if (keeps && kept)
    TRY(store_check_fields(driver->scheduler->store, run->identity, &kept, error));
  if (keeps && run->fields_path && !kept && driver->fields_missing++ == 0) {
    char text[4400];
    snprintf(text, sizeof text,
             "fields file %.4000s of the store is %s, perhaps others too (`clast check` lists them): those that the "
             "campaign keeps are computed again",
             run->fields_path, run->fields_missing ? "missing" : "damaged");
    scheduler_note(driver->scheduler, text);
  }
  driver->summary.runs_reused++;
  count_run(driver, point, r, run, kept);
  return STATUS_OK;
}

/* Called after the prefix has grown: surplus runs inside it count from now on. A run that counts is never excluded
 * again, so that a point shared with another campaign keeps that campaign's decision. */
static status admit(struct driver *driver, struct point *point, struct error *error) {
  bool any = false;
  int64_t prefix = point->prefix;
  for (int64_t r = 0; r < point->capacity; r++) {
    struct point_replicate *replicate = &point->replicates[r];
    if (replicate->state != POINT_DONE)
      continue;
    if (r < point->prefix && replicate->surplus) {
      any = true;
      replicate->surplus = false;
      driver->summary.runs_surplus--;
      count_doubts(driver, replicate);
    } else if (r >= prefix && !replicate->surplus) {
      prefix = r + 1;
    }
  }
  return any ? store_set_prefix(driver->scheduler->store, point->id, prefix, error) : STATUS_OK;
}

/* Keeps the point if it needs the most runs of those that reached the cap. */
static void count_wide(struct driver *driver, const struct point *point) {
  const struct campaign *campaign = driver->campaign;
  struct driver_summary *summary = &driver->summary;
  struct sample_summary mean = sample_summarise((size_t)point->prefix, point->values, 0.95);
  const double wanted = campaign->until_half_width * (campaign->until_of_value ? fabs(mean.mean) : 1);
  const size_t runs = scatter_runs_of_rule(mean.mean, mean.standard_deviation, wanted, point->rule.share);
  if (summary->widest_point && (summary->widest_runs == 0 || (runs && runs <= summary->widest_runs)))
    return;
  if (field_is_share(driver->row))
    sample_of_share(&mean, 0.95);
  summary->widest_point = point->id;
  summary->widest_half_width = mean.half_width;
  summary->widest_mean = mean.mean;
  summary->widest_runs = runs;
}

/* Is the interval of a share in a table as narrow as asked? That of equal runs is a bound, which the rule does not
 * compare. */
static bool is_narrow(const struct point *point) {
  struct sample_summary mean = sample_summarise((size_t)point->prefix, point->values, point->rule.level);
  const double one = point->rule.of_mean ? fabs(mean.mean) : 1;
  sample_of_share(&mean, point->rule.level);
  return !(fmax(mean.high - mean.mean, mean.mean - mean.low) > one * point->rule.half_width && isnan(mean.half_width));
}

/* Judges the point's prefixes and updates the prefix in the store. When the point is decided, marks the runs whose
 * fields are wanted. */
static status judge(struct driver *driver, struct point *point, struct error *error) {
  const int64_t before = point->prefix;
  if (!point_judge(point))
    return STATUS_OK;
  driver->wanted += point->prefix - before;
  if (point->decided) {
    driver->summary.points_done++;
    driver->summary.points_interval_met += point->verdict == DESIGN_INTERVAL_MET;
    driver->summary.points_cap_reached += point->verdict == DESIGN_CAP_REACHED;
    driver->summary.points_equal += point->verdict == DESIGN_INTERVAL_MET && point->rule.share && !is_narrow(point);
    if (point->verdict == DESIGN_CAP_REACHED)
      count_wide(driver, point);
    point_want_fields(point, driver->campaign);
  }
  return admit(driver, point, error);
}

/* Takes the point's stored runs, then judges its prefixes. */
static status resume(struct driver *driver, struct point *point, struct error *error) {
  ANSWER stored = ask_run_of_point(driver->scheduler->store, point->id, point->scene->kind, driver->row,
                                   driver->row_of_outcome, error);
  for (struct ask_run_of_point run; ask_run_of_point_next(&stored, &run);)
    TRY(take_stored(driver, point, &run, error));
  TRY(answer_end(&stored));
  TRY(judge(driver, point, error));
  return admit(driver, point, error); /* a fixed number of replicates may cover runs that an older rule left out */
}

/* Appends "PATH (VALUE there, VALUE here)". */
static void write_hidden(const struct scene *scene, const struct field *row, const struct query_value *theirs,
                         char *text, size_t size) {
  struct field_value here, there = {.kind = row->kind, .number = theirs->real, .integer = theirs->integer};
  char mine[FIELD_TEXT_SIZE + 40], other[FIELD_TEXT_SIZE + 40] = "none";
  field_get(row, scene->inputs, &here);
  field_show(row, &here, mine, sizeof mine);
  if (theirs->text)
    snprintf(other, sizeof other, "%s", theirs->text);
  else if (theirs->kind != QUERY_NULL)
    field_show(row, &there, other, sizeof other);
  text_append(text, size, "%s%s (%s there, %s here)", *text ? ", " : "", row->path, other, mine);
}

/* Warns of points in the store of an earlier form of this campaign, or of another campaign of the scene. The inputs
 * that differ become varied inputs of the store, so that tables show them and --by takes them. */
static status tell_hidden_inputs(struct driver *driver, const struct scene *scene, int64_t id, struct error *error) {
  enum { NAMED = 8 };
  const struct field *differs[LIMITS_AXES_OF_POOL];
  const struct field_table *inputs = scene->kind->inputs;
  char names[2048] = "", text[2600], campaign[40];
  size_t count = 0;
  bool own = false;
  ANSWER hidden = ask_campaign_hidden_inputs(driver->scheduler->store, driver->summary.campaign_id, id, error);
  while (answer_next(&hidden)) {
    const struct field *row = field_find(inputs, answer_text(&hidden, 0), NULL);
    const struct query_value theirs = answer_value(&hidden, 1);
    if (!row || count == LIMITS_AXES_OF_POOL)
      continue;
    if (!scene->given[row - inputs->rows] && scheduler_follows(answer_text(&hidden, 2), row))
      continue; /* it differs because others do */
    differs[count] = row;
    own |= answer_integer(&hidden, 3);
    if (count++ < NAMED)
      write_hidden(scene, row, &theirs, names, sizeof names);
  }
  TRY(answer_end(&hidden));
  for (size_t i = 0; i < count; i++)
    TRY(scheduler_show_input(driver->scheduler->store, differs[i], error));
  if (count == 0 || driver->failures) /* the campaigns of a series differ on purpose */
    return STATUS_OK;
  snprintf(campaign, sizeof campaign, "campaign %lld", (long long)driver->summary.campaign_id);
  snprintf(
      text, sizeof text,
      "warning: the store has other points of this campaign or scene: %s%s %s of this store from now on (--by). For %s "
      "alone, name another store or ask with --%s",
      names, count > NAMED ? " and more" : "",
      count > 1 ? "differ, and are varied inputs" : "differs, and is a varied input", own ? "one form" : "one campaign",
      own ? "where" : campaign);
  scheduler_note(driver->scheduler, text);
  return STATUS_OK;
}

/* Is this the first point of the campaign, or the first with these names, such as of materials, among those varied? */
static bool is_first_of_names(struct driver *driver, const struct scene *scene) {
  char text[FIELD_TEXT_SIZE];
  uint64_t hash = TEXT_HASH_START;
  for (size_t i = 0; i < driver->campaign->axis_count; i++) {
    const struct field *row = driver->campaign->axes[i].row;
    struct field_value value = {0};
    if (!text_ends_in(row->path, ".name"))
      continue;
    field_get(row, scene->inputs, &value);
    field_show(row, &value, text, sizeof text);
    hash = text_hash(hash, text, strlen(text) + 1);
  }
  return remember(driver, -(int64_t)(hash >> 1) - 1); /* ids of points are positive */
}

/* Takes the next design point and its stored runs into the window. *more is false when the window is full or the design
 * has no more points. Points with an invalid combination of values are counted, and the first few noted. */
static status expand(struct driver *driver, bool *more, struct error *error) {
  *more = driver->point_count < WINDOW && campaign_walk_next(&driver->walk);
  if (!*more)
    return STATUS_OK;
  driver->expanded++;
  struct error why = {0};
  struct scene *scene = campaign_walk_scene(&driver->walk, &why);
  if (!scene && why.status == STATUS_MEMORY)
    return status_fail(error, STATUS_MEMORY, "%s", why.message);
  if (!scene) {
    char text[sizeof why.message + 80];
    const char *at = strstr(why.message, " (at "); /* the point's own values */
    const uint64_t reason = text_hash(0, why.message, at ? (size_t)(at - why.message) : strlen(why.message));
    if (at && reason == driver->reason)
      snprintf(text, sizeof text, "point %llu of the design cannot be run for the same reason%s",
               (unsigned long long)driver->expanded, at);
    else
      snprintf(text, sizeof text, "point %llu of the design cannot be run: %s", (unsigned long long)driver->expanded,
               why.message);
    driver->reason = reason;
    if (++driver->summary.points_invalid <= 5)
      scheduler_note(driver->scheduler, text);
    return STATUS_OK;
  }

  int64_t id = 0;
  status code = store_add_point(driver->scheduler->store, driver->summary.campaign_id, scene,
                                driver->campaign->axis_count, driver->paths, &id, error);
  if (code != STATUS_OK || !remember(driver, id)) {
    scene_free(scene);
    return code;
  }
  struct point *point = point_create(driver->campaign, scene);
  point->id = id;
  driver->summary.points++;
  driver->wanted += point->prefix;
  if (is_first_of_names(driver, scene))
    code = tell_hidden_inputs(driver, scene, id, error);
  if (code == STATUS_OK)
    code = resume(driver, point, error);
  if (code != STATUS_OK || point_over(point))
    point_free(point);
  else
    driver->points[driver->point_count++] = point;
  return code;
}

/* ---- runs out ---- */

/* The most expensive point that has a run to send out. The run is in the point's prefix, or with `ahead` may be beyond
 * it. */
static struct point *choose(struct driver *driver, bool ahead, int64_t *replicate) {
  struct point *best = NULL;
  double highest = -1;
  for (size_t i = 0; i < driver->point_count; i++) {
    struct point *point = driver->points[i];
    const double cost = point_cost_predict(&driver->cost, &point->cost);
    const int64_t r = cost > highest ? point_next(point, ahead) : -1;
    if (r < 0)
      continue;
    best = point;
    highest = cost;
    *replicate = r;
  }
  return best;
}

/* A stored run whose fields are still to be written. */
static struct point *choose_replay(struct driver *driver, int64_t *replicate) {
  for (size_t i = 0; i < driver->point_count; i++) {
    struct point *point = driver->points[i];
    for (int64_t r = 0; point->replays > 0 && r < point->capacity; r++)
      if (point->replicates[r].replay) {
        *replicate = r;
        return point;
      }
  }
  return NULL;
}

/* First runs of the prefixes, then runs beyond them, so that no slot idles, then replays. Runs beyond a prefix start
 * only when no further point can enter the window. */
static status next(void *context, struct scheduler_run *run, struct error *error) {
  struct driver *driver = context;
  const struct campaign *campaign = driver->campaign;
  const double deadline = clock_s() + FILL_S;
  bool more = true, replay = false;
  int64_t r = 0;
  while (more && clock_s() < deadline)
    TRY(expand(driver, &more, error));
  struct point *point = choose(driver, false, &r);
  for (more = true; !point && more; point = choose(driver, false, &r))
    TRY(expand(driver, &more, error));
  if (!point)
    point = choose(driver, true, &r);
  if (!point) {
    point = choose_replay(driver, &r);
    replay = true;
  }
  if (!point)
    return STATUS_OK;

  struct point_replicate *replicate = &point->replicates[r];
  point->out++;
  if (replay) {
    replicate->replay = false;
    replicate->replaying = true;
    point->replays--;
  } else {
    replicate->state = POINT_OUT;
  }
  /* Runs with extreme values are known only afterwards; they are computed again. */
  const bool fields = replay || campaign->keep == CAMPAIGN_KEEP_ALL ||
                      (campaign->keep == CAMPAIGN_KEEP_FIRST && r < campaign->keep_first);
  *run = (struct scheduler_run){.scene = point->scene,
                                .point_id = point->id,
                                .session_id = driver->summary.session_id,
                                .replicate = r,
                                .seed = campaign_seed(campaign, point->scene, r),
                                .fields = fields,
                                .replay = replay,
                                .lost = replicate->lost,
                                .place = point};
  return STATUS_OK;
}

/* ---- and in ---- */

static bool is_surplus(void *context, const struct scheduler_run *run) {
  (void)context;
  return run->replicate >= ((const struct point *)run->place)->prefix;
}

/* Many failures among the first runs mean that something is wrong with the campaign, not with chance. */
static status judge_failures(struct driver *driver, bool failed, struct error *error) {
  if (driver->first_done >= CAMPAIGN_FIRST_RUNS)
    return STATUS_OK;
  driver->first_done++;
  driver->first_failed += failed;
  char word[TEXT_WORD];
  if (driver->campaign->failures == 0 || driver->first_failed < driver->campaign->failures)
    return STATUS_OK;
  return status_fail(error, STATUS_FAILED_RUNS,
                     "stopped: %lld of the first %lld runs failed. `clast query %s --named failures` says why. Correct "
                     "the campaign, or set limits.failures: 0 to ignore failures",
                     (long long)driver->first_failed, (long long)driver->first_done,
                     text_word(driver->scheduler->options.store_path, word));
}

static status take_result(struct driver *driver, const struct scheduler_run *run, const struct scheduler_end *end,
                          struct error *error) {
  const struct outcome *outcome = &end->result->outcome;
  const struct ask_run_of_point row = {.surplus = is_surplus(driver, run),
                                       .state = outcome->state,
                                       .value = campaign_value(driver->row, driver->row_of_outcome, outcome,
                                                               end->result->result),
                                       .warnings = outcome->warnings,
                                       .wall_s = end->report->wall_s};
  driver->summary.runs_done++;
  driver->summary.fields_written += end->fields;
  driver->summary.cpu_s += end->report->cpu_s;
  count_run(driver, run->place, run->replicate, &row, end->fields);
  return judge_failures(driver, !outcome_is_usable(outcome->state), error);
}

static status take_run(struct driver *driver, const struct scheduler_run *run, const struct scheduler_end *end,
                       struct error *error) {
  struct point *point = run->place;
  if (end->report) {
    driver->started_done++;
    driver->finished_s += end->report->wall_s;
    driver->summary.attempts_failed += end->ending != SCHEDULER_DONE;
  }
  switch (end->ending) {
  case SCHEDULER_DONE: return take_result(driver, run, end, error);
  case SCHEDULER_AGAIN:
    point->replicates[run->replicate].lost = run->lost;
    point_want_again(point, run->replicate);
    return STATUS_OK;
  case SCHEDULER_LEFT:
    point_leave(point, run->replicate);
    driver->summary.runs_left++;
    return STATUS_OK;
  case SCHEDULER_FAILED: break;
  }
  point_finish_replicate(point, run->replicate, POINT_FAILED, NAN);
  count_failure(driver, point->id, run->replicate);
  return end->report ? judge_failures(driver, true, error) : STATUS_OK;
}

static status ended(void *context, const struct scheduler_run *run, const struct scheduler_end *end,
                    struct error *error) {
  struct driver *driver = context;
  struct point *point = run->place;
  status code = STATUS_OK;
  point->out--;
  if (run->replay) {
    point->replicates[run->replicate].replaying = false;
    point->replicates[run->replicate].fields = end->fields;
    driver->summary.fields_written += end->fields;
    driver->summary.runs_left += end->ending == SCHEDULER_LEFT;
  } else {
    code = take_run(driver, run, end, error);
  }
  if (code == STATUS_OK)
    code = judge(driver, point, error);
  else
    (void)judge(driver, point, NULL); /* the stop keeps its own message */
  if (!point_over(point))
    return code;
  size_t place = 0;
  while (driver->points[place] != point)
    place++;
  driver->point_count--; /* the order stays: points of equal cost start in the order of the design */
  memmove(&driver->points[place], &driver->points[place + 1], (driver->point_count - place) * sizeof *driver->points);
  point_free(point);
  return code;
}

/* ---- progress ---- */

/* Estimates the seconds left from the missing runs of the points in the window and a mean for later points. It is
 * updated once a second. */
static double time_left(struct driver *driver, double now) {
  if (now - driver->last_left < 1 && !isnan(driver->seconds_left))
    return driver->seconds_left;
  driver->last_left = now;
  driver->seconds_left = NAN;
  if (driver->cost.runs == 0)
    return NAN;

  struct point_cost_left left = {.finished_s = driver->finished_s,
                                 .elapsed_s = now - driver->begin,
                                 .slots = driver->scheduler->options.slots};
  const double mean = driver->cost.seconds / (double)driver->cost.runs;
  for (size_t i = 0; i < driver->point_count; i++)
    left.missing_s += (double)point_missing(driver->points[i]) *
                      point_cost_predict(&driver->cost, &driver->points[i]->cost);
  const uint64_t unmet = design_points(driver->walk.design) - driver->expanded;
  left.missing_s += (double)unmet * (double)campaign_replicates_least(driver->campaign) * mean;
  for (size_t i = 0; i < driver->scheduler->places; i++) {
    const struct scheduler_run *run = &driver->scheduler->out[i];
    if (!run->scene || run->replay)
      continue;
    const struct point *point = run->place;
    const double predicted = point_cost_predict(&driver->cost, &point->cost);
    const double had = isnan(run->started) ? 0 : now - run->started;
    left.under_way_s += fmin(had, predicted);
    left.longest_s = fmax(left.longest_s, predicted - had);
  }
  driver->seconds_left = point_cost_time_left(&left);
  return driver->seconds_left;
}

/* The point with the widest interval of those that the stopping rule has tested and not ended. NULL: none. */
static const struct point *widest_reached(const struct driver *driver) {
  const struct point *widest = NULL;
  for (size_t i = 0; i < driver->point_count; i++)
    if (!driver->points[i]->decided && driver->points[i]->reached > (widest ? widest->reached : 0))
      widest = driver->points[i];
  return widest;
}

static void tick(void *context, int running, bool last) {
  struct driver *driver = context;
  struct progress *progress = driver->scheduler->options.progress;
  if (!progress)
    return;
  const struct driver_summary *summary = &driver->summary;
  const double now = clock_s(), elapsed = now - driver->begin;
  const uint64_t points = design_points(driver->walk.design), unmet = points - driver->expanded;
  const uint64_t open_points = summary->points - summary->points_done;
  const bool rated = elapsed > 0 && driver->started_done > 0;
  struct sample_summary mean = sample_summarise_moments(&driver->moments, 0.95);
  const struct sample_range range = sample_range(driver->row);
  sample_in_range(&mean, &range, 0.95);
  if (points > 1) /* the interval is one of a single point's seeds */
    mean.half_width = mean.low = mean.high = NOTHING;
  const int64_t least = (int64_t)points * campaign_replicates_least(driver->campaign), /* as `plan` tells it */
      total = driver->wanted + (int64_t)unmet * campaign_replicates_least(driver->campaign);
  const struct point *widest = last ? NULL : widest_reached(driver);
  char quantity[FIELD_TEXT_SIZE]; /* as in tables */
  field_column_name(driver->row->path, quantity, sizeof quantity);
  struct progress_state state = {
      .done = summary->runs_done + summary->runs_reused - summary->runs_surplus,
      .failed = summary->runs_failed,
      .running = running,
      .total = driver->campaign->per_point == 0 && open_points > 0 && total < least ? least : total,
      .total_is_minimum = driver->campaign->per_point == 0 && open_points > 0,
      .rate = rated ? (double)driver->started_done / elapsed : NOTHING,
      .seconds_left = last ? NOTHING : time_left(driver, now),
      /* The table has the mean of the runs that count; those of a study differ in their settings. */
      .quantity = last || driver->failures ? NULL : quantity,
      .mean = mean,
      .reached = widest ? widest->reached * driver->campaign->until_scale : 0,
      .point = widest && points > 1 ? widest->id : 0,
      .least = campaign_replicates_least(driver->campaign),
      .unit = driver->campaign->until_unit,
      .asked = driver->campaign->until_half_width * driver->campaign->until_scale,
      .doubtful = summary->runs_doubtful > 0,
      .part = driver->failures != NULL,
  };
  progress_update(progress, &state, now, last);
}

/* ---- a whole campaign ---- */

static status verdict(const struct driver_summary *summary, struct error *error) {
  if (summary->runs_left > 0)
    return status_fail(error, STATUS_STOPPED,
                       "%lld run%s left: signals from outside ended %s, or the machine had no memory or disk; the same "
                       "command tries again, and `clast query STORE --named failures` says more",
                       (long long)summary->runs_left, summary->runs_left == 1 ? " is" : "s are",
                       summary->runs_left == 1 ? "it" : "them");
  if (summary->runs_failed + (int64_t)summary->points_invalid == 0)
    return STATUS_OK;
  char points[64] = "";
  if (summary->points_invalid)
    snprintf(points, sizeof points, " and %llu point%s could not be run", (unsigned long long)summary->points_invalid,
             summary->points_invalid == 1 ? "" : "s");
  return status_fail(error, STATUS_FAILED_RUNS,
                     "finished, but %lld run%s failed%s; `clast query STORE --named failures` says why",
                     (long long)summary->runs_failed, summary->runs_failed == 1 ? "" : "s", points);
}

static status end(void *context, status code, struct error *error) {
  const struct driver *driver = context;
  const struct driver_summary *summary = &driver->summary;
  struct store *store = driver->scheduler->store;
  if (code == STATUS_OK) /* a stopped campaign pools in its next invocation */
    code = pooling_store(store, summary->campaign_id, error);
  if (code == STATUS_OK)
    code = verdict(summary, error);
  const char *outcome = code == STATUS_OK || code == STATUS_FAILED_RUNS ? "finished"
                        : code == STATUS_STOPPED                        ? "stopped"
                                                                        : "failed";
  if (code == STATUS_OK && driver->campaign->per_point == 0)
    code = store_set_session_unmet(store, summary->session_id, (int64_t)summary->points_cap_reached, error);
  const status session = store_end_session(store, summary->session_id, outcome, code == STATUS_OK ? error : NULL);
  return code != STATUS_OK ? code : session;
}

struct scheduler_planner driver_planner(struct driver *driver) {
  return (struct scheduler_planner){.context = driver,
                                    .limits = driver->campaign,
                                    .begin = begin,
                                    .next = next,
                                    .is_surplus = is_surplus,
                                    .ended = ended,
                                    .tick = tick,
                                    .end = end};
}

status driver_run(const struct campaign *campaign, struct farm *farm, const struct scheduler_options *options,
                  struct driver_summary *summary, struct error *error) {
  struct driver *driver = driver_new(campaign);
  const struct scheduler_planner planner = driver_planner(driver);
  const status code = scheduler_compute(&planner, farm, options, error);
  *summary = driver->summary;
  driver_free(driver);
  return code;
}

/* ---- a series ---- */

struct running {
  const struct series *series;
  struct series_summary *summary;
  struct scheduler *scheduler;
  struct campaign *campaign; /* owned; NULL between two campaigns */
  struct driver *driver;     /* owned; NULL between two campaigns */
  int out;                   /* runs on slots */
  bool finished;             /* no campaign is left */
  struct failures failures;  /* owned */
};

static status begin_series(void *context, struct scheduler *scheduler, struct error *error) {
  (void)error;
  ((struct running *)context)->scheduler = scheduler;
  return STATUS_OK;
}

static status begin_campaign(struct running *running, struct error *error) {
  TRY(running->series->next(running->series->context, running->scheduler, &running->campaign, error));
  running->finished = !running->campaign;
  if (running->finished)
    return STATUS_OK;
  struct driver *driver = driver_new(running->campaign);
  driver->failures = &running->failures;
  const status code = begin(driver, running->scheduler, error);
  if (code == STATUS_OK)
    running->driver = driver;
  else
    driver_free(driver);
  return code;
}

/* `outcome`: outcome of the campaign's session in the store. */
static status end_campaign(struct running *running, const char *outcome, struct error *error) {
  const struct driver_summary summary = running->driver->summary;
  struct store *store = running->scheduler->store;
  running->summary->runs_done += summary.runs_done;
  running->summary->runs_failed += summary.runs_failed - running->driver->failed_again;
  running->summary->runs_reused += summary.runs_reused;
  if (!running->summary->session_id)
    running->summary->session_id = summary.session_id;
  running->summary->cpu_s += summary.cpu_s;
  tick(running->driver, 0, true);
  driver_free(running->driver);
  campaign_free(running->campaign);
  running->driver = NULL;
  running->campaign = NULL;
  TRY(store_end_session(store, summary.session_id, outcome, error));
  return store_flush(store, error);
}

static status next_of_series(void *context, struct scheduler_run *run, struct error *error) {
  struct running *running = context;
  const struct series *series = running->series;
  while (!running->finished) {
    if (!running->driver)
      TRY(begin_campaign(running, error));
    if (running->finished)
      break;
    if (!series->is_enough || !series->is_enough(series->context))
      TRY(next(running->driver, run, error));
    running->out += run->scene != NULL;
    if (running->out > 0)
      return STATUS_OK;
    TRY(end_campaign(running, "finished", error));
    TRY(series->done(series->context, running->scheduler, error));
  }
  return STATUS_OK;
}

static bool is_surplus_of_series(void *context, const struct scheduler_run *run) {
  return is_surplus(((struct running *)context)->driver, run);
}

static status ended_of_series(void *context, const struct scheduler_run *run, const struct scheduler_end *end,
                              struct error *error) {
  struct running *running = context;
  running->out--;
  return ended(running->driver, run, end, error);
}

static void tick_of_series(void *context, int on_slots, bool last) {
  struct running *running = context;
  if (running->driver && !last)
    tick(running->driver, on_slots, false);
}

static status end_series(void *context, status code, struct error *error) {
  struct running *running = context;
  if (running->driver)
    (void)end_campaign(running, code == STATUS_STOPPED ? "stopped" : "failed", NULL);
  return code == STATUS_OK ? pooling_store(running->scheduler->store, 0, error) : code;
}

status driver_run_series(const struct series *series, struct farm *farm, const struct scheduler_options *options,
                         struct series_summary *summary, struct error *error) {
  *summary = (struct series_summary){0};
  struct running running = {.series = series, .summary = summary};
  const struct scheduler_planner planner = {.context = &running,
                                            .limits = series->limits,
                                            .begin = begin_series,
                                            .next = next_of_series,
                                            .is_surplus = is_surplus_of_series,
                                            .ended = ended_of_series,
                                            .tick = tick_of_series,
                                            .end = end_series};
  const status code = scheduler_compute(&planner, farm, options, error);
  campaign_free(running.campaign); /* one that could not begin */
  free(running.failures.run);
  return code;
}

status driver_list_begin(const struct campaign *like, const struct scene *scene, size_t axes, size_t points,
                         struct campaign **out, struct error *error) {
  struct campaign *campaign = *out = memory_small(1, sizeof *campaign);
  *campaign = *like;
  campaign->point_lines = NULL; /* what `like` owns is freed once */
  campaign->text = NULL;
  campaign->axis_count = 0;
  campaign->design = (struct campaign_design_keys){.kind = CAMPAIGN_LIST};
  campaign->keep = CAMPAIGN_KEEP_NONE;
  campaign->scene = scene_copy(scene);
  campaign->axes = memory_small(axes, sizeof *campaign->axes);
  while (campaign->axis_count < axes) {
    struct design_axis *axis = &campaign->axes[campaign->axis_count++];
    *axis = (struct design_axis){.kind = DESIGN_AXIS_LEVELS, .lower = -HUGE_VAL, .upper = HUGE_VAL};
    TRY(memory_array(&axis->levels, points, sizeof *axis->levels, "a round", error));
    axis->level_count = points;
  }
  return STATUS_OK;
}

status driver_list_end(struct campaign *campaign, const char *scene_reference, const char *comment,
                       struct error *error) {
  campaign->text = campaign_write_list(campaign, scene_reference, comment);
  return campaign->text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a round");
}

void driver_list_reference(const struct campaign *campaign, const char *path, char *reference, size_t size) {
  const char *slash = strrchr(path, '/'), *scene = campaign->scene_reference;
  const bool is_file = strchr(scene, '/') || strchr(scene, '.');
  snprintf(reference, size, "%.*s%s", slash && is_file && scene[0] != '/' ? (int)(slash + 1 - path) : 0, path, scene);
}
