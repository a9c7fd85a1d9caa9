/* Differences of means against values computed by hand and by numerical integration of Student's density. */

#include "analysis/statistics/statistics.h"
#include "tests/support/check.h"

TEST(pairs_are_used) {
  const struct difference_value a[] = {{1, 10}, {2, 20}, {3, 30}, {9, 500}};
  const struct difference_value b[] = {{1, 11}, {2, 22}, {3, 33}, {4, -500}};
  const struct difference d = sample_difference(4, a, 4, b, 0.95);
  assert_int_equal(d.pairs, 3);
  assert_true(d.side[0].mean == 140 && d.side[1].mean == -108.5 && d.difference == 2);
  assert_true(fabs(d.half_width - 4.302652729749 / sqrt(3)) < 1e-9); /* differences 1, 2, 3: standard deviation 1 */
}

TEST(independent_sides_are_welch) {
  const struct difference_value a[] = {{1, 1}, {2, 2}, {3, 3}, {4, 4}}, b[] = {{4, 2}, {5, 4}, {6, 6}, {7, 8}};
  const struct difference d = sample_difference(4, a, 4, b, 0.95); /* one pair is too few */
  assert_int_equal(d.pairs, 0);
  assert_true(d.difference == 2.5);
  assert_true(fabs(d.half_width - 3.8641672155) < 1e-6); /* 4.41 degrees of freedom */
}

TEST(too_few_values_have_no_interval) {
  const struct difference_value a[] = {{1, 1}}, b[] = {{1, 3}};
  const struct difference d = sample_difference(1, a, 1, b, 0.95);
  assert_true(d.difference == 2 && isnan(d.half_width) && d.pairs == 0);
  assert_true(isnan(sample_difference(0, NULL, 1, b, 0.95).difference));
  /* Nor have values that do not vary: with equal seeds, and without. */
  const struct difference_value equal[] = {{1, 0.1}, {2, 0.1}, {3, 0.1}}, other[] = {{4, 0.4}, {5, 0.4}, {6, 0.4}};
  assert_true(isnan(sample_difference(3, equal, 3, equal, 0.95).half_width));
  assert_true(isnan(sample_difference(3, equal, 3, other, 0.95).half_width));
}

/* Values near the ends of double have the interval of ordinary ones, times the same power of two. */
TEST(ends_of_double) {
  static const double first[] = {1, 2, 3, 4}, second[] = {2, 4, 6, 8};
  static const int powers[] = {-1000, -560, 560, 1015};
  for (size_t k = 0; k < 4; k++) {
    struct difference_value a[4], b[4];
    for (int i = 0; i < 4; i++) {
      a[i] = (struct difference_value){1 + i, ldexp(first[i], powers[k])};
      b[i] = (struct difference_value){5 + i, ldexp(second[i], powers[k])};
    }
    assert_true(fabs(ldexp(sample_difference(4, a, 4, b, 0.95).half_width, -powers[k]) - 3.8641672155) < 1e-6);
  }
}
