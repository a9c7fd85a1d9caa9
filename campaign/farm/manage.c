/* Rank 0: takes tasks from the caller, spreads them over the ranks and reports their results. It never computes, and
 * blocks only in poll(). */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <unistd.h>

#include "campaign/farm/manage.h"
#include "schemas/clock.h"

#define TICK_NS (100 * CLOCK_MS)
/* A second signal this soon is a copy: `timeout` and shells signal both the child and its group. */
#define SECOND_SIGNAL_NS (100 * CLOCK_MS)
#define LAST_ANSWER_NS   (10 * CLOCK_S) /* longest wait for the last answer of the other ranks */

void farm_manage_drain(struct manager *m, status reason, double grace_s) {
  if (m->final == STATUS_OK)
    m->final = reason;
  const int64_t drop_ns = clock_ns() + clock_from_s(grace_s);
  if (!m->draining || drop_ns < m->drop_ns)
    m->drop_ns = drop_ns;
  m->draining = true;
}

void farm_manage_fail(struct manager *m, status reason) {
  if (reason == STATUS_OK)
    return;
  m->silent = m->dropping = true;
  farm_manage_drain(m, reason, 0);
}

void farm_manage_obey(struct manager *m, status said) {
  if (said != STATUS_STOPPED) {
    farm_manage_fail(m, said);
    return;
  }
  if (m->draining)
    return;
  farm_manage_drain(m, said, m->farm->options.drain_s);
  farm_manage_send_recall_all(m);
}

void farm_manage_stop(struct manager *m, int number) {
  const struct farm_options *options = &m->farm->options;
  m->signal_ns = clock_ns();
  farm_manage_drain(m, STATUS_STOPPED, number == SIGUSR1 ? options->drain_s : options->grace_s);
  farm_manage_send_recall_all(m);
}

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
      status_fail(farm_manage_error(m), STATUS_STOPPED, "mpirun has died: stopped; the same command resumes");
    else
      status_fail(farm_manage_error(m), STATUS_STOPPED, "stopped by signal %d (%s); the same command resumes", number,
                  strsignal(number));
    farm_manage_stop(m, number);
  }
}

/* Finds lost ranks, and ends the farm when no slot is left. `late_ns`: time during which this rank itself did not
 * listen. */
static void watch_ranks(struct manager *m, int64_t now, int64_t late_ns) {
  const int64_t limit = clock_from_s(m->farm->options.lost_after_s);
  struct farm_peer *peers = m->farm->peers;
  const int own = farm_pool_slots(m->farm->pool);
  if (peers[0].slots != own) {
    peers[0].slots = own;
    if (own == 0)
      farm_manage_send_recall(m, 0);
  }

  int alive = 0;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    if (rank > 0 && !peers[rank].lost) {
      if (late_ns > CLOCK_S)
        peers[rank].heard_ns += late_ns;
      if (now - peers[rank].heard_ns > limit)
        farm_manage_take_loss(m, rank);
    }
    alive += peers[rank].lost ? 0 : peers[rank].slots;
  }
  if (alive == 0 && !m->draining)
    farm_manage_fail(m, status_fail(m->error, STATUS_STOPPED,
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
  return !m->returned.first && (m->draining || (m->dry && !m->calls->orders));
}

/* Ends this rank's pool and its running tasks. The pool frees its jobs. */
static void drop_pool(struct manager *m) {
  for (struct farm_job *job; (job = farm_job_table_oldest(&m->table, 0));)
    farm_job_table_remove(&m->table, job->handle);
  farm_pool_end(m->farm->pool);
  m->farm->pool = NULL;
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

static int unanswered(const struct farm *farm) {
  int count = 0;
  for (int rank = 1; rank < farm->ranks; rank++)
    count += !farm->peers[rank].bye && !farm->peers[rank].lost;
  return count;
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
  while (clock_ns() < until) {
    if (farm_link_drain(farm->link, farm_manage_take, m, &count, &ignored) != STATUS_OK || unanswered(farm) == 0)
      break;
    nanosleep(&(struct timespec){.tv_nsec = FARM_SLEEP_LEAST_NS}, NULL);
  }
  for (int rank = 1; rank < farm->ranks; rank++) {
    if (!farm->peers[rank].bye)
      farm->broken = true;
    m->usage.waiting_cpu_s += farm->peers[rank].cpu_s;
  }
}

/* With outside requests, one file descriptor reports both signals and requests. */
static void watch(struct manager *m) {
  m->watched = m->farm->signals;
  if (!m->calls->orders)
    return;
  m->watched = epoll_create1(EPOLL_CLOEXEC);
  struct epoll_event event = {.events = EPOLLIN};
  if (m->watched < 0 || epoll_ctl(m->watched, EPOLL_CTL_ADD, m->farm->signals, &event) != 0 ||
      epoll_ctl(m->watched, EPOLL_CTL_ADD, m->calls->orders, &event) != 0)
    farm_manage_fail(m, status_fail(m->error, STATUS_MEMORY, "cannot watch for orders: %s", strerror(errno)));
}

static void begin(struct manager *m) {
  watch(m);
  m->ticked_ns = m->looped_ns = clock_ns();
  m->sleep_ns = FARM_SLEEP_LEAST_NS;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    m->farm->peers[rank].heard_ns = m->ticked_ns;
    m->farm->peers[rank].out = 0;
    m->farm->peers[rank].recalling = false;
  }
}

/* Sends all outgoing messages and jobs. */
static void send_all(struct manager *m) {
  take_own_signals(m);
  farm_manage_send(m);
  farm_manage_send_balance(m);
  farm_pool_dispatch(m->farm->pool);
  if (m->farm->link)
    farm_manage_fail(m, farm_link_flush(m->farm->link, m->error));
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
    farm_manage_fail(m, farm_link_drain(farm->link, farm_manage_take, m, &count, farm_manage_error(m)));
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
  farm_manage_obey(m, m->calls->tick(m->calls->context, (int)running, farm_manage_error(m)));
}

status farm_manage(struct farm *farm, const struct farm_manager *calls, struct error *error) {
  struct error own = {0};
  struct manager m = {.farm = farm, .calls = calls, .error = error ? error : &own};
  const double cpu = clock_cpu_s();
  farm_pool_sink_to(farm->pool, (struct farm_pool_sink){&m, farm_manage_take_own});
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
  if (m.dropping)
    drop_pool(&m);
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
