/* Exponents of fragment spectra, F(m) ~ m^-beta: differential, fragments per unit mass. The cumulative number N(>m) has
 * slope beta - 1.
 *
 * Least squares on logarithmic bins is the method of Kun & Herrmann (1999). With few fragments it is biased, because it
 * drops empty bins and gives a bin of one fragment the weight of a bin of hundreds: for a true 2.0 it gives 1.66 with
 * 100 fragments in a window without an upper end. Maximum likelihood has no such bias. Tests check both numbers. With
 * many runs, in the window of exponent_window_from(), every bin is filled and least squares is also unbiased.
 *
 * Grains of nearly equal mass make the masses of small fragments nearly discrete. A continuous fit that starts at one
 * grain then gives 2.8 for a true 2.0, so windows start at several mean element masses (estimates.h). */
#ifndef CLAST_ANALYSIS_STATISTICS_EXPONENT_H
#define CLAST_ANALYSIS_STATISTICS_EXPONENT_H

#include <stddef.h>
#include <stdint.h>

#include "analysis/statistics/spectrum.h"
#include "schemas/field.h"

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

/* An empty result: the given window, n = 0, everything else NaN. */
struct exponent exponent_unknown(enum exponent_method method, struct exponent_window window);

/* masses in any order (descending is fastest); values that are not positive and finite are left out. With too few
 * fragments or an empty window beta is NaN, n is set and the status is STATUS_OK. STATUS_USAGE: a window without 0 <
 * lower < upper, an unknown method. STATUS_MEMORY. */
status exponent_fit(enum exponent_method method, size_t n, const double *masses, struct exponent_window window,
                    struct exponent *out, struct error *error);
/* Least squares from bins alone, in ascending order. */
status exponent_fit_bins(size_t n, const struct spectrum_bin_row *bins, struct exponent_window window,
                         struct exponent *out, struct error *error);

/* The bins wholly inside a window: first <= bin < end; *end = INT32_MAX for an open window. */
void exponent_bins_inside(struct exponent_window window, int *first, int *end);

#endif
