/* The farm sends tasks (byte strings) to slots on this machine and on MPI ranks, and returns their results (byte
 * strings). It contains no physics, scenes or stores, so that synthetic tasks can test and time it.
 *
 * Every process uses the same kind of pool of slots. farm_start() forks a fork server before MPI_Init, any thread and
 * HDF5. The server forks the slots. A slot forks one child per run (isolated), or computes the run itself (in process,
 * for very short runs). Without MPI, `-j N` uses one pool of N slots; under mpirun or srun every rank has such a pool,
 * and MPI links the pools to rank 0. Messages and code are the same in both cases. No process busy-waits.
 *
 * Measured by bench_farm on two cores shared with other work (400 tasks, lognormal, mean 50 ms), as a share of the
 * processor time that the kernel granted: 0.975-0.982 in process, 0.954-0.975 isolated, 0.992-0.997 at a mean of 1 s
 * with the most expensive first. Empty runs without a store: 640 000-970 000/s in process, 3 200-4 000/s isolated,
 * because a fork costs half a millisecond of a slot. So isolated is the default; in process is better for runs below
 * about 10 ms. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Signals that stop a farm: of a terminal, and of batch systems, some of which announce the end with SIGUSR1 (Slurm),
 * SIGUSR2 (LSF, Grid Engine) or SIGXCPU (Grid Engine, PBS). The main process watches them; the processes that it starts
 * ignore them. */
enum { FARM_STOP_SIGNALS = 6 };
extern const int farm_stop_signals[FARM_STOP_SIGNALS];

/* Computes one task in a slot or its child: task bytes in, malloc'd result bytes out. Neither MPI nor the store is open
 * here. A status other than STATUS_OK, with *error filled, is a failed attempt whose process did not crash (reason
 * "exit"). */
typedef status (*farm_work)(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size,
                            struct error *error);

/* Raises the memory limit of the task that this process computes, if it has one. farm_work calls it for address space
 * that a task takes and does not fill, such as stacks of threads. */
void farm_allow_memory(size_t bytes);

struct farm_options {
  int slots;           /* slots per rank; 0: one per core that this process may use (under MPI: one) */
  bool in_process;     /* runs are computed in the slot's process: no fork per run, but a crash ends the slot as well */
  double time_limit_s; /* limit of an attempt's wall time, after which it gets SIGKILL; 0: no limit */
  size_t memory_limit; /* limit of an attempt's memory beyond that of the slot (RLIMIT_AS), bytes; 0: no limit */
  bool use_mpi;        /* set from farm_under_mpi() */
  /* In the following members zero means the default. */
  double grace_s;      /* time that running tasks get after SIGINT, SIGTERM or SIGHUP. Default 2; under MPI 0.5, because
                          mpirun kills after 1 s */
  double drain_s;      /* the same after SIGUSR1, SIGUSR2 or SIGXCPU, which a batch system sends early, and after
                          report() returned STATUS_STOPPED. Default 120 */
  double lost_after_s; /* a rank that sends nothing for this time is lost (it sends a message every 2 s). Default 60 */
};

struct farm;

/* True when started by mpirun, srun or another PMI launcher, with any number of ranks. Looks at the environment only.
 */
bool farm_under_mpi(void);

/* Number of programs that the launcher started side by side, from the environment; 1 if the environment does not
 * tell. */
int farm_launched(void);

/* Number of cores that this process may use. */
int farm_cores(void);

/* Forks the server and the slots. STATUS_USAGE when the launcher started several programs that MPI does not connect.
 * Every rank calls it, before MPI_Init, any thread and HDF5. */
status farm_start(const struct farm_options *options, farm_work work, struct farm **out, struct error *error);
int farm_rank(const struct farm *farm); /* 0 = manager */
int farm_ranks(const struct farm *farm);
int farm_slots_total(const struct farm *farm); /* slots of all ranks */

/* FARM_LOST says nothing about the task: a signal from outside ended it, a rank or slot went away, or the machine had
 * no memory, process or disk for it. Tasks ignore the stop signals, which a terminal or batch system sends to
 * the whole process group: the manager decides what these mean. */
enum farm_ending { FARM_DONE, FARM_FAILED, FARM_TIME_LIMIT, FARM_MEMORY_LIMIT, FARM_CRASHED, FARM_LOST };

/* farm_work calls it before it returns an error: how the attempt ended, other than FARM_FAILED (a program that the task
 * ran crashed, or met a limit of its own). */
void farm_end_as(enum farm_ending ending);

struct farm_task {
  uint64_t id;          /* chosen by the caller */
  const uint8_t *bytes; /* copied by the farm when it takes the task */
  size_t size;
};

struct farm_report {
  uint64_t id;
  enum farm_ending ending;
  const uint8_t *bytes; /* result bytes, borrowed for the call */
  size_t size;
  int exit_code, signal;
  double wall_s, cpu_s;
  int64_t peak_memory;
  int rank, slot;
  const char *host;
  const char *message; /* description of every ending except FARM_DONE ("" there) */
};

/* The manager's callbacks, called from farm_run on rank 0 only. */
struct farm_manager {
  void *context;
  /* Gives the next task (true), or returns false when there is none now. The farm calls it again after every report.
   * NULL: there are no tasks. */
  bool (*next)(void *context, struct farm_task *task);
  /* A task has ended. Called exactly once per task, but not for tasks that had not begun when the farm stopped.
   * STATUS_OK: the farm goes on. STATUS_STOPPED: no new tasks start, and running ones have drain_s to finish and are
   * reported. Any other status ends the farm immediately, without further reports. */
  status (*report)(void *context, const struct farm_report *report, struct error *error);
  /* Called at most every 100 ms, also while no task ends: for a progress line and store_tick. `running`: tasks on
   * slots. */
  status (*tick)(void *context, int running, struct error *error);
  /* The first stop signal has come, or the launcher or a rank has died. Commit immediately: mpirun may kill this
   * process within a second. Reports of tasks that still finish in time follow. May be NULL. */
  void (*stopping)(void *context, int signal_number);
  /* File descriptor, readable when outside requests may be waiting. The farm then calls tick() immediately, and next()
   * again. It goes on without tasks until a signal or a status ends it. 0: no outside requests; the farm ends when
   * next() gives no task and no task is out. */
  int orders;
  /* True: reports are not yet taken in, and next() may give tasks later. NULL: never. */
  bool (*waits)(void *context);
};

/* Runs until next() gives no task and no task is out. Rank 0 manages; the other ranks serve until it ends them, and
 * return its final status. After the first stop signal no new tasks start, running ones get
 * grace_s or drain_s to finish, and the status is STATUS_STOPPED. A second signal ends the farm immediately. */
status farm_run(struct farm *farm, const struct farm_manager *manager, struct error *error);

/* Times of the last farm_run; wall_s: from the first task sent to the last report. */
struct farm_usage {
  double wall_s, manager_cpu_s, waiting_cpu_s, start_up_s;
  int64_t tasks;
};
struct farm_usage farm_usage(const struct farm *farm);

void farm_stop(struct farm *farm); /* ends slots and server, MPI_Finalize. NULL is fine */
