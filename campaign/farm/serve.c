/* A rank other than 0: its pool computes, its main process carries tasks and results between the pool and the manager.
 */
#include <stdlib.h>
#include <string.h>

#include "campaign/farm/private.h"
#include "schemas/clock.h"

#define ALIVE_EVERY_NS (2 * CLOCK_S)

struct server {
  struct farm *farm;
  struct error *error;
  status failed; /* error of a callback that cannot return one */
  bool ended, drop;
  status final;
  struct error final_error;
  int64_t said_ns, looked_ns;
  int64_t leave_ns; /* time at which this rank ends without the manager; 0: it does not */
  bool empty_said;
};

static void keep(struct server *server, status result) {
  if (server->failed == STATUS_OK)
    server->failed = result;
}

static void say(struct server *server, enum farm_frame_kind kind, uint64_t handle, int parts,
                const struct iovec *part) {
  keep(server, farm_link_send(server->farm->link, 0, kind, handle, parts, part, server->error));
  server->said_ns = clock_ns();
}

static void job_ended(void *context, struct farm_job *job, const struct farm_result *result, const uint8_t *bytes,
                      const char *message, size_t message_size) {
  struct server *server = context;
  say(server, FARM_FRAME_RESULT, job->handle, 3,
      (struct iovec[]){{(void *)result, sizeof *result},
                       {(void *)bytes, result->size},
                       {(void *)message, message_size}});
  free(job);
}

static status take_task(struct server *server, const struct farm_frame *frame, const uint8_t *payload,
                        struct error *error) {
  struct farm_job *job = farm_job_new(frame->handle, payload, frame->size);
  if (!job)
    return status_fail(error, STATUS_MEMORY, "no memory for a task of %zu bytes", (size_t)frame->size);
  farm_pool_submit(server->farm->pool, job);
  return STATUS_OK;
}

/* Gives back up to `most` jobs that are not begun. */
static void give_back(struct server *server, uint64_t most) {
  struct farm_job_queue back = {0};
  farm_pool_withdraw(server->farm->pool, most, &back);
  for (struct farm_job *job; (job = farm_job_pop(&back)); free(job))
    say(server, FARM_FRAME_RETURNED, job->handle, 0, NULL);
  say(server, FARM_FRAME_RECALLED, 0, 0, NULL);
}

static status take_end(struct server *server, const struct farm_frame *frame, const uint8_t *payload,
                       struct error *error) {
  struct farm_end end;
  if (frame->size < sizeof end)
    return status_fail(error, STATUS_INTERNAL, "the manager's last message is damaged");
  memcpy(&end, payload, sizeof end);
  server->ended = true;
  server->drop = end.drop != 0;
  server->final = (status)end.status;
  if (server->final != STATUS_OK)
    status_fail(&server->final_error, server->final, "%.*s", (int)(frame->size - sizeof end),
                (const char *)payload + sizeof end);
  return STATUS_OK;
}

static status take(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                   struct error *error) {
  struct server *server = context;
  (void)rank;
  switch (frame->kind) {
  case FARM_FRAME_TASK: return take_task(server, frame, payload, error);
  case FARM_FRAME_RECALL: give_back(server, frame->handle); return STATUS_OK;
  case FARM_FRAME_END: return take_end(server, frame, payload, error);
  default: return status_fail(error, STATUS_INTERNAL, "the manager sent a message of unknown kind %d", frame->kind);
  }
}

/* Passes signals on to the manager, at most every 50 ms unless a message came. True: the launcher has died and the
 * manager has not ended this rank within 2 s, so that the rank must end without it. */
static bool leave_alone(struct server *server, int64_t now, bool heard) {
  if (!heard && now - server->looked_ns <= 50 * CLOCK_MS)
    return false;
  server->looked_ns = now;
  const int number = farm_signal(server->farm);
  if (number)
    say(server, FARM_FRAME_SIGNAL, (uint64_t)number, 0, NULL);
  if (server->farm->broken && server->leave_ns == 0)
    server->leave_ns = clock_ns() + 2 * CLOCK_S;
  return server->leave_ns != 0 && clock_ns() > server->leave_ns;
}

/* Sends the heartbeat to the manager: every ALIVE_EVERY_NS, and immediately when the last slot is gone. */
static void say_alive(struct server *server, int64_t now) {
  const int slots = farm_pool_slots(server->farm->pool);
  if (now - server->said_ns <= ALIVE_EVERY_NS && (slots > 0 || server->empty_said))
    return;
  server->empty_said = slots == 0;
  say(server, FARM_FRAME_ALIVE, (uint64_t)slots, 0, NULL);
}

/* Serves until the manager ends this rank. An error is kept in server->failed. */
static void serve(struct server *server) {
  struct farm *const farm = server->farm;
  int64_t sleep_ns = FARM_SLEEP_LEAST_NS;
  while (!server->ended) {
    int count = 0;
    const bool heard = farm_pool_listen(farm->pool, farm->signals, sleep_ns);
    keep(server, farm_link_drain(farm->link, take, server, &count, server->error));
    farm_pool_dispatch(farm->pool);
    const int64_t now = clock_ns();
    if (leave_alone(server, now, heard)) {
      keep(server, status_fail(server->error, STATUS_STOPPED, "the launcher of this rank has died"));
      return;
    }
    say_alive(server, now);
    keep(server, farm_link_flush(farm->link, server->error));
    if (server->failed != STATUS_OK) {
      farm->broken = true;
      return;
    }
    sleep_ns = heard || count > 0 ? FARM_SLEEP_LEAST_NS : farm_sleep_longer(sleep_ns);
  }
}

status farm_serve(struct farm *farm, struct error *error) {
  struct server server = {.farm = farm, .error = error, .said_ns = clock_ns()};
  const double cpu = clock_cpu_s();
  farm_pool_sink_to(farm->pool, (struct farm_pool_sink){&server, job_ended});
  serve(&server);
  if (!server.ended || server.failed != STATUS_OK)
    return server.failed;
  if (server.drop) {
    farm_pool_end(farm->pool);
    farm->pool = NULL;
  }
  const double used = clock_cpu_s() - cpu;
  farm->usage.waiting_cpu_s = used;
  say(&server, FARM_FRAME_BYE, 0, 1, &(struct iovec){(void *)&used, sizeof used});
  keep(&server, farm_link_flush(farm->link, error));
  if (server.failed != STATUS_OK)
    return server.failed;
  if (server.final != STATUS_OK && error)
    *error = server.final_error;
  return server.final;
}
