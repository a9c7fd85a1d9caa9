/* UM-Bridge protocol 1.0 (https://um-bridge-benchmarks.readthedocs.io): requests as JSON, answers as JSON. Pure: no
 * socket, no store.
 *
 * `config` may have: results (names; default: those of the server), statistic (one of mean, sd, se, hw95, or a list of
 * them; one output vector for each), replicates (how many seeds; default: the campaign's), replicate (one seed, whose
 * results are given as they are), level (of the server's knob, 0: the coarsest; default: the scene as it is). */
#ifndef CLAST_CAMPAIGN_SERVE_REQUEST_H
#define CLAST_CAMPAIGN_SERVE_REQUEST_H

#include "campaign/serve/model.h"

enum { SERVE_REQUEST_REPLICATES = 10000 }; /* most replicates of one request */

enum serve_statistic { SERVE_MEAN, SERVE_SD, SERVE_SE, SERVE_HW95, SERVE_STATISTICS };

struct serve_config {
  struct serve_result results[SERVE_MODEL_RESULTS];
  size_t result_count;
  enum serve_statistic statistics[SERVE_STATISTICS];
  size_t statistic_count;
  int64_t first, count; /* replicates */
  bool single;          /* a single replicate, without statistic */
  size_t level;         /* index of the level, or SERVE_MODEL_OWN_LEVEL */
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

/* The answer to an evaluation. values[k * count + r]: result k of replicate first + r; NaN: no usable run. */
struct serve_answer serve_request_answer(const struct serve_request *request, const double *values);

#endif
