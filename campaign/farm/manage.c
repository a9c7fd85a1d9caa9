/* Rank 0: takes tasks from the caller, spreads them over the ranks and reports their results. It never computes, and
 * blocks only in poll(). */
#include "campaign/farm/farm_private.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <unistd.h>

#include "schemas/clock.h"

struct manager {
  struct farm *farm;
  const struct farm_manager *calls;
  struct error *error;            /* error of the first reason to end */
  struct error later;             /* later errors */
  struct farm_job_table table;    /* all jobs that were taken and not yet reported */
  struct farm_job_queue returned; /* jobs that came back from their rank and wait for another rank */
  bool dry;                       /* the last call of next() gave no task */
  bool draining;                  /* no more tasks go out */
  bool dropping;                  /* running tasks are killed */
  bool silent;                    /* nothing more is reported to the caller */
  status final;
  int64_t drop_ns;           /* time at which draining becomes dropping */
  int64_t signal_ns;         /* time of the first stop signal; 0: none came */
  int64_t first_ns, last_ns; /* times of the first task sent and the last result taken */
  int64_t ticked_ns, looped_ns, sleep_ns;
  int watched; /* readable when a signal or an order has come */
  struct farm_usage usage;
};

/* The error to write to: only the first reason to end is kept. */
static struct error *first_error(struct manager *m) {
  return m->final == STATUS_OK ? m->error : &m->later;
}

#define TICK_NS (100 * CLOCK_MS)
/* A second signal this soon is a copy: `timeout` and shells signal both the child and its group. */
#define SECOND_SIGNAL_NS (100 * CLOCK_MS)
#define LAST_ANSWER_NS   (10 * CLOCK_S) /* longest wait for the last answer of the other ranks */

/* Stops sending tasks. Kills the tasks that still run after grace_s. */
static void drain(struct manager *m, status reason, double grace_s) {
  if (m->final == STATUS_OK)
    m->final = reason;
  const int64_t drop_ns = clock_ns() + clock_from_s(grace_s);
  if (!m->draining || drop_ns < m->drop_ns)
    m->drop_ns = drop_ns;
  m->draining = true;
}

/* Ends the farm immediately, unless the reason is STATUS_OK. */
static void fail(struct manager *m, status reason) {
  if (reason == STATUS_OK)
    return;
  m->silent = m->dropping = true;
  drain(m, reason, 0);
}

/* ---- tasks go to the ranks ---- */

#define REMOTE_AHEAD_S    0.010 /* work sent ahead to a rank: twice the longest sleep of a main process */
#define REMOTE_AHEAD_MOST 256
#define ALL               (SIZE_MAX >> 1)

static void send(struct manager *m, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                 const struct iovec *part) {
  fail(m, farm_link_send(m->farm->link, rank, kind, handle, parts, part, first_error(m)));
}

/* Most jobs sent to a rank: the running ones, and enough waiting ones that it never idles. */
static size_t capacity(const struct manager *m, int rank) {
  const struct farm_peer *peer = &m->farm->peers[rank];
  if (peer->lost || peer->slots <= 0)
    return 0;
  if (rank == 0)
    return farm_pool_capacity(m->farm->pool);
  const double wanted = REMOTE_AHEAD_S / (peer->mean_wall_s + 1e-9);
  size_t ahead = 1;
  if (wanted >= 1)
    ahead = wanted > REMOTE_AHEAD_MOST ? REMOTE_AHEAD_MOST : (size_t)wanted;
  return (size_t)peer->slots * (1 + ahead);
}

/* The rank below its capacity with the fewest jobs per slot: every slot gets a first job before any gets a second. -1:
 * all are full. */
static int least_loaded(const struct manager *m) {
  int best = -1;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank];
    if (peer->out >= capacity(m, rank))
      continue;
    const struct farm_peer *other = best < 0 ? NULL : &m->farm->peers[best];
    if (!other || peer->out * (size_t)other->slots < other->out * (size_t)peer->slots)
      best = rank;
  }
  return best;
}

/* The next task as a job: a returned job, or a new task of the caller. NULL: there is none, or an error. */
static struct farm_job *next_job(struct manager *m) {
  struct farm_job *job = farm_job_pop(&m->returned);
  struct farm_task task = {0};
  if (job)
    return job;
  if (m->dry || !m->calls->next || !m->calls->next(m->calls->context, &task)) {
    m->dry = true;
    return NULL;
  }
  if (task.size > FARM_FRAME_LARGEST / 2) {
    fail(m, status_fail(m->error, STATUS_INTERNAL, "a task of %zu bytes is larger than a message may be", task.size));
    return NULL;
  }

  job = farm_job_new(0, task.bytes, task.size);
  if (!job || !farm_job_table_add(&m->table, job)) {
    free(job);
    fail(m, status_fail(m->error, STATUS_MEMORY, "no memory for a task of %zu bytes", task.size));
    return NULL;
  }
  job->id = task.id;
  return job;
}

/* Sends the caller's tasks to the ranks. */
static void send_tasks(struct manager *m) {
  while (!m->draining) {
    const int rank = least_loaded(m);
    struct farm_job *job = rank < 0 ? NULL : next_job(m);
    if (!job)
      return;
    job->rank = rank;
    m->farm->peers[rank].out++;
    if (m->first_ns == 0)
      m->first_ns = m->last_ns = clock_ns();
    if (rank == 0)
      farm_pool_submit(m->farm->pool, job);
    else
      send(m, rank, FARM_FRAME_TASK, job->handle, 1, &(struct iovec){job->bytes, job->size});
  }
}

/* ---- taking back: for idle slots at the end, and when the farm stops ---- */

/* Handles a job that has left its rank: it waits for another rank, or is dropped when no more tasks are sent. */
static void take_back(struct manager *m, struct farm_job *job) {
  if (m->farm->peers[job->rank].out > 0)
    m->farm->peers[job->rank].out--;
  job->rank = -1;
  if (!m->draining) {
    farm_job_push(&m->returned, job);
    return;
  }
  farm_job_table_remove(&m->table, job->handle);
  free(job);
}

/* Asks a rank for up to `most` jobs that it has not begun. */
static void recall(struct manager *m, int rank, size_t most) {
  struct farm_peer *peer = &m->farm->peers[rank];
  if (rank > 0) {
    if (peer->recalling || peer->lost)
      return;
    peer->recalling = true;
    send(m, rank, FARM_FRAME_RECALL, most, 0, NULL);
    return;
  }
  struct farm_job_queue back = {0};
  farm_pool_withdraw(m->farm->pool, most, &back);
  for (struct farm_job *job; (job = farm_job_pop(&back));)
    take_back(m, job);
}

/* Moves jobs that wait at one rank, that with the most of them per slot, to idle slots of another, at the end of a
 * campaign. Very short jobs are not worth the messages. */
static void balance(struct manager *m) {
  size_t idle = 0;
  int loaded = -1;
  if (!m->dry || m->returned.first || m->farm->ranks == 1)
    return;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank], *other = loaded < 0 ? NULL : &m->farm->peers[loaded];
    if (peer->lost || peer->slots <= 0)
      continue;
    if (peer->out <= (size_t)peer->slots)
      idle += (size_t)peer->slots - peer->out;
    else if (!peer->recalling && peer->mean_wall_s > 1e-3 &&
             (!other || peer->out * (size_t)other->slots > other->out * (size_t)peer->slots))
      loaded = rank;
  }
  if (idle == 0 || loaded < 0)
    return;
  const size_t waiting = m->farm->peers[loaded].out - (size_t)m->farm->peers[loaded].slots;
  recall(m, loaded, waiting < idle ? waiting : idle);
}

/* The rank has so many slots left. */
static void set_slots(struct manager *m, int rank, int slots) {
  struct farm_peer *const peer = &m->farm->peers[rank];
  if (slots >= peer->slots)
    return;
  if (slots == 0)
    recall(m, rank, ALL);
  peer->slots = slots;
}

/* Asks all ranks for all jobs that they have not begun. */
static void recall_all(struct manager *m) {
  for (int rank = 0; rank < m->farm->ranks; rank++)
    recall(m, rank, ALL);
}

/* ---- reasons to end ---- */

/* Handles the status of a callback: STATUS_STOPPED drains the farm, another error ends it immediately. */
static void obey(struct manager *m, status said) {
  if (said != STATUS_STOPPED) {
    fail(m, said);
    return;
  }
  if (m->draining)
    return;
  drain(m, said, m->farm->options.drain_s);
  recall_all(m);
}

/* Handles a stop signal: drains the farm for the time that this signal grants. */
static void stop(struct manager *m, int number) {
  const struct farm_options *options = &m->farm->options;
  m->signal_ns = clock_ns();
  const bool early = number == SIGUSR1 || number == SIGUSR2 || number == SIGXCPU;
  drain(m, STATUS_STOPPED, early ? options->drain_s : options->grace_s);
  recall_all(m);
}

/* ---- results, signals and other messages come from the ranks and from the manager's own pool ---- */

static void report(void *context, struct farm_job *job, const struct farm_ended *ended) {
  struct manager *m = context;
  char text[1024];
  const struct farm_result *const result = &ended->result;
  struct farm_peer *const peer = &m->farm->peers[job->rank];
  snprintf(text, sizeof text, "%.*s", (int)(ended->message_size < sizeof text ? ended->message_size : sizeof text - 1),
           ended->message_size ? ended->message : "");
  const struct farm_report it = {.id = job->id,
                                 .ending = (enum farm_ending)result->ending,
                                 .bytes = ended->bytes,
                                 .size = result->size,
                                 .exit_code = result->exit_code,
                                 .signal = result->signal,
                                 .wall_s = result->wall_s,
                                 .cpu_s = result->cpu_s,
                                 .peak_memory = result->peak_memory,
                                 .rank = job->rank,
                                 .slot = result->slot,
                                 .host = peer->host,
                                 .message = text};
  if (peer->out > 0)
    peer->out--;
  peer->mean_wall_s += 0.1 * (result->wall_s - peer->mean_wall_s);
  m->usage.tasks++;
  m->last_ns = clock_ns();
  m->dry = false;
  farm_job_table_remove(&m->table, job->handle);
  if (!m->silent)
    obey(m, m->calls->report(m->calls->context, &it, first_error(m)));
  m->last_ns = clock_ns();
  free(job);
}

/* Handles a rank that no longer answers. It is unknown which of its jobs were running: the oldest ones, as many as the
 * rank has slots, are reported as lost; the others go to other ranks. */
static void lose_rank(struct manager *m, int rank) {
  struct farm_peer *const peer = &m->farm->peers[rank];
  char why[160];
  snprintf(why, sizeof why, "rank %d on %s has said nothing for %g s: frozen or gone", rank, peer->host,
           m->farm->options.lost_after_s);
  peer->lost = m->farm->broken = true;
  if (m->calls->stopping)
    m->calls->stopping(m->calls->context, 0);

  const struct farm_ended lost = {{.ending = FARM_LOST}, NULL, why, strlen(why)};
  struct farm_job *job;
  for (int reported = 0; peer->out > 0 && (job = farm_job_table_oldest(&m->table, rank));) {
    if (reported++ < peer->slots)
      report(m, job, &lost);
    else
      take_back(m, job);
  }
  peer->slots = 0;
  peer->out = 0;
}

/* Handles a stop signal that another rank received. If the whole group was signalled, this rank receives it as well. */
static void take_signal(struct manager *m, int rank, int number) {
  if (m->draining)
    return;
  if (m->calls->stopping)
    m->calls->stopping(m->calls->context, number);
  status_fail(m->error, STATUS_STOPPED, "rank %d got signal %d (%s): stopped; the same command resumes", rank, number,
              strsignal(number));
  stop(m, number);
}

/* Takes a message of a rank. `context` is the manager. */
static status take_message(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                           struct error *error) {
  struct manager *m = context;
  struct farm_peer *const peer = &m->farm->peers[rank];
  peer->heard_ns = clock_ns();
  if (peer->lost)
    return STATUS_OK;
  switch (frame->kind) {
  case FARM_FRAME_RESULT: {
    struct farm_ended ended;
    if (!farm_frame_result(frame, payload, &ended))
      return status_fail(error, STATUS_INTERNAL, "rank %d sent a damaged result", rank);
    struct farm_job *job = farm_job_table_find(&m->table, frame->handle);
    if (job && job->rank == rank)
      report(m, job, &ended);
    return STATUS_OK;
  }
  case FARM_FRAME_RETURNED: {
    struct farm_job *job = farm_job_table_find(&m->table, frame->handle);
    if (job && job->rank == rank)
      take_back(m, job);
    return STATUS_OK;
  }
  case FARM_FRAME_RECALLED: peer->recalling = false; return STATUS_OK;
  case FARM_FRAME_ALIVE: set_slots(m, rank, (int)frame->handle); return STATUS_OK;
  case FARM_FRAME_SIGNAL: take_signal(m, rank, (int)frame->handle); return STATUS_OK;
  case FARM_FRAME_BYE:
    peer->bye = true;
    if (frame->size == sizeof peer->cpu_s)
      memcpy(&peer->cpu_s, payload, sizeof peer->cpu_s);
    return STATUS_OK;
  default: return status_fail(error, STATUS_INTERNAL, "rank %d sent a message of unknown kind %d", rank, frame->kind);
  }
}

/* ---- the loop ---- */

static void take_own_signals(struct manager *m) {
  for (int number; (number = farm_signal(m->farm));) {
    if (m->signal_ns) {
      if (clock_ns() - m->signal_ns > SECOND_SIGNAL_NS)
        m->dropping = true;
      continue;
    }
    if (m->calls->stopping)
      m->calls->stopping(m->calls->context, number);
    if (m->farm->launcher == 0 && m->farm->link)
      status_fail(first_error(m), STATUS_STOPPED, "mpirun has died: stopped; the same command resumes");
    else
      status_fail(first_error(m), STATUS_STOPPED, "stopped by signal %d (%s); the same command resumes", number,
                  strsignal(number));
    stop(m, number);
  }
}

/* Finds lost ranks, and ends the farm when no slot is left. `late_ns`: time during which this rank itself did not
 * listen. */
static void watch_ranks(struct manager *m, int64_t now, int64_t late_ns) {
  const int64_t limit = clock_from_s(m->farm->options.lost_after_s);
  struct farm_peer *peers = m->farm->peers;
  set_slots(m, 0, farm_pool_slots(m->farm->pool));
  int alive = 0;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    if (rank > 0 && !peers[rank].lost) {
      if (late_ns > CLOCK_S)
        peers[rank].heard_ns += late_ns;
      if (now - peers[rank].heard_ns > limit)
        lose_rank(m, rank);
    }
    alive += peers[rank].lost ? 0 : peers[rank].slots;
  }
  if (alive == 0 && !m->draining)
    fail(m, status_fail(m->error, STATUS_STOPPED,
                        "no slot is left: the processes that compute were killed or could "
                        "not be made; the same command resumes"));
}

static bool finished(const struct manager *m) {
  if (m->dropping)
    return true;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank];
    if (!peer->lost && (peer->out > 0 || peer->recalling))
      return false;
  }
  const bool waits = m->calls->waits && m->calls->waits(m->calls->context);
  return !m->returned.first && (m->draining || (m->dry && !m->calls->orders && !waits));
}

static void send_end(struct manager *m) {
  struct farm *const farm = m->farm;
  const struct farm_end end = {m->final, m->dropping};
  const char *text = m->final != STATUS_OK ? m->error->message : "";
  struct error ignored;
  for (int rank = 1; rank < farm->ranks; rank++) {
    const struct iovec part[] = {{(void *)&end, sizeof end}, {(void *)text, strlen(text)}};
    farm->peers[rank].bye = false;
    if (farm_link_send(farm->link, rank, FARM_FRAME_END, 0, 2, part, &ignored) != STATUS_OK)
      farm->broken = true;
  }
  if (farm_link_flush(farm->link, &ignored) != STATUS_OK)
    farm->broken = true;
}

/* Tells all ranks that the farm ends and waits for their answer. A rank that does not answer in time makes MPI_Finalize
 * impossible. */
static void end_ranks(struct manager *m) {
  struct farm *const farm = m->farm;
  if (!farm->link)
    return;
  send_end(m);
  const int64_t until = clock_ns() + (m->signal_ns ? CLOCK_S / 2 : LAST_ANSWER_NS);
  struct error ignored;
  int count;
  for (bool waits = true; waits && clock_ns() < until;) {
    if (farm_link_drain(farm->link, take_message, m, &count, &ignored) != STATUS_OK)
      break;
    waits = false;
    for (int rank = 1; rank < farm->ranks; rank++)
      waits = waits || !(farm->peers[rank].bye || farm->peers[rank].lost);
    if (waits)
      nanosleep(&(struct timespec){.tv_nsec = FARM_SLEEP_LEAST_NS}, NULL);
  }
  for (int rank = 1; rank < farm->ranks; rank++) {
    if (!farm->peers[rank].bye)
      farm->broken = true;
    m->usage.waiting_cpu_s += farm->peers[rank].cpu_s;
  }
}

static void begin(struct manager *m) {
  m->ticked_ns = m->looped_ns = clock_ns();
  m->sleep_ns = FARM_SLEEP_LEAST_NS;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    m->farm->peers[rank].heard_ns = m->ticked_ns;
    m->farm->peers[rank].out = 0;
    m->farm->peers[rank].recalling = false;
  }
  m->watched = m->farm->signals;
  if (!m->calls->orders)
    return;
  /* With outside requests, one file descriptor reports both signals and requests. */
  m->watched = epoll_create1(EPOLL_CLOEXEC);
  struct epoll_event event = {.events = EPOLLIN};
  if (m->watched < 0 || epoll_ctl(m->watched, EPOLL_CTL_ADD, m->farm->signals, &event) != 0 ||
      epoll_ctl(m->watched, EPOLL_CTL_ADD, m->calls->orders, &event) != 0)
    fail(m, status_fail(m->error, STATUS_MEMORY, "cannot watch for orders: %s", strerror(errno)));
}

/* Sends all outgoing messages and jobs. */
static void send_all(struct manager *m) {
  take_own_signals(m);
  send_tasks(m);
  if (!m->draining)
    balance(m);
  else
    for (struct farm_job *job; (job = farm_job_pop(&m->returned)); free(job))
      farm_job_table_remove(&m->table, job->handle);
  farm_pool_dispatch(m->farm->pool);
  if (m->farm->link)
    fail(m, farm_link_flush(m->farm->link, m->error));
  if (m->draining && clock_ns() >= m->drop_ns)
    m->dropping = true;
}

/* Sleeps until the next tick or until a message comes, and takes the messages in. An MPI message does not wake a
 * sleeping process: with other ranks the sleep is short, and grows only while no message comes. */
static void receive_all(struct manager *m) {
  struct farm *const farm = m->farm;
  int64_t timeout_ns = m->ticked_ns + TICK_NS - clock_ns();
  if (farm->ranks > 1 && m->sleep_ns < timeout_ns)
    timeout_ns = m->sleep_ns;
  const bool heard = farm_pool_listen(farm->pool, m->watched, timeout_ns < 0 ? 0 : timeout_ns);
  int count = 0;
  if (farm->ranks > 1)
    fail(m, farm_link_drain(farm->link, take_message, m, &count, first_error(m)));
  if (heard && m->calls->orders)
    m->ticked_ns -= TICK_NS; /* the event may be an outside request: tick at once */
  m->sleep_ns = heard || count > 0 ? FARM_SLEEP_LEAST_NS : farm_sleep_longer(m->sleep_ns);
}

/* Ten times a second: calls the caller's tick(), and asks for tasks again if there was none. */
static void tick(struct manager *m, int64_t now) {
  if (now - m->ticked_ns < TICK_NS)
    return;
  m->ticked_ns = now;
  if (!m->draining)
    m->dry = false;
  if (!m->calls->tick || m->silent)
    return;
  const size_t slots = (size_t)farm_slots_total(m->farm);
  const size_t running = m->table.count < slots ? m->table.count : slots;
  obey(m, m->calls->tick(m->calls->context, (int)running, first_error(m)));
}

status farm_manage(struct farm *farm, const struct farm_manager *calls, struct error *error) {
  struct error own = {0};
  struct manager m = {.farm = farm, .calls = calls, .error = error ? error : &own};
  const double cpu = clock_cpu_s();
  farm_pool_sink_to(farm->pool, (struct farm_pool_sink){&m, report});
  begin(&m);
  for (;;) {
    send_all(&m);
    if (finished(&m))
      break;
    receive_all(&m);
    const int64_t now = clock_ns();
    watch_ranks(&m, now, now - m.looped_ns);
    m.looped_ns = now;
    tick(&m, now);
  }
  if (m.dropping) { /* ends the running tasks of this rank; the pool frees its jobs */
    for (struct farm_job *job; (job = farm_job_table_oldest(&m.table, 0));)
      farm_job_table_remove(&m.table, job->handle);
    farm_pool_end(farm->pool);
    farm->pool = NULL;
  }
  end_ranks(&m);
  if (m.watched != farm->signals && m.watched >= 0)
    close(m.watched);

  m.usage.wall_s = 1e-9 * (double)(m.last_ns - m.first_ns);
  m.usage.manager_cpu_s = clock_cpu_s() - cpu;
  m.usage.start_up_s = farm->usage.start_up_s;
  farm->usage = m.usage;
  farm_job_table_free(&m.table);
  return m.final;
}
