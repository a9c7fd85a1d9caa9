/* The dip of samples with known dips, and how often chance makes a dip. */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

/* The definition, by all pairs and triples of knots. A distribution function G is within d of F at both sides of every
 * jump, convex below the mode x[last] and concave above it, where it may jump. Side -1 is the upper part, reversed. */
struct bounds {
  double x, low, high;
};

static struct bounds bounds_at(size_t n, const double *x, double d, size_t j, size_t last, int side) {
  const double number = (double)n, place = side > 0 ? x[j] : -x[n - 1 - j];
  const double before = (double)j / number, behind = (double)(j + 1) / number; /* the reversed F has the same value */
  return (struct bounds){place, (j == last ? before : behind) - d, before + d};
}

/* The smallest value that G can have at the mode, for the part on this side. HUGE_VAL: no convex function fits. */
static double least_end(size_t n, const double *x, double d, size_t last, int side) {
  const struct bounds end = bounds_at(n, x, d, last, last, side);
  double least = end.low;
  for (size_t p = 0; p < last; p++)
    for (size_t q = p + 1; q < last; q++) {
      const struct bounds a = bounds_at(n, x, d, p, last, side), b = bounds_at(n, x, d, q, last, side);
      least = fmax(least, b.low + (b.low - a.high) / (b.x - a.x) * (end.x - b.x));
      for (size_t r = q + 1; r <= last; r++) { /* b is not above the line from a to c */
        const struct bounds c = bounds_at(n, x, d, r, last, side);
        if (a.high + (c.high - a.high) / (c.x - a.x) * (b.x - a.x) < b.low - 1e-12)
          return HUGE_VAL;
      }
    }
  return least <= end.high + 1e-12 ? least : HUGE_VAL;
}

static double dip_by_definition(size_t n, const double *x) {
  double low = 0.5 / (double)n - 1e-9, high = 0.25;
  for (int i = 0; i < 30; i++) {
    const double d = (low + high) / 2;
    bool fits = false;
    for (size_t mode = 0; mode < n && !fits; mode++)
      fits = least_end(n, x, d, mode, 1) <= 1 - least_end(n, x, d, n - 1 - mode, -1) + 1e-12;
    *(fits ? &high : &low) = d;
  }
  return high;
}

TEST(known_dips) {
  double x[400];
  for (int n = 2; n <= 50; n += 6) {
    for (int i = 0; i < n; i++)
      x[i] = i;
    assert_true(fabs(scatter_dip((size_t)n, x) - 0.5 / n) < 1e-14); /* equal steps: the smallest possible dip */
  }
  for (int i = 0; i < 400; i++) /* two clusters of equal weight, far apart: 1/4 in the limit */
    x[i] = (i < 200 ? 0 : 1000) + 1e-3 * i;
  assert_true(fabs(scatter_dip(400, x) - 0.25) < 0.005);
  for (int i = 0; i < 400; i++) /* a tenth in the second: half of the lesser weight */
    x[i] = (i < 360 ? 0 : 1000) + 1e-3 * i;
  assert_true(fabs(scatter_dip(400, x) - 0.05) < 0.005);
  for (int i = 0; i < 400; i++) /* all equal: one mode */
    x[i] = 3;
  assert_true(scatter_dip(400, x) <= 0.5 / 400 + 1e-14);
  assert_true(isnan(scatter_dip(0, x)));
}

TEST(as_defined) {
  double x[24];
  for (uint64_t c = 0; c < 40; c++) {
    const size_t n = 6 + c % 14;
    for (size_t i = 0; i < n; i++)
      x[i] = random_draw(3, 3, c, i) + (c % 3 && i % 2 ? 0.7 * (double)(c % 3) : 0);
    qsort(x, n, sizeof *x, sample_ascending);
    assert_true(fabs(scatter_dip(n, x) - dip_by_definition(n, x)) < 1e-7);
  }
}

/* Samples with one mode are reported as two no more often than the level allows; two clear modes nearly always are. */
TEST(false_and_true_alarms) {
  enum { CASES = 80, N = 60 };
  int alarms[3] = {0};
  double x[N];
  for (uint64_t c = 0; c < CASES; c++)
    for (int law = 0; law < 3; law++) {
      for (uint64_t i = 0; i < N; i++) {
        const double u = random_draw(11, (uint64_t)law, c, i), v = random_draw(12, (uint64_t)law, c, i);
        const double normal = sqrt(-2 * log1p(-u)) * cos(2 * M_PI * v);
        x[i] = law == 0 ? u : law == 1 ? exp(normal) : normal + (i % 2 ? 5 : 0);
      }
      qsort(x, N, sizeof *x, sample_ascending);
      alarms[law] += scatter_dip_share(N, scatter_dip(N, x)) < 0.05;
    }
  assert_true(alarms[0] <= 4 + 4 * 2); /* uniform: 5 % of 80 are 4 +- 2 */
  assert_true(alarms[0] >= 1);
  assert_true(alarms[1] <= 4); /* skewed, one mode */
  assert_true(alarms[2] >= 76);
}

/* The limit is where the share passes 0.05, for small and for large samples. */
TEST(limits) {
  static const size_t sizes[] = {4, 20, 63, 3000};
  for (int k = 0; k < 4; k++) {
    const double limit = scatter_dip_limit(sizes[k]);
    assert_true(scatter_dip_share(sizes[k], limit * (1 + 1e-9)) < 0.05);
    assert_true(scatter_dip_share(sizes[k], limit * (1 - 1e-9)) >= 0.05);
  }
  assert_true(isnan(scatter_dip_limit(3)));
}

TEST(large_samples) {
  /* Maechler's diptest documents p = 0.087 for the 63 values of its data set statfaculty, whose dip is 0.0595. */
  assert_true(fabs(scatter_dip_share(63, 0.05952381) - 0.087) < 0.02);
  const double share = scatter_dip_share(1000, 0.5 / sqrt(1000)),
               larger = scatter_dip_share(100000, 0.5 / sqrt(100000));
  assert_true(share > 0.01 && share < 0.1 && fabs(larger - share) < 1e-12);
  assert_true(isnan(scatter_dip_share(3, 0.2)));
}
