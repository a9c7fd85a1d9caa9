/* Spreads the manager's tasks over the ranks. Takes back tasks that a rank has not begun: for idle slots at the end,
 * and when the farm stops. */
#include <stdlib.h>

#include "campaign/farm/manage.h"
#include "schemas/clock.h"

#define REMOTE_AHEAD_S    0.010 /* work sent ahead to a rank: twice the longest sleep of a main process */
#define REMOTE_AHEAD_MOST 256

static void send(struct manager *m, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                 const struct iovec *part) {
  farm_manage_fail(m, farm_link_send(m->farm->link, rank, kind, handle, parts, part, farm_manage_error(m)));
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

static void assign(struct manager *m, int rank, struct farm_job *job) {
  job->rank = rank;
  m->farm->peers[rank].out++;
  if (m->first_ns == 0)
    m->first_ns = m->last_ns = clock_ns();
  if (rank == 0)
    farm_pool_submit(m->farm->pool, job);
  else
    send(m, rank, FARM_FRAME_TASK, job->handle, 1, &(struct iovec){job->bytes, job->size});
}

/* The next task as a job: a returned job, or a new task of the caller. NULL: there is none, or an error. */
static struct farm_job *next_job(struct manager *m) {
  struct farm_job *job = farm_job_pop(&m->returned);
  struct farm_task task = {0};
  if (job)
    return job;
  if (m->dry || !m->calls->next(m->calls->context, &task)) {
    m->dry = true;
    return NULL;
  }
  if (task.size > FARM_FRAME_LARGEST / 2) {
    farm_manage_fail(m, status_fail(m->error, STATUS_INTERNAL, "a task of %zu bytes is larger than a message may be",
                                    task.size));
    return NULL;
  }

  job = farm_job_new(0, task.bytes, task.size);
  if (!job || !farm_job_table_add(&m->table, job)) {
    free(job);
    farm_manage_fail(m, status_fail(m->error, STATUS_MEMORY, "no memory for a task of %zu bytes", task.size));
    return NULL;
  }
  job->id = task.id;
  return job;
}

void farm_manage_send(struct manager *m) {
  while (!m->draining) {
    const int rank = least_loaded(m);
    if (rank < 0)
      return;
    struct farm_job *job = next_job(m);
    if (!job)
      return;
    assign(m, rank, job);
  }
}

/* ---- taking back: for idle slots at the end, and when the farm stops ---- */

void farm_manage_send_back(struct manager *m, struct farm_job *job) {
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
    farm_manage_send_back(m, job);
}

static void drop_returned(struct manager *m) {
  for (struct farm_job *job; (job = farm_job_pop(&m->returned)); free(job))
    farm_job_table_remove(&m->table, job->handle);
}

/* The rank with the most waiting jobs per slot, or -1. Very short jobs are not worth the messages. */
static int most_loaded(const struct manager *m) {
  int best = -1;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank];
    if (peer->lost || peer->slots <= 0 || peer->out <= (size_t)peer->slots || peer->recalling ||
        peer->mean_wall_s <= 1e-3)
      continue;
    const struct farm_peer *other = best < 0 ? NULL : &m->farm->peers[best];
    if (!other || peer->out * (size_t)other->slots > other->out * (size_t)peer->slots)
      best = rank;
  }
  return best;
}

static size_t idle_slots(const struct manager *m) {
  size_t idle = 0;
  for (int rank = 0; rank < m->farm->ranks; rank++) {
    const struct farm_peer *peer = &m->farm->peers[rank];
    if (!peer->lost && peer->slots > 0 && peer->out < (size_t)peer->slots)
      idle += (size_t)peer->slots - peer->out;
  }
  return idle;
}

void farm_manage_send_balance(struct manager *m) {
  if (m->draining) {
    drop_returned(m);
    return;
  }
  if (!m->dry || m->returned.first || m->farm->ranks == 1)
    return;
  const size_t idle = idle_slots(m);
  const int loaded = most_loaded(m);
  if (idle == 0 || loaded < 0)
    return;
  const struct farm_peer *peer = &m->farm->peers[loaded];
  const size_t waiting = peer->out - (size_t)peer->slots;
  recall(m, loaded, waiting < idle ? waiting : idle);
}

void farm_manage_send_recall(struct manager *m, int rank) {
  recall(m, rank, SIZE_MAX >> 1);
}

void farm_manage_send_recall_all(struct manager *m) {
  for (int rank = 0; rank < m->farm->ranks; rank++)
    farm_manage_send_recall(m, rank);
}
