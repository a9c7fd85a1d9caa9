/* Predicts runs and cost of a campaign. Stores nothing. Times come from trial runs of up to 5 s in all: of the most
 * expensive sampled point, of a coarse version of it that runs to its end, and of other points. */
#ifndef CLAST_CAMPAIGN_SCHEDULER_PLAN_H
#define CLAST_CAMPAIGN_SCHEDULER_PLAN_H

#include "campaign/document/campaign.h"

struct plan_options {
  const char *store_path; /* NULL: the campaign's */
  bool no_trial;
  double trial_s; /* 0 = 5 s */
  int slots;      /* for the wall time */
};

struct plan {
  uint64_t points, points_looked_at; /* costs are averaged over the sampled points (at most 4096) */
  uint64_t runs_least, runs_most;    /* differ with `until` */
  uint64_t runs_there;               /* of the sampled points, already in the store */
  bool store_exists;
  bool trial_made, trial_finished; /* finished: the trial is a whole run, not an extrapolation */
  bool trial_whole;     /* times are of whole runs, measured or estimated from a coarse run; else upper bounds */
  double share_of_most; /* mean time of a run divided by that of the most expensive point; NaN: taken from the engine's
                           measure of work */
  double trial_s, trial_progress;
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
void plan_print(const struct campaign *campaign, const struct plan *plan, int slots, FILE *out); /* for people */
char *plan_print_json(const struct campaign *campaign, const struct plan *plan, int slots);      /* malloc'd */

#endif
