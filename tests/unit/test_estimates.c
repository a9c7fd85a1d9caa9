/* The standard rows of a run: windows in mean grain masses, dust and the largest left out, one headline. */

#include "analysis/statistics/statistics.h"
#include "tests/support/check.h"

/* Few different masses tell no exponent, however many fragments there are: of one run, of runs together, and of what is
 * left without one run. */
TEST(few_masses_tell_nothing) {
  double masses[200];
  for (size_t i = 0; i < 200; i++)
    masses[i] = i < 20 ? 40 : i < 90 ? 20 : 10 * (1 + 1e-9 * (double)(i % 2));
  struct exponent fit;
  for (int method = EXPONENT_MASSES; method <= EXPONENT_UPPER_CUTOFF; method++) {
    assert_int_equal(exponent_fit((enum exponent_method)method, 200, masses, (struct exponent_window){5, 50}, &fit,
                                  NULL),
                     STATUS_OK);
    assert_true(fit.n == 200 && isnan(fit.beta) && isnan(fit.standard_error));
  }
  for (size_t i = 0; i < 40; i++) /* only the first of four runs has more */
    masses[i] = 60 - (double)i;
  const size_t first[] = {0, 50, 100, 150, 200};
  struct pooled_exponent pooled;
  assert_int_equal(pooled_exponent(&(struct pooled_runs){4, first, masses}, EXPONENT_MASSES, 5, 0.95, &pooled, NULL),
                   STATUS_OK);
  assert_true(isfinite(pooled.fit.beta) && isnan(pooled.interval.half_width));
}

TEST(rows_of_a_run) {
  /* 60 resolved fragments of 100/1..100/60 x 3 grains each, 140 grains of dust; every grain 2 kg. */
  struct fragment fragments[200] = {0};
  double total = 0, grains = 0;
  for (uint32_t i = 0; i < 200; i++) {
    fragments[i].count = i < 60 ? 300 / (i + 1) : 1;
    fragments[i].mass = 2.0 * fragments[i].count;
    total += fragments[i].mass;
    grains += fragments[i].count;
  }
  assert_true(total / grains == 2);
  fragments[60].mass = 4; /* a single grain of twice the mean mass still counts as unresolved */
  fragments[61].mass = fragments[62].mass = 1;
  struct estimate rows[ESTIMATES_COUNT];
  assert_int_equal(estimates_make(200, fragments, 0, rows, NULL), STATUS_OK);
  const struct estimate *headline = NULL;
  int headlines = 0;
  for (int i = 0; i < ESTIMATES_COUNT; i++) {
    headlines += rows[i].headline;
    if (rows[i].headline)
      headline = &rows[i];
    assert_true(isfinite(rows[i].fit.beta) && rows[i].fit.standard_error > 0);
    assert_true(rows[i].fit.lower >= 2 * estimates_window_elements((enum estimates_window)rows[i].window));
    assert_true(rows[i].fit.upper <= fragments[0].mass);
    if (rows[i].fit.method == EXPONENT_LEAST_SQUARES)
      assert_true(rows[i].fit.upper <= 20 * estimates_window_elements((enum estimates_window)rows[i].window));
    assert_true(!isinf(rows[i].fit.cutoff_mass));
  }
  assert_int_equal(headlines, 1);
  assert_int_equal(headline->fit.method, EXPONENT_MASSES);
  assert_true(headline->fit.lower == 9 && headline->fit.upper == 600);
  assert_int_equal(headline->fit.n, 59); /* 300/2 .. 300/60 = 5 grains; not the 300 of M_1 */
  assert_int_equal(rows[3].fit.n, 59);   /* masses from 2 */
  assert_int_equal(rows[5].fit.n, 29);   /* masses from 10: to 300/30; not 300/31 = 9 */

  /* complete from 5 grains of 2 kg: the window from 2 begins there, too */
  struct estimate complete[ESTIMATES_COUNT];
  assert_int_equal(estimates_make(200, fragments, 9, complete, NULL), STATUS_OK);
  for (int i = 0; i < ESTIMATES_COUNT; i++)
    if (complete[i].window == ESTIMATES_FROM_2)
      assert_true(complete[i].fit.lower >= 9 &&
                  (complete[i].fit.method != EXPONENT_MASSES || complete[i].fit.beta == headline->fit.beta));
    else
      assert_true(complete[i].fit.beta == rows[i].fit.beta && complete[i].fit.n == rows[i].fit.n);
}

TEST(nothing_to_fit) {
  struct estimate rows[ESTIMATES_COUNT];
  struct fragment whole = {.mass = 5, .count = 1000},
                  dust[3] = {{.mass = 1, .count = 1}, {.mass = 1, .count = 1}, {.mass = 1, .count = 1}};
  assert_int_equal(estimates_make(1, &whole, 0, rows, NULL), STATUS_OK);
  for (int i = 0; i < ESTIMATES_COUNT; i++)
    assert_true(isnan(rows[i].fit.beta) && rows[i].fit.n == 0);
  assert_int_equal(estimates_make(3, dust, 0, rows, NULL), STATUS_OK);
  for (int i = 0; i < ESTIMATES_COUNT; i++)
    assert_true(isnan(rows[i].fit.beta) && rows[i].fit.n == 0);
  assert_int_equal(estimates_make(0, NULL, 0, rows, NULL), STATUS_OK);
  for (int i = 0; i < ESTIMATES_COUNT; i++)
    assert_true(isnan(rows[i].fit.beta) && rows[i].fit.n == 0);
}

/* The line through four filled bins of five, by hand: an empty one and one at the window's end do not count. Least
 * squares has a window of a decade, the other methods reach up to the largest mass. */
TEST(least_squares_by_hand) {
  const struct spectrum_bin_row rows[] = {{0, 1000, 0}, {1, 500, 0}, {2, 300, 0}, {4, 20, 0}, {5, 7, 0}};
  struct exponent fit;
  assert_int_equal(exponent_fit_bins(5, rows, 0, (struct exponent_window){1, spectrum_edge(5)}, &fit, NULL), STATUS_OK);
  assert_true(fit.n == 1820 && fit.lower == 1 && fit.upper == spectrum_edge(5));
  assert_true(fabs(fit.beta - 5.260148227803589) < 1e-12);
  assert_true(fabs(fit.standard_error - 0.638146958408374) < 1e-12); /* of n - 2 degrees of freedom */
  const struct exponent_window decade = exponent_window_from(EXPONENT_LEAST_SQUARES, 2, 300),
                               whole = exponent_window_from(EXPONENT_MASSES, 2, 300);
  assert_true(decade.lower == 2 && decade.upper == 20 && whole.lower == 2 && whole.upper == 300);
}

/* Masses that are whole numbers of an element, as often as m^-2 says: m from N - 1/2 to N + 1/2 gives N. Bins hold one,
 * one or two whole numbers. Over their own widths the line has a slope of 1.81, over those of the numbers the right
 * one. The same masses as real numbers are fitted as before. */
TEST(whole_masses_have_their_exponent) {
  enum { N = 20000 };
  const double element = 1;
  OWNED double *masses = malloc(N * sizeof *masses), *real = malloc(N * sizeof *real);
  assert_true(masses && real);
  for (int i = 0; i < N; i++) {
    real[i] = element * 4.5 * N / (i + 0.5); /* ascending counts of m^-1: F(m) ~ m^-2 from 4.5 elements on */
    masses[i] = element * round(real[i] / element);
  }
  const struct exponent_window window = {4.5 * element, 45 * element};
  struct exponent fit, fit_real;
  assert_int_equal(exponent_fit(EXPONENT_LEAST_SQUARES, N, masses, window, &fit, NULL), STATUS_OK);
  assert_int_equal(exponent_fit(EXPONENT_LEAST_SQUARES, N, real, window, &fit_real, NULL), STATUS_OK);
  if (!(fabs(fit.beta - 2) < 0.02) || !(fabs(fit_real.beta - 2) < 0.02))
    fail_msg("%g of whole masses, %g of real ones", fit.beta, fit_real.beta);
  double strayed[200]; /* one fragment of another body lies between 3.16 and 3.98, where no whole number is */
  for (int i = 0; i < 200; i++)
    strayed[i] = i == 150 ? 3.5 : ceil(masses[i * 90] / 3);
  const struct exponent_window wide = {1.5, 15};
  assert_int_equal(exponent_fit(EXPONENT_LEAST_SQUARES, 200, strayed, wide, &fit_real, NULL), STATUS_OK);
  assert_true(isfinite(fit_real.beta));
  const size_t first[] = {0, N};
  const struct pooled_runs runs = {1, first, masses};
  struct pooled_exponent pooled;
  assert_int_equal(pooled_exponent(&runs, EXPONENT_LEAST_SQUARES, window.lower, 0.95, &pooled, NULL), STATUS_OK);
  assert_true(pooled.fit.beta == fit.beta);
}

TEST(equal_masses_have_no_exponent) {
  double masses[50];
  for (int i = 0; i < 50; i++)
    masses[i] = 3;
  const struct exponent_window windows[] = {{3, HUGE_VAL}, {1, HUGE_VAL}, {3, 4}, {1, 3.0000001}};
  for (int w = 0; w < 4; w++) {
    for (int method = 0; method < EXPONENT_METHODS; method++) {
      struct exponent fit;
      assert_int_equal(exponent_fit((enum exponent_method)method, 50, masses, windows[w], &fit, NULL), STATUS_OK);
      assert_true(!isinf(fit.beta)); /* a number or NaN, never a hang or a trap */
    }
  }
}

TEST(bad_windows_are_refused) {
  double masses[5] = {1, 2, 3, 4, 5};
  const struct exponent_window windows[] = {{0, 1}, {-1, 1}, {2, 2}, {3, 2}, {NAN, 2}, {1, NAN}, {HUGE_VAL, HUGE_VAL}};
  struct exponent fit;
  for (size_t w = 0; w < sizeof windows / sizeof *windows; w++)
    assert_int_equal(exponent_fit(EXPONENT_MASSES, 5, masses, windows[w], &fit, &error), STATUS_USAGE);
  assert_int_equal(exponent_fit((enum exponent_method)17, 5, masses, (struct exponent_window){1, 2}, &fit, &error),
                   STATUS_USAGE);
}
