/* Estimators against synthetic spectra whose exponent is known. The test must reproduce the biases measured before this
 * program was written (true exponent 2.0, 200 samples): least squares is biased, maximum likelihood is not. Every
 * tolerance is a Monte-Carlo error computed here, times four. */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { SAMPLES = 200, MOST = 1001 };
enum law { PURE, CUTOFF_AT_100, WITH_GIANT };

/* Pareto of density exponent 2 from 1 kg by inversion; with a cut-off by rejection on top. */
static size_t draw(enum law law, size_t n, uint64_t sample, double *masses) {
  uint64_t number = 0;
  for (size_t i = 0; i < n; i++) {
    do {
      masses[i] = 1 / (1 - random_draw(20, (uint64_t)law + 100, sample, number++));
    } while (law == CUTOFF_AT_100 && random_draw(21, 0, sample, number++) > exp(-masses[i] / 100));
  }
  if (law == WITH_GIANT)
    masses[n++] = 1e4; /* a remnant that belongs to no power law */
  return n;
}

struct result {
  double mean, deviation, quoted, error; /* error: Monte-Carlo standard error of the mean */
  int used;
};

static struct result measure(enum exponent_method method, enum law law, size_t n, struct exponent_window window) {
  double masses[MOST], beta[SAMPLES], quoted = 0, mean = 0, squares = 0;
  int used = 0;
  for (uint64_t s = 0; s < SAMPLES; s++) {
    struct exponent fit;
    size_t count = draw(law, n, s, masses);
    assert_int_equal(exponent_fit(method, count, masses, window, &fit, NULL), STATUS_OK);
    if (!isfinite(fit.beta))
      continue;
    beta[used++] = fit.beta;
    mean += fit.beta;
    quoted += fit.standard_error;
  }
  mean /= used;
  for (int i = 0; i < used; i++)
    squares += (beta[i] - mean) * (beta[i] - mean);
  double deviation = sqrt(squares / (used - 1));
  printf("  %-14s law %d n %4zu: %.3f +- %.3f (quoted %.3f), %d samples\n", exponent_method_names[method], (int)law, n,
         mean, deviation, quoted / used, used);
  return (struct result){mean, deviation, quoted / used, deviation / sqrt(used), used};
}

static const struct exponent_window from_1 = {1, HUGE_VAL};

/* Two independent sets of 200 samples (the table's and ours): the error of their difference is sqrt 2 of one. */
static void agrees(struct result result, double table) {
  double tolerance = 4 * sqrt(2) * result.error + 0.0005 /* the table's rounding */;
  if (!(fabs(result.mean - table) <= tolerance))
    fail_msg("mean %.4f, table %.4f, tolerance %.4f", result.mean, table, tolerance);
}

TEST(likelihood_is_unbiased) {
  struct result small = measure(EXPONENT_MASSES, PURE, 100, from_1),
                large = measure(EXPONENT_MASSES, PURE, 1000, from_1);
  agrees(small, 2.010);
  agrees(large, 1.999);
  /* Theory: mean 1 + (beta-1) n/(n-1), standard error (beta-1)/sqrt(n). */
  assert_true(fabs(large.mean - 2.0010) < 4 * large.error);
  assert_true(fabs(small.mean - 2.0101) < 4 * small.error);
  /* A standard deviation from 200 samples is known to 1/sqrt(400) = 5 %. */
  assert_true(fabs(large.deviation / large.quoted - 1) < 4 * 0.05);
  assert_true(fabs(small.deviation / small.quoted - 1) < 4 * 0.05);
  agrees(measure(EXPONENT_MASSES, CUTOFF_AT_100, 1000, from_1), 2.105);
  agrees(measure(EXPONENT_MASSES, WITH_GIANT, 1000, from_1), 1.992);
}

TEST(least_squares_has_its_known_bias) {
  struct result small = measure(EXPONENT_LEAST_SQUARES, PURE, 100, from_1);
  struct result large = measure(EXPONENT_LEAST_SQUARES, PURE, 1000, from_1);
  agrees(small, 1.660);
  agrees(large, 1.834);
  assert_true(fabs(large.deviation / 0.095 - 1) < 4 * sqrt(2) * 0.05);
  assert_true(large.quoted < 0.65 * large.deviation); /* .050 quoted for a scatter of .095 */
  agrees(measure(EXPONENT_LEAST_SQUARES, CUTOFF_AT_100, 1000, from_1), 2.134);
  agrees(measure(EXPONENT_LEAST_SQUARES, WITH_GIANT, 1000, from_1), 1.719);
}

TEST(cutoff_is_found) {
  agrees(measure(EXPONENT_UPPER_CUTOFF, PURE, 1000, from_1), 1.988);
  struct result with = measure(EXPONENT_UPPER_CUTOFF, CUTOFF_AT_100, 1000, from_1);
  agrees(with, 1.991);
  assert_true(fabs(with.deviation / with.quoted - 1) < 4 * 0.05);
}

/* Masses in whole grains, P(N) ~ N^-2, N >= 1: drawn by inversion from the sums themselves. */
static double grains(uint64_t sample, uint64_t i) {
  double left = random_draw(22, 0, sample, i) * M_PI * M_PI / 6, n = 1;
  while (left > 1 / (n * n) && n < 3000) { /* the rest of the sum beyond N is near 1/(N + 1/2) */
    left -= 1 / (n * n);
    n++;
  }
  return n < 3000 ? n : floor(1 / fmax(1.0 / 2999.5 - left, 1e-9));
}

TEST(equal_grains_are_discrete) {
  enum { N = 2000, SETS = 60 };
  /* From one grain up as if continuous: 1 + 1/mean(ln N) = 2.755, the sum done by hand (2.77 was measured). From
   * N - 1/2 the windows of estimates: 1.955, 1.996, 2.004. */
  const double lower[4] = {1, 1.5, 4.5, 9.5}, expected[4] = {2.755, 1.955, 1.996, 2.004};
  double mean[4] = {0}, squares[4] = {0};
  static double masses[N];
  for (uint64_t s = 0; s < SETS; s++) {
    for (uint64_t i = 0; i < N; i++)
      masses[i] = grains(s, i);
    for (int w = 0; w < 4; w++) {
      struct exponent fit;
      assert_int_equal(exponent_fit(EXPONENT_MASSES, N, masses, (struct exponent_window){lower[w], HUGE_VAL}, &fit,
                                    NULL),
                       STATUS_OK);
      mean[w] += fit.beta / SETS;
      squares[w] += fit.beta * fit.beta / SETS;
    }
  }
  for (int w = 0; w < 4; w++) {
    double standard_error = sqrt((squares[w] - mean[w] * mean[w]) / SETS),
           bias = 1.0 / (N / (lower[w] + 0.5)); /* (beta-1)/n */
    printf("  whole grains from %.1f: %.3f +- %.3f\n", lower[w], mean[w], standard_error);
    assert_true(fabs(mean[w] - expected[w]) < 4 * standard_error + 0.003 /* error of the expected numbers */ + bias);
  }
}
