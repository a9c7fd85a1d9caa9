/* Designs: known values, uniformity, strata of Latin hypercubes, Sobol numbers against GSL, laws inside their bounds.
 */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_qrng.h>
#include <time.h>

#include "campaign/design/design.h"
#include "schemas/unit.h"
#include "tests/support/check.h"

static const struct field real_row = {.path = "x",
                                      .kind = FIELD_REAL,
                                      .unit = "1",
                                      .minimum = -HUGE_VAL,
                                      .maximum = HUGE_VAL};
static const struct field integer_row = {.path = "n",
                                         .kind = FIELD_INTEGER,
                                         .unit = "1",
                                         .minimum = -1e9,
                                         .maximum = 1e9};

static struct field_value levels_a[] = {{.number = 6}, {.number = 9}, {.number = 12}};
static struct field_value levels_b[] = {{.number = 1}, {.number = 2}};
static struct field_value levels_c[] = {{.number = 10}, {.number = 20}, {.number = 30}};

static struct design_axis levels(struct field_value *values, size_t n) {
  return (struct design_axis){.row = &real_row,
                              .kind = DESIGN_AXIS_LEVELS,
                              .levels = values,
                              .level_count = n,
                              .lower = -HUGE_VAL,
                              .upper = HUGE_VAL};
}
static struct design_axis law(int kind, double a, double b, double lower, double upper) {
  return (struct design_axis){.row = &real_row, .kind = kind, .a = a, .b = b, .lower = lower, .upper = upper};
}

/* The levels are the numbers that a person writes, to the last bit. */
TEST(spaced_levels_are_written_numbers) {
  static const struct {
    const char *from, *to, *si;
    size_t n;
    bool logarithmic;
    const char *levels[4]; /* the first ones */
  } cases[] = {
      {"1e30", "1e36", "1/m^3", 4, true, {"1e30", "1e32", "1e34", "1e36"}},
      {"0.1", "0.3", "1", 3, false, {"0.1", "0.2", "0.3"}},
      {"1 %", "10 %", "1", 10, false, {"1 %", "2 %", "3 %", "4 %"}},
      {"1 %", "6 %", "1", 6, false, {"1 %", "2 %", "3 %", "4 %"}},
      {"1 deg", "7 deg", "rad", 7, false, {"1 deg", "2 deg", "3 deg", "4 deg"}},
      {"0", "9 deg", "rad", 4, false, {"0", "3 deg", "6 deg", "9 deg"}},
      {"-0.3 mm", "0.2 mm", "m", 6, false, {"-0.3 mm", "-0.2 mm", "-0.1 mm", "0"}},
      {"5 mm", "2 cm", "m", 4, false, {"5 mm", "10 mm", "15 mm", "2 cm"}},
      {"1 mm", "1000 mm", "m", 4, true, {"1 mm", "10 mm", "100 mm", "1 m"}},
      {"0.1 h", "100 h", "s", 4, true, {"0.1 h", "1 h", "10 h", "100 h"}},
      {"0", "1", "1", 4, false, {"0", "0.33333333333333", "0.66666666666667", "1"}},
  };
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
    for (size_t i = 0; i < 4 && cases[k].levels[i]; i++) {
      double expected = NAN;
      assert_int_equal(unit_read(cases[k].levels[i], cases[k].si, &expected, NULL), STATUS_OK);
      const double level = design_axis_spaced(cases[k].from, cases[k].to, cases[k].si, cases[k].n, cases[k].logarithmic,
                                              i);
      if (level != expected || signbit(level) != signbit(expected))
        fail_msg("%s to %s, level %zu: %.17g is not %.17g", cases[k].from, cases[k].to, i, level, expected);
    }
}

TEST(grid_walks_the_last_axis_fastest) {
  struct design_axis axes[3] = {levels(levels_a, 3), levels(levels_b, 2), law(DESIGN_AXIS_LINKED, 2, 0.5, 0, 0)};
  struct design *design;
  axes[2].linked = 1;
  OK(design_create(DESIGN_GRID, axes, 3, 0, 0, &design, &error));
  assert_int_equal(design_points(design), 6);
  double expected[6][3] = {{6, 1, 2.5}, {6, 2, 4.5}, {9, 1, 2.5}, {9, 2, 4.5}, {12, 1, 2.5}, {12, 2, 4.5}};
  struct field_value values[3];
  for (int i = 0; i < 6; i++) {
    assert_true(design_next(design, values));
    for (int a = 0; a < 3; a++)
      assert_true(values[a].number == expected[i][a]);
  }
  assert_false(design_next(design, values));
  design_free(design);
}

TEST(list_goes_in_step_and_links_by_level) {
  struct design_axis axes[3] = {levels(levels_a, 3), levels(levels_c, 3), levels(levels_c, 3)};
  struct design *design;
  axes[2].kind = DESIGN_AXIS_LINKED;
  axes[2].linked = 0;
  OK(design_create(DESIGN_LIST, axes, 3, 0, 0, &design, &error));
  assert_int_equal(design_points(design), 3);
  struct field_value values[3];
  for (int i = 0; i < 3; i++) {
    assert_true(design_next(design, values));
    assert_true(values[0].number == levels_a[i].number && values[1].number == levels_c[i].number);
    assert_true(values[2].number == levels_c[i].number);
  }
  design_free(design);
  axes[1] = levels(levels_b, 2);
  assert_int_equal(design_create(DESIGN_LIST, axes, 2, 0, 0, &design, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "2 values, but vary.x has 3"));
}

TEST(refusals_say_the_remedy) {
  struct design *design;
  struct design_axis uniform = law(DESIGN_AXIS_UNIFORM, 0, 1, -HUGE_VAL, HUGE_VAL);
  assert_int_equal(design_create(DESIGN_GRID, &uniform, 1, 0, 0, &design, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "a distribution has no grid"));
  assert_null(design);
  assert_int_equal(design_create(DESIGN_SOBOL, &uniform, 1, 0, 0, &design, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "how many points"));
  assert_int_equal(design_create(DESIGN_RANDOM, NULL, 0, 5, 0, &design, &error), STATUS_CONTENT);
  assert_int_equal(design_create(DESIGN_SOBOL, &uniform, 1, (UINT64_C(1) << 30) + 1, 0, &design, &error),
                   STATUS_CONTENT);
  /* GSL accepts 41 dimensions and returns zeros: the check is ours. */
  struct design_axis many[41];
  for (int i = 0; i < 41; i++)
    many[i] = uniform;
  OK(design_create(DESIGN_SOBOL, many, 40, 8, 0, &design, &error));
  design_free(design);
  assert_int_equal(design_create(DESIGN_SOBOL, many, 41, 8, 0, &design, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "41 varied inputs"));
  static struct field_value big[1 << 14];
  struct design_axis wide[4] = {levels(big, 1 << 14), levels(big, 1 << 14), levels(big, 1 << 14), levels(big, 1 << 14)};
  assert_int_equal(design_create(DESIGN_GRID, wide, 4, 0, 0, &design, &error), STATUS_CONTENT); /* 2^56 points */
}

/* Every n, especially small ones: an order of 0..n-1; over seeds each number is equally often in each place. */
TEST(latin_orders_are_permutations_and_even) {
  for (uint64_t n = 1; n <= 300; n += n < 20 ? 1 : 37) {
    char seen[300] = {0};
    for (uint64_t i = 0; i < n; i++) {
      uint64_t p = design_latin_permute(5, 3, n, i);
      assert_true(p < n && !seen[p]);
      seen[p] = 1;
    }
  }
  for (uint64_t n = 2; n <= 7; n++) {
    enum { SEEDS = 4000 };
    double count[7][7] = {{0}}, chi = 0, expected = SEEDS / (double)n;
    for (uint64_t seed = 0; seed < SEEDS; seed++)
      for (uint64_t i = 0; i < n; i++)
        count[i][design_latin_permute(seed, 0, n, i)]++;
    for (uint64_t i = 0; i < n; i++)
      for (uint64_t j = 0; j < n; j++)
        chi += (count[i][j] - expected) * (count[i][j] - expected) / expected;
    double freedom = (double)((n - 1) * (n - 1)); /* rows and columns sum to SEEDS */
    /* Fixed seeds: the test is deterministic. One in 1e5 such sequences of a correct shuffle would lie above. */
    assert_true(chi * (double)(n - 1) / (double)n < gsl_cdf_chisq_Pinv(1 - 1e-5, freedom));
  }
}

TEST(latin_projections_are_stratified) {
  enum { N = 97, D = 5 };
  for (size_t d = 0; d < D; d++) {
    int strata[N] = {0};
    double inside = 0;
    for (uint64_t i = 0; i < N; i++) {
      double u = design_latin_coordinate(11, N, i, d);
      assert_true(u >= 0 && u < 1);
      strata[(int)(u * N)]++;
      inside += u * N - floor(u * N);
    }
    for (int s = 0; s < N; s++)
      assert_int_equal(strata[s], 1);
    assert_true(fabs(inside / N - 0.5) < 5 * sqrt(1 / 12.0 / N)); /* draws within strata: five standard errors */
  }
  /* Dimensions are independent. Rank correlation of independent orders: sd 1/sqrt(N-1). */
  double product = 0;
  for (uint64_t i = 0; i < N; i++)
    product += (design_latin_coordinate(11, N, i, 0) - 0.5) * (design_latin_coordinate(11, N, i, 1) - 0.5) * 12 / N;
  assert_true(fabs(product) < 4 / sqrt(N - 1.0));
}

TEST(sobol_is_gsl_with_origin_and_shift) {
  enum { D = 40, N = 1024 };
  struct design_sobol *sobol, *again, *other;
  OK(design_sobol_create(D, 7, &sobol, &error));
  OK(design_sobol_create(D, 7, &again, &error));
  OK(design_sobol_create(D, 8, &other, &error));
  gsl_qrng *gsl = gsl_qrng_alloc(gsl_qrng_sobol, D);
  static int strata[D][N];
  int differs = 0;
  for (int i = 0; i < N; i++) {
    double x[D] = {0}, u[D], v[D], w[D];
    if (i > 0)
      gsl_qrng_get(gsl, x);
    design_sobol_next(sobol, u);
    design_sobol_next(again, v);
    design_sobol_next(other, w);
    for (size_t d = 0; d < D; d++) {
      uint32_t digits = (uint32_t)floor(ldexp(u[d], DESIGN_SOBOL_BITS)) ^ design_sobol_shift(7, d);
      assert_true(ldexp(digits, -DESIGN_SOBOL_BITS) == x[d]);
      assert_true(u[d] == v[d] && u[d] > 0 && u[d] < 1);
      differs += u[d] != w[d];
      strata[d][(int)(u[d] * N)]++;
    }
  }
  assert_true(differs > D * N * 9 / 10);
  for (int d = 0; d < D; d++) /* a net in base 2: with the origin, every interval of length 1/N holds one point */
    for (int s = 0; s < N; s++)
      assert_int_equal(strata[d][s], 1);
  gsl_qrng_free(gsl);
  design_sobol_free(sobol);
  design_sobol_free(again);
  design_sobol_free(other);
}

TEST(quantiles_are_the_laws) {
  struct field_value value;
  struct design_axis normal = law(DESIGN_AXIS_NORMAL, 3, 2, -HUGE_VAL, HUGE_VAL);
  design_axis_quantile(&normal, 0.975, &value);
  assert_true(fabs(value.number - (3 + 2 * 1.959963984540054)) < 1e-12); /* tables */
  struct design_axis lognormal = law(DESIGN_AXIS_LOGNORMAL, 10, 0.5, -HUGE_VAL, HUGE_VAL);
  design_axis_quantile(&lognormal, 0.5, &value);
  assert_true(fabs(value.number - 10) < 1e-12);
  design_axis_quantile(&lognormal, 0.8413447460685429, &value); /* one sigma */
  assert_true(fabs(value.number / (10 * exp(0.5)) - 1) < 1e-12);
  struct design_axis logs = law(DESIGN_AXIS_LOG_UNIFORM, 1e-3, 1e3, -HUGE_VAL, HUGE_VAL);
  design_axis_quantile(&logs, 0.5, &value);
  assert_true(fabs(value.number - 1) < 1e-12);
  design_axis_quantile(&normal, 0, &value); /* a draw of exactly 0 does not give infinity */
  assert_true(isfinite(value.number));
}

TEST(shares_are_the_inverse_of_quantiles) {
  const struct design_axis axes[] = {law(DESIGN_AXIS_UNIFORM, -2, 5, -HUGE_VAL, HUGE_VAL),
                                     law(DESIGN_AXIS_LOG_UNIFORM, 1e33, 1e37, -HUGE_VAL, HUGE_VAL),
                                     law(DESIGN_AXIS_NORMAL, 3, 2, 2, 4), law(DESIGN_AXIS_NORMAL, 0, 1, 5, 6),
                                     law(DESIGN_AXIS_LOGNORMAL, 10, 0.5, -HUGE_VAL, HUGE_VAL)};
  struct design_axis whole = law(DESIGN_AXIS_UNIFORM, 2, 5, -HUGE_VAL, HUGE_VAL);
  struct field_value value;
  for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++)
    for (double u = 0.01; u < 1; u += 0.07) {
      design_axis_quantile(&axes[i], u, &value);
      assert_true(fabs(design_axis_share(&axes[i], &value) - u) < 1e-9);
    }
  whole.row = &integer_row;
  value = (struct field_value){.kind = FIELD_INTEGER, .integer = 4}; /* the third of four steps */
  assert_true(fabs(design_axis_share(&whole, &value) - 0.625) < 1e-12);
  whole.kind = DESIGN_AXIS_LEVELS;
  assert_true(isnan(design_axis_share(&whole, &value)));
}

/* Mean and variance of a truncated law against its closed form, by 4096 midpoints of u (error of the midpoint rule on a
 * smooth bounded quantile function: below 1e-5 of the width); never a value outside. */
TEST(truncated_laws_stay_inside) {
  const double cases[][4] = {{3, 2, 2, 4}, {0, 1, 5, 6}, {0, 1, -6, -5}, {0, 1, 36, 37}, {1, 0.5, 0.9, HUGE_VAL}};
  for (size_t c = 0; c < 5; c++) {
    struct design_axis axis = law(DESIGN_AXIS_NORMAL, cases[c][0], cases[c][1], cases[c][2], cases[c][3]);
    double sum = 0, before = -HUGE_VAL;
    enum { N = 4096 };
    for (int i = 0; i < N; i++) {
      struct field_value value;
      design_axis_quantile(&axis, (i + 0.5) / N, &value);
      assert_true(value.number >= axis.lower && value.number <= axis.upper);
      assert_true(value.number >= before);
      before = value.number;
      sum += value.number / N;
    }
    double a = (axis.lower - axis.a) / axis.b, b = (axis.upper - axis.a) / axis.b;
    double density = exp(-a * a / 2) - exp(-b * b / 2), mass;
    if (a > 0)
      mass = gsl_cdf_ugaussian_Q(a) - gsl_cdf_ugaussian_Q(b);
    else
      mass = gsl_cdf_ugaussian_P(b) - gsl_cdf_ugaussian_P(a);
    double mean = axis.a + axis.b * density / sqrt(2 * M_PI) / mass;
    if (!(fabs(sum - mean) < 2e-4 * axis.b))
      fail_msg("case %zu: mean %.9g, closed form %.9g", c, sum, mean);
    /* the open tail of the last case dominates: its last cell's share */
  }
  struct design_axis lognormal = law(DESIGN_AXIS_LOGNORMAL, 1e9, 0.3, 8e8, 1.2e9);
  struct design_axis whole = law(DESIGN_AXIS_UNIFORM, 2, 5, -HUGE_VAL, HUGE_VAL);
  struct design_axis rounded = law(DESIGN_AXIS_NORMAL, 4, 10, 2.4, 6.6);
  whole.row = rounded.row = &integer_row;
  int counts[8] = {0};
  for (int i = 0; i < 4000; i++) {
    struct field_value value;
    design_axis_quantile(&lognormal, (i + 0.5) / 4000, &value);
    assert_true(value.number >= 8e8 && value.number <= 1.2e9);
    design_axis_quantile(&whole, (i + 0.5) / 4000, &value);
    assert_true(value.integer >= 2 && value.integer <= 5);
    counts[value.integer]++;
    design_axis_quantile(&rounded, (i + 0.5) / 4000, &value);
    assert_true(value.integer >= 3 && value.integer <= 6);
  }
  for (int n = 2; n <= 5; n++)
    assert_int_equal(counts[n], 1000);
}

TEST(random_points_are_uniform) {
  enum { N = 20000, BINS = 50 };
  double chi = 0, counts[BINS] = {0}, product = 0;
  for (uint64_t i = 0; i < N; i++) {
    double u = design_random_coordinate(3, i, 0), v = design_random_coordinate(3, i, 1);
    counts[(int)(u * BINS)]++;
    product += (u - 0.5) * (v - 0.5) * 12 / N;
  }
  for (int b = 0; b < BINS; b++)
    chi += (counts[b] - N / (double)BINS) * (counts[b] - N / (double)BINS) * BINS / N;
  assert_true(chi < gsl_cdf_chisq_Pinv(1 - 1e-5, BINS - 1) && chi > gsl_cdf_chisq_Pinv(1e-5, BINS - 1));
  assert_true(fabs(product) < 4 / sqrt(N));
}

/* The first of a million points comes at once, and the last is there too. The time shows that the points are not all
 * stored in memory. */
TEST(a_million_points_are_a_counter) {
  struct design_axis axes[3] = {law(DESIGN_AXIS_UNIFORM, 0, 1, -HUGE_VAL, HUGE_VAL),
                                law(DESIGN_AXIS_LOG_UNIFORM, 1, 10, -HUGE_VAL, HUGE_VAL), levels(levels_a, 3)};
  for (int kind = DESIGN_RANDOM; kind <= DESIGN_SOBOL; kind++) {
    struct design *design;
    struct field_value values[3];
    OK(design_create((enum design_kind)kind, axes, 3, 1000000, 1, &design, &error));
    clock_t begin = clock();
    assert_true(design_next(design, values));
    assert_true(clock() - begin < CLOCKS_PER_SEC / 10);
    assert_int_equal(design_points(design), 1000000);
    design_free(design);
  }
}
