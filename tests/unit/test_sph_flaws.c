/* Explicit flaws against the Weibull law: ranked thresholds exactly, poisson by its known scatter, extremes without
 * overflow. */

#include "analysis/statistics/statistics.h"
#include "tests/support/flaw_row.h"
#include "tests/support/grady_kipp.h"

static struct sph_flaws *make(double m, double k, int draw, uint64_t seed, size_t n) {
  const struct sph_flaw_law law = {.weibull = {m, k}, .draw = draw, .seed = seed};
  return flaw_row(&law, n, 1e-5);
}

/* Number of flaws that are drawn at places; later ones were given to particles without one. */
static size_t drawn(size_t n) {
  return (size_t)ceil((double)n * (log((double)n) + 0.5772156649015329));
}

TEST(ranked_is_the_law) {
  SPH_FLAWS *flaws = make(8.5, 5e34, SPH_FLAWS_RANKED, 3, 500);
  for (size_t i = 0; i < 500; i++) {
    assert_true(flaws->first[i + 1] > flaws->first[i]); /* each particle has one */
    for (size_t f = flaws->first[i] + 1; f < flaws->first[i + 1]; f++)
      assert_true(flaws->log_strain[f] >= flaws->log_strain[f - 1]);
  }
  OWNED double *all = malloc(flaws->count * sizeof *all);
  for (size_t f = 0; f < flaws->count; f++)
    all[f] = flaws->log_strain[f];
  qsort(all, flaws->count, sizeof *all, sample_ascending);
  for (size_t j = 1; j <= drawn(500); j++) /* n(eps) V = k eps^m V = j at the j-th flaw; rounding of logs only */
    assert_true(fabs(exp(8.5 * all[j - 1] + log(5e34) + log(1e-5)) / (double)j - 1) < 1e-11);
  assert_int_equal(grady_kipp_open(flaws, 7, HUGE_VAL), flaws->first[8] - flaws->first[7]);
  assert_int_equal(grady_kipp_open(flaws, 7, -HUGE_VAL), 0);
  assert_int_equal(grady_kipp_open(flaws, 7, flaws->log_strain[flaws->first[7]]), 1);
}

/* Weakest of a Poisson draw is (E/kV)^(1/m), E a unit exponential: CV from gamma functions, 0.140 at m = 8.5, 0.077 at
 * 16, 0.363 at 3. 4000 seeds give the CV to about 1.5 %; 6 % is four times that. `ranked` has none at all. */
TEST(scatter_of_the_weakest) {
  const double ms[] = {8.5, 16, 3};
  const int seeds = 4000;
  for (int c = 0; c < 3; c++) {
    double m = ms[c], sum = 0, squares = 0;
    for (int s = 0; s < seeds; s++) {
      SPH_FLAWS *flaws = make(m, 1e30, SPH_FLAWS_POISSON, (uint64_t)s, 1);
      double x = exp(flaws->log_strain[0] - (-log(1e30) - log(1e-5)) / m);
      sum += x;
      squares += x * x;
    }
    double mean = sum / seeds, cv = sqrt(squares / seeds - mean * mean) / mean;
    double g1 = tgamma(1 + 1 / m), want = sqrt(tgamma(1 + 2 / m) / (g1 * g1) - 1);
    assert_true(fabs(want / (c == 0 ? 0.140 : c == 1 ? 0.077 : 0.363) - 1) < 0.01);
    assert_true(fabs(cv / want - 1) < 0.06);
  }
  SPH_FLAWS *a = make(8.5, 1e30, SPH_FLAWS_RANKED, 1, 1), *b = make(8.5, 1e30, SPH_FLAWS_RANKED, 2, 1);
  assert_true(a->log_strain[0] == b->log_strain[0]);
}

/* Every m from 1 to 200 and k from 1 to 1e200 that a user may type: ln eps_j = (ln j - ln k - ln V)/m to rounding,
 * against long double. */
TEST(extremes_keep_the_law) {
  const double ms[] = {1, 3, 8.5, 57, 200}, ks[] = {1, 1e10, 1e34, 1e65, 1e200};
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) {
      struct sph_flaws *poisson = make(ms[i], ks[j], SPH_FLAWS_POISSON, 1, 50),
                       *flaws = make(ms[i], ks[j], SPH_FLAWS_RANKED, 1, 50);
      for (size_t f = 0; f < poisson->count; f++)
        assert_true(isfinite(poisson->log_strain[f]));
      qsort(flaws->log_strain, flaws->count, sizeof *flaws->log_strain, sample_ascending);
      for (size_t f = 0; f < drawn(50); f++) {
        long double want = (logl((long double)(f + 1)) - logl(ks[j]) - logl(1e-5L)) / ms[i];
        assert_true(fabsl(flaws->log_strain[f] - want) < 1e-14L * (1 + logl(ks[j])));
      }
      sph_flaws_free(poisson);
      sph_flaws_free(flaws);
    }
}

/* Both draws obey n(eps) = k eps^m: flaws below eps in volume V are k V eps^m exactly (ranked) or a Poisson variable of
 * that mean and variance (poisson); and which particle a flaw goes to is uniform. 2000 seeds: a mean of M is known to
 * sqrt(M/2000), a variance to M sqrt(2/2000) and a bit for the Poisson's own kurtosis; five standard errors. The body
 * is large enough (N = 300, hence about 1900 flaws) that the draw never ends below the tested eps. */
TEST(draws_obey_the_law) {
  enum { SEEDS = 2000, N = 300 };
  const double m = 8.5, k = 1e30, want[] = {1, 7, 60, 400};
  double chi2 = 0;
  for (int e = 0; e < 4; e++) {
    double sum = 0, squares = 0, log_strain = (log(want[e]) - log(k) - log(1e-5)) / m;
    size_t in_particle[N] = {0}, all = 0;
    for (int s = 0; s < SEEDS; s++) {
      SPH_FLAWS *flaws = make(m, k, SPH_FLAWS_POISSON, (uint64_t)s, N);
      double below = 0;
      for (size_t i = 0; i < N; i++) {
        size_t active = grady_kipp_open(flaws, i, log_strain);
        below += (double)active;
        in_particle[i] += active;
        all += active;
      }
      sum += below;
      squares += below * below;
    }
    double mean = sum / SEEDS, variance = squares / SEEDS - mean * mean;
    assert_true(fabs(mean - want[e]) < 5 * sqrt(want[e] / SEEDS));
    assert_true(fabs(variance / want[e] - 1) < 5 * sqrt((2 + 1 / want[e]) / SEEDS));
    for (size_t i = 0; i < N; i++) {
      double share = (double)all / N;
      chi2 += ((double)in_particle[i] - share) * ((double)in_particle[i] - share) / share;
    }
  }
  /* four times N-1 degrees of freedom, each with mean 1 and variance 2 (the four nest, at worst adding up: s.d. 4
   * sqrt(2(N-1))) */
  assert_true(fabs(chi2 - 4 * (N - 1)) < 5 * 4 * sqrt(2.0 * (N - 1)));
  SPH_FLAWS *ranked = make(m, k, SPH_FLAWS_RANKED, 11, N);
  for (int e = 0; e < 4; e++) {
    size_t below = 0;
    for (size_t i = 0; i < N; i++)
      below += grady_kipp_open(ranked, i, (log(want[e] + 0.5) - log(k) - log(1e-5)) / m);
    assert_int_equal(below, (size_t)want[e]);
  }
}

/* Flaws per particle: one body of N = 20 000 particles holds about N (ln N + 0.577) flaws, spread at random over
 * particles but for those given to particles that got none: mean lambda and variance lambda up to 5 s.e. (of the
 * variance: lambda sqrt(2/N)), lowest 1 by construction. */
TEST(counts_per_particle) {
  const size_t n = 20000;
  SPH_FLAWS *flaws = make(8.5, 5e34, SPH_FLAWS_RANKED, 5, n);
  double lambda = (double)flaws->count / (double)n, variance = 0;
  size_t fewest = n;
  for (size_t i = 0; i < n; i++) {
    size_t own = flaws->first[i + 1] - flaws->first[i];
    variance += ((double)own - lambda) * ((double)own - lambda) / (double)n;
    fewest = own < fewest ? own : fewest;
  }
  assert_int_equal(fewest, 1);
  assert_true(fabs(variance / lambda - 1) < 5 * sqrt(2.0 / (double)n));
}
