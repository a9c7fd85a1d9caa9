/* Which input matters: Sobol indices from a Saltelli design, and Morris's elementary effects as the cheap form. The
 * seed of a run is an additional input with its own indices.
 *
 * Indices (Sobol 2001, doi 10.1016/S0378-4754(00)00270-6) are shares of the variance V of y(inputs, seed). First order:
 * the variance over an input of y averaged over all others. Total: the mean variance caused by the input when all
 * others are fixed. It exceeds the first order if the input interacts with others. */
#ifndef CLAST_ANALYSIS_STATISTICS_SENSITIVITY_H
#define CLAST_ANALYSIS_STATISTICS_SENSITIVITY_H

#include "analysis/statistics/sample.h"
#include "schemas/status.h"

/* Blocks of a design. A block of Saltelli's design has inputs + 2 points: A, B and, for every input i, A with input i
 * from B. A block of Morris's design is a trajectory of inputs + 1 points; step i changes input order[block * inputs +
 * i]. */
struct sensitivity_table {
  size_t inputs, blocks, seeds;
  const double *value; /* value[(block * points of a block + point) * seeds + r] of the point's r-th seed */
  bool same_seeds;     /* true: index r is the same seed at all points; false: the seeds of points are independent */
};
struct sensitivity_index {
  /* 95 % intervals by the jackknife over blocks and over seeds, whose variances are added (with one or two seeds over
   * blocks alone, and none of the seed's first order). The jackknife takes blocks as independent. The points of a
   * design are spread evenly, so its intervals are too wide for smooth functions (2 to 80 times). For the total of an
   * input that acts through others they can be too narrow: at 64 blocks they held Ishigami's third total in 0.75 of the
   * cases. */
  struct sample_interval first, total;
};
/* index: an array of inputs + 1, the last one for the seed. With one seed all indices are for this seed, and the seed's
 * and all totals are NaN: each total would hold all the noise of the runs.
 * If the seeds differ between points, the total index of an input is that of the mean over seeds and does not include
 * its interaction with the seed. Estimators: first order Saltelli et al. (2010, doi 10.1016/j.cpc.2009.09.018) table 2
 * (b), total Jansen (1999); both use different seeds where noise would bias them. STATUS_USAGE: fewer than two
 * blocks. */
status sensitivity_sobol(const struct sensitivity_table *table, struct sensitivity_index *index, struct error *error);

struct sensitivity_effect {             /* in units of y for the whole range of an input, as quantile 0 to 1 */
  struct sample_interval mean_absolute; /* mu* (Campolongo et al. 2007); its interval over trajectories */
  double mean;                          /* mu */
  double deviation; /* sigma: large compared with mu* if the input is nonlinear or interacts with others */
  double noise;     /* mu* caused by seeds alone; NaN for one seed */
};
/* step: signed change of the quantile at each step, step[block * inputs + i]; order as above. */
status sensitivity_morris(const struct sensitivity_table *table, const size_t *order, const double *step,
                          struct sensitivity_effect *effect, struct error *error);

#endif
