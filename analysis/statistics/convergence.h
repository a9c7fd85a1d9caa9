/* Does a result still change when a run gets finer? Pure functions on the values of two or more settings (levels) of
 * one knob: bias against the finest level, correlation between levels, which settings are worth their cost, and the
 * rows of a study. The limit is inferred by limit.h. `clast converge` makes the runs.
 *
 * Values of a level are in order of the seed, with the same seed at the same index for every level. NaN: the run
 * failed. */
#ifndef CLAST_ANALYSIS_STATISTICS_CONVERGENCE_H
#define CLAST_ANALYSIS_STATISTICS_CONVERGENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "analysis/statistics/limit.h"
#include "schemas/field.h"

/* A difference of two means with the half width of its interval. NaN: too few values. */
struct convergence_difference {
  size_t n; /* pairs of seeds, or the smaller number of values */
  double value, half_width;
};
/* Mean of level - reference. `paired`: seed by seed, by Student's t; only seeds that both have count. Otherwise the two
 * means are independent, and the degrees of freedom are those of Welch (1947, doi 10.1093/biomet/34.1-2.28). */
struct convergence_difference convergence_bias(size_t n, const double *level, const double *reference, bool paired,
                                               double level_of_confidence);

/* Sample skewness, sum of ((x - mean)/s)^3 over n. NaN for fewer than 3 values, or equal ones. */
double convergence_skew(size_t n, const double *values);

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

/* Marks the Pareto frontier: a point is on it if no other one has a smaller (or equal) cost and a smaller error. NaN is
 * never on the frontier. */
void convergence_frontier(size_t n, const double *cost, const double *error, bool *on_frontier);

/* ---- rows of a study, as the store keeps them ---- */

struct convergence_row { /* one level of one knob, for one quantity */
  char knob[FIELD_TEXT_SIZE], quantity[FIELD_TEXT_SIZE], setting[FIELD_TEXT_SIZE];
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
  bool open;         /* no limit is known: the error may be larger */
  double error; /* of this level: resolution, or |bias| and half width of a model's; and the errors that the other knobs
                   leave at the scene's own setting */
  bool frontier;
};
extern const struct field_table convergence_table;

struct convergence_limit_row { /* one knob, for one quantity: struct limit_law */
  char knob[FIELD_TEXT_SIZE], quantity[FIELD_TEXT_SIZE];
  int verdict; /* enum limit_verdict */
  int64_t dropped;
  double fit, fit_with;
  struct limit_range order, limit, change;
};
extern const struct field_table convergence_limit_table;

/* Fills distance, resolution and open of every level of a ladder, coarse to fine. With a limit, resolution is the
 * largest distance within the interval. Without one: |bias| and half width against the finest level; the finest level
 * itself takes those of the next coarser one; if the knob has no step, the finest level counts as exact and has 0. When
 * all runs of the ladder are equal, the knob leaves what the interval of the mean leaves: NaN (cannot be told), or
 * `bound` of a share. Levels without runs get NaN. law: of the levels with index place[l]; place[l] is at least
 * LIMIT_LEVELS for a level without one. */
void convergence_resolve(size_t count, struct convergence_row *levels, const struct limit_law *law, const size_t *place,
                         double bound);
/* The row of a law. */
void convergence_limit_fill(const struct limit_law *law, struct convergence_limit_row *row);

#endif
