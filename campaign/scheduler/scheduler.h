/* Computes many runs: asks a planner for the next run, sends it to a slot of the farm, stores what comes back as rows,
 * and tells the planner how the run ended. A planner knows which runs are wanted and nothing of slots, attempts or
 * rows. These are planners:
 *
 *     a campaign   chooses among the replicates of its points: driver_run()
 *     a series     campaigns one after another, each depends on the results before: driver_run_series(). A study of
 *                  convergence (converge/) and a fit (fit/) are series. So is whatever else looks for something by
 *                  runs: it gives the next campaign and reads its results, and nothing more
 *     a server     runs that requests ask for: serve/
 *
 *     farm_start(&farm_options, run_work, &farm, &error);     // before HDF5, threads, MPI
 *     scheduler_compute(&planner, farm, &options, &error);    // every rank; only rank 0 opens the store
 *     farm_stop(farm);
 *
 * Each run has an identity, so that nothing is computed twice: a planner looks its runs up in the store first. */
#pragma once

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
  double started; /* s, clock_s(); NaN: it waits behind another run of its slot */
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

/* Makes an input in which campaigns of a store differ a varied input of the store. People see angles in degrees. */
status scheduler_show_input(struct store *store, const struct field *row, struct error *error);
/* Does the input follow from the others in a stored scene (JSON)? False also for a scene that no longer reads. */
bool scheduler_follows(const char *scene_json, const struct field *row);

/* The parts of scheduler_compute, for tests that take the farm's place. */
struct farm_manager scheduler_manager(struct scheduler *scheduler);
/* After the farm has ended with `code`: the last tick, and commits the open batch. Returns the status to go on with,
 * which may be an error that no tick has passed on yet. The store stays open. */
status scheduler_end(struct scheduler *scheduler, status code, struct error *error);

/* ---- campaigns as planners ----
 *
 * A campaign is asked for runs until every point has its replicates. A point's statistics use a fixed prefix of
 * replicate numbers 0..n-1. With `seeds: until` the prefix grows batch by batch and the decision looks at complete
 * prefixes only, never at "the first n that finished" (which is biased towards quick runs). Idle slots compute runs
 * beyond the prefix; these are stored with surplus = 1 and counted only if the prefix grows to include them. */

struct driver_summary {
  int64_t campaign_id, session_id;
  uint64_t points, points_done;   /* different points; points whose replicates are complete */
  uint64_t points_invalid;        /* points with invalid combinations of values: no runs, counted as failures */
  int64_t runs_reused, runs_done; /* found in the store; computed now */
  int64_t runs_failed;            /* all attempts failed, or the run ended in a failed state; includes reused runs */
  int64_t runs_left;       /* the machine ended limits.attempts attempts: the same command tries these runs again */
  int64_t runs_warned;     /* that count, and break a condition: as `clast status` tells it */
  int64_t runs_doubtful;   /* of these, whose words mark the main quantity */
  int64_t runs_censored;   /* ended at the hard end time: usable, but fragmentation may be incomplete */
  int64_t runs_surplus;    /* in the store, but left out of statistics */
  int64_t runs_excluded;   /* by a person: for a rule, runs without a value */
  int64_t fields_written;  /* HDF5 files kept */
  int64_t attempts_failed; /* attempts that failed in this invocation */
  uint64_t points_interval_met, points_cap_reached; /* with `until` */
  uint64_t points_equal;    /* of those that met it: a share whose runs are equal, with a wider bound in tables */
  int64_t widest_point;     /* of those that reached the cap, the one that needs the most runs, and how many (0: not */
  double widest_half_width; /* known); its 95 % half width as in tables (NaN: none) and its mean */
  double widest_mean;
  size_t widest_runs;
  double cpu_s; /* processor time of the runs computed now */
};

/* Computes a campaign; every rank calls it. STATUS_OK; STATUS_FAILED_RUNS: finished with failed runs, or stopped
 * because too many of the first failed; STATUS_STOPPED also when runs were lost to the machine: the same command
 * resumes; and the statuses of scheduler_compute. *summary is filled in every case, with zero on ranks other than 0. */
status driver_run(const struct campaign *campaign, struct farm *farm, const struct scheduler_options *options,
                  struct driver_summary *summary, struct error *error);

/* Campaigns one after the other, where each depends on earlier results: the levels of a study, the rounds of a fit.
 * Each is an ordinary campaign of the store. Stored runs are not computed again, so that a stopped series goes on where
 * it was. */
struct series {
  void *context;
  const struct campaign *limits; /* those of every campaign of the series */
  /* Gives the next campaign in *campaign, which the series then owns. It stays NULL when there is none. The scheduler
   * tells the store and the number of slots. */
  status (*next)(void *context, const struct scheduler *scheduler, struct campaign **campaign, struct error *error);
  /* All runs of the campaign are in the store, committed. */
  status (*done)(void *context, const struct scheduler *scheduler, struct error *error);
  /* Ends the campaign under way without its other runs, when it returns true. NULL: every run is wanted. */
  bool (*is_enough)(void *context);
};

struct series_summary {
  int64_t runs_done, runs_failed, runs_reused; /* each failed one once */
  int64_t session_id;                          /* of its first campaign; 0: none began */
  double cpu_s;
};

/* Every rank calls it; only rank 0 calls the callbacks. STATUS_STOPPED after a signal, STATUS_FAILED_RUNS when too many
 * of a campaign's first runs failed (limits.failures); *error says which. Single failed runs are no error: they have no
 * result when `done` is called. */
status driver_run_series(const struct series *series, struct farm *farm, const struct scheduler_options *options,
                         struct series_summary *summary, struct error *error);

/* A campaign of a series: a list of `points` points of a scene, with the seeds, limits and store of `like`. It has
 * `axes` axes, whose rows and levels the caller sets; then driver_list_end() writes its document. The caller frees it,
 * also after an error. */
status driver_list_begin(const struct campaign *like, const struct scene *scene, size_t axes, size_t points,
                         struct campaign **out, struct error *error);
status driver_list_end(struct campaign *campaign, const char *scene_reference, const char *comment,
                       struct error *error);
/* Writes the scene of the campaign at `path` as it is called from the current folder. */
void driver_list_reference(const struct campaign *campaign, const char *path, char *reference, size_t size);

/* The parts of driver_run, for tests that take the farm's place. */
struct driver;
struct driver *driver_new(const struct campaign *campaign);          /* borrows the campaign; never NULL */
struct scheduler_planner driver_planner(struct driver *driver);      /* context: the driver */
struct driver_summary driver_summarise(const struct driver *driver); /* so far */
void driver_free(struct driver *driver);                             /* NULL is fine */

/* ---- what a campaign will cost ----
 *
 * Predicts runs and cost of a campaign. Stores nothing. Times come from trial runs of up to 5 s in all: of the most
 * expensive sampled point, of a coarse version of it that runs to its end, and of other points. */

struct plan_options {
  const char *store_path; /* NULL: the campaign's */
  bool no_trial;
  double trial_s; /* 0 = 5 s */
  int slots;      /* for the wall time */
  bool all;       /* the model with its reasons and sources */
};

struct plan {
  uint64_t points, points_looked_at; /* costs are averaged over the sampled points (at most 4096) */
  uint64_t runs_least, runs_most;    /* differ with `until` */
  uint64_t runs_there;               /* of the sampled points, already in the store */
  uint64_t points_ended;             /* with `until`, by the runs in the store: met the rule, or ended at seeds.max */
  const char *store;                 /* path; borrowed from the campaign or the options */
  char costliest[512];               /* the point of `model`, as people read it; "": there is one point */
  bool store_exists;
  bool trial_made, trial_finished; /* finished: the trial is a whole run, not an extrapolation */
  bool trial_whole; /* times are of whole runs, measured or estimated from a coarse run; else upper bounds */
  double run_s_mean,
      run_s_most; /* per run; NaN without trial and without finished runs. An upper bound unless finished */
  double cpu_s_least, cpu_s_most;   /* processor time of the remaining runs */
  double wall_s_least, wall_s_most; /* wall time of the remaining runs on the slots */
  double threads;      /* threads that share the work of a run of the most expensive point; 1 without trial */
  double memory_most;  /* largest memory of one run, bytes */
  double disk_bytes;   /* growth of the store by runs_most runs; NaN without trial */
  double fields_bytes; /* size of the HDF5 files to keep; NaN when not known */
  char *model;         /* owned: kind->describe() of the sampled point */
  char *alternatives;  /* owned: JSON array of the settings that an accuracy was chosen from, or NULL */
};

status plan_make(const struct campaign *campaign, const struct plan_options *options, struct plan *plan,
                 struct error *error);
void plan_clear(struct plan *plan);
/* Prints the plan on standard output, for people or as JSON. */
status plan_show(const struct campaign *campaign, const struct plan *plan, int slots, bool json, struct error *error);
char *plan_print_json(const struct campaign *campaign, const struct plan *plan, int slots); /* malloc'd */

/* ---- trials: the beginning of a run, whole runs, and coarse whole runs that tell which share of a run the beginning
 * was. All times are processor time of this process, so that other work on the machine does not count. ---- */

enum { PLAN_MARKS = 512 };

/* Progress of a run (simulated time divided by the hard end time) after numbers of steps. */
struct plan_trial {
  double prepare_s, step_s, finish_s;
  double steps;    /* made */
  double expected; /* to the hard end; NaN: not known */
  double progress; /* 0..1 at the end of the piece */
  bool finished;   /* the run ended before the time limit of the trial */
  size_t fragments;
  double mark_steps[PLAN_MARKS], mark_progress[PLAN_MARKS]; /* ascending */
  size_t marks;
};

/* Runs for at most `seconds`, on one thread. A run that cannot be prepared is an error. */
status plan_try(const struct scene *scene, uint64_t seed, double seconds, struct plan_trial *run, struct error *error);

/* Processor time (s) of a whole run, of which `piece` is the beginning. Estimated from a whole run of a coarser scene:
 * both runs are assumed to need the same share of their steps up to the same simulated time. NaN: the coarse run did
 * not reach this time. */
double plan_whole(const struct plan_trial *piece, const struct plan_trial *coarse);

/* The same without a coarse run: time up to the hard end of the run, which most runs do not reach. */
double plan_to_hard_end(const struct plan_trial *piece);

/* Points whose runs are timed: at most this many, in the middle of equal parts of the design. Is it point i of `points`
 * when so many `before` it are samples? */
enum { PLAN_SAMPLES = 8 };
bool plan_is_sample(uint64_t i, uint64_t points, size_t before);

/* Mean time of a run over points of this mean work: expensive points count by their work, also if few were timed. NaN:
 * none was timed. */
struct plan_samples {
  double seconds, work; /* sums */
  double most;          /* s */
};
double plan_mean(const struct plan_samples *samples, double mean_work);

/* Coarsens the scene by the first knob of its engine that has a step (particles, grains), so that a whole run takes
 * about `seconds`. `rate`: upper bound of processor seconds per unit of the engine's work. The caller owns *coarse;
 * NULL: there is no such scene. `setting`: value of that knob, for other points of the campaign. */
void plan_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]);
/* The same setting in another scene. NULL: it does not apply. */
struct scene *plan_coarsen_like(const struct scene *scene, const char *setting);
