/* Turns evaluations into runs, and runs into answers. */
#include "campaign/serve/jobs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/driver/driver.h"
#include "campaign/driver/pooling.h"
#include "campaign/driver/record.h"
#include "schemas/clock.h"

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct job { /* an evaluation under way */
  struct job *next;
  struct serve_request request;
  struct scene *scene;
  int64_t point_id;
  void *ticket;
  double started; /* s, clock_s() */
  bool answered;  /* it waited too long: only its runs are left */
  size_t missing; /* runs of it that are waiting or on slots */
};

struct wish { /* one job waits for one run */
  struct job *job;
  struct wish *next;
};

struct run { /* waiting or on a slot */
  uint8_t identity[16];
  uint64_t id; /* of the farm's task */
  struct record record;
  struct scene *scene;
  struct wish *wishes;
  struct run *next; /* in the queue */
  int lost;         /* attempts that the machine ended */
  UT_hash_handle hh, by_id;
};

struct serve_jobs {
  const struct serve_model *model;
  struct store *store;
  struct serve_jobs_options options;
  struct farm_options limits;
  int64_t session_id, campaign_id;
  const char **paths; /* of the inputs that vary, for the store */
  size_t path_count;
  struct job *first;
  struct run *runs, *runs_by_id; /* uthash */
  struct run *queue, *queue_end;
  uint64_t last_id;
  uint8_t *task; /* bytes of the last task given out */
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

static void free_job(struct job *job) {
  serve_request_clear(&job->request);
  scene_free(job->scene);
  free(job);
}

static void free_run(struct run *run) {
  for (struct wish *wish = run->wishes, *next; wish; wish = next) {
    next = wish->next;
    free(wish);
  }
  scene_free(run->scene);
  free(run);
}

void serve_jobs_free(struct serve_jobs *jobs) {
  if (!jobs)
    return;
  struct run *run, *next_run;
  HASH_CLEAR(by_id, jobs->runs_by_id);
  HASH_ITER(hh, jobs->runs, run, next_run) {
    HASH_DEL(jobs->runs, run);
    free_run(run);
  }
  for (struct job *job = jobs->first, *next; job; job = next) {
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
  const struct job *job;
  double *values; /* NaN: no usable run. May be NULL */
  bool *there;    /* may be NULL */
};

static void take_stored(void *context, const struct store_point_run *run) {
  const struct reading *reading = context;
  const struct campaign *campaign = reading->jobs->model->campaign;
  const struct serve_config *config = &reading->job->request.config;
  uint8_t identity[16];
  const int64_t r = campaign->independent ? run->replicate : (int64_t)(run->seed - (uint64_t)campaign->first_seed);
  if (r < config->first || r - config->first >= config->count ||
      campaign_seed(campaign, reading->job->scene, r) != run->seed)
    return;
  scene_identity(reading->job->scene, run->seed, identity);
  if (memcmp(identity, run->identity, sizeof identity) != 0)
    return;
  if (reading->values)
    reading->values[r - config->first] = outcome_is_usable(run->state) ? run->value : (double)NAN;
  if (reading->there)
    reading->there[r - config->first] = true;
}

static status read_store(struct serve_jobs *jobs, const struct job *job, const struct serve_result *result,
                         double *values, bool *there, struct error *error) {
  struct reading reading = {jobs, job, values, there};
  return store_point_runs(jobs->store, job->point_id, job->scene->kind, result->row, result->of_outcome, take_stored,
                          &reading, error);
}

static struct serve_answer answer_of(struct serve_jobs *jobs, const struct job *job) {
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

static struct run *find_run(struct serve_jobs *jobs, const uint8_t identity[16]) {
  struct run *run = NULL;
  HASH_FIND(hh, jobs->runs, identity, 16, run);
  return run;
}

static void push(struct serve_jobs *jobs, struct run *run) {
  run->next = NULL;
  if (jobs->queue)
    jobs->queue_end->next = run;
  else
    jobs->queue = run;
  jobs->queue_end = run;
}

static struct run *add_run(struct serve_jobs *jobs, const struct job *job, int64_t replicate, uint64_t seed,
                           const uint8_t identity[16], int failed) {
  struct run *run = calloc(1, sizeof *run);
  if (!run)
    return NULL;
  run->scene = scene_copy(job->scene);
  run->id = ++jobs->last_id;
  run->record = (struct record){.point_id = job->point_id,
                                .session_id = jobs->session_id,
                                .replicate = replicate,
                                .seed = seed,
                                .attempt = failed + 1};
  memcpy(run->identity, identity, 16);
  memcpy(run->record.identity, identity, 16);
  if (!run->scene) {
    free_run(run);
    return NULL;
  }
  HASH_ADD(hh, jobs->runs, identity, 16, run);
  HASH_ADD(by_id, jobs->runs_by_id, id, sizeof run->id, run);
  push(jobs, run);
  return run;
}

/* The job waits for this run, unless it has used up its attempts. False: no memory. */
static bool want(struct serve_jobs *jobs, struct job *job, int64_t replicate) {
  uint8_t identity[16];
  const uint64_t seed = campaign_seed(jobs->model->campaign, job->scene, replicate);
  scene_identity(job->scene, seed, identity);
  struct run *run = find_run(jobs, identity);
  if (!run) {
    const int failed = store_attempts(jobs->store, identity, jobs->limits.time_limit_s,
                                      (double)jobs->limits.memory_limit);
    if (failed >= jobs->model->campaign->attempts)
      return true;
    run = add_run(jobs, job, replicate, seed, identity, failed);
  }
  struct wish *wish = run ? malloc(sizeof *wish) : NULL;
  if (!wish)
    return false;
  *wish = (struct wish){job, run->wishes};
  run->wishes = wish;
  job->missing++;
  return true;
}

/* The point in the store, and a wish for each run that it lacks. */
static status open_job(struct serve_jobs *jobs, struct job *job, struct error *error) {
  const struct serve_config *config = &job->request.config;
  status code = store_add_point(jobs->store, jobs->campaign_id, job->scene, jobs->path_count, jobs->paths,
                                &job->point_id, error);
  if (code)
    return code;
  bool *there = calloc((size_t)config->count, sizeof *there);
  if (!there)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  code = read_store(jobs, job, &config->results[0], NULL, there, error);
  for (int64_t r = 0; !code && r < config->count; r++) {
    jobs->counts.found += there[r];
    if (!there[r] && !want(jobs, job, config->first + r))
      code = status_fail(error, STATUS_MEMORY, "out of memory");
  }
  free(there);
  return code;
}

struct serve_answer serve_jobs_submit(struct serve_jobs *jobs, struct serve_request *request, void *ticket) {
  struct error error = {0};
  struct job *job = calloc(1, sizeof *job);
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
  job->answered = answer.http != 0; /* runs may point at it: it goes when they are done */
  job->next = jobs->first;
  jobs->first = job;
  return answer;
}

/* ---- runs out and in ---- */

bool serve_jobs_next(void *context, struct farm_task *task) {
  struct serve_jobs *jobs = context;
  struct run *run = jobs->queue;
  if (!run || jobs->stopping)
    return false;
  const struct run_request request = {.kind = run->scene->kind, .inputs = run->scene->inputs, .seed = run->record.seed};
  free(jobs->task);
  jobs->task = run_encode_task(&request, &task->size);
  if (!jobs->task)
    return false; /* asked again at the next tick */
  jobs->queue = run->next;
  task->id = run->id;
  task->bytes = jobs->task;
  return true;
}

static void unlink_job(struct serve_jobs *jobs, struct job *job) {
  struct job **at = &jobs->first;
  while (*at != job)
    at = &(*at)->next;
  *at = job->next;
  free_job(job);
}

/* The run is over, well or not: the jobs that waited for it alone are answered. */
static void settle(struct serve_jobs *jobs, struct run *run) {
  HASH_DELETE(hh, jobs->runs, run);
  HASH_DELETE(by_id, jobs->runs_by_id, run);
  for (struct wish *wish = run->wishes; wish; wish = wish->next) {
    struct job *job = wish->job;
    if (--job->missing > 0)
      continue;
    if (!job->answered)
      jobs->options.answered(jobs->options.context, job->ticket, answer_of(jobs, job));
    unlink_job(jobs, job);
  }
  free_run(run);
}

static status take_result(struct serve_jobs *jobs, struct run *run, const struct farm_report *report,
                          struct error *error) {
  struct run_result result;
  status code = run_decode_result(run->scene->kind, report->bytes, report->size, &result, error);
  if (code)
    return code;
  code = record_run(jobs->store, &run->record, run->scene->kind, report, &result, error);
  run_result_clear(&result);
  jobs->counts.computed += code == STATUS_OK;
  return code;
}

status serve_jobs_report(void *context, const struct farm_report *report, struct error *error) {
  struct serve_jobs *jobs = context;
  struct run *run = NULL;
  HASH_FIND(by_id, jobs->runs_by_id, &report->id, sizeof report->id, run);
  if (!run)
    return status_fail(error, STATUS_INTERNAL, "the farm reported a task that it was not given");
  if (report->ending == FARM_DONE) {
    const status code = take_result(jobs, run, report, error);
    if (code == STATUS_OK)
      settle(jobs, run);
    return code;
  }
  const status code = record_attempt(jobs->store, &run->record, report, jobs->limits.time_limit_s,
                                     (double)jobs->limits.memory_limit, error);
  if (code)
    return code;
  const bool lost = report->ending == FARM_LOST;
  run->lost += lost;
  run->record.attempt += !lost;
  if (!jobs->stopping && (lost ? run->lost : run->record.attempt - 1) < jobs->model->campaign->attempts) {
    push(jobs, run);
    return STATUS_OK;
  }
  jobs->counts.failed++;
  settle(jobs, run);
  return STATUS_OK;
}

status serve_jobs_tick(struct serve_jobs *jobs, struct error *error) {
  const double now = clock_s();
  for (struct job *job = jobs->first; job && jobs->options.wait_s > 0; job = job->next) {
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
  for (struct job *job = jobs->first; all && job; job = job->next) {
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
