/* Statistics of a sample with their uncertainty: every mean has its number of values and its interval. The store's
 * views compute the same in plain SQL (db/store/views.c), the page of `clast report` in JavaScript
 * (analysis/report/statistics.js); tests compare them. */
#ifndef CLAST_ANALYSIS_STATISTICS_SAMPLE_H
#define CLAST_ANALYSIS_STATISTICS_SAMPLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Orders of doubles, for qsort. */
int sample_ascending(const void *a, const void *b);
int sample_descending(const void *a, const void *b);

/* Running mean and sum of squared deviations (Welford 1962), without cancellation. All zero: no values yet. */
struct sample_moments {
  size_t n;
  double mean, squares;
};
void sample_add(struct sample_moments *moments, double value); /* NaN is left out */

struct sample_summary {
  size_t n;
  double mean, standard_deviation, standard_error;
  double half_width; /* of the confidence interval of the mean, by Student's t. NaN: the values are equal (or differ by
                        rounding, SAMPLE_ROUNDING of their size), which says nothing of how far the mean may be off */
  double low, high;  /* the interval. A share: within 0 and 1, and a bound also when all values are equal */
  bool weak;         /* a share only: few runs, of a kind whose interval often misses the mean */
};
#define SAMPLE_ROUNDING 1e-12
/* NaN values are left out; n counts the others. level: 0.95 for a 95 % interval. Undefined results are NaN: everything
 * for n = 0, the scatter for n = 1. Two passes avoid cancellation. */
struct sample_summary sample_summarise(size_t n, const double *values, double level);
/* The same from running moments. */
struct sample_summary sample_summarise_moments(const struct sample_moments *moments, double level);
/* Turns the interval of a mean into that of a share, a value between 0 and 1 (field_is_share()). Student's t takes the
 * values as normal. Near an end of the range they cannot be: they are skewed, the more the larger their standard
 * deviation s is against the distance e of the mean from that end. Three rules, chosen by their coverage
 * (tests/verification/shares.md):
 *
 * - The half width is Student's times 1 + SAMPLE_SKEW s/e. From 25 runs on the addition falls as 1/sqrt(n), as the
 *   skewness of a mean does. s/e is at most sqrt(n) for any values of one sign.
 * - When all n values are equal, a share of the runs of up to p = 1 - (1 - level)^(1/n) may end otherwise without being
 *   seen. The interval is the value moved by p of its distance from both ends of the range.
 * - The interval is weak when an outcome of a tenth of the runs may be missing from the sample and would move the mean
 *   out of the interval: with fewer than SAMPLE_NARROW_RUNS runs when s is below SAMPLE_NARROW of the distance from the
 *   far end; with fewer than SAMPLE_EDGE_RUNS when s is below SAMPLE_EDGE of it and above SAMPLE_EDGE_SKEW e. */
void sample_of_share(struct sample_summary *summary, double level);
#define SAMPLE_SKEW      0.375
#define SAMPLE_SKEW_RUNS 25
#define SAMPLE_NARROW    0.045
#define SAMPLE_EDGE      0.14
#define SAMPLE_EDGE_SKEW 0.4
enum { SAMPLE_NARROW_RUNS = 40, SAMPLE_EDGE_RUNS = 20 };

/* Two-sided quantile of Student's t for a mean of n values: its interval's half width is this times its standard error.
 * NaN for n < 2 or a level outside (0, 1). */
double sample_student(size_t n, double level);

/* Interval of a statistic of many runs, such as an exponent, by the jackknife over runs: leave out one run after
 * another and measure how far the statistic moves; then use Student's t, whose degrees of freedom are the number of
 * runs minus one (Tukey 1958). The runs are independent, the fragments of one run are not (their masses sum to the
 * body's). `statistic` is called with subsets of the runs. With more than SAMPLE_GROUPS runs, groups of consecutive
 * runs of equal size are left out, which limits the cost. No random numbers are used: the same runs give the same bits.
 *
 * Errors are NaN for one run, and when the statistic has no value without one of the runs. Runs that are equal have no
 * half width. A bootstrap would need more
 * runs: the coverage of its percentile intervals is 0.79 with 3 runs and 0.85 with 5, compared with 0.93 to 0.97 here
 * (tests/verification/intervals.md). */
typedef double (*sample_statistic)(size_t n, const uint32_t *runs, void *context);
struct sample_interval {
  double estimate, standard_error;
  double half_width; /* of the interval of the requested level, about the estimate */
};
enum { SAMPLE_GROUPS = 100 };
/* Returns the number of groups that are left out in turn. *each: runs per group (the last one may have fewer). */
size_t sample_groups(size_t runs, size_t *each);
/* theta[g]: the statistic without group g; `estimate`: of all runs. */
struct sample_interval sample_jackknife_of(size_t runs, double level, double estimate, const double *theta);
struct sample_interval sample_jackknife(size_t runs, double level, sample_statistic statistic, void *context);

/* The difference of two means. Runs with the same seed in both samples form pairs, so an effect of the seed that is
 * equal on both sides cancels. */
struct difference_value {
  int64_t seed;
  double value;
};

struct difference {
  size_t n[2];  /* values of each side */
  size_t pairs; /* pairs of runs with one seed that the interval is of; 0: the samples count as independent */
  double mean[2], difference; /* of the pairs, or of all values; second minus first */
  double half_width;          /* of the interval of the difference; NaN: too few values, or they do not vary */
};

/* Both arrays are ascending in seed, without NaN. Pairs are used when there are two or more and at least half of the
 * runs of the larger side belong to one: Student's t of the differences. Otherwise Welch's interval for independent
 * samples (Welch 1947, doi 10.1093/biomet/34.1-2.28). level: 0.95 for a 95 % interval. */
struct difference sample_difference(size_t first_count, const struct difference_value *first, size_t second_count,
                                    const struct difference_value *second, double level);

/* Stopping at a fixed width (Chow & Robbins 1965, doi 10.1214/aoms/1177700156): stop when the interval's half width is
 * at most `half_width`.
 *
 * The rule tests a prefix of replicate numbers, never "the first n that finished": with 32 workers that biases the mean
 * by 2.8 standard errors. It tests the first n0 replicates, and again after each further SAMPLE_BATCH.
 *
 * Chow and Robbins add 1/n to the variance, so that a chance run of equal values does not stop too early. Here 1/n is
 * in units of (SAMPLE_GUARD half_width)^2, so that the rule does not depend on the unit of the values. Measured with
 * values that are 1 in a tenth of the runs and else 0, at a nominal level of 95 %: n0 = 3 without this guard covers
 * .68-.74, n0 = 30 without it .85-.89, n0 = 30 with it .91-.96 (normal data .968). The guard needs 15 % more runs at
 * 100 and 5 % at 220. Values that never vary stop at 50. */
enum { SAMPLE_FIRST = 30, SAMPLE_BATCH = 10, SAMPLE_GUARD = 20 };

/* values[r] of replicate r; NaN (a failed run) is left out of the statistics. True when a campaign may stop at the
 * prefix of length n. */
bool sample_may_stop(size_t n, const double *values, double half_width, double level, size_t n0);

#endif
