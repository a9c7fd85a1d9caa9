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
  bool all;       /* the model with its reasons and sources */
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

/* ---- trials: the beginning of a run, whole runs, and coarse whole runs that tell which share of a run the beginning
 * was. All times are processor time of this process, so that other work on the machine does not count. ---- */

enum { PLAN_MARKS = 512 };

/* Progress of a run (simulated time divided by the hard end time) after numbers of steps. */
struct plan_trial {
  double prepare_s, step_s, finish_s;
  double steps;    /* made */
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

/* Coarsens the scene by the first knob of its engine that has a step (particles, grains), so that a whole run takes
 * about `seconds`. `rate`: upper bound of processor seconds per unit of the engine's work. The caller owns *coarse;
 * NULL: there is no such scene. `setting`: value of that knob, for other points of the campaign. */
void plan_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]);
/* The same setting in another scene. NULL: it does not apply. */
struct scene *plan_coarsen_like(const struct scene *scene, const char *setting);

#endif
