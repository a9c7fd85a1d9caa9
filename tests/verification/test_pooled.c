/* Pooling over runs: each run bounded by its own largest fragment gives the true exponent back, with a giant in every
 * run too; the interval from resampling runs has its nominal coverage; cut-offs are found if and only if they exist. */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { RUNS = 30, MOST = 101 };

struct made {
  size_t first[RUNS + 1];
  double masses[RUNS * MOST];
};

/* Runs of differing length (20 to 100) from a law of exponent 2, perhaps cut off, perhaps with a giant on top. */
static struct pooled_runs make(struct made *made, uint64_t ensemble, double cutoff, bool giant) {
  size_t at = 0;
  for (uint64_t r = 0; r < RUNS; r++) {
    made->first[r] = at;
    size_t n = 20 + (size_t)(80 * random_draw(40, ensemble, r, 0));
    uint64_t number = 0;
    for (size_t i = 0; i < n; i++) {
      do {
        made->masses[at] = 1 / (1 - random_draw(41, ensemble, r, number++));
      } while (random_draw(42, ensemble, r, number++) > exp(-made->masses[at] / cutoff));
      at++;
    }
    if (giant)
      made->masses[at++] = 3e4 * (1 + random_draw(43, ensemble, r, 0));
    qsort(made->masses + made->first[r], at - made->first[r], sizeof(double), sample_descending);
  }
  made->first[RUNS] = at;
  return (struct pooled_runs){RUNS, made->first, made->masses};
}

TEST(true_exponent_with_an_interval) {
  enum { ENSEMBLES = 100 };
  static struct made made;
  for (int giant = 0; giant < 2; giant++) {
    double mean = 0, squares = 0, quoted = 0, over_runs = 0;
    int held = 0;
    for (uint64_t e = 0; e < ENSEMBLES; e++) {
      struct pooled_runs runs = make(&made, e, HUGE_VAL, giant);
      struct pooled_exponent out;
      assert_int_equal(pooled_exponent(&runs, EXPONENT_MASSES, 1, 0.95, &out, NULL), STATUS_OK);
      assert_int_equal(out.fit.n, made.first[RUNS] - RUNS); /* all but the largest */
      mean += out.fit.beta / ENSEMBLES;
      squares += out.fit.beta * out.fit.beta / ENSEMBLES;
      quoted += out.fit.standard_error / ENSEMBLES;
      over_runs += out.interval.standard_error / ENSEMBLES;
      held += fabs(out.fit.beta - 2) <= out.interval.half_width;
    }
    double deviation = sqrt(squares - mean * mean), standard_error = deviation / sqrt(ENSEMBLES);
    printf("  %s%s: %.4f +- %.4f, quoted %.4f, over runs %.4f, covers %d %%\n", exponent_method_names[EXPONENT_MASSES],
           giant ? " with giants" : "", mean, deviation, quoted, over_runs, held);
    /* n is about 1800: the bias 1/n is below the Monte-Carlo error. */
    assert_true(fabs(mean - 2) < 4 * standard_error + 1.0 / 1500);
    assert_true(fabs(quoted / deviation - 1) < 4 / sqrt(2.0 * ENSEMBLES));
    assert_true(fabs(over_runs / deviation - 1) < 4 / sqrt(2.0 * ENSEMBLES));
    assert_true(held > 100 * 0.93 - 4 * 100 * sqrt(0.93 * 0.07 / ENSEMBLES)); /* test_intervals has a stricter test */
  }
}

/* Least squares has no bias when every bin of its window is filled; the same runs give the same bits. */
TEST(least_squares_pools_too) {
  static struct made made;
  struct pooled_runs runs = make(&made, 7, HUGE_VAL, true);
  struct pooled_exponent ls, again;
  assert_int_equal(pooled_exponent(&runs, EXPONENT_LEAST_SQUARES, 1, 0.95, &ls, NULL), STATUS_OK);
  assert_true(fabs(ls.fit.beta - 2) < 4 * ls.interval.standard_error && ls.interval.standard_error < 0.1);
  assert_true(ls.fit.lower == 1 && ls.fit.upper == 10);
  assert_int_equal(pooled_exponent(&runs, EXPONENT_LEAST_SQUARES, 1, 0.95, &again, NULL), STATUS_OK);
  assert_true(again.interval.half_width == ls.interval.half_width);
}

/* Fewer than five different masses below the largest of each run tell no exponent, and no p. */
TEST(equal_masses_tell_nothing) {
  enum { FEW = 5, EACH = 40 };
  static double masses[FEW * EACH];
  size_t first[FEW + 1];
  const struct pooled_runs runs = {FEW, first, masses};
  for (int different = 3; different <= 6; different++) {
    for (size_t r = 0; r <= FEW; r++)
      first[r] = r * EACH;
    for (size_t i = 0; i < FEW * EACH; i++) {
      const double place = (double)(i % EACH) * different / EACH; /* steps down, each of several fragments */
      masses[i] = (10 + different - floor(place)) * (1 - 1e-12 * (double)(i % EACH));
    }
    struct pooled_exponent exponent;
    struct pooled_rivals rivals;
    struct pooled_goodness goodness;
    assert_int_equal(pooled_exponent(&runs, EXPONENT_MASSES, 1, 0.95, &exponent, NULL), STATUS_OK);
    assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
    assert_int_equal(pooled_goodness(&runs, 1, 20, &goodness, NULL), STATUS_OK);
    assert_true(exponent.fit.n > 100 && goodness.n == (size_t)exponent.fit.n);
    const bool told = different >= EXPONENT_LEAST_FRAGMENTS;
    assert_true(isfinite(exponent.fit.beta) == told && isfinite(rivals.cutoff_p) == told);
    assert_true(isfinite(goodness.p) == told && isfinite(rivals.beta) == told);
    if (!told)
      assert_string_equal(pooled_exponent_untold(&exponent), "fewer than 5 different masses");
  }
}

TEST(cutoffs_are_told_apart) {
  enum { ENSEMBLES = 60 };
  static struct made made;
  double mean = 0, squares = 0;
  int needed = 0, alarms = 0, lognormal = 0, far = 0, open = 0, open_alarms = 0;
  for (uint64_t e = 0; e < ENSEMBLES; e++) {
    struct pooled_rivals rivals;
    struct pooled_runs runs = make(&made, 1000 + e, 30, true);
    assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
    needed += rivals.cutoff_p < 0.05;
    mean += rivals.cutoff_beta / ENSEMBLES;
    squares += rivals.cutoff_beta * rivals.cutoff_beta / ENSEMBLES;
    runs = make(&made, e, HUGE_VAL, true);
    assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
    alarms += rivals.cutoff_p < 0.05;
    lognormal += rivals.lognormal_p < 0.05;
    /* Without giants, and a cut-off that few fragments reach: the open windows see more of it. */
    runs = make(&made, 2000 + e, 300, false);
    assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
    far += rivals.cutoff_p < 0.05;
    open += rivals.open_cutoff_p < 0.05;
    runs = make(&made, 3000 + e, HUGE_VAL, false);
    assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
    open_alarms += rivals.open_cutoff_p < 0.05;
  }
  double deviation = sqrt(squares - mean * mean);
  printf("  cut-off found in %d of %d, false alarms %d and %d (lognormal); beta %.3f +- %.3f\n", needed, ENSEMBLES,
         alarms, lognormal, mean, deviation);
  printf("  far cut-off found in %d, in open windows in %d; false alarms there %d\n", far, open, open_alarms);
  assert_int_equal(needed, ENSEMBLES);
  assert_true(open >= 0.8 * ENSEMBLES && open > 2 * far && open_alarms <= 3 + 4 * 1.7);
  /* nominal 5 % of 60 = 3 +- 1.7 */
  assert_true(alarms <= 3 + 4 * 1.7 && lognormal <= 3 + 4 * 1.7);
  assert_true(fabs(mean - 2) < 4 * deviation / sqrt(ENSEMBLES));
}

TEST(spectrum_density_and_error) {
  /* Three runs: bin [1, 1.26) holds 3, 1 and 2, bin [10, 12.6) one in each (the largest), NaN and 0 nowhere. */
  const size_t first[4] = {0, 5, 8, 11};
  const double masses[11] = {11, 1.1, 1.2, 1, 0, 12, 1.05, NAN, 10, 1.25, 1};
  struct pooled_runs runs = {3, first, masses};
  struct pooled_form form = {0};
  struct pooled_bin *bins;
  size_t count;
  assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
  assert_int_equal(count, 2);
  double width = pow(10, 0.1) - 1;
  assert_int_equal(bins[0].count, 6);
  assert_true(fabs(bins[0].value * width - 2) < 1e-13);
  assert_true(fabs(bins[0].half_width * width / sample_student(3, 0.95) - sqrt(1.0 / 3)) <
              1e-13); /* counts 3, 1, 2: s.d. 1, over sqrt 3 */
  assert_true(bins[1].count == 3 && isnan(bins[1].half_width));
  free(bins);
  runs.count = 0;
  assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
  assert_int_equal(count, 0);
  free(bins);
}

/* The same three runs, cumulative, by size, and as two points: one of the first two runs, and one of the third. */
TEST(spectrum_forms) {
  const size_t first[4] = {0, 5, 8, 11}, points[3] = {0, 2, 3};
  const double masses[11] = {11, 1.1, 1.2, 1, 0, 12, 1.05, NAN, 10, 1.25, 1};
  const struct pooled_runs runs = {3, first, masses};
  struct pooled_form form = {.cumulative = true};
  struct pooled_bin *bins;
  size_t count;
  assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
  assert_int_equal(count, 11); /* from 1 to 10 kg, also where there is none */
  assert_true(bins[0].count == 9 && fabs(bins[0].value - 3) < 1e-13);
  assert_true(fabs(bins[0].mass - (11 + 1.1 + 1.2 + 1 + 12 + 1.05 + 10 + 1.25 + 1)) < 1e-13);
  assert_true(fabs(bins[0].half_width / sample_student(3, 0.95) - sqrt(1.0 / 3)) < 1e-13); /* 4, 2, 3 fragments */
  for (int j = 1; j < 11; j++)
    assert_true(bins[j].count == 3 && bins[j].value == 1 && isnan(bins[j].half_width));
  free(bins);
  form = (struct pooled_form){.units = 2, .first_run = points};
  assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
  const double width = bins[0].upper - bins[0].lower;
  assert_true(fabs(bins[0].value * width - 2) < 1e-13); /* 2 a run in both points */
  assert_true(isnan(bins[0].half_width) && count == 2); /* although the first point's runs differ */
  free(bins);
  for (int dimensions = 2; dimensions <= 3; dimensions++) {
    form = (struct pooled_form){.size = {2700, dimensions}};
    assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
    const double size = dimensions == 2 ? sqrt(1 / (2700 * M_PI / 4)) : cbrt(1 / (2700 * M_PI / 6));
    assert_true(fabs(bins[0].lower / size - 1) < 1e-14);
    assert_true(fabs(spectrum_size_mass(&form.size, bins[0].lower) - 1) < 1e-14);
    assert_true(fabs(bins[0].value * (bins[0].upper - bins[0].lower) - 2) < 1e-13);
    free(bins);
  }
}

/* The four names of an exponent: slopes of spectra of a pure power law, against the names. */
TEST(exponent_in_forms) {
  enum { N = 400000 };
  const size_t first[2] = {0, N};
  OWNED double *masses = malloc(N * sizeof *masses);
  const double beta = 1.8;
  assert_non_null(masses);
  for (size_t i = 0; i < N; i++)
    masses[i] = pow((double)(N - i) / N, -1 / (beta - 1)); /* N(>m) = N m^(1 - beta), without scatter */
  const struct pooled_runs runs = {1, first, masses};
  for (int f = 0; f < 6; f++) {
    const struct pooled_form form = {.cumulative = f % 2, .size = {f / 2 ? 2000 : 0, f / 2 + 1}};
    OWNED struct pooled_bin *bins = NULL;
    size_t count;
    assert_int_equal(pooled_spectrum(&runs, &form, &bins, &count, NULL), STATUS_OK);
    const double slope = -log(bins[20].value / bins[10].value) / log(bins[20].lower / bins[10].lower);
    assert_true(fabs(slope - pooled_spectrum_exponent(&form, beta)) < 0.01);
  }
}

/* Under the law p is uniform in 0..1; a lognormal law is refused. Windows end at each run's largest fragment. Both are
 * so for masses that are whole numbers of a particle's, 10 and more, with a particle that differs a little from run to
 * run, and with a few fragments that hold a particle of another body. */
TEST(goodness_of_fit) {
  enum { SHOTS = 10, EACH = 40, CASES = 40 };
  static double masses[SHOTS * EACH];
  size_t first[SHOTS + 1];
  for (int form = 0; form < 4; form++) {
    const int law = form % 2, whole = form / 2;
    double mean = 0;
    int low = 0;
    for (uint64_t c = 0; c < CASES; c++) {
      for (size_t r = 0; r <= SHOTS; r++)
        first[r] = r * EACH;
      for (size_t i = 0; i < SHOTS * EACH; i++) {
        const double u = random_draw(41, (uint64_t)law, c, 2 * i), v = random_draw(41, (uint64_t)law, c, 2 * i + 1);
        masses[i] = law ? exp(1.2 * sqrt(-2 * log1p(-u)) * cos(2 * M_PI * v)) : pow(1 - u, -1 / 0.9);
      }
      for (size_t i = 0; whole && i < SHOTS * EACH; i++) {
        const double particle = (law ? 0.5 : 1) / 9.5 * (1 + 0.001 * ((double)(i / EACH % 5) - 2));
        masses[i] = particle * (round(masses[i] / particle) + (i % 37 == 0 ? 0.3 : 0));
      }
      for (size_t r = 0; r < SHOTS; r++)
        qsort(masses + first[r], EACH, sizeof *masses, sample_descending);
      const struct pooled_runs runs = {SHOTS, first, masses};
      struct pooled_goodness g, again;
      struct pooled_exponent fit;
      const double lower = law ? 0.5 : 1;
      assert_int_equal(pooled_goodness(&runs, lower, 200, &g, NULL), STATUS_OK);
      assert_int_equal(pooled_exponent(&runs, EXPONENT_MASSES, lower, 0.95, &fit, NULL), STATUS_OK);
      assert_int_equal(g.n, fit.fit.n);
      if (c == 0) { /* the same bits on any number of cores */
        assert_int_equal(pooled_goodness(&runs, lower, 200, &again, NULL), STATUS_OK);
        assert_true(again.p == g.p && again.distance == g.distance);
      }
      mean += g.p / CASES;
      low += g.p < 0.1;
    }
    printf("  goodness: mean p %.3f, below 0.1 in %d of %d (%s%s)\n", mean, low, CASES, law ? "lognormal" : "power law",
           whole ? ", whole particles" : "");
    if (law)
      assert_true(low >= 0.9 * CASES);
    else
      assert_true(fabs(mean - 0.5) < 4 * sqrt(1 / 12.0 / CASES) && low <= 4 + 4 * 1.9);
  }
  /* Masses at the quantiles of the law lie nearer to it than any sample: the first 100 draws are larger, and enough. */
  double quantiles[101];
  const size_t one_run[2] = {0, 101};
  for (size_t i = 0; i < 101; i++)
    quantiles[i] = pow(1 - (100.5 - (double)i) / 101 * (1 - 1e-3), -1 / 0.9);
  struct pooled_goodness perfect;
  assert_int_equal(pooled_goodness(&(struct pooled_runs){1, one_run, quantiles}, 1, 100000, &perfect, NULL), STATUS_OK);
  assert_true(perfect.draws == 100 && perfect.p == 1 && perfect.n == 100);
  const size_t none[2] = {0, 0};
  struct pooled_goodness g;
  assert_int_equal(pooled_goodness(&(struct pooled_runs){1, none, masses}, 1, 100, &g, NULL), STATUS_OK);
  assert_true(g.n == 0 && isnan(g.p) && g.draws == 0);
  assert_int_equal(pooled_goodness(&(struct pooled_runs){1, none, masses}, 0, 100, &g, NULL), STATUS_USAGE);
}

/* Four nearly equal parts in each run lie at the upper ends of their windows: they have no exponent. Unlike ones do. */
TEST(equal_parts_have_no_exponent) {
  static const double apart[] = {0, 1e-16, 1e-12, 1e-6, 1e-3};
  for (size_t c = 0; c < sizeof apart / sizeof apart[0]; c++) {
    double masses[12];
    const size_t first[4] = {0, 4, 8, 12};
    for (size_t i = 0; i < 12; i++)
      masses[i] = 24.3 * (1 - apart[c] * (double)(i % 4));
    const struct pooled_runs runs = {3, first, masses};
    struct pooled_exponent out;
    assert_int_equal(pooled_exponent(&runs, EXPONENT_MASSES, 2.5, 0.95, &out, NULL), STATUS_OK);
    assert_true(isnan(out.fit.beta) && isnan(out.interval.half_width));
    struct pooled_goodness goodness;
    assert_int_equal(pooled_goodness(&runs, 2.5, 100, &goodness, NULL), STATUS_OK);
    assert_true(isnan(goodness.distance) && isnan(goodness.p) && goodness.draws == 0);
  }
  const double unlike[12] = {24, 20, 18, 15, 30, 21, 17, 9, 19, 18, 11, 10};
  const struct pooled_runs runs = {3, (const size_t[]){0, 4, 8, 12}, unlike};
  struct pooled_exponent out;
  assert_int_equal(pooled_exponent(&runs, EXPONENT_MASSES, 2.5, 0.95, &out, NULL), STATUS_OK);
  assert_true(isfinite(out.fit.beta) && isfinite(out.interval.half_width));
}

TEST(empty_and_bad) {
  const size_t first[4] = {0, 0, 1, 1};
  const double masses[1] = {3};
  struct pooled_runs runs = {3, first, masses}, none = {0, first, masses};
  const enum exponent_method pooling[] = {EXPONENT_LEAST_SQUARES, EXPONENT_MASSES};
  for (int m = 0; m < 2; m++) {
    struct pooled_exponent out;
    assert_int_equal(pooled_exponent(&runs, pooling[m], 1, 0.95, &out, NULL), STATUS_OK);
    assert_true(isnan(out.fit.beta) && isnan(out.interval.half_width));
    assert_int_equal(pooled_exponent(&none, pooling[m], 1, 0.95, &out, NULL), STATUS_OK);
    assert_true(isnan(out.fit.beta));
    assert_int_equal(pooled_exponent(&runs, pooling[m], 0, 0.95, &out, NULL), STATUS_USAGE);
  }
  struct pooled_exponent out;
  struct pooled_rivals rivals;
  assert_int_equal(pooled_exponent(&runs, EXPONENT_METHODS, 1, 0.95, &out, NULL), STATUS_USAGE);
  assert_int_equal(pooled_exponent(&runs, EXPONENT_UPPER_CUTOFF, 1, 0.95, &out, NULL), STATUS_USAGE); /* of runs only */
  assert_int_equal(pooled_rivals(&runs, 1, &rivals, NULL), STATUS_OK);
  assert_true(isnan(rivals.cutoff_p));
}
