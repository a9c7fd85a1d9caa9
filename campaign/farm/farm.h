/* The farm: tasks (byte strings) out, results (byte strings) back, over slots on this machine and over MPI ranks.
 * It knows nothing of physics, scenes or stores, so that it can be tested and timed with synthetic tasks.
 *
 * One slot pool everywhere (design: joint 4): farm_start() forks a fork server before MPI_Init, any thread and HDF5;
 * the server forks slots; a slot forks one child per run (isolated) or computes itself (in process, for very short
 * runs). `-j N` alone drives N slots; under mpirun/srun every rank is such a pool and MPI links the pools to rank 0.
 * One protocol, one code path. Nobody busy-waits.
 *
 * Measured by bench_farm on two cores shared with other work (400 tasks, lognormal, mean 50 ms), of the time the kernel
 * gave: 0.975-0.982 in process, 0.954-0.975 isolated, 0.992-0.997 at mean 1 s dearest first. No-op runs without a
 * store: 640 000-970 000/s in process, 3 200-4 000/s isolated: a fork costs half a millisecond of a slot. So isolated
 * is the default, and in process pays for runs below some 10 ms. */
#ifndef CLAST_CAMPAIGN_FARM_FARM_H
#define CLAST_CAMPAIGN_FARM_FARM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Runs in a slot or its child: task bytes in, malloc'd result bytes out. Called with nothing of MPI or the store open.
 * A non-zero status with *error filled is an attempt that failed in an orderly way (reason "exit"). */
typedef status (*farm_work)(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size,
                            struct error *error);

struct farm_options {
  int slots;           /* per rank; 0 = one per core this process may use (1 under MPI) */
  bool in_process;     /* slots compute themselves: no fork per run, a crash costs the slot's current run */
  double time_limit_s; /* wall time per attempt, 0 = none; SIGTERM then SIGKILL */
  size_t memory_limit; /* bytes per attempt (RLIMIT_AS over the base), 0 = none */
  bool use_mpi;        /* decided by farm_under_mpi() */
  /* Zero means the default in all of these. */
  double
      grace_s; /* after SIGINT, SIGTERM, SIGHUP: running tasks get this long; 2, under MPI 0.5 (mpirun kills after 1) */
  double drain_s; /* the same after SIGUSR1, the batch system's early warning, and after report() said STOPPED; 120 */
  double lost_after_s; /* a rank silent this long is lost (each says something every 2 s); 60 */
};

struct farm;

/* True when started by mpirun, srun or another PMI launcher with more than... any number of ranks (environment only).
 */
bool farm_under_mpi(void);

/* Must be the first thing a computing process does: before MPI_Init, threads and HDF5. Forks the server and the slots.
 * Every rank calls it. */
status farm_start(const struct farm_options *options, farm_work work, struct farm **out, struct error *error);
int farm_rank(const struct farm *farm); /* 0 = manager */
int farm_ranks(const struct farm *farm);
int farm_slots_total(const struct farm *farm); /* over all ranks */

enum farm_ending { FARM_DONE, FARM_FAILED, FARM_TIME_LIMIT, FARM_MEMORY_LIMIT, FARM_CRASHED, FARM_LOST };

struct farm_task {
  uint64_t id;          /* the caller's */
  const uint8_t *bytes; /* copied by the farm when it takes the task */
  size_t size;
};

struct farm_report {
  uint64_t id;
  enum farm_ending ending;
  const uint8_t *bytes; /* result, borrowed for the call */
  size_t size;
  int exit_code, signal;
  double wall_s, cpu_s;
  int64_t peak_memory;
  int rank, slot;
  const char *host;
  const char *message; /* what happened, for every ending but FARM_DONE ("" there) */
};

/* The manager's callbacks, called from farm_run on rank 0 only. */
struct farm_manager {
  void *context;
  /* Give the next task (true) or none at the moment (false). The farm asks again after every report. */
  bool (*next)(void *context, struct farm_task *task);
  /* A task ended, one way or another: exactly once per task, but for tasks taken back because the farm stops (they were
   * not run). STATUS_OK goes on. STATUS_STOPPED drains: no new tasks, running ones finish within drain_s and are
   * reported. Anything else ends the farm at once with that status and no more reports. */
  status (*report)(void *context, const struct farm_report *report, struct error *error);
  /* At most every 100 ms, also while nothing happens: progress, store_tick. running/waiting: tasks out on slots. */
  status (*tick)(void *context, int running, struct error *error);
  /* The first stop signal has come (or the launcher or a rank has died): commit at once, mpirun may kill in a second.
   * Before any grace; may be NULL. Reports of tasks that still finish in time follow. */
  void (*stopping)(void *context, int signal_number);
};

/* Runs until next() gives nothing and nothing is out. Rank 0 manages; the others serve until told to stop and return
 * the manager's final status. First SIGINT/SIGTERM (SIGUSR1 too): no new tasks, what runs is finished if quick (grace)
 * or dropped, STATUS_STOPPED. Second: at once. */
status farm_run(struct farm *farm, const struct farm_manager *manager, struct error *error);

/* Utilisation of the last farm_run: sum of task CPU over slots x wall from first dispatch to last report. */
struct farm_usage {
  double task_cpu_s, wall_s, manager_cpu_s, waiting_cpu_s, start_up_s;
  int64_t tasks;
};
struct farm_usage farm_usage(const struct farm *farm);

status farm_stop(struct farm *farm, struct error *error); /* ends slots and server, MPI_Finalize. NULL is fine */

#endif
