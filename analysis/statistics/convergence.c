/* Bias, order, limit, correlation and frontier of the levels of a knob. */
#include "analysis/statistics/convergence.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "schemas/rows.h"

enum { RESAMPLES = 1000, FEWEST_SEEDS = 3, FEWEST_PAIRS = 4 };
#define NOTHING ((double)NAN)
/* Share of the resamples that must agree before an order is reported, or denied. */
#define SURE 0.95

struct convergence_difference convergence_bias(size_t n, const double *level, const double *reference, bool paired,
                                               double confidence) {
  if (paired) {
    struct sample_moments moments = {0};
    for (size_t i = 0; i < n; i++)
      sample_add(&moments, level[i] - reference[i]); /* NaN when either value is missing */
    const struct sample_summary summary = sample_summarise_moments(&moments, confidence);
    const bool equal = summary.n > 1 && isnan(summary.half_width); /* by equal seeds: the bias is exact */
    return (struct convergence_difference){summary.n, summary.mean, equal ? 0 : summary.half_width};
  }
  const struct sample_summary a = sample_summarise(n, level, confidence);
  const struct sample_summary b = sample_summarise(n, reference, confidence);
  struct convergence_difference difference = {a.n < b.n ? a.n : b.n, a.mean - b.mean, NOTHING};
  if (difference.n < 2)
    return difference;

  const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
  if (va + vb == 0) {
    difference.half_width = 0;
    return difference;
  }
  const double freedom = (va + vb) * (va + vb) / (va * va / (double)(a.n - 1) + vb * vb / (double)(b.n - 1));
  difference.half_width = gsl_cdf_tdist_Pinv(0.5 + confidence / 2, freedom) * sqrt(va + vb);
  return difference;
}

double convergence_skew(size_t n, const double *values) {
  const struct sample_summary summary = sample_summarise(n, values, SURE);
  if (summary.n < 3 || !(summary.standard_deviation > 0))
    return NOTHING;
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    if (!isnan(values[i]))
      sum += pow((values[i] - summary.mean) / summary.standard_deviation, 3);
  return sum / (double)summary.n;
}

struct convergence_correlation convergence_correlate(size_t n, const double *coarse, const double *fine,
                                                     double confidence) {
  struct convergence_correlation correlation = {0, NOTHING, NOTHING, NOTHING};
  double *pairs = malloc(2 * (n ? n : 1) * sizeof *pairs);
  if (!pairs)
    return correlation;
  size_t m = 0;
  for (size_t i = 0; i < n; i++)
    if (!isnan(coarse[i]) && !isnan(fine[i])) {
      pairs[2 * m] = coarse[i];
      pairs[2 * m + 1] = fine[i];
      m++;
    }
  correlation.n = m;
  if (m >= FEWEST_PAIRS && gsl_stats_variance(pairs, 2, m) > 0 && gsl_stats_variance(pairs + 1, 2, m) > 0) {
    const double r = gsl_stats_correlation(pairs, 2, pairs + 1, 2, m);
    const double z = gsl_cdf_ugaussian_Pinv(0.5 + confidence / 2) / sqrt((double)m - 3);
    correlation.value = fmax(-1, fmin(1, r));
    correlation.low = tanh(atanh(correlation.value) - z);
    correlation.high = tanh(atanh(correlation.value) + z);
  }
  free(pairs);
  return correlation;
}

double convergence_break_even(double w) {
  return 2 * sqrt(w) / (1 + w);
}

double convergence_gain(double correlation, double w) {
  const double r = fabs(correlation);
  if (!(r <= 1) || !(w >= 0))
    return NOTHING;
  if (r <= convergence_break_even(w))
    return 1; /* plain Monte Carlo is better */
  const double root = sqrt(1 - r * r) + r * sqrt(w);
  return 1 / (root * root);
}

/* ---- order and limit ---- */

static FIELD_WORDS(verdict_names,
                   CONVERGENCE_VERDICTS, [CONVERGENCE_TOO_FEW] = "too-few", [CONVERGENCE_UNCHANGED] = "unchanged",
                   [CONVERGENCE_ORDER] = "order", [CONVERGENCE_NO_ORDER] = "no-order", [CONVERGENCE_UNSURE] = "unsure");

/* The equation (h0^p - h1^p)/(h1^p - h2^p) = ratio of the differences, for p. h enters as logarithms relative to h1;
 * expm1 is exact for small p. */
struct order_equation {
  double up, down, ratio; /* ln(h0/h1) > 0, ln(h1/h2) > 0 */
};
static double excess(double p, void *context) {
  const struct order_equation *e = context;
  return expm1(p * e->up) / -expm1(-p * e->down) - e->ratio;
}

bool convergence_solve(const double h[3], const double f[3], double *order, double *limit) {
  struct order_equation equation = {log(h[0] / h[1]), log(h[1] / h[2]), (f[0] - f[1]) / (f[1] - f[2])};
  double low = 1e-6, high = CONVERGENCE_ORDER_MOST;
  *order = *limit = NOTHING;
  if (!isfinite(equation.ratio) || excess(low, &equation) >= 0 || excess(high, &equation) <= 0)
    return false;
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!solver)
    return false;

  gsl_function function = {excess, &equation};
  gsl_root_fsolver_set(solver, &function, low, high);
  for (int i = 0; i < 200 && high - low > 1e-12 * high; i++) {
    if (gsl_root_fsolver_iterate(solver) != GSL_SUCCESS)
      break;
    low = gsl_root_fsolver_x_lower(solver);
    high = gsl_root_fsolver_x_upper(solver);
  }
  *order = gsl_root_fsolver_root(solver);
  gsl_root_fsolver_free(solver);
  *limit = f[2] + (f[2] - f[1]) / expm1(*order * equation.down);
  return true;
}

/* Means of the three levels, each shifted at random within the uncertainty that the number of seeds leaves: a draw from
 * Student's t in several dimensions. With w_s normal, the sum of w_s (x_s - mean) over sqrt(n (n - 1)) has the
 * covariance of the means, and the factor sqrt((n - 1)/chi^2) turns it into t. Paired levels share w and chi^2. */
static void draw_means(uint64_t draw, size_t n, const double *const values[3], const struct sample_summary mean[3],
                       bool paired, double f[3]) {
  for (uint64_t level = 0; level < 3; level++) {
    const uint64_t stream = paired ? 0 : level;
    uint64_t bits[4];
    double sum = 0;
    for (size_t s = 0; s < n; s++) {
      if (isnan(values[level][s]))
        continue;
      random_bits(stream, RANDOM_RESAMPLE, draw, s + 1, bits);
      sum += gsl_cdf_ugaussian_Pinv(random_uniform(bits[0])) * (values[level][s] - mean[level].mean);
    }
    const double count = (double)mean[level].n;
    random_bits(stream, RANDOM_RESAMPLE, draw, 0, bits);
    const double chi_squared = gsl_cdf_chisq_Pinv(random_uniform(bits[0]), count - 1);
    f[level] = mean[level].mean + sum / sqrt(count * chi_squared);
  }
}

/* Limits of the middle part of sorted values, with the share `confidence`. */
static void middle(size_t n, double *values, double confidence, double *low, double *high) {
  qsort(values, n, sizeof *values, sample_ascending);
  *low = gsl_stats_quantile_from_sorted_data(values, 1, n, 0.5 - confidence / 2);
  *high = gsl_stats_quantile_from_sorted_data(values, 1, n, 0.5 + confidence / 2);
}

/* Paired levels use only the seeds that all three levels have. */
static size_t complete_seeds(size_t n, const double *const values[3], double *kept[3]) {
  size_t m = 0;
  for (size_t s = 0; s < n; s++) {
    if (isnan(values[0][s]) || isnan(values[1][s]) || isnan(values[2][s]))
      continue;
    for (int level = 0; level < 3; level++)
      kept[level][m] = values[level][s];
    m++;
  }
  return m;
}

static enum convergence_verdict judge(const struct convergence_limit *found, size_t n, const double *const values[3],
                                      bool paired, double confidence) {
  const struct convergence_difference finest = convergence_bias(n, values[1], values[2], paired, confidence);
  if (found->shrinking >= SURE)
    return CONVERGENCE_ORDER;
  if (!(fabs(finest.value) > finest.half_width))
    return CONVERGENCE_UNCHANGED;
  return found->shrinking <= 1 - SURE ? CONVERGENCE_NO_ORDER : CONVERGENCE_UNSURE;
}

struct convergence_limit convergence_extrapolate(const double h[3], size_t n, const double *const values[3],
                                                 bool paired, double confidence) {
  struct convergence_limit found = {CONVERGENCE_TOO_FEW, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING};
  double *kept[3] = {0}, orders[RESAMPLES], limits[RESAMPLES], f[3], drawn[3];
  double *room = malloc(3 * (n ? n : 1) * sizeof *room);
  if (!room)
    return found;
  for (int level = 0; level < 3; level++) {
    kept[level] = room + (size_t)level * n;
    memcpy(kept[level], values[level], n * sizeof **kept);
  }
  if (paired)
    n = complete_seeds(n, values, kept);
  const double *const sample[3] = {kept[0], kept[1], kept[2]};
  struct sample_summary mean[3];
  for (int level = 0; level < 3; level++) {
    mean[level] = sample_summarise(n, sample[level], confidence);
    f[level] = mean[level].mean;
    if (mean[level].n < FEWEST_SEEDS)
      goto cleanup;
  }

  size_t count = 0; /* draws that have both order and limit */
  for (uint64_t draw = 0; draw < RESAMPLES; draw++) {
    draw_means(draw, n, sample, mean, paired, drawn);
    count += convergence_solve(h, drawn, &orders[count], &limits[count]);
  }
  found.shrinking = (double)count / RESAMPLES;
  found.verdict = judge(&found, n, sample, paired, confidence);
  if (found.verdict == CONVERGENCE_ORDER && convergence_solve(h, f, &found.order, &found.limit)) {
    middle(count, orders, confidence, &found.order_low, &found.order_high);
    middle(count, limits, confidence, &found.limit_low, &found.limit_high);
  }
cleanup:
  free(room);
  return found;
}

void convergence_frontier(size_t n, const double *cost, const double *error, bool *on_frontier) {
  for (size_t i = 0; i < n; i++) {
    on_frontier[i] = isfinite(cost[i]) && isfinite(error[i]);
    for (size_t j = 0; j < n && on_frontier[i]; j++)
      if (cost[j] <= cost[i] && error[j] <= error[i] && (cost[j] < cost[i] || error[j] < error[i]))
        on_frontier[i] = false;
  }
}

void convergence_resolve(size_t count, struct convergence_row *levels, const struct convergence_limit_row *limit) {
  const bool open = limit->verdict == CONVERGENCE_NO_ORDER || limit->verdict == CONVERGENCE_UNSURE ||
                    limit->verdict == CONVERGENCE_TOO_FEW;
  double coarser = NOTHING; /* |bias| and half width of the last level before the reference */
  for (size_t l = 0; l < count; l++) {
    struct convergence_row *level = &levels[l];
    const bool stepped = !isnan(level->step);
    level->open = stepped && open;
    if (limit->verdict == CONVERGENCE_ORDER)
      level->resolution = fabs(level->mean - limit->limit) + (limit->limit_high - limit->limit_low) / 2;
    else if (!level->reference)
      level->resolution = fabs(level->bias) + level->bias_half_width;
    else
      level->resolution = stepped ? coarser : 0;
    if (!level->reference && isfinite(level->bias_half_width))
      coarser = fabs(level->bias) + level->bias_half_width;
  }
}

/* ---- rows of the store ---- */

#define NUMBER(struct_, path_, member_, least_, ...)                                                                   \
  REAL_OF(struct_, path_, member_, NULL, NAN, least_, HUGE_VAL, .flags = FIELD_MAY_BE_OFF, __VA_ARGS__)
#define LEVEL_TEXT(path_, ...)    ROW_OF(convergence_row, path_, path_, FIELD_TEXT, NULL, .text = "", __VA_ARGS__)
#define LEVEL_FLAG(path_, ...)    ROW_OF(convergence_row, path_, path_, FIELD_BOOLEAN, NULL, .maximum = 1, __VA_ARGS__)
#define LEVEL(path_, least_, ...) NUMBER(convergence_row, path_, path_, least_, __VA_ARGS__)
#define LIMIT_TEXT(path_, ...)    ROW_OF(convergence_limit_row, path_, path_, FIELD_TEXT, NULL, .text = "", __VA_ARGS__)
/* Column names differ from the C members where the member's name is a word of SQL. */
#define LIMIT_AS(path_, member_, least_, ...) NUMBER(convergence_limit_row, path_, member_, least_, __VA_ARGS__)

static const struct field rows[] = {
    LEVEL_TEXT(knob, .doc = "What was made coarser or finer (`clast converge --list`)."),
    LEVEL_TEXT(quantity, .doc = "Result, as a column of the view runs. Its unit is that of mean, bias and error."),
    LEVEL_TEXT(setting, .doc = "Value of the knob's first input at this level."),
    LEVEL_FLAG(base, .doc = "1: the scene's own setting."),
    LEVEL_FLAG(reference, .doc = "1: the finest level, or the choice that the others are compared with."),
    LEVEL_FLAG(paired, .doc = "1: levels are compared seed by seed."),
    LEVEL(step, 0, .doc = "Size that goes to zero as the knob gets finer, such as particles^(-1/3). Off: none."),
    ROW_OF(convergence_row, n, n, FIELD_INTEGER, "1", .maximum = 0x1p53, .doc = "Seeds with a usable result."),
    LEVEL(mean, -HUGE_VAL, .doc = "Mean over seeds."),
    LEVEL(half_width, 0, .doc = "Half width of the 95 % interval of the mean (Student's t)."),
    LEVEL(deviation, 0, .doc = "Standard deviation between seeds."),
    LEVEL(skew, -HUGE_VAL, .doc = "Skewness over seeds. Off for fewer than three."),
    LEVEL(upper_mode, 0, .doc = "Share of the runs in the upper of two modes (`clast scatter`). Off: one mode."),
    ROW_OF(convergence_row, cpu, cpu, FIELD_REAL, "s", .number = NAN, .maximum = HUGE_VAL, .flags = FIELD_MAY_BE_OFF,
           .doc = "Mean processor time of a run."),
    LEVEL(bias, -HUGE_VAL, .doc = "Mean of this level less that of the reference."),
    LEVEL(bias_half_width, 0, .doc = "Half width of the 95 % interval of the bias."),
    LEVEL(correlation, -1, .doc = "Pearson's correlation over seeds with the next finer level."),
    LEVEL(correlation_low, -1, .doc = "Lower end of its 95 % interval (Fisher)."),
    LEVEL(correlation_high, -1, .doc = "Upper end of it."),
    LEVEL(cost_ratio, 0, .doc = "w: processor time of a run over that of the next finer level."),
    LEVEL(break_even, 0, .doc = "2 sqrt(w)/(1 + w): correlation from which a control variate would save time."),
    LEVEL(gain, 0, .doc = "Plain Monte Carlo's cost over that of the best control variate; 1: it saves nothing."),
    LEVEL(resolution, 0,
          .doc = "What this knob leaves unknown at this level: the distance to the limit and half its interval, or "
                 "|bias| and half width where there is no order. Off for knobs that are no resolution."),
    LEVEL_FLAG(open, .doc = "1: no limit is in sight, so that resolution may be larger."),
    LEVEL(error, 0,
          .doc = "resolution (of a model: |bias| and half width), and what the other knobs leave unknown at the "
                 "scene's own setting. Off where it is not known."),
    LEVEL_FLAG(frontier, .doc = "1: no level studied is both cheaper and nearer (Pareto)."),
};
const struct field_table convergence_table = FIELD_TABLE(rows, struct convergence_row, "convergence",
                                                         "Levels of the knobs that a study has run.");

static const char *const verdict_docs = "fewer than three levels with a step, or fewer than three seeds\n"
                                        "the two finest levels do not differ as far as these seeds tell\n"
                                        "differences shrink: order and limit are given\n"
                                        "differences do not shrink: no limit is in sight\n"
                                        "more seeds are needed to tell";
static const struct field limit_rows[] = {
    LIMIT_TEXT(knob, .doc = "What was made coarser or finer."),
    LIMIT_TEXT(quantity, .doc = "Result, as a column of the view runs. Its unit is that of the limit."),
    ROW_OF(convergence_limit_row, verdict, verdict, FIELD_CHOICE, NULL, .choices = verdict_names,
           .choice_docs = verdict_docs, .maximum = CONVERGENCE_VERDICTS - 1,
           .doc = "What the three finest levels tell."),
    LIMIT_AS(measured_order, order, 0, .doc = "p of limit + a step^p through the three finest levels."),
    LIMIT_AS(measured_order_low, order_low, 0, .doc = "Lower end of the 95 % interval of the order."),
    LIMIT_AS(measured_order_high, order_high, 0, .doc = "Upper end of it."),
    LIMIT_AS(extrapolated, limit, -HUGE_VAL, .doc = "Extrapolated value at step 0."),
    LIMIT_AS(extrapolated_low, limit_low, -HUGE_VAL, .doc = "Lower end of its 95 % interval."),
    LIMIT_AS(extrapolated_high, limit_high, -HUGE_VAL, .doc = "Upper end of it."),
};
const struct field_table convergence_limit_table = FIELD_TABLE(limit_rows, struct convergence_limit_row,
                                                               "convergence limit",
                                                               "Orders and limits of the knobs of a study.");
