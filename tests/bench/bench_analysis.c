/* Cost of the estimates that every run computes, and of a pooled exponent with its interval. Prints `name value unit`.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "analysis/analysis.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* One point of 200 runs with 80 fragments each: the methods of points, with their intervals. */
static int pooled(void) {
  enum { RUNS = 200, EACH = 80 };
  static double masses[RUNS * EACH];
  size_t first[RUNS + 1];
  for (size_t r = 0; r <= RUNS; r++)
    first[r] = r * EACH;
  for (size_t i = 0; i < RUNS * EACH; i++)
    masses[i] = 1 / (1 - random_draw(2, 2, i, 0));
  for (size_t r = 0; r < RUNS; r++)
    qsort(masses + first[r], EACH, sizeof *masses, sample_descending);
  struct pooled_runs runs = {RUNS, first, masses};
  for (int method = EXPONENT_LEAST_SQUARES; method <= EXPONENT_MASSES; method++) {
    struct pooled_exponent out;
    double start = seconds();
    if (pooled_exponent(&runs, (enum exponent_method)method, 1, 0.95, &out, NULL))
      return 70;
    printf("analysis_pooled_%s_200_runs_ms %.1f ms\n", exponent_method_names[method], 1e3 * (seconds() - start));
  }
  runs.count = 13; /* about 1000 fragments: the limit is 2 s on one core */
  struct pooled_goodness goodness;
  const double start = seconds();
  if (pooled_goodness(&runs, 1, 2500, &goodness, NULL))
    return 70;
  printf("analysis_goodness_%zu_fragments_cpu_s %.2f s\nanalysis_goodness_draws %zu 1\n", goodness.n, seconds() - start,
         goodness.draws);
  return 0;
}

int main(void) {
  enum { N = 500 };
  analysis_init();
  struct fragment fragments[N] = {0};
  double masses[N];
  for (uint32_t i = 0; i < N; i++) { /* about 500 fragments, a power law of grains, descending */
    double rank = (i + 0.5) / N;
    fragments[i].count = (uint32_t)(1 / rank);
    fragments[i].mass = fragments[i].count * (0.8 + 0.4 * random_draw(1, 1, i, 0));
    masses[i] = fragments[i].mass;
  }
  struct estimate rows[ESTIMATES_COUNT];
  double best = HUGE_VAL;
  for (int repeat = 0; repeat < 50; repeat++) {
    double start = seconds();
    if (estimates_make(N, fragments, 0, rows, NULL))
      return 70;
    best = fmin(best, seconds() - start);
  }
  printf("analysis_estimates_500_ms %.3f ms\n", 1e3 * best);
  for (int method = 0; method < EXPONENT_METHODS; method++) {
    best = HUGE_VAL;
    for (int repeat = 0; repeat < 50; repeat++) {
      struct exponent fit;
      double start = seconds();
      if (exponent_fit((enum exponent_method)method, N, masses, (struct exponent_window){0.8, HUGE_VAL}, &fit, NULL))
        return 70;
      best = fmin(best, seconds() - start);
    }
    printf("analysis_%s_500_ms %.4f ms\n", exponent_method_names[method], 1e3 * best);
  }
  return pooled();
}
