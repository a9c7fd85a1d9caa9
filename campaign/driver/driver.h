/* Drives one campaign through farm and store: sends design points out as runs and stores their results as rows, until
 * every point has its replicates. Each run has an identity, so that a resumed campaign does not compute stored runs
 * again.
 *
 *     campaign_load(path, &campaign, &error);                 // every rank
 *     driver_farm_options(campaign, &farm_options);           // limits of the document
 *     farm_start(&farm_options, run_work, &farm, &error);     // before HDF5, threads, MPI
 *     driver_run(campaign, farm, &options, &summary, &error); // every rank; only rank 0 opens the store
 *     farm_stop(farm, &error);
 *
 * A point's statistics use a fixed prefix of replicate numbers 0..n-1. With `seeds: until` the prefix grows batch by
 * batch and the decision looks at complete prefixes only, never at "the first n that finished" (which is biased towards
 * quick runs). Idle slots compute runs beyond the prefix; these are stored with surplus = 1 and counted only if the
 * prefix grows to include them. */
#ifndef CLAST_CAMPAIGN_DRIVER_DRIVER_H
#define CLAST_CAMPAIGN_DRIVER_DRIVER_H

#include "campaign/document/campaign.h"
#include "campaign/farm/farm.h"
#include "campaign/terminal/progress.h"
#include "db/store/store.h"

struct driver_options {
  const char *store_path;                        /* NULL: the campaign's */
  const char *facts;                             /* JSON of provenance_json() */
  struct progress *progress;                     /* NULL: silent. Borrowed */
  void (*note)(void *context, const char *text); /* warnings and notes for a person, one line each; may be NULL */
  void *note_context;
  int slots; /* number of slots for the estimate of the time left; driver_run takes it from the farm */
};

struct driver_summary {
  int64_t campaign_id, session_id;
  uint64_t points, points_done;   /* different points; points whose replicates are complete */
  uint64_t points_invalid;        /* points with invalid combinations of values: no runs, counted as failures */
  int64_t runs_reused, runs_done; /* found in the store; computed now */
  int64_t runs_failed;            /* all attempts failed, or the run ended in a failed state; includes reused runs */
  int64_t runs_left;       /* the machine ended limits.attempts attempts: the same command tries these runs again */
  int64_t runs_censored;   /* ended at the hard end time: usable, but fragmentation may be incomplete */
  int64_t runs_surplus;    /* in the store, but left out of statistics */
  int64_t fields_written;  /* HDF5 files kept */
  int64_t attempts_failed; /* attempts that failed in this invocation */
  uint64_t points_interval_met, points_cap_reached; /* with `until` */
  double cpu_s;                                     /* processor time of the runs computed now */
};

/* Copies the campaign's time and memory limits into *options. The other options do not change. */
void driver_farm_options(const struct campaign *campaign, struct farm_options *options);

/* STATUS_OK; STATUS_FAILED_RUNS: finished with failed runs, or stopped because too many of the first failed;
 * STATUS_STOPPED: signal, or runs were lost to the machine; the same command resumes. STATUS_IO: a fields file could
 * not be written; STATUS_IO and STATUS_CONTENT from the store. *summary is filled in every case. On ranks other than 0:
 * serves, returns the manager's status, *summary zero. */
status driver_run(const struct campaign *campaign, struct farm *farm, const struct driver_options *options,
                  struct driver_summary *summary, struct error *error);

/* For a manager that cannot begin: ends the other ranks, which wait for it, by a farm run without tasks. */
void driver_release_ranks(struct farm *farm);

/* The parts of driver_run, for tests that take the farm's place and for studies that run one campaign after another. */
struct driver;
status driver_open(const struct campaign *campaign, struct store *store, const struct driver_options *options,
                   struct driver **out, struct error *error);
struct farm_manager driver_manager(struct driver *driver);
/* After the farm has ended: prints the last progress line and commits the open batch. Returns an error that no tick has
 * passed on yet. */
status driver_end(struct driver *driver, struct error *error);
void driver_summarise(const struct driver *driver, struct driver_summary *summary);
void driver_free(struct driver *driver); /* NULL is fine; the store stays open */

#endif
