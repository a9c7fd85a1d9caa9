/* Exponents of fragment spectra, F(m) ~ m^-beta (differential, per unit mass). `farm.md`-style biases are held in tests:
 * least squares on log bins is biased (it drops empty bins); maximum likelihood is ours. */
#ifndef CLAST_ANALYSIS_EXPONENT_H
#define CLAST_ANALYSIS_EXPONENT_H

#include <stddef.h>
#include <stdint.h>

#include "engine/spectrum.h"
#include "schemas/field.h"

enum exponent_method {
  EXPONENT_LEAST_SQUARES,   /* K99's way: unweighted least squares of log density on log-binned, non-empty bins */
  EXPONENT_BINNED,          /* maximum likelihood on the stored bins (Virkar & Clauset 2014) */
  EXPONENT_MASSES,          /* maximum likelihood on masses, bounded window (Hanel et al. 2017: any beta) */
  EXPONENT_KS,              /* the same with lower cut-off by Kolmogorov-Smirnov (Clauset, Shalizi & Newman 2009; plfit) */
  EXPONENT_CUTOFF,          /* power law with exponential cut-off, maximum likelihood; parameter2 = cut-off mass */
};

struct exponent_window { /* [lower, upper] kg; upper = HUGE_VAL for none */
  double lower, upper;
};

struct exponent {
  int method;              /* enum exponent_method */
  double lower, upper;     /* the window really used, kg */
  int64_t n;               /* fragments in the window */
  double beta;             /* NaN when n is too small; message in status */
  double standard_error;   /* of this sample alone (fragments taken as independent) */
  double cutoff_mass;      /* EXPONENT_CUTOFF, else NaN */
  double ks_distance;      /* goodness of fit, NaN where it does not apply */
  double log_likelihood;   /* NaN where it does not apply */
};
extern const struct field_table exponent_table;

/* masses in any order. Too few fragments or an empty window gives beta = NaN with n set, STATUS_OK. */
status exponent_fit(enum exponent_method method, size_t n, const double *masses, struct exponent_window window,
                    struct exponent *out, struct error *error);
/* From bins alone (LEAST_SQUARES and BINNED only). */
status exponent_fit_bins(enum exponent_method method, size_t n, const struct spectrum_bin_row *bins,
                         struct exponent_window window, struct exponent *out, struct error *error);

#endif
