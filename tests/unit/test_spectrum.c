/* Bin edges are exact: a mass on an edge is in the bin above, the double before it in the bin below. */

#include "analysis/statistics/statistics.h"
#include "tests/support/check.h"

TEST(edges_are_exact) {
  for (int bin = -300; bin <= 300; bin++) {
    double edge = spectrum_edge(bin);
    assert_int_equal(spectrum_bin(edge), bin);
    assert_int_equal(spectrum_bin(nextafter(edge, HUGE_VAL)), bin);
    assert_int_equal(spectrum_bin(nextafter(edge, 0)), bin - 1);
    /* Two roundings here, two in pow and its argument: a few 2e-16, times the exponent for the argument of pow. */
    assert_true(fabs(edge / pow(10, bin / 10.0) - 1) < 1e-14);
  }
}

TEST(powers_of_ten_open_their_bin) {
  for (int decade = -22; decade <= 22; decade++) {
    char text[16];
    snprintf(text, sizeof text, "1e%d", decade);
    double power = strtod(text, NULL); /* correctly rounded in glibc */
    assert_true(spectrum_edge(10 * decade) == power);
    assert_int_equal(spectrum_bin(power), 10 * decade);
    assert_int_equal(spectrum_bin(nextafter(power, 0)), 10 * decade - 1);
  }
  assert_int_equal(spectrum_bin(0.001), -30);
  assert_int_equal(spectrum_bin(0.00999999), -21);
}

TEST(whole_range_of_doubles) {
  const double masses[] = {5e-324, 1e-310, 2.2250738585072014e-308, 1e-100, 1e100, 1.7976931348623157e308};
  for (size_t i = 0; i < sizeof masses / sizeof *masses; i++) {
    int bin = spectrum_bin(masses[i]);
    assert_true(spectrum_edge(bin) <= masses[i] && masses[i] < spectrum_edge(bin + 1));
  }
  const double none[] = {0, -0.0, -1, NAN, HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    assert_int_equal(spectrum_bin(none[i]), SPECTRUM_NO_BIN);
}

TEST(fill_counts_everything_in_any_order) {
  double masses[] = {0.5, 3e-3, 2.1e-3, 0.42, NAN, 1e-5, 0.0, 40, 2.2e-3, 1.01e-5};
  size_t n = sizeof masses / sizeof *masses;
  struct spectrum_bin_row rows[8], again[8];
  assert_int_equal(spectrum_fill(n, masses, rows, 8), 5);
  int64_t count = 0;
  for (int i = 0; i < 5; i++) {
    count += rows[i].count;
    if (i)
      assert_true(rows[i].bin > rows[i - 1].bin);
  }
  assert_int_equal(count, 8);
  assert_int_equal(rows[0].bin, -50);
  assert_int_equal(rows[0].count, 2);
  assert_int_equal(rows[1].bin, -27);
  assert_true(rows[1].mass == 2.1e-3 + 2.2e-3);
  assert_int_equal(rows[3].bin, -4);
  assert_int_equal(rows[4].bin, 16);
  /* The output array is too small: the required size is returned. */
  assert_int_equal(spectrum_fill(n, masses, again, 4), 5);
  assert_int_equal(spectrum_fill(n, masses, NULL, 0), 5);
  assert_int_equal(spectrum_fill(0, NULL, again, 8), 0);
}
