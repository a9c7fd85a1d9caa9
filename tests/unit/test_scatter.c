/* Scatter of a sample: known quantiles, modes, numbers of runs; coverage of the intervals; the split of a variance. */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

static double normal(uint64_t a, uint64_t b, uint64_t c) {
  return sqrt(-2 * log1p(-random_draw(21, a, b, 2 * c))) * cos(2 * M_PI * random_draw(21, a, b, 2 * c + 1));
}

TEST(known_samples) {
  double x[101];
  struct scatter s;
  for (int i = 0; i <= 100; i++)
    x[i] = i * 37 % 101; /* 0..100 in another order */
  assert_int_equal(scatter_make(101, x, &s, NULL), STATUS_OK);
  assert_true(s.n == 101 && s.mean.mean == 50 && fabs(s.skewness) < 1e-12);
  assert_true(fabs(s.mean.standard_deviation - sqrt(101 * 102 / 12.0)) < 1e-12);
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    assert_true(fabs(s.quantile[q].value - 100 * scatter_shares[q]) < 1e-12);
  /* Median of 101: P(B <= 40) = 0.023, P(B <= 41) = 0.037 for B(101, 1/2): from the 41st to the 61st value. */
  assert_true(s.quantile[2].low == 40 && s.quantile[2].high == 60);
  assert_true(isnan(s.between) && s.dip_share > 0.5);
  const struct scatter_histogram h = scatter_histogram_of(&s, 0);
  size_t sum = 0;
  for (size_t b = 0; b < h.bins; b++)
    sum += h.count[b];
  assert_true(sum == 101 && h.width == 50 && h.from == 0); /* 2 x 50 / 101^(1/3) = 21.5 -> 50 */
  scatter_release(&s);

  const double few[4] = {3, NAN, 1, 2};
  assert_int_equal(scatter_make(4, few, &s, NULL), STATUS_OK);
  assert_true(s.n == 3 && s.quantile[2].value == 2 && isnan(s.quantile[2].low) && isnan(s.dip_share));
  assert_true(isnan(s.skewness)); /* few values tell none */
  scatter_release(&s);
  assert_int_equal(scatter_make(0, few, &s, NULL), STATUS_OK);
  assert_true(s.n == 0 && isnan(s.mean.mean) && isnan(s.quantile[0].value) && scatter_histogram_of(&s, 0).bins == 0);
  scatter_release(&s);
  double same[30]; /* 30 times 1/30 is not 1 in floating point */
  for (int i = 0; i < 30; i++)
    same[i] = 1;
  assert_int_equal(scatter_make(30, same, &s, NULL), STATUS_OK);
  assert_true(s.mean.standard_deviation == 0 && isnan(s.skewness) && scatter_histogram_of(&s, 0).bins == 1);
  assert_true(isnan(s.mean.half_width) && isnan(s.mean.low) && isnan(s.mean.high));
  scatter_release(&s);
}

/* Samples in one panel have bins of one width: the median of their own, of those whose values differ. */
TEST(one_width) {
  double x[3][100];
  struct scatter s[4];
  const double alike[3] = {20, 20, 20};
  for (int i = 0; i < 100; i++)
    for (int k = 0; k < 3; k++)
      x[k][i] = i * pow(10, k - 2);
  for (int k = 0; k < 3; k++)
    assert_int_equal(scatter_make(100, x[k], &s[k], NULL), STATUS_OK);
  assert_int_equal(scatter_make(3, alike, &s[3], NULL), STATUS_OK);
  assert_true(scatter_histogram_of(&s[0], 0).width == 0.5 && scatter_histogram_of(&s[2], 0).width == 50);
  assert_true(scatter_width_of_all(4, s) == 5 && scatter_width_of_all(1, s + 3) == 2);
  const struct scatter_histogram h = scatter_histogram_of(&s[2], 5);
  assert_true(h.width == 5 && h.bins == 20 && h.count[0] == 5 && h.count[19] == 5);
  for (int k = 0; k < 100; k++)
    x[2][k] *= 10; /* 0 to 990 has no room in 60 bins of 5 */
  scatter_release(&s[2]);
  assert_int_equal(scatter_make(100, x[2], &s[2], NULL), STATUS_OK);
  assert_true(scatter_width_of_all(4, s) == 500);
  for (int k = 0; k < 4; k++)
    scatter_release(&s[k]);
}

TEST(two_modes) {
  double x[60];
  struct scatter s;
  for (uint64_t i = 0; i < 60; i++) /* a bridge that holds in a quarter of the runs */
    x[i] = (i % 4 ? 0.3 : 0.8) + 0.02 * normal(1, 1, i);
  assert_int_equal(scatter_make(60, x, &s, NULL), STATUS_OK);
  assert_true(s.dip_share < 0.05);
  assert_true(fabs(s.lower_mode - 0.3) < 0.01 && fabs(s.upper_mode - 0.8) < 0.02);
  assert_true(s.between > 0.4 && s.between < 0.75 && s.upper_share == 0.25);
  assert_true(fabs(s.upper_low - 0.1578) < 1e-4 && fabs(s.upper_high - 0.3723) < 1e-4); /* Wilson, 15 of 60 */
  scatter_release(&s);
  assert_int_equal(scatter_make(8, x, &s, NULL), STATUS_OK); /* few runs tell no modes */
  assert_true(isnan(s.dip_share) && isnan(s.between));
  scatter_release(&s);
}

/* Counts around 7 +- 2 look like a comb: no modes are reported. Counts of thousands may have two. */
TEST(counts_in_few_steps) {
  double x[200];
  struct scatter s;
  for (uint64_t i = 0; i < 200; i++)
    x[i] = round(7 + 2 * normal(7, 1, i));
  assert_int_equal(scatter_make(200, x, &s, NULL), STATUS_OK);
  assert_true(s.dip > scatter_dip_limit(200)); /* the dip test alone would report two modes */
  assert_true(isnan(s.dip_share) && isnan(s.between));
  scatter_release(&s);
  for (uint64_t i = 0; i < 200; i++)
    x[i] = round((i % 2 ? 3000 : 5000) + 100 * normal(7, 2, i));
  assert_int_equal(scatter_make(200, x, &s, NULL), STATUS_OK);
  assert_true(s.dip_share < 0.05 && fabs(s.upper_mode - 5000) < 40);
  scatter_release(&s);
}

TEST(runs_for_an_interval) {
  /* t(n - 1) s / sqrt(n) <= h: n = 18 for s = 1, h = 0.5: t(17) = 2.1098, 2.1098/sqrt(18) = 0.4973; n = 17: 0.5142 */
  assert_int_equal(scatter_runs_needed(1, 0.5), 18);
  assert_int_equal(scatter_runs_needed(2, 1), 18);
  assert_int_equal(scatter_runs_needed(0, 1), 2);
  assert_int_equal(scatter_runs_needed(NAN, 1), 0);
  assert_int_equal(scatter_runs_needed(1, 1e-9), 0);
  const double n = (double)scatter_runs_needed(1, 0.001);
  assert_true(fabs(n - pow(1.959963985 / 0.001, 2)) < 5);
}

/* The number is where the interval of a table first is narrow enough, and where the rule ends a point. */
TEST(runs_for_an_interval_are_those_of_tables_and_of_the_rule) {
  enum { MOST = 4000 };
  const double mean = 0.12, widths[] = {0.03, 0.01, 0.004};
  double x[MOST];
  for (int w = 0; w < 3; w++) {
    const double half_width = widths[w], s = 0.1;
    const size_t share = scatter_runs_of_share(mean, s, half_width), plain = scatter_runs_needed(s, half_width);
    assert_true(share > plain && share < 2 * plain);
    for (size_t n = share - 1; n <= share; n++) {
      struct sample_summary of = {.n = n, .mean = mean, .standard_deviation = s};
      of.half_width = sample_student(n, 0.95) * s / sqrt((double)n);
      sample_of_share(&of, 0.95);
      assert_int_equal(of.half_width <= half_width, n == share);
    }
    const size_t rule = scatter_runs_of_rule(mean, s, half_width, false);
    assert_true(rule >= SAMPLE_FIRST && (rule - SAMPLE_FIRST) % SAMPLE_BATCH == 0 && rule > plain);
    size_t n = SAMPLE_FIRST;
    for (; n < MOST; n += SAMPLE_BATCH) { /* values with this standard deviation, whatever n is */
      for (size_t i = 0; i < n; i++)
        x[i] = mean + (i % 2 ? s : -s) * sqrt((double)(n - 1) / (double)n);
      if (sample_may_stop(n, x, half_width, 0.95, SAMPLE_FIRST))
        break;
    }
    assert_int_equal(n, rule);
    const size_t of_share = scatter_runs_of_rule(mean, s, half_width, true), least = share > rule ? share : rule;
    assert_true(of_share >= least && of_share < least + SAMPLE_BATCH); /* both intervals are narrow enough */
  }
  /* Equal runs: Student's t knows no width, a share has one, and the guard of the rule ends it at 50. */
  assert_int_equal(scatter_runs_of_rule(0.9, 0, 0.02, true), 50);
  const size_t n = scatter_runs_of_share(0.9, 0, 0.02); /* 0.9 (1 - 0.05^(1/n)) <= 0.02: n = 134 */
  assert_int_equal(n, 134);
  assert_int_equal(scatter_runs_of_share(NAN, 1, 1), 0);
  assert_int_equal(scatter_runs_of_share(0.5, NAN, 1), 0);
  assert_int_equal(scatter_runs_of_rule(0.5, NAN, 1, true), 0);
}

/* 95 % intervals of the median hold it in 95 % of the samples, of a normal and of a skewed law. */
TEST(coverage) {
  enum { CASES = 400, N = 40 };
  const double median[2] = {0, 1};
  for (int law = 0; law < 2; law++) {
    int held = 0;
    for (uint64_t c = 0; c < CASES; c++) {
      double x[N];
      OWNED_BY(scatter_release) struct scatter s;
      for (uint64_t i = 0; i < N; i++)
        x[i] = law ? exp(0.5 * normal(3, c, i)) : normal(2, c, i);
      assert_int_equal(scatter_make(N, x, &s, NULL), STATUS_OK);
      held += s.quantile[2].low <= median[law] && s.quantile[2].high >= median[law];
    }
    assert_true(held >= 0.95 * CASES - 4 * 4.4); /* exact: 0.95 and more */
  }
}

/* Values near the ends of double: every number is that of ordinary values times the same power of two, bit for bit. */
TEST(at_the_ends_of_double) {
  enum { N = 60 };
  double x[N], y[N];
  for (uint64_t i = 0; i < N; i++)
    x[i] = (i % 3 ? 0.6 : -0.6) + 0.05 * normal(11, 1, i);
  SCATTER of = {0};
  assert_int_equal(scatter_make(N, x, &of, NULL), STATUS_OK);
  assert_true(of.dip_share < 0.05 && of.mean.half_width > 0);
  static const int powers[] = {-1020, -800, -565, -250, 250, 533, 800, 1024};
  for (size_t k = 0; k < sizeof powers / sizeof *powers; k++) {
    const int power = powers[k];
    struct sample_moments moments = {0}, ordinary = {0};
    sample_add(&moments, 0); /* larger and larger values come */
    sample_add(&ordinary, 0);
    for (size_t i = 0; i < N; i++) {
      y[i] = ldexp(x[i], power);
      sample_add(&moments, y[i]);
      sample_add(&ordinary, x[i]);
    }
    const struct sample_summary running = sample_summarise_moments(&moments, 0.95),
                                usual = sample_summarise_moments(&ordinary, 0.95);
    const double s = of.mean.standard_deviation;
    assert_true(fabs(ldexp(running.mean, -power) - usual.mean) < 1e-15);
    assert_true(fabs(ldexp(running.standard_deviation, -power) - usual.standard_deviation) < 1e-15 * s);
    SCATTER there = {0};
    assert_int_equal(scatter_make(N, y, &there, NULL), STATUS_OK);
    assert_true(there.mean.mean == ldexp(of.mean.mean, power) && there.mean.standard_deviation == ldexp(s, power));
    assert_true(there.mean.half_width == ldexp(of.mean.half_width, power));
    assert_true(fabs(there.skewness - of.skewness) < 1e-12 && there.dip == of.dip);
    assert_true(there.quantile[1].value == ldexp(of.quantile[1].value, power) &&
                there.sorted[7] == ldexp(of.sorted[7], power));
    assert_true(there.between == ldexp(of.between, power) && there.upper_share == of.upper_share);
    assert_true(there.lower_mode == ldexp(of.lower_mode, power) && there.upper_mode == ldexp(of.upper_mode, power));
    for (double width = 0.5; width < 8; width *= 2)
      assert_true(sample_may_stop(N, y, ldexp(width * s, power), 0.95, 30) ==
                  sample_may_stop(N, x, width * s, 0.95, 30));
  }
}

/* Tables of chi-square: 5 % quantiles 0.00393 (1 degree of freedom) and 3.940 (10). */
TEST(a_deviation_of_few_values) {
  assert_true(fabs(sample_deviation_factor(1) - sqrt(1 / 0.00393214)) < 1e-3);
  assert_true(fabs(sample_deviation_factor(10) - sqrt(10 / 3.940299)) < 1e-6);
}
