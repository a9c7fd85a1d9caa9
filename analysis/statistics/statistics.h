/* Statistics of runs: samples and their intervals, spectra of fragments and their exponents, the scatter over seeds,
 * and which input matters. Every number says how sure it is. Pure functions of arrays; convergence.h has those of
 * studies. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/bins.h"
#include "engine/fragments.h"
#include "schemas/field.h"
#include "schemas/status.h"

/* ---- samples ----
 *
 * Statistics of a sample with their uncertainty: every mean has its number of values and its interval. The store's
 * views compute the same in plain SQL (db/store/views.c), the page of `clast report` in JavaScript
 * (analysis/report/statistics.js); tests compare them. */

/* Orders of doubles, for qsort. */
int sample_ascending(const void *a, const void *b);
int sample_descending(const void *a, const void *b);

/* Running mean and sum of squared deviations (Welford 1962), without cancellation. All zero: no values yet. */
struct sample_moments {
  size_t n;
  double mean, squares;
  double scale; /* the squares are those of the values times this: sample_scale() of the largest one */
};
/* A power of two that brings values of up to this size to where their squares fit in a double: 1 for sizes from 1e-60
 * to 1e60, so that these keep their bits. */
double sample_scale(double largest);
/* Where variances are wanted, not their roots. STATUS_USAGE: no double holds them. */
status sample_squares_fit(size_t n, const double *values, struct error *error);
/* The same, and *about: the values less their mean, which the caller frees. */
status sample_about_mean(size_t n, const double *values, double **about, struct error *error);
void sample_add(struct sample_moments *moments, double value); /* NaN is left out */

struct sample_summary {
  size_t n;
  double mean, standard_deviation, standard_error;
  double half_width; /* of the confidence interval of the mean, by Student's t. NaN: the values are equal (or differ by
                        rounding, SAMPLE_ROUNDING of their size), which says nothing of how far the mean may be off */
  double low, high;  /* the interval. In sample_range: within it. A share: a bound also when all values are equal */
  bool weak;         /* a share only: few runs, of a kind whose interval often misses the mean */
};
#define SAMPLE_ROUNDING     1e-14
#define SAMPLE_FIT_ROUNDING 1e-12 /* the same of numbers that a fit has found */
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

/* The half width of that interval, of n values with this mean and standard deviation. NaN: they are equal, or too few.
 */
double sample_share_half_width(size_t n, double mean, double deviation, double level);

/* Upper 95 % bound of a standard deviation over its estimate from so many degrees of freedom (above 0), of a normal
 * law: 16 of 1, 1.6 of 10. */
double sample_deviation_factor(double freedom);

/* The values that a quantity can have: HUGE_VAL is no end. */
struct sample_range {
  double least, most;
  bool share; /* field_is_share() */
};
struct sample_range sample_range(const struct field *row); /* NULL: any values */
/* Ends the interval of a mean where the values end, which the mean cannot pass: it holds the mean as often as before.
 * The half width stays. Of a share it is sample_of_share(). */
void sample_in_range(struct sample_summary *summary, const struct sample_range *range, double level);
#define SAMPLE_SKEW      0.375
#define SAMPLE_SKEW_RUNS 25
#define SAMPLE_NARROW    0.045
#define SAMPLE_EDGE      0.14
#define SAMPLE_EDGE_SKEW 0.4
enum { SAMPLE_NARROW_RUNS = 40, SAMPLE_EDGE_RUNS = 20 };

/* Two-sided quantile of Student's t for a mean of n values: its interval's half width is this times its standard error.
 * NaN for n < 2 or a level outside (0, 1). */
double sample_student(size_t n, double level);

/* The same for any degrees of freedom above 0, whole numbers or not. */
double sample_student_of(double freedom, double level);

/* The mean of points whose runs share seeds. A seed that acts at all points alike moves all their means together: no
 * number of points averages it out, and the scatter between the points does not show it. With mean y_p of n_p runs at P
 * points, and r = y - y_p of each run,
 *     var(mean) = var(y_p) / P + C / (P (P - 1)),  C = sum over pairs p != q and their common seeds of
 *                 r_ps r_qs / sqrt(n_p (n_p - 1) n_q (n_q - 1)),
 * which is unbiased for points and seeds that are drawn independently, each with effects of its own (random effects,
 * crossed), if all points have the same seeds; where they share some of them only, it is too small (6 points of 3 seeds
 * out of 6: by 18 %). C below 0 counts as 0. Degrees of freedom are Satterthwaite's (1946, doi 10.2307/3002019), from
 * both scatters. Points of one run tell nothing of the seeds: C leaves them out. */
struct sample_crossed {
  double units;     /* degrees of freedom + 1. The number of points when C is 0 */
  double deviation; /* sqrt(units var(mean)): the half width is sample_student_of(units - 1) deviation / sqrt(units) */
};
struct sample_of_seed {
  int64_t seed;
  double value;
};
/* Point p has values[first[p]] ... values[first[p + 1] - 1], at least one. NaN for fewer than two points. False: no
 * memory. */
bool sample_crossed(size_t points, const size_t *first, const struct sample_of_seed *values,
                    struct sample_crossed *out);
/* The half width of the 95 % interval of that mean. NaN: one point, or they are equal. */
status sample_crossed_half_width(size_t points, const size_t *first, const uint64_t *seed, const double *values,
                                 double *half_width, struct error *error);

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

/* A variance with a part, `alike`, that comes from seeds which all points share. Few seeds tell this part badly: it has
 * the scatter of a variance of so many values, and more points do not mend it. The jackknife over three to eight seeds
 * holds such a share in 0.83 to 0.92 of the cases. */
struct sample_alike {
  size_t seeds;
  double points;
  double own, alike, whole; /* variances: of the seeds at a point, the shared part of it, and of all */
};
/* Half width of the 95 % interval of a share of `whole` that this scatter makes, by the chi-squared law. of_seeds: the
 * share contains the part `alike`; else the part is only in the whole. */
double sample_alike_half(const struct sample_alike *variance, double share, bool of_seeds);

/* The difference of two means. Runs with the same seed in both samples form pairs, so an effect of the seed that is
 * equal on both sides cancels. */
struct difference_value {
  int64_t seed;
  double value;
};

struct difference {
  struct sample_summary side[2]; /* of all values */
  size_t pairs;      /* pairs of runs with one seed that the interval is of; 0: the samples count as independent */
  double difference; /* second minus first: mean of the pairs, or of the means */
  double half_width; /* of the interval of the difference; NaN: too few values, or they do not vary */
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
/* The same of n values with this standard deviation. */
bool sample_may_stop_with(size_t n, double deviation, double half_width, double level);
/* The half width that the rule compares with `half_width`, guard included. NaN: fewer than two values. */
double sample_rule_half_width(size_t n, double deviation, double half_width, double level);
/* Are n values enough to stop if all are equal? From 41 on at a level of 0.95. */
bool sample_could_stop(size_t n, double level);

/* ---- spectra of masses ----
 *
 * The mass spectrum of one run on fixed logarithmic bins. Estimates and the store use the same edges.
 *
 * Bins are those of engine/bins.h, in kg. */

enum { SPECTRUM_BINS_PER_DECADE = BINS_PER_DECADE, SPECTRUM_NO_BIN = BINS_NONE };

int spectrum_bin(double mass); /* bins_of() */
double spectrum_edge(int bin); /* bins_edge(), kg */

/* The size of a fragment: diameter of the sphere, or in two dimensions of the disc, of its mass and this density. */
struct spectrum_size {
  double density; /* kg/m^3; 0: no sizes, an axis of masses */
  int dimensions; /* 2: masses are kg per metre of thickness; else 3 */
};
/* Position of a mass on the axis: kg, or m. spectrum_size_mass() is the inverse. */
double spectrum_size_of(const struct spectrum_size *size, double mass);
double spectrum_size_mass(const struct spectrum_size *size, double place);

struct spectrum_bin_row {
  int bin;
  int64_t count;
  double mass; /* sum, kg */
};

/* Fills the non-empty bins in ascending order. Masses are in any order (descending is fastest); those without a bin are
 * left out. Returns the number of bins. When that is more than `capacity`, the rows are not filled: call again with
 * that many rows. The order of summation is the order of `masses`. */
size_t spectrum_fill(size_t n, const double *masses, struct spectrum_bin_row *rows, size_t capacity);

/* ---- exponents of one spectrum ----
 *
 * Exponents of fragment spectra, F(m) ~ m^-beta: differential, fragments per unit mass. The cumulative number N(>m) has
 * slope beta - 1.
 *
 * Least squares on logarithmic bins is the method of Kun & Herrmann (1999). With few fragments it is biased, because it
 * drops empty bins and gives a bin of one fragment the weight of a bin of hundreds: for a true 2.0 it gives 1.66 with
 * 100 fragments in a window without an upper end. Maximum likelihood has no such bias. Tests check both numbers. With
 * many runs, in the window of exponent_window_from(), every bin is filled and least squares is also unbiased.
 *
 * Grains of nearly equal mass make the masses of small fragments nearly discrete. A continuous fit that starts at one
 * grain then gives 2.8 for a true 2.0, so windows start at several mean element masses (below). */

enum exponent_method {
  EXPONENT_LEAST_SQUARES, /* unweighted least squares of log density on non-empty log bins (Kun & Herrmann 1999) */
  EXPONENT_MASSES,        /* maximum likelihood in a bounded window (Hanel et al. 2017), any beta */
  EXPONENT_UPPER_CUTOFF,  /* power law times exp(-m/m_c), maximum likelihood; cutoff_mass = HUGE_VAL for none */
  EXPONENT_METHODS,
};
/* "least_squares"..., NULL-terminated; as stored and printed, where EXPONENT_UPPER_CUTOFF is "cutoff". */
extern const char *const exponent_method_names[];

/* [lower, upper) kg; upper = HUGE_VAL for none. It is half-open, so upper = M_1 leaves out the largest fragment. Given
 * M_1, the others are independent draws below it, and the bounded fits are exact conditional likelihoods. Least squares
 * uses the bins wholly inside. */
struct exponent_window {
  double lower, upper;
};
/* The window of a method from `lower` on for a run whose largest fragment is `largest`. Least squares: one decade,
 * which includes the largest fragment if it is inside. This follows the paper, where the histogram is straight "for at
 * least one order of magnitude" and only single grains are left out. Without the largest fragments, or in a window
 * without an upper end, more runs make it worse: the omitted fragments reduce the upper bins of all runs (a true 2.00
 * gives 2.14 with 20 runs, 2.48 with 1000). Other methods: up to M_1. */
struct exponent_window exponent_window_from(enum exponent_method method, double lower, double largest);

/* With fewer fragments (or, for least squares, fewer non-empty bins) beta is NaN. */
enum { EXPONENT_LEAST_FRAGMENTS = 5, EXPONENT_LEAST_BINS = 3 };

struct exponent {
  int method;            /* enum exponent_method */
  double lower, upper;   /* the window used, kg; upper may be HUGE_VAL */
  int64_t n;             /* fragments in the window */
  double beta;           /* NaN when there are too few */
  double standard_error; /* from this sample alone, with fragments taken as independent */
  double cutoff_mass;    /* EXPONENT_UPPER_CUTOFF: m_c (HUGE_VAL: none needed), else NaN */
  double ks_distance;    /* largest distance of the distribution functions; EXPONENT_MASSES, else NaN */
  double log_likelihood; /* of ln(m), natural logarithm; NaN for least squares */
};

/* Adds masses that differ from those `seen` to them. True when there are EXPONENT_LEAST_FRAGMENTS: fewer tell no
 * exponent, however many fragments there are. */
bool exponent_masses_differ(size_t n, const double *masses, size_t *count, double seen[EXPONENT_LEAST_FRAGMENTS]);
/* An empty result: the given window, n = 0, everything else NaN. */
struct exponent exponent_unknown(enum exponent_method method, struct exponent_window window);

/* masses in any order (descending is fastest); values that are not positive and finite are left out. With too few
 * fragments or an empty window beta is NaN, n is set and the status is STATUS_OK. STATUS_USAGE: a window without 0 <
 * lower < upper, an unknown method. STATUS_MEMORY. */
status exponent_fit(enum exponent_method method, size_t n, const double *masses, struct exponent_window window,
                    struct exponent *out, struct error *error);
/* Least squares from bins alone, in ascending order. element (kg): where masses are whole numbers of it, the width
 * of a bin is that of the whole numbers inside, each one wide; a bin from 6.3 to 7.9 elements is one wide. 0: they are
 * not. */
status exponent_fit_bins(size_t n, const struct spectrum_bin_row *bins, double element, struct exponent_window window,
                         struct exponent *out, struct error *error);
/* The greatest mass that four of five of the masses begin .. end - 1 are multiples of, or 0. Others may hold particles
 * of another body. Of a run's n masses (descending), those that differ show it; `lower` is the window's end. */
double exponent_step(size_t n, const double *masses, size_t begin, size_t end, double lower);
bool exponent_bin_may_be_empty(int bin, double element); /* no whole number of elements lies in it */

/* The bins wholly inside a window: first <= bin < end; *end = INT32_MAX for an open window. */
void exponent_bins_inside(struct exponent_window window, int *first, int *end);

/* ---- the power law ----
 *
 * The power law f(m) ~ m^-beta on a window [a, b), by maximum likelihood, for any beta (also 1 and below when b is
 * finite: Hanel, Corominas-Murtra, Liu & Thurner 2017, doi 10.1371/journal.pone.0170920).
 *
 * With u = ln(m/a), L = ln(b/a) and k = beta - 1, u has an exponential distribution of rate k, cut at L. The mean is
 * sufficient. The likelihood equation is
 *     sum_g n_g [ mean_g - L_g G(L_g k) ] = 0,   G(y) = 1/y - 1/(e^y - 1)
 * Its left side is monotone in k.
 *
 * Groups g are runs, each with its own window. A run's window ends at its largest fragment M_1, which is left out. This
 * is an exact conditional likelihood: given the maximum, the others are independent draws from [a, M_1).
 *
 * The pure law has two rivals: the law with an exponential cut-off at large masses, and the lognormal. Both are the
 * power law times one more factor: f(u) = exp(-k u - s h(u)) / Z, 0 <= u < L, with s >= 0. Cut-off: h = e^u - 1, s = a
 * / cut-off mass. Lognormal: h = u^2. So s = 0 is the power law itself, and twice the difference of the log-likelihoods
 * is a likelihood ratio. Both are exponential families: the log-likelihood is concave, and its derivatives are means
 * and covariances of u and h, so Newton's method converges. Z and the moments come from Gauss-Legendre panels in u.
 * This is one formula for every beta and any window, where the closed form Gamma(1 - beta, s) cancels or needs negative
 * arguments (a test compares them). Clauset, Shalizi & Newman (2009), doi 10.1137/070710111, tables 2.1 and 6. */

enum power_law_kind { POWER_LAW_PURE, POWER_LAW_CUTOFF, POWER_LAW_LOGNORMAL };

/* The sufficient statistics of the fragments in one window. */
struct power_law_group {
  double weight; /* number of fragments */
  double mean;   /* of u = ln(m/a) */
  double span;   /* ln(b/a); HUGE_VAL for no upper bound */
  double mean_h; /* of a rival's h(u); 0 for the pure law */
};
/* Of n masses in the window [lower, upper). */
struct power_law_group power_law_group_of(enum power_law_kind kind, size_t n, const double *masses, double lower,
                                          double upper);

/* A larger beta - 1 is no exponent, with or without a cut-off: the masses lie within some hundredth of one end of their
 * windows, such as four equal quarters of a body. */
#define POWER_LAW_STEEPEST 100

struct power_law {
  double beta, standard_error; /* NaN when the groups are empty or at one end (POWER_LAW_STEEPEST) */
  double log_likelihood;       /* of u, natural log */
};

struct power_law power_law_fit(size_t count, const struct power_law_group *groups);

/* beta without one part of the groups, for each part: betas[p] leaves out groups p * each to (p + 1) * each - 1 (the
 * last part may be shorter). NaN where the rest has no beta. Solving every equation again would cost parts x count.
 * Here each group is evaluated at a few nodes that all parts share; the result agrees with the solution within 1e-12.
 * False: no memory. */
bool power_law_leave_out(size_t count, const struct power_law_group *groups, size_t each, double *betas);

/* The distribution function of the pure law: share of a window's fragments below u = ln(m/a). */
double power_law_below(double beta, double u, double span);

struct power_law_rival {
  double beta, standard_error; /* NaN when there is no fit; for the lognormal: the local exponent at m = a */
  double rate;                 /* s; 0: the pure power law is the best of the family */
  double log_likelihood;       /* of u, natural log */
};
struct power_law_rival power_law_rival_fit(enum power_law_kind kind, size_t count,
                                           const struct power_law_group *groups);

/* 2 (lnL - lnL of the pure law) and its p-value. s = 0 lies on the boundary: under the pure law half of all samples
 * give 0, and the others follow chi-squared of one degree (Chernoff 1954), so p = P(chi2 > ratio)/2. This is
 * approximate below some hundred fragments. A small p rejects the pure law. */
double power_law_rival_ratio(const struct power_law_rival *fit, double pure_log_likelihood);
double power_law_rival_p_value(double ratio);

/* ln Z and, where not NULL, mean (2) and covariance (uu, uh, hh) of (u, h). With an open window, s > 0 or k > 0 is
 * required. */
double power_law_log_normalisation(enum power_law_kind kind, double k, double s, double span, double mean[2],
                                   double covariance[3]);

/* ---- all runs of a point ----
 *
 * A point's spectrum and exponents from all its runs together. Runs are independent, so errors come from the scatter
 * between runs, never from counting fragments.
 *
 * With maximum likelihood each run's largest fragment M_1 bounds the run's window and is left out. This loses almost no
 * information, and a giant remnant cannot bias the fit. Least squares has one window for all runs, which ends a decade
 * above its lower end; it leaves out no fragment (exponent_window_from()). */

/* Masses of the fragments of run r: masses[first[r]] ... masses[first[r + 1] - 1], descending, kg. Borrowed. */
struct pooled_runs {
  size_t count;
  const size_t *first; /* count + 1 */
  const double *masses;
};

/* The form of a spectrum. All zero: F(m), differential, by mass, with runs as units. */
struct pooled_form {
  bool cumulative; /* N(>m), fragments per run of at least that mass; else fragments per run and kg (or m) */
  struct spectrum_size size;
  /* Units for mean and interval: unit u contains the runs first_run[u] .. first_run[u + 1] - 1, such as all runs of a
   * point. Each has the same weight. NULL: every run is a unit. */
  size_t units;
  const size_t *first_run;
  const uint64_t *seed; /* of every run: the interval is that of sample_crossed(). NULL: no units share seeds */
};
/* A non-empty bin. Of a cumulative spectrum: any bin; it counts the fragments above its lower end. */
struct pooled_bin {
  int bin;
  double lower, upper; /* kg, or m */
  int64_t count;       /* fragments of all runs; cumulative: of this bin and all above */
  double mass;         /* of these fragments, kg */
  double value;        /* F or N: the mean over the units */
  double
      half_width; /* of the 95 % interval of the value over the units (Student's t); NaN for one unit, or equal ones */
};
/* Half width of the 95 % interval of the mean count per run in a bin, from the scatter between runs (Student's t).
 * count, squares: sum over the runs of their counts and of the squares. NaN for fewer than two runs, and when
 * all runs have the same count. */
double pooled_spectrum_count_hw95(size_t runs, double count, double squares);

/* Computes the bins in ascending order; the caller frees *bins. Differential: the non-empty bins. Cumulative: all bins
 * from the first to the last non-empty one. */
status pooled_spectrum(const struct pooled_runs *runs, const struct pooled_form *form, struct pooled_bin **bins,
                       size_t *count, struct error *error);

/* The mean over the units of a form, and its 95 % interval, of a number of each run; and of its number of fragments of
 * at least a mass, which N(>m) has. */
status pooled_mean(size_t runs, const struct pooled_form *form, const double *number, double *mean, double *half_width,
                   struct error *error);
status pooled_number(const struct pooled_runs *runs, const struct pooled_form *form, double from, double *mean,
                     double *half_width, struct error *error);

/* The exponent of a power law has four names: F(m) ~ m^-beta, N(>m) ~ m^-(beta - 1), and by size in d dimensions F(L) ~
 * L^-(d (beta - 1) + 1), N(>L) ~ L^-(d (beta - 1)). These functions convert its value and its half width to a form. */
double pooled_spectrum_exponent(const struct pooled_form *form, double beta);
double pooled_spectrum_half_width(const struct pooled_form *form, double half_width);

struct pooled_exponent {
  struct exponent fit; /* fit.standard_error takes fragments as independent; fit.upper is the largest one of the runs */
  struct sample_interval interval; /* over runs: quote this error. NaN for one run */
  size_t runs;                     /* number of runs with fragments in their window */
};
/* Why tables for people and pictures show no beta: its whole number is not known, by the interval or by
 * fit.standard_error. NULL: they show it. */
const char *pooled_exponent_untold(const struct pooled_exponent *exponent);
/* Why a beta of several runs has no interval. NULL: it has one. */
const char *pooled_exponent_no_interval(const struct pooled_exponent *exponent);
/* Decimals of beta for people where no interval gives them. */
int pooled_exponent_decimals(const struct pooled_exponent *exponent);
/* Appends a reason to "not known to a whole number: ...", unless it is there or NULL. */
void pooled_exponent_tell(const char *reason, char *text, size_t size);
/* Methods: least squares or on masses; STATUS_USAGE for another one. lower: kg, the same for all runs of
 * the point (a number of mean element masses). level: 0.95 for a 95 % interval. The cost is microseconds per run. */
status pooled_exponent(const struct pooled_runs *runs, enum exponent_method method, double lower, double level,
                       struct pooled_exponent *out, struct error *error);

/* The window of run r from a mass `lower` on: fragments [*begin, *end), below its largest fragment, whose mass is
 * returned (NaN: none is so heavy). Fragments of the same mass as the largest are also left out. */
double pooled_window(const struct pooled_runs *runs, size_t r, double lower, size_t *begin, size_t *end);

/* The contribution of each run to the exponent, so that points with the same seeds can be compared seed by seed:
 * values[r] = beta + (n - 1) (mean of the others - beta without run r), with n the number of runs. Their mean is beta,
 * and Student's interval of their mean is the interval of pooled_exponent (up to SAMPLE_GROUPS runs; with more,
 * pooled_exponent uses groups). The differences of these values between two points are the contributions to the
 * difference of their exponents. All NaN where pooled_exponent has no interval. `values` has space for runs->count
 * numbers. */
status pooled_exponent_of_runs(const struct pooled_runs *runs, enum exponent_method method, double lower,
                               double *values, struct error *error);

/* Does a power law fit the data at all? It uses the windows and numbers of fragments of
 * pooled_exponent by masses, and fits the law to every draw again. Fragments of one run are taken as independent. */
struct pooled_goodness {
  size_t n;        /* fragments */
  double distance; /* Kolmogorov's distance of the fragments from the fit; NaN: too few fragments */
  double p;        /* share of samples from the fit that are at least as far from their own fits */
  size_t draws;    /* number of samples drawn: fewer than requested when p is large */
};
/* Runs on all cores; the numbers do not depend on their count. */
status pooled_goodness(const struct pooled_runs *runs, double lower, size_t draws, struct pooled_goodness *out,
                       struct error *error);

/* Is the pure power law sufficient? Likelihood ratios against its two rivals in the same windows. */
struct pooled_rivals {
  int64_t n;
  double beta;                     /* pure */
  double cutoff_beta, cutoff_mass; /* HUGE_VAL: no cut-off needed */
  double cutoff_ratio, cutoff_p;   /* 2 dlnL; small p: the cut-off is needed */
  double lognormal_ratio, lognormal_p;
  double open_cutoff_p; /* of windows without an upper end that hold each run's largest fragment: the stronger test
                         * where this fragment follows the law, and wrong where it is a remnant of the body */
};
status pooled_rivals(const struct pooled_runs *runs, double lower, struct pooled_rivals *out, struct error *error);

/* ---- the standard set of exponents ----
 *
 * The standard set of exponents that every run stores: several methods and windows, so that later comparisons need no
 * new run. Exponents of a point have rows of the same table. */

/* An element is a grain or a particle. Windows begin midway between N - 1 and N mean element masses, N = 2, 5, 10, and
 * end below the run's largest fragment M_1. None begins below the mass from which the spectrum is complete (outcome:
 * complete_mass), so in sph, where it is 10 particles, all begin there. FROM_2 is the choice of Kun & Herrmann (1999):
 * all fragments except single grains. FROM_5 is between the others and shows the trend.
 *
 * The masses of small fragments of nearly equal grains are nearly discrete. A continuous fit from one grain reads 2.76
 * for a true 2.0. With equal grains, windows from N - 1/2 read 1.96, 2.00, 2.00 (from N: 2.32, 2.11, 2.05); with grains
 * whose masses scatter by 30 %, 1.92, 2.01, 2.00. */
enum estimates_window { ESTIMATES_FROM_2, ESTIMATES_FROM_5, ESTIMATES_FROM_10, ESTIMATES_WINDOWS };
extern const char *const estimates_window_names[];              /* "from_2"..., NULL-terminated */
double estimates_window_elements(enum estimates_window window); /* lower end in mean element masses: 1.5, 4.5, 9.5 */
/* Lower end, kg: the window's number of mean element masses, but at least complete_mass (NaN: not known). */
double estimates_window_lower(enum estimates_window window, double element_mass, double complete_mass);

struct estimate {
  int window;          /* enum estimates_window */
  bool headline;       /* the estimate that is called `beta` */
  struct exponent fit; /* fit.cutoff_mass is also NaN where no cut-off was needed */
  double half_width;   /* of the 95 % interval of beta over the runs of a point; NaN for one run */
};
extern const struct field_table estimates_table;

/* The headline is maximum likelihood on masses of at least 5 elements, without the largest fragment M_1. It does not
 * have the bias of least squares. A giant remnant, which belongs to no power law, is left out. 5 elements is the lowest
 * window without effects of discrete masses. A run of 1100 grains has some 30 such fragments: its standard error is
 * about 0.2 and its bias, as for any ratio of small numbers, about (beta - 1)/n. Pool runs. */
enum {
  ESTIMATES_HEADLINE_METHOD = EXPONENT_MASSES,
  ESTIMATES_HEADLINE_WINDOW = ESTIMATES_FROM_5,
  ESTIMATES_COUNT = 2 * ESTIMATES_WINDOWS + 1, /* least_squares and masses in each window; cutoff from 5 */
};

/* Fragments in descending order of mass. They include those of one element, which are part of the mean element mass
 * (total mass over total count) but not of the windows. complete_mass: kg, from the outcome: no window begins below it.
 * Fills all rows; too few fragments give beta = NaN. */
status estimates_make(size_t n, const struct fragment *fragments, double complete_mass,
                      struct estimate rows[ESTIMATES_COUNT], struct error *error);

/* Parses the name of an exponent of a point: "beta" is the headline, "beta_METHOD_WINDOW" ("beta_masses_from_2")
 * another one. *is = false for other names; STATUS_USAGE for an unknown name that begins with beta. */
status estimates_named(const char *name, bool *is, enum exponent_method *method, enum estimates_window *window,
                       struct error *error);
/* The name under which studies store it: the headline's long name becomes "beta"; other names do not change. */
const char *estimates_short_name(const char *name);

/* ---- measured spectra ----
 *
 * A measured spectrum of fragments: a CSV file (schemas/csv.h), and its distance from simulated runs.
 *
 *     # source: Nakamura & Fujiwara (1991)      lines of remarks; three keys are read: source,
 *     # complete from: 0.1 g                    from which mass or size on all fragments were found,
 *     # density: 2.7 g/cm^3                     and the density that turns sizes into masses
 *     mass (g), count
 *     0.1, 214
 *
 * One column is `mass` or `size` (diameter of the sphere of equal volume) with its unit. Without another column, every
 * row is a fragment. A second one says how much a row stands for:
 *
 *     count                 the number of fragments from this mass up to that of the next row
 *     cumulative            N(>= m), the number of fragments of at least this mass
 *     retained (g or %)     the mass of the fragments of this class, which a sieve retains; the pan has size 0
 *     cumulative retained   the mass of all fragments of at least this mass or size
 *     passing (%)           the mass of all smaller fragments
 *
 * Beside a two-dimensional scene, masses are per metre of depth: mass (kg/m), retained (kg/m).
 * measured.c has the other names that laboratories use. `name`, `id`, `note` and the like are not read; a column
 * of any other name is refused. */

struct measured {
  bool single;      /* true: `mass` has every fragment; false: `mass` has thresholds, and `above` their numbers */
  bool bodies;      /* masses in kg beside those of a two-dimensional scene, kg/m: as if the bodies were 1 m deep */
  bool weighed;     /* `above` has masses: a sieve table */
  bool shares;      /* these are shares of the specimen's mass, not kg */
  size_t n;         /* masses, or thresholds */
  double *mass;     /* kg, ascending; owned */
  double *above;    /* N(>= mass[i]), or the mass of these fragments; owned */
  double complete;  /* kg; 0: the file does not give it */
  char source[200]; /* "" when the file does not give it */
};

/* size: converts a column of sizes into masses if the file gives no density (size->density 0: no conversion).
 * STATUS_MISSING, STATUS_IO, STATUS_CONTENT with line and remedy, STATUS_MEMORY. After an error *out is empty. */
status measured_read(const char *path, const struct spectrum_size *size, struct measured *out, struct error *error);
void measured_release(struct measured *measured); /* a zeroed one is fine */

/* Converts to bins of a spectrum, to be drawn beside others of the same form. Without intervals. The caller frees
 * *bins. whole: kg, the body that a sieve table of shares is drawn for. The number of a class follows from its mass.
 * Empty bins of single fragments from `complete` on belong to the next bin above, as they lower the mean. */
status measured_bins(const struct measured *measured, const struct pooled_form *form, double whole,
                     struct pooled_bin **bins, size_t *count, struct error *error);

/* Agreement of runs with measured data, for fragments of at least `complete` only. Shapes are compared, each normalised
 * by its own number of fragments; the numbers are given separately. Sieve tables: shares of the mass are compared
 * instead of numbers. */
enum { MATCH_RUNS = 20, MATCH_GROUPS = 4, MATCH_SMALL = 20, MATCH_MOST = 1000000000 };
struct measured_match {
  double from;      /* kg: lower limit of the fragments used; with thresholds, the first threshold from `complete` on */
  double fragments; /* number of measured fragments; NaN for a sieve table */
  double simulated; /* fragments per run: mean over the runs */
  double distance;  /* Kolmogorov's: greatest difference between both shares of fragments above a mass. NaN: fewer than
                       two measured fragments or classes, which have no shape */
  /* Of runs that are at least as far from the pool of the other runs: one experiment is one specimen, so a share below
   * 0.05 is evidence against the pool. The distance of a run with fewer than MATCH_SMALL fragments is mostly chance. If
   * two or more such runs have no more fragments together than were measured, the share is that of draws of so many
   * runs. They hide what differs between runs beside the chance of few fragments. NaN: fewer than `needed` runs are
   * judged: so few can be all nearer by chance. */
  double share;
  double log_likelihood; /* of the measured fragments in classes of mass (the store's bins, or the thresholds), if each
                            is drawn from the pool; half a fragment is added to each class. Compare it between pools
                            with the same `complete`. NaN for a sieve table */
  size_t judged;         /* runs with two or more fragments from `from` on */
  size_t needed;         /* MATCH_RUNS, or MATCH_GROUPS times the runs of a draw; MATCH_MOST: so many or more */
  size_t together;       /* runs of a draw; 1: single runs are judged */
};
status measured_compare(const struct measured *measured, const struct pooled_runs *runs, double complete,
                        struct measured_match *out, struct error *error);

/* ---- scatter over seeds ----
 *
 * The scatter of a point's runs over seeds: moments, quantiles and modes. Means, quantiles and shares of modes have
 * intervals. Standard deviation and skewness have none: those of the jackknife held the true value of lognormal samples
 * in 0.53 to 0.75 and in 0.00 to 0.28 of the cases, and a sample cannot tell that its law is of this kind. */

enum { SCATTER_QUANTILES = 5, SCATTER_SHAPE_RUNS = 20 };
extern const double scatter_shares[SCATTER_QUANTILES]; /* 0.05, 0.25, 0.5, 0.75, 0.95 */

struct scatter_quantile {
  double value;     /* interpolated between the two nearest values */
  double low, high; /* 95 % interval between two of the values, by the binomial law; NaN: too few values */
};
struct scatter {
  size_t n;                   /* number of values that are not NaN */
  double *sorted;             /* these values, ascending; owned */
  struct sample_summary mean; /* with the standard deviation and the 95 % interval of the mean */
  double skewness;            /* NaN: all values are equal, or fewer than SCATTER_SHAPE_RUNS. The error of ten values
                                 is as large as the skewness of most laws, and of a triple it is at most 0.71 */
  struct scatter_quantile quantile[SCATTER_QUANTILES];
  double dip, dip_share; /* scatter_dip(). Below 0.05 the values have at least two modes. NaN: not known, or fewer than
                            SCATTER_SHAPE_RUNS values: of these, the test finds chance more often than modes */
  /* The two classes with the least scatter within them (Fisher 1958), set only if dip_share is below 0.05: their means,
   * the value between them, and the share of the upper one with its 95 % interval (Wilson 1927). Else NaN. */
  double lower_mode, upper_mode, between;
  double upper_share, upper_low, upper_high;
};
/* The interval of out->mean is Student's; for shares the caller passes it to sample_of_share(). STATUS_MEMORY. */
status scatter_make(size_t n, const double *values, struct scatter *out, struct error *error);
void scatter_release(struct scatter *scatter);
/* One that is released where its block is left: SCATTER scatter = {0}; */
#define SCATTER __attribute__((cleanup(scatter_release))) struct scatter /* a zeroed one is fine */

/* Has a sample one mode? The dip (Hartigan & Hartigan 1985, doi 10.1214/aos/1176346577): the distance of the
 * distribution function of the sample from the nearest one with a single mode, between 1/(2n) and 1/4. The test needs
 * no bins, no bandwidth and no assumed distribution of the modes. values: ascending, finite. NaN when memory ran out or
 * n is 0. The cost is n times a small number of steps. */
double scatter_dip(size_t n, const double *values);

/* The share of one-mode samples of n values that have at least this dip. It is computed for the uniform law, which has
 * the largest dips, so for other laws it is too large, never too small. SCATTER_DIP_DRAWS samples are drawn, always the
 * same ones; fewer when the share is certainly above 0.05. Beyond SCATTER_DIP_MOST values the dip is known to shrink
 * with 1/sqrt(n). */
enum { SCATTER_DIP_DRAWS = 2000, SCATTER_DIP_MOST = 1000 };
double scatter_dip_share(size_t n, double dip);
/* The dip above which that share is below 0.05. It is meant for many samples of one size: all SCATTER_DIP_DRAWS samples
 * are drawn once. NaN: too few values. */
double scatter_dip_limit(size_t n);

/* Are the values whole numbers in so few steps that the steps themselves look like modes? Then the dip has no meaning.
 * sorted: ascending. */
bool scatter_in_steps(size_t n, const double *sorted);
/* Sets the two modes of scatter->sorted, which needs at least two values that are not all equal. */
void scatter_find_modes(struct scatter *scatter);

/* The number of runs for a 95 % interval of the mean with at most this half width, given this standard deviation. 0:
 * not known. */
size_t scatter_runs_needed(double deviation, double half_width);
/* The same of a share (sample_of_share()): what an interval of a table needs. */
size_t scatter_runs_of_share(double mean, double deviation, double half_width);
/* The number of runs at which a campaign's stopping rule (design_stopping_judge()) ends a point with this mean and
 * standard deviation, with its first prefix and its batch as they are by default. */
size_t scatter_runs_of_rule(double mean, double deviation, double half_width, bool share);

/* Edges of a histogram: Freedman and Diaconis's width 2 (q75 - q25)/n^(1/3), rounded to 1, 2 or 5 times a power of ten;
 * 1 to SCATTER_BINS bins. */
enum { SCATTER_BINS = 60 };
struct scatter_histogram {
  size_t bins;
  double from, width;
  size_t count[SCATTER_BINS];
};
/* width: of a bin; 0: as above. */
struct scatter_histogram scatter_histogram_of(const struct scatter *scatter, double width);
/* One width for the histograms of several samples in one panel: the median of their own widths, of the samples whose
 * values differ; larger if a sample had too many bins. */
double scatter_width_of_all(size_t count, const struct scatter *scatter);

/* ---- which input matters ----
 *
 * Which input matters: Sobol indices from a Saltelli design. The seed of a run is an additional input with its own
 * indices.
 *
 * Indices (Sobol 2001, doi 10.1016/S0378-4754(00)00270-6) are shares of the variance V of y(inputs, seed). First order:
 * the variance over an input of y averaged over all others. Total: the mean variance caused by the input when all
 * others are fixed. It exceeds the first order if the input interacts with others. */

/* Blocks of a design. A block has inputs + 2 points: A, B and, for every input i, A with input i from B. */
struct sensitivity_table {
  size_t inputs, blocks, seeds;
  const double *value;   /* value[(block * points of a block + point) * seeds + r] of the point's r-th seed */
  bool same_seeds;       /* true: index r is the same seed at all points; false: the seeds of points are independent */
  const uint32_t *group; /* group[block], ascending: blocks of one group are spread evenly, groups are independent;
                          * NULL: all blocks are independent */
};
struct sensitivity_index {
  /* 95 % intervals by the jackknife over groups of blocks and over seeds, whose variances are added (with one or two
   * seeds over groups alone, and none of the seed's first order). Seeds that all points share: sample_alike_half(). */
  struct sample_interval first, total;
};
/* index: an array of inputs + 1, the last one for the seed. With one seed all indices are for this seed, and the seed's
 * and all totals are NaN: each total would hold all the noise of the runs.
 * If the seeds differ between points, the total index of an input is that of the mean over seeds and does not include
 * its interaction with the seed. Estimators: first order Saltelli et al. (2010, doi 10.1016/j.cpc.2009.09.018) table 2
 * (b), total Jansen (1999); both use different seeds where noise would bias them. STATUS_USAGE: fewer than two
 * blocks. */
status sensitivity_sobol(const struct sensitivity_table *table, struct sensitivity_index *index, struct error *error);

/* First-order indices from any points: Latin hypercube, random, Sobol, lists, grids. An input is taken by the ranks of
 * its values, so a logarithmic axis is like any other; the index is of the values as the points have them.
 *
 * The means of the points are fitted by a sum of polynomials, one of each input. What a polynomial leaves is found in
 * the residuals, whose products are not 0 on average between neighbours along the input (as the estimator of Gamboa,
 * Gremaud, Klein & Lagnoux 2022 takes the values themselves, doi 10.3150/21-BEJ1421; the fit takes off the scatter that
 * other inputs make, which is most of the error there). The variance of the coefficients, by leaving points out, is
 * taken off, and an estimate is moved into its interval: with few points it is rather too small than too large.
 * Intervals: the law of an index is a gamma law with the variance that the influence of single points gives; points are
 * independent, seeds of a point are not points. Coverage: tests/verification/sensitivity_points.md. */
struct sensitivity_points {
  size_t inputs, points; /* inputs: at most LIMITS_AXES_OF_POOL */
  const double *x;       /* x[point * inputs + i]; of values without an order, their numbers */
  const bool *named;     /* named[i]: its values have no order */
  size_t most;           /* most runs of a point */
  const size_t *runs;    /* of each point, at least one */
  const double *value;   /* value[point * most + r] */
  bool same_seeds;       /* every point has the same seeds, in the same order */
};
struct sensitivity_share {
  double estimate, low, high; /* of the variance; the 95 % interval is within 0 and 1. NaN: not known */
};
struct sensitivity_point {
  enum {
    SENSITIVITY_TOLD,
    SENSITIVITY_ONE_VALUE, /* the input does not vary */
    SENSITIVITY_MOVES,     /* the other inputs, most of all `with`, tell its value: their effects cannot be separated */
    SENSITIVITY_SAME,  /* its values have the order of those of `with`, whose index is that of both: linked inputs */
    SENSITIVITY_STEPS, /* pairs of points differ in one input alone, as those of Saltelli: they are not independent
                        */
  } verdict;
  size_t with;
  struct sensitivity_share of_runs;  /* share of the variance of single runs, which has the scatter over seeds */
  struct sensitivity_share of_means; /* of the variance of the means over seeds. NaN: one seed, or too few points */
  size_t first_rank, last_rank; /* by of_means, else of_runs: an input with an interval that overlaps may be before or
                               behind */
};
/* index: an array of inputs + 1, the last one for the seeds (NaN with one seed for each point). What is left of the
 * whole is what inputs do together, and with one seed also the scatter over seeds. *needed: the least number of points
 * for an answer; if there are fewer, index has only verdicts of one value. STATUS_USAGE: all means are equal. */
status sensitivity_points(const struct sensitivity_points *given, struct sensitivity_point *index, size_t *needed,
                          struct error *error);
