/* What the files of the farm share: frames, jobs, slots, the fork server, the pool of a rank, the link between ranks.
 */
#pragma once

#include <signal.h>
#include <stdatomic.h>
#include <sys/types.h>
#include <sys/uio.h>

#include "campaign/farm/farm.h"

/* The message format between manager, slots, children (pipes and sockets) and ranks (MPI).
 *
 * A frame is a 32-byte head and a payload padded to 16 bytes, so that payloads stay aligned in a buffer of frames. The
 * head's magic number holds the version. The check covers head and payload, so that a damaged or foreign frame is
 * reported and never crashes the program. Byte order is the machine's: all ranks run the same program on the same kind
 * of machine. */

/* "CLF1"; the digit is the version: raise it when any payload changes. */
#define FARM_FRAME_MAGIC UINT32_C(0x31464c43)
/* Most bytes of payload, because MPI counts are int. A larger size means a damaged frame. */
#define FARM_FRAME_LARGEST ((size_t)1 << 30)

enum farm_frame_kind {
  FARM_FRAME_TASK = 1, /* manager -> slot or rank: the task's bytes */
  FARM_FRAME_RESULT,   /* slot or rank -> manager: struct farm_result, result bytes, message */
  FARM_FRAME_ANSWER,   /* child -> its slot: int64 status, result bytes or message */
  FARM_FRAME_HELLO,    /* rank -> manager: struct farm_hello */
  FARM_FRAME_ALIVE,    /* rank -> manager: heartbeat; handle = slots alive */
  FARM_FRAME_SIGNAL,   /* rank -> manager: handle = signal number */
  FARM_FRAME_RECALL,   /* manager -> rank: give back up to `handle` tasks that have not begun */
  FARM_FRAME_RETURNED, /* rank -> manager: this task had not begun and is given back */
  FARM_FRAME_RECALLED, /* rank -> manager: the recall is answered */
  FARM_FRAME_END,      /* manager -> rank: struct farm_end, message */
  FARM_FRAME_BYE,      /* rank -> manager: double, CPU seconds of the rank's main process in this run */
  FARM_FRAME_FINALIZE, /* manager -> rank: call MPI_Finalize now */
};

struct farm_frame {
  uint32_t magic;
  uint16_t kind, ticket; /* ticket: see struct farm_slot_record */
  uint64_t handle;       /* identifies the task; other meanings above */
  uint64_t size;         /* of the payload without padding */
  uint64_t check;
};

/* Head of a RESULT payload; `size` result bytes follow, then the message. */
struct farm_result {
  int32_t ending, exit_code, signal, slot;
  double wall_s, cpu_s;
  int64_t peak_memory;
  uint64_t size;
};

/* How a job ended: the parts of a RESULT payload. */
struct farm_ended {
  struct farm_result result;
  const uint8_t *bytes; /* result.size of them; all pointers are borrowed */
  const char *message;
  size_t message_size;
};

/* A growing byte queue. data[begin..end) is its content; `begin` moves by whole frames, so that it stays aligned. */
struct farm_bytes {
  uint8_t *data;
  size_t begin, end, capacity;
};

/* Makes space for `more` bytes at data+end. May move the content. False when memory is refused; nothing has changed
 * then. */
bool farm_frame_reserve(struct farm_bytes *bytes, size_t more);
void farm_frame_free(struct farm_bytes *bytes); /* leaves the queue empty and ready for use */
/* For an empty queue: keeps a small buffer for the next use and frees a large one. */
void farm_frame_trim(struct farm_bytes *bytes);

/* Appends a frame. Its payload is the parts one after the other. False when memory is refused or the payload is too
 * large. */
bool farm_frame_append(struct farm_bytes *bytes, enum farm_frame_kind kind, uint16_t ticket, uint64_t handle, int parts,
                       const struct iovec *part);
/* Takes the first frame out of the queue. 1: found; its payload is borrowed until the next reserve or append. 0: the
 * frame is incomplete. -1: damaged. */
int farm_frame_next(struct farm_bytes *bytes, struct farm_frame *frame, const uint8_t **payload);
/* Finds the parts of a RESULT frame. False: it is damaged, or another frame. */
bool farm_frame_result(const struct farm_frame *frame, const uint8_t *payload, struct farm_ended *ended);
/* Bytes to reserve before reading: the missing bytes of the first, incomplete frame, at least `minimum`. */
size_t farm_frame_missing(const struct farm_bytes *bytes, size_t minimum);

/* ---- A task on its way: the manager's own record of it, or a rank's copy ---- */

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct farm_job {
  struct farm_job *prev, *next; /* in the same queue (utlist) */
  uint64_t handle;              /* set by the farm, never used twice */
  uint64_t id;                  /* the caller's number of the task */
  int rank;                     /* rank that it was sent to (manager only) */
  uint16_t ticket;              /* while it is in a slot */
  UT_hash_handle hh;            /* in the manager's table */
  size_t size;
  _Alignas(16) uint8_t bytes[];
};

/* NULL when memory is refused. Freed by free(). */
struct farm_job *farm_job_new(uint64_t handle, const uint8_t *bytes, size_t size);

struct farm_job_queue {
  struct farm_job *first; /* first->prev is the last one */
  size_t count;
};
void farm_job_push(struct farm_job_queue *queue, struct farm_job *job);
void farm_job_push_front(struct farm_job_queue *queue, struct farm_job *job);
struct farm_job *farm_job_pop(struct farm_job_queue *queue); /* NULL when empty */
/* Takes out the job with this handle; NULL: there is none. Searches from the front, because slots answer in order. */
struct farm_job *farm_job_take(struct farm_job_queue *queue, uint64_t handle);
void farm_job_clear(struct farm_job_queue *queue);

/* The manager's table of the jobs that are out, by handle. */
struct farm_job_table {
  struct farm_job *jobs; /* uthash, in order of addition */
  size_t count;
  uint64_t last_handle; /* handles count from 1: no handle is 0, which means "none" in a slot's record */
};
bool farm_job_table_add(struct farm_job_table *table, struct farm_job *job); /* sets job->handle; false: no memory */
struct farm_job *farm_job_table_find(const struct farm_job_table *table, uint64_t handle);
void farm_job_table_remove(struct farm_job_table *table, uint64_t handle); /* does not free the job */
/* The oldest job that was sent to this rank, or NULL. */
struct farm_job *farm_job_table_oldest(const struct farm_job_table *table, int rank);
void farm_job_table_free(struct farm_job_table *table); /* frees the jobs too */

/* A slot: a process that takes tasks from its channel and gives results back, one at a time.
 *
 * Tasks may be sent before the slot is free, and can still be taken back: each sent task has a ticket in memory shared
 * with the main process. The process that swaps the ticket out owns the task: the slot runs it, or the main process
 * gives it to an idle slot. So the last tasks of a campaign never wait behind a long one. */

#define FARM_SLOT_TICKETS 64

struct farm_slot_record {
  _Atomic uint64_t running;                   /* handle of the running task, 0 = none; a crash is counted for it */
  _Atomic int64_t started_ns;                 /* start time of `running` */
  _Atomic uint64_t ticket[FARM_SLOT_TICKETS]; /* handle of the waiting task, 0 = taken by either side */
};

struct farm_slot_setup {
  struct farm_options options;
  farm_work work;
  struct farm_slot_record *records; /* one per slot, shared */
};

/* Main function of a slot process whose parent is `parent`; serves until the channel closes. */
_Noreturn void farm_slot_serve(const struct farm_slot_setup *setup, int slot, int channel, pid_t parent);

/* Makes the kernel kill this process when `parent` dies. Then checks `parent`, which may have died before the call. */
void farm_slot_die_with(pid_t parent);
void farm_slot_unblock(void); /* all signals of this process */

/* Ending of a run whose process was killed by this signal. The run itself raises only the signals of a crash (SIGSEGV,
 * SIGABRT and the like). All others come from outside: from a user, a batch system, or the kernel out of memory. */
enum farm_ending farm_slot_ending_by(int signal_number);

/* The fork server: a small process without threads, MPI and HDF5 that forks slots and collects their exit status.
 *
 * It is forked first, so that slots can be replaced later, when the main process itself can no longer fork safely. It
 * acts only on requests of the main process over `control` (a SOCK_SEQPACKET pair: one message, one packet). Closing
 * `control` ends it and every slot. */

enum farm_server_verb {
  FARM_SERVER_SPAWN = 1, /* -> server: make this slot */
  FARM_SERVER_KILL,      /* -> server: SIGKILL this slot if it still has this pid */
  FARM_SERVER_SPAWNED,   /* <- server: the slot's pid, and the main process's end of its channel as SCM_RIGHTS */
  FARM_SERVER_DIED,      /* <- server: wait status; pid 0: it could not be made, value = errno */
};

struct farm_server_message {
  int32_t verb, slot, pid, value;
};

/* Forks the server; *control is the main process's end. The caller's buffered stdio is flushed first. */
status farm_server_start(const struct farm_slot_setup *setup, pid_t *server, int *control, struct error *error);
bool farm_server_ask(int control, enum farm_server_verb verb, int slot, pid_t pid);
/* Non-blocking: 1 a message (with *channel >= 0 when it brings one), 0 none now, -1 the server is gone. */
int farm_server_hear(int control, struct farm_server_message *message, int *channel);
/* Closes control, waits for the server's end (killed after 2 s). All slots are dead on return. */
void farm_server_end(pid_t server, int control);

/* The slots of one rank, for its main process: takes jobs, gives results, never blocks.
 *
 * Jobs wait in the pool's queue; each slot holds its running job and one waiting job (more if they are very short), so
 * that it need not wait for the main process. Waiting jobs are taken back when another slot is idle. */

struct farm_pool;

/* A job has ended. Called from farm_pool_listen only. The receiver owns the job and frees it; all else is borrowed. */
struct farm_pool_sink {
  void *context;
  void (*ended)(void *context, struct farm_job *job, const struct farm_ended *ended);
};

/* End *out also after an error. */
status farm_pool_start(const struct farm_options *options, farm_work work, struct farm_pool **out, struct error *error);
void farm_pool_sink_to(struct farm_pool *pool, struct farm_pool_sink sink);
void farm_pool_submit(struct farm_pool *pool, struct farm_job *job); /* owns the job until it has ended */
/* Takes back up to `most` jobs that have not begun, from the end of the queue, then from slots. */
void farm_pool_withdraw(struct farm_pool *pool, size_t most, struct farm_job_queue *into);
/* Sends waiting jobs to slots. To be called after submitting and after farm_pool_listen. */
void farm_pool_dispatch(struct farm_pool *pool);
/* Sleeps until a slot or `signals` (a file descriptor, or -1) is readable or the timeout is over, and reads what the
 * slots have written. True when something was readable. */
bool farm_pool_listen(struct farm_pool *pool, int signals, int64_t timeout_ns);
int farm_pool_slots(const struct farm_pool *pool); /* slots that work or are being replaced; 0: the pool is lost */
/* Most jobs that the pool should hold, from the recent duration of tasks. */
size_t farm_pool_capacity(const struct farm_pool *pool);
/* Ends slots and server immediately and frees everything, jobs included. NULL is fine. */
void farm_pool_end(struct farm_pool *pool);

/* Sends and receives frames between ranks by non-blocking point-to-point MPI.
 *
 * Frames to one rank are collected and leave together as one message at farm_link_flush. Sends are MPI_Isend of a
 * buffer of their own, receives MPI_Iprobe + MPI_Irecv, because a blocking call waits for ever for a dead or stopped
 * partner if the message is above the eager limit (4 kB in shared memory). Frames of one rank arrive in order. */

struct farm_link;

/* True when this MPI library can connect to a launcher that has only the older PMI-1 or PMI-2 (srun --mpi=pmi2).
 * Debian's Open MPI cannot, and its MPI_Init would end the process with a long message. */
bool farm_link_knows_pmi(void);
/* MPI_Init. Signals must be blocked before, as MPI starts threads. */
status farm_link_open(struct farm_link **out, int *rank, int *ranks, struct error *error);
/* Queues a frame for a rank. STATUS_MEMORY when memory is refused. */
status farm_link_send(struct farm_link *link, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                      const struct iovec *part, struct error *error);
status farm_link_flush(struct farm_link *link, struct error *error);
typedef status (*farm_link_take)(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                                 struct error *error);
/* Calls `take` for every frame that has arrived. *count: number of messages received and sends completed. */
status farm_link_drain(struct farm_link *link, farm_link_take take, void *context, int *count, struct error *error);
/* Calls MPI_Finalize when `together` (all ranks call it now). Else calls MPI_Abort with this exit code and does not
 * return. */
void farm_link_close(struct farm_link *link, bool together, int exit_code);

/* Open MPI's ranks on one host communicate through files in /dev/shm. Killed ranks and launchers leave their files
 * there, 4 MB of memory each, until the machine restarts. */

/* Removes the files of this user and this host that no process has mapped and that are older than a minute. */
void farm_leftovers_remove(void);

/* ---- struct farm, shared by rank.c (start, the other ranks, end) and manage.c (rank 0) ---- */

#define FARM_HOST_SIZE 64

/* An MPI message does not wake a sleeping process: check, and when no message came, sleep twice as long as before, up
 * to 5 ms. If no message comes for longer, the sleep grows to 10 ms within half a second: with 5 ms an idle rank used
 * 0.3 % of a core on a quiet machine but 0.6 % on a loaded one. The longer sleep costs nothing after such a pause. */
#define FARM_SLEEP_LEAST_NS (50 * INT64_C(1000))
#define FARM_SLEEP_USUAL_NS (5 * INT64_C(1000000))
#define FARM_SLEEP_MOST_NS  (10 * INT64_C(1000000))

static inline int64_t farm_sleep_longer(int64_t sleep_ns) {
  const int64_t longer = sleep_ns < FARM_SLEEP_USUAL_NS ? 2 * sleep_ns : sleep_ns + sleep_ns / 64;
  return longer < FARM_SLEEP_MOST_NS ? longer : FARM_SLEEP_MOST_NS;
}

struct farm_hello {
  int32_t slots;
  char host[FARM_HOST_SIZE];
};

struct farm_end {
  int64_t status, drop; /* drop: kill running tasks */
};

/* The manager's record of a rank; [0] is its own pool. */
struct farm_peer {
  int slots, started_with;
  size_t out; /* number of tasks that it has */
  double mean_wall_s;
  int64_t heard_ns;
  bool lost, recalling, bye;
  double cpu_s;
  char host[FARM_HOST_SIZE];
};

struct farm {
  struct farm_options options;
  struct farm_pool *pool; /* NULL once dropped */
  struct farm_link *link; /* NULL: no other ranks */
  int rank, ranks;
  struct farm_peer *peers; /* manager: one per rank */
  struct farm_usage usage;
  /* Stop signals, read from a file: no handler and no global is needed. */
  int signals;
  bool stopped; /* a stop signal has come */
  sigset_t mask_before;
  pid_t launcher; /* parent at the start; if it changes under MPI, mpirun has died */
  bool broken;    /* a rank is lost or does not answer: MPI_Finalize would hang */
  status last;    /* status of the last run */
};

status farm_manage(struct farm *farm, const struct farm_manager *manager, struct error *error);

/* The next stop signal that has come; 0: none. Also SIGTERM, once, when the launcher has died. */
int farm_signal(struct farm *farm);
