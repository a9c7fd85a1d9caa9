/* Has a sample one mode? The dip (Hartigan & Hartigan 1985, doi 10.1214/aos/1176346577): the distance of the
 * distribution function of the sample from the nearest one with a single mode, between 1/(2n) and 1/4. The test needs
 * no bins, no bandwidth and no assumed distribution of the modes. */
#ifndef CLAST_ANALYSIS_STATISTICS_DIP_H
#define CLAST_ANALYSIS_STATISTICS_DIP_H

#include <stddef.h>

/* values: ascending, finite. NaN when memory ran out or n is 0. The cost is n times a small number of steps. */
double dip_of(size_t n, const double *values);

/* The share of one-mode samples of n values that have at least this dip. It is computed for the uniform law, which has
 * the largest dips, so for other laws it is too large, never too small. DIP_DRAWS samples are drawn, always the same
 * ones; fewer when the share is certainly above 0.05. Beyond DIP_MOST values the dip is known to shrink with
 * 1/sqrt(n). */
enum { DIP_DRAWS = 2000, DIP_MOST = 1000 };
double dip_share(size_t n, double dip);
/* The dip above which that share is below 0.05. It is meant for many samples of one size: all DIP_DRAWS samples are
 * drawn once. NaN: too few values. */
double dip_limit(size_t n);

#endif
