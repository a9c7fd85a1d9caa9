/* Whole fits of three made-up models, pinned in inference.txt (tests/support/pinned.h): with bounds and without, with
 * specimens, errors and shots, on a grid and sampled. test_inference judges what the numbers mean; this test says that
 * they stay. */
#include "analysis/inference/inference.h"
#include "tests/support/inference_cases.h"
#include "tests/support/pinned.h"

static FILE *out;

static void say(const char *name, size_t count, const double *numbers) {
  fputs(name, out);
  for (size_t k = 0; k < count; k++)
    fprintf(out, " %.9g", fabs(numbers[k]) < 1e-12 ? 0 : numbers[k]); /* rounding */
  fputc('\n', out);
}
#define SAY(name, ...) say(name, sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]){__VA_ARGS__})

static double curved(const double *u, size_t k, uint64_t seed) {
  const double scatter = (0.02 + 0.05 * u[0]) * (case_normal(seed, 1, 0) + 0.4 * case_normal(seed, 2, k));
  return (k == 0 ? u[0] * u[0] + 0.5 * u[1] : k == 1 ? exp(-2 * u[1]) + 0.3 * u[0] : u[0] * u[1]) + scatter;
}

static double ridge(const double *u, size_t k, uint64_t seed) {
  return (k == 0 ? u[0] + u[1] : 2 * u[2]) + 0.05 * case_normal(seed, 3, k);
}

static double many(const double *u, size_t k, uint64_t seed) {
  return u[k] + 0.3 * u[4] * (double)k + 0.04 * case_normal(seed, 4, k);
}

static void fit(const char *name, case_model model, size_t inputs, size_t outputs, const struct posterior_datum *data,
                const bool *bounded, uint64_t seed) {
  static struct case_fit fit;
  fit = (struct case_fit){.inputs = inputs, .outputs = outputs};
  OK(case_solve(&fit, model, data, bounded, seed, &error));
  fprintf(out, "== %s\n", name);
  SAY("size", (double)fit.rounds, (double)fit.points, (double)fit.posterior.count, fit.posterior.sampled);
  for (size_t k = 0; k < outputs; k++) {
    const struct seed_scatter *s = &fit.surfaces.scatter[k];
    SAY("scatter", s->constant, s->slope[0], s->slope[1], s->shared, s->skewness, s->excess, (double)s->freedom);
    SAY("surface", fit.surfaces.left_out[k], (double)fit.surfaces.used[k]);
    say("correlation", outputs, &fit.surfaces.correlation[k * outputs]);
    for (double p = 0.05; p < 1; p += 0.9)
      SAY("predicted", p, posterior_predicted(&fit.surfaces.model, &fit.posterior, k, p));
    SAY("below", posterior_below(&fit.surfaces.model, &fit.posterior, k, fit.surfaces.model.data[k].value));
  }
  double mean[INFERENCE_INPUTS], covariance[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  posterior_moments(&fit.posterior, mean, covariance);
  say("mean", inputs, mean), say("covariance", inputs * inputs, covariance);
  for (size_t i = 0; i < inputs; i++)
    SAY("input", posterior_quantile(&fit.posterior, i, 0.05), posterior_quantile(&fit.posterior, i, 0.5),
        posterior_quantile(&fit.posterior, i, 0.95));
  SAY("node", (double)posterior_node(&fit.posterior, 0), (double)posterior_node(&fit.posterior, 0.4),
      (double)posterior_node(&fit.posterior, 1));
  for (double z = -1; z < 2; z += 1.6) {
    const double at[INFERENCE_INPUTS] = {z, 0.3, -z, 0.1, z};
    double x[INFERENCE_INPUTS], expected[INFERENCE_OUTPUTS];
    posterior_place(&fit.surfaces.model, at, x);
    posterior_expect(&fit.surfaces.model, at, expected, covariance);
    say("place", inputs, x), say("expected", outputs, expected), say("about", outputs * outputs, covariance);
    SAY("share", posterior_share(z), posterior_coordinate(posterior_share(z)));
  }
  struct identify found;
  identify_find(&fit.surfaces.model, &fit.posterior, &found);
  SAY("determined", (double)found.determined);
  say("centre", inputs, found.centre), say("kept", inputs, found.kept);
  for (size_t d = 0; d < inputs; d++) {
    const struct identify_direction *direction = &found.direction[d];
    say("along", inputs, direction->along);
    SAY("knows", direction->information, direction->deviation, identify_mixed(&found, d, 0),
        identify_mixed(&found, d, 1));
  }
  case_clear(&fit);
}

TEST(fits_stay) {
  static const bool bounded[INFERENCE_INPUTS] = {true, false, true}, loose[INFERENCE_INPUTS] = {false};
  OWNED char *text = NULL;
  size_t size = 0;
  assert_non_null(out = open_memstream(&text, &size));
  const struct posterior_datum three[] = {{.value = 0.6, .error = 0.01, .specimens = 1, .shot = 0},
                                          {.value = 0.45, .error = 0.02, .resolution = 0.03, .specimens = 4, .shot = 0},
                                          {.value = 0.3, .error = 0, .specimens = 1, .shot = 1}};
  fit("curved", curved, 2, 3, three, bounded, 5);
  fit("curved, one datum", curved, 2, 1, three, loose, 6);
  fit("ridge", ridge, 3, 2, three, bounded, 7);
  const struct posterior_datum five[] = {{.value = 0.5, .error = 0.1, .specimens = 1, .shot = 0},
                                         {.value = 0.6, .error = 0.1, .specimens = 1, .shot = 1},
                                         {.value = 0.9, .error = 0.2, .specimens = 2, .shot = 2}};
  fit("many", many, 5, 3, five, loose, 8);

  const double matrix[9] = {4, 1, 0.5, 1, 3, -0.2, 0.5, -0.2, 2}, b[3] = {1, -2, 0.5};
  double factor[9], x[3], inverse[9], values[3], vectors[9];
  memcpy(factor, matrix, sizeof factor);
  assert_true(covariance_factor(3, factor));
  covariance_solve(3, factor, b, x);
  covariance_inverse(3, factor, inverse);
  SAY("determinant", covariance_log_determinant(3, factor), covariance_distance(3, factor, b, values));
  say("solution", 3, x), say("inverse", 9, inverse);
  covariance_eigen(3, matrix, values, vectors);
  say("eigenvalues", 3, values), say("eigenvectors", 9, vectors);
  fclose(out);
  pinned_same("unit/inference.txt", text, 1e-5); /* surfaces are optimised to some 1e-7 */
}
