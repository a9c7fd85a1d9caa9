/* Stores the result of a run or an attempt, and updates its point. */
#include <stdio.h>
#include <string.h>

#include "campaign/driver/private.h"
#include "campaign/driver/record.h"

static struct record record_of(const struct driver *driver, const struct flight *flight) {
  struct record record = {.point_id = flight->point->id,
                          .session_id = driver->summary.session_id,
                          .replicate = flight->replicate,
                          .seed = flight->seed,
                          .attempt = flight->attempt};
  memcpy(record.identity, flight->identity, sizeof record.identity);
  return record;
}

static status store_result(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                           const struct run_result *result, struct error *error) {
  struct point *point = flight->point;
  struct point_replicate *replicate = &point->replicates[flight->replicate];
  char path[4096] = "";
  if (driver_writes_fields(driver, flight) && result->outcome.state != OUTCOME_INVALID && !result->unwritten.status)
    driver_fields_path(driver, flight->identity, false, path, sizeof path);
  replicate->surplus = flight->replicate >= point->prefix;
  replicate->fields = path[0] != '\0' || result->outcome.state == OUTCOME_INVALID;
  driver->summary.fields_written += path[0] != '\0';
  driver->summary.runs_surplus += replicate->surplus;
  struct record record = record_of(driver, flight);
  record.surplus = replicate->surplus;
  record.fields_path = path[0] ? path : NULL;
  return record_run(driver->store, &record, point->scene->kind, report, result, error);
}

static status store_failure(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                            struct error *error) {
  const struct record record = record_of(driver, flight);
  driver->summary.attempts_failed++;
  return record_attempt(driver->store, &record, report, driver->time_limit, driver->memory_limit, error);
}

/* Many failures among the first runs mean that something is wrong with the campaign, not with chance. */
static status judge_failures(struct driver *driver, bool failed, struct error *error) {
  if (driver->first_done >= CAMPAIGN_FIRST_RUNS)
    return STATUS_OK;
  driver->first_done++;
  driver->first_failed += failed;
  if (driver->campaign->failures == 0 || driver->first_failed < driver->campaign->failures)
    return STATUS_OK;
  return status_fail(error, STATUS_FAILED_RUNS,
                     "stopped: %lld of the first %lld runs failed. `clast query %s --named failures` says why. Correct "
                     "the campaign, or set limits.failures: 0 to ignore failures",
                     (long long)driver->first_failed, (long long)driver->first_done, driver->options.store_path);
}

/* The machine ended the attempt, which says nothing about the run. This invocation tries the run again, up to
 * limits.attempts times; then the next invocation does. The run never counts as failed. */
static void finish_lost(struct driver *driver, const struct flight *flight) {
  struct point_replicate *replicate = &flight->point->replicates[flight->replicate];
  if (++replicate->lost < driver->campaign->attempts) {
    point_want_again(flight->point, flight->replicate);
    return;
  }
  point_leave(flight->point, flight->replicate);
  driver->summary.runs_left++;
}

/* Starts no more runs; results of running ones are still stored. The next invocation writes the missing fields. */
static void stop_without_fields(struct driver *driver, const struct error *why) {
  if (driver->stop.status != STATUS_OK)
    return;
  status_fail(&driver->stop, why->status,
              "%s. The results are stored, these fields are not: free some space, and give the same command again",
              why->message);
  driver_note(driver, "a fields file cannot be written: no new runs start, and the running ones end first");
}

/* Handles an attempt without a result: the run is tried again, or counts as failed when its attempts are used up. */
static status finish_attempt(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                             struct error *error) {
  status code = store_failure(driver, flight, report, error);
  if (code != STATUS_OK)
    return code;
  if (report->ending == FARM_LOST) {
    finish_lost(driver, flight);
    return STATUS_OK;
  }
  if (flight->attempt < driver->campaign->attempts) {
    point_want_again(flight->point, flight->replicate);
    return STATUS_OK;
  }
  driver_give_up(driver, flight->point, flight->replicate);
  return judge_failures(driver, true, error);
}

static status finish_run(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                         struct error *error) {
  if (report->ending != FARM_DONE)
    return finish_attempt(driver, flight, report, error);

  struct point *point = flight->point;
  struct run_result result;
  status code = run_decode_result(point->scene->kind, report->bytes, report->size, &result, error);
  if (code != STATUS_OK)
    return code;
  code = store_result(driver, flight, report, &result, error);
  if (code != STATUS_OK)
    goto cleanup;

  const bool usable = campaign_usable(&result.outcome);
  const double value = campaign_value(driver->row, driver->row_of_outcome, &result.outcome, result.result);
  point_finish_replicate(point, flight->replicate, POINT_DONE, value);
  cost_learn(&driver->cost, &point->cost, report->wall_s);
  sample_add(&driver->moments, value);
  driver->summary.runs_done++;
  driver->summary.runs_failed += !usable;
  driver->summary.runs_censored += result.outcome.state == OUTCOME_END_TIME;
  driver->summary.cpu_s += report->cpu_s;
  if (result.unwritten.status != STATUS_OK) {
    stop_without_fields(driver, &result.unwritten);
    code = store_flush(driver->store, error); /* before fields of other runs fill the disk */
  }
  if (code == STATUS_OK)
    code = judge_failures(driver, !usable, error);
cleanup:
  run_result_clear(&result);
  return code;
}

/* STATUS_OK when the run that was computed for its fields has written them. */
static status fields_written(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                             struct error *error) {
  struct run_result result;
  status code = run_decode_result(flight->point->scene->kind, report->bytes, report->size, &result, error);
  if (code != STATUS_OK)
    return code;
  code = result.unwritten.status;
  if (code != STATUS_OK)
    stop_without_fields(driver, &result.unwritten);
  run_result_clear(&result);
  return code;
}

static status finish_replay(struct driver *driver, const struct flight *flight, const struct farm_report *report,
                            struct error *error) {
  struct point_replicate *replicate = &flight->point->replicates[flight->replicate];
  char path[4096], text[4400];
  replicate->replaying = false;
  driver_fields_path(driver, flight->identity, false, path, sizeof path);
  if (report->ending != FARM_DONE) {
    snprintf(text, sizeof text, "fields of seed %llu could not be written to %s: %s", (unsigned long long)flight->seed,
             path, report->message && report->message[0] ? report->message : "the replay did not end well");
    driver_note(driver, text);
    driver->summary.runs_left += report->ending == FARM_LOST;
    return STATUS_OK;
  }
  if (fields_written(driver, flight, report, error) != STATUS_OK)
    return driver->stop.status != STATUS_OK ? STATUS_OK : STATUS_INTERNAL;
  replicate->fields = true;
  driver->summary.fields_written++;
  return store_set_fields(driver->store, flight->identity, path, error);
}

status driver_receive(void *context, const struct farm_report *report, struct error *error) {
  struct driver *driver = context;
  if (report->id >= driver->flight_count || !driver->flights[report->id].point)
    return status_fail(error, STATUS_INTERNAL, "the farm reported a task that it was not given");
  const struct flight flight = driver->flights[report->id];
  driver->flights[report->id].point = NULL;
  flight.point->out--;

  status code = STATUS_OK;
  if (flight.replay) {
    code = finish_replay(driver, &flight, report, error);
  } else {
    code = finish_run(driver, &flight, report, error);
    driver->started_done++;
    driver->finished_s += report->wall_s;
  }
  if (code == STATUS_OK)
    code = driver_window_judge(driver, flight.point, error);
  else if (code == STATUS_FAILED_RUNS)
    (void)driver_window_judge(driver, flight.point, NULL); /* the stop keeps its own message */
  if (point_over(flight.point))
    driver_window_drop(driver, flight.point);
  if (code == STATUS_OK && driver->stop.status != STATUS_OK)
    return status_fail(error, STATUS_STOPPED, "%s", driver->stop.message);
  return code;
}
