/* The farm: tasks (byte strings) out, results (byte strings) back, over slots on this machine and over MPI ranks.
 * It knows nothing of physics, scenes or stores, so that it can be tested and timed with synthetic tasks.
 *
 * There is one pool of slots everywhere. farm_start() forks a fork server before MPI_Init, any thread and HDF5. The
 * server forks the slots. A slot forks one child per run (isolated), or computes the run itself (in process, for very
 * short runs). `-j N` alone drives N slots; under mpirun or srun every rank is such a pool, and MPI links the pools to
 * rank 0. Messages and code are the same in both cases. No process busy-waits.
 *
 * Measured by bench_farm on two cores shared with other work (400 tasks, lognormal, mean 50 ms), as a share of the
 * time that the kernel gave: 0.975-0.982 in process, 0.954-0.975 isolated, 0.992-0.997 at a mean of 1 s with the most
 * expensive first. Empty runs without a store: 640 000-970 000/s in process, 3 200-4 000/s isolated, because a fork
 * costs half a millisecond of a slot. So isolated is the default, and in process is better for runs below some 10 ms.
 */
#ifndef CLAST_CAMPAIGN_FARM_FARM_H
#define CLAST_CAMPAIGN_FARM_FARM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* Computes one task in a slot or its child: task bytes in, malloc'd result bytes out. Neither MPI nor the store is open
 * here. A status other than STATUS_OK, with *error filled, is an attempt that failed in order (reason "exit"). */
typedef status (*farm_work)(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size,
                            struct error *error);

struct farm_options {
  int slots;           /* per rank; 0: one per core that this process may use (under MPI: one) */
  bool in_process;     /* runs are computed in the slot's process: no fork per run, but a crash ends the slot as well */
  double time_limit_s; /* wall time of an attempt, 0: none. Then SIGKILL */
  size_t memory_limit; /* bytes of an attempt beyond those of the slot (RLIMIT_AS), 0: none */
  bool use_mpi;        /* decided by farm_under_mpi() */
  /* Zero means the default in all of these. */
  double grace_s; /* time that running tasks get after SIGINT, SIGTERM or SIGHUP; 2, under MPI 0.5, because mpirun kills
                     after 1 */
  double drain_s; /* the same after SIGUSR1, which a batch system sends early, and after report() returned
                     STATUS_STOPPED; 120 */
  double lost_after_s; /* a rank is lost when it has sent nothing for so long (it sends something every 2 s); 60 */
};

struct farm;

/* True when started by mpirun, srun or another PMI launcher, with any number of ranks. Looks at the environment only.
 */
bool farm_under_mpi(void);

/* How many programs the launcher says it started side by side; 1: one, or it says nothing. Looks at the environment
 * only.
 */
int farm_launched(void);

/* Forks the server and the slots. STATUS_USAGE when the launcher started several programs that MPI does not connect.
 * Every rank calls it, before MPI_Init, any thread and HDF5. */
status farm_start(const struct farm_options *options, farm_work work, struct farm **out, struct error *error);
int farm_rank(const struct farm *farm); /* 0 = manager */
int farm_ranks(const struct farm *farm);
int farm_slots_total(const struct farm *farm); /* over all ranks */

/* FARM_LOST says nothing about the task: a signal from outside ended it, a rank or slot went away, or the machine had
 * no memory, process or disk for it. Tasks ignore SIGINT, SIGTERM, SIGHUP and SIGUSR1, which a terminal or batch system
 * sends to the whole process group: the manager decides what these mean. */
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
  /* Gives the next task (true), or says that there is none at the moment (false). The farm asks again after every
   * report. */
  bool (*next)(void *context, struct farm_task *task);
  /* A task has ended. Called exactly once per task; not for tasks that were taken back, unbegun, because the farm
   * stops. STATUS_OK goes on. STATUS_STOPPED drains: no new tasks go out, and running ones have drain_s to finish and
   * are reported. Any other status ends the farm at once, without further reports. */
  status (*report)(void *context, const struct farm_report *report, struct error *error);
  /* Every 100 ms at most, also while nothing happens: for a progress line and store_tick. `running`: tasks on slots. */
  status (*tick)(void *context, int running, struct error *error);
  /* The first stop signal has come, or the launcher or a rank has died. Commit at once: mpirun may kill in a second.
   * Reports of tasks that still finish in time follow. May be NULL. */
  void (*stopping)(void *context, int signal_number);
  /* For a manager that takes orders from outside: a file that is readable when there may be some. Then tick() is called
   * at once, and next() is asked again. The farm goes on while there is no task, until a signal or a status ends it.
   * 0: there are no orders, and the farm ends when next() gives nothing and no task is out. */
  int orders;
};

/* Runs until next() gives nothing and no task is out. Rank 0 manages; the others serve until it ends them, and return
 * its final status. After the first SIGINT, SIGTERM, SIGHUP or SIGUSR1 no new tasks go out, running ones get a while to
 * finish, and the status is STATUS_STOPPED. A second signal ends the farm at once. */
status farm_run(struct farm *farm, const struct farm_manager *manager, struct error *error);

/* Utilisation of the last farm_run: sum of task CPU over slots x wall from first dispatch to last report. */
struct farm_usage {
  double task_cpu_s, wall_s, manager_cpu_s, waiting_cpu_s, start_up_s;
  int64_t tasks;
};
struct farm_usage farm_usage(const struct farm *farm);

status farm_stop(struct farm *farm, struct error *error); /* ends slots and server, MPI_Finalize. NULL is fine */

#endif
