/* Campaigns as planners: one campaign, and a series of campaigns.
 *
 * A campaign is asked for runs until every point has its replicates. A point's statistics use a fixed prefix of
 * replicate numbers 0..n-1. With `seeds: until` the prefix grows batch by batch and the decision looks at complete
 * prefixes only, never at "the first n that finished" (which is biased towards quick runs). Idle slots compute runs
 * beyond the prefix; these are stored with surplus = 1 and counted only if the prefix grows to include them. */
#ifndef CLAST_CAMPAIGN_SCHEDULER_DRIVER_H
#define CLAST_CAMPAIGN_SCHEDULER_DRIVER_H

#include "campaign/scheduler/scheduler.h"

struct driver_summary {
  int64_t campaign_id, session_id;
  uint64_t points, points_done;   /* different points; points whose replicates are complete */
  uint64_t points_invalid;        /* points with invalid combinations of values: no runs, counted as failures */
  int64_t runs_reused, runs_done; /* found in the store; computed now */
  int64_t runs_failed;            /* all attempts failed, or the run ended in a failed state; includes reused runs */
  int64_t runs_left;       /* the machine ended limits.attempts attempts: the same command tries these runs again */
  int64_t runs_doubtful;   /* whose words mark the main quantity */
  int64_t runs_censored;   /* ended at the hard end time: usable, but fragmentation may be incomplete */
  int64_t runs_surplus;    /* in the store, but left out of statistics */
  int64_t fields_written;  /* HDF5 files kept */
  int64_t attempts_failed; /* attempts that failed in this invocation */
  uint64_t points_interval_met, points_cap_reached; /* with `until` */
  double cpu_s;                                     /* processor time of the runs computed now */
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
  int64_t runs_done, runs_failed, runs_reused;
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

#endif
