/* The slots of one rank, for its main process: takes jobs, gives results, never blocks.
 *
 * Jobs wait in the pool's queue; each slot holds its running job and one waiting job (more if they are very short), so
 * that it need not wait for the main process. Waiting jobs are taken back when another slot is idle. */
#ifndef CLAST_CAMPAIGN_FARM_POOL_H
#define CLAST_CAMPAIGN_FARM_POOL_H

#include "campaign/farm/farm.h"
#include "campaign/farm/frame.h"
#include "campaign/farm/job.h"

struct farm_pool;

/* A job has ended. Called from farm_pool_listen only. The receiver owns the job and frees it; all else is borrowed. */
struct farm_pool_sink {
  void *context;
  void (*ended)(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                const char *message, size_t message_size);
};

status farm_pool_start(const struct farm_options *options, farm_work work, struct farm_pool **out, struct error *error);
void farm_pool_sink_to(struct farm_pool *pool, struct farm_pool_sink sink);
void farm_pool_submit(struct farm_pool *pool, struct farm_job *job); /* owns the job until it has ended */
/* Takes back up to `most` jobs that have not begun, from the end of the queue, then from slots. */
void farm_pool_withdraw(struct farm_pool *pool, size_t most, struct farm_job_queue *into);
/* Sends waiting jobs to slots. To be called after submitting and after farm_pool_listen. */
void farm_pool_dispatch(struct farm_pool *pool);
/* Sleeps until a slot or `signals` (a file descriptor, or -1) is readable or the timeout is over, and reads what the
 * slots have written. True when something was readable. */
bool farm_pool_listen(struct farm_pool *pool, int signals, int64_t timeout_ns);
int farm_pool_slots(const struct farm_pool *pool); /* slots that work or are being replaced; 0: the pool is lost */
/* Most jobs that the pool should hold, from the recent duration of tasks. */
size_t farm_pool_capacity(const struct farm_pool *pool);
/* Ends slots and server immediately and frees everything, jobs included. NULL is fine. */
void farm_pool_end(struct farm_pool *pool);

#endif
