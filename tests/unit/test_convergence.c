/* Known answers of the statistics of a convergence study: bias, break-even, gain, frontier. */

#include "analysis/statistics/convergence.h"
#include "tests/support/check.h"

#define NEAR(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

TEST(biases) {
  /* Differences 1, 2, 3: mean 2, s = 1, half width t(2, .975) / sqrt 3 = 4.302653 / 1.732051 = 2.484138. */
  const double level[4] = {11, 22, 33, NAN}, reference[4] = {10, 20, 30, 40};
  struct convergence_difference d = convergence_bias(4, level, reference, true, 0.95);
  assert_int_equal(d.n, 3);
  NEAR(d.value, 2, 1e-12);
  NEAR(d.half_width, 2.484138, 1e-6);

  /* Welch: {1,2,3} and {2,4,6,8}: s^2/n 1/3 and 5/3; freedom 4/(1/18 + 25/27) = 4.07547; t(.975) = 2.756285 there (by
   * integration). */
  const double a[4] = {1, 2, 3, NAN}, b[4] = {2, 4, 6, 8};
  d = convergence_bias(4, a, b, false, 0.95);
  NEAR(d.value, -3, 1e-12);
  NEAR(d.half_width / sqrt(2), 2.756285, 1e-6);
  assert_true(isnan(convergence_bias(1, a, b, false, 0.95).half_width));
  assert_true(isfinite(convergence_bias(2, a, b, false, 0.95).half_width));
  /* Equal bits: the bias is zero, known exactly. */
  /* So do values that differ by rounding alone. */
  const double rounded[] = {nextafter(b[0], 9), b[1], b[2], nextafter(b[3], 9)};
  for (int paired = 0; paired < 2; paired++)
    assert_true(convergence_bias(4, rounded, b, paired, 0.95).value == 0);
  assert_true(convergence_bias(4, rounded, b, true, 0.95).half_width == 0);
  d = convergence_bias(4, b, b, true, 0.95);
  assert_true(d.value == 0 && d.half_width == 0);
}

TEST(correlations) {
  const double x[5] = {1, 2, 3, 4, 5}, y[5] = {1, 3, 2, 5, 4}, flat[5] = {1, 1, 1, 1, 1};
  const struct convergence_correlation r = convergence_correlate(5, x, y, 0.95);
  NEAR(r.value, 0.8, 1e-12);
  NEAR(r.low, tanh(atanh(0.8) - 1.959964 / sqrt(2)), 1e-6);
  NEAR(r.high, tanh(atanh(0.8) + 1.959964 / sqrt(2)), 1e-6);
  assert_true(isnan(convergence_correlate(5, x, flat, 0.95).value));
  assert_true(isnan(convergence_correlate(3, x, y, 0.95).value));

  NEAR(convergence_break_even(0.25), 0.8, 1e-12);
  NEAR(convergence_gain(0.8, 0.25), 1, 1e-12);
  NEAR(convergence_gain(0.6, 0.25), 1, 0); /* below break-even plain Monte Carlo is used */
  NEAR(convergence_gain(1, 0.25), 4, 1e-12);
  /* x^3 by x^2 on U(0,1) at a tenth of the cost: rho^2 = 35/36. Two-model control variate, budget 100 at cost 1:
   * variance of x^3 is 9/112, so 9/11200/gain = 8.0357e-4/gain. */
  const double rho = sqrt(35.0 / 36), gain = convergence_gain(rho, 0.1);
  NEAR(1 / gain, pow(sqrt(1.0 / 36) + sqrt(0.1 * 35 / 36), 2), 1e-12);
}

TEST(resolutions) {
  struct convergence_row level[3] = {{.step = 4, .mean = 0.5, .bias = -0.1, .bias_half_width = 0.02},
                                     {.step = 2, .mean = 0.56, .bias = -0.04, .bias_half_width = 0.01},
                                     {.step = 1, .mean = 0.6, .reference = true}};
  static const size_t place[3] = {LIMIT_LEVELS, 0, 1}; /* the coarsest has no run */
  struct limit_law law = {.verdict = LIMIT_SEEN, .distance = {{-0.14, -0.2, -0.1}, {-0.1, -0.15, 0.05}}};
  convergence_resolve(3, level, &law, place, true);
  NEAR(level[0].resolution, 0.12, 1e-12);
  NEAR(level[1].distance, -0.15, 1e-12);
  NEAR(level[1].distance_half_width, 0.05, 1e-12);
  NEAR(level[2].distance, -0.05, 1e-12);
  NEAR(level[2].resolution, 0.15, 1e-12); /* the interval's end that is farther from zero */
  assert_false(level[0].open);

  law.verdict = LIMIT_NOT_SEEN;
  convergence_resolve(3, level, &law, place, true);
  NEAR(level[0].resolution, 0.12, 1e-12);
  NEAR(level[2].resolution, 0.05, 1e-12); /* as far as the next coarser level at least */
  assert_true(level[0].open && level[2].open);

  /* Equal runs: no difference, which is no bound. A level without runs tells nothing. */
  law.verdict = LIMIT_CONSTANT;
  level[1].n = level[2].n = 3;
  convergence_resolve(3, level, &law, place, true);
  assert_true(isnan(level[0].resolution));
  assert_true(level[1].resolution == 0 && level[1].open && level[2].resolution == 0 && level[2].open);

  /* One run of a level has no interval: its difference is no error. */
  struct convergence_row one[] = {{.step = 1, .n = 8, .bias = 0.14, .bias_half_width = 0.03},
                                  {.step = 0.5, .n = 1, .bias = 0.009, .bias_half_width = NAN},
                                  {.step = 0.25, .n = 8, .reference = true}};
  law = (struct limit_law){.verdict = LIMIT_TOO_FEW};
  convergence_resolve(3, one, &law, (size_t[]){LIMIT_LEVELS, LIMIT_LEVELS, LIMIT_LEVELS}, false);
  assert_true(isnan(one[1].resolution) && one[1].open);
  NEAR(one[2].resolution, 0.17, 1e-12);

  /* Exact is exact: a choice has no step. */
  level[0].step = level[1].step = level[2].step = NAN;
  law.verdict = LIMIT_TOO_FEW;
  convergence_resolve(3, level, &law, place, true);
  assert_true(level[2].resolution == 0 && !level[2].open);

  /* Numbers without a step, such as how long to wait for a break, have no end: no bound, unless all runs are equal. */
  convergence_resolve(3, level, &law, place, false);
  NEAR(level[2].resolution, 0.05, 1e-12);
  assert_true(level[1].open && level[2].open);
  level[1].bias = level[1].bias_half_width = 0;
  convergence_resolve(3, level, &law, place, false);
  assert_true(level[2].resolution == 0 && !level[2].open);
}

/* The scene's own level without runs has the error of the law at its step; beyond the law, the largest and no bound. */
/* With one level that has runs nothing is compared: its runs may be equal, and the knob is not known to have no effect.
 */
TEST(one_level_tells_nothing) {
  for (int with_step = 0; with_step < 2; with_step++) {
    const double equal[4] = {0.4, 0.4, 0.4, 0.4};
    const double step = with_step ? 1 : NAN;
    struct convergence_row level[2] = {{.step = 2 * step, .mean = NAN, .bias = NAN, .bias_half_width = NAN},
                                       {.step = step, .n = 4, .mean = 0.4, .reference = true}};
    static const size_t place[2] = {LIMIT_LEVELS, 0};
    const struct limit_ladder ladder =
        {.levels = 1, .seeds = 4, .step = {1}, .values = {equal}, .least = -HUGE_VAL, .most = HUGE_VAL};
    struct limit_law law;
    assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
    assert_int_equal(law.verdict, LIMIT_TOO_FEW);
    convergence_resolve(2, level, &law, place, false);
    assert_true(isnan(level[1].resolution));
  }
}

TEST(own_level_without_runs) {
  const size_t place[] = {0, LIMIT_LEVELS, 1, 2};
  const struct limit_point own = {.step = 0.8, .distance = {0.1, -0.02, 0.2}};
  struct limit_law law = {.verdict = LIMIT_SEEN};
  struct convergence_row level[4] = {{.step = 1, .resolution = 0.3},
                                     {.step = 0.8, .resolution = NAN, .base = true},
                                     {.step = 0.5, .resolution = 0.15},
                                     {.step = 0.25, .resolution = 0.1, .reference = true}};
  convergence_resolve_own(4, level, &law, place, &own);
  NEAR(level[1].resolution, 0.2, 1e-12);
  NEAR(level[1].distance, 0.09, 1e-12);
  assert_true(!level[1].open && level[2].resolution == 0.15);

  law.dropped = 1; /* the law begins at a step of 0.5 */
  convergence_resolve_own(4, level, &law, place, &own);
  assert_true(level[1].resolution == 0.3 && level[1].open);
  law = (struct limit_law){.verdict = LIMIT_NOT_SEEN};
  convergence_resolve_own(4, level, &law, place, &own);
  assert_true(level[1].resolution == 0.3 && level[1].open);

  level[1].step = 0.1; /* finer than all others */
  convergence_resolve_own(4, level, &law, place, &own);
  assert_true(level[1].resolution == 0.1 && level[1].open);
  level[1].step = 0.8;

  const size_t all[] = {0, 1, 2, 3}; /* with runs it is a level like the others */
  level[1].resolution = 0.17;
  level[1].open = false;
  convergence_resolve_own(4, level, &law, all, &own);
  assert_true(level[1].resolution == 0.17 && !level[1].open);
}
