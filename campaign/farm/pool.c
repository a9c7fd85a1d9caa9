/* Sends jobs to slots, and takes back jobs that they have not begun. pool_listen.c reads the slots' messages. */
#include "campaign/farm/pool_private.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "schemas/clock.h"

/* Several tasks shorter than this are sent ahead to a slot, so that it never waits while the manager handles a batch.
 */
#define AHEAD_NS (500 * CLOCK_MS / 1000)

status farm_pool_start(const struct farm_options *options, farm_work work, struct farm_pool **out,
                       struct error *error) {
  const size_t slots = (size_t)options->slots;
  status result = STATUS_MEMORY;
  struct farm_pool *pool = calloc(1, sizeof *pool);
  if (!pool)
    return status_fail(error, STATUS_MEMORY, "no memory for the farm");
  *pool = (struct farm_pool){.setup = {.options = *options, .work = work}, .control = -1, .mean_wall_s = 1};
  pool->looked_ns = clock_ns();
  pool->slots = calloc(slots, sizeof *pool->slots);
  pool->fds = calloc(slots + 2, sizeof *pool->fds);
  pool->records_size = slots * sizeof *pool->setup.records;
  pool->setup.records = mmap(NULL, pool->records_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (!pool->slots || !pool->fds || pool->setup.records == MAP_FAILED) {
    if (pool->setup.records == MAP_FAILED)
      pool->setup.records = NULL;
    status_fail(error, STATUS_MEMORY, "no memory for %zu slots", slots);
    goto cleanup;
  }
  for (size_t i = 0; i < slots; i++)
    pool->slots[i].channel = -1;
  result = farm_server_start(&pool->setup, &pool->server, &pool->control, error);
  if (result != STATUS_OK)
    goto cleanup;
  *out = pool;
  return STATUS_OK;
cleanup:
  farm_pool_end(pool);
  return result;
}

void farm_pool_sink_to(struct farm_pool *pool, struct farm_pool_sink sink) {
  pool->sink = sink;
}

void farm_pool_submit(struct farm_pool *pool, struct farm_job *job) {
  farm_job_push(&pool->queue, job);
  pool->count++;
}

int farm_pool_slots(const struct farm_pool *pool) {
  int alive = 0;
  if (pool->control < 0)
    return 0;
  for (int i = 0; i < pool->setup.options.slots; i++)
    alive += !pool->slots[i].given_up;
  return alive;
}

/* Jobs per slot: the one that it computes and those sent ahead. */
static size_t depth(const struct farm_pool *pool) {
  const double ahead = 1e-9 * (double)AHEAD_NS / (pool->mean_wall_s + 1e-9);
  if (ahead < 1)
    return 2;
  return ahead > FARM_SLOT_TICKETS - 1 ? FARM_SLOT_TICKETS : 1 + (size_t)ahead;
}

size_t farm_pool_capacity(const struct farm_pool *pool) {
  return (size_t)farm_pool_slots(pool) * depth(pool);
}

void farm_pool_flush(struct slot *slot) {
  while (slot->channel >= 0 && slot->out.begin < slot->out.end) {
    const ssize_t n = send(slot->channel, slot->out.data + slot->out.begin, slot->out.end - slot->out.begin,
                           MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return; /* either the channel is full, and poll reports when it has space again; or the slot has ended, and the
                 server reports that */
    slot->out.begin += (size_t)n;
  }
  if (slot->out.begin == slot->out.end)
    farm_frame_trim(&slot->out);
}

static bool give(struct farm_pool *pool, int index, struct farm_job *job) {
  struct farm_slot_record *const record = &pool->setup.records[index];
  struct slot *const slot = &pool->slots[index];
  for (uint16_t ticket = 0; ticket < FARM_SLOT_TICKETS; ticket++) {
    if (atomic_load(&record->ticket[ticket]) != 0)
      continue;
    if (!farm_frame_append(&slot->out, FARM_FRAME_TASK, ticket, job->handle, 1, &(struct iovec){job->bytes, job->size}))
      return false;
    atomic_store(&record->ticket[ticket], job->handle); /* before the flush that shows it to the slot */
    job->ticket = ticket;
    farm_job_push(&slot->jobs, job);
    return true;
  }
  return false;
}

/* The last job of this slot that it has not begun, or NULL. */
static struct farm_job *take_back(struct farm_pool *pool, int index) {
  struct farm_slot_record *const record = &pool->setup.records[index];
  struct slot *const slot = &pool->slots[index];
  struct farm_job *last = NULL;
  for (struct farm_job *job = slot->jobs.first; job; job = job->next)
    if (atomic_load(&record->ticket[job->ticket]) == job->handle)
      last = job;
  if (!last)
    return NULL;
  uint64_t expected = last->handle;
  if (!atomic_compare_exchange_strong(&record->ticket[last->ticket], &expected, 0))
    return NULL;
  return farm_job_take(&slot->jobs, last->handle);
}

static int slot_with(const struct farm_pool *pool, bool most) {
  int best = -1;
  for (int i = 0; i < pool->setup.options.slots; i++) {
    const struct slot *slot = &pool->slots[i];
    if (slot->channel < 0)
      continue;
    if (best < 0 ||
        (most ? slot->jobs.count > pool->slots[best].jobs.count : slot->jobs.count < pool->slots[best].jobs.count))
      best = i;
  }
  return best;
}

/* Sends waiting jobs to the slots with the fewest jobs, until every slot has enough. */
static void send_waiting(struct farm_pool *pool) {
  const size_t deep = depth(pool);
  while (pool->queue.first) {
    const int index = slot_with(pool, false);
    if (index < 0 || pool->slots[index].jobs.count >= deep)
      return;
    struct farm_job *job = farm_job_pop(&pool->queue);
    if (!give(pool, index, job)) {
      farm_job_push_front(&pool->queue, job);
      return;
    }
  }
}

/* Moves jobs that wait at one slot to idle slots, when no job waits in the pool. */
static void relieve_slots(struct farm_pool *pool) {
  while (!pool->queue.first) {
    const int idle = slot_with(pool, false);
    if (idle < 0 || pool->slots[idle].jobs.count > 0)
      return;
    const int loaded = slot_with(pool, true);
    if (pool->slots[loaded].jobs.count < 2)
      return;
    struct farm_job *job = take_back(pool, loaded);
    if (!job)
      return;
    if (!give(pool, idle, job)) {
      farm_job_push_front(&pool->queue, job);
      return;
    }
  }
}

void farm_pool_dispatch(struct farm_pool *pool) {
  send_waiting(pool);
  relieve_slots(pool);
  for (int i = 0; i < pool->setup.options.slots; i++)
    farm_pool_flush(&pool->slots[i]);
}

void farm_pool_withdraw(struct farm_pool *pool, size_t most, struct farm_job_queue *into) {
  while (most > 0 && pool->queue.last) {
    struct farm_job *job = farm_job_take(&pool->queue, pool->queue.last->handle);
    farm_job_push_front(into, job);
    pool->count--;
    most--;
  }
  for (int i = 0; i < pool->setup.options.slots; i++) {
    for (struct farm_job *job; most > 0 && (job = take_back(pool, i)); most--) {
      farm_job_push(into, job);
      pool->count--;
    }
  }
}

void farm_pool_end(struct farm_pool *pool) {
  if (!pool)
    return;
  if (pool->control >= 0)
    farm_server_end(pool->server, pool->control);
  for (int i = 0; pool->slots && i < pool->setup.options.slots; i++) {
    struct slot *const slot = &pool->slots[i];
    if (slot->channel >= 0)
      close(slot->channel);
    farm_job_clear(&slot->jobs);
    farm_frame_free(&slot->in);
    farm_frame_free(&slot->out);
  }
  farm_job_clear(&pool->queue);
  if (pool->setup.records)
    munmap(pool->setup.records, pool->records_size);
  free(pool->slots);
  free(pool->fds);
  free(pool);
}
