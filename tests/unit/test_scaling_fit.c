/* Finite-size scaling of made-up runs with known exponents, and of runs that have none. */

#include "analysis/inference/scaling.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { SIZES = 5, POINTS = 11, SEEDS = 20, ALL = SIZES * POINTS * SEEDS };
static const double CRITICAL = 14, NU = 0.8, BETA = 0.2, GAMMA = 1.6, CUTOFF = 1.8; /* 2 beta + gamma = d */

static void assert_near(double a, double b, double tolerance) {
  assert_true(fabs(a - b) <= tolerance);
}

struct law {
  size_t sizes;
  double noise;      /* standard deviation of ln P and ln S of a run */
  double correction; /* P is larger by this share of 1/L */
  double sign;       /* of dP/dx */
};

static double noise(uint64_t seed, uint64_t item, uint64_t draw) { /* Box and Muller 1958 */
  const double u = random_draw(seed, 1, item, 2 * draw) + 0x1p-54, v = random_draw(seed, 1, item, 2 * draw + 1);
  return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

static size_t make(const struct law *law, struct scaling_run *run) {
  size_t n = 0;
  for (size_t i = 0; i < law->sizes; i++)
    for (size_t k = 0; k < POINTS; k++)
      for (uint64_t seed = 1; seed <= SEEDS; seed++, n++) {
        const double size = 10 * pow(2, (double)i), x = 12 + 0.4 * (double)k;
        const double z = law->sign * (x - CRITICAL) * pow(size / 160, 1 / NU);
        const double p = 0.6 * pow(size, -BETA) * exp(0.2 * z + law->noise * noise(seed, i, 0)) *
                         (1 + law->correction / size);
        const double s = 0.05 * pow(size, GAMMA) * exp(-0.3 * z + law->noise * noise(seed, i, 1));
        run[n] = (struct scaling_run){size, x, seed, p, p, s, s * 0.3 * pow(size, CUTOFF) * exp(-0.1 * z)};
      }
  return n;
}

static void find(size_t n, const struct scaling_run *run, struct scaling *found) {
  OK(scaling_find(n, run, 2, found, &error));
}

static const double exact[SCALING_VALUES] = {CRITICAL, NU, BETA, GAMMA, CUTOFF, 3 - 1.6 / 1.8};

/* Without noise and without corrections the fit is exact but for the cubic in z, which is not the law of Q. */
TEST(exact_runs_give_exact_values) {
  static struct scaling_run run[ALL];
  for (int sign = -1; sign <= 1; sign += 2) {
    SCALING found;
    find(make(&(struct law){SIZES, 0, 0, sign}, run), run, &found);
    assert_int_equal(found.kind, SCALING_FOUND);
    assert_int_equal(found.sizes, SIZES);
    assert_int_equal(found.runs, ALL);
    for (int v = 0; v < SCALING_VALUES; v++) {
      assert_near(found.value[v].estimate, exact[v], 2e-3 * exact[v]);
      assert_true(found.value[v].half_width < 5e-3 * exact[v]);
    }
  }
}

/* Runs without an order parameter leave the scatter of the others: the bars of P are wider by the root of 20/16. */
TEST(runs_without_an_order) {
  static struct scaling_run run[ALL];
  SCALING all, part;
  const size_t n = make(&(struct law){SIZES, 0.05, 0, 1}, run);
  find(n, run, &all);
  for (size_t i = 0; i < n; i += 5)
    run[i].order = NAN;
  find(n, run, &part);
  assert_int_equal(part.kind, SCALING_FOUND);
  double ratio = 0;
  for (size_t c = 0; c < all.cells; c++)
    ratio += part.cell[c].half_width[0] / all.cell[c].half_width[0] / (double)all.cells;
  assert_near(ratio, sqrt(1.25), 0.1);
}

/* The interval has the width of the noise and holds the value; 95 % of six values may miss one. */
TEST(intervals_hold_the_values) {
  static struct scaling_run run[ALL];
  SCALING found;
  int held = 0;
  find(make(&(struct law){SIZES, 0.2, 0, 1}, run), run, &found);
  assert_int_equal(found.kind, SCALING_FOUND);
  for (int v = 0; v < SCALING_VALUES; v++)
    held += fabs(found.value[v].estimate - exact[v]) <= found.value[v].half_width;
  assert_true(held >= SCALING_VALUES - 1);
  /* ln P scatters by 0.2 / sqrt(20) at a size; over sizes 20 to 160 a slope is off by 0.029, and 1.96 of that is 0.057.
   * The error of x_c adds to it. */
  assert_true(found.value[SCALING_BETA].half_width > 0.04 && found.value[SCALING_BETA].half_width < 0.2);
  assert_true(found.chi_square[0] < 4 && found.chi_square[1] < 4);
}

/* P is larger by 2/L: a fifth at the smallest size. S has no correction of its own: only x_c and nu, which Q shifts,
 * move gamma/nu. */
TEST(a_correction_is_inside_the_interval) {
  static struct scaling_run run[ALL];
  SCALING found;
  find(make(&(struct law){SIZES, 1e-4, 2, 1}, run), run, &found);
  assert_int_equal(found.kind, SCALING_FOUND);
  assert_true(fabs(found.value[SCALING_BETA].shift) > 1e-3);
  assert_true(found.value[SCALING_GAMMA].half_width < 0.038);
  for (int v = 0; v < SCALING_VALUES; v++)
    assert_true(fabs(found.value[v].estimate - exact[v]) <= found.value[v].half_width + 2e-3 * exact[v]);
}

/* S has a part that knows nothing of the transition: as large as the other one at L = 10. The curves are one all the
 * same. */
TEST(a_regular_part_of_the_masses) {
  static struct scaling_run run[ALL];
  SCALING found;
  const size_t n = make(&(struct law){SIZES, 0.05, 0, 1}, run);
  for (size_t i = 0; i < n; i++)
    run[i].second += 2;
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_FOUND);
  assert_true(found.distance[1] < 0.1);
  assert_true(fabs(found.value[SCALING_GAMMA].estimate - GAMMA) <= found.value[SCALING_GAMMA].half_width);
}

TEST(the_order_of_runs_and_the_unit_of_x_change_nothing) {
  static struct scaling_run run[ALL], other[ALL];
  SCALING a, b;
  const size_t n = make(&(struct law){SIZES, 0.1, 0, 1}, run);
  for (size_t i = 0; i < n; i++) {
    other[i] = run[(i * 7) % n];
    other[i].control *= 1024;
  }
  find(n, run, &a);
  find(n, other, &b);
  for (int v = 0; v < SCALING_VALUES; v++) {
    const double unit = v == SCALING_CRITICAL ? 1024 : 1;
    assert_near(a.value[v].estimate * unit, b.value[v].estimate, 1e-5 * unit);
    assert_near(a.value[v].half_width * unit, b.value[v].half_width, 1e-5 * unit);
  }
}

TEST(two_sizes_are_too_few) {
  static struct scaling_run run[ALL];
  SCALING found;
  find(make(&(struct law){2, 0.1, 0, 1}, run), run, &found);
  assert_int_equal(found.kind, SCALING_TOO_FEW);
  assert_true(isnan(found.value[SCALING_NU].estimate));
  assert_int_equal(found.cells, 2 * POINTS); /* a picture can be drawn */
  find(0, run, &(struct scaling){0});
}

/* The same curve of P at every size: no transition but a slope. */
TEST(curves_that_do_not_cross) {
  static struct scaling_run run[ALL];
  SCALING found;
  const size_t n = make(&(struct law){SIZES, 0.1, 0, 1}, run);
  for (size_t i = 0; i < n; i++) {
    const double p = 0.3 + 0.05 * (run[i].control - CRITICAL), rest = 1 - p;
    const double square = run[i].size * run[i].size;
    run[i].order = run[i].largest = p * (1 + 0.02 * noise(run[i].seed, i, 3));
    run[i].second = 0.1 * rest * rest * square;
    run[i].third = 0.01 * rest * rest * rest * square * square;
  }
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_NO_CROSSING);
  assert_true(isnan(found.value[SCALING_CRITICAL].estimate));
  /* Q is p^2 over p^2 + 0.1 (1 - p)^2 for all sizes, but for 2 % of noise: it differs nowhere. */
  assert_true(!found.differ && found.touch && isnan(found.crossing));
  assert_true(found.range[0] == 12 && found.range[1] == 16);
  assert_true(found.nearest >= 12 && found.nearest <= 16 && fabs(found.nearest_q[1] - found.nearest_q[0]) < 0.02);
  for (size_t i = 0; i < n; i++) /* nearest at the largest control */
    run[i].second *= 1 + (16.2 - run[i].control) * run[i].size;
  scaling_release(&found);
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_NO_CROSSING);
  assert_true(found.differ && !found.touch && found.nearest == 16);
}

/* Curves that cross, but are no steeper at the largest size than at the middle one; and two runs a point that scatter
 * more than the curves change. There are no values, no NaN is told as a distance, and the place of the crossing is. */
TEST(runs_that_tell_no_values) {
  static struct scaling_run run[ALL], some[ALL];
  static const double slope[] = {0.1, 2, 1};
  SCALING found;
  size_t n = make(&(struct law){3, 0, 0, 1}, run);
  for (size_t i = 0; i < n; i++) {
    const double square = run[i].size * run[i].size, at = slope[lround(log2(run[i].size / 10))];
    run[i].largest = 0.4 * (1 + 0.01 * noise(run[i].seed, i, 5));
    run[i].order = run[i].control;
    run[i].second = 0.16 * square * exp(-at * (run[i].control - CRITICAL));
  }
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_NOT_TOLD);
  assert_near(found.crossing, CRITICAL, 0.1);
  assert_near(found.about[0], 13.2, 0.41);
  assert_near(found.about[1], 14.8, 0.41);
  int not_told = 0, may_jump = 0;
  n = make(&(struct law){3, 0.2, 0, 1}, run);
  for (size_t i = 0; i < n; i++)
    run[i].second *= exp(1.2 * noise(run[i].seed, i, 6));
  for (uint64_t first = 1; first < SEEDS; first += 2) {
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
      if (run[i].seed - first < 2 && run[i].control < 15)
        some[count++] = run[i];
    scaling_release(&found);
    find(count, some, &found);
    const bool told = found.kind == SCALING_FOUND || found.kind == SCALING_JUMP;
    assert_true(told == !isnan(found.value[SCALING_CRITICAL].estimate));
    assert_true(found.kind != SCALING_JUMP ||
                found.value[SCALING_NU].estimate + found.value[SCALING_NU].half_width < 1);
    may_jump += found.kind == SCALING_FOUND && found.may_jump;
    not_told += found.kind == SCALING_NOT_TOLD && isfinite(found.chi_square[0]);
  }
  assert_true(not_told > 0 && may_jump > 0);
}

/* The least and the largest size cross at 14, the larger ones at 12.5, where there are no runs. */
TEST(a_critical_value_beyond_the_runs) {
  static struct scaling_run run[ALL];
  SCALING found;
  size_t count = 0;
  const size_t n = make(&(struct law){3, 0, 0, 1}, run);
  for (size_t i = 0; i < n; i++) {
    const double x = run[i].control, square = run[i].size * run[i].size;
    const double log_ratio = run[i].size < 15 ? -3 - 0.1 * (x - 14) : -0.05 * run[i].size * (x - 12.5);
    run[i].largest = 0.4 * (1 + 0.01 * noise(run[i].seed, i, 5));
    run[i].order = run[i].largest * x;
    run[i].second = 0.16 * square * exp(log_ratio);
    if (x > 13)
      run[count++] = run[i];
  }
  find(count, run, &found);
  assert_int_equal(found.kind, SCALING_NOT_TOLD);
  assert_near(found.crossing, 14, 0.1);
  assert_true(isnan(found.chi_square[0]) && isnan(found.value[SCALING_CRITICAL].estimate));
}

/* A body breaks into halves at a threshold of its own, or stays whole: the thresholds scatter as L^-2. */
TEST(a_jump_is_told) {
  enum { VALUES = 21, BODIES = 100 };
  static struct scaling_run run[4 * VALUES * BODIES];
  SCALING found;
  size_t n = 0;
  for (size_t i = 0; i < 4; i++)
    for (int k = 0; k < VALUES; k++)
      for (uint64_t seed = 1; seed <= BODIES; seed++, n++) {
        const double size = 10 * pow(2, (double)i), square = size * size;
        const double x = 10 + 30 * (k - 10) * pow(size, -2);
        const bool whole = x > 10 + 100 * noise(seed, i, 4) / square;
        run[n] = (struct scaling_run){size,
                                      x,
                                      seed,
                                      whole ? 0.9 : 0.05 * 10 / size,
                                      whole ? 0.9 : 0.05 * 10 / size,
                                      whole ? 0.5 : 4,
                                      whole ? 1 : 10};
      }
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_JUMP);
  assert_true(fabs(found.value[SCALING_CRITICAL].estimate - 10) <= found.value[SCALING_CRITICAL].half_width);
}

/* The sizes cross, but P goes up and down with L by a factor of three. */
TEST(curves_that_are_not_one) {
  static struct scaling_run run[ALL];
  SCALING found;
  const size_t n = make(&(struct law){SIZES, 0.05, 0, 1}, run);
  for (size_t i = 0; i < n; i++)
    run[i].order *= lround(log2(run[i].size / 10)) % 2 ? 3 : 1;
  find(n, run, &found);
  assert_int_equal(found.kind, SCALING_NOT_ONE);
  assert_true(isnan(found.value[SCALING_BETA].estimate));
  assert_true(found.chi_square[0] > 4 && found.distance[0] > 0.1);
}

/* Whole bodies have no other fragment: S and T are 0. */
TEST(whole_bodies_count) {
  static struct scaling_run run[ALL];
  SCALING found;
  const size_t n = make(&(struct law){SIZES, 0.1, 0, 1}, run);
  for (size_t i = 0; i < n; i++)
    if (run[i].control > 15.3) {
      run[i].order = run[i].largest = 1;
      run[i].second = run[i].third = 0;
    }
  find(n, run, &found);
  assert_int_equal(found.runs, ALL);
  assert_int_equal(found.kind, SCALING_FOUND);
}
