/* Twin experiments: inputs drawn from the priors, one specimen "measured" by the model itself, and a fit that does not
 * know them. The 90 % intervals must hold the inputs in about 90 of 100 cases. See fit_twins.md. */

#include "tests/support/check.h"
#include "tests/support/inference_cases.h"

/* Two results of a body that breaks up, as functions of two inputs: the largest fragment's share, a curve from 1 to 0
 * over a load, and the logarithm of a number of fragments. The seed changes both, more where the body breaks. */
static double body(const double *u, size_t k, uint64_t seed) {
  const double load = 2 * u[0] - u[1], share = 1 / (1 + exp(3 * (load - 0.5)));
  const uint64_t place = (uint64_t)(u[0] * 0x1p31) << 31 | (uint64_t)(u[1] * 0x1p31);
  /* common: the same deviation at all points */
  const double own = case_normal(seed, place, k), common = case_normal(seed, 0, 7 + k);
  if (k == 0)
    return share + (0.02 + 0.2 * share * (1 - share)) * (0.8 * own + 0.6 * common);
  return 2 + 1.5 * u[0] + 2 * u[1] * u[1] + (0.15 + 0.1 * u[0]) * (0.9 * own + 0.44 * common);
}

/* The same, where a seed acts alike at all points. */
static double alike(const double *u, size_t k, uint64_t seed) {
  const double share = 1 / (1 + exp(3 * (2 * u[0] - u[1] - 0.5))), common = case_normal(seed, 0, 7 + k);
  if (k == 0)
    return share + (0.02 + 0.2 * share * (1 - share)) * common;
  return 2 + 1.5 * u[0] + 2 * u[1] * u[1] + (0.15 + 0.1 * u[0]) * common;
}

/* One input and one result that decreases with it, with a skewed scatter. */
static double skewed(const double *u, size_t k, uint64_t seed) {
  const uint64_t place = (uint64_t)(u[0] * 0x1p52);
  return exp(-2 * u[0]) + 0.05 * (case_normal(seed, place, k) * case_normal(seed, place, k + 1) - 0.2 +
                                  0.3 * fabs(case_normal(seed, place, k + 2)));
}

/* The same largest fragment, and the logarithm of one plus a number of fragments: of six, each with a chance that grows
 * with the load. Three such numbers are often equal. */
static double few(const double *u, size_t k, uint64_t seed) {
  if (k == 0)
    return body(u, k, seed);
  const uint64_t place = (uint64_t)(u[0] * 0x1p31) << 31 | (uint64_t)(u[1] * 0x1p31);
  double number = 0;
  for (uint64_t j = 0; j < 6; j++)
    number += case_normal(seed, place, 20 + j) < -2.6 + 1.2 * u[0] + 0.8 * u[1] * u[1];
  return log1p(number);
}

struct count {
  size_t cases, held[INFERENCE_INPUTS], rounds;
  double width[INFERENCE_INPUTS];
};

static void run_twins(size_t inputs, size_t outputs, case_model model, bool counts, bool own_seeds, size_t number,
                      struct count *count) {
  static struct case_fit fit;
  const bool bounded[INFERENCE_INPUTS] = {true, true, true, true};
  *count = (struct count){.cases = number};
  for (size_t c = 0; c < number; c++) {
    struct posterior_datum data[INFERENCE_OUTPUTS];
    double truth[INFERENCE_INPUTS];
    for (size_t i = 0; i < inputs; i++)
      truth[i] = random_draw(c, 100, 1000000007, i);
    for (size_t k = 0; k < outputs; k++) {
      const double error_of = k == 0 ? 0.01 : counts ? 0 : 0.05;
      data[k] = (struct posterior_datum){.value = model(truth, k, 999000000 + c) + error_of * case_normal(c, 3, k),
                                         .error = error_of,
                                         .specimens = 1};
    }
    fit = (struct case_fit){.inputs = inputs, .outputs = outputs, .own_seeds = own_seeds};
    OK(case_solve(&fit, model, data, bounded, c + 1, &error));
    for (size_t i = 0; i < inputs; i++) {
      const double low = gsl_cdf_ugaussian_P(posterior_quantile(&fit.posterior, i, 0.05));
      const double high = gsl_cdf_ugaussian_P(posterior_quantile(&fit.posterior, i, 0.95));
      count->held[i] += low <= truth[i] && truth[i] <= high;
      count->width[i] += (high - low) / (double)number;
    }
    count->rounds += fit.rounds;
    case_clear(&fit);
  }
}

static size_t cases(void) {
  const char *wanted = getenv("CLAST_SEEDS");
  return wanted ? strtoul(wanted, NULL, 10) : getenv("CLAST_FULL") ? 100 : 20;
}

/* 85 to 95 of 100 in the long form. Of the quick form's 20 cases 14 or fewer would hold by chance in one of 90 tests of
 * intervals that hold 90 %; the cases are always the same. Shared seeds that act alike are no fair sample: not judged.
 */
static void judge(const char *name, size_t inputs, bool judged, const struct count *count) {
  for (size_t i = 0; i < inputs; i++) {
    print_message("%s, input %zu: held in %zu of %zu, mean width %.3f of the prior's range, %.1f rounds\n", name, i,
                  count->held[i], count->cases, count->width[i], (double)count->rounds / (double)count->cases);
    if (!judged)
      continue;
    if (count->cases == 100) {
      assert_in_range(count->held[i], 85, 95);
    } else {
      assert_true(4 * count->held[i] >= 3 * count->cases);
    }
    assert_true(count->width[i] < 0.8); /* the prior's own interval holds 90 % as well */
  }
}

/* With the seeds of `clast fit`, each point's own, and with `independent: false`. */
static void run_both(const char *name, size_t inputs, case_model model, bool counts, bool judge_shared) {
  for (int own = 1; own >= 0; own--) {
    struct count count;
    char label[100];
    snprintf(label, sizeof label, "%s, %s", name, own ? "seeds of its own" : "shared seeds");
    run_twins(inputs, inputs, model, counts, own, cases(), &count);
    judge(label, inputs, own || judge_shared, &count);
  }
}

TEST(two_inputs) {
  run_both("two inputs, two summaries", 2, body, false, true);
}

TEST(one_input) {
  run_both("one input, skewed scatter", 1, skewed, false, true);
}

TEST(few_fragments) {
  run_both("two inputs, a share and a small number", 2, few, true, true);
}

TEST(seeds_that_act_alike) {
  run_both("seeds that act alike", 2, alike, false, false);
}
