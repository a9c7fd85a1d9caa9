/* Evaluations under way: each is a point and some of its replicates. What the store has is not computed again; what two
 * evaluations need is computed once; what is computed is stored. Single-threaded: everything is called from the farm's
 * manager or between its calls. */
#ifndef CLAST_CAMPAIGN_SERVE_JOBS_H
#define CLAST_CAMPAIGN_SERVE_JOBS_H

#include "campaign/farm/farm.h"
#include "campaign/serve/request.h"
#include "db/store/store.h"

struct serve_jobs;

struct serve_jobs_options {
  const char *facts; /* JSON of provenance_json() */
  double wait_s;     /* an evaluation is answered with 503 after so long; its runs go on. 0: never */
  /* An evaluation that was not answered at once is answered now; takes the answer's body. */
  void (*answered)(void *context, void *ticket, struct serve_answer answer);
  void *context;
};

/* Opens session and campaign in the store (a writer, borrowed as the model is). */
status serve_jobs_open(const struct serve_model *model, struct store *store, const struct serve_jobs_options *options,
                       struct serve_jobs **out, struct error *error);
void serve_jobs_free(struct serve_jobs *jobs); /* NULL is fine */

/* Takes the request. The answer if it can be given at once, else http 0: `answered` gets it with the ticket later. */
struct serve_answer serve_jobs_submit(struct serve_jobs *jobs, struct serve_request *request, void *ticket);

/* The farm's calls: struct farm_manager. */
bool serve_jobs_next(void *context, struct farm_task *task);
status serve_jobs_report(void *context, const struct farm_report *report, struct error *error);
/* Answers those that wait too long, and commits. */
status serve_jobs_tick(struct serve_jobs *jobs, struct error *error);

/* No more runs: new evaluations are refused, and with `all` those under way are answered with 503. */
void serve_jobs_stop(struct serve_jobs *jobs, bool all);

/* Exponents of the points for the view estimates, and the end of the session. */
status serve_jobs_end(struct serve_jobs *jobs, struct error *error);

struct serve_jobs_counts {
  int64_t evaluations, computed, found, failed; /* runs: computed now, found in the store, given up */
};
struct serve_jobs_counts serve_jobs_counts(const struct serve_jobs *jobs);

#endif
