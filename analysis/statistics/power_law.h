/* The pure power law f(m) ~ m^-beta on a window [a, b), by maximum likelihood, for any beta (also 1 and below when b is
 * finite: Hanel, Corominas-Murtra, Liu & Thurner 2017, doi 10.1371/journal.pone.0170920).
 *
 * With u = ln(m/a), L = ln(b/a) and k = beta - 1, u has an exponential distribution of rate k, cut at L. The mean is
 * sufficient. The likelihood equation is
 *     sum_g n_g [ mean_g - L_g G(L_g k) ] = 0,   G(y) = 1/y - 1/(e^y - 1)
 * Its left side is monotone in k.
 *
 * Groups g are runs, each with its own window. A run's window ends at its largest fragment M_1, which is left out. This
 * is an exact conditional likelihood: given the maximum, the others are independent draws from [a, M_1). */
#ifndef CLAST_ANALYSIS_STATISTICS_POWER_LAW_H
#define CLAST_ANALYSIS_STATISTICS_POWER_LAW_H

#include <stdbool.h>
#include <stddef.h>

/* The sufficient statistic of the fragments in one window. */
struct power_law_group {
  double weight; /* number of fragments */
  double mean;   /* of ln(m/a) */
  double span;   /* ln(b/a); HUGE_VAL for no upper bound */
};

struct power_law {
  double beta, standard_error; /* NaN when the groups are empty or all at one end */
  double log_likelihood;       /* of u, natural log */
};

struct power_law power_law_fit(size_t count, const struct power_law_group *groups);

/* beta without one part of the groups, for each part: betas[p] leaves out groups p * each to (p + 1) * each - 1 (the
 * last part may be shorter). NaN where the rest has no beta. Solving every equation again would cost parts x count.
 * Here each group is evaluated at a few nodes that all parts share; the result agrees with the solution within 1e-12.
 * False: no memory. */
bool power_law_leave_out(size_t count, const struct power_law_group *groups, size_t each, double *betas);

/* The distribution function: share of a window's fragments below u = ln(m/a). */
double power_law_below(double beta, double u, double span);

#endif
