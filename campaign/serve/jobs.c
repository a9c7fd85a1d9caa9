/* Turns evaluations into runs, and runs into answers. */
#include "campaign/serve/jobs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/driver/driver.h"
#include "campaign/driver/pooling.h"
#include "campaign/driver/record.h"
#include "campaign/serve/runs.h"
#include "schemas/clock.h"

struct serve_job { /* an evaluation under way */
  struct serve_job *next;
  struct serve_request request;
  struct scene *scene;
  int64_t point_id;
  void *ticket;
  double started; /* s, clock_s() */
  bool answered;  /* it waited too long and was answered; only its runs are left */
  size_t missing; /* runs of it that are waiting or on slots */
};

struct serve_jobs {
  const struct serve_model *model;
  struct store *store;
  struct serve_jobs_options options;
  struct farm_options limits;
  int64_t session_id, campaign_id;
  const char **paths; /* paths of the varied inputs, for the store */
  size_t path_count;
  struct serve_job *first;
  struct serve_runs runs; /* runs that the jobs wait for */
  uint8_t *task;          /* bytes of the last task given out */
  struct serve_jobs_counts counts;
  bool stopping;
};

/* ---- opening ---- */

static status take_paths(struct serve_jobs *jobs, struct error *error) {
  const struct campaign *campaign = jobs->model->campaign;
  const struct ladder *ladder = &jobs->model->ladder;
  jobs->paths = calloc(campaign->axis_count + KNOB_INPUTS, sizeof *jobs->paths);
  if (!jobs->paths)
    return status_fail(error, STATUS_MEMORY, "no memory for the server");
  for (size_t i = 0; i < campaign->axis_count; i++)
    jobs->paths[jobs->path_count++] = campaign->axes[i].row->path;
  for (size_t i = 0; ladder->count && i < KNOB_INPUTS && ladder->knob->inputs[i].path; i++)
    jobs->paths[jobs->path_count++] = ladder->knob->inputs[i].path;
  return STATUS_OK;
}

status serve_jobs_open(const struct serve_model *model, struct store *store, const struct serve_jobs_options *options,
                       struct serve_jobs **out, struct error *error) {
  const struct campaign *campaign = model->campaign;
  struct serve_jobs *jobs = *out = calloc(1, sizeof *jobs);
  if (!jobs)
    return status_fail(error, STATUS_MEMORY, "no memory for the server");
  jobs->model = model;
  jobs->store = store;
  jobs->options = *options;
  driver_farm_options(campaign, &jobs->limits);
  status code = take_paths(jobs, error);
  if (!code)
    code = store_begin_session(store, options->facts, &jobs->session_id, error);
  if (!code)
    code = store_add_campaign(store, campaign->name, campaign->text, "{\"served\": true}", &jobs->campaign_id, error);
  for (size_t i = 0; !code && i < campaign->axis_count; i++)
    code = store_add_axis(store, campaign->axes[i].row, campaign->axes[i].unit, error);
  if (!code)
    code = store_flush(store, error);
  if (code) {
    serve_jobs_free(jobs);
    *out = NULL;
  }
  return code;
}

static void free_job(struct serve_job *job) {
  serve_request_clear(&job->request);
  scene_free(job->scene);
  free(job);
}

void serve_jobs_free(struct serve_jobs *jobs) {
  if (!jobs)
    return;
  serve_runs_clear(&jobs->runs);
  for (struct serve_job *job = jobs->first, *next; job; job = next) {
    next = job->next;
    free_job(job);
  }
  free(jobs->paths);
  free(jobs->task);
  free(jobs);
}

struct serve_jobs_counts serve_jobs_counts(const struct serve_jobs *jobs) {
  return jobs->counts;
}

/* ---- what the store has of a job ---- */

struct reading {
  const struct serve_jobs *jobs;
  const struct serve_job *job;
  double *values; /* NaN: no usable run. May be NULL */
  bool *there;    /* may be NULL */
};

static void take_stored(void *context, const struct store_point_run *run) {
  const struct reading *reading = context;
  const struct serve_config *config = &reading->job->request.config;
  const int64_t r = record_replicate(reading->jobs->model->campaign, reading->job->scene, run);
  if (r < config->first || r - config->first >= config->count)
    return;
  if (reading->values)
    reading->values[r - config->first] = outcome_is_usable(run->state) ? run->value : (double)NAN;
  if (reading->there)
    reading->there[r - config->first] = true;
}

static status read_store(struct serve_jobs *jobs, const struct serve_job *job, const struct serve_result *result,
                         double *values, bool *there, struct error *error) {
  struct reading reading = {jobs, job, values, there};
  return store_point_runs(jobs->store, job->point_id, job->scene->kind, result->row, result->of_outcome, take_stored,
                          &reading, error);
}

static struct serve_answer answer_of(struct serve_jobs *jobs, const struct serve_job *job) {
  const struct serve_config *config = &job->request.config;
  const size_t count = (size_t)config->count, size = config->result_count * count;
  struct error error = {0};
  double *values = malloc(size * sizeof *values);
  status code = values ? STATUS_OK : status_fail(&error, STATUS_MEMORY, "out of memory");
  for (size_t i = 0; values && i < size; i++)
    values[i] = NAN;
  for (size_t k = 0; !code && k < config->result_count; k++)
    code = read_store(jobs, job, &config->results[k], values + k * count, NULL, &error);
  const struct serve_answer answer = code ? serve_request_error(503, "Unavailable", "%s", error.message)
                                          : serve_request_answer(&job->request, values);
  free(values);
  return answer;
}

/* ---- evaluations in ---- */

/* The run of a replicate, waiting or on a slot. NULL with *code STATUS_OK: the run has used up its attempts. */
static struct serve_run *find_or_add_run(struct serve_jobs *jobs, const struct serve_job *job, int64_t replicate,
                                         status *code, struct error *error) {
  struct record record = {.point_id = job->point_id, .session_id = jobs->session_id, .replicate = replicate};
  record.seed = campaign_seed(jobs->model->campaign, job->scene, replicate);
  scene_identity(job->scene, record.seed, record.identity);
  struct serve_run *run = serve_runs_find(&jobs->runs, record.identity);
  if (run)
    return run;
  const int failed = store_attempts(jobs->store, record.identity, jobs->limits.time_limit_s,
                                    (double)jobs->limits.memory_limit);
  if (failed >= jobs->model->campaign->attempts)
    return NULL;
  record.attempt = failed + 1;
  run = serve_runs_add(&jobs->runs, &record, job->scene);
  if (!run)
    *code = status_fail(error, STATUS_MEMORY, "out of memory");
  return run;
}

/* The job waits for this run, unless it has used up its attempts. */
static status want(struct serve_jobs *jobs, struct serve_job *job, int64_t replicate, struct error *error) {
  status code = STATUS_OK;
  struct serve_run *run = find_or_add_run(jobs, job, replicate, &code, error);
  if (!run)
    return code;
  if (!serve_runs_wish(run, job))
    return status_fail(error, STATUS_MEMORY, "out of memory");
  job->missing++;
  return STATUS_OK;
}

/* Finds or adds the point in the store, and requests each missing run. */
static status open_job(struct serve_jobs *jobs, struct serve_job *job, struct error *error) {
  const struct serve_config *config = &job->request.config;
  TRY(store_add_point(jobs->store, jobs->campaign_id, job->scene, jobs->path_count, jobs->paths, &job->point_id,
                      error));
  bool *there = calloc((size_t)config->count, sizeof *there);
  if (!there)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  status code = read_store(jobs, job, &config->results[0], NULL, there, error);
  for (int64_t r = 0; !code && r < config->count; r++) {
    jobs->counts.found += there[r];
    if (!there[r])
      code = want(jobs, job, config->first + r, error);
  }
  free(there);
  return code;
}

struct serve_answer serve_jobs_submit(struct serve_jobs *jobs, struct serve_request *request, void *ticket) {
  struct error error = {0};
  struct serve_job *job = calloc(1, sizeof *job);
  struct serve_answer answer = {0};
  if (!job || jobs->stopping) {
    serve_request_clear(request);
    free(job);
    return serve_request_error(503, "Unavailable", "%s", jobs->stopping ? "the server is stopping" : "out of memory");
  }
  jobs->counts.evaluations++;
  job->request = *request;
  *request = (struct serve_request){0};
  job->ticket = ticket;
  job->started = clock_s();
  job->scene = serve_model_scene(jobs->model, job->request.inputs, job->request.config.level, &error);
  if (!job->scene) {
    answer = serve_request_error(error.status == STATUS_MEMORY ? 503 : 400,
                                 error.status == STATUS_MEMORY ? "Unavailable" : "InvalidInput", "%s", error.message);
    free_job(job);
    return answer;
  }
  if (open_job(jobs, job, &error) != STATUS_OK)
    answer = serve_request_error(503, "Unavailable", "%s", error.message);
  else if (job->missing == 0)
    answer = answer_of(jobs, job);
  if (answer.http && job->missing == 0) {
    free_job(job);
    return answer;
  }
  job->answered = answer.http != 0; /* runs may point to the job: it is freed when they are done */
  job->next = jobs->first;
  jobs->first = job;
  return answer;
}

/* ---- runs out and in ---- */

bool serve_jobs_next(void *context, struct farm_task *task) {
  struct serve_jobs *jobs = context;
  const struct serve_run *run = jobs->runs.queue;
  if (!run || jobs->stopping)
    return false;
  const struct run_request request = {.kind = run->scene->kind, .inputs = run->scene->inputs, .seed = run->record.seed};
  free(jobs->task);
  jobs->task = run_encode_task(&request, &task->size);
  if (!jobs->task)
    return false; /* the farm asks again at the next tick */
  task->id = run->id;
  serve_runs_pop(&jobs->runs);
  task->bytes = jobs->task;
  return true;
}

static void unlink_job(struct serve_jobs *jobs, struct serve_job *job) {
  struct serve_job **at = &jobs->first;
  while (*at != job)
    at = &(*at)->next;
  *at = job->next;
  free_job(job);
}

/* Handles a run that has ended or failed: answers the jobs that waited only for this run. */
static void settle(struct serve_jobs *jobs, struct serve_run *run) {
  for (struct serve_wish *wish = run->wishes; wish; wish = wish->next) {
    struct serve_job *job = wish->job;
    if (--job->missing > 0)
      continue;
    if (!job->answered)
      jobs->options.answered(jobs->options.context, job->ticket, answer_of(jobs, job));
    unlink_job(jobs, job);
  }
  serve_runs_remove(&jobs->runs, run);
}

static status take_result(struct serve_jobs *jobs, struct serve_run *run, const struct farm_report *report,
                          struct error *error) {
  struct run_result result;
  TRY(run_decode_result(run->scene->kind, report->bytes, report->size, &result, error));
  status code = record_run(jobs->store, &run->record, run->scene->kind, report, &result, error);
  run_result_clear(&result);
  jobs->counts.computed += code == STATUS_OK;
  return code;
}

status serve_jobs_report(void *context, const struct farm_report *report, struct error *error) {
  struct serve_jobs *jobs = context;
  struct serve_run *run = serve_runs_with_id(&jobs->runs, report->id);
  if (!run)
    return status_fail(error, STATUS_INTERNAL, "the farm reported a task that it was not given");
  if (report->ending == FARM_DONE) {
    const status code = take_result(jobs, run, report, error);
    if (code == STATUS_OK)
      settle(jobs, run);
    return code;
  }
  TRY(record_attempt(jobs->store, &run->record, report, jobs->limits.time_limit_s, (double)jobs->limits.memory_limit,
                     error));
  const bool lost = report->ending == FARM_LOST;
  run->lost += lost;
  run->record.attempt += !lost;
  if (!jobs->stopping && (lost ? run->lost : run->record.attempt - 1) < jobs->model->campaign->attempts) {
    serve_runs_push(&jobs->runs, run);
    return STATUS_OK;
  }
  jobs->counts.failed++;
  settle(jobs, run);
  return STATUS_OK;
}

status serve_jobs_tick(struct serve_jobs *jobs, struct error *error) {
  const double now = clock_s();
  for (struct serve_job *job = jobs->first; job && jobs->options.wait_s > 0; job = job->next) {
    if (job->answered || now - job->started < jobs->options.wait_s)
      continue;
    job->answered = true;
    jobs->options.answered(jobs->options.context, job->ticket,
                           serve_request_error(503, "Unavailable",
                                               "%zu of the runs are not done after %g s; they go on, and the same "
                                               "request finds them",
                                               job->missing, jobs->options.wait_s));
  }
  return store_tick(jobs->store, error);
}

void serve_jobs_stop(struct serve_jobs *jobs, bool all) {
  jobs->stopping = true;
  for (struct serve_job *job = jobs->first; all && job; job = job->next) {
    if (!job->answered)
      jobs->options.answered(jobs->options.context, job->ticket,
                             serve_request_error(503, "Unavailable", "the server was stopped"));
    job->answered = true;
  }
}

status serve_jobs_end(struct serve_jobs *jobs, struct error *error) {
  status code = store_flush(jobs->store, error);
  if (!code)
    code = pooling_store(jobs->store, jobs->campaign_id, error);
  const status ended = store_end_session(jobs->store, jobs->session_id, code ? "failed" : "finished",
                                         code ? NULL : error);
  return code ? code : ended;
}
