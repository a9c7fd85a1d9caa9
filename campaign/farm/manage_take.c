/* Takes results, signals and other messages from the ranks and from the manager's own pool. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/farm/manage.h"
#include "schemas/clock.h"

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
  if (!m->silent)
    farm_manage_obey(m, m->calls->report(m->calls->context, &it, farm_manage_error(m)));
  m->last_ns = clock_ns();
  free(job);
}

void farm_manage_take_own(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                          const char *message, size_t message_size) {
  report(context, job, result, bytes, message, message_size);
}

/* Handles a rank that no longer answers. It is unknown which of its jobs were running: the oldest ones, as many as the
 * rank has slots, are reported as lost; the others go to other ranks. */
void farm_manage_take_loss(struct manager *m, int rank) {
  struct farm_peer *const peer = &m->farm->peers[rank];
  const struct farm_result lost = {.ending = FARM_LOST};
  char why[160];
  snprintf(why, sizeof why, "rank %d on %s has said nothing for %g s: frozen or gone", rank, peer->host,
           m->farm->options.lost_after_s);
  peer->lost = m->farm->broken = true;
  if (m->calls->stopping)
    m->calls->stopping(m->calls->context, 0);

  struct farm_job *job;
  for (int reported = 0; peer->out > 0 && (job = farm_job_table_oldest(&m->table, rank));) {
    if (reported++ < peer->slots)
      report(m, job, &lost, NULL, why, strlen(why));
    else
      farm_manage_send_back(m, job);
  }
  peer->slots = 0;
  peer->out = 0;
}

static status take_result(struct manager *m, int rank, const struct farm_frame *frame, const uint8_t *payload,
                          struct error *error) {
  struct farm_result result;
  if (frame->size < sizeof result)
    return status_fail(error, STATUS_INTERNAL, "rank %d sent a damaged result", rank);
  memcpy(&result, payload, sizeof result);
  const size_t left = frame->size - sizeof result;
  if (result.size > left)
    return status_fail(error, STATUS_INTERNAL, "rank %d sent a damaged result", rank);

  const uint8_t *bytes = payload + sizeof result;
  struct farm_job *job = farm_job_table_find(&m->table, frame->handle);
  if (job && job->rank == rank)
    report(m, job, &result, bytes, (const char *)bytes + result.size, left - result.size);
  return STATUS_OK;
}

/* The rank tells how many slots it has left. */
static void take_alive(struct manager *m, int rank, int slots) {
  struct farm_peer *const peer = &m->farm->peers[rank];
  if (slots >= peer->slots)
    return;
  if (slots == 0)
    farm_manage_send_recall(m, rank);
  peer->slots = slots;
}

/* Handles a stop signal that another rank received. If the whole group was signalled, this rank receives it as well. */
static void take_signal(struct manager *m, int rank, int number) {
  if (m->draining)
    return;
  if (m->calls->stopping)
    m->calls->stopping(m->calls->context, number);
  status_fail(m->error, STATUS_STOPPED, "rank %d got signal %d (%s): stopped; the same command resumes", rank, number,
              strsignal(number));
  farm_manage_stop(m, number);
}

status farm_manage_take(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                        struct error *error) {
  struct manager *m = context;
  struct farm_peer *const peer = &m->farm->peers[rank];
  peer->heard_ns = clock_ns();
  if (peer->lost)
    return STATUS_OK;
  switch (frame->kind) {
  case FARM_FRAME_RESULT: return take_result(m, rank, frame, payload, error);
  case FARM_FRAME_RETURNED: {
    struct farm_job *job = farm_job_table_find(&m->table, frame->handle);
    if (job && job->rank == rank)
      farm_manage_send_back(m, job);
    return STATUS_OK;
  }
  case FARM_FRAME_RECALLED: peer->recalling = false; return STATUS_OK;
  case FARM_FRAME_ALIVE: take_alive(m, rank, (int)frame->handle); return STATUS_OK;
  case FARM_FRAME_SIGNAL: take_signal(m, rank, (int)frame->handle); return STATUS_OK;
  case FARM_FRAME_BYE:
    peer->bye = true;
    if (frame->size == sizeof peer->cpu_s)
      memcpy(&peer->cpu_s, payload, sizeof peer->cpu_s);
    return STATUS_OK;
  default: return status_fail(error, STATUS_INTERNAL, "rank %d sent a message of unknown kind %d", rank, frame->kind);
  }
}
