#include "campaign/driver.h"

#include <stdio.h>

#include "campaign/pooling.h"

static status verdict(const struct driver_summary *summary, status code, struct error *error) {
  if (code != STATUS_OK || summary->runs_failed + (int64_t)summary->points_invalid == 0)
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
  return code == STATUS_OK || code == STATUS_FAILED_RUNS ? "finished" : code == STATUS_STOPPED ? "stopped" : "failed";
}

/* Nothing to do: lets the other ranks go in peace when the manager cannot begin. */
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

status driver_run(const struct campaign *campaign, struct farm *farm, const struct driver_options *options,
                  struct driver_summary *summary, struct error *error) {
  *summary = (struct driver_summary){0};
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);
  struct driver_options own = *options;
  if (!own.store_path)
    own.store_path = campaign->store;
  own.slots = farm_slots_total(farm);
  struct store *store = NULL;
  struct driver *driver = NULL;
  char warning[1024] = "";
  status code = store_open_writer(own.store_path, &store, warning, sizeof warning, error);
  if (code == STATUS_OK && warning[0] && own.note)
    own.note(own.note_context, warning);
  if (code == STATUS_OK)
    code = driver_open(campaign, store, &own, &driver, error);
  if (code == STATUS_OK) {
    struct farm_manager manager = driver_manager(driver);
    code = farm_run(farm, &manager, error);
    status ended = driver_end(driver, code == STATUS_OK ? error : NULL);
    code = code != STATUS_OK ? code : ended;
    driver_summarise(driver, summary);
    if (code == STATUS_OK) /* after a stop there is no time to lose: the next invocation pools */
      code = pooling_store(store, summary->campaign_id, error);
    code = verdict(summary, code, error);
    status session = store_end_session(store, summary->session_id, outcome_of(code), code == STATUS_OK ? error : NULL);
    code = code != STATUS_OK ? code : session;
  } else {
    const struct farm_manager nobody = {.next = no_task, .report = no_report, .tick = no_tick};
    struct error ignored;
    farm_run(farm, &nobody, &ignored);
  }
  driver_free(driver);
  /* What was committed stays, whatever happened; an error on closing is the last word only when all else went well. */
  struct error closing = {0};
  status closed = store_close(store, &closing);
  if (closed != STATUS_OK && (code == STATUS_OK || code == STATUS_FAILED_RUNS)) {
    code = closed;
    if (error)
      *error = closing;
  }
  return code;
}
