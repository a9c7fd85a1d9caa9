/* Computes many runs: asks a planner for the next run, sends it to a slot of the farm, stores what comes back as rows,
 * and tells the planner how the run ended. A planner knows which runs are wanted and nothing of slots, attempts or
 * rows. These are planners:
 *
 *     a campaign   chooses among the replicates of its points: driver.h
 *     a series     campaigns one after another, each depends on the results before: driver.h. A study of convergence
 *                  (converge/) and a fit (fit/) are series. So is whatever else looks for something by runs: it gives
 *                  the next campaign and reads its results, and nothing more
 *     a server     runs that requests ask for: serve/
 *
 *     farm_start(&farm_options, run_work, &farm, &error);     // before HDF5, threads, MPI
 *     scheduler_compute(&planner, farm, &options, &error);    // every rank; only rank 0 opens the store
 *     farm_stop(farm, &error);
 *
 * Each run has an identity, so that nothing is computed twice: a planner looks its runs up in the store first. */
#ifndef CLAST_CAMPAIGN_SCHEDULER_SCHEDULER_H
#define CLAST_CAMPAIGN_SCHEDULER_SCHEDULER_H

#include "campaign/document/campaign.h"
#include "campaign/farm/farm.h"
#include "campaign/scheduler/run.h"
#include "campaign/terminal/progress.h"
#include "db/ask/ask.h"

struct scheduler;

struct scheduler_run {       /* a run that a planner asks for */
  const struct scene *scene; /* borrowed until the planner is told the run's end; NULL: no run */
  int64_t point_id, session_id, replicate;
  uint64_t seed;
  bool fields; /* its fields are kept in an HDF5 file */
  bool replay; /* the store has it: it is computed again for its fields only */
  int lost;    /* attempts of this invocation that the machine ended. The scheduler counts, the planner keeps the number
                  until it asks for the run again */
  void *place; /* the planner's */

  /* By the scheduler. */
  uint8_t identity[16];
  int attempt;    /* 1.. */
  double started; /* s, clock_s() */
};

enum scheduler_ending {
  SCHEDULER_DONE,   /* it has results; those of a failed run, too */
  SCHEDULER_AGAIN,  /* the attempt has failed, others are left: the planner asks for the run again */
  SCHEDULER_FAILED, /* all attempts are used up, now or in an earlier invocation */
  SCHEDULER_LEFT,   /* the machine ended all attempts, which says nothing about the run: the next invocation tries it */
};
struct scheduler_end { /* all members are borrowed for the call */
  enum scheduler_ending ending;
  const struct farm_report *report; /* of the attempt; NULL: nothing was computed */
  const struct run_result *result;  /* NULL: none, or a replay */
  bool fields;                      /* a fields file was written */
};

struct scheduler_planner {
  void *context;
  const struct campaign *limits; /* its time and memory of an attempt, and number of attempts */
  /* The store is open: reads and announces what is wanted. */
  status (*begin)(void *context, struct scheduler *scheduler, struct error *error);
  /* Fills *run, which is all zero before. It stays so when there is no run now; the scheduler asks again after each
   * report. */
  status (*next)(void *context, struct scheduler_run *run, struct error *error);
  /* Is the result, which comes next, beyond what statistics may count? NULL: never. */
  bool (*is_surplus)(void *context, const struct scheduler_run *run);
  /* The run has ended, and its rows are in the open batch of the store. STATUS_FAILED_RUNS ends all. */
  status (*ended)(void *context, const struct scheduler_run *run, const struct scheduler_end *end, struct error *error);
  /* Called at most every 100 ms, with the number of runs on slots, and a last time. NULL: there is nothing to do. */
  void (*tick)(void *context, int running, bool last);
  /* The first signal has come; no new runs start. NULL: the scheduler notes it for the user. */
  void (*stopping)(void *context);
  /* The farm has ended with `code`, and all rows are committed. Returns the status of the whole. */
  status (*end)(void *context, status code, struct error *error);
  int orders; /* as in struct farm_manager */
};

struct scheduler_options {
  const char *store_path;
  const char *facts;                             /* JSON of provenance_json() */
  struct progress *progress;                     /* NULL: silent. Borrowed */
  void (*note)(void *context, const char *text); /* warnings and notes for a person, one line each; may be NULL */
  void *note_context;
  int slots; /* for estimates of the time left; scheduler_compute takes it from the farm */
};

struct scheduler_held;
struct scheduler { /* planners read the first members and the list of the runs that are out */
  struct scheduler_planner planner;
  struct store *store;
  struct scheduler_options options;
  struct scheduler_run *out; /* runs on slots, by the id of the farm's task; scene NULL: a free place. Owned */
  size_t places;
  uint8_t *task;      /* bytes of the last task given out. Owned */
  struct error error; /* of the planner's next(), which the farm's next() cannot return */
  struct error stop;  /* why no new runs start; results of running ones are still stored */
  /* Reports that wait while another program holds the store, and the first of their instants. */
  struct scheduler_held *held; /* utlist */
  size_t held_bytes;
  double held_since; /* s, clock_s() */
  bool held_noted;
};

/* Computes all that the planner asks for. Every rank calls it: ranks other than 0 compute runs and return the manager's
 * status. STATUS_STOPPED after a signal: the same command goes on. STATUS_IO: a fields file or the store could not be
 * written; STATUS_CONTENT from the store; what the planner returns. */
status scheduler_compute(const struct scheduler_planner *planner, struct farm *farm,
                         const struct scheduler_options *options, struct error *error);
/* For a manager that cannot begin: ends the other ranks, which wait for it, by a farm run without tasks. */
void scheduler_release_ranks(struct farm *farm);
/* Copies the campaign's time and memory limits into *options. The other options do not change. */
void scheduler_limits(const struct campaign *campaign, struct farm_options *options);

/* ---- for planners ---- */

void scheduler_note(const struct scheduler *scheduler, const char *text);
/* Opens a session and the campaign with its axes in the store. plan: JSON. */
status scheduler_announce(struct scheduler *scheduler, const struct campaign *campaign, const char *plan,
                          int64_t *session_id, int64_t *campaign_id, struct error *error);
/* The replicate of the point with this scene that has the identity of a stored run. -1: none; the run has an older
 * results_version or another seed. */
int64_t scheduler_replicate(const struct campaign *campaign, const struct scene *scene,
                            const struct ask_run_of_point *run);
/* How often attempts at the run have failed, by these limits. */
int scheduler_attempts(const struct scheduler *scheduler, const uint8_t identity[16]);

/* Pooled exponents of every point of the campaign (0: of all campaigns) that has runs and no estimates yet: writes them
 * into the store (table point_estimate, view estimates), where any tool finds them, and commits. The store drops a
 * point's estimates as soon as a run is added to the point. */
status pooling_store(struct store *store, int64_t campaign_id, struct error *error);

/* The parts of scheduler_compute, for tests that take the farm's place. */
struct farm_manager scheduler_manager(struct scheduler *scheduler);
/* After the farm has ended with `code`: the last tick, and commits the open batch. Returns the status to go on with,
 * which may be an error that no tick has passed on yet. The store stays open. */
status scheduler_end(struct scheduler *scheduler, status code, struct error *error);

#endif
