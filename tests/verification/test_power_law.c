/* Exact answers: stationary likelihoods for any exponent, the normalisation against closed forms, invariances. */
#include <gsl/gsl_sf_gamma.h>

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

/* The sample mean of a cut exponential, straight from its definition; the fit must return the rate. */
static double exact_mean(double k, double span) {
  if (isinf(span))
    return 1 / k;
  if (k == 0)
    return span / 2;
  return 1 / k - span / expm1(k * span);
}

TEST(masses_any_exponent) {
  const double betas[] = {-1, 0, 0.5, 0.999, 1, 1.001, 1.5, 2, 3.7, 8}, spans[] = {0.7, 3, 9, HUGE_VAL};
  for (size_t s = 0; s < 4; s++) {
    for (size_t b = 0; b < sizeof betas / sizeof *betas; b++) {
      double k = betas[b] - 1;
      if (isinf(spans[s]) && k <= 0)
        continue;
      struct power_law_group group = {100, exact_mean(k, spans[s]), spans[s], 0};
      struct power_law fit = power_law_fit(1, &group);
      /* The definition itself loses digits for small k: 1e-16 of 1/k over the slope of the mean, span^2/12. */
      assert_true(fabs(fit.beta - betas[b]) < 1e-11);
      assert_true(fit.standard_error > 0);
    }
  }
  /* beta exactly 1: u uniform, standard error sqrt(12/n)/span. */
  struct power_law_group uniform = {400, 2.5, 5, 0};
  struct power_law fit = power_law_fit(1, &uniform);
  assert_true(fabs(fit.beta - 1) < 1e-15 && fabs(fit.standard_error - sqrt(12.0 / 400) / 5) < 1e-14);
  assert_true(fabs(fit.log_likelihood + 400 * log(5)) < 1e-10);
}

TEST(groups_are_one_sample) {
  struct power_law_group one = {30, 0.8, 5, 0}, split[3] = {{10, 0.5, 5, 0}, {12, 1.0, 5, 0}, {8, 0.875, 5, 0}};
  assert_true(fabs((10 * 0.5 + 12 * 1.0 + 8 * 0.875) / 30 - 0.8) < 0.04);
  one.mean = (10 * 0.5 + 12 * 1.0 + 8 * 0.875) / 30;
  struct power_law a = power_law_fit(1, &one), b = power_law_fit(3, split);
  assert_true(fabs(a.beta - b.beta) < 1e-13 && fabs(a.standard_error - b.standard_error) < 1e-13);
  /* A group at one end of its window says nothing alone, but does not spoil the others. */
  struct power_law_group with_edge[2] = {{10, 0.5, 5, 0}, {1, 0, 3, 0}};
  assert_true(isfinite(power_law_fit(2, with_edge).beta));
  assert_true(isnan(power_law_fit(1, &with_edge[1]).beta));
  assert_true(isnan(power_law_fit(0, NULL).beta));
}

TEST(normalisation_is_incomplete_gamma) {
  /* Z = integral over m > a of (m/a)^-beta exp(-(m-a)/xc) dm/m... = e^s s^k Gamma(-k, s), also for negative arguments.
   */
  const double ks[] = {-1.5, -0.3, 0.5, 1, 1.7, 3}, rates[] = {1e-6, 1e-3, 0.1, 1, 20};
  for (size_t i = 0; i < 6; i++) {
    for (size_t j = 0; j < 5; j++) {
      double k = ks[i], s = rates[j];
      double exact = s + k * log(s) + log(gsl_sf_gamma_inc(-k, s));
      double ours = power_law_log_normalisation(POWER_LAW_CUTOFF, k, s, HUGE_VAL, NULL, NULL);
      /* quadrature error, and GSL's own near-cancellation at small s (its stated error grows to 1e-10) */
      if (!(fabs(ours - exact) < 1e-9 * (1 + fabs(exact))))
        fail_msg("k %g s %g: %.15g, exact %.15g", k, s, ours, exact);
    }
  }
  /* Without the factor the closed form of the pure law. */
  for (size_t i = 0; i < 6; i++) {
    double k = ks[i], span = 9, exact = log(-expm1(-k * span) / k);
    assert_true(fabs(power_law_log_normalisation(POWER_LAW_CUTOFF, k, 0, span, NULL, NULL) - exact) < 1e-12);
    assert_true(fabs(power_law_log_normalisation(POWER_LAW_LOGNORMAL, k, 0, span, NULL, NULL) - exact) < 1e-12);
  }
  /* Half a normal curve. */
  double half = power_law_log_normalisation(POWER_LAW_LOGNORMAL, 0, 0.5, HUGE_VAL, NULL, NULL);
  assert_true(fabs(half - log(sqrt(M_PI / 2))) < 1e-12);
}

TEST(moments_are_derivatives) {
  for (int kind = POWER_LAW_CUTOFF; kind <= POWER_LAW_LOGNORMAL; kind++) {
    double mean[2], covariance[3], k = 0.8, s = 0.05, step = 1e-5;
    enum power_law_kind which = (enum power_law_kind)kind;
    power_law_log_normalisation(which, k, s, 7, mean, covariance);
    double up = power_law_log_normalisation(which, k + step, s, 7, NULL, NULL);
    double down = power_law_log_normalisation(which, k - step, s, 7, NULL, NULL);
    double here = power_law_log_normalisation(which, k, s, 7, NULL, NULL);
    /* central differences: error step^2, and 1e-16/step (1e-16/step^2 for the second) of rounding */
    assert_true(fabs(mean[0] + (up - down) / (2 * step)) < 1e-8);
    assert_true(fabs(covariance[0] - (up - 2 * here + down) / (step * step)) < 1e-4);
    up = power_law_log_normalisation(which, k, s + step, 7, NULL, NULL);
    down = power_law_log_normalisation(which, k, s - step, 7, NULL, NULL);
    assert_true(fabs(mean[1] + (up - down) / (2 * step)) <
                1e-4 * mean[1]); /* h reaches e^7: third derivative times step^2 */
  }
}

/* A narrow lognormal far from 0: its variance is 1/(2 s), that of h = u^2 is 2 u0^2/s + 1/(2 s^2), exact to rounding
 * although the squares of the means are a million times as large. */
TEST(covariances_do_not_cancel) {
  const double s = 3e3, u0 = 12;
  double mean[2], covariance[3];
  power_law_log_normalisation(POWER_LAW_LOGNORMAL, -2 * s * u0, s, HUGE_VAL, mean, covariance);
  assert_true(fabs(mean[0] - u0) < 1e-12 * u0 && fabs(mean[1] - u0 * u0 - 0.5 / s) < 1e-12 * u0 * u0);
  assert_true(fabs(covariance[0] * 2 * s - 1) < 1e-11);
  assert_true(fabs(covariance[1] * s / u0 - 1) < 1e-11);
  assert_true(fabs(covariance[2] / (2 * u0 * u0 / s + 0.5 / s / s) - 1) < 1e-11);
}

TEST(pure_sample_needs_no_factor) {
  /* Evenly spaced quantiles of a pure law with its upper tail thickened: s = 0 must be returned as such. */
  double u[200], masses[200];
  for (int i = 0; i < 200; i++) {
    u[i] = -log((i + 0.5) / 200) * 0.4 + (i < 5 ? 2 : 0);
    masses[i] = exp(u[i]);
  }
  struct power_law_group group = power_law_group_of(POWER_LAW_CUTOFF, 200, masses, 1, HUGE_VAL);
  struct power_law_rival fit = power_law_rival_fit(POWER_LAW_CUTOFF, 1, &group);
  assert_true(fit.rate == 0);
  double mean = 0;
  for (int i = 0; i < 200; i++)
    mean += u[i] / 200;
  assert_true(fabs(fit.beta - 1 - 1 / mean) < 1e-13);
}

/* Masses that are equal but for a thousandth, in a window that begins far below them: no method tells an exponent. The
 * law with a cut-off has one of -76 000 there. A rival that cannot be fitted has no p. */
TEST(near_equal_masses_have_no_exponent) {
  double masses[40];
  for (uint64_t i = 0; i < 40; i++)
    masses[i] = 1 + 0.01 * random_draw(4, 4, i, 0);
  for (int method = 0; method < EXPONENT_METHODS; method++)
    for (int end = 0; end < 2; end++) {
      struct exponent e;
      const struct exponent_window window = {end ? 0.5 : 0.999, end ? 2 : 100};
      assert_int_equal(exponent_fit((enum exponent_method)method, 40, masses, window, &e, NULL), STATUS_OK);
      assert_true(isnan(e.beta) || fabs(e.beta) < 101);
      assert_true(method != EXPONENT_UPPER_CUTOFF || (isnan(e.beta) && isnan(e.cutoff_mass)));
    }
  assert_true(isnan(power_law_rival_p_value(power_law_rival_ratio(&(struct power_law_rival){NAN, NAN, NAN, NAN}, 1))));
}

/* Moving all masses by a factor moves no exponent; the windows go along. */
TEST(units_do_not_matter) {
  double masses[300], scaled[300];
  for (uint64_t i = 0; i < 300; i++) {
    masses[i] = pow(1 - random_draw(3, 3, i, 0), -0.8);
    scaled[i] = masses[i] * 1e-5; /* 50 bins: bins move along exactly */
  }
  for (int method = 0; method < EXPONENT_METHODS; method++) {
    struct exponent a, b;
    assert_int_equal(exponent_fit((enum exponent_method)method, 300, masses, (struct exponent_window){1.1, 40}, &a,
                                  NULL),
                     0);
    assert_int_equal(exponent_fit((enum exponent_method)method, 300, scaled, (struct exponent_window){1.1e-5, 40e-5},
                                  &b, NULL),
                     0);
    assert_int_equal(a.n, b.n);
    assert_true(fabs(a.beta - b.beta) < 1e-6); /* the cut-off's Newton stops at 1e-7 of the standard error */
  }
}

/* betas without each part, against a fit of the rest. */
static void leave_out_like_fits(size_t count, const struct power_law_group *groups, size_t each, double tolerance) {
  struct power_law_group rest[256];
  double betas[256];
  assert_true(power_law_leave_out(count, groups, each, betas));
  for (size_t p = 0; p * each < count; p++) {
    size_t n = 0;
    for (size_t g = 0; g < count; g++)
      if (g / each != p)
        rest[n++] = groups[g];
    const double beta = power_law_fit(n, rest).beta;
    assert_true(isnan(beta) ? isnan(betas[p]) : fabs(betas[p] - beta) <= tolerance * (1 + fabs(beta)));
  }
}

TEST(leaving_out_is_fitting_the_rest) {
  struct power_law_group masses[203];
  for (uint64_t g = 0; g < 203; g++) {
    const double weight = 1 + floor(40 * random_draw(9, 1, g, 0)), span = 2 + 6 * random_draw(9, 2, g, 0);
    masses[g] = (struct power_law_group){weight, span * (0.1 + 0.4 * random_draw(9, 3, g, 0)), span, 0};
  }
  const size_t counts[] = {1, 2, 3, 5, 20, 100, 203};
  for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
    for (size_t each = 1; each <= 7; each += 3)
      leave_out_like_fits(counts[c], masses, each, 1e-11); /* the interpolation's own limit */

  struct power_law_group equal[100]; /* no part moves beta */
  for (int g = 0; g < 100; g++)
    equal[g] = (struct power_law_group){30, 2, 5, 0};
  leave_out_like_fits(100, equal, 1, 1e-13);

  struct power_law_group open[10]; /* windows without an end: y > 0 */
  for (int g = 0; g < 10; g++)
    open[g] = (struct power_law_group){5, g == 0 ? 50 : 0.1, HUGE_VAL, 0};
  leave_out_like_fits(10, open, 1, 1e-11);

  struct power_law_group ends[3] = {{10, 0, 4, 0},
                                    {10, 0, 4, 0},
                                    {10, 2, 4, 0}}; /* without the last, all are at one end */
  double betas[3];
  assert_true(power_law_leave_out(3, ends, 1, betas));
  assert_true(isfinite(betas[0]) && isfinite(betas[1]) && isnan(betas[2]));
}
