/* A point's spectrum and exponents from all its runs together. Runs are independent, so errors come from the scatter
 * between runs, never from counting fragments.
 *
 * With maximum likelihood each run's largest fragment M_1 bounds the run's window and is left out. This loses almost no
 * information, and a giant remnant cannot bias the fit. Least squares has one window for all runs, which ends a decade
 * above its lower end; it leaves out no fragment (exponent_window_from()). */
#ifndef CLAST_ANALYSIS_STATISTICS_POOLED_H
#define CLAST_ANALYSIS_STATISTICS_POOLED_H

#include <stdbool.h>

#include "analysis/statistics/exponent.h"
#include "analysis/statistics/sample.h"

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

/* The exponent of a power law has four names: F(m) ~ m^-beta, N(>m) ~ m^-(beta - 1), and by size in d dimensions F(L) ~
 * L^-(d (beta - 1) + 1), N(>L) ~ L^-(d (beta - 1)). These functions convert its value and its half width to a form. */
double pooled_spectrum_exponent(const struct pooled_form *form, double beta);
double pooled_spectrum_half_width(const struct pooled_form *form, double half_width);

struct pooled_exponent {
  struct exponent fit; /* fit.standard_error takes fragments as independent; fit.upper is the largest one of the runs */
  struct sample_interval interval; /* over runs: quote this error. NaN for one run */
  size_t runs;                     /* number of runs with fragments in their window */
};
/* Methods: least squares or on masses; STATUS_USAGE for another one. lower: kg, the same for all runs of
 * the point (a number of mean element masses). level: 0.95 for a 95 % interval. The cost is microseconds per run. */
status pooled_exponent(const struct pooled_runs *runs, enum exponent_method method, double lower, double level,
                       struct pooled_exponent *out, struct error *error);

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

/* Is the pure power law sufficient? Likelihood ratios against its two rivals (power_law.h) in the same windows. */
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

#endif
