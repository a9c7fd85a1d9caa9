/* Evaluations in progress: each is a point and some of its replicates. Runs in the store are not computed again; a run
 * that two evaluations need is computed once; all computed runs are stored. Single-threaded: everything is called from
 * the farm's manager or between its calls. */
#ifndef CLAST_CAMPAIGN_SERVE_JOBS_H
#define CLAST_CAMPAIGN_SERVE_JOBS_H

#include "campaign/farm/farm.h"
#include "campaign/serve/request.h"
#include "db/store/store.h"

struct serve_jobs;

struct serve_jobs_options {
  const char *facts; /* JSON of provenance_json() */
  double wait_s;     /* an evaluation is answered with 503 after this time, s; its runs go on. 0: never */
  /* Answers an evaluation that serve_jobs_submit did not answer; takes ownership of the answer's body. */
  void (*answered)(void *context, void *ticket, struct serve_answer answer);
  void *context;
};

/* Opens session and campaign in the store (open for writing). Borrows store and model. */
status serve_jobs_open(const struct serve_model *model, struct store *store, const struct serve_jobs_options *options,
                       struct serve_jobs **out, struct error *error);
void serve_jobs_free(struct serve_jobs *jobs); /* NULL is fine */

/* Takes ownership of the request. Returns the answer if it is known already; else http is 0, and `answered` gets the
 * answer with the ticket later. */
struct serve_answer serve_jobs_submit(struct serve_jobs *jobs, struct serve_request *request, void *ticket);

/* Callbacks for struct farm_manager. */
bool serve_jobs_next(void *context, struct farm_task *task);
status serve_jobs_report(void *context, const struct farm_report *report, struct error *error);
/* Answers evaluations that waited too long, and commits. */
status serve_jobs_tick(struct serve_jobs *jobs, struct error *error);

/* Starts no more runs: refuses new evaluations, and with `all` answers the pending ones with 503. */
void serve_jobs_stop(struct serve_jobs *jobs, bool all);

/* Writes the points' exponents for the view estimates, and ends the session. */
status serve_jobs_end(struct serve_jobs *jobs, struct error *error);

struct serve_jobs_counts {
  int64_t evaluations, computed, found, failed; /* numbers of runs: computed now, found in the store, failed */
};
struct serve_jobs_counts serve_jobs_counts(const struct serve_jobs *jobs);

#endif
