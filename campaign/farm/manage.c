/* Rank 0: asks for tasks, spreads them, reports what came back; never computes, never blocks but in poll(). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/farm/private.h"
#include "schemas/clock.h"

#define TICK_NS (100 * CLOCK_MS)
#define SECOND_SIGNAL_NS                                                                                               \
  (100 * CLOCK_MS) /* closer ones are copies: `timeout` and shells signal child and group                              \
                    */
#define BYE_NS            (10 * CLOCK_S)
#define REMOTE_AHEAD_S    0.010 /* work sent ahead to a rank: twice the longest sleep of a main process */
#define REMOTE_AHEAD_MOST 256

struct manager {
  struct farm *farm;
  const struct farm_manager *calls;
  struct error *error;
  struct farm_job_table table;    /* all that was taken and not reported */
  struct farm_job_queue returned; /* taken from the caller, at no rank now */
  bool dry;                       /* next() had none */
  bool draining, dropping, silent;
  status final;
  int64_t drop_ns, signal_ns, first_ns, last_ns;
  struct farm_usage usage;
};

/* The first reason to end stays. */
static void end_with(struct manager *m, status reason, double grace_s) {
  if (m->final == STATUS_OK)
    m->final = reason;
  const int64_t drop_ns = clock_ns() + clock_from_s(grace_s);
  if (!m->draining || drop_ns < m->drop_ns)
    m->drop_ns = drop_ns;
  m->draining = true;
}

static void fail(struct manager *m, status reason) {
  if (reason == STATUS_OK)
    return;
  m->silent = m->dropping = true;
  end_with(m, reason, 0);
}

static void tell(struct manager *m, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                 const struct iovec *part) {
  struct error ignored;
  fail(m, farm_link_send(m->farm->link, rank, kind, handle, parts, part, m->final == STATUS_OK ? m->error : &ignored));
}

/* ---- tasks out ---- */

static size_t room(const struct manager *m, int rank) {
  const struct farm_peer *peer = &m->farm->peers[rank];
  if (peer->lost || peer->slots <= 0)
    return 0;
  if (rank == 0)
    return farm_pool_room(m->farm->pool);
  const double ahead = REMOTE_AHEAD_S / (peer->mean_wall_s + 1e-9);
  const size_t each = ahead < 1 ? 1 : ahead > REMOTE_AHEAD_MOST ? REMOTE_AHEAD_MOST : (size_t)ahead;
  return (size_t)peer->slots * (1 + each);
}

/* The rank with room whose slots have least to do: everybody gets a first task before anybody a second. */
static int emptiest(const struct manager *m) {
  int best = -1;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank], *other = best < 0 ? NULL : &m->farm->peers[best];
    if (peer->out >= room(m, rank))
      continue;
    if (!other || peer->out * (size_t)other->slots < other->out * (size_t)peer->slots)
      best = rank;
  }
  return best;
}

static void assign(struct manager *m, int rank, struct farm_job *job) {
  job->rank = rank;
  m->farm->peers[rank].out++;
  if (m->first_ns == 0)
    m->first_ns = m->last_ns = clock_ns();
  if (rank == 0)
    farm_pool_submit(m->farm->pool, job);
  else
    tell(m, rank, FARM_FRAME_TASK, job->handle, 1, &(struct iovec){job->bytes, job->size});
}

static void fill(struct manager *m) {
  for (int rank; !m->draining && (rank = emptiest(m)) >= 0;) {
    struct farm_job *job = farm_job_pop(&m->returned);
    struct farm_task task = {0};
    if (!job) {
      if (m->dry || !m->calls->next(m->calls->context, &task)) {
        m->dry = true;
        return;
      }
      if (task.size > FARM_FRAME_LARGEST / 2) {
        fail(m,
             status_fail(m->error, STATUS_INTERNAL, "a task of %zu bytes is larger than a message may be", task.size));
        return;
      }
      job = farm_job_new(0, task.bytes, task.size);
      if (!job || !farm_job_table_add(&m->table, job)) {
        free(job);
        fail(m, status_fail(m->error, STATUS_MEMORY, "no memory for a task of %zu bytes", task.size));
        return;
      }
      job->id = task.id;
    }
    assign(m, rank, job);
  }
}

/* ---- taking back: for idle slots at the end, and when the farm stops ---- */

static void come_back(struct manager *m, struct farm_job *job) {
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

static void recall(struct manager *m, int rank, size_t most) {
  struct farm_peer *peer = &m->farm->peers[rank];
  if (rank > 0) {
    if (peer->recalling || peer->lost)
      return;
    peer->recalling = true;
    tell(m, rank, FARM_FRAME_RECALL, most, 0, NULL);
    return;
  }
  struct farm_job_queue back = {0};
  farm_pool_withdraw(m->farm->pool, most, &back);
  for (struct farm_job *job; (job = farm_job_pop(&back));)
    come_back(m, job);
}

static void balance(struct manager *m) {
  if (m->draining) {
    for (struct farm_job *job; (job = farm_job_pop(&m->returned)); free(job))
      farm_job_table_remove(&m->table, job->handle);
    return;
  }
  if (!m->dry || m->returned.first || m->farm->ranks == 1)
    return;
  size_t idle = 0;
  int loaded = -1;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank];
    if (peer->lost || peer->slots <= 0)
      continue;
    const size_t slots = (size_t)peer->slots;
    if (peer->out < slots)
      idle += slots - peer->out;
    if (peer->out > slots && !peer->recalling && peer->mean_wall_s > 1e-3 &&
        (loaded < 0 || peer->out * (size_t)m->farm->peers[loaded].slots > m->farm->peers[loaded].out * slots))
      loaded = rank;
  }
  if (idle == 0 || loaded < 0)
    return;
  const size_t over = m->farm->peers[loaded].out - (size_t)m->farm->peers[loaded].slots;
  recall(m, loaded, over < idle ? over : idle);
}

static void take_all_back(struct manager *m) {
  for (int rank = 0; rank < m->farm->ranks; rank++)
    recall(m, rank, SIZE_MAX >> 1);
}

/* ---- results in ---- */

static void report(struct manager *m, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                   const char *message, size_t message_size) {
  char text[1024];
  struct farm_peer *const peer = &m->farm->peers[job->rank];
  snprintf(text, sizeof text, "%.*s", (int)(message_size < sizeof text ? message_size : sizeof text - 1),
           message_size ? message : "");
  const struct farm_report it = {.id = job->id,
                                 .ending = (enum farm_ending)result->ending,
                                 .bytes = bytes,
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
  m->usage.task_cpu_s += result->cpu_s;
  m->usage.tasks++;
  m->last_ns = clock_ns();
  m->dry = false;
  farm_job_table_remove(&m->table, job->handle);
  if (!m->silent) {
    struct error later;
    const status said = m->calls->report(m->calls->context, &it, m->final == STATUS_OK ? m->error : &later);
    if (said == STATUS_STOPPED && !m->draining) {
      end_with(m, said, m->farm->options.drain_s);
      take_all_back(m);
    } else if (said != STATUS_OK && said != STATUS_STOPPED) {
      fail(m, said);
    }
  }
  m->last_ns = clock_ns();
  free(job);
}

static void local_ended(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                        const char *message, size_t message_size) {
  report(context, job, result, bytes, message, message_size);
}

/* Who was computing is not known: the oldest as many as there are slots. They are reported, the rest goes elsewhere. */
static void lose(struct manager *m, int rank, const char *why) {
  struct farm_peer *const peer = &m->farm->peers[rank];
  const struct farm_result lost = {.ending = FARM_LOST};
  int blamed = 0;
  for (size_t place = 0; place < m->table.capacity; place++) {
    struct farm_job *job = m->table.job[place];
    if (!job || job->rank != rank || peer->out == 0)
      continue;
    if (blamed++ < peer->slots)
      report(m, job, &lost, NULL, why, strlen(why));
    else
      come_back(m, job);
  }
  peer->slots = 0;
  peer->out = 0;
}

static status take(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                   struct error *error) {
  struct manager *m = context;
  struct farm_peer *const peer = &m->farm->peers[rank];
  peer->heard_ns = clock_ns();
  if (peer->lost)
    return STATUS_OK;
  struct farm_job *job = farm_job_table_find(&m->table, frame->handle);
  switch (frame->kind) {
  case FARM_FRAME_RESULT: {
    struct farm_result result;
    if (frame->size < sizeof result)
      return status_fail(error, STATUS_INTERNAL, "rank %d sent a torn result", rank);
    memcpy(&result, payload, sizeof result);
    if (result.size > frame->size - sizeof result)
      return status_fail(error, STATUS_INTERNAL, "rank %d sent a torn result", rank);
    if (job && job->rank == rank)
      report(m, job, &result, payload + sizeof result, (const char *)payload + sizeof result + result.size,
             frame->size - sizeof result - result.size);
    return STATUS_OK;
  }
  case FARM_FRAME_RETURNED:
    if (job && job->rank == rank)
      come_back(m, job);
    return STATUS_OK;
  case FARM_FRAME_RECALLED: peer->recalling = false; return STATUS_OK;
  case FARM_FRAME_ALIVE:
    if ((int)frame->handle < peer->slots) {
      if (frame->handle == 0) {
        recall(m, rank, SIZE_MAX >> 1);
        peer->slots = 0;
      } else {
        peer->slots = (int)frame->handle;
      }
    }
    return STATUS_OK;
  case FARM_FRAME_SIGNAL: /* of this rank alone, or of the whole group: then ours comes too */
    if (!m->draining) {
      if (m->calls->stopping)
        m->calls->stopping(m->calls->context, (int)frame->handle);
      status_fail(m->error, STATUS_STOPPED, "rank %d got signal %d (%s): stopped; the same command resumes", rank,
                  (int)frame->handle, strsignal((int)frame->handle));
      end_with(m, STATUS_STOPPED, frame->handle == SIGUSR1 ? m->farm->options.drain_s : m->farm->options.grace_s);
      m->signal_ns = clock_ns();
      take_all_back(m);
    }
    return STATUS_OK;
  case FARM_FRAME_BYE:
    peer->bye = true;
    if (frame->size == sizeof peer->cpu_s)
      memcpy(&peer->cpu_s, payload, sizeof peer->cpu_s);
    return STATUS_OK;
  default: return status_fail(error, STATUS_INTERNAL, "rank %d sent a message of unknown kind %d", rank, frame->kind);
  }
}

/* ---- the loop ---- */

static void mind_signals(struct manager *m) {
  for (int number; (number = farm_signal(m->farm));) {
    const int64_t now = clock_ns();
    if (m->signal_ns && now - m->signal_ns > SECOND_SIGNAL_NS) {
      m->dropping = true;
    } else if (!m->signal_ns) {
      m->signal_ns = now;
      if (m->calls->stopping)
        m->calls->stopping(m->calls->context, number);
      if (m->final == STATUS_OK) {
        if (m->farm->launcher == 0 && m->farm->link)
          status_fail(m->error, STATUS_STOPPED, "mpirun has died: stopped; the same command resumes");
        else
          status_fail(m->error, STATUS_STOPPED, "stopped by signal %d (%s); the same command resumes", number,
                      strsignal(number));
      }
      end_with(m, STATUS_STOPPED, number == SIGUSR1 ? m->farm->options.drain_s : m->farm->options.grace_s);
      take_all_back(m);
    }
  }
}

static void mind_ranks(struct manager *m, int64_t now, int64_t late_ns) {
  const int64_t limit = clock_from_s(m->farm->options.lost_after_s);
  int alive = 0;
  if (m->farm->peers[0].slots != farm_pool_slots(m->farm->pool)) {
    m->farm->peers[0].slots = farm_pool_slots(m->farm->pool);
    if (m->farm->peers[0].slots == 0)
      recall(m, 0, SIZE_MAX >> 1);
  }
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    struct farm_peer *const peer = &m->farm->peers[rank];
    if (rank > 0 && !peer->lost) {
      if (late_ns > CLOCK_S)
        peer->heard_ns += late_ns; /* it was us who did not listen */
      if (now - peer->heard_ns > limit) {
        char why[160];
        snprintf(why, sizeof why, "rank %d on %s has said nothing for %g s: frozen or gone", rank, peer->host,
                 m->farm->options.lost_after_s);
        peer->lost = m->farm->broken = true;
        if (m->calls->stopping)
          m->calls->stopping(m->calls->context, 0);
        lose(m, rank, why);
      }
    }
    alive += peer->lost ? 0 : peer->slots;
  }
  if (alive == 0 && !m->draining) {
    fail(m, status_fail(m->error, STATUS_STOPPED,
                        "no slot is left: the processes that compute were killed or could "
                        "not be made; the same command resumes"));
  }
}

static bool finished(const struct manager *m) {
  if (m->dropping)
    return true;
  size_t out = 0;
  bool recalling = false;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    out += m->farm->peers[rank].lost ? 0 : m->farm->peers[rank].out;
    recalling |= m->farm->peers[rank].recalling && !m->farm->peers[rank].lost;
  }
  return out == 0 && !m->returned.first && (m->draining || m->dry) && !recalling;
}

/* All ranks are told, and answer; who does not within the time makes MPI_Finalize impossible. */
static void say_goodbye(struct manager *m) {
  struct farm *const farm = m->farm;
  struct error ignored;
  const struct farm_end end = {m->final, m->dropping};
  const char *text = m->final != STATUS_OK && m->error ? m->error->message : "";
  if (m->dropping) {
    for (size_t place = 0; place < m->table.capacity; place++) /* these are the pool's to free */
      if (m->table.job[place] && m->table.job[place]->rank == 0)
        m->table.job[place] = NULL;
    farm_pool_end(farm->pool);
    farm->pool = NULL;
  }
  for (int rank = 1; rank < farm->ranks; rank++) {
    farm->peers[rank].bye = false;
    if (farm_link_send(farm->link, rank, FARM_FRAME_END, 0, 2,
                       (struct iovec[]){{(void *)&end, sizeof end}, {(void *)text, strlen(text)}},
                       &ignored) != STATUS_OK)
      farm->broken = true;
  }
  if (!farm->link)
    return;
  if (farm_link_flush(farm->link, &ignored) != STATUS_OK)
    farm->broken = true;
  const int64_t until = clock_ns() + (m->signal_ns ? CLOCK_S / 2 : BYE_NS);
  for (int missing = 1; missing > 0 && clock_ns() < until;) {
    int count;
    if (farm_link_drain(farm->link, take, m, &count, &ignored) != STATUS_OK)
      break;
    missing = 0;
    for (int rank = 1; rank < farm->ranks; rank++)
      missing += !farm->peers[rank].bye && !farm->peers[rank].lost;
    if (missing)
      nanosleep(&(struct timespec){.tv_nsec = FARM_SLEEP_LEAST_NS}, NULL);
  }
  for (int rank = 1; rank < farm->ranks; rank++) {
    if (!farm->peers[rank].bye)
      farm->broken = true;
    m->usage.waiting_cpu_s += farm->peers[rank].cpu_s;
  }
}

status farm_manage(struct farm *farm, const struct farm_manager *calls, struct error *error) {
  struct error own = {0};
  struct manager m = {.farm = farm, .calls = calls, .error = error ? error : &own};
  const double cpu = clock_cpu_s();
  int64_t sleep_ns = FARM_SLEEP_LEAST_NS, ticked_ns = clock_ns(), looped_ns = ticked_ns;
  farm_pool_sink_to(farm->pool, (struct farm_pool_sink){&m, local_ended});
  for (int rank = 0; rank < farm->ranks; rank++) {
    farm->peers[rank].heard_ns = ticked_ns;
    farm->peers[rank].out = 0;
    farm->peers[rank].recalling = false;
  }
  for (;;) {
    int count = 0;
    mind_signals(&m);
    fill(&m);
    balance(&m);
    farm_pool_dispatch(farm->pool);
    if (farm->link)
      fail(&m, farm_link_flush(farm->link, m.error));
    const int64_t now = clock_ns();
    if (m.draining && now >= m.drop_ns)
      m.dropping = true;
    if (finished(&m))
      break;
    int64_t timeout_ns = ticked_ns + TICK_NS - now;
    if (farm->ranks > 1 && sleep_ns < timeout_ns)
      timeout_ns = sleep_ns;
    const bool heard = farm_pool_wait(farm->pool, farm->signals, timeout_ns < 0 ? 0 : timeout_ns);
    if (farm->ranks > 1) {
      struct error later;
      fail(&m, farm_link_drain(farm->link, take, &m, &count, m.final == STATUS_OK ? m.error : &later));
    }
    sleep_ns = heard || count > 0 ? FARM_SLEEP_LEAST_NS : farm_sleep_longer(sleep_ns);
    const int64_t after = clock_ns();
    mind_ranks(&m, after, after - looped_ns);
    looped_ns = after;
    if (after - ticked_ns >= TICK_NS) {
      ticked_ns = after;
      if (!m.draining)
        m.dry = false;
      struct error later;
      if (calls->tick && !m.silent) {
        const size_t slots = (size_t)farm_slots_total(farm), taken = m.table.count;
        const status said = calls->tick(calls->context, (int)(taken < slots ? taken : slots),
                                        m.final == STATUS_OK ? m.error : &later);
        if (said == STATUS_STOPPED && !m.draining) {
          end_with(&m, said, farm->options.drain_s);
          take_all_back(&m);
        } else if (said != STATUS_OK && said != STATUS_STOPPED) {
          fail(&m, said);
        }
      }
    }
  }
  say_goodbye(&m);
  m.usage.wall_s = 1e-9 * (double)(m.last_ns - m.first_ns);
  m.usage.manager_cpu_s = clock_cpu_s() - cpu;
  m.usage.start_up_s = farm->usage.start_up_s;
  farm->usage = m.usage;
  farm_job_table_free(&m.table);
  return m.final;
}
