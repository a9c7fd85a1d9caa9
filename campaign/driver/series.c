/* Several campaigns in one run of the farm: the farm's callbacks pass through to the driver of the campaign under way.
 */
#include "campaign/driver/series.h"

#include "campaign/driver/pooling.h"

struct running {
  const struct series *series;
  const struct driver_options *options;
  struct store *store;
  struct series_summary *summary;
  struct campaign *campaign; /* owned; NULL between two campaigns */
  struct driver *driver;     /* owned; NULL between two campaigns */
  struct farm_manager calls; /* the driver's callbacks */
  int out;                   /* tasks on slots */
  bool finished;             /* no campaign is left */
  struct error error;        /* error of a callback that cannot return one */
};

static status begin(struct running *running, struct error *error) {
  error->status = STATUS_OK;
  running->campaign = running->series->next(running->series->context, running->store, error);
  running->finished = !running->campaign;
  if (!running->campaign)
    return error->status;
  const status code = driver_open(running->campaign, running->store, running->options, &running->driver, error);
  if (code == STATUS_OK)
    running->calls = driver_manager(running->driver);
  return code;
}

/* `outcome`: outcome of the campaign's session in the store. */
static status end(struct running *running, const char *outcome, struct error *error) {
  struct driver_summary summary;
  status code = driver_end(running->driver, error);
  driver_summarise(running->driver, &summary);
  running->summary->runs_done += summary.runs_done;
  running->summary->runs_failed += summary.runs_failed;
  running->summary->runs_reused += summary.runs_reused;
  running->summary->cpu_s += summary.cpu_s;
  driver_free(running->driver);
  running->driver = NULL;
  campaign_free(running->campaign);
  running->campaign = NULL;
  if (code == STATUS_OK)
    code = store_end_session(running->store, summary.session_id, outcome, error);
  return code;
}

static bool next_task(void *context, struct farm_task *task) {
  struct running *running = context;
  struct error *error = &running->error;
  while (error->status == STATUS_OK && !running->finished) {
    if (!running->driver) {
      error->status = begin(running, error);
      continue;
    }
    if (running->calls.next(running->calls.context, task)) {
      running->out++;
      return true;
    }
    if (running->out > 0)
      return false;
    error->status = end(running, "finished", error);
    if (error->status == STATUS_OK)
      error->status = running->series->done(running->series->context, running->store, error);
  }
  return false;
}

static status take_report(void *context, const struct farm_report *report, struct error *error) {
  struct running *running = context;
  running->out--;
  return running->calls.report(running->calls.context, report, error);
}

static status tick(void *context, int slots, struct error *error) {
  struct running *running = context;
  if (running->error.status != STATUS_OK) {
    *error = running->error;
    return running->error.status;
  }
  return running->driver ? running->calls.tick(running->calls.context, slots, error) : STATUS_OK;
}

static void stopping(void *context, int signal_number) {
  struct running *running = context;
  if (running->driver)
    running->calls.stopping(running->calls.context, signal_number);
}

static status run_all(struct running *running, struct farm *farm, struct error *error) {
  const struct farm_manager manager = {.context = running,
                                       .next = next_task,
                                       .report = take_report,
                                       .tick = tick,
                                       .stopping = stopping};
  status code = farm_run(farm, &manager, error);
  if (code == STATUS_OK && running->error.status != STATUS_OK) {
    *error = running->error;
    code = running->error.status;
  }
  struct error ignored;
  if (running->driver)
    (void)end(running, code == STATUS_STOPPED ? "stopped" : "failed", &ignored);
  campaign_free(running->campaign);
  return code == STATUS_OK ? pooling_store(running->store, 0, error) : code;
}

status series_run(const struct series *series, struct farm *farm, const struct driver_options *options,
                  struct series_summary *summary, struct error *error) {
  *summary = (struct series_summary){0};
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);
  struct driver_options own = *options;
  own.slots = farm_slots_total(farm);
  struct running running = {.series = series, .options = &own, .summary = summary};
  char warning[1024] = "";
  status code = store_open_writer(own.store_path, &running.store, warning, sizeof warning, error);
  if (code == STATUS_OK && warning[0] && own.note)
    own.note(own.note_context, warning);
  if (code == STATUS_OK)
    code = run_all(&running, farm, error);
  else
    driver_release_ranks(farm);
  struct error closing = {0};
  const status closed = store_close(running.store, &closing);
  if (closed != STATUS_OK && code == STATUS_OK) {
    *error = closing;
    code = closed;
  }
  return code;
}
