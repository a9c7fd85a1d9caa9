#include "campaign/driver_private.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/run.h"
#include "schemas/clock.h"

void driver_note(struct driver *driver, const char *text) {
  if (driver->options.note)
    driver->options.note(driver->options.note_context, text);
}

void driver_farm_options(const struct campaign *campaign, struct farm_options *options) {
  options->time_limit_s = isnan(campaign->time_limit) ? 0 : campaign->time_limit;
  options->memory_limit = isnan(campaign->memory_limit) ? 0 : (size_t)campaign->memory_limit;
}

status driver_open(const struct campaign *campaign, struct store *store, const struct driver_options *options,
                   struct driver **out, struct error *error) {
  *out = NULL;
  struct driver *driver = calloc(1, sizeof *driver);
  if (!driver)
    return status_fail(error, STATUS_MEMORY, "no memory for the campaign's driver");
  driver->campaign = campaign;
  driver->store = store;
  driver->options = *options;
  driver->begin = driver->last_left = clock_s();
  driver->seconds_left = NAN;
  driver->values = calloc(campaign->axis_count + 1, sizeof *driver->values);
  driver->paths = calloc(campaign->axis_count + 1, sizeof *driver->paths);
  driver->points = calloc(DRIVER_WINDOW, sizeof *driver->points);
  driver->seen_size = 1024;
  driver->seen = calloc(driver->seen_size, sizeof *driver->seen);
  status code = STATUS_OK;
  if (!driver->values || !driver->paths || !driver->points || !driver->seen)
    code = status_fail(error, STATUS_MEMORY, "no memory for the campaign's driver");
  for (size_t i = 0; code == STATUS_OK && i < campaign->axis_count; i++)
    driver->paths[i] = campaign->axes[i].row->path;
  const char *quantity = campaign->per_point ? campaign->quantity : campaign->until_quantity;
  if (code == STATUS_OK &&
      !(driver->row = campaign_quantity(campaign->scene->kind, quantity, &driver->row_of_outcome, error)))
    code = STATUS_CONTENT;
  if (code == STATUS_OK)
    code = design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                         (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &driver->design, error);
  if (code == STATUS_OK)
    code = store_begin_session(store, options->facts ? options->facts : "{}", &driver->summary.session_id, error);
  if (code == STATUS_OK) {
    char plan[256];
    snprintf(plan, sizeof plan,
             "{\"design\": %d, \"points\": %llu, \"replicates_least\": %lld, \"replicates_most\": %lld}",
             campaign->design.kind, (unsigned long long)design_points(driver->design),
             (long long)campaign_replicates_least(campaign), (long long)campaign_replicates_most(campaign));
    code = store_add_campaign(store, campaign->name, campaign->text, plan, &driver->summary.campaign_id, error);
    if (code == STATUS_OK)
      code = store_flush(store, error); /* readers see the campaign from its first second */
  }
  if (code != STATUS_OK) {
    driver_free(driver);
    return code;
  }
  *out = driver;
  return STATUS_OK;
}

void driver_free(struct driver *driver) {
  if (!driver)
    return;
  for (size_t i = 0; driver->points && i < driver->point_count; i++)
    point_free(driver->points[i]);
  design_free(driver->design);
  free(driver->values);
  free(driver->paths);
  free(driver->points);
  free(driver->seen);
  free(driver->flights);
  free(driver->task);
  free(driver);
}

/* The dearest point that has something to send out: its own runs first, then, so that no slot idles, runs ahead of the
 * prefixes under way, then replays for fields. */
static struct point *choose(struct driver *driver, bool ahead, int64_t *replicate) {
  struct point *best = NULL;
  double dearest = -1;
  for (size_t i = 0; i < driver->point_count; i++) {
    struct point *point = driver->points[i];
    double cost = cost_predict(&driver->cost, &point->cost);
    if (cost <= dearest)
      continue;
    int64_t r = point_next(point, ahead);
    if (r < 0)
      continue;
    best = point;
    dearest = cost;
    *replicate = r;
  }
  return best;
}

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

/* "results.db" -> "results-fields/<identity>.h5", relative to the store's folder; with `folder` the store's own in
 * front. */
static void fields_path(const struct driver *driver, const uint8_t identity[16], bool folder, char *path, size_t size) {
  const char *store = driver->options.store_path ? driver->options.store_path : driver->campaign->store;
  const char *slash = strrchr(store, '/'), *base = slash ? slash + 1 : store;
  const char *dot = strrchr(base, '.');
  char hex[33];
  for (int i = 0; i < 16; i++)
    snprintf(hex + 2 * i, 3, "%02x", identity[i]);
  snprintf(path, size, "%.*s%.*s-fields/%s.h5", folder && slash ? (int)(slash + 1 - store) : 0, store,
           dot && dot != base ? (int)(dot - base) : (int)strlen(base), base, hex);
}

/* Whether a run that is computed now writes its fields at once; extremes are known only afterwards. */
static bool writes_fields(const struct driver *driver, const struct flight *flight) {
  return flight->replay || driver->campaign->keep == CAMPAIGN_KEEP_ALL ||
         (driver->campaign->keep == CAMPAIGN_KEEP_FIRST && flight->replicate < driver->campaign->keep_first);
}

static struct flight *free_flight(struct driver *driver) {
  for (size_t i = 0; i < driver->flight_count; i++)
    if (!driver->flights[i].point)
      return &driver->flights[i];
  size_t count = driver->flight_count ? 2 * driver->flight_count : 16;
  struct flight *flights = realloc(driver->flights, count * sizeof *flights);
  if (!flights)
    return NULL;
  memset(flights + driver->flight_count, 0, (count - driver->flight_count) * sizeof *flights);
  driver->flights = flights;
  struct flight *fresh = &flights[driver->flight_count];
  driver->flight_count = count;
  return fresh;
}

static void give_up(struct driver *driver, struct point *point, int64_t r) {
  point_finish_replicate(point, r, POINT_FAILED, NAN);
  driver->summary.runs_failed++;
}

/* Fills the window; then the dearest run that nobody has given up on before. NULL: nothing (or an error). */
static struct point *next_run(struct driver *driver, struct flight *flight, status *code) {
  double deadline = clock_s() + DRIVER_FILL_S;
  while (*code == STATUS_OK) {
    while (*code == STATUS_OK && driver->point_count < DRIVER_WINDOW && clock_s() < deadline &&
           driver_window_expand(driver, code, &driver->error))
      ;
    if (*code != STATUS_OK)
      return NULL;
    struct point *point = choose(driver, false, &flight->replicate);
    if (!point) { /* nothing in the window: go on in the design before anything is computed ahead */
      if (driver->point_count < DRIVER_WINDOW && driver_window_expand(driver, code, &driver->error))
        continue;
      if (*code != STATUS_OK)
        return NULL;
      point = choose(driver, true, &flight->replicate);
    }
    if (!point) {
      point = choose_replay(driver, &flight->replicate);
      flight->replay = point != NULL;
    }
    if (!point)
      return NULL;
    flight->seed = campaign_seed(driver->campaign, point->scene, flight->replicate);
    scene_identity(point->scene, flight->seed, flight->identity);
    flight->attempt = 1;
    if (flight->replay)
      return point;
    struct farm_options limits = {0};
    driver_farm_options(driver->campaign, &limits);
    int failed = store_attempts(driver->store, flight->identity, limits.time_limit_s, (double)limits.memory_limit);
    flight->attempt = failed + 1;
    if (failed < driver->campaign->attempts)
      return point;
    give_up(driver, point, flight->replicate); /* in an earlier invocation, or now */
    *code = driver_window_judge(driver, point, &driver->error);
    if (*code == STATUS_OK && point_over(point))
      driver_window_drop(driver, point);
  }
  return NULL;
}

static bool next(void *context, struct farm_task *task) {
  struct driver *driver = context;
  struct flight flight = {0};
  status code = driver->error.status;
  struct point *point = code == STATUS_OK ? next_run(driver, &flight, &code) : NULL;
  if (code != STATUS_OK)
    driver->error.status = code; /* tick() hands it to the farm */
  if (!point)
    return false;
  struct flight *place = free_flight(driver);
  char path[4096] = "";
  if (writes_fields(driver, &flight))
    fields_path(driver, flight.identity, true, path, sizeof path);
  struct run_request request = {point->scene->kind, point->scene->inputs, flight.seed, path[0] ? path : NULL, NULL};
  free(driver->task);
  driver->task = place ? run_encode_task(&request, &task->size) : NULL;
  if (!driver->task) {
    status_fail(&driver->error, STATUS_MEMORY, "no memory for a task");
    return false;
  }
  flight.point = point;
  *place = flight;
  point->out++;
  struct point_replicate *replicate = &point->replicates[flight.replicate];
  if (flight.replay) {
    replicate->replay = false;
    replicate->replaying = true;
    point->replays--;
  } else {
    replicate->state = POINT_OUT;
  }
  task->id = (uint64_t)(place - driver->flights);
  task->bytes = driver->task;
  return true;
}

static status store_result(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                           const struct run_result *result, struct error *error) {
  struct point *point = flight->point;
  struct point_replicate *replicate = &point->replicates[flight->replicate];
  char path[4096] = "";
  if (writes_fields(driver, flight) && result->outcome.state != OUTCOME_INVALID)
    fields_path(driver, flight->identity, false, path, sizeof path);
  replicate->surplus = flight->replicate >= point->prefix;
  replicate->fields = path[0] != '\0' || result->outcome.state == OUTCOME_INVALID;
  driver->summary.fields_written += path[0] != '\0';
  driver->summary.runs_surplus += replicate->surplus;
  struct store_run run = {
      .point_id = point->id,
      .session_id = driver->summary.session_id,
      .replicate = flight->replicate,
      .seed = flight->seed,
      .surplus = replicate->surplus,
      .kind = point->scene->kind,
      .outcome = &result->outcome,
      .result = result->result,
      .fragments = result->fragments,
      .fragment_count = result->fragment_count,
      .estimates = result->estimate_count ? result->estimates : NULL,
      .estimate_count = result->estimate_count,
      .wall_s = report->wall_s,
      .cpu_s = report->cpu_s,
      .peak_memory = report->peak_memory,
      .attempt = flight->attempt,
      .host = report->host,
      .rank = report->rank,
      .fields_path = path[0] ? path : NULL,
  };
  memcpy(run.identity, flight->identity, sizeof run.identity);
  return store_add_run(driver->store, &run, error);
}

static status store_failure(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                            struct error *error) {
  static const char *const reasons[] = {[FARM_DONE] = "exit",
                                        [FARM_FAILED] = "exit",
                                        [FARM_TIME_LIMIT] = "time_limit",
                                        [FARM_MEMORY_LIMIT] = "memory_limit",
                                        [FARM_CRASHED] = "crash",
                                        [FARM_LOST] = "lost"};
  struct farm_options limits = {0};
  driver_farm_options(driver->campaign, &limits);
  driver->summary.attempts_failed++;
  struct store_attempt attempt = {
      .point_id = flight->point->id,
      .replicate = flight->replicate,
      .session_id = driver->summary.session_id,
      .seed = flight->seed,
      .attempt = flight->attempt,
      .reason = reasons[report->ending],
      .exit_code = report->exit_code,
      .signal = report->signal,
      .wall_s = report->wall_s,
      .peak_memory = report->peak_memory,
      .limit = report->ending == FARM_TIME_LIMIT     ? limits.time_limit_s
               : report->ending == FARM_MEMORY_LIMIT ? (double)limits.memory_limit
                                                     : 0,
      .message = report->message,
      .host = report->host,
      .rank = report->rank,
  };
  memcpy(attempt.identity, flight->identity, sizeof attempt.identity);
  return store_add_attempt(driver->store, &attempt, error);
}

/* Twenty failures among the first fifty mean that something is wrong with the campaign, not with chance. */
static status judge_failures(struct driver *driver, bool failed, struct error *error) {
  if (driver->first_done >= CAMPAIGN_FIRST_RUNS)
    return STATUS_OK;
  driver->first_done++;
  driver->first_failed += failed;
  if (driver->campaign->failures == 0 || driver->first_failed < driver->campaign->failures)
    return STATUS_OK;
  return status_fail(
      error, STATUS_FAILED_RUNS,
      "stopped: %lld of the first %lld runs failed. What happened is in the store: clast query %s --named failures. "
      "Mend the campaign, or set limits.failures: 0 to go on regardless",
      (long long)driver->first_failed, (long long)driver->first_done,
      driver->options.store_path ? driver->options.store_path : driver->campaign->store);
}

static status finish_run(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                         struct error *error) {
  struct point *point = flight->point;
  struct run_result result;
  if (report->ending != FARM_DONE) {
    status code = store_failure(driver, flight, report, error);
    bool last = flight->attempt >= driver->campaign->attempts;
    if (code != STATUS_OK)
      return code;
    if (!last) {
      point_want_again(point, flight->replicate);
      return STATUS_OK;
    }
    give_up(driver, point, flight->replicate);
    return judge_failures(driver, true, error);
  }
  status code = run_decode_result(point->scene->kind, report->bytes, report->size, &result, error);
  if (code != STATUS_OK)
    return code;
  code = store_result(driver, flight, report, &result, error);
  if (code == STATUS_OK) {
    bool usable = campaign_usable(&result.outcome);
    double value = campaign_value(driver->row, driver->row_of_outcome, &result.outcome, result.result);
    point_finish_replicate(point, flight->replicate, POINT_DONE, value);
    cost_learn(&driver->cost, &point->cost, report->wall_s);
    sample_add(&driver->moments, value);
    driver->summary.runs_done++;
    driver->summary.runs_failed += !usable;
    driver->summary.runs_censored += result.outcome.state == OUTCOME_END_TIME;
    driver->summary.cpu_s += report->cpu_s;
    code = judge_failures(driver, !usable, error);
  }
  run_result_clear(&result);
  return code;
}

static status finish_replay(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                            struct error *error) {
  struct point_replicate *replicate = &flight->point->replicates[flight->replicate];
  char path[4096], text[4400];
  replicate->replaying = false;
  fields_path(driver, flight->identity, false, path, sizeof path);
  if (report->ending != FARM_DONE) {
    snprintf(text, sizeof text, "fields of seed %llu could not be written to %s: %s", (unsigned long long)flight->seed,
             path, report->message && report->message[0] ? report->message : "the replay did not end well");
    driver_note(driver, text);
    return STATUS_OK;
  }
  replicate->fields = true;
  driver->summary.fields_written++;
  return store_set_fields(driver->store, flight->identity, path, error);
}

static status report(void *context, const struct farm_report *report, struct error *error) {
  struct driver *driver = context;
  if (report->id >= driver->flight_count || !driver->flights[report->id].point)
    return status_fail(error, STATUS_INTERNAL, "the farm reported a task that it was not given");
  struct flight flight = driver->flights[report->id];
  driver->flights[report->id].point = NULL;
  flight.point->out--;
  status code = flight.replay ? finish_replay(driver, &flight, report, error)
                              : finish_run(driver, &flight, report, error);
  driver->started_done += !flight.replay;
  status judged = code == STATUS_OK || code == STATUS_FAILED_RUNS
                      ? driver_window_judge(driver, flight.point, code ? NULL : error)
                      : code;
  if (point_over(flight.point))
    driver_window_drop(driver, flight.point);
  return code != STATUS_OK ? code : judged;
}

/* Seconds left on all slots, from what is missing in the points met and the mean of the rest. Once a second is enough.
 */
static double time_left(struct driver *driver, double now) {
  if (now - driver->last_left < 1 && !isnan(driver->seconds_left))
    return driver->seconds_left;
  driver->last_left = now;
  if (driver->cost.runs == 0)
    return driver->seconds_left = NAN;
  double seconds = 0, mean = driver->cost.seconds / (double)driver->cost.runs;
  for (size_t i = 0; i < driver->point_count; i++)
    seconds += (double)point_missing(driver->points[i]) * cost_predict(&driver->cost, &driver->points[i]->cost);
  uint64_t unmet = design_points(driver->design) - driver->expanded;
  seconds += (double)unmet * (double)campaign_replicates_least(driver->campaign) * mean;
  return driver->seconds_left = seconds / (driver->options.slots > 0 ? driver->options.slots : 1);
}

static void show(struct driver *driver, int running, bool last) {
  if (!driver->options.progress)
    return;
  double now = clock_s(), elapsed = now - driver->begin;
  uint64_t unmet = design_points(driver->design) - driver->expanded;
  struct sample_summary mean = sample_summarise_moments(&driver->moments, 0.95);
  struct progress_state state = {
      .done = driver->summary.runs_done + driver->summary.runs_reused - driver->summary.runs_surplus,
      .failed = driver->summary.runs_failed,
      .running = running,
      .total = driver->wanted + (int64_t)unmet * campaign_replicates_least(driver->campaign),
      .total_is_minimum = driver->campaign->per_point == 0 &&
                                  driver->summary.points_done<driver->summary.points, .rate = elapsed> 0 &&
                                  driver->started_done > 0
                              ? (double)driver->started_done / elapsed
                              : DRIVER_NOTHING,
      .seconds_left = last ? DRIVER_NOTHING : time_left(driver, now),
      .quantity = driver->row->path,
      .mean = mean.mean,
      .half_width = mean.half_width,
  };
  progress_update(driver->options.progress, &state, now, last);
}

static status tick(void *context, int running, struct error *error) {
  struct driver *driver = context;
  if (driver->error.status != STATUS_OK) {
    if (error)
      *error = driver->error;
    return driver->error.status;
  }
  show(driver, running, false);
  return store_tick(driver->store, error);
}

/* mpirun may kill in a second: what is there is committed first. */
static void stopping(void *context, int signal_number) {
  struct driver *driver = context;
  (void)signal_number;
  store_flush(driver->store, NULL);
  driver_note(driver, "stopping: no new runs, those that end in a moment are kept; the same command goes on from here");
}

struct farm_manager driver_manager(struct driver *driver) {
  return (struct farm_manager){.context = driver, .next = next, .report = report, .tick = tick, .stopping = stopping};
}

status driver_end(struct driver *driver, struct error *error) {
  show(driver, 0, true);
  status code = store_flush(driver->store, error);
  if (driver->error.status == STATUS_OK)
    return code;
  if (error)
    *error = driver->error;
  return driver->error.status;
}

void driver_summarise(const struct driver *driver, struct driver_summary *summary) {
  *summary = driver->summary;
}
