/* Summaries against exact numbers; coverage of intervals, of stopping rules and of the jackknife against their nominal
 * level, within Monte-Carlo errors (sqrt(p(1-p)/N), four of them). */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

static double normal(uint64_t stream, uint64_t sample, uint64_t i) {
  uint64_t bits[4];
  random_bits(30, stream, sample, i, bits);
  return sqrt(-2 * log(1 - random_uniform(bits[0]))) * cos(2 * M_PI * random_uniform(bits[1]));
}

TEST(summaries_are_exact) {
  /* Offsets at which a plain sum of squares loses all digits: mean 1e9 + 3, variance 2.5. */
  const double values[] = {1e9 + 1, NAN, 1e9 + 2, 1e9 + 5, 1e9 + 4, NAN, 1e9 + 3};
  struct sample_summary s = sample_summarise(7, values, 0.95);
  assert_int_equal(s.n, 5);
  assert_true(s.mean == 1e9 + 3);
  assert_true(fabs(s.standard_deviation - sqrt(2.5)) < 1e-15 * 4);
  /* Student t, 4 degrees of freedom, 97.5 %: 2.776445105 (tables). */
  assert_true(fabs(s.half_width / (2.776445105198 * sqrt(0.5)) - 1) < 1e-10);
  s = sample_summarise(1, values, 0.95);
  assert_true(s.n == 1 && s.mean == 1e9 + 1 && isnan(s.standard_deviation) && isnan(s.half_width));
  s = sample_summarise(0, NULL, 0.95);
  assert_true(s.n == 0 && isnan(s.mean));
  /* Small differences at a large mean are no rounding. */
  s = sample_summarise(4, (const double[]){1e9, 1e9 + 1e-3, 1e9 + 2e-3, 1e9 + 1e-3}, 0.95);
  assert_true(fabs(s.half_width / (3.182446305 * 1e-3 / sqrt(6)) - 1) < 1e-3);

  struct sample_moments moments = {0};
  s = sample_summarise_moments(&moments, 0.95);
  assert_true(s.n == 0 && isnan(s.mean) && isnan(s.standard_deviation));
  for (int i = 0; i < 7; i++)
    sample_add(&moments, values[i]);
  s = sample_summarise_moments(&moments, 0.95);
  assert_int_equal(s.n, 5);
  /* Running means round to a unit in the last place of 1e9, 1.2e-7. */
  assert_true(fabs(s.mean - 1e9 - 3) < 1e-6 && fabs(s.standard_deviation - sqrt(2.5)) < 1e-6);
}

/* The shortest prefix n0, n0 + SAMPLE_BATCH, ... at which a campaign stops; 0: none up to n. */
static size_t stopping_prefix(size_t n, const double *values, double half_width, size_t n0) {
  for (size_t length = n0; length <= n; length += SAMPLE_BATCH)
    if (sample_may_stop(length, values, half_width, 0.95, n0))
      return length;
  return 0;
}

/* Share of `trials` in which the interval at the stopped prefix holds the true mean. */
static double coverage(bool bimodal, size_t n0, double half_width, int trials, double *mean_length) {
  enum { MOST = 600 };
  double values[MOST];
  int held = 0;
  *mean_length = 0;
  for (int trial = 0; trial < trials; trial++) {
    for (uint64_t r = 0; r < MOST; r++)
      values[r] = bimodal ? (random_draw(31, n0, (uint64_t)trial, r) < 0.1 ? 1 : 0) : normal(n0, (uint64_t)trial, r);
    size_t length = stopping_prefix(MOST, values, half_width, n0);
    assert_true(length >= n0 && length <= MOST);
    struct sample_summary s = sample_summarise(length, values, 0.95);
    held += fabs(s.mean - (bimodal ? 0.1 : 0)) <= half_width;
    *mean_length += (double)length / trials;
  }
  printf("  %s n0 %zu: coverage %.3f, stops at %.0f\n", bimodal ? "90/10 " : "normal", n0, (double)held / trials,
         *mean_length);
  return (double)held / trials;
}

TEST(stopping_keeps_its_level) {
  enum { TRIALS = 2000 };
  double length, standard_error = sqrt(0.95 * 0.05 / TRIALS);
  /* Normal data: at least the level (the guard and the last batch overshoot the width wanted). */
  assert_true(coverage(false, 20, 0.5, TRIALS, &length) > 0.95 - 4 * standard_error);
  assert_true(coverage(false, 30, 0.2, TRIALS, &length) > 0.95 - 4 * standard_error);
  /* (1.97/0.2)^2 = 97 runs, the guard adds (20 t)^2/97 = 16, the batch half of ten */
  assert_true(length > 105 && length < 125);
  /* One run in ten is 1, the rest 0. Without the guard .85-.89 from n0 = 30 and .7 from 3: the test would fail. */
  double least = 0.91 - 4 * sqrt(0.91 * 0.09 / TRIALS);
  assert_true(coverage(true, SAMPLE_FIRST, 0.06, TRIALS, &length) > least);
  assert_true(coverage(true, SAMPLE_FIRST, 0.05, TRIALS, &length) > least);
  assert_true(coverage(true, SAMPLE_FIRST, 0.04, TRIALS, &length) > least);
  assert_true(coverage(true, 3, 0.05, TRIALS, &length) > least);
}

TEST(stopping_waits) {
  double equal[100], scattered[100];
  const double zeros[100] = {0}, tiny[4] = {0, 0, 1e-170, 3e-170};
  for (int i = 0; i < 100; i++) {
    equal[i] = 0.25;
    scattered[i] = i % 2;
  }
  assert_int_equal(stopping_prefix(29, equal, 0.01, 30), 0);
  assert_int_equal(stopping_prefix(100, equal, 0.01, 30), 50); /* 20 t = 40.4 */
  assert_int_equal(stopping_prefix(100, zeros, 0.01, 30), 50); /* zeros are as equal */
  struct sample_moments moments = {0};
  for (int i = 0; i < 4; i++)
    sample_add(&moments, tiny[i]); /* zeros before the first value do not hide its scatter */
  assert_true(fabs(sample_summarise_moments(&moments, 0.95).standard_deviation - sqrt(2) * 1e-170) < 1e-180);
  assert_int_equal(stopping_prefix(100, scattered, 0.01, 30), 0);
  equal[3] = NAN; /* a failed run: 29 values in 30 replicates */
  assert_int_equal(stopping_prefix(100, equal, 0.01, 30), 50);
  assert_false(sample_may_stop(30, equal, 0.01, 0.95, 30));
  assert_int_equal(stopping_prefix(100, equal, 0, 30), 0);
  assert_int_equal(stopping_prefix(100, equal, NAN, 30), 0);
}

struct clusters {
  const double *values;
};
static double mean_of(size_t n, const uint32_t *runs, void *context) {
  const double *values = ((struct clusters *)context)->values;
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += values[runs[i]];
  return sum / (double)n;
}

/* Of a mean, leaving out one run after another is Student's interval itself; of groups of runs, nearly. */
TEST(jackknife_of_a_mean_is_students) {
  enum { MOST = 250, TRIALS = 400 };
  static const size_t sizes[] = {2, 3, 50, SAMPLE_GROUPS};
  double values[MOST], ratio = 0;
  for (uint64_t i = 0; i < MOST; i++)
    values[i] = normal(77, 0, i);
  for (size_t k = 0; k < 4; k++) {
    struct sample_interval j = sample_jackknife(sizes[k], 0.95, mean_of, &(struct clusters){values});
    struct sample_summary s = sample_summarise(sizes[k], values, 0.95);
    assert_true(fabs(j.estimate - s.mean) < 1e-13);
    assert_true(fabs(j.standard_error / s.standard_error - 1) < 1e-10);
    assert_true(fabs(j.half_width / s.half_width - 1) < 1e-10);
  }
  int held = 0;
  for (uint64_t trial = 0; trial < TRIALS; trial++) { /* 84 groups of three runs, the last of one */
    for (uint64_t i = 0; i < MOST; i++)
      values[i] = normal(77, trial, i);
    struct sample_interval j = sample_jackknife(MOST, 0.95, mean_of, &(struct clusters){values});
    struct sample_summary s = sample_summarise(MOST, values, 0.95);
    ratio += j.standard_error / s.standard_error / TRIALS;
    held += fabs(j.estimate) <= j.half_width;
  }
  printf("  by groups: error over standard error %.4f, coverage %.3f\n", ratio, (double)held / TRIALS);
  assert_true(fabs(ratio - 1) < 4 / sqrt(2.0 * 83 * TRIALS) + 0.005 /* an error of 83 degrees is 0.3 % low */);
  assert_true(fabs((double)held / TRIALS - 0.95) < 4 * sqrt(0.95 * 0.05 / TRIALS));
}

static double mean_of_four_at_least(size_t n, const uint32_t *runs, void *context) {
  return n < 4 ? (double)NAN : mean_of(n, runs, context);
}

TEST(jackknife_refuses_what_it_cannot_tell) {
  const double values[7] = {1, 4, 2, 8, 5, 7, 1};
  struct clusters clusters = {values};
  struct sample_interval none = sample_jackknife(0, 0.9, mean_of, &clusters);
  assert_true(isnan(none.estimate) && isnan(none.half_width));
  struct sample_interval one = sample_jackknife(1, 0.9, mean_of, &clusters);
  assert_true(one.estimate == 1 && isnan(one.standard_error) && isnan(one.half_width));
  struct sample_interval four = sample_jackknife(4, 0.9, mean_of_four_at_least, &clusters);
  assert_true(four.estimate == 3.75 && isnan(four.half_width)); /* no value without any one of the runs */
  assert_true(isfinite(sample_jackknife(5, 0.9, mean_of_four_at_least, &clusters).half_width));
  const double same[7] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}; /* no +- 0, also where their sum rounds */
  struct clusters equal = {same};
  assert_true(isnan(sample_jackknife(7, 0.9, mean_of, &equal).half_width));
  assert_true(isnan(sample_summarise(7, same, 0.9).half_width) && isnan(sample_summarise(7, same, 0.9).low));
}

/* An infinite value, which only a damaged store has: no scatter is known. It is not 0, which would end a campaign. */
TEST(infinite_values_have_no_interval) {
  const double values[] = {1, HUGE_VAL, 2};
  const struct sample_summary summary = sample_summarise(3, values, 0.95);
  assert_true(isinf(summary.mean));
  assert_true(isnan(summary.standard_deviation) && isnan(summary.standard_error) && isnan(summary.half_width));
}

TEST(crossed_by_hand) {
  struct sample_crossed c;
  /* Means 2 and 5, of points 2.25. Parts -+ 1/sqrt(2) and -+ 3/sqrt(2): seeds -+ 4/sqrt(2), of seeds 16/4; pairs 6/2.
   */
  const struct sample_of_seed two[] = {{9, 3}, {5, 1}, {5, 2}, {9, 8}};
  assert_true(sample_crossed(2, (const size_t[]){0, 2, 4}, two, &c));
  const double units = 5.25 * 5.25 / (2.25 * 2.25 + 16) + 1;
  assert_true(fabs(c.units / units - 1) < 1e-14 && fabs(c.deviation / sqrt(5.25 * units) - 1) < 1e-14);
  /* The same seeds the other way round: no pair has a common part, so as without seeds. */
  const struct sample_of_seed against[] = {{5, 1}, {9, 3}, {5, 8}, {9, 2}};
  assert_true(sample_crossed(2, (const size_t[]){0, 2, 4}, against, &c));
  assert_true(c.units == 2 && fabs(c.deviation / sqrt(4.5) - 1) < 1e-15);
  /* A third point of one run, and seeds of their own: the same. An input without effect: points as one, seeds remain.
   */
  const struct sample_of_seed own[] = {{1, 1}, {2, 3}, {3, 2}, {4, 8}, {1, 5}};
  assert_true(sample_crossed(3, (const size_t[]){0, 2, 4, 5}, own, &c));
  assert_true(c.units == 3 && fabs(c.deviation / sqrt(3) - 1) < 1e-15);
  const struct sample_of_seed idle[] = {{1, 1}, {2, 3}, {3, 8}, {1, 1}, {2, 3}, {3, 8}};
  assert_true(sample_crossed(2, (const size_t[]){0, 3, 6}, idle, &c));
  assert_true(fabs(c.units - 3) < 1e-14 && fabs(c.deviation / sqrt(13) - 1) < 1e-14);
  assert_true(sample_crossed(1, (const size_t[]){0, 2}, two, &c) && isnan(c.units));
  assert_true(sample_crossed(0, (const size_t[]){0}, two, &c) && isnan(c.units));
}

/* Points and seeds act by themselves and together: y = a_p + b_s + e_ps. Every third seed may lack every second point.
 */
static double crossed_coverage(size_t points, size_t seeds, double a, double b, double e, bool gaps, bool skew,
                               double *old) {
  enum { TRIALS = 1000, MOST = 1000 };
  struct sample_of_seed values[MOST];
  size_t first[101], held = 0, held_without = 0;
  for (uint64_t trial = 0; trial < TRIALS; trial++) {
    struct sample_moments means = {0};
    size_t n = 0;
    for (size_t p = 0; p < points; p++) {
      double sum = 0;
      first[p] = n;
      for (size_t s = 0; s < seeds; s++)
        if (!gaps || p % 2 == 0 || s % 3 > 0) {
          const double of_seed = skew ? -log(1 - random_draw(32, 1, trial, s)) - 1 : normal(2, trial, s);
          values[n] = (struct sample_of_seed){(int64_t)s, a * normal(3, trial, p) + b * of_seed +
                                                              e * normal(4, trial, p * 100 + s)};
          sum += values[n++].value;
        }
      sample_add(&means, sum / (double)(n - first[p]));
    }
    first[points] = n;
    struct sample_crossed c;
    assert_true(n <= MOST && sample_crossed(points, first, values, &c));
    const struct sample_summary alone = sample_summarise_moments(&means, 0.95);
    held += fabs(alone.mean) <= sample_student_of(c.units - 1, 0.95) * c.deviation / sqrt(c.units);
    held_without += fabs(alone.mean) <= alone.half_width;
  }
  *old = (double)held_without / TRIALS;
  return (double)held / TRIALS;
}

TEST(crossed_keeps_its_level) {
  static const struct {
    size_t points, seeds;
    double a, b, e;
    bool gaps, skew;
    double least;
  } laws[] = {
      {100, 5, 1, 0, 0.5, false, false, 0.94},    {100, 5, 1, 0.5, 0.1, false, false, 0.93},
      {100, 10, 0.1, 1, 0.3, false, false, 0.94}, {9, 3, 1, 1, 1, false, false, 0.94},
      {9, 10, 0.1, 0, 1, false, false, 0.94},     {4, 3, 1, 0.5, 0.1, false, false, 0.94},
      {9, 9, 0.3, 1, 0.5, true, false, 0.93},     {20, 6, 0.3, 0.3, 0.3, true, false, 0.93},
      {9, 10, 0.3, 1, 0.3, false, true, 0.87},    {100, 2, 1, 0.5, 0.1, false, false, 0.86},
  };
  for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
    double old;
    const double share = crossed_coverage(laws[i].points, laws[i].seeds, laws[i].a, laws[i].b, laws[i].e, laws[i].gaps,
                                          laws[i].skew, &old);
    printf("  %3zu points, %2zu seeds, scatter %.1f, %.1f, %.1f%s%s: coverage %.3f, without seeds %.3f\n",
           laws[i].points, laws[i].seeds, laws[i].a, laws[i].b, laws[i].e, laws[i].gaps ? ", gaps" : "",
           laws[i].skew ? ", skew" : "", share, old);
    assert_true(share > laws[i].least - 4 * sqrt(0.95 * 0.05 / 1000));
  }
}
