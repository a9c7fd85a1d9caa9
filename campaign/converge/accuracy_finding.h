/* Inside of accuracy on demand: what the store has of a campaign's studies. */
#pragma once

#include "campaign/converge/accuracy.h"
#include "campaign/converge/study.h"

enum { ACCURACY_FEWEST_SEEDS = 3, ACCURACY_POINTS = 1000 };
enum { ACCURACY_FEW_RUNS = 10 }; /* the true standard deviation may be twice that of fewer */

struct accuracy_finding {
  const struct campaign *campaign;
  struct accuracy *accuracy;
  struct store *store; /* borrowed */
  struct study_quantity quantity;
  char results[ASK_DOUBTS_RESULTS];
  struct convergence_row *rows; /* of all studies of the quantity, those of a scene together; owned */
  size_t row_count, row_room;
  struct accuracy_place { /* a point of the campaign */
    int64_t point;        /* in the store; 0: not there */
    struct scene *scene;  /* owned; NULL: it is refused */
    double work, own_s;   /* of a run with its own settings; NaN: not known */
  } * places;             /* the first ones; owned */
  size_t place_count, place_room;
  struct accuracy_row_part {
    struct ask_part part; /* without texts */
    const struct knob *knob;
    double finest;
  } * parts; /* of the scene studied and its levels; owned */
  size_t part_count, part_room;

  const struct scene *scene;  /* whose study is used; borrowed */
  int64_t point;              /* its point in the store */
  char hopeless[256];         /* knobs whose finest level is marked by its runs: "grains,time_step"; "": none */
  char marks[ACCURACY_MARKS]; /* of the level that becomes an option */
  const struct convergence_row *finest; /* the reference of the last knob that has one, for levels finer than it */
};

/* ---- accuracy_read.c ---- */

const struct knob *accuracy_knob(const struct campaign *campaign, const char *name);
/* The rows of the study of a scene, by its point. */
const struct convergence_row *accuracy_rows(const struct accuracy_finding *finding, int64_t point, size_t *count);
double accuracy_work(const struct scene *scene);

/* ---- accuracy_choose.c ---- */

/* Makes options of the study of finding->point, and sorts them. */
status accuracy_choose_options(struct accuracy_finding *finding, struct error *error);
/* Takes mean and scatter of the chosen option from all of its runs at the points of the campaign, and chooses again
 * until the chosen one has them. */
status accuracy_learn(struct accuracy_finding *finding, struct error *error);
/* How far a result with this mean can move. */
double accuracy_most(bool share, double mean);
/* The error, with what may lie beyond the finest levels. */
double accuracy_resolution(const struct accuracy_option *option);
/* What a setting with this mean may be off. NaN: a time is given, not an accuracy. */
double accuracy_allowed(const struct campaign *campaign, double mean);
/* True when the campaign varies an input that this level of the knob sets. */
bool accuracy_is_varied(const struct campaign *campaign, const struct knob *knob, const char *setting);
/* The first condition that would mark this scene's result and not that of the studied one (finer grains with the same
 * time step). NULL: none. */
const struct condition *accuracy_mark(const struct scene *studied, const struct scene *scene);

/* ---- accuracy_advice.c ---- */

/* No option reaches the accuracy: what would, for the one with the smallest error. */
void accuracy_advise(const struct accuracy_finding *finding);
