/* The algebra of fits against closed forms: linear models with normal errors, whose posteriors are known. */
#include "analysis/inference/inference.h"
#include "tests/support/check.h"
#include "tests/support/inference_cases.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* y = 2 z0 - z1, error 0.5: precision I + [4 -2; -2 1] / 0.25, mean = covariance . (2, -1) y / 0.25. */
TEST(kalman_gives_the_posterior_of_a_linear_model) {
  enum { MEMBERS = 4000 };
  static double z[MEMBERS * 2], g[MEMBERS];
  const double y = 1.5, gamma = 0.25;
  struct ensemble_kalman e = {.members = MEMBERS, .inputs = 2, .outputs = 1, .z = z, .g = g, .y = &y, .gamma = &gamma};
  for (size_t i = 0; i < 2 * MEMBERS; i++)
    z[i] = case_normal(1, i, 0);
  for (e.seed = 1; e.tempered < 1; e.round++) {
    for (size_t j = 0; j < MEMBERS; j++)
      g[j] = 2 * z[2 * j] - z[2 * j + 1];
    OK(ensemble_kalman_step(&e, &error));
    assert_true(e.round < 10);
  }
  double mean[2] = {0}, square[2] = {0};
  for (size_t j = 0; j < MEMBERS; j++)
    for (size_t i = 0; i < 2; i++) {
      mean[i] += z[2 * j + i] / MEMBERS;
      square[i] += z[2 * j + i] * z[2 * j + i] / MEMBERS;
    }
  /* covariance = I - A^T A / (A A^T + 0.25) = I - [4 -2; -2 1] / 5.25; five standard errors of 4000 members. */
  assert_near(mean[0], 2 * y / 5.25, 5 * sqrt((1 - 4 / 5.25) / MEMBERS) + 0.02);
  assert_near(mean[1], -y / 5.25, 5 * sqrt((1 - 1 / 5.25) / MEMBERS) + 0.02);
  assert_near(square[0] - mean[0] * mean[0], 1 - 4 / 5.25, 0.03);
  assert_near(square[1] - mean[1] * mean[1], 1 - 1 / 5.25, 0.1);
}

TEST(kalman_replaces_failed_members) {
  double z[6] = {-1, 0, 1, 9, 9, 9}, g[6] = {-1, 0, 1, NAN, NAN, NAN}, y = 0, gamma = 1;
  struct ensemble_kalman e = {.members = 6, .inputs = 1, .outputs = 1, .z = z, .g = g, .y = &y, .gamma = &gamma};
  OK(ensemble_kalman_step(&e, &error));
  for (size_t j = 3; j < 6; j++)
    assert_true(fabs(z[j]) < 4);
  double far[3] = {90, 100, 110}; /* when few rounds are left, the data are taken in larger parts */
  e = (struct ensemble_kalman){.members = 3, .inputs = 1, .outputs = 1, .z = z, .g = far, .y = &y, .gamma = &gamma};
  OK(ensemble_kalman_step(&e, &error));
  assert_true(e.tempered < 0.01);
  e.least = 0.5;
  OK(ensemble_kalman_step(&e, &error));
  assert_true(e.tempered >= 0.5 && e.tempered < 0.51);
  e = (struct ensemble_kalman){.members = 6, .inputs = 1, .outputs = 1, .z = z, .g = g, .y = &y, .gamma = &gamma};
  g[1] = NAN;
  assert_int_equal(ensemble_kalman_step(&e, &error), STATUS_CONTENT);
  g[1] = 0;
  gamma = 0;
  e.tempered = 0;
  assert_int_equal(ensemble_kalman_step(&e, &error), STATUS_CONTENT);
}

/* Values at `points` places with a given scatter, `shared` of its variance from the replicate's own seed. */
enum { POINTS = 60, REPLICATES = 6 };
struct sampled {
  double x[POINTS], values[POINTS * REPLICATES];
};
static struct seed_scatter_runs sample(struct sampled *s, uint64_t seed, double slope, double shared) {
  for (size_t i = 0; i < POINTS; i++) {
    s->x[i] = -1.5 + 3 * (double)i / (POINTS - 1);
    for (size_t r = 0; r < REPLICATES; r++)
      s->values[i * REPLICATES + r] = 7 + exp(slope * s->x[i] / 2) * (sqrt(shared) * case_normal(seed, r, 1000000) +
                                                                      sqrt(1 - shared) * case_normal(seed, i, r));
  }
  return (struct seed_scatter_runs){.points = POINTS,
                                    .inputs = 1,
                                    .replicates = REPLICATES,
                                    .x = s->x,
                                    .values = s->values};
}

TEST(scatter_of_seeds_is_recovered) {
  static struct sampled s;
  struct seed_scatter fit;
  double constant = 0, slope = 0, shared = 0, apart = 0;
  enum { TIMES = 40 };
  for (uint64_t t = 0; t < TIMES; t++) {
    struct seed_scatter_runs runs = sample(&s, t, 1.2, 0.6);
    OK(seed_scatter_fit(&runs, true, &fit, &error));
    shared += fit.shared / TIMES;
    runs = sample(&s, 500 + t, 1.2, 0);
    OK(seed_scatter_fit(&runs, true, &fit, &error));
    apart += fit.shared / TIMES;
    constant += fit.constant / TIMES;
    slope += fit.slope[0] / TIMES;
    assert_int_equal(fit.freedom, POINTS * (REPLICATES - 1));
  }
  /* ln(s^2) of five degrees of freedom scatters by 0.7; 60 points, 40 times: 0.015 in the constant, 0.016 in the slope,
   * which its prior of width 1 makes 1 % smaller. */
  assert_near(constant, 0, 0.06);
  assert_near(slope, 1.2, 0.06);
  assert_near(shared, 0.6, 0.1);
  assert_true(apart < 0.03);
}

/* Three counts of a point, 1 or 2, are equal in four of ten points or more. Their variance is p (1 - p).
 * The worst of the 120 variances is off by a factor of 1.5; a line through the logarithms is off by 236. */
TEST(equal_counts_are_no_certainty) {
  static struct sampled s;
  struct seed_scatter fit;
  double most = 0;
  enum { THREE = 3, TIMES = 40 };
  for (uint64_t t = 0; t < TIMES; t++) {
    for (size_t i = 0; i < POINTS; i++) {
      s.x[i] = -1.5 + 3 * (double)i / (POINTS - 1);
      for (size_t r = 0; r < THREE; r++)
        s.values[i * THREE + r] = 1 + (case_normal(40 + t, i, r) > 0.5 - 0.4 * s.x[i]);
    }
    const struct seed_scatter_runs runs = {.points = POINTS,
                                           .inputs = 1,
                                           .replicates = THREE,
                                           .x = s.x,
                                           .values = s.values};
    OK(seed_scatter_fit(&runs, true, &fit, &error));
    for (int k = -1; k <= 1; k++) {
      const double x = k, p = 0.5 * erfc((0.5 - 0.4 * x) / sqrt(2)), variance = seed_scatter_variance(&fit, &x);
      most = fmax(most, fabs(log(variance / (p * (1 - p)))));
    }
  }
  assert_true(most < log(2.5));
}

/* Where nothing breaks, all runs are equal: here beyond `whole`. Elsewhere the standard deviation is 1. A line cannot
 * show both, but it must not be drawn to 0 where the runs scatter, nor rise without end on their far side. */
TEST(equal_runs_do_not_hide_the_scatter_of_others) {
  static struct sampled s;
  struct seed_scatter fit;
  const double there = -0.5, end = -1.5;
  enum { THREE = 3, TIMES = 40 };
  for (uint64_t t = 0; t < TIMES; t++) {
    const double whole = (const double[]){0.5, 0, -0.6}[t % 3];
    for (size_t i = 0; i < POINTS; i++) {
      s.x[i] = -1.5 + 3 * (double)i / (POINTS - 1);
      for (size_t r = 0; r < THREE; r++)
        s.values[i * THREE + r] = 7 + (s.x[i] < whole ? case_normal(80 + t, i, r) : 0);
    }
    const struct seed_scatter_runs runs = {.points = POINTS,
                                           .inputs = 1,
                                           .replicates = THREE,
                                           .x = s.x,
                                           .values = s.values};
    OK(seed_scatter_fit(&runs, true, &fit, &error));
    const double variance = seed_scatter_variance(&fit, &there);
    assert_true(whole <= 0 || (variance > 0.4 && variance < 2.5)); /* 80 degrees of freedom know it to 30 % */
    assert_true(seed_scatter_variance(&fit, &end) > 0.4 && seed_scatter_variance(&fit, &end) < 16);
  }
}

TEST(scatter_knows_two_heaps_and_too_few_runs) {
  static struct sampled s;
  struct seed_scatter fit;
  struct seed_scatter_runs runs = sample(&s, 3, 0, 0);
  OK(seed_scatter_fit(&runs, true, &fit, &error));
  assert_near(fit.excess, 0, 0.7); /* of a normal law, with 360 values +- 0.26 */
  for (size_t i = 0; i < POINTS * REPLICATES; i++)
    s.values[i] = i % 2 ? 0.3 : 0.5;
  OK(seed_scatter_fit(&runs, true, &fit, &error));
  assert_near(fit.excess, -2, 0.01);
  for (size_t i = 0; i < POINTS * REPLICATES; i++)
    s.values[i] = i % REPLICATES ? (double)NAN : 1;
  assert_int_equal(seed_scatter_fit(&runs, true, &fit, &error), STATUS_CONTENT);
  for (size_t i = 0; i < POINTS * REPLICATES; i++)
    s.values[i] = 1;
  OK(seed_scatter_fit(&runs, true, &fit, &error));
  assert_true(seed_scatter_variance(&fit, s.x) < 1e-200); /* no seed moves it */
}

static struct kriging *surface_of(size_t n, const double *x, const double *y, double own, double shared) {
  struct kriging *k = NULL;
  OWNED double *noise = calloc(n * n, sizeof *noise);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      noise[i * n + j] = shared + (i == j ? own : 0);
  const struct kriging_data data = {.points = n, .inputs = 1, .x = x, .mean = y, .noise = noise};
  OK(kriging_fit(&data, &k, &error));
  return k;
}

TEST(kriging_passes_through_a_smooth_function) {
  enum { N = 15 };
  double x[N], y[N], variance;
  for (size_t i = 0; i < N; i++) {
    x[i] = -2 + 4 * (double)i / (N - 1);
    y[i] = 3 + sin(2 * x[i]);
  }
  struct kriging *k = surface_of(N, x, y, 0, 0);
  double worst = 0, ratio = 0;
  for (double at = -1.9; at < 2; at += 0.137) {
    const double off = kriging_predict(k, &at, &variance) - 3 - sin(2 * at);
    worst = fmax(worst, fabs(off));
    ratio = fmax(ratio, fabs(off) / sqrt(variance));
  }
  assert_true(worst < 0.01);
  assert_true(ratio < 3);
  kriging_predict(k, &(double){6}, &variance);
  assert_true(variance > 1); /* far from all points the surface is uncertain */
  kriging_free(k);
}

/* The mean of N noisy values of a constant: its variance is own/N + shared. */
TEST(kriging_knows_what_seeds_leave) {
  enum { N = 40 };
  double x[N], y[N], alone, together, errors[N], squares = 0;
  for (size_t i = 0; i < N; i++) {
    x[i] = -1.7 + 3.4 * (double)i / (N - 1);
    y[i] = 5 + 0.3 * case_normal(8, i, 0);
  }
  struct kriging *k = surface_of(N, x, y, 0.09, 0);
  assert_near(kriging_predict(k, &(double){0}, &alone), 5, 0.2);
  kriging_left_out(k, errors);
  for (size_t i = 0; i < N; i++)
    squares += errors[i] * errors[i] / N;
  assert_near(sqrt(squares), 1, 0.3);
  kriging_free(k);
  assert_true(alone > 0.09 / N && alone < 0.09 / 4);
  k = surface_of(N, x, y, 0.09, 0.04); /* a shift of all points by one seed cannot be seen in them */
  kriging_predict(k, &(double){0}, &together);
  assert_near(together - alone, 0.04, 0.01);
  kriging_free(k);
}

/* Values so noisy that they tell nothing leave the priors: the middle of the values everywhere, with the variance 1 of
 * the process and 10 (1 + x^2) of the trend, in variances of the values; the error of a point over its noise. */
TEST(kriging_of_noise_keeps_its_priors) {
  const double x[3] = {-1, 0, 1}, y[3] = {1, 3, 8}, noise = 1e10, scale = sqrt(13); /* of 1, 3, 8 about 4 */
  double variance, errors[3];
  struct kriging *k = surface_of(3, x, y, noise, 0);
  for (double at = 0; at < 4; at += 1.5) {
    assert_near(kriging_predict(k, &at, &variance), 4, 1e-6);
    assert_near(variance / (scale * scale), 11 + 10 * at * at, 0.03); /* the search ends 2 % from the prior's mode */
  }
  kriging_left_out(k, errors);
  for (int i = 0; i < 3; i++)
    assert_near(errors[i] * sqrt(noise), y[i] - 4, 1e-6);
  kriging_free(k);
}

/* Surfaces of y = a0 z0 + a1 z1, exact, and a scatter of 0.3. */
static double linear(const double *u, size_t k, uint64_t seed) {
  const double a[2][2] = {{2, -1}, {1, 1}};
  return a[k][0] * gsl_cdf_ugaussian_Pinv(u[0]) + a[k][1] * gsl_cdf_ugaussian_Pinv(u[1]) +
         0.3 * case_normal(seed, (uint64_t)(u[0] * 0x1p52), 2 * (uint64_t)(u[1] * 0x1p52) + k);
}

TEST(posterior_is_that_of_a_linear_model) {
  static struct case_fit fit;
  const bool bounded[2] = {false, false};
  fit = (struct case_fit){.inputs = 2, .outputs = 2};
  const struct posterior_datum data[2] = {{.value = 1.5, .error = 0.4, .specimens = 1, .shot = 0},
                                          {.value = 0.5, .resolution = 0.4, .specimens = 1, .shot = 1}};
  OK(case_solve(&fit, linear, data, bounded, 1, &error));
  assert_false(fit.posterior.sampled);
  /* Both errors are 0.5 with the scatter. Precision I + 4 [2 -1; 1 1]^T [2 -1; 1 1] = [21 -4; -4 9]. */
  const double det = 21 * 9 - 16, right[2] = {4 * (2 * 1.5 + 0.5), 4 * (-1.5 + 0.5)};
  const double exact[2] = {(9 * right[0] + 4 * right[1]) / det, (4 * right[0] + 21 * right[1]) / det};
  double mean[2], c[4];
  posterior_moments(&fit.posterior, mean, c);
  assert_near(mean[0], exact[0], 0.1); /* the scatter is estimated, the surface has an error of its own */
  assert_near(mean[1], exact[1], 0.1);
  assert_near(sqrt(c[0]), sqrt(9 / det), 0.04);
  assert_near(sqrt(c[3]), sqrt(21 / det), 0.05);
  assert_near(posterior_quantile(&fit.posterior, 0, 0.95), mean[0] + 1.645 * sqrt(c[0]), 0.03);
  assert_near(posterior_quantile(&fit.posterior, 0, 0.05), mean[0] - 1.645 * sqrt(c[0]), 0.03);

  struct identify found;
  identify_find(&fit.surfaces.model, &fit.posterior, &found);
  assert_int_equal(found.determined, 2);
  assert_near(found.direction[0].information, 4 * (3.5 + sqrt(1.5 * 1.5 + 1)), 6); /* eigenvalues of [20 -4; -4 8] */

  /* The predicted spread of one more experiment: scatter and errors, plus the uncertainty of the inputs. */
  const double spread = 2 * 2 * c[0] - 2 * 2 * c[1] + c[3] + 0.25;
  assert_near(posterior_predicted(&fit.surfaces.model, &fit.posterior, 0, 0.95) -
                  posterior_predicted(&fit.surfaces.model, &fit.posterior, 0, 0.5),
              1.645 * sqrt(spread), 0.15);
  case_clear(&fit);
}

/* Data that a ridge far narrower than a grid's cell explains, and that a second place far from it misses by six
 * standard deviations or more: a sample of the posterior has nothing there, whichever way its walkers begin. d = (z0 -
 * z1) / 2 is 1 on the ridge and -1 at the other place. */
TEST(a_sample_leaves_a_lower_maximum) {
  enum { SIDE = 11, N = SIDE * SIDE };
  static double x[2 * N], y[2][N], noise[N * N];
  for (size_t i = 0; i < N; i++) {
    const double a = -2.4 + 4.8 * (double)(i % SIDE) / (SIDE - 1), b = -2.4 + 4.8 * (double)(i / SIDE) / (SIDE - 1);
    const double d = (a - b) / 2;
    x[2 * i] = a;
    x[2 * i + 1] = b;
    y[0][i] = a + b;
    y[1][i] = (d * d - 1) * (d * d - 1) + 0.3 * (1 - d);
    noise[i * N + i] = 1e-8;
  }
  const struct seed_scatter none = {.inputs = 2, .constant = -700};
  struct posterior_datum data[2] = {{.value = 0, .error = 0.001, .specimens = 1, .scatter = &none},
                                    {.value = 0, .error = 0.06, .specimens = 1, .shot = 1, .scatter = &none}};
  for (int k = 0; k < 2; k++) {
    const struct kriging_data points = {.points = N, .inputs = 2, .x = x, .mean = y[k], .noise = noise};
    OK(kriging_fit(&points, &data[k].surface, &error));
  }
  const double correlation[4] = {1, 0, 0, 1};
  const struct posterior_model model = {.inputs = 2, .outputs = 2, .data = data, .correlation = correlation};
  for (uint64_t seed = 1; seed <= 5; seed++) {
    OWNED_BY(posterior_clear) struct posterior sample;
    OK(posterior_make(&model, seed, &sample, &error));
    assert_true(sample.sampled);
    double mean = 0, square = 0;
    for (size_t n = 0; n < sample.count; n++) {
      const double d = (sample.z[2 * n] - sample.z[2 * n + 1]) / 2;
      assert_true(d > 0);
      mean += sample.weight[n] * d;
      square += sample.weight[n] * d * d;
    }
    assert_near(mean, 1, 0.1);                      /* its own width is 0.1 */
    assert_true(sqrt(square - mean * mean) > 0.02); /* of the order of sqrt(0.06) / 2 */
  }
  for (int k = 0; k < 2; k++)
    kriging_free(data[k].surface);
}

/* Statistics of four nodes by hand, of either input. */
TEST(statistics_of_weighted_nodes) {
  double z[] = {0, 3, 10, -1, 20, 1, 30, -1}, weight[] = {0.1, 0.2, 0.4, 0.3}, mean[2], c[4];
  const struct posterior nodes = {.count = 4, .inputs = 2, .z = z, .weight = weight};
  static const struct {
    size_t input;
    double share, z;
  } cases[] = {
      {0, 0.01, 0},  {0, 0.05, 0},  {0, 0.35, 15}, {0, 0.85, 30}, {0, 0.99, 30}, /* middles at 0.05, 0.2, 0.5, 0.85 */
      {1, 0.25, -1}, {1, 0.475, 0}, {1, 0.7, 1},   {1, 0.825, 2}, {1, 0.99, 3},  /* two of the nodes are at -1 */
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    assert_near(posterior_quantile(&nodes, cases[i].input, cases[i].share), cases[i].z, 1e-12);
  posterior_moments(&nodes, mean, c);
  assert_near(mean[0], 19, 1e-12);
  assert_near(mean[1], 0.2, 1e-12);
  const double expected[4] = {89, -6.8, -6.8, 1.76};
  for (int i = 0; i < 4; i++)
    assert_near(c[i], expected[i], 1e-12);
  for (int i = 0; i < 4; i++) /* shares below 0.1, 0.3, 0.7, 1 */
    assert_int_equal(posterior_node(&nodes, (const double[]){0.05, 0.25, 0.65, 0.95}[i]), i);
  assert_int_equal(posterior_node(&nodes, 1), 3);
}

/* A surface through exact values of slope[0] z0 + slope[1] z1 + slope[2] z2 on a grid. */
static struct kriging *plane_of(const double slope[3]) {
  enum { N = 27 };
  double x[3 * N], y[N];
  static double noise[N * N];
  for (size_t n = 0; n < N; n++) {
    y[n] = 0;
    for (size_t i = 0, rest = n; i < 3; i++, rest /= 3) {
      x[3 * n + i] = 2 * (double)(rest % 3) - 2;
      y[n] += slope[i] * x[3 * n + i];
    }
  }
  struct kriging *k = NULL;
  const struct kriging_data data = {.points = N, .inputs = 3, .x = x, .mean = y, .noise = noise};
  OK(kriging_fit(&data, &k, &error));
  return k;
}

/* 3 z0 + 4 z1 known within 0.5, s z2 within 1: information 100 along (3, 4, 0)/5, s^2 along z2, none along (4, -3,
 * 0)/5. With both values 0 the posterior is normal about 0, of variance 1/(1 + information) along each. */
TEST(directions_of_a_linear_model) {
  static const double slopes[2] = {2, 0.8}; /* more information than the prior's 1, and less */
  for (int c = 0; c < 2; c++) {
    const double s = slopes[c];
    const struct seed_scatter none = {.constant = -100, .inputs = 3};
    const struct posterior_datum data[2] =
        {{.error = 0.5, .specimens = 1, .shot = 0, .surface = plane_of((const double[]){3, 4, 0}), .scatter = &none},
         {.error = 1, .specimens = 1, .shot = 1, .surface = plane_of((const double[]){0, 0, s}), .scatter = &none}};
    const double correlation[4] = {1, 0, 0, 1};
    const struct posterior_model model = {.inputs = 3, .outputs = 2, .data = data, .correlation = correlation};
    struct posterior posterior;
    struct identify found;
    OK(posterior_make(&model, 1, &posterior, &error));
    identify_find(&model, &posterior, &found);
    const double information[3] = {100, s * s, 0}, along[3][3] = {{0.6, 0.8, 0}, {0, 0, 1}, {0.8, -0.6, 0}};
    assert_int_equal(found.inputs, 3);
    assert_int_equal(found.determined, s > 1 ? 2 : 1);
    assert_near(found.widest, 1, 0.03); /* along (4, -3, 0)/5 */
    for (int d = 0; d < 3; d++) {
      /* the surfaces are exact to their jitter of 1e-6 of a variance of about 70 */
      assert_near(found.direction[d].information, information[d], 0.01 * information[d] + 1e-3);
      /* the grid has 22 nodes per input over some 7 deviations */
      assert_near(found.direction[d].deviation, 1 / sqrt(1 + information[d]), 0.03);
      for (int i = 0; i < 3; i++) {
        assert_near(found.direction[d].along[i], along[d][i], 1e-3);
        assert_int_equal(identify_mixed(&found, (size_t)d, (size_t)i), fabs(along[d][i]) > 0);
      }
      assert_near(found.centre[d], 0, 0.01);
    }
    /* The 90 % interval of z2 has the share 2 Phi(1.645 sd) - 1 of the prior, that of the prior itself 0.9. */
    const double half = gsl_cdf_ugaussian_Pinv(0.95) / sqrt(1 + s * s);
    assert_near(found.kept[2], (2 * gsl_cdf_ugaussian_P(half) - 1) / 0.9, 0.02);
    posterior_clear(&posterior);
    kriging_free(data[0].surface);
    kriging_free(data[1].surface);
  }
  struct identify parts = {.inputs = 3, .direction[1].along = {0.25, -0.24, -0.26}};
  assert_true(identify_mixed(&parts, 1, 0) && !identify_mixed(&parts, 1, 1) && identify_mixed(&parts, 1, 2));
}

/* y = z^2, known within 0.5, at 64 nodes: information (2 z)^2 / 0.25, whose median is that of the two in the middle. */
TEST(information_is_a_median_over_nodes) {
  enum { POINTS_OF_CURVE = 9, MIDDLE = 64 / 2 };
  double x[POINTS_OF_CURVE], y[POINTS_OF_CURVE], z[64], weight[64];
  for (size_t i = 0; i < POINTS_OF_CURVE; i++) {
    x[i] = 0.5 * (double)i - 2;
    y[i] = x[i] * x[i];
  }
  for (size_t n = 0; n < 64; n++) {
    z[n] = 0.2 + 0.02 * (double)(37 * n % 64); /* every rank once, in no order */
    weight[n] = 1 / 64.0;
  }
  const struct seed_scatter none = {.constant = -100, .inputs = 1};
  const struct posterior_datum data = {.error = 0.5,
                                       .specimens = 1,
                                       .surface = surface_of(POINTS_OF_CURVE, x, y, 0, 0),
                                       .scatter = &none};
  const struct posterior_model model = {.inputs = 1, .outputs = 1, .data = &data, .correlation = &(double){1}};
  const struct posterior posterior = {.count = 64, .inputs = 1, .z = z, .weight = weight};
  struct identify found;
  identify_find(&model, &posterior, &found);
  const double low = 2 * (0.2 + 0.02 * (MIDDLE - 1)), high = 2 * (0.2 + 0.02 * MIDDLE);
  const double expected = (low * low + high * high) / 2 / 0.25;
  /* The next rank is 5 % away, so half of it 2.4 %. */
  assert_near(found.direction[0].information, expected, 0.005 * expected);
  kriging_free(data.surface);
}

/* A product and a sum: only u0 + u1 is determined, or only a ring. */
static double sum_only(const double *u, size_t k, uint64_t seed) {
  (void)k;
  return u[0] + u[1] + 0.02 * case_normal(seed, (uint64_t)(u[0] * 0x1p52), (uint64_t)(u[1] * 0x1p52));
}
static double ring(const double *u, size_t k, uint64_t seed) {
  (void)k;
  return (u[0] - 0.5) * (u[0] - 0.5) + (u[1] - 0.5) * (u[1] - 0.5) +
         0.004 * case_normal(seed, (uint64_t)(u[0] * 0x1p52), (uint64_t)(u[1] * 0x1p52));
}

TEST(ridges_are_seen) {
  static struct case_fit fit;
  struct identify found;
  const bool bounded[2] = {true, true};
  const struct posterior_datum sum = {.value = 1.1, .error = 0.02, .specimens = 1};
  fit = (struct case_fit){.inputs = 2, .outputs = 1};
  OK(case_solve(&fit, sum_only, &sum, bounded, 2, &error));
  identify_find(&fit.surfaces.model, &fit.posterior, &found);
  assert_int_equal(found.determined, 1);
  assert_true(found.direction[0].information > 20 && found.direction[1].information < 0.5);
  assert_true(identify_mixed(&found, 1, 0) && identify_mixed(&found, 1, 1));
  assert_true(found.direction[1].along[0] * found.direction[1].along[1] < 0); /* one rises, the other falls */
  assert_true(found.kept[0] > 0.6 && found.kept[1] > 0.6);
  assert_true(found.direction[0].deviation < 0.3);
  case_clear(&fit);

  const struct posterior_datum radius = {.value = 0.1, .error = 0.004, .specimens = 1};
  fit = (struct case_fit){.inputs = 2, .outputs = 1};
  OK(case_solve(&fit, ring, &radius, bounded, 3, &error));
  identify_find(&fit.surfaces.model, &fit.posterior, &found);
  /* on the ring one direction is known everywhere, and it differs from point to point */
  assert_int_equal(found.determined, 1);
  case_clear(&fit);
}

/* Slopes 3 and 1; where `wiggle` is not 0, also a short steep part in the middle of the ridge. */
static double wiggle;
static double steep_and_flat(const double *u, size_t k, uint64_t seed) {
  (void)k;
  const double z0 = gsl_cdf_ugaussian_Pinv(u[0]), z1 = gsl_cdf_ugaussian_Pinv(u[1]), s = 0.35;
  return 3 * z0 + z1 + wiggle * z1 * exp(-z1 * z1 / (2 * s * s)) +
         0.1 * case_normal(seed, (uint64_t)(u[0] * 0x1p52), (uint64_t)(u[1] * 0x1p52));
}

/* Along a ridge of 3 z0 + z1 the inputs change as -1 to 3, even if its middle is steeper. */
TEST(ridges_follow_unequal_slopes) {
  static struct case_fit fit;
  struct identify found;
  const bool bounded[2] = {false, false};
  const struct posterior_datum sum = {.value = 0, .error = 0.1, .specimens = 1};
  for (wiggle = 0; wiggle < 4; wiggle += 3) {
    fit = (struct case_fit){.inputs = 2, .outputs = 1};
    OK(case_solve(&fit, steep_and_flat, &sum, bounded, 6, &error));
    identify_find(&fit.surfaces.model, &fit.posterior, &found);
    const double *along = found.direction[1].along, off = wiggle > 0 ? 0.2 : 0.02; /* the middle alone: -0.8, 0.6 */
    assert_int_equal(found.determined, 1);
    assert_near(along[0], -1 / sqrt(10), off);
    assert_near(along[1], 3 / sqrt(10), off);
    assert_near(found.direction[1].deviation, 1, 0.1); /* that of the prior: the data do not determine this direction */
    case_clear(&fit);
  }
}

static double five(const double *u, size_t k, uint64_t seed) {
  double sum = 0;
  for (size_t i = 0; i < 5; i++)
    sum += (i == k ? 2 : 0.2) * gsl_cdf_ugaussian_Pinv(u[i]);
  return sum + 0.2 * case_normal(seed, (uint64_t)(u[0] * 0x1p52), 8 * (uint64_t)(u[1] * 0x1p52) + k);
}

TEST(five_inputs_are_sampled) {
  static struct case_fit fit;
  struct posterior_datum data[5];
  const bool bounded[5] = {false};
  for (size_t k = 0; k < 5; k++)
    data[k] = (struct posterior_datum){.value = 1, .error = 0.3, .specimens = 1, .shot = k};
  fit = (struct case_fit){.inputs = 5, .outputs = 5};
  OK(case_solve(&fit, five, data, bounded, 4, &error));
  assert_true(fit.posterior.sampled);
  double mean[5], c[25];
  posterior_moments(&fit.posterior, mean, c);
  for (size_t i = 0; i < 5; i++) {
    /* By symmetry all are equal: (1 + s) z = A^T y / 0.13 with s the eigenvalue 2.8^2 / 0.13 of the sum. */
    assert_near(mean[i], 2.8 / 0.13 / (1 + 2.8 * 2.8 / 0.13), 0.1);
    assert_near(sqrt(c[i * 6]), 0.195, 0.05); /* 1 + 1.8^2 / 0.13 four times, 1 + 2.8^2 / 0.13 once */
  }
  case_clear(&fit);
}

/* Of two outputs with three points. One run of the second point has no first output, and the third point has too few
 * runs. Deviations: first output -1, 0, 1 and -1, 1; second one -2, 0, 2 and -1, 0. So 5 / sqrt(4 x 9). */
TEST(correlation_of_two_outputs) {
  const double first[9] = {1, 2, 3, 10, 12, NAN, 100, NAN, NAN}, second[9] = {2, 4, 6, 5, 6, 7, 1, 2, 3};
  const struct seed_scatter_runs a = {.points = 3, .replicates = 3, .values = first};
  const struct seed_scatter_runs b = {.points = 3, .replicates = 3, .values = second};
  assert_true(fabs(seed_scatter_correlation(&a, &b) - 5.0 / 6) < 1e-15);
  assert_true(seed_scatter_correlation(&a, &b) == seed_scatter_correlation(&b, &a));
  const double constant[9] = {0};
  const struct seed_scatter_runs none = {.points = 3, .replicates = 3, .values = constant};
  assert_true(seed_scatter_correlation(&a, &none) == 0);
}

/* Three points with two runs each: the runs of the first output lie at -1 and 1 about the mean (variance 2), those of
 * the second at -2 and 2 (variance 8), and the seeds act alike (0.98 in place of a correlation of 1). */
TEST(errors_of_data_by_hand) {
  const double z[3] = {-1, 0, 1}, values[12] = {4, 6, 1, 3, 7, 9, 0, 4, 1, 5, 8, 12};
  const struct surfaces_runs runs = {.points = 3, .inputs = 1, .outputs = 2, .replicates = 2, .z = z, .values = values};
  const bool bounded[1] = {false};
  for (size_t shot = 0; shot < 2; shot++) {
    const struct posterior_datum data[2] = {{.error = 3, .resolution = 4, .specimens = 1},
                                            {.error = 1, .resolution = 0, .specimens = 4, .shot = shot}};
    double gamma[4];
    OK(surfaces_errors(&runs, data, bounded, 3, gamma, &error));
    assert_near(gamma[0], 2 + 9 + 16, 1e-9);
    assert_near(gamma[3], 8.0 / 4 + 1, 1e-9);
    assert_near(gamma[1], shot == 0 ? 0.98 * sqrt(2) * sqrt(8.0 / 4) : 0, 1e-9);
    assert_true(gamma[1] == gamma[2]);
  }
}

/* A point with one run takes no part: the surface is that of the others. */
TEST(points_of_one_run_are_left_out) {
  enum { ALL = 5 };
  double z[ALL] = {-1, -0.5, 0.5, 1, 0}, values[2 * ALL];
  const struct posterior_datum data = {.value = 1, .error = 1, .specimens = 1};
  const bool bounded = false;
  double at[2];
  for (int i = 0; i < ALL; i++)
    values[2 * i] = 2 * z[i] + 0.1, values[2 * i + 1] = 2 * z[i] - 0.1;
  for (int with = 0; with < 2; with++) {
    values[2 * (ALL - 1)] = 100, values[2 * (ALL - 1) + 1] = NAN;
    const struct surfaces_runs runs =
        {.points = with ? ALL : ALL - 1, .inputs = 1, .outputs = 1, .replicates = 2, .z = z, .values = values};
    OWNED_BY(surfaces_clear) struct surfaces surfaces;
    OK(surfaces_fit(&runs, &data, &bounded, &surfaces, &error));
    assert_int_equal(surfaces.used[0], ALL - 1);
    at[with] = kriging_predict(surfaces.surface[0], &(double){0.25}, NULL);
  }
  assert_true(at[0] == at[1]);
}
