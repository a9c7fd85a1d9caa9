/* Does a result still change when a run gets finer? Pure functions on the values of two or more settings (levels) of
 * one knob: bias against the finest level, correlation between levels, which settings are worth their cost, and the
 * rows of a study; and the limit that it tends to. `clast converge` makes the runs.
 *
 * Values of a level are in order of the seed, with the same seed at the same index for every level. NaN: the run
 * failed. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/field.h"

/* ---- the limit ----
 *
 * The limit of a result as a knob gets finer, from all levels and seeds at once:
 *
 *     value of a run at step s = limit + a s^p + noise,   LIMIT_ORDER_LEAST <= p <= LIMIT_ORDER_MOST
 *
 * The noise of a level has a standard deviation of its own; runs of one seed have a common part, of the correlation rho
 * between any two levels. Deviations and rho are drawn from their posterior given the scatter of the runs about the
 * means of their levels, so that few seeds make wide intervals, as with Student's t. For each law, generalised least
 * squares find limit and a for every draw. A law is a p, a number of coarse levels that it leaves out (each costs
 * LIMIT_COST_OF_LEVEL in -2 ln likelihood), or two terms a s^p + b s^q of all levels (LIMIT_COST_OF_TERM).
 *
 * An interval is that of the profile likelihood over the laws: it holds every value that some law does not reject. So
 * its coverage holds for every p of the range, also where the levels cannot tell p; there it is wide. A prior over p
 * would make it shorter and miss the limit of the p at the ends of the range.
 *
 * A law whose limit lies outside of what the result can have (a share above 1) costs as much in -2 ln(likelihood) as
 * the limit is outside, in squares of its standard deviation. If the best law with that cost is rejected against the
 * best one without, no limit is seen. The cost counts for the limit; a prediction for a finite step needs no limit.
 *
 * Only a law that the levels contradict is told from a right one. Two errors that cancel within the noise on all
 * levels, or a law that changes beyond the finest level, look like a limit that is reached
 * (tests/verification/limits.md). */

#define LIMIT_ORDER_LEAST   0.5
#define LIMIT_ORDER_MOST    3.0 /* what counts single particles changes by their mass, s^3 */
#define LIMIT_COST_OF_LEVEL 3.0
#define LIMIT_COST_OF_TERM  4.0
enum { LIMIT_LEVELS = 12, LIMIT_FEWEST_LEVELS = 3, LIMIT_FEWEST_SEEDS = 3 };

struct limit_ladder {
  size_t levels;                      /* coarse to fine; at most LIMIT_LEVELS */
  double step[LIMIT_LEVELS];          /* decreasing, above 0; NaN: none, so that no law applies */
  const double *values[LIMIT_LEVELS]; /* by seed, the same seed at the same index; NaN: no usable run */
  size_t seeds;
  double least, most;             /* range of the result; -HUGE_VAL, HUGE_VAL: none */
  double order_least, order_most; /* 0: LIMIT_ORDER_LEAST and LIMIT_ORDER_MOST. Equal: the order is known */
};

enum limit_verdict {
  LIMIT_TOO_FEW,  /* fewer than three levels or three seeds */
  LIMIT_CONSTANT, /* all runs of all levels are equal: nothing tells how far other runs may be */
  LIMIT_SEEN,     /* a law of the range agrees with the three finest levels at least */
  LIMIT_NOT_SEEN, /* none does, or none has a limit in the range of the result */
  LIMIT_FALLING,  /* none does, but the last change is smaller than the one before by more than the slowest law asks */
  LIMIT_VERDICTS
};

/* A number with its interval. */
struct limit_range {
  double value, low, high;
};

struct limit_law {
  enum limit_verdict verdict;
  size_t dropped;           /* coarse levels that the law does not describe */
  double fit;               /* share of the samples of the best law of one p that lie farther from it than the levels;
                               LIMIT_FALLING: below 0.05 with any number of dropped levels */
  double fit_with;          /* the same with one of the dropped levels; NaN: none is dropped */
  struct limit_range order; /* the range that the levels do not reject */
  struct limit_range limit; /* with the interval of the given confidence, as all others */
  struct limit_range one_power; /* the limit by the laws of one power alone; NaN: the levels reject them */
  struct limit_range
      distance[LIMIT_LEVELS]; /* mean of the level less the limit, by the law; a dropped level: measured */
  struct limit_range change;  /* of the mean from the next to finest level to the finest one */
};

/* The value of the law at a step that need not be a level. */
struct limit_point {
  double step;
  struct limit_range mean;     /* mean over all seeds */
  struct limit_range sample;   /* mean over as many other runs of this step as the levels have seeds */
  struct limit_range distance; /* mean less the limit */
};

/* Pure: the same values give the same bits. `points`: steps to evaluate, filled when the verdict is LIMIT_SEEN; may be
 * NULL. False: memory ran out. */
bool limit_infer(const struct limit_ladder *ladder, double confidence, struct limit_law *law, size_t count,
                 struct limit_point *points);

/* ---- levels against each other ---- */

/* A difference of two means with the half width of its interval. NaN: too few values. */
struct convergence_difference {
  size_t n; /* pairs of seeds, or the smaller number of values */
  double value, half_width;
};
/* Mean of level - reference. `paired`: seed by seed, by Student's t; only seeds that both have count. Otherwise the two
 * means are independent, and the degrees of freedom are those of Welch (1947, doi 10.1093/biomet/34.1-2.28). */
struct convergence_difference convergence_bias(size_t n, const double *level, const double *reference, bool paired,
                                               double level_of_confidence);

/* Pearson's correlation over seeds, with Fisher's interval: tanh(atanh r +- z/sqrt(n - 3)). NaN for fewer than 4 pairs,
 * or a level that does not scatter. */
struct convergence_correlation {
  size_t n;
  double value, low, high;
};
struct convergence_correlation convergence_correlate(size_t n, const double *coarse, const double *fine,
                                                     double level_of_confidence);

/* Two levels have correlation rho, and the coarse one costs w times as much as the fine one. At equal cost, a control
 * variate with the best weight and the best numbers of runs has the variance of plain Monte Carlo divided by the gain
 * 1/(sqrt(1 - rho^2) + rho sqrt(w))^2 (Peherstorfer, Willcox & Gunzburger 2016, doi 10.1137/15M1046472, two models).
 * The gain is above 1 when rho is above the break-even 2 sqrt(w)/(1 + w). */
double convergence_break_even(double cost_ratio);
double convergence_gain(double correlation, double cost_ratio);

/* The order of settings: below 0 if the first is the better one, with less error, or as much for less cost. An error
 * that is no bound (>=), or as large as a share can move, counts as its number. NaN is the largest. */
int convergence_order(double error, double cost, double other_error, double other_cost);

/* ---- rows of a study, as the store keeps them ---- */

struct convergence_row { /* one level of one knob, for one quantity */
  char knob[FIELD_TEXT_SIZE], quantity[FIELD_TEXT_SIZE], setting[FIELD_TEXT_SIZE];
  int64_t point, base_point; /* of level and scene in the store, for rows that were read from there */
  bool base, reference, paired;
  double step; /* NaN: the knob has none */
  int64_t n;
  double mean, half_width, deviation, skew;
  double upper_mode; /* share of the runs in the upper of two modes (scatter_find_modes); NaN: one mode */
  double cpu;
  double bias, bias_half_width;
  double correlation, correlation_low, correlation_high; /* with the next finer level */
  double cost_ratio, break_even, gain;
  double distance, distance_half_width; /* mean less the limit, middle and half width of the interval; NaN: no limit */
  double resolution; /* error that this knob alone leaves at this level (convergence_resolve). NaN: a model's knob */
  bool open;         /* no limit is known: resolution may be larger. With 0: no difference was seen */
  double error;      /* that all knobs together leave at this level, by the store's view resolution. NaN: not studied */
  bool at_least;     /* error is no bound: it may be larger. With 0: no difference was seen */
  bool frontier;
};
extern const struct field_table convergence_table;

struct convergence_limit_row { /* one knob, for one quantity: struct limit_law */
  char knob[FIELD_TEXT_SIZE], quantity[FIELD_TEXT_SIZE];
  int verdict; /* enum limit_verdict */
  int64_t dropped;
  double fit, fit_with;
  struct limit_range order, limit, one_power, change;
};
extern const struct field_table convergence_limit_table;

/* Fills distance, resolution and open of every level of a ladder, coarse to fine. With a limit, resolution is the
 * largest distance within the interval. Without one: |bias| and half width against the finest level, and not less than
 * the difference from any finer level; the finest level itself takes those of the next coarser one. `choices`: levels
 * are no numbers. There, and of numbers without a step whose runs are equal seed by seed, the finest level counts as
 * exact and has 0. When all runs of the ladder are equal, no difference was seen: 0 and open. How many other runs may
 * differ is told by the interval over seeds. Levels without runs get NaN. law: of the levels with index place[l];
 * place[l] is at least LIMIT_LEVELS for a level without one. */
void convergence_resolve(size_t count, struct convergence_row *levels, const struct limit_law *law, const size_t *place,
                         bool choices);
/* The same for the scene's own level when it was left out; else nothing. `own`: the law at its step, of limit_infer().
 * Where no law reaches it, its resolution is the largest of the levels, or that of the finest one if it is finer still,
 * and open tells that it is no bound. */
void convergence_resolve_own(size_t count, struct convergence_row *levels, const struct limit_law *law,
                             const size_t *place, const struct limit_point *own);
/* The row of a law. */
void convergence_limit_fill(const struct limit_law *law, struct convergence_limit_row *row);
