/* Accuracy on demand: the cheapest settings and number of seeds that reach the accuracy of a campaign
 * (`accuracy: {quantity, within}`), or those that give the least error for a time (`accuracy: {quantity,
 * processor_time}`), from a study that `clast converge` has stored. */
#pragma once

#include "analysis/statistics/convergence.h"
#include "campaign/document/campaign.h"
#include "db/store/store.h"

enum { ACCURACY_MARKS = 160 };

/* What a knob leaves of an error (struct ask_part). */
struct accuracy_part {
  const struct knob *knob;
  bool open; /* no limit is seen, and what may lie beyond the levels is no small part of what is allowed */
  double error, left_by_seeds;
  double beyond; /* NaN: not known */
  double finest; /* setting of the finest level; 0: none */
  int64_t seeds;
};

/* A way to run the campaign: one level of one knob, all other inputs as in the campaign's scene. */
struct accuracy_option {
  char knob[64], setting[64];
  bool own;          /* the scene's own settings */
  bool extrapolated; /* finer than any level of the study: error by the law, cost by the engine's measure of work */
  bool open;         /* the error is no bound */
  double error;      /* change by finer settings of all knobs together, in the quantity's SI unit, as on every screen */
  int64_t point;     /* in the store */
  struct accuracy_part part[LIMITS_STUDY_KNOBS]; /* of the error, largest first */
  size_t part_count;
  double beyond;    /* if open: what the slowest law would leave beyond the finest levels, a guess. NaN: not known; then
                       the option is chosen for a time only. Else 0 */
  double mean;      /* of an extrapolated one that of the finest level with runs */
  int64_t n;        /* seeds of this mean */
  bool borrowed;    /* mean and deviation are those of the finest level, as the setting has no run */
  bool learned;     /* mean and deviation of all runs of the store, not of the study alone */
  double within;    /* the error that is allowed: the campaign's, or its share of |mean|; NaN for a time */
  bool share;       /* of a share, whose intervals in tables are wider than Student's */
  double deviation; /* standard deviation between seeds */
  int64_t seeds;    /* of a point: the fewest that reach the accuracy, or as many as the time allows; 0: none do */
  double total;     /* error, beyond if known, and half width of the 95 % interval of the mean of so many seeds; NaN
                       when seeds is 0 */
  double run_s;     /* processor time of a run, s: mean over the points */
  double cpu_s;     /* processor time of one point (`seeds` runs), s; NaN when seeds is 0 */

  char marks[ACCURACY_MARKS]; /* of the level's runs, of an extrapolated one those of the finest: "3 of 4 runs:
                                 cut"; "": none */
};

struct accuracy {
  struct accuracy_option *options; /* owned; by cpu_s, for a time by total; then those that do not reach it, by error */
  size_t count;
  double point_s; /* processor time that a point may cost in the mean, s; NaN: an accuracy is given, not a time */
  size_t chosen;  /* the cheapest option that reaches the accuracy, or that with the least total; count: none does. All
                     are in the order of convergence_order() */
  char advice[1600]; /* how to reach the accuracy, where no option does */
  char marked[512];  /* levels that are no options as their runs are in doubt: "grains = 0.005 m (step)"; "": none */
  char place[300];   /* of several points the one whose study this is: "point 1, speed 150 m/s"; "": there is one */
  bool some_studied; /* the others have no study */
  char
      widest_point[500]; /* a sentence on another studied point at which the chosen setting is farthest off; "": none */
  const char *path;      /* the campaign's file with --set and --store of the command (option_words()); borrowed */
  size_t reference;      /* the option with the smallest error; costs are relative to it */
};

/* Finds the options of a campaign with the key `accuracy`. Looks for a study of the campaign's scene, then of its
 * points: one study is used for all points. Levels of inputs that the campaign varies are no options. STATUS_CONTENT:
 * the store has no study; *error names the command that makes it, with `path` as in struct accuracy. STATUS_MISSING:
 * there is no store. */
status accuracy_find(const struct campaign *campaign, const char *path, const char *store, struct accuracy *accuracy,
                     struct error *error);
void accuracy_clear(struct accuracy *accuracy); /* a zeroed one is fine */

/* The least total when a point may cost so many seconds; NaN: too few for every option. *open: whether the option that
 * gives it is open. For a time only. */
double accuracy_least(const struct accuracy *accuracy, double point_s, bool *open);

/* Sets the chosen option's inputs and number of seeds in the campaign. STATUS_CONTENT when no option reaches the
 * accuracy, or the time is too short for each. */
status accuracy_apply(const struct accuracy *accuracy, struct campaign *campaign, struct error *error);

enum accuracy_print { ACCURACY_SILENT, ACCURACY_NOTE, ACCURACY_TEXT, ACCURACY_ALL, ACCURACY_JSON };

/* Calls accuracy_find and accuracy_apply if the campaign has the key `accuracy`. Before it applies the chosen option it
 * prints a sentence about it on stderr, or all options on stdout (ALL: with every column), or makes *json of them,
 * malloc'd: an array, for a time followed by members of the object that has it. json: NULL, unless asked for. */
status accuracy_settle(struct campaign *campaign, const char *path, const char *store, enum accuracy_print print,
                       char **json, struct error *error);

/* Number of seeds whose interval in a table has at most the half width `margin`: Student's, or that of a share, where
 * equal runs may miss a rare outcome; at least 3. 0: margin is not above 0, the scatter is not known, or more than
 * 10 000 seeds would be needed, where finer settings are better. */
int64_t accuracy_seeds(double mean, double deviation, double margin, bool share);
