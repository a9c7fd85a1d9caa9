/* The power law f(m) ~ m^-beta on a window [a, b), by maximum likelihood, for any beta (also 1 and below when b is
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
#ifndef CLAST_ANALYSIS_STATISTICS_POWER_LAW_H
#define CLAST_ANALYSIS_STATISTICS_POWER_LAW_H

#include <stdbool.h>
#include <stddef.h>

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

/* A larger beta - 1 is no exponent: the masses lie within some hundredth of one end of their windows, such as four
 * equal quarters of a body. */
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

#endif
