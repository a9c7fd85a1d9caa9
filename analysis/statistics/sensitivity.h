/* Which input matters: Sobol indices from a Saltelli design, and Morris's elementary effects as the cheap form. The
 * seed of a run is one more input, with indices of its own.
 *
 * Indices (Sobol 2001, doi 10.1016/S0378-4754(00)00270-6) are shares of the variance V of y(inputs, seed). First order:
 * variance of the mean of y that an input leaves when all others are averaged over. Total: the mean variance that it
 * makes when all others are kept; more than the first order, if it acts together with others. */
#ifndef CLAST_ANALYSIS_STATISTICS_SENSITIVITY_H
#define CLAST_ANALYSIS_STATISTICS_SENSITIVITY_H

#include "analysis/statistics/sample.h"
#include "schemas/status.h"

/* Blocks of a design: a block of Saltelli has the points A, B, and A with input i from B, for every input: inputs + 2;
 * one of Morris is a trajectory of inputs + 1 points, of which step i changes input order[block * inputs + i]. */
struct sensitivity_table {
  size_t inputs, blocks, seeds;
  const double *value; /* value[(block * points of a block + point) * seeds + r] of the point's r-th seed */
  bool same_seeds;     /* r is the same seed in all points; else seeds of points have nothing to do with each other */
};
struct sensitivity_index {
  /* 95 % intervals by the jackknife over blocks and over seeds, whose variances are added (with one or two seeds over
   * blocks alone) */
  struct sample_interval first, total;
};
/* index: inputs + 1, the last of the seed: NaN for one seed, which then is part of nothing: all indices are those of
 * this seed. With seeds that differ between points the total index of an input is that of the mean over seeds: what it
 * does together with the seed is not seen. Estimates: first order Saltelli et al. (2010, doi
 * 10.1016/j.cpc.2009.09.018) table 2 (b), total Jansen (1999), both of different seeds where noise would bias them.
 * STATUS_USAGE: fewer than two blocks. */
status sensitivity_sobol(const struct sensitivity_table *table, struct sensitivity_index *index, struct error *error);

struct sensitivity_effect {             /* in units of y for the whole range of an input, as quantile 0 to 1 */
  struct sample_interval mean_absolute; /* mu* (Campolongo et al. 2007); its interval over trajectories */
  double mean, deviation; /* mu, and sigma: large beside mu* where the input is curved or acts with others */
  double noise;           /* mu* that seeds alone would make; NaN for one seed */
};
/* step: signed change of the quantile at each step, step[block * inputs + i]; order as above. */
status sensitivity_morris(const struct sensitivity_table *table, const size_t *order, const double *step,
                          struct sensitivity_effect *effect, struct error *error);

#endif
