/* Does a result still change when a run gets finer? Pure functions on the values of two or more settings (levels) of
 * one knob: bias against the finest level, order, extrapolated limit, correlation between levels, and which settings
 * are worth their cost. `clast converge` makes the runs.
 *
 * Values of a level are in order of the seed, with the same seed at the same index for every level. NaN: the run
 * failed. */
#ifndef CLAST_ANALYSIS_STATISTICS_CONVERGENCE_H
#define CLAST_ANALYSIS_STATISTICS_CONVERGENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* f(h) = limit + a h^order through the three finest levels, with intervals from resampled seeds. */
enum convergence_verdict {
  CONVERGENCE_TOO_FEW,   /* fewer than three levels with a step, or fewer than three seeds */
  CONVERGENCE_UNCHANGED, /* the two finest levels do not differ significantly with these seeds */
  CONVERGENCE_ORDER,     /* differences shrink in at least 95 % of the resamples: order and limit are given */
  CONVERGENCE_NO_ORDER,  /* they do not shrink in at least 95 % of them: no limit is in sight */
  CONVERGENCE_UNSURE,    /* between both: more seeds are needed to decide */
  CONVERGENCE_VERDICTS
};

struct convergence_limit {
  enum convergence_verdict verdict;
  double order, order_low, order_high;
  double limit, limit_low, limit_high;
  double shrinking; /* share of resamples whose differences shrink */
};

/* Order p and limit of f(h) = limit + a h^p through (h[i], f[i]), h[0] > h[1] > h[2] > 0. False when the differences
 * change their sign or do not shrink faster than a logarithm, or when p would be above CONVERGENCE_ORDER_MOST.
 * Richardson (1911, doi 10.1098/rsta.1911.0009); the equation for p is solved by Brent's method. */
#define CONVERGENCE_ORDER_MOST 12.0
bool convergence_solve(const double h[3], const double f[3], double *order, double *limit);

/* h: steps of the three finest levels, coarse to fine. values[i][s]: value of level i and seed s. `paired`: all levels
 * share one draw of seeds. The same values give the same bits. */
struct convergence_limit convergence_extrapolate(const double h[3], size_t n, const double *const values[3],
                                                 bool paired, double level_of_confidence);

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
  double resolution; /* error that this knob alone leaves at this level (convergence_resolve). NaN: a model's knob */
  bool open;         /* no limit is known: the error may be larger */
  double error; /* of this level: resolution, or |bias| and half width of a model's; and the errors that the other knobs
                   leave at the scene's own setting */
  bool frontier;
};
extern const struct field_table convergence_table;

struct convergence_limit_row { /* one knob, for one quantity */
  char knob[FIELD_TEXT_SIZE], quantity[FIELD_TEXT_SIZE];
  int verdict; /* enum convergence_verdict */
  double order, order_low, order_high;
  double limit, limit_low, limit_high;
};
extern const struct field_table convergence_limit_table;

/* Fills resolution and open of every level of a ladder, coarse to fine. With an order: the distance to the limit and
 * the half width of its interval. Without an order: |bias| and half width against the finest level. The finest level
 * itself takes those of the next coarser one; if the knob has no step, the finest level counts as exact and has 0.
 * Levels without runs get NaN. */
void convergence_resolve(size_t count, struct convergence_row *levels, const struct convergence_limit_row *limit);

#endif
