/* Starts and ends the farm of one rank: pool, signals, MPI, introduction of the ranks. */
#include "campaign/farm/farm_private.h"

#include <errno.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "schemas/clock.h"
#include "schemas/memory.h"

#define HELLO_NS    (60 * CLOCK_S)
#define FINALIZE_NS (60 * CLOCK_S)

bool farm_under_mpi(void) {
  return getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMIX_RANK") || (getenv("PMI_RANK") && farm_link_knows_pmi());
}

int farm_launched(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char *size = getenv(names[i]);
    if (size && *size)
      return atoi(size);
  }
  return 1;
}

int farm_cores(void) {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

const int farm_stop_signals[FARM_STOP_SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

static status watch_signals(struct farm *farm, struct error *error) {
  sigset_t set;
  sigemptyset(&set);
  for (size_t i = 0; i < FARM_STOP_SIGNALS; i++) {
    struct sigaction now;
    if (sigaction(farm_stop_signals[i], NULL, &now) == 0 && now.sa_handler == SIG_IGN)
      continue; /* nohup, or `&` in a script */
    sigaddset(&set, farm_stop_signals[i]);
  }
  if (sigprocmask(SIG_BLOCK, &set, &farm->mask_before) != 0 ||
      (farm->signals = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK)) < 0)
    return status_fail(error, STATUS_MEMORY, "cannot watch for signals: %s", strerror(errno));
  return STATUS_OK;
}

int farm_signal(struct farm *farm) {
  struct signalfd_siginfo info;
  if (read(farm->signals, &info, sizeof info) == (ssize_t)sizeof info) {
    farm->stopped = true;
    return (int)info.ssi_signo;
  }
  if (farm->link && farm->launcher && getppid() != farm->launcher) {
    farm->launcher = 0;
    farm->broken = true;
    return SIGTERM;
  }
  return 0;
}

static status hello(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                    struct error *error) {
  struct farm *farm = context;
  struct farm_hello it;
  if (frame->kind != FARM_FRAME_HELLO || frame->size != sizeof it)
    return status_fail(error, STATUS_INTERNAL, "rank %d did not introduce itself", rank);
  memcpy(&it, payload, sizeof it);
  struct farm_peer *peer = &farm->peers[rank];
  peer->slots = peer->started_with = it.slots;
  memcpy(peer->host, it.host, sizeof peer->host);
  peer->host[sizeof peer->host - 1] = '\0';
  return STATUS_OK;
}

static status introduce(struct farm *farm, struct error *error) {
  struct farm_hello it = {.slots = farm->options.slots};
  gethostname(it.host, sizeof it.host - 1);
  farm->peers[0].slots = farm->peers[0].started_with = it.slots;
  memcpy(farm->peers[0].host, it.host, sizeof it.host);
  if (!farm->link)
    return STATUS_OK;
  if (farm->rank > 0) {
    TRY(farm_link_send(farm->link, 0, FARM_FRAME_HELLO, 0, 1, &(struct iovec){&it, sizeof it}, error));
    return farm_link_flush(farm->link, error);
  }
  const int64_t until = clock_ns() + HELLO_NS;
  for (int missing = farm->ranks - 1; missing > 0;) {
    int count;
    TRY(farm_link_drain(farm->link, hello, farm, &count, error));
    missing = 0;
    for (int rank = 1; rank < farm->ranks; rank++)
      missing += farm->peers[rank].slots == 0;
    if (missing && clock_ns() > until)
      return status_fail(error, STATUS_MEMORY, "%d of %d ranks did not start within %d s", missing, farm->ranks,
                         (int)(HELLO_NS / CLOCK_S));
    if (missing)
      nanosleep(&(struct timespec){.tv_nsec = FARM_SLEEP_LEAST_NS}, NULL);
  }
  return STATUS_OK;
}

/* Fills in what the caller left at zero. */
static status complete_options(struct farm_options *o, struct error *error) {
  if (o->slots < 0 || o->slots > 4096)
    return status_fail(error, STATUS_USAGE, "%d slots asked for: from 1 to 4096, or 0 for one per core", o->slots);
  if (o->slots == 0)
    o->slots = o->use_mpi ? 1 : farm_cores();
  if (!(o->grace_s > 0))
    o->grace_s = o->use_mpi ? 0.5 : 2;
  if (!(o->drain_s > 0))
    o->drain_s = 120;
  if (!(o->lost_after_s > 0))
    o->lost_after_s = 60;
  return STATUS_OK;
}

/* Makes the parts of the farm. After an error the caller frees those that are made. */
static status start(struct farm *farm, farm_work work, struct error *error) {
  const int launched = farm_launched();
  TRY(complete_options(&farm->options, error));
  TRY(farm_pool_start(&farm->options, work, &farm->pool, error)); /* forks: before MPI and its threads */
  TRY(watch_signals(farm, error));
  prctl(PR_SET_TIMERSLACK, 1000UL); /* or a sleep of 50 us takes 100 */
  if (farm->options.use_mpi) {
    farm->launcher = getppid();
    farm_leftovers_remove();
    TRY(farm_link_open(&farm->link, &farm->rank, &farm->ranks, error));
  }
  /* A launcher without a common PMI starts programs without a connection. All would write one store: one would work,
   * and the others' errors would hide how it ended. */
  if (farm->ranks == 1 && launched > 1)
    return status_fail(error, STATUS_USAGE,
                       "the launcher started %d programs, but MPI does not connect them. Under Slurm use `srun "
                       "--mpi=pmix`, or start one program; programs that work on stores of their own need `env -u "
                       "SLURM_STEP_NUM_TASKS -u PMI_SIZE`",
                       launched);
  TRY(memory_array(&farm->peers, (size_t)farm->ranks, sizeof *farm->peers, "the ranks", error));
  for (int rank = 0; rank < farm->ranks; rank++)
    farm->peers[rank].mean_wall_s = 1;
  return introduce(farm, error);
}

status farm_start(const struct farm_options *options, farm_work work, struct farm **out, struct error *error) {
  const int64_t begin = clock_ns();
  struct farm *farm = memory_small(1, sizeof *farm);
  *farm = (struct farm){.options = *options, .ranks = 1, .signals = -1};
  const status result = start(farm, work, error);
  if (result == STATUS_OK) {
    farm->usage.start_up_s = 1e-9 * (double)(clock_ns() - begin);
    *out = farm;
    return STATUS_OK;
  }
  if (farm->ranks == 1)
    farm_link_close(farm->link, true, 0); /* no other rank waits */
  farm->link = NULL; /* MPI stays open, so that the caller can report the error; mpirun ends the other ranks */
  farm_stop(farm);
  return result;
}

int farm_rank(const struct farm *farm) {
  return farm->rank;
}
int farm_ranks(const struct farm *farm) {
  return farm->ranks;
}

int farm_slots_total(const struct farm *farm) {
  int total = 0;
  if (farm->rank > 0)
    return farm->options.slots;
  for (int rank = 0; rank < farm->ranks; rank++)
    total += farm->peers[rank].started_with;
  return total;
}

struct farm_usage farm_usage(const struct farm *farm) {
  return farm->usage;
}

/* ---- serving ----
 * A rank other than 0: its pool computes, its main process carries tasks and results between the pool and the manager.
 */

#define ALIVE_EVERY_NS (2 * CLOCK_S)

struct server {
  struct farm *farm;
  struct error *error;
  status failed; /* error of a callback that cannot return one */
  bool ended, drop;
  status final;
  struct error final_error;
  int64_t said_ns, looked_ns;
  int64_t leave_ns; /* time at which this rank ends without the manager, as the launcher has died; 0: it does not */
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

static void job_ended(void *context, struct farm_job *job, const struct farm_ended *ended) {
  say(context, FARM_FRAME_RESULT, job->handle, 3,
      (struct iovec[]){{(void *)&ended->result, sizeof ended->result},
                       {(void *)ended->bytes, ended->result.size},
                       {(void *)ended->message, ended->message_size}});
  free(job);
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
  struct farm_job_queue back = {0};
  struct farm_job *job;
  (void)rank;
  switch (frame->kind) {
  case FARM_FRAME_TASK:
    job = farm_job_new(frame->handle, payload, frame->size);
    if (!job)
      return status_fail(error, STATUS_MEMORY, "no memory for a task of %zu bytes", (size_t)frame->size);
    farm_pool_submit(server->farm->pool, job);
    return STATUS_OK;
  case FARM_FRAME_RECALL:
    farm_pool_withdraw(server->farm->pool, frame->handle, &back);
    for (; (job = farm_job_pop(&back)); free(job))
      say(server, FARM_FRAME_RETURNED, job->handle, 0, NULL);
    say(server, FARM_FRAME_RECALLED, 0, 0, NULL);
    return STATUS_OK;
  case FARM_FRAME_END: return take_end(server, frame, payload, error);
  default: return status_fail(error, STATUS_INTERNAL, "the manager sent a message of unknown kind %d", frame->kind);
  }
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
    if (heard || now - server->looked_ns > 50 * CLOCK_MS) { /* passes signals on to the manager */
      const int number = farm_signal(farm);
      if (number)
        say(server, FARM_FRAME_SIGNAL, (uint64_t)number, 0, NULL);
      server->looked_ns = now;
    }
    if (farm->broken && server->leave_ns == 0)
      server->leave_ns = now + 2 * CLOCK_S;
    if (server->leave_ns != 0 && now > server->leave_ns) {
      keep(server, status_fail(server->error, STATUS_STOPPED, "the launcher of this rank has died"));
      return;
    }
    /* The heartbeat. The manager hears at once that the last slot is gone. */
    const int slots = farm_pool_slots(farm->pool);
    if (now - server->said_ns > ALIVE_EVERY_NS || (slots == 0 && !server->empty_said)) {
      server->empty_said = slots == 0;
      say(server, FARM_FRAME_ALIVE, (uint64_t)slots, 0, NULL);
    }
    keep(server, farm_link_flush(farm->link, server->error));
    if (server->failed != STATUS_OK) {
      farm->broken = true;
      return;
    }
    sleep_ns = heard || count > 0 ? FARM_SLEEP_LEAST_NS : farm_sleep_longer(sleep_ns);
  }
}

static status serve_rank(struct farm *farm, struct error *error) {
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

/* ---- running and ending ---- */

status farm_run(struct farm *farm, const struct farm_manager *manager, struct error *error) {
  if (!farm->pool)
    return farm->last = status_fail(error, STATUS_STOPPED, "the farm was stopped and has no slots left");
  return farm->last = farm->rank == 0 ? farm_manage(farm, manager, error) : serve_rank(farm, error);
}

static status finalize(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                       struct error *error) {
  (void)rank;
  (void)payload;
  (void)error;
  if (frame->kind == FARM_FRAME_FINALIZE)
    *(bool *)context = true;
  return STATUS_OK;
}

/* MPI_Finalize uses processor time while it waits for other ranks. So the ranks first sleep here, because the manager
 * may have a store to close. */
static bool agree_to_finalize(struct farm *farm) {
  int count;
  if (farm->broken)
    return false;
  if (farm->rank == 0) {
    for (int rank = 1; rank < farm->ranks; rank++)
      if (farm_link_send(farm->link, rank, FARM_FRAME_FINALIZE, 0, 0, NULL, NULL) != STATUS_OK)
        return false;
    return farm_link_flush(farm->link, NULL) == STATUS_OK;
  }
  const int64_t until = clock_ns() + FINALIZE_NS * 10;
  int64_t sleep_ns = FARM_SLEEP_LEAST_NS;
  for (bool now = false; !now;) {
    if (farm_link_drain(farm->link, finalize, &now, &count, NULL) != STATUS_OK)
      return false;
    farm_signal(farm);
    if (farm->broken || clock_ns() > until)
      return false;
    if (!now)
      nanosleep(&(struct timespec){.tv_nsec = sleep_ns}, NULL);
    sleep_ns = farm_sleep_longer(sleep_ns);
  }
  return true;
}

void farm_stop(struct farm *farm) {
  if (!farm)
    return;
  farm_pool_end(farm->pool);
  if (farm->link)
    farm_link_close(farm->link, agree_to_finalize(farm), farm->last);
  if (farm->signals >= 0) {
    close(farm->signals);
    if (!farm->stopped) /* after a stop the program ends, and another signal must not change its exit code */
      sigprocmask(SIG_SETMASK, &farm->mask_before, NULL);
  }
  free(farm->peers);
  free(farm);
}
