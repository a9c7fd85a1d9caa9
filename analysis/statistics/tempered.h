/* The two rivals of the pure power law: a power law with an exponential cut-off at large masses, and the lognormal.
 *
 * With u = ln(m/a), both are the power law times one more factor: f(u) = exp(-k u - s h(u)) / Z, 0 <= u < L, with k =
 * beta - 1 and s >= 0. Cut-off: h = e^u - 1, s = a / cut-off mass. Lognormal: h = u^2. So s = 0 is the power law
 * itself, and twice the difference of the log-likelihoods is a likelihood ratio.
 *
 * Both are exponential families: the log-likelihood is concave, and its derivatives are means and covariances of u and
 * h, so Newton's method converges. Z and the moments come from Gauss-Legendre panels in u. This is one formula for
 * every beta and any window, where the closed form Gamma(1 - beta, s) cancels or needs negative arguments (a test
 * compares them). Clauset, Shalizi & Newman (2009), doi 10.1137/070710111, tables 2.1 and 6. */
#ifndef CLAST_ANALYSIS_STATISTICS_TEMPERED_H
#define CLAST_ANALYSIS_STATISTICS_TEMPERED_H

#include <stdbool.h>
#include <stddef.h>

enum tempered_kind { TEMPERED_CUTOFF, TEMPERED_LOGNORMAL };

struct tempered {
  double beta, standard_error; /* NaN when there is no fit; for the lognormal: the local exponent at m = a */
  double rate;                 /* s; 0: the pure power law is the best of the family */
  double log_likelihood;       /* of u, natural log */
};

/* The sufficient statistics of the fragments in one run's window. Runs may have their own windows (power_law.h). */
struct tempered_group {
  double weight, mean_u, mean_h;
  double span; /* ln(b/a), or HUGE_VAL */
};
/* u: ln(m/a) of each fragment, all in [0, span). */
struct tempered_group tempered_group(enum tempered_kind kind, size_t n, const double *u, double span);
struct tempered tempered_fit(enum tempered_kind kind, size_t count, const struct tempered_group *groups);

/* 2 (lnL - lnL of the pure law) and its p-value. s = 0 lies on the boundary: under the pure law half of all samples
 * give 0, and the others follow chi-squared of one degree (Chernoff 1954), so p = P(chi2 > ratio)/2. This is
 * approximate below some hundred fragments. A small p rejects the pure law. */
double tempered_ratio(const struct tempered *fit, double pure_log_likelihood);
double tempered_p_value(double ratio);

/* ln Z and, where not NULL, mean (2) and covariance (uu, uh, hh) of (u, h). With an open window, s > 0 or k > 0 is
 * required. */
double tempered_log_normalisation(enum tempered_kind kind, double k, double s, double span, double mean[2],
                                  double covariance[3]);

#endif
