/* `clast serve`: a campaign as a model that UQ packages evaluate over HTTP (UM-Bridge protocol 1.0,
 * https://um-bridge-benchmarks.readthedocs.io). Requests and the farm share one thread: http.c takes requests,
 * request.c reads them and writes answers, model.c makes scenes, and serve.c is the planner of the runs (scheduler.h).
 */
#pragma once

#include "campaign/scheduler/scheduler.h"

/* ---- the model: the varied inputs as numbers, results by name ---- */

enum { SERVE_MODEL_RESULTS = 64 };

struct serve_result {
  const struct field *row;
  bool of_outcome;
};

struct serve_model {
  const struct campaign *campaign; /* borrowed */
  size_t *inputs;                  /* owned: indices of the axes that are not linked */
  size_t input_count;
  struct serve_result results[SERVE_MODEL_RESULTS]; /* default results of a request */
  size_t result_count;
};

/* results: comma-separated names, NULL: the campaign's main quantity. STATUS_CONTENT:
 * nothing is varied, or an input is no number. STATUS_USAGE: an unknown result. Clear *model
 * also after an error. */
status serve_model_make(const struct campaign *campaign, const char *results, struct serve_model *model,
                        struct error *error);
void serve_model_clear(struct serve_model *model);

/* STATUS_USAGE: more than SERVE_MODEL_RESULTS results, or one that is not a number of a run. */
status serve_model_result(const struct serve_model *model, const char *name, struct serve_result *result,
                          struct error *error);

/* The scene of these inputs (input_count of them, SI). NULL with *error when it cannot be run. Owned by the
 * caller. */
struct scene *serve_model_scene(const struct serve_model *model, const double *inputs, struct error *error);

/* Names, units and ranges as JSON, for people and scripts; malloc'd. */
char *serve_model_describe(const struct serve_model *model);

/* ---- the server ---- */

struct serve_http;

struct serve_options {
  const char *store, *facts;
  const char *address;
  const char *token; /* a word that each request must have, as bearer token or as password; NULL: none */
  int port;
  double wait_s; /* an evaluation is answered with 503 after this time, s; its runs go on. 0: never */
};

/* Serves until a signal stops it (STATUS_OK) or the store fails. Tells on stderr where it listens, and at the end what
 * it did. The farm has been started; ranks other than 0 compute runs. */
status serve_run(const struct serve_model *model, struct farm *farm, const struct serve_options *options,
                 struct error *error);
int serve_http_port(const struct serve_http *http);
bool serve_http_open_to_all(const struct serve_http *http); /* other machines reach it, and there is no token */

/* ---- requests as JSON, answers as JSON: request.c. Pure: no socket, no store ----
 *
 * `config` of a request may have: results (names; default: those of the server), statistic (one of mean, sd, se, hw95,
 * or a list of them; one output vector for each), replicates (how many seeds; default: the campaign's), replicate (one
 * seed, whose results are given as they are). */

enum { SERVE_REQUEST_REPLICATES = 10000 }; /* most replicates of one request */

enum serve_statistic { SERVE_MEAN, SERVE_SD, SERVE_SE, SERVE_HW95, SERVE_STATISTICS };

struct serve_config {
  struct serve_result results[SERVE_MODEL_RESULTS];
  size_t result_count;
  enum serve_statistic statistics[SERVE_STATISTICS];
  size_t statistic_count;
  int64_t first, count; /* replicates */
  bool single;          /* a single replicate, without statistic */
};

struct serve_request {
  double *inputs; /* owned: as many as the model has */
  struct serve_config config;
};
void serve_request_clear(struct serve_request *request);

struct serve_answer { /* status of HTTP, 0: none yet; body malloc'd */
  unsigned http;
  char *body;
};
/* type: InvalidInput, InvalidOutput, UnsupportedFeature, ModelNotFound, or Unavailable, which is not part of the
 * protocol. */
struct serve_answer serve_request_error(unsigned http, const char *type, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Judges a request: `method` and `path` of HTTP, and the body. True: *request is an evaluation to be made. False:
 * *answer is the complete answer. */
bool serve_request_read(const struct serve_model *model, const char *method, const char *path, const char *body,
                        size_t size, struct serve_request *request, struct serve_answer *answer);

/* The answer to an evaluation. values[k * count + r]: result k of replicate first + r; NaN: no usable run.
 * doubts[k]: of the runs behind result k. */
struct serve_answer serve_request_answer(const struct serve_request *request, const double *values,
                                         const struct ask_doubts *doubts);

/* ---- evaluations: serve.c ---- */

struct serve;

/* Takes ownership of the request. Returns the answer if it is known already; else http is 0, and serve_http_answer gets
 * the answer with the ticket later. */
struct serve_answer serve_submit(struct serve *serve, struct serve_request *request, void *ticket);

/* ---- HTTP on one port, without a thread of its own: http.c ---- */

enum {
  SERVE_HTTP_BODY = 1 << 20,    /* most bytes of a request */
  SERVE_HTTP_CONNECTIONS = 512, /* most connections at a time */
  SERVE_HTTP_IDLE_S = 60,       /* a connection that sends nothing is closed */
};

/* Listens at the address of the options ("127.0.0.1", "::1", "0.0.0.0") and their port (0: any free one). Evaluations
 * go to `serve`. STATUS_USAGE: no such address; STATUS_IO: it is taken. */
status serve_http_open(const struct serve_model *model, struct serve *serve, const struct serve_options *options,
                       struct serve_http **out, struct error *error);
int serve_http_file(const struct serve_http *http); /* readable when there is something to do */
void serve_http_run(struct serve_http *http);       /* reads and writes without waiting */
/* Answers an evaluation that serve_submit did not answer; takes ownership of the answer's body. */
void serve_http_answer(void *ticket, struct serve_answer answer);
/* All evaluations must have been answered. Sends the remaining answers for at most a second. NULL is fine. */
void serve_http_close(struct serve_http *http);
