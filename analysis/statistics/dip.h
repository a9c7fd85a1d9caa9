/* Has a sample one mode? The dip (Hartigan & Hartigan 1985, doi 10.1214/aos/1176346577): the distance of the
 * distribution function of the sample from the nearest one with a single mode, between 1/(2n) and 1/4. No bins, no
 * bandwidth, no law of the modes. */
#ifndef CLAST_ANALYSIS_STATISTICS_DIP_H
#define CLAST_ANALYSIS_STATISTICS_DIP_H

#include <stddef.h>

/* values: ascending, finite. NaN when memory is short or n is 0. Costs n times a few steps. */
double dip_of(size_t n, const double *values);

/* Share of samples of n values with one mode that have at least this dip, for the law where dips are largest, the
 * uniform one (so it is too large for others, never too small). By drawing DIP_DRAWS samples, always the same ones;
 * fewer when the share is certainly above 0.05. Beyond DIP_MOST values the dip is known to shrink with 1/sqrt(n). */
enum { DIP_DRAWS = 2000, DIP_MOST = 1000 };
double dip_share(size_t n, double dip);
/* The dip above which that share is below 0.05. For many samples of one size: all DIP_DRAWS samples are drawn once.
 * NaN: so few values cannot tell. */
double dip_limit(size_t n);

#endif
