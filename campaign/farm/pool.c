/* The slots of a rank: sends jobs to them, takes back jobs that they have not begun, reads their messages, replaces
 * slots that end. */
#include "campaign/farm/farm_private.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/clock.h"
#include "schemas/memory.h"

struct slot {
  int channel; /* -1: none at present */
  pid_t pid;
  bool given_up;
  int idle_ends;
  uint64_t killed;   /* handle of the task at whose deadline the slot was killed */
  uint64_t forgiven; /* handle of the task whose deadline was moved by forgiven_ns */
  int64_t forgiven_ns;
  struct farm_job_queue jobs; /* jobs sent to the slot, in order */
  struct farm_bytes in, out;
};

struct farm_pool {
  struct farm_slot_setup setup;
  size_t records_size;
  pid_t server;
  int control;
  struct slot *slots;
  struct pollfd *fds;
  struct farm_job_queue queue;
  struct farm_pool_sink sink;
  double mean_wall_s; /* mean wall time of recent tasks */
  int64_t looked_ns;
};

/* Writes the bytes that wait for the slot, as far as its channel accepts them. */
static void flush(struct slot *slot) {
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

/* Several tasks shorter than this are sent ahead to a slot, so that it never waits while the manager handles a batch.
 */
#define AHEAD_NS (500 * CLOCK_MS / 1000)

status farm_pool_start(const struct farm_options *options, farm_work work, struct farm_pool **out,
                       struct error *error) {
  const size_t slots = (size_t)options->slots;
  struct farm_pool *pool = *out = memory_small(1, sizeof *pool);
  *pool = (struct farm_pool){.setup = {.options = *options, .work = work}, .control = -1, .mean_wall_s = 1};
  pool->looked_ns = clock_ns();
  pool->records_size = slots * sizeof *pool->setup.records;
  void *records = mmap(NULL, pool->records_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (records == MAP_FAILED)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu slots", slots);
  pool->setup.records = records;
  TRY(memory_array(&pool->fds, slots + 2, sizeof *pool->fds, "the slots", error));
  TRY(memory_array(&pool->slots, slots, sizeof *pool->slots, "the slots", error));
  for (size_t i = 0; i < slots; i++)
    pool->slots[i].channel = -1;
  return farm_server_start(&pool->setup, &pool->server, &pool->control, error);
}

void farm_pool_sink_to(struct farm_pool *pool, struct farm_pool_sink sink) {
  pool->sink = sink;
}

void farm_pool_submit(struct farm_pool *pool, struct farm_job *job) {
  farm_job_push(&pool->queue, job);
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
    flush(&pool->slots[i]);
}

void farm_pool_withdraw(struct farm_pool *pool, size_t most, struct farm_job_queue *into) {
  while (most > 0 && pool->queue.first) {
    struct farm_job *job = farm_job_take(&pool->queue, pool->queue.first->prev->handle);
    farm_job_push_front(into, job);
    most--;
  }
  for (int i = 0; i < pool->setup.options.slots; i++)
    for (struct farm_job *job; most > 0 && (job = take_back(pool, i)); most--)
      farm_job_push(into, job);
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

/* ---- Reads results, replaces slots that end, enforces deadlines of runs in process ---- */

enum { IDLE_ENDS = 5 }; /* a slot that ends this many times in a row without a task is not replaced */

/* Reads the bytes that the slot has written so far. False: its channel is closed. */
static bool read_slot(struct slot *slot) {
  for (;;) {
    if (!farm_frame_reserve(&slot->in, farm_frame_missing(&slot->in, 16384)))
      return false;
    const size_t space = slot->in.capacity - slot->in.end;
    const ssize_t n = recv(slot->channel, slot->in.data + slot->in.end, space, MSG_DONTWAIT);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0 && errno == EAGAIN)
      return true;
    if (n <= 0)
      return false;
    slot->in.end += (size_t)n;
    if ((size_t)n < space)
      return true;
  }
}

/* Takes the results that the slot has written. False: its channel is closed, or it wrote invalid data. */
static bool listen_to(struct farm_pool *pool, struct slot *slot) {
  const bool open = read_slot(slot);
  struct farm_frame frame;
  const uint8_t *payload;
  int got;
  while ((got = farm_frame_next(&slot->in, &frame, &payload)) > 0) {
    struct farm_ended how;
    if (!farm_frame_result(&frame, payload, &how))
      return false;
    struct farm_job *job = farm_job_take(&slot->jobs, frame.handle);
    if (!job)
      continue; /* unreachable: a job that the slot ran is in its queue */
    slot->idle_ends = 0;
    pool->mean_wall_s += 0.1 * (how.result.wall_s - pool->mean_wall_s);
    pool->sink.ended(pool->sink.context, job, &how);
  }
  if (got < 0)
    return false;
  if (slot->in.begin == slot->in.end)
    farm_frame_trim(&slot->in);
  return open;
}

/* The job that the slot was computing when it ended, taken out of its queue. NULL: it had not begun one. */
static struct farm_job *take_running(struct slot *slot, struct farm_slot_record *record) {
  const uint64_t running = atomic_load(&record->running);
  struct farm_job *job = running ? farm_job_take(&slot->jobs, running) : NULL;
  if (!job || atomic_load(&record->ticket[job->ticket]) != running)
    return job;
  farm_job_push_front(&slot->jobs, job); /* the ticket was not yet taken: the slot had not begun the job */
  return NULL;
}

/* The slot's process has ended: its running job gets the verdict. */
static void slot_ended(struct farm_pool *pool, int index, const struct farm_result *verdict, const char *text) {
  struct slot *const slot = &pool->slots[index];
  struct farm_slot_record *const record = &pool->setup.records[index];
  if (slot->channel >= 0) {
    listen_to(pool, slot);
    close(slot->channel);
    slot->channel = -1;
  }
  farm_frame_free(&slot->in);
  farm_frame_free(&slot->out);

  const uint64_t running = atomic_load(&record->running);
  const int64_t started = atomic_load(&record->started_ns);
  const bool timed_out = running && slot->killed == running;
  struct farm_job *job = take_running(slot, record);
  for (struct farm_job *last; slot->jobs.first;) { /* the others are next in the pool, in their order */
    last = farm_job_take(&slot->jobs, slot->jobs.first->prev->handle);
    farm_job_push_front(&pool->queue, last);
  }
  slot->idle_ends = job ? 0 : slot->idle_ends + 1;
  slot->killed = slot->forgiven = 0;
  for (int i = 0; i < FARM_SLOT_TICKETS; i++)
    atomic_store(&record->ticket[i], 0);
  atomic_store(&record->running, 0);
  if (!job)
    return;

  struct farm_ended how = {.result = *verdict};
  char limit[96];
  if (timed_out) {
    how.result.ending = FARM_TIME_LIMIT;
    snprintf(limit, sizeof limit, "ended at its time limit of %g s", pool->setup.options.time_limit_s);
    text = limit;
  }
  how.result.wall_s = 1e-9 * (double)(clock_ns() - started);
  how.result.slot = index;
  how.message = text;
  how.message_size = strlen(text);
  pool->sink.ended(pool->sink.context, job, &how);
}

/* The fork server reports that a slot's process has ended, or could not be made. Requests a new one. */
static void hear_slot_ended(struct farm_pool *pool, const struct farm_server_message *message) {
  struct slot *const slot = &pool->slots[message->slot];
  const int value = message->value;
  char text[160];
  const bool in_process = pool->setup.options.in_process;
  struct farm_result verdict = {.ending = FARM_LOST};
  if (message->pid == 0) {
    snprintf(text, sizeof text, "the system refused a process for a slot: %s", strerror(value));
  } else if (WIFSIGNALED(value)) {
    verdict.signal = WTERMSIG(value);
    if (in_process)
      verdict.ending = farm_slot_ending_by(verdict.signal);
    snprintf(text, sizeof text, "%s killed by signal %d (%s)%s",
             in_process ? "the run's process was" : "the slot (not the run) was", verdict.signal,
             strsignal(verdict.signal),
             verdict.signal == SIGKILL ? "; if nobody did it, the machine was out of memory" : "");
  } else {
    verdict.exit_code = WEXITSTATUS(value);
    if (in_process && verdict.exit_code != STATUS_MEMORY)
      verdict.ending = FARM_CRASHED;
    snprintf(text, sizeof text, "the run's process exited with code %d and no result", verdict.exit_code);
  }
  slot_ended(pool, message->slot, &verdict, text);
  slot->pid = 0;
  if (slot->idle_ends >= IDLE_ENDS || !farm_server_ask(pool->control, FARM_SERVER_SPAWN, message->slot, 0))
    slot->given_up = true;
}

static void hear_server(struct farm_pool *pool) {
  static const struct farm_result lost = {.ending = FARM_LOST};
  struct farm_server_message message;
  int channel, got;
  while ((got = farm_server_hear(pool->control, &message, &channel)) > 0 && message.slot >= 0 &&
         message.slot < pool->setup.options.slots) {
    if (message.verb == FARM_SERVER_SPAWNED) {
      pool->slots[message.slot].channel = channel;
      pool->slots[message.slot].pid = message.pid;
    } else if (message.verb == FARM_SERVER_DIED) {
      hear_slot_ended(pool, &message);
    }
  }
  if (got == 0)
    return;

  if (channel >= 0)
    close(channel);
  for (int i = 0; i < pool->setup.options.slots; i++) {
    slot_ended(pool, i, &lost, "the fork server of this rank is gone, and its slots with it");
    pool->slots[i].given_up = true;
  }
  farm_server_end(pool->server, pool->control);
  pool->control = -1;
  pool->server = 0;
}

/* Returns the deadline of the slot's running job, and kills the slot if the deadline has passed. `late`: time since the
 * last check, ns. INT64_MAX: no deadline to wait for. */
static int64_t keep_deadline(struct farm_pool *pool, int index, int64_t now, int64_t late) {
  struct slot *const slot = &pool->slots[index];
  const uint64_t running = atomic_load(&pool->setup.records[index].running);
  const int64_t started = atomic_load(&pool->setup.records[index].started_ns);
  const int64_t limit = clock_from_s(pool->setup.options.time_limit_s);
  if (slot->channel < 0 || slot->jobs.count == 0 || !running || slot->killed == running)
    return INT64_MAX;

  /* The main process checks at least once a second. A longer gap means that all processes were stopped (Ctrl-Z); this
   * time does not count for the run. */
  if (late > 2 * CLOCK_S) {
    slot->forgiven_ns = (slot->forgiven == running ? slot->forgiven_ns : 0) + late;
    slot->forgiven = running;
  }
  const int64_t until = started + (slot->forgiven == running ? slot->forgiven_ns : 0) + limit;
  if (now < until)
    return until;
  slot->killed = running;
  farm_server_ask(pool->control, FARM_SERVER_KILL, index, slot->pid);
  return INT64_MAX;
}

/* Returns the time of the next check. The main process enforces the deadline of a run in the slot's own process,
 * because the slot is busy; a slot with isolated runs enforces their deadlines itself. */
static int64_t keep_deadlines(struct farm_pool *pool) {
  const int64_t now = clock_ns(), late = now - pool->looked_ns;
  pool->looked_ns = now;
  int64_t next = INT64_MAX;
  if (!pool->setup.options.in_process || !(pool->setup.options.time_limit_s > 0))
    return next;
  for (int i = 0; i < pool->setup.options.slots; i++) {
    const int64_t until = keep_deadline(pool, i, now, late);
    if (until < next)
      next = until;
  }
  return next;
}

bool farm_pool_listen(struct farm_pool *pool, int signals, int64_t timeout_ns) {
  const int slots = pool->setup.options.slots;
  const int64_t deadline = pool->control >= 0 ? keep_deadlines(pool) : INT64_MAX, now = clock_ns();
  if (timeout_ns > CLOCK_S)
    timeout_ns = CLOCK_S;
  if (deadline - now < timeout_ns)
    timeout_ns = deadline > now ? deadline - now : 0;
  for (int i = 0; i < slots; i++) {
    const bool waits = pool->slots[i].out.begin < pool->slots[i].out.end;
    pool->fds[i] = (struct pollfd){.fd = pool->slots[i].channel, .events = waits ? POLLIN | POLLOUT : POLLIN};
  }
  pool->fds[slots] = (struct pollfd){.fd = pool->control, .events = POLLIN};
  pool->fds[slots + 1] = (struct pollfd){.fd = signals, .events = POLLIN};
  const struct timespec timeout = {timeout_ns / CLOCK_S, (long)(timeout_ns % CLOCK_S)};
  if (ppoll(pool->fds, (nfds_t)slots + 2, &timeout, NULL) <= 0)
    return false;
  for (int i = 0; i < slots; i++) {
    const short events = pool->fds[i].revents;
    if (events & POLLOUT)
      flush(&pool->slots[i]);
    if (!(events & (POLLIN | POLLHUP | POLLERR)) || listen_to(pool, &pool->slots[i]))
      continue;
    /* A closed channel: the slot has ended, and the server reports why. Invalid data: the slot is killed, and the
     * server reports that. */
    if (pool->control >= 0)
      farm_server_ask(pool->control, FARM_SERVER_KILL, i, pool->slots[i].pid);
    close(pool->slots[i].channel);
    pool->slots[i].channel = -1;
  }
  if (pool->control >= 0 && pool->fds[slots].revents)
    hear_server(pool);
  return true;
}
