/* The lower cut-off of a power law by the Kolmogorov-Smirnov distance (Clauset, Shalizi & Newman 2009), and what
 * follows from searching it: errors that include the search, the exact p-value. plfit's library does the search. */
#ifndef CLAST_ANALYSIS_STATISTICS_CUTOFF_H
#define CLAST_ANALYSIS_STATISTICS_CUTOFF_H

#include "analysis/statistics/exponent.h"

/* The x_min that plfit chooses among the masses (all of them above the resolution limit, any order); NaN when it finds
 * none. plfit's errors are silenced by analysis_init(). */
double cutoff_lower(size_t n, const double *masses);

struct cutoff_error {
  double beta_error, lower_error; /* standard deviations over the resamples, x_min searched anew in each */
  size_t resamples;               /* that gave a fit */
};
/* Bootstrap of EXPONENT_KS on one sample, fragments resampled. Counter-based: same seed, same bits. For several runs
 * resample runs instead (pooled.h). Costs `resamples` fits. */
status cutoff_bootstrap(size_t n, const double *masses, struct exponent_window window, size_t resamples, uint64_t seed,
                        struct cutoff_error *out, struct error *error);

/* The exact p-value of the pure law above x_min (both searched) by plfit's semi-parametric bootstrap; resolution
 * `precision` (0.05: 100 resamples, 0.01: 2500). Small p rejects. Seconds of work at 1000 masses and precision 0.01:
 * only on request, once per point, never per run. plfit's approximate p is wrong (0.97 for 0.49): not offered. */
status cutoff_p_value(size_t n, const double *masses, double lower, double precision, uint64_t seed, double *p,
                      struct error *error);

#endif
