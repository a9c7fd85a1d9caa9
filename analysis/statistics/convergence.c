/* Bias and correlation of the levels of a knob, and the rows of a study. */
#include "analysis/statistics/convergence.h"

#include <float.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/statistics.h"
#include "schemas/memory.h"
#include "schemas/rows.h"

enum { FEWEST_PAIRS = 4 };
#define NOTHING ((double)NAN)

/* a - b; 0 where rounding alone may have made it. NaN when either is missing. */
static double difference_of(double a, double b) {
  const double rounding = 4 * DBL_EPSILON * fmax(fabs(a), fabs(b));
  return fabs(a - b) <= rounding ? 0 : a - b;
}

struct convergence_difference convergence_bias(size_t n, const double *level, const double *reference, bool paired,
                                               double confidence) {
  if (paired) {
    struct sample_moments moments = {0};
    for (size_t i = 0; i < n; i++)
      sample_add(&moments, difference_of(level[i], reference[i]));
    const struct sample_summary summary = sample_summarise_moments(&moments, confidence);
    const bool equal = summary.n > 1 && isnan(summary.half_width); /* by equal seeds: the bias is exact */
    return (struct convergence_difference){summary.n, summary.mean, equal ? 0 : summary.half_width};
  }
  const struct sample_summary a = sample_summarise(n, level, confidence);
  const struct sample_summary b = sample_summarise(n, reference, confidence);
  struct convergence_difference difference = {a.n < b.n ? a.n : b.n, difference_of(a.mean, b.mean), NOTHING};
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

struct convergence_correlation convergence_correlate(size_t n, const double *coarse, const double *fine,
                                                     double confidence) {
  struct convergence_correlation correlation = {0, NOTHING, NOTHING, NOTHING};
  OWNED double *pairs = malloc(2 * (n ? n : 1) * sizeof *pairs);
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

static int order_of(double a, double b) {
  return isnan(a) || isnan(b) ? isnan(a) - isnan(b) : (a > b) - (a < b);
}

int convergence_order(double error, double cost, double other_error, double other_cost) {
  const int by_error = order_of(error, other_error);
  return by_error ? by_error : order_of(cost, other_cost);
}

static void resolve(struct convergence_row *level, const struct limit_range *distance) {
  level->distance = (distance->low + distance->high) / 2;
  level->distance_half_width = (distance->high - distance->low) / 2;
  level->resolution = fmax(fabs(distance->low), fabs(distance->high));
}

void convergence_resolve(size_t count, struct convergence_row *levels, const struct limit_law *law, const size_t *place,
                         bool choices) {
  bool moves = false; /* do levels differ? */
  size_t ran = 0;
  for (size_t l = 0; l < count; l++) {
    ran += levels[l].n > 0;
    moves |= levels[l].n > 0 && fabs(levels[l].bias) + levels[l].bias_half_width > 0;
  }
  double coarser = NOTHING; /* |bias| and half width of the last level before the reference */
  for (size_t l = 0; l < count; l++) {
    struct convergence_row *level = &levels[l];
    const bool endless = !isnan(level->step) || (moves && !choices);
    level->open = (endless && law->verdict != LIMIT_SEEN) || law->verdict == LIMIT_CONSTANT;
    if (law->verdict == LIMIT_SEEN && place[l] < LIMIT_LEVELS)
      resolve(level, &law->distance[place[l]]);
    else if (law->verdict == LIMIT_CONSTANT)
      level->resolution = level->n > 0 ? 0 : NOTHING;
    else if (!level->reference) {
      level->resolution = fabs(level->bias) + level->bias_half_width;
      for (size_t finer = l + 1; endless && finer < count; finer++) /* of these, one may equal the finest by chance */
        if (fabs(level->bias - levels[finer].bias) > level->resolution && levels[finer].n > 0)
          level->resolution = fabs(level->bias - levels[finer].bias);
    } else
      level->resolution = endless ? coarser : ran > 1 ? 0 : NOTHING; /* one level has nothing to be compared with */
    if (!level->reference && isfinite(level->bias_half_width))
      coarser = fabs(level->bias) + level->bias_half_width;
  }
}

void convergence_resolve_own(size_t count, struct convergence_row *levels, const struct limit_law *law,
                             const size_t *place, const struct limit_point *own) {
  struct convergence_row *base = NULL;
  const struct convergence_row *finest = NULL;
  double largest = NOTHING, coarsest = 0; /* of the levels; step of the coarsest one that the law describes */
  for (size_t l = 0; l < count; l++) {
    if (place[l] < LIMIT_LEVELS)
      largest = fmax(largest, levels[l].resolution);
    if (place[l] < LIMIT_LEVELS && (!finest || levels[l].step < finest->step))
      finest = &levels[l];
    if (place[l] == law->dropped)
      coarsest = levels[l].step;
    if (levels[l].base && place[l] >= LIMIT_LEVELS)
      base = &levels[l];
  }
  if (!base)
    return;
  base->open = !(law->verdict == LIMIT_SEEN && base->step <= coarsest);
  if (base->open) /* finer than all levels: as the finest one */
    base->resolution = finest && base->step < finest->step ? finest->resolution : largest;
  else
    resolve(base, &own->distance);
}

void convergence_limit_fill(const struct limit_law *law, struct convergence_limit_row *row) {
  row->verdict = law->verdict;
  row->dropped = (int64_t)law->dropped;
  row->fit = law->fit;
  row->fit_with = law->fit_with;
  row->order = law->order;
  row->limit = law->limit;
  row->one_power = law->one_power;
  row->change = law->change;
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
    LEVEL(skew, -HUGE_VAL, .doc = "Skewness over seeds. Off for fewer than 20."),
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
    LEVEL(distance, -HUGE_VAL, .doc = "Mean less its limit: the middle of the 95 % interval. Off: no limit is seen."),
    LEVEL(distance_half_width, 0, .doc = "Half width of that interval."),
    LEVEL(resolution, 0,
          .doc = "What this knob leaves unknown at this level: the largest distance to the limit in its interval, or "
                 "|bias| and half width where no limit is seen; 0 where all runs are equal. Off for knobs that are no "
                 "resolution."),
    LEVEL_FLAG(open, .doc = "1: no limit is in sight, so that resolution may be larger; with 0: no run differs."),
    LEVEL(error, 0,
          .doc = "What all knobs of group resolution together leave unknown at this level: half_width of the view "
                 "resolution after the last study. Off where it is not known."),
    LEVEL_FLAG(frontier,
               .doc = "1: no other level of the scene here has an error and a cpu that are both not larger, and one of "
                      "them smaller (Pareto)."),
};
const struct field_table convergence_table = FIELD_TABLE(rows, struct convergence_row, "convergence",
                                                         "Levels of the knobs that a study has run.");

static FIELD_WORDS(verdict_names, LIMIT_VERDICTS, [LIMIT_TOO_FEW] = "too-few", [LIMIT_CONSTANT] = "constant",
                   [LIMIT_SEEN] = "limit", [LIMIT_NOT_SEEN] = "no-limit", [LIMIT_FALLING] = "falling");
static const char *const verdict_docs = "fewer than three levels with a step, or fewer than three seeds\n"
                                        "all runs are equal, which tells no limit\n"
                                        "a law limit + a step^p agrees with the levels\n"
                                        "no such law agrees with the three finest levels\n"
                                        "none does, but the last change is smaller than the one before";
static const struct field limit_rows[] = {
    LIMIT_TEXT(knob, .doc = "What was made coarser or finer."),
    LIMIT_TEXT(quantity, .doc = "Result, as a column of the view runs. Its unit is that of the limit."),
    ROW_OF(convergence_limit_row, verdict, verdict, FIELD_CHOICE, NULL, .choices = verdict_names,
           .choice_docs = verdict_docs, .maximum = LIMIT_VERDICTS - 1,
           .doc = "What all levels and seeds together tell."),
    ROW_OF(convergence_limit_row, dropped, dropped, FIELD_INTEGER, "1", .maximum = LIMIT_LEVELS,
           .doc = "Coarse levels that the law does not describe."),
    LIMIT_AS(fit, fit, 0,
             .doc = "Share of the samples of the best law that lie farther from it than the levels; below 0.05 no law "
                    "fits."),
    LIMIT_AS(fit_with, fit_with, 0, .doc = "The same with the finest of the dropped levels. Off: none is dropped."),
    LIMIT_AS(measured_order, order.value, 0, .doc = "p of limit + a step^p that fits best."),
    LIMIT_AS(measured_order_low, order.low, 0, .doc = "Lower end of its 95 % interval, 0.5 at least."),
    LIMIT_AS(measured_order_high, order.high, 0, .doc = "Upper end of it, 3 at most."),
    LIMIT_AS(extrapolated, limit.value, -HUGE_VAL, .doc = "Value at step 0: mean over the laws, by their likelihood."),
    LIMIT_AS(extrapolated_low, limit.low, -HUGE_VAL, .doc = "Lower end of its 95 % interval over all laws."),
    LIMIT_AS(extrapolated_high, limit.high, -HUGE_VAL, .doc = "Upper end of it."),
    LIMIT_AS(one_power_low, one_power.low, -HUGE_VAL,
             .doc =
                 "Lower end of the interval of the laws with one power alone: two errors against each other are left "
                 "out. Off: the levels reject one power."),
    LIMIT_AS(one_power_high, one_power.high, -HUGE_VAL, .doc = "Upper end of it."),
    LIMIT_AS(change, change.value, -HUGE_VAL, .doc = "Mean of the finest level less that of the next coarser one."),
    LIMIT_AS(change_low, change.low, -HUGE_VAL, .doc = "Lower end of its 95 % interval."),
    LIMIT_AS(change_high, change.high, -HUGE_VAL, .doc = "Upper end of it."),
};
const struct field_table convergence_limit_table = FIELD_TABLE(limit_rows, struct convergence_limit_row,
                                                               "convergence limit", "Limits of the knobs of a study.");
