/* Runs out and reports in, between a planner and the farm. */
#include "campaign/scheduler/scheduler.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <utlist.h>

#include "engine/grow.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

enum { HELD_BYTES = 64 << 20 }; /* of reports while another program holds the store; then no new runs start */
#define HELD_NOTED_S 10.0
#define HELD_LAST_S  10.0

void scheduler_limits(const struct campaign *campaign, struct farm_options *options) {
  options->time_limit_s = isnan(campaign->time_limit) ? 0 : campaign->time_limit;
  options->memory_limit = isnan(campaign->memory_limit) ? 0 : (size_t)campaign->memory_limit;
}

void scheduler_note(const struct scheduler *scheduler, const char *text) {
  if (scheduler->options.note)
    scheduler->options.note(scheduler->options.note_context, text);
}

status scheduler_announce(struct scheduler *scheduler, const struct campaign *campaign, const char *plan,
                          int64_t *session_id, int64_t *campaign_id, struct error *error) {
  const char *facts = scheduler->options.facts;
  TRY(store_begin_session(scheduler->store, facts ? facts : "{}", session_id, error));
  TRY(store_add_campaign(scheduler->store, campaign->name, campaign->text, plan, campaign_id, error));
  for (size_t i = 0; i < campaign->axis_count; i++)
    TRY(store_add_axis(scheduler->store, campaign->axes[i].row, campaign->axes[i].unit, error));
  return STATUS_OK;
}

status scheduler_show_input(struct store *store, const struct field *row, struct error *error) {
  const char *unit = row->flags & FIELD_PERCENT ? "%" : row->unit && strcmp(row->unit, "rad") == 0 ? "deg" : "";
  return store_add_axis(store, row, unit, error);
}

bool scheduler_follows(const char *scene_json, const struct field *row) {
  struct error error;
  SCENE scene = NULL;
  if (!(row->flags & FIELD_DERIVED) || scene_parse_json("stored scene", scene_json, &scene, &error) != STATUS_OK)
    return false;
  const struct field *own = field_find(scene->kind->inputs, row->path, NULL);
  return own && scene_follows(scene, own);
}

int64_t scheduler_replicate(const struct campaign *campaign, const struct scene *scene,
                            const struct ask_run_of_point *run) {
  const int64_t r = campaign->independent ? run->replicate : (int64_t)(run->seed - (uint64_t)campaign->first_seed);
  if (r < 0 || campaign_seed(campaign, scene, r) != run->seed)
    return -1;
  uint8_t identity[16];
  scene_identity(scene, run->seed, identity);
  return memcmp(identity, run->identity, sizeof identity) == 0 ? r : -1;
}

int scheduler_attempts(const struct scheduler *scheduler, const uint8_t identity[16]) {
  struct farm_options limits = {0};
  scheduler_limits(scheduler->planner.limits, &limits);
  return store_attempts(scheduler->store, identity, limits.time_limit_s, (double)limits.memory_limit);
}

/* Path of a run's fields: "results.db" gives "results-fields/<identity>.h5". It is relative to the store's folder, or
 * with `folder` begins with that folder. */
static void fields_path(const struct scheduler *scheduler, const struct scheduler_run *run, bool folder, char *path,
                        size_t size) {
  const char *store = store_path(scheduler->store);
  const char *slash = strrchr(store, '/');
  const char *base = slash ? slash + 1 : store;
  const char *dot = strrchr(base, '.');
  const int stem = dot && dot != base ? (int)(dot - base) : (int)strlen(base);
  char hex[33];
  text_hex(run->identity, 16, hex);
  snprintf(path, size, "%.*s%.*s-fields/%s.h5", folder ? (int)(base - store) : 0, store, stem, base, hex);
}

/* ---- runs out ---- */

/* The next run whose attempts are not used up. The planner is told of those that are. */
static status next_run(struct scheduler *scheduler, struct scheduler_run *run, struct error *error) {
  const struct scheduler_planner *planner = &scheduler->planner;
  for (;;) {
    *run = (struct scheduler_run){0};
    TRY(planner->next(planner->context, run, error));
    if (!run->scene)
      return STATUS_OK;
    scene_identity(run->scene, run->seed, run->identity);
    const int failed = run->replay ? 0 : scheduler_attempts(scheduler, run->identity);
    run->attempt = failed + 1;
    if (run->replay || failed < planner->limits->attempts)
      return STATUS_OK;
    TRY(planner->ended(planner->context, run, &(struct scheduler_end){.ending = SCHEDULER_FAILED}, error));
  }
}

/* The farm sends a slot its next run before it has finished: of the runs that are out, as many run as there are slots.
 * A run that waits has the start NaN. */
static void start_waiting(struct scheduler *scheduler) {
  int running = 0;
  for (size_t i = 0; i < scheduler->places; i++)
    running += scheduler->out[i].scene && !isnan(scheduler->out[i].started);
  for (size_t i = 0; i < scheduler->places && running < scheduler->options.slots; i++)
    if (scheduler->out[i].scene && isnan(scheduler->out[i].started)) {
      scheduler->out[i].started = clock_s();
      running++;
    }
}

static status send(struct scheduler *scheduler, struct farm_task *task, struct error *error) {
  struct scheduler_run run;
  char path[LIMITS_PATH] = "";
  TRY(next_run(scheduler, &run, error));
  task->bytes = NULL;
  if (!run.scene)
    return STATUS_OK;
  size_t place = 0;
  while (place < scheduler->places && scheduler->out[place].scene)
    place++;
  if (place == scheduler->places) {
    if (!grow_room(&scheduler->out, &scheduler->places, place + 1, sizeof *scheduler->out))
      return status_fail(error, STATUS_MEMORY, "no memory for a task");
    memset(scheduler->out + place, 0, (scheduler->places - place) * sizeof *scheduler->out);
  }
  if (run.fields)
    fields_path(scheduler, &run, true, path, sizeof path);
  const struct run_request request = {.kind = run.scene->kind,
                                      .inputs = run.scene->inputs,
                                      .seed = run.seed,
                                      .fields_path = path[0] ? path : NULL};
  free(scheduler->task);
  scheduler->task = run_encode_task(&request, &task->size);
  if (!scheduler->task)
    return status_fail(error, STATUS_MEMORY, "no memory for a task");
  run.started = NAN;
  scheduler->out[place] = run;
  start_waiting(scheduler);
  task->id = place;
  task->bytes = scheduler->task;
  return STATUS_OK;
}

static bool next_task(void *context, struct farm_task *task) {
  struct scheduler *scheduler = context;
  if (scheduler->error.status != STATUS_OK || scheduler->stop.status != STATUS_OK)
    return false; /* tick() passes the error to the farm */
  if (scheduler->held_bytes > HELD_BYTES)
    return false;
  scheduler->error.status = send(scheduler, task, &scheduler->error);
  return scheduler->error.status == STATUS_OK && task->bytes;
}

/* ---- reports in ---- */

static status store_attempt(struct scheduler *scheduler, const struct scheduler_run *run,
                            const struct farm_report *report, struct error *error) {
  static const char *const reasons[] = {[FARM_DONE] = "exit",
                                        [FARM_FAILED] = "exit",
                                        [FARM_TIME_LIMIT] = "time_limit",
                                        [FARM_MEMORY_LIMIT] = "memory_limit",
                                        [FARM_CRASHED] = "crash",
                                        [FARM_LOST] = "lost"};
  struct farm_options limits = {0};
  scheduler_limits(scheduler->planner.limits, &limits);
  struct store_attempt attempt = {
      .point_id = run->point_id,
      .replicate = run->replicate,
      .session_id = run->session_id,
      .seed = run->seed,
      .attempt = run->attempt,
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
  memcpy(attempt.identity, run->identity, sizeof attempt.identity);
  return store_add_attempt(scheduler->store, &attempt, error);
}

/* An attempt without a result. The machine may end limits.attempts attempts before the run is left to the next
 * invocation; these never count as failures of the run. */
static status take_attempt(struct scheduler *scheduler, struct scheduler_run *run, struct scheduler_end *end,
                           struct error *error) {
  const struct farm_report *report = end->report;
  const int64_t attempts = scheduler->planner.limits->attempts;
  if (run->replay) {
    char path[LIMITS_PATH], text[LIMITS_PATH + 304];
    fields_path(scheduler, run, false, path, sizeof path);
    snprintf(text, sizeof text, "fields of seed %llu could not be written to %s: %s", (unsigned long long)run->seed,
             path, report->message && report->message[0] ? report->message : "the replay did not end well");
    scheduler_note(scheduler, text);
    end->ending = report->ending == FARM_LOST ? SCHEDULER_LEFT : SCHEDULER_FAILED;
    return STATUS_OK;
  }
  TRY(store_attempt(scheduler, run, report, error));
  if (report->ending == FARM_LOST)
    end->ending = ++run->lost < attempts ? SCHEDULER_AGAIN : SCHEDULER_LEFT;
  else
    end->ending = run->attempt < attempts ? SCHEDULER_AGAIN : SCHEDULER_FAILED;
  return STATUS_OK;
}

static status store_result(struct scheduler *scheduler, const struct scheduler_run *run, struct scheduler_end *end,
                           struct error *error) {
  const struct run_result *result = end->result;
  char path[LIMITS_PATH];
  end->fields = run->fields && result->outcome.state != OUTCOME_INVALID && !result->unwritten.status;
  fields_path(scheduler, run, false, path, sizeof path);
  struct store_run row = {
      .point_id = run->point_id,
      .session_id = run->session_id,
      .replicate = run->replicate,
      .seed = run->seed,
      .surplus = scheduler->planner.is_surplus && scheduler->planner.is_surplus(scheduler->planner.context, run),
      .kind = run->scene->kind,
      .outcome = &result->outcome,
      .result = result->result,
      .fragments = result->fragments,
      .fragment_count = result->fragment_count,
      .estimates = result->estimate_count ? result->estimates : NULL,
      .estimate_count = result->estimate_count,
      .wall_s = end->report->wall_s,
      .cpu_s = end->report->cpu_s,
      .peak_memory = end->report->peak_memory,
      .attempt = run->attempt,
      .host = end->report->host,
      .rank = end->report->rank,
      .fields_path = end->fields ? path : NULL,
      .fields_digest = end->fields ? result->fields_digest : NULL,
  };
  memcpy(row.identity, run->identity, sizeof row.identity);
  return store_add_run(scheduler->store, &row, error);
}

/* The run was computed again for its fields. */
static status store_fields(struct scheduler *scheduler, const struct scheduler_run *run, struct scheduler_end *end,
                           struct error *error) {
  char path[LIMITS_PATH];
  const struct run_result *result = end->result;
  end->fields = !result->unwritten.status;
  end->result = NULL;
  fields_path(scheduler, run, false, path, sizeof path);
  return end->fields ? store_set_fields(scheduler->store, run->identity, path, result->fields_digest, error)
                     : STATUS_OK;
}

/* Starts no more runs; results of running ones are still stored. The next invocation writes the missing fields. Commits
 * before fields of other runs fill the disk. */
static status stop_without_fields(struct scheduler *scheduler, const struct error *why, struct error *error) {
  if (scheduler->stop.status == STATUS_OK) {
    status_fail(&scheduler->stop, why->status,
                "%s. The results are stored, these fields are not: free some space, and give the same command again",
                why->message);
    scheduler_note(scheduler, "a fields file cannot be written: no new runs start, and the running ones end first");
  }
  return store_flush(scheduler->store, error);
}

static status take(struct scheduler *scheduler, struct scheduler_run run, const struct farm_report *report,
                   struct error *error) {
  const struct scheduler_planner *planner = &scheduler->planner;
  struct scheduler_end end = {.report = report};
  RUN_RESULT result = {0};
  if (report->ending != FARM_DONE) {
    TRY(take_attempt(scheduler, &run, &end, error));
  } else {
    TRY(run_decode_result(run.scene->kind, report->bytes, report->size, &result, error));
    end.result = &result;
    TRY((run.replay ? store_fields : store_result)(scheduler, &run, &end, error));
  }
  if (result.unwritten.status)
    TRY(stop_without_fields(scheduler, &result.unwritten, error));
  TRY(planner->ended(planner->context, &run, &end, error));
  if (scheduler->stop.status != STATUS_OK)
    return status_fail(error, STATUS_STOPPED, "%s", scheduler->stop.message);
  return STATUS_OK;
}

/* ---- another program holds the store: reports wait in memory, and the slots go on ---- */

struct scheduler_held {
  struct scheduler_run run;
  struct farm_report report; /* bytes and message: owned */
  struct scheduler_held *prev, *next;
};

static status hold(struct scheduler *scheduler, const struct scheduler_run *run, const struct farm_report *report,
                   struct error *error) {
  uint8_t *bytes = NULL;
  TRY(memory_array(&bytes, report->size, 1, "results while another program holds the store", error));
  struct scheduler_held *held = memory_small(1, sizeof *held);
  *held = (struct scheduler_held){.run = *run, .report = *report};
  held->report.bytes = bytes;
  held->report.message = memory_small_text(report->message ? report->message : "");
  if (report->size)
    memcpy(bytes, report->bytes, report->size);
  if (!scheduler->held)
    scheduler->held_since = clock_s();
  DL_APPEND(scheduler->held, held);
  scheduler->held_bytes += sizeof *held + report->size;
  return STATUS_OK;
}

static void drop_held(struct scheduler *scheduler, struct scheduler_held *held) {
  DL_DELETE(scheduler->held, held);
  scheduler->held_bytes -= sizeof *held + held->report.size;
  free((void *)held->report.bytes);
  free((void *)held->report.message);
  free(held);
}

/* Takes in what waits, as long as the store is free, or is so within the given time. */
static status take_held(struct scheduler *scheduler, double patience_s, struct error *error) {
  status code = STATUS_OK;
  while (code == STATUS_OK && scheduler->held && store_begin_within(scheduler->store, patience_s)) {
    struct scheduler_held *held = scheduler->held;
    code = take(scheduler, held->run, &held->report, error);
    drop_held(scheduler, held);
  }
  const bool long_held = scheduler->held && clock_s() - scheduler->held_since > HELD_NOTED_S;
  if (long_held && !scheduler->held_noted)
    scheduler_note(scheduler, "another program holds the store (a database browser with unsaved changes?): results "
                              "wait in memory until it lets go");
  scheduler->held_noted = long_held;
  return code;
}

/* After a signal: results that cannot be stored within HELD_LAST_S are lost. */
static void end_held(struct scheduler *scheduler) {
  struct error ignored = {0};
  const struct scheduler_held *held;
  size_t count = 0;
  char text[160];
  DL_COUNT(scheduler->held, held, count);
  if (count == 0)
    return;
  snprintf(text, sizeof text, "another program holds the store: clast tries for %g s to store %zu results", HELD_LAST_S,
           count);
  scheduler_note(scheduler, text);
  scheduler->held_noted = true;
  (void)take_held(scheduler, HELD_LAST_S, &ignored);
  for (count = 0; scheduler->held; count++)
    drop_held(scheduler, scheduler->held);
  if (count == 0)
    return;
  snprintf(text, sizeof text,
           "%zu results were not stored, because another program holds the store; the same command computes them again",
           count);
  scheduler_note(scheduler, text);
}

static status take_report(void *context, const struct farm_report *report, struct error *error) {
  struct scheduler *scheduler = context;
  if (report->id >= scheduler->places || !scheduler->out[report->id].scene)
    return status_fail(error, STATUS_INTERNAL, "the farm reported a task that it was not given");
  const struct scheduler_run run = scheduler->out[report->id];
  scheduler->out[report->id].scene = NULL;
  start_waiting(scheduler);
  TRY(take_held(scheduler, 0, error));
  if (scheduler->held || !store_begin_within(scheduler->store, 0))
    return hold(scheduler, &run, report, error);
  return take(scheduler, run, report, error);
}

static bool waits(void *context) {
  return ((const struct scheduler *)context)->held != NULL;
}

/* ---- the farm's other callbacks ---- */

static status tick(void *context, int running, struct error *error) {
  struct scheduler *scheduler = context;
  if (scheduler->error.status != STATUS_OK) {
    if (error)
      *error = scheduler->error;
    return scheduler->error.status;
  }
  TRY(take_held(scheduler, 0, error));
  if (scheduler->planner.tick)
    scheduler->planner.tick(scheduler->planner.context, running, false);
  return store_tick(scheduler->store, error);
}

/* Commits first: mpirun may kill this process within a second. Without a signal a rank was lost, and the others go on.
 */
static void stopping(void *context, int signal_number) {
  struct scheduler *scheduler = context;
  store_flush(scheduler->store, NULL);
  if (signal_number == 0)
    return;
  if (scheduler->planner.stopping)
    scheduler->planner.stopping(scheduler->planner.context);
  else
    scheduler_note(scheduler, "stopping: no new runs start, and runs that end in a moment are kept; the same command "
                              "goes on from here");
}

struct farm_manager scheduler_manager(struct scheduler *scheduler) {
  return (struct farm_manager){.context = scheduler,
                               .next = next_task,
                               .report = take_report,
                               .tick = tick,
                               .stopping = stopping,
                               .orders = scheduler->planner.orders,
                               .waits = waits};
}

status scheduler_end(struct scheduler *scheduler, status code, struct error *error) {
  if (scheduler->planner.tick)
    scheduler->planner.tick(scheduler->planner.context, 0, true);
  /* The disk that refused fields may refuse the last commit, too, which is then the error. */
  const bool refused = code == STATUS_STOPPED && scheduler->stop.status != STATUS_OK;
  const bool good = code == STATUS_OK || refused;
  if (code != STATUS_OK)
    store_hurry(scheduler->store, HELD_LAST_S);
  end_held(scheduler);
  const status flushed = store_flush(scheduler->store, good ? error : NULL);
  const struct error *why = NULL;
  if (scheduler->error.status != STATUS_OK)
    why = &scheduler->error;
  else if (refused && flushed == STATUS_OK)
    why = &scheduler->stop;
  if (good && why)
    *error = *why;
  free(scheduler->out);
  free(scheduler->task);
  scheduler->out = NULL;
  scheduler->task = NULL;
  scheduler->places = 0;
  if (!good)
    return code;
  return why ? why->status : flushed;
}

void scheduler_release_ranks(struct farm *farm) {
  struct error ignored;
  farm_run(farm, &(struct farm_manager){0}, &ignored);
}

status scheduler_compute(const struct scheduler_planner *planner, struct farm *farm,
                         const struct scheduler_options *options, struct error *error) {
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);
  struct scheduler scheduler = {.planner = *planner, .options = *options};
  char warning[1024] = "";
  scheduler.options.slots = farm_slots_total(farm);
  status code = store_open_writer(options->store_path, &scheduler.store, warning, sizeof warning, error);
  if (code == STATUS_OK && warning[0])
    scheduler_note(&scheduler, warning);
  if (code == STATUS_OK)
    code = planner->begin(planner->context, &scheduler, error);
  if (code == STATUS_OK) {
    const struct farm_manager manager = scheduler_manager(&scheduler);
    code = scheduler_end(&scheduler, farm_run(farm, &manager, error), error);
    code = planner->end(planner->context, code, error);
  } else {
    scheduler_release_ranks(farm);
  }

  /* Committed results are kept. An error on closing is returned only if there was no earlier error. */
  struct error closing = {0};
  const status closed = store_close(scheduler.store, &closing);
  if (closed == STATUS_OK || (code != STATUS_OK && code != STATUS_FAILED_RUNS))
    return code;
  if (error)
    *error = closing;
  return closed;
}
