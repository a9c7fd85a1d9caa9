/* The crossing of a level: likelihoods, intervals and next places by hand, and every kind of answer. */

#include "analysis/analysis.h"
#include "analysis/inference/crossing.h"
#include "tests/support/check.h"

#define NEAR(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static struct crossing find(size_t n, const double *x, const double *y, double level, double share) {
  struct crossing found;
  const struct crossing_data data = {.n = n, .x = x, .y = y, .level = level, .share = share};
  OK(crossing_find(&data, &found, &error));
  return found;
}

/* Means -2, 0 and 2 are in order, so the curve goes through them. Squares about it: 2 + 2 + 4.5 with 6 - 3 degrees of
 * freedom: variance 8.5 / 3, weight of a mean 6 / 8.5 = 0.705882. A crossing below 0 would put the first mean at 0:
 * 4 * 0.705882 = 2.823529, likelihood exp(-1.411765) = 0.243713; likewise above 1. Both are far below 1.4 t^2 = 14.2.
 * Gaps of 0.1, 0.5, 0.5 and 0.1 have the weights 0.0243713, 0.5, 0.5, 0.0243713; an eighth of their sum is 0.131093. */
TEST(means_by_hand) {
  const double x[6] = {1, 0.5, 0, 0, 0.5, 1}, y[6] = {10.5, 9, 7, 9, 11, 13.5};
  struct crossing found = find(6, x, y, 10, NAN);
  assert_int_equal(found.kind, CROSSING_OPEN);
  assert_true(isnan(found.share) && found.rising && found.n == 6);
  NEAR(found.low, -0.1, 1e-12);
  NEAR(found.high, 1.1, 1e-12);
  NEAR(found.at, 0.5, 1e-12);
  NEAR(found.next[0], 0.131093 - 0.0243713, 1e-6);
  NEAR(found.next[3], 1 - found.next[0], 1e-12);
  double mirrored[6];
  for (int i = 0; i < 6; i++)
    mirrored[i] = 20 - y[i];
  found = find(6, x, mirrored, 10, NAN);
  assert_false(found.rising);
  NEAR(found.next[0], 0.106722, 1e-6);
}

/* Two modes: -1 and 3 about the level, so their mean is at it for a share of 1/4 of the upper one. Below the crossing
 * are n runs of the lower mode. If the crossing were below all places, their share would be at least 1/4: minus twice
 * the logarithm of the likelihood is -2 n ln(3/4) = 0.575364 n. The limit is 1.4 * 3.841459 = 5.378042, so 9 runs do
 * not exclude it and 10 runs do. Above, -2 n ln(1/4) = 2.772589 n: two runs. */
TEST(modes_by_hand) {
  double x[12], y[12];
  for (int n = 9; n <= 10; n++) {
    for (int i = 0; i < n + 2; i++) {
      x[i] = i < n ? 0 : 1;
      y[i] = i < n ? 4 : 8;
    }
    const struct crossing found = find((size_t)n + 2, x, y, 5, NAN);
    NEAR(found.share, 0.25, 1e-12);
    assert_int_equal(found.kind, n == 10 ? CROSSING_FOUND : CROSSING_OPEN);
    NEAR(found.low, n == 10 ? 0 : -0.1, 1e-12);
    NEAR(found.high, 1, 1e-12);
  }
  const struct crossing found = find(12, x, y, 5, 0.25); /* the same, as was asked for */
  NEAR(found.high - found.low, 1, 1e-12);
  assert_true(crossing_is_answer(&found, 1) && !crossing_is_answer(&found, 0.5));
}

/* A run of the upper mode at 0.4 and one of the lower at 0.6 are out of order; the curve pools them: 0, 1/2, 1. */
TEST(places_out_of_order_are_pooled) {
  const double x[22] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.4, 0.6, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const double y[22] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const struct crossing found = find(22, x, y, 0.5, 0.5);
  /* Gaps (0, 0.4), (0.4, 0.6), (0.6, 1): the best curves have 0, 1/2, 1/2, 1, all with 4 ln 2, of equal likelihood. */
  NEAR(found.low, 0, 1e-12);
  NEAR(found.high, 1, 1e-12);
  NEAR(found.at, 0.5, 1e-3);
}

enum { PLACES = 21, EACH = 8 };
static struct crossing of_curve(double (*curve)(double), double noise) {
  static double x[PLACES * EACH], y[PLACES * EACH];
  for (int i = 0; i < PLACES * EACH; i++) {
    x[i] = i / EACH / (PLACES - 1.0);
    y[i] = curve(x[i]) + noise * (i % 2 ? 1 : -1);
  }
  return find(PLACES * EACH, x, y, 0, NAN);
}

static double high(double x) {
  return 1 + x;
}
static double low(double x) {
  return x - 2;
}
static double humps(double x) {
  return sin(15 * x + 0.5);
}
static double shelf(double x) {
  return x < 0.32 ? x - 0.32 : x > 0.68 ? x - 0.68 : 0;
}
static double nothing(double x) {
  (void)x;
  return 0;
}

TEST(kinds) {
  assert_int_equal(of_curve(high, 0.1).kind, CROSSING_ABOVE);
  assert_int_equal(of_curve(low, 0.1).kind, CROSSING_BELOW);
  assert_int_equal(of_curve(low, 0).kind, CROSSING_BELOW);
  /* 15 x + 0.5 passes pi, 2 pi, 3 pi and 4 pi: at 0.176, 0.386, 0.595 and 0.804. */
  const struct crossing found = of_curve(humps, 0.1);
  assert_int_equal(found.kind, CROSSING_SEVERAL);
  assert_int_equal(found.parts, 4);
  for (size_t i = 0; i < found.parts; i++) {
    const double at = ((double)(i + 1) * 3.14159265 - 0.5) / 15;
    assert_true(found.part[i].low <= at && at <= found.part[i].high);
    NEAR(found.part[i].high, found.part[i].low, 0.16);
  }
  const struct crossing flat = of_curve(shelf, 0.001);
  assert_int_equal(flat.kind, CROSSING_PLATEAU);
  assert_true(flat.low <= 0.35 && flat.high >= 0.65 && crossing_is_answer(&flat, 0));
  assert_int_equal(of_curve(nothing, 0).kind, CROSSING_PLATEAU);
}

/* Six places with 20 runs each, at the level without noise: a third of their runs ends within a place. */
TEST(plateau_of_few_places) {
  static const double level[4] = {-1, -0.01, 0.01, 1};
  double x[200], y[200];
  for (int i = 0; i < 200; i++) {
    const int place = i / 20;
    x[i] = place == 0 ? 0 : place == 9 ? 1 : 0.2 + 0.07 * place;
    y[i] = place < 2 ? level[place] : place > 7 ? level[place - 6] : 0;
  }
  const struct crossing found = find(200, x, y, 0, NAN);
  assert_int_equal(found.kind, CROSSING_PLATEAU);
}

TEST(runs_without_results) {
  struct crossing found;
  const double x[4] = {0, 1, 1, 1}, y[4] = {1, NAN, NAN, HUGE_VAL};
  const struct crossing_data data = {.n = 4, .x = x, .y = y, .level = 0, .share = NAN};
  assert_int_equal(crossing_find(&data, &found, &error), STATUS_CONTENT);
  assert_int_equal(found.kind, CROSSING_OPEN);
}

/* Scatter of 0.5 about the means -1, 1 and, at the end, -0.65. Pooled within the places the variance of a run is 0.25 *
 * 4 / 3, so the mean of four has an error of 0.289, and the last place is 2.25 errors below the level, after a crossing
 * between 0.45 and 0.55. It proves no second one, but no answer is given before runs around it have been made. */
TEST(a_place_that_contradicts_is_looked_at) {
  const double places[9] = {0, 0.15, 0.3, 0.45, 0.55, 0.65, 0.75, 0.85, 1};
  double x[36], y[36];
  for (int i = 0; i < 36; i++) {
    x[i] = places[i / 4];
    y[i] = (i < 16 ? -1 : i < 32 ? 1 : -0.65) + (i % 2 ? 0.5 : -0.5);
  }
  struct crossing found = find(36, x, y, 0, NAN);
  assert_int_equal(found.kind, CROSSING_FOUND);
  NEAR(found.low, 0.45, 1e-12);
  NEAR(found.high, 0.55, 1e-12);
  assert_true(found.contradicted && !crossing_is_answer(&found, 0.2));
  NEAR(found.next[0], 0.925, 1e-12);
  NEAR(found.next[3], 1, 1e-12);
  for (int i = 0; i < 36; i++)
    x[i] = 1 - x[i]; /* the first place contradicts */
  found = find(36, x, y, 0, NAN);
  assert_true(found.contradicted);
  NEAR(found.next[0], 0, 1e-12);
  NEAR(found.next[3], 0.075, 1e-12);
  for (int i = 32; i < 36; i++)
    y[i] += 1.65;
  found = find(36, x, y, 0, NAN);
  assert_true(!found.contradicted && crossing_is_answer(&found, 0.2));
}

/* Nothing breaks at the first place, so all of its runs are 0; elsewhere a maximum falls towards the level, 1.5, and
 * scatters much. The scatter of the neighbours would hide the first place. 6 runs there prove no crossing, but the
 * answer is not "above the level", and the next runs are there. With 24 runs the response rises at the low end. */
TEST(a_place_of_equal_runs_keeps_its_own_scatter) {
  for (int last = 0; last < 2; last++) { /* 2.5: still above the level, or 0.5 */
    const double means[8] = {0, 8, 18, 11, 7, 4, 3, last ? 0.5 : 2.5}, scatter[8] = {0, 8, 9, 3, 1, 0.6, 0.4, 0.2};
    for (int zeros = 6; zeros <= 24; zeros += 18) {
      double x[52], y[52];
      const int n = zeros + 28;
      for (int i = 0; i < n; i++) {
        const int place = i < zeros ? 0 : 1 + (i - zeros) / 4;
        x[i] = place / 7.0;
        y[i] = means[place] + (i % 2 ? 1 : -1) * scatter[place];
      }
      const struct crossing found = find((size_t)n, x, y, 1.5, NAN);
      assert_int_equal(found.kind, CROSSING_OPEN);
      if (zeros == 6)
        assert_true(found.contradicted && found.contradiction == 0 && found.next[1] == 0);
      else
        assert_true(found.rising && found.high < 0.5);
    }
  }
}

/* Low, high, low, with less scatter at both ends. The interval of the rise is wide; the place at the other end lies
 * below the level by 1.9, and the error of its mean is 0.5 / sqrt(3) by its own runs. */
TEST(an_end_on_the_wrong_side_is_told_of_a_wide_interval) {
  const double places[9] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1};
  const double means[9] = {-1.8, -1.8, -1.8, -1.8, 3, 2.4, 1.5, 1, -1.9};
  double x[36], y[36];
  for (int mirrored = 0; mirrored <= 1; mirrored++) {
    for (int i = 0; i < 36; i++) {
      const int place = i / 4;
      x[i] = mirrored ? 1 - places[place] : places[place];
      y[i] = means[place] + (i % 2 ? 1 : -1) * (place > 7 ? 0.5 : place > 3 ? 1.5 : 0.1);
    }
    const struct crossing found = find(36, x, y, 0, NAN);
    assert_int_equal(found.kind, CROSSING_FOUND);
    assert_true(found.rising == !mirrored && found.high - found.low > 0.25);
    assert_true(found.contradicted && found.contradiction == !mirrored);
    assert_true(!crossing_is_answer(&found, 1));
  }
}

/* Bodies stay whole up to 0.4 (0.6 above the level); beyond, half of them do, and the others lie 0.5 to 3.5 below it.
 * All of three runs at a place are whole one time in eight, so such a place proves nothing and gets no more runs. */
TEST(few_equal_runs_do_not_contradict) {
  double x[24 * 21], y[24 * 21];
  size_t n = 0;
  for (int place = 0; place <= 20; place++)
    for (int i = 0; i < (place == 16 ? 3 : 24); i++) {
      x[n] = place / 20.0;
      y[n++] = place < 9 || place == 16 || i % 2 ? 0.6 : -0.5 - 0.5 * (i % 8);
    }
  const struct crossing found = find(n, x, y, 0, NAN);
  assert_int_equal(found.kind, CROSSING_FOUND);
  assert_true(!found.rising && !found.contradicted);
}

TEST(rounds_grow_by_a_sixth) {
  const struct crossing found = {.next = {0.1, 0.2, 0.3, 0.4}};
  double place[CROSSING_PLACES];
  assert_int_equal(crossing_next(&found, 20, place), 2);
  assert_int_equal(crossing_next(&found, 96, place), 4);
  NEAR(place[2], 0.3, 0);
}

TEST(runs_for_a_width) {
  assert_int_equal(crossing_runs_for(100, 0.2, 0.1), 400);
  assert_int_equal(crossing_runs_for(368, 13, 5.5), 2100); /* 2056 */
  assert_int_equal(crossing_runs_for(40, 0.11, 0.1), 49);  /* 48.4 */
}
