/* The slots of one rank as its main process sees them: jobs in, results out, nothing blocks.
 *
 * Jobs wait in the pool's queue; each slot holds the one it computes and one more sent ahead (more if they are very
 * short), so that it need not wait for the main process; what was sent ahead is taken back when another slot is idle.
 */
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
void farm_pool_submit(struct farm_pool *pool, struct farm_job *job); /* owns the job until it ended */
/* Takes back up to `most` jobs that have not begun, from the end of the queue, then from slots. */
void farm_pool_withdraw(struct farm_pool *pool, size_t most, struct farm_job_queue *into);
/* Sends waiting jobs to slots. To be called after submitting and after farm_pool_listen. */
void farm_pool_dispatch(struct farm_pool *pool);
/* Sleeps until a slot or `signals` (a file to watch, or -1) has something to read, or the timeout is over, and takes in
 * what the slots have written. True when anything was there. */
bool farm_pool_listen(struct farm_pool *pool, int signals, int64_t timeout_ns);
int farm_pool_slots(const struct farm_pool *pool); /* that work or will; 0: the pool is lost */
/* How many jobs it takes in all, at the recent length of tasks. */
size_t farm_pool_capacity(const struct farm_pool *pool);
/* Ends slots and server at once and frees everything, jobs included. NULL is fine. */
void farm_pool_end(struct farm_pool *pool);

#endif
