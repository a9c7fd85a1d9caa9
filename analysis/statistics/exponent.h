/* Exponents of fragment spectra, F(m) ~ m^-beta: differential, fragments per unit mass. (The cumulative number N(>m)
 * has slope beta - 1.) Least squares on log bins is the paper's way and biased, because it drops empty bins and weighs
 * a bin of one fragment like a bin of hundreds: 1.66 for a true 2.0 at 100 fragments. Maximum likelihood is ours. Tests
 * hold both to those numbers.
 *
 * Near-equal grains make masses nearly discrete, and a continuous fit from one grain up is badly off (2.8 for a
 * true 2.0): windows start at several mean element masses (estimates.h). */
#ifndef CLAST_ANALYSIS_STATISTICS_EXPONENT_H
#define CLAST_ANALYSIS_STATISTICS_EXPONENT_H

#include <stddef.h>
#include <stdint.h>

#include "analysis/statistics/spectrum.h"
#include "schemas/field.h"

enum exponent_method {
  EXPONENT_LEAST_SQUARES, /* K99's way: unweighted least squares of log density on log-binned, non-empty bins */
  EXPONENT_BINNED,        /* maximum likelihood on the stored bins (Virkar & Clauset 2014) */
  EXPONENT_MASSES,        /* maximum likelihood on masses, bounded window (Hanel et al. 2017: any beta) */
  EXPONENT_KS,     /* the same with lower cut-off by Kolmogorov-Smirnov (Clauset, Shalizi & Newman 2009; plfit) */
  EXPONENT_CUTOFF, /* power law with exponential cut-off, maximum likelihood; cutoff_mass = HUGE_VAL for none */
  EXPONENT_METHODS,
};
extern const char *const exponent_method_names[]; /* "least_squares"..., NULL-terminated */

/* [lower, upper) kg; upper = HUGE_VAL for none. Half-open, so that upper = M_1 leaves the largest fragment out: given
 * M_1, the others are independent draws below it, and the bounded fits are exact conditional likelihoods. Methods on
 * bins use the bins that lie wholly inside. */
struct exponent_window {
  double lower, upper;
};

/* Fewer fragments (or, for least squares, fewer than EXPONENT_LEAST_BINS non-empty bins) give beta = NaN. */
enum { EXPONENT_LEAST_FRAGMENTS = 5, EXPONENT_LEAST_BINS = 3 };

struct exponent {
  int method;            /* enum exponent_method */
  double lower, upper;   /* the window really used, kg; upper may be HUGE_VAL */
  int64_t n;             /* fragments in it */
  double beta;           /* NaN when there are too few */
  double standard_error; /* of this sample alone (fragments taken as independent); EXPONENT_KS: for its x_min taken as
                            given, 23-38 % too small: exponent_bootstrap() */
  double cutoff_mass;    /* EXPONENT_CUTOFF (HUGE_VAL: none needed), else NaN */
  double
      ks_distance; /* largest distance between the two distribution functions; EXPONENT_MASSES, EXPONENT_KS, else NaN */
  double log_likelihood; /* of ln(m) or of the bins; NaN for least squares */
};

/* masses in any order (descending is fastest); values that are not positive and finite are left out. Too few fragments
 * or an empty window gives beta = NaN with n set, STATUS_OK. STATUS_USAGE: a window without 0 < lower < upper, an
 * unknown method. STATUS_MEMORY. */
status exponent_fit(enum exponent_method method, size_t n, const double *masses, struct exponent_window window,
                    struct exponent *out, struct error *error);
/* From bins alone, ascending (LEAST_SQUARES and BINNED only; else STATUS_USAGE). */
status exponent_fit_bins(enum exponent_method method, size_t n, const struct spectrum_bin_row *bins,
                         struct exponent_window window, struct exponent *out, struct error *error);

/* First and last-but-one bin wholly inside a window: [*first, *end); *end = INT32_MAX for an open one. */
void exponent_bins_inside(struct exponent_window window, int *first, int *end);

#endif
