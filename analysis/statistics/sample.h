/* Statistics that say how sure they are: every mean has its n and interval (design: joint 7). */
#ifndef CLAST_ANALYSIS_STATISTICS_SAMPLE_H
#define CLAST_ANALYSIS_STATISTICS_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct sample_summary {
  size_t n;
  double mean, standard_deviation, standard_error;
  double half_width; /* of the confidence interval of the mean, Student t at the level asked for */
  double minimum, median, maximum;
};

/* Orders of doubles, for qsort. */
int sample_ascending(const void *a, const void *b);
int sample_descending(const void *a, const void *b);

/* NaN values are left out (n counts what was used). level: 0.95. What cannot be told from so few is NaN: everything for
 * n = 0, the scatter for n = 1. Two passes, no cancellation. */
struct sample_summary sample_summarise(size_t n, const double *values, double level);

/* Bootstrap over runs (cluster bootstrap: fragments of one run are not independent, mass is conserved; runs are).
 * Resamples run indices, calls `statistic` on each resample, gives the standard deviation and the percentile interval.
 * `estimate` is the statistic of the sample itself. Resamples without a value (NaN) are left out; fewer than half with
 * one gives NaN. Counter-based random numbers: same seed, same bits. */
typedef double (*sample_statistic)(size_t n, const uint32_t *runs, void *context);
struct sample_interval {
  double estimate, standard_error, lower, upper;
  size_t resamples; /* that had a value */
};
struct sample_interval sample_bootstrap(size_t runs, size_t resamples, uint64_t seed, double level,
                                        sample_statistic statistic, void *context);

/* Fixed-width stopping (Chow & Robbins 1965, doi 10.1214/aoms/1177700156): stop once the interval's half width is at
 * most `half_width`, judged on a prefix of replicate numbers (never on "the first n that finished": 32 workers make
 * that 2.8 standard errors wrong), not before n0 and then after every SAMPLE_BATCH replicates. Their variance + 1/n
 * keeps a chance run of equal values from stopping too early; 1/n is taken in units of (SAMPLE_GUARD half_width)^2, so
 * that the rule does not depend on units. Measured with a value that is 1 in a tenth of the runs and else 0, nominal 95
 * %: n0 = 3 covers .68-.74 without the guard, n0 = 30 .85-.89, n0 = 30 with it .91-.96 (normal data .968), for 15 %
 * more runs at 100, 5 % at 220. Values that never vary stop at 50. */
enum { SAMPLE_FIRST = 30, SAMPLE_BATCH = 10, SAMPLE_GUARD = 20 };

/* values[r] of replicate r; NaN (failed runs) are left out of the statistics. True when the prefix of length n may
 * stop. */
bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0);
/* The shortest prefix n0, n0 + SAMPLE_BATCH, ... <= n that may stop; 0 when none may yet. The same for every n beyond
 * it. */
size_t sample_stopping_prefix(size_t n, const double *values, double half_width, double level, size_t n0);

#endif
