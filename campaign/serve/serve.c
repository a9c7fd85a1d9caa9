/* The planner of a server: turns evaluations into runs, and runs into answers. Runs in the store are not computed
 * again; a run that two evaluations need is computed once; all computed runs are stored. */
#include "campaign/serve/serve.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HASH_NONFATAL_OOM 1
#include <uthash.h>
#include <utlist.h>

#include "schemas/clock.h"
#include "schemas/memory.h"

struct job { /* an evaluation under way */
  struct job *next;
  struct serve_request request;
  struct scene *scene;
  int64_t point_id;
  void *ticket;
  double started; /* s, clock_s() */
  bool answered;  /* it waited too long and was answered; only its runs are left */
  size_t missing; /* runs of it that are waiting or on slots */
};

struct wish { /* one job waits for one run */
  struct job *job;
  struct wish *next;
};

struct wanted { /* a run that waits or is on a slot */
  struct scheduler_run run;
  uint8_t identity[16];
  struct scene *scene;
  struct wish *wishes;
  struct wanted *prev, *next; /* in the queue */
  UT_hash_handle hh;          /* by identity */
};

struct serve {
  const struct serve_model *model;
  const struct serve_options *options;
  struct serve_http *http;
  struct scheduler *scheduler;
  int64_t session_id, campaign_id;
  const char **paths; /* paths of the varied inputs, for the store */
  struct job *jobs;
  struct wanted *runs;                          /* uthash */
  struct wanted *queue;                         /* those on no slot */
  int64_t evaluations, computed, found, failed; /* numbers of runs: computed now, found in the store, failed */
  bool stopping;
};

static void free_job(struct job *job) {
  serve_request_clear(&job->request);
  scene_free(job->scene);
  free(job);
}

static void free_wanted(struct wanted *wanted) {
  struct wish *wish, *next;
  LL_FOREACH_SAFE(wanted->wishes, wish, next) {
    free(wish);
  }
  scene_free(wanted->scene);
  free(wanted);
}

static status begin(void *context, struct scheduler *scheduler, struct error *error) {
  struct serve *serve = context;
  const struct campaign *campaign = serve->model->campaign;
  serve->scheduler = scheduler;
  serve->paths = memory_small(campaign->axis_count, sizeof *serve->paths);
  for (size_t i = 0; i < campaign->axis_count; i++)
    serve->paths[i] = campaign->axes[i].row->path;
  TRY(scheduler_announce(scheduler, campaign, "{\"served\": true}", &serve->session_id, &serve->campaign_id, error));
  TRY(store_flush(scheduler->store, error));
  const int slots = scheduler->options.slots;
  fprintf(stderr, "clast: serving at port %d with %d slot%s, store %s; Ctrl-C ends\n", serve_http_port(serve->http),
          slots, slots == 1 ? "" : "s", serve->options->store);
  if (serve_http_open_to_all(serve->http))
    fputs("clast: warning: other machines can reach this port, and nobody is asked for a password\n", stderr);
  return STATUS_OK;
}

/* ---- what the store has of a job ---- */

/* `values`: NaN where there is no usable run, or its value has no meaning. Both arrays may be NULL. The usable runs are
 * added to *doubts. */
static status read_store(struct serve *serve, const struct job *job, const struct serve_result *result, double *values,
                         bool *there, struct ask_doubts *doubts, struct error *error) {
  const struct serve_config *config = &job->request.config;
  ANSWER answer = ask_run_of_point(serve->scheduler->store, job->point_id, job->scene->kind, result->row,
                                   result->of_outcome, error);
  for (struct ask_run_of_point run; ask_run_of_point_next(&answer, &run);) {
    const int64_t r = scheduler_replicate(serve->model->campaign, job->scene, &run) - config->first;
    if (r < 0 || r >= config->count)
      continue;
    if (values)
      values[r] = outcome_is_usable(run.state) && !run.withheld ? run.value : (double)NAN;
    if (doubts && outcome_is_usable(run.state)) {
      (void)ask_doubts_run(doubts, job->scene->kind->name, run.warnings, result->row->path, 1);
      ask_doubts_absent(doubts, result->row->path, isnan(run.value) && !run.withheld, 1);
    }
    if (there)
      there[r] = true;
  }
  return answer_end(&answer);
}

static struct serve_answer answer_of(struct serve *serve, const struct job *job) {
  const struct serve_config *config = &job->request.config;
  const size_t count = (size_t)config->count, size = config->result_count * count;
  struct error error = {0};
  OWNED double *values = NULL;
  OWNED struct ask_doubts *doubts = memory_small(config->result_count, sizeof *doubts);
  status code = memory_array(&values, size, sizeof *values, "an answer", &error);
  for (size_t i = 0; !code && i < size; i++)
    values[i] = NAN;
  for (size_t k = 0; !code && k < config->result_count; k++)
    code = read_store(serve, job, &config->results[k], values + k * count, NULL, &doubts[k], &error);
  return code ? serve_request_error(503, "Unavailable", "%s", error.message)
              : serve_request_answer(&job->request, values, doubts);
}

/* ---- evaluations in ---- */

/* The job waits for this run, unless the run has used up its attempts. */
static void want(struct serve *serve, struct job *job, int64_t replicate) {
  struct wanted *wanted = NULL;
  uint8_t identity[16];
  const uint64_t seed = campaign_seed(serve->model->campaign, job->scene, replicate);
  scene_identity(job->scene, seed, identity);
  HASH_FIND(hh, serve->runs, identity, sizeof identity, wanted);
  if (!wanted && scheduler_attempts(serve->scheduler, identity) >= serve->model->campaign->attempts)
    return;
  if (!wanted) {
    wanted = memory_small(1, sizeof *wanted);
    memcpy(wanted->identity, identity, sizeof identity);
    wanted->scene = scene_copy(job->scene);
    wanted->run = (struct scheduler_run){.scene = wanted->scene,
                                         .point_id = job->point_id,
                                         .session_id = serve->session_id,
                                         .replicate = replicate,
                                         .seed = seed,
                                         .place = wanted};
    HASH_ADD(hh, serve->runs, identity, sizeof identity, wanted);
    DL_APPEND(serve->queue, wanted);
  }
  struct wish *wish = memory_small(1, sizeof *wish);
  wish->job = job;
  LL_PREPEND(wanted->wishes, wish);
  job->missing++;
}

/* Finds or adds the point in the store, and requests each missing run. */
static status open_job(struct serve *serve, struct job *job, struct error *error) {
  const struct serve_config *config = &job->request.config;
  TRY(store_add_point(serve->scheduler->store, serve->campaign_id, job->scene, serve->model->campaign->axis_count,
                      serve->paths, &job->point_id, error));
  OWNED bool *there = memory_small((size_t)config->count, sizeof *there);
  TRY(read_store(serve, job, &config->results[0], NULL, there, NULL, error));
  for (int64_t r = 0; r < config->count; r++) {
    serve->found += there[r];
    if (!there[r])
      want(serve, job, config->first + r);
  }
  return STATUS_OK;
}

struct serve_answer serve_submit(struct serve *serve, struct serve_request *request, void *ticket) {
  if (serve->stopping) {
    serve_request_clear(request);
    return serve_request_error(503, "Unavailable", "the server is stopping");
  }
  struct error error = {0};
  struct job *job = memory_small(1, sizeof *job);
  struct serve_answer answer = {0};
  serve->evaluations++;
  *job = (struct job){.request = *request, .ticket = ticket, .started = clock_s()};
  *request = (struct serve_request){0};
  job->scene = serve_model_scene(serve->model, job->request.inputs, &error);
  if (!job->scene)
    answer = error.status == STATUS_MEMORY ? serve_request_error(503, "Unavailable", "%s", error.message)
                                           : serve_request_error(400, "InvalidInput", "%s", error.message);
  else if (open_job(serve, job, &error) != STATUS_OK)
    answer = serve_request_error(503, "Unavailable", "%s", error.message);
  else if (job->missing == 0)
    answer = answer_of(serve, job);
  if (job->missing == 0) {
    free_job(job);
    return answer;
  }
  job->answered = answer.http != 0; /* runs may point to the job: it is freed when they are done */
  LL_PREPEND(serve->jobs, job);
  return answer;
}

/* ---- runs out and in ---- */

static status next(void *context, struct scheduler_run *run, struct error *error) {
  struct serve *serve = context;
  (void)error;
  if (!serve->queue || serve->stopping)
    return STATUS_OK;
  *run = serve->queue->run;
  DL_DELETE(serve->queue, serve->queue);
  return STATUS_OK;
}

/* Answers the jobs that waited only for this run, which has ended. */
static void settle(struct serve *serve, struct wanted *wanted) {
  for (struct wish *wish = wanted->wishes; wish; wish = wish->next) {
    struct job *job = wish->job;
    if (--job->missing > 0)
      continue;
    if (!job->answered)
      serve_http_answer(job->ticket, answer_of(serve, job));
    LL_DELETE(serve->jobs, job);
    free_job(job);
  }
  HASH_DELETE(hh, serve->runs, wanted);
  free_wanted(wanted);
}

static status ended(void *context, const struct scheduler_run *run, const struct scheduler_end *end,
                    struct error *error) {
  struct serve *serve = context;
  struct wanted *wanted = run->place;
  (void)error;
  if (end->ending == SCHEDULER_AGAIN && !serve->stopping) {
    wanted->run.lost = run->lost;
    DL_APPEND(serve->queue, wanted);
  } else {
    serve->computed += end->ending == SCHEDULER_DONE;
    serve->failed += end->ending != SCHEDULER_DONE;
    settle(serve, wanted);
  }
  serve_http_run(serve->http);
  return STATUS_OK;
}

/* Answers evaluations that waited too long. */
static void tick(void *context, int running, bool last) {
  struct serve *serve = context;
  const double now = clock_s(), wait_s = serve->options->wait_s;
  (void)running;
  if (last)
    return;
  serve_http_run(serve->http);
  for (struct job *job = serve->jobs; job && wait_s > 0; job = job->next) {
    if (job->answered || now - job->started < wait_s)
      continue;
    job->answered = true;
    serve_http_answer(job->ticket, serve_request_error(503, "Unavailable",
                                                       "%zu of the runs are not done after %g s; they go on, and the "
                                                       "same request finds them",
                                                       job->missing, wait_s));
  }
}

/* ---- the end ---- */

static void stopping(void *context) {
  ((struct serve *)context)->stopping = true;
}

/* Answers what is pending, writes the points' exponents for the view estimates, and ends the session. A signal is the
 * normal end of a server. The farm also stops when no slot is left, which is none. */
static status end(void *context, status code, struct error *error) {
  struct serve *serve = context;
  struct store *store = serve->scheduler->store;
  const bool good = code == STATUS_OK || (code == STATUS_STOPPED && serve->stopping);
  serve->stopping = true;
  for (struct job *job = serve->jobs; job; job = job->next) {
    if (!job->answered)
      serve_http_answer(job->ticket, serve_request_error(503, "Unavailable", "the server was stopped"));
    job->answered = true;
  }
  const status pooled = pooling_store(store, serve->campaign_id, good ? error : NULL);
  const char *outcome = good && !pooled ? "finished" : code == STATUS_STOPPED && !pooled ? "stopped" : "failed";
  const status ended = store_end_session(store, serve->session_id, outcome, good && !pooled ? error : NULL);
  if (!good)
    return code;
  return pooled ? pooled : ended;
}

status serve_run(const struct serve_model *model, struct farm *farm, const struct serve_options *options,
                 struct error *error) {
  struct serve serve = {.model = model, .options = options};
  status code = STATUS_OK;
  if (farm_rank(farm) == 0)
    code = serve_http_open(model, &serve, options, &serve.http, error);
  if (code) {
    scheduler_release_ranks(farm);
  } else {
    const struct scheduler_planner planner = {.context = &serve,
                                              .limits = model->campaign,
                                              .begin = begin,
                                              .next = next,
                                              .ended = ended,
                                              .tick = tick,
                                              .stopping = stopping,
                                              .end = end,
                                              .orders = serve.http ? serve_http_file(serve.http) : 0};
    const struct scheduler_options own = {.store_path = options->store, .facts = options->facts};
    code = scheduler_compute(&planner, farm, &own, error);
  }
  if (!code && farm_rank(farm) == 0)
    fprintf(stderr,
            "clast: %" PRId64 " evaluations: %" PRId64 " runs computed, %" PRId64 " found in the store, %" PRId64
            " given up\n",
            serve.evaluations, serve.computed, serve.found, serve.failed);
  serve_http_close(serve.http);
  struct wanted *wanted, *following;
  HASH_ITER(hh, serve.runs, wanted, following) {
    HASH_DELETE(hh, serve.runs, wanted);
    free_wanted(wanted);
  }
  struct job *job, *after;
  LL_FOREACH_SAFE(serve.jobs, job, after) {
    free_job(job);
  }
  free(serve.paths);
  return code;
}
