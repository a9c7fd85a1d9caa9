/* Times runs for a plan: the beginning of a run, whole runs, and coarse whole runs that tell which share of a run the
 * beginning was. All times are processor time of this process, so that other work on the machine does not count. */
#ifndef CLAST_CAMPAIGN_SCHEDULER_PILOT_H
#define CLAST_CAMPAIGN_SCHEDULER_PILOT_H

#include "engine/scene.h"

enum { PILOT_MARKS = 512 };

/* Progress of a run (simulated time divided by the hard end time) after numbers of steps. */
struct pilot_run {
  double prepare_s, step_s, finish_s;
  double steps;    /* made */
  double progress; /* 0..1 at the end of the piece */
  bool finished;   /* the run ended before the time limit of the trial */
  size_t fragments;
  double mark_steps[PILOT_MARKS], mark_progress[PILOT_MARKS]; /* ascending */
  size_t marks;
};

/* Runs for at most `seconds`, on one thread. A run that cannot be prepared is an error. */
status pilot_try(const struct scene *scene, uint64_t seed, double seconds, struct pilot_run *run, struct error *error);

/* Processor time (s) of a whole run, of which `piece` is the beginning. Estimated from a whole run of a coarser scene:
 * both runs are assumed to need the same share of their steps up to the same simulated time. NaN: the coarse run did
 * not reach this time. */
double pilot_whole(const struct pilot_run *piece, const struct pilot_run *coarse);

/* The same without a coarse run: time up to the hard end of the run, which most runs do not reach. */
double pilot_to_hard_end(const struct pilot_run *piece);

/* Coarsens the scene by the first knob of its engine that has a step (particles, grains), so that a whole run takes
 * about `seconds`. `rate`: upper bound of processor seconds per unit of the engine's work. The caller owns *coarse;
 * NULL: there is no such scene. `setting`: value of that knob, for other points of the campaign. */
void pilot_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]);
/* The same setting in another scene. NULL: it does not apply. */
struct scene *pilot_coarsen_like(const struct scene *scene, const char *setting);

#endif
