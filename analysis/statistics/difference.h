/* The difference of two means. Runs with the same seed in both samples form pairs, so an effect of the seed that is
 * equal on both sides cancels. */
#ifndef CLAST_ANALYSIS_STATISTICS_DIFFERENCE_H
#define CLAST_ANALYSIS_STATISTICS_DIFFERENCE_H

#include <stddef.h>
#include <stdint.h>

struct difference_value {
  int64_t seed;
  double value;
};

struct difference {
  size_t n[2]; /* values of each side */
  size_t
      pairs; /* pairs of runs with one seed that the interval is computed from; 0: the samples count as independent */
  double mean[2], difference; /* of the pairs, or of all values; second minus first */
  double half_width;          /* of the interval of the difference; NaN: too few values */
};

/* Both arrays are ascending in seed, without NaN. Pairs are used when there are two or more and at least half of the
 * runs of the larger side belong to one: Student's t of the differences. Otherwise Welch's interval for independent
 * samples (Welch 1947, doi 10.1093/biomet/34.1-2.28). level: 0.95 for a 95 % interval. */
struct difference difference_between(size_t first_count, const struct difference_value *first, size_t second_count,
                                     const struct difference_value *second, double level);

#endif
