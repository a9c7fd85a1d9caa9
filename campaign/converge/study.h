/* A study of convergence: runs the levels of some knobs with the same seeds through farm and store, in rounds with
 * increasing numbers of seeds, until the bias of every level is known to the wanted width or the budget is spent. Its
 * runs are ordinary runs of the store: a stopped study goes on where it ended, and runs of other campaigns are used.
 *
 *     study_add(study, base, &levels, &error);          // a knob of a scene; several
 *     farm_start(...);
 *     study_rounds_run(study, farm, &options, &error);         // every rank
 *     study_of_scene(study, 0, 0, found);               // rank 0: what was found */
#ifndef CLAST_CAMPAIGN_CONVERGE_STUDY_H
#define CLAST_CAMPAIGN_CONVERGE_STUDY_H

#include "analysis/statistics/convergence.h"
#include "campaign/converge/ladder.h"
#include "campaign/converge/study_quantity.h"
#include "campaign/document/campaign.h"
#include "campaign/driver/driver.h"

enum { STUDY_QUANTITIES = 8, STUDY_KNOBS = 32 /* of one scene */ };

/* One knob of one scene, and the values of its runs. */
struct study_ladder {
  struct ladder levels;
  const struct scene *base; /* borrowed */
  int64_t base_point;       /* in the store; 0 before study_run */
  int64_t point[KNOB_LEVELS];
  bool left_out[KNOB_LEVELS];                    /* left out because of the budget */
  int64_t seeds;                                 /* wanted number for every level that is not left out */
  double *values[STUDY_QUANTITIES][KNOB_LEVELS]; /* by seed; NaN: no usable run. Owned. For an exponent: the run's
                                                    contribution (pooled_exponent_of_runs), first `seeds` only */
  bool *ran[KNOB_LEVELS];                        /* by seed: its run is in the store. Owned */
  double cpu[KNOB_LEVELS], wall[KNOB_LEVELS];    /* means of the runs, s; NaN: none */
  bool narrow;                                   /* every bias of every quantity is known to the wanted width */
  bool done;
  const char *end; /* why no more seeds are added: a sentence without full stop */
};

struct study_rule {
  double within; /* wanted half width of every bias; NaN: none, only the first round is run */
  bool relative; /* within is a share of the reference's mean */
  int64_t first_seeds, most_seeds;
  double seconds; /* wall time of this invocation; HUGE_VAL: no limit */
};

struct study {
  struct campaign limits; /* name, store, first_seed, time and memory limits, attempts, failures; nothing is owned */
  const char *scene_reference;
  struct study_rule rule;
  struct study_quantity quantity[STUDY_QUANTITIES];
  size_t quantity_count;
  struct study_ladder *ladder; /* owned */
  size_t ladder_count;
  int64_t runs_done, runs_failed; /* totals of this invocation */
  double cpu_s;
  bool budget_spent;
};

/* Takes ownership of the ladder (also on errors). STATUS_MEMORY. */
status study_add(struct study *study, const struct scene *base, struct ladder *levels, struct error *error);
void study_clear(struct study *study);

/* Every rank calls it. Rank 0 runs all rounds and reads the values of all ladders. STATUS_OK also when the budget is
 * spent; STATUS_STOPPED after a signal: the same command continues the study. */
status study_rounds_run(struct study *study, struct farm *farm, const struct driver_options *options,
                        struct error *error);

/* The results of a ladder for a quantity: one row per level, NaN where runs are missing. */
struct study_found {
  struct convergence_row rows[KNOB_LEVELS];
  size_t count;
  struct convergence_limit_row limit;
  bool adds; /* its error is one of resolution, which adds to the errors of the other knobs' levels */
};
/* Results of one ladder: the member `error` of its rows is that of its knob alone. */
void study_find(const struct study *study, const struct study_ladder *ladder, size_t quantity,
                struct study_found *found);
/* Results of all ladders of one scene, beginning with ladder `from`; `found` has STUDY_KNOBS elements. Each level's
 * error includes the errors of the other knobs at the scene's own setting; the frontier is over all ladders. Returns
 * the number of ladders. */
size_t study_of_scene(const struct study *study, size_t from, size_t quantity, struct study_found *found);

/* ---- shared by study.c and study_rounds.c ---- */

/* Index of the level that the others are compared with. */
size_t study_reference(const struct study_ladder *ladder);
/* Reads the values of a ladder's runs from the store. */
status study_read(const struct study *study, struct study_ladder *ladder, struct store *store, struct error *error);
/* Computes and stores the rows of all ladders and quantities. */
status study_store(const struct study *study, struct store *store, struct error *error);

#endif
