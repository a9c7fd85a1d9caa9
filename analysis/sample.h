/* Statistics that say how sure they are: every mean has its n and interval (design: joint 7). */
#ifndef CLAST_ANALYSIS_SAMPLE_H
#define CLAST_ANALYSIS_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct sample_summary {
  size_t n;
  double mean, standard_deviation, standard_error;
  double half_width; /* of the confidence interval of the mean, Student t at the level asked for */
  double minimum, median, maximum;
};
/* NaN values are left out (n counts what was used). level: 0.95. */
struct sample_summary sample_summarise(size_t n, const double *values, double level);

/* Bootstrap over runs (cluster bootstrap): resamples run indices, calls `statistic` on each resample, gives the standard
 * deviation and the percentile interval. Counter-based random numbers: same seed, same bits. */
typedef double (*sample_statistic)(size_t n, const uint32_t *runs, void *context);
struct sample_interval { double estimate, standard_error, lower, upper; };
struct sample_interval sample_bootstrap(size_t runs, size_t resamples, uint64_t seed, double level,
                                        sample_statistic statistic, void *context);

/* Fixed-width stopping (Chow & Robbins 1965): decides on a fixed prefix of replicates, in batches, never before n0;
 * uses variance + 1/n. values[r] of replicate r for r < n. Returns true when the prefix of length n may stop. */
bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0);

#endif
