/* Times runs for a plan: a piece of a run, whole runs, and coarse whole runs that tell how much of a run a piece was.
 * All times are processor time of this process, so that other work on the machine does not count. */
#ifndef CLAST_CAMPAIGN_DRIVER_PILOT_H
#define CLAST_CAMPAIGN_DRIVER_PILOT_H

#include "engine/scene.h"

enum { PILOT_MARKS = 512 };

/* How a run went: progress (simulated time over the hard end) after numbers of steps. */
struct pilot_run {
  double prepare_s, step_s, finish_s;
  double steps;    /* made */
  double progress; /* 0..1 at the end of the piece */
  bool finished;   /* the run has ended by itself */
  size_t fragments;
  double mark_steps[PILOT_MARKS], mark_progress[PILOT_MARKS]; /* ascending */
  size_t marks;
};

/* Runs for at most `seconds`, on one thread. A run that cannot be prepared is an error. */
status pilot_try(const struct scene *scene, uint64_t seed, double seconds, struct pilot_run *run, struct error *error);

/* Processor time of the whole run that `piece` is the beginning of, s, from a whole run of a coarser scene: both take
 * the same share of their steps up to the same simulated time. NaN when the coarse run has not got so far. */
double pilot_whole(const struct pilot_run *piece, const struct pilot_run *coarse);

/* The scene with so much less work that a whole run takes some `seconds`, by the first knob of its engine that has a
 * step (particles, grains); `rate`: processor seconds per unit of the engine's work, an upper bound. *coarse is owned;
 * NULL: there is none. `setting`: of that knob, for other points of the campaign. */
void pilot_coarsen(const struct scene *scene, double rate, double seconds, struct scene **coarse, char setting[64]);
/* The same setting in another scene. NULL: it does not apply. */
struct scene *pilot_coarsen_like(const struct scene *scene, const char *setting);

#endif
