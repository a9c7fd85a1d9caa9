/* Puts HTTP, evaluations, farm and store together. */
#include "campaign/serve/serve.h"

#include "campaign/driver/driver.h"

struct server {
  struct serve_http *http;
  struct serve_jobs *jobs;
};

static bool next(void *context, struct farm_task *task) {
  return serve_jobs_next(((struct server *)context)->jobs, task);
}

static status report(void *context, const struct farm_report *report, struct error *error) {
  struct server *server = context;
  const status code = serve_jobs_report(server->jobs, report, error);
  serve_http_run(server->http);
  return code;
}

static status tick(void *context, int running, struct error *error) {
  struct server *server = context;
  (void)running;
  serve_http_run(server->http);
  return serve_jobs_tick(server->jobs, error);
}

static void stopping(void *context, int signal_number) {
  (void)signal_number;
  serve_jobs_stop(((struct server *)context)->jobs, false);
}

static status serve(struct server *server, struct farm *farm, struct error *error) {
  const struct farm_manager manager = {.context = server,
                                       .next = next,
                                       .report = report,
                                       .tick = tick,
                                       .stopping = stopping,
                                       .orders = serve_http_file(server->http)};
  status code = farm_run(farm, &manager, error);
  if (code == STATUS_STOPPED) /* a signal is the normal end of a server */
    code = STATUS_OK;
  serve_jobs_stop(server->jobs, true);
  const status ended = serve_jobs_end(server->jobs, code ? NULL : error);
  return code ? code : ended;
}

status serve_run(const struct serve_model *model, struct farm *farm, const struct serve_options *options,
                 struct serve_jobs_counts *counts, struct error *error) {
  *counts = (struct serve_jobs_counts){0};
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);
  struct server server = {0};
  struct store *store = NULL;
  status code = serve_http_open(model, options->address, options->port, &server.http, error);
  if (!code)
    code = store_open_writer(options->store, &store, NULL, 0, error);
  const struct serve_jobs_options jobs = {.facts = options->facts,
                                          .wait_s = options->wait_s,
                                          .answered = serve_http_answered,
                                          .context = server.http};
  if (!code)
    code = serve_jobs_open(model, store, &jobs, &server.jobs, error);
  if (code) {
    driver_release_ranks(farm);
  } else {
    serve_http_jobs(server.http, server.jobs);
    if (options->ready)
      options->ready(options->context, server.http);
    code = serve(&server, farm, error);
    *counts = serve_jobs_counts(server.jobs);
  }
  serve_http_close(server.http);
  serve_jobs_free(server.jobs);
  const status closed = store_close(store, code ? NULL : error);
  return code ? code : closed;
}
