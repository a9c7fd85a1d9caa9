/* The life of a campaign's driver: opening, the whole run with farm and store, progress, the end. Runs go out in send.c
 * and come back in receive.c. */
#include "campaign/driver/private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/driver/pooling.h"
#include "schemas/clock.h"
#include "schemas/text.h"

void driver_note(struct driver *driver, const char *text) {
  if (driver->options.note)
    driver->options.note(driver->options.note_context, text);
}

void driver_farm_options(const struct campaign *campaign, struct farm_options *options) {
  options->time_limit_s = isnan(campaign->time_limit) ? 0 : campaign->time_limit;
  options->memory_limit = isnan(campaign->memory_limit) ? 0 : (size_t)campaign->memory_limit;
}

/* The campaign's session and plan in the store, committed: readers see the campaign from its first second. */
static status announce(struct driver *driver, struct error *error) {
  const struct campaign *campaign = driver->campaign;
  const char *facts = driver->options.facts ? driver->options.facts : "{}";
  status code = store_begin_session(driver->store, facts, &driver->summary.session_id, error);
  if (code != STATUS_OK)
    return code;

  char plan[256];
  snprintf(plan, sizeof plan,
           "{\"design\": %d, \"points\": %llu, \"replicates_least\": %lld, \"replicates_most\": %lld}",
           campaign->design.kind, (unsigned long long)design_points(driver->walk.design),
           (long long)campaign_replicates_least(campaign), (long long)campaign_replicates_most(campaign));
  code = store_add_campaign(driver->store, campaign->name, campaign->text, plan, &driver->summary.campaign_id, error);
  if (code == STATUS_OK)
    code = store_set_session(driver->store, driver->summary.session_id, driver->summary.campaign_id, error);
  for (size_t i = 0; code == STATUS_OK && i < campaign->axis_count; i++)
    code = store_add_axis(driver->store, campaign->axes[i].row, campaign->axes[i].unit, error);
  return code == STATUS_OK ? store_flush(driver->store, error) : code;
}

static status prepare(struct driver *driver, struct error *error) {
  const struct campaign *campaign = driver->campaign;
  driver->paths = calloc(campaign->axis_count + 1, sizeof *driver->paths);
  driver->points = calloc(DRIVER_WINDOW, sizeof *driver->points);
  if (!driver->paths || !driver->points)
    return status_fail(error, STATUS_MEMORY, "no memory for the campaign's driver");
  for (size_t i = 0; i < campaign->axis_count; i++)
    driver->paths[i] = campaign->axes[i].row->path;

  const char *quantity = campaign->per_point ? campaign->quantity : campaign->until_quantity;
  driver->row = campaign_quantity(campaign->scene->kind, quantity, &driver->row_of_outcome, error);
  if (!driver->row)
    return STATUS_CONTENT;
  status code = campaign_walk_begin(&driver->walk, campaign, error);
  return code == STATUS_OK ? announce(driver, error) : code;
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
  if (!options->store_path)
    driver->options.store_path = campaign->store;
  struct farm_options limits = {0};
  driver_farm_options(campaign, &limits);
  driver->time_limit = limits.time_limit_s;
  driver->memory_limit = (double)limits.memory_limit;
  driver->begin = driver->last_left = clock_s();
  driver->seconds_left = NAN;

  status code = prepare(driver, error);
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
  campaign_walk_end(&driver->walk);
  free(driver->paths);
  free(driver->points);
  driver_window_forget(driver);
  free(driver->flights);
  free(driver->task);
  free(driver);
}

void driver_give_up(struct driver *driver, struct point *point, int64_t replicate) {
  point_finish_replicate(point, replicate, POINT_FAILED, NAN);
  driver->summary.runs_failed++;
}

bool driver_writes_fields(const struct driver *driver, const struct flight *flight) {
  const struct campaign *campaign = driver->campaign;
  if (flight->replay || campaign->keep == CAMPAIGN_KEEP_ALL)
    return true;
  return campaign->keep == CAMPAIGN_KEEP_FIRST && flight->replicate < campaign->keep_first;
}

void driver_fields_path(const struct driver *driver, const uint8_t identity[16], bool folder, char *path, size_t size) {
  const char *store = driver->options.store_path;
  const char *slash = strrchr(store, '/');
  const char *base = slash ? slash + 1 : store;
  const char *dot = strrchr(base, '.');
  const int stem = dot && dot != base ? (int)(dot - base) : (int)strlen(base);
  char hex[33];
  text_hex(identity, 16, hex);
  snprintf(path, size, "%.*s%.*s-fields/%s.h5", folder ? (int)(base - store) : 0, store, stem, base, hex);
}

/* Adds the time that the runs on slots have used, and the longest time that one of them still needs. */
static void look_at_flights(const struct driver *driver, double now, struct cost_left *left) {
  for (size_t i = 0; i < driver->flight_count; i++) {
    const struct flight *flight = &driver->flights[i];
    if (!flight->point || flight->replay)
      continue;
    const double predicted = cost_predict(&driver->cost, &flight->point->cost), had = now - flight->started;
    left->under_way_s += fmin(had, predicted);
    left->longest_s = fmax(left->longest_s, predicted - had);
  }
}

/* Estimates the seconds left from the missing runs of the points in the window and a mean for later points. It is
 * updated once a second. */
static double time_left(struct driver *driver, double now) {
  if (now - driver->last_left < 1 && !isnan(driver->seconds_left))
    return driver->seconds_left;
  driver->last_left = now;
  driver->seconds_left = NAN;
  if (driver->cost.runs == 0)
    return NAN;

  struct cost_left left = {.finished_s = driver->finished_s,
                           .elapsed_s = now - driver->begin,
                           .slots = driver->options.slots};
  const double mean = driver->cost.seconds / (double)driver->cost.runs;
  for (size_t i = 0; i < driver->point_count; i++)
    left.missing_s += (double)point_missing(driver->points[i]) * cost_predict(&driver->cost, &driver->points[i]->cost);
  const uint64_t unmet = design_points(driver->walk.design) - driver->expanded;
  left.missing_s += (double)unmet * (double)campaign_replicates_least(driver->campaign) * mean;
  look_at_flights(driver, now, &left);
  driver->seconds_left = cost_time_left(&left);
  return driver->seconds_left;
}

static void show(struct driver *driver, int running, bool last) {
  if (!driver->options.progress)
    return;
  const struct driver_summary *summary = &driver->summary;
  const double now = clock_s(), elapsed = now - driver->begin;
  const uint64_t unmet = design_points(driver->walk.design) - driver->expanded;
  const struct sample_summary quantity = sample_summarise_moments(&driver->moments, 0.95);
  struct progress_state state = {
      .done = summary->runs_done + summary->runs_reused - summary->runs_surplus,
      .failed = summary->runs_failed,
      .running = running,
      .total = driver->wanted + (int64_t)unmet * campaign_replicates_least(driver->campaign),
      .total_is_minimum = driver->campaign->per_point == 0 && summary->points_done < summary->points,
      .rate = NAN,
      .seconds_left = last ? DRIVER_NOTHING : time_left(driver, now),
      .quantity = driver->row->path,
      .mean = quantity.mean,
      .half_width = design_points(driver->walk.design) == 1 ? quantity.half_width
                                                            : (double)NAN, /* of one point's seeds */
  };
  if (elapsed > 0 && driver->started_done > 0)
    state.rate = (double)driver->started_done / elapsed;
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

/* Commits first: mpirun may kill this process within a second. */
static void stopping(void *context, int signal_number) {
  struct driver *driver = context;
  (void)signal_number;
  store_flush(driver->store, NULL);
  driver_note(
      driver,
      "stopping: no new runs start, and runs that end in a moment are kept; the same command goes on from here");
}

struct farm_manager driver_manager(struct driver *driver) {
  return (struct farm_manager){.context = driver,
                               .next = driver_send,
                               .report = driver_receive,
                               .tick = tick,
                               .stopping = stopping};
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

/* ---- a whole campaign ---- */

static status verdict(const struct driver_summary *summary, status code, struct error *error) {
  if (code != STATUS_OK)
    return code;
  if (summary->runs_left > 0)
    return status_fail(error, STATUS_STOPPED,
                       "%lld run%s left: signals from outside ended %s, or the machine had no memory or disk; the same "
                       "command tries again, and `clast query STORE --named failures` says more",
                       (long long)summary->runs_left, summary->runs_left == 1 ? " is" : "s are",
                       summary->runs_left == 1 ? "it" : "them");
  if (summary->runs_failed + (int64_t)summary->points_invalid == 0)
    return code;
  char points[64] = "";
  if (summary->points_invalid)
    snprintf(points, sizeof points, " and %llu point%s could not be run", (unsigned long long)summary->points_invalid,
             summary->points_invalid == 1 ? "" : "s");
  return status_fail(error, STATUS_FAILED_RUNS,
                     "finished, but %lld run%s failed%s; `clast query STORE --named failures` says why",
                     (long long)summary->runs_failed, summary->runs_failed == 1 ? "" : "s", points);
}

static const char *outcome_of(status code) {
  if (code == STATUS_OK || code == STATUS_FAILED_RUNS)
    return "finished";
  return code == STATUS_STOPPED ? "stopped" : "failed";
}

static bool no_task(void *context, struct farm_task *task) {
  (void)context, (void)task;
  return false;
}
static status no_report(void *context, const struct farm_report *report, struct error *error) {
  (void)context, (void)report, (void)error;
  return STATUS_OK;
}
static status no_tick(void *context, int running, struct error *error) {
  (void)context, (void)running, (void)error;
  return STATUS_OK;
}

/* The end after fields could not be written. The same full disk may refuse the last commit, which is then the error. */
static status end_without_fields(struct driver *driver, struct error *error) {
  const status code = driver_end(driver, error);
  if (code != STATUS_OK)
    return code;
  if (error)
    *error = driver->stop;
  return driver->stop.status;
}

static status manage(struct driver *driver, struct farm *farm, struct driver_summary *summary, struct error *error) {
  struct farm_manager manager = driver_manager(driver);
  status code = farm_run(farm, &manager, error);
  if (code == STATUS_STOPPED && driver->stop.status != STATUS_OK) {
    code = end_without_fields(driver, error);
  } else {
    status ended = driver_end(driver, code == STATUS_OK ? error : NULL);
    code = code != STATUS_OK ? code : ended;
  }
  driver_summarise(driver, summary);
  if (code == STATUS_OK) /* a stopped campaign pools in its next invocation */
    code = pooling_store(driver->store, summary->campaign_id, error);
  code = verdict(summary, code, error);
  status session = store_end_session(driver->store, summary->session_id, outcome_of(code),
                                     code == STATUS_OK ? error : NULL);
  return code != STATUS_OK ? code : session;
}

void driver_release_ranks(struct farm *farm) {
  const struct farm_manager nobody = {.next = no_task, .report = no_report, .tick = no_tick};
  struct error ignored;
  farm_run(farm, &nobody, &ignored);
}

status driver_run(const struct campaign *campaign, struct farm *farm, const struct driver_options *options,
                  struct driver_summary *summary, struct error *error) {
  *summary = (struct driver_summary){0};
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);

  struct driver_options own = *options;
  own.slots = farm_slots_total(farm);
  struct store *store = NULL;
  struct driver *driver = NULL;
  char warning[1024] = "";
  const char *path = options->store_path ? options->store_path : campaign->store;
  status code = store_open_writer(path, &store, warning, sizeof warning, error);
  if (code == STATUS_OK && warning[0] && own.note)
    own.note(own.note_context, warning);
  if (code == STATUS_OK)
    code = driver_open(campaign, store, &own, &driver, error);
  if (code == STATUS_OK)
    code = manage(driver, farm, summary, error);
  else
    driver_release_ranks(farm);
  driver_free(driver);

  /* Committed results are kept. An error on closing is returned only if there was no earlier error. */
  struct error closing = {0};
  status closed = store_close(store, &closing);
  if (closed == STATUS_OK || (code != STATUS_OK && code != STATUS_FAILED_RUNS))
    return code;
  if (error)
    *error = closing;
  return closed;
}
