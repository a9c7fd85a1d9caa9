/* Every function of the statistics on small samples of many kinds, pinned in statistics.txt (tests/support/pinned.h):
 * empty, single, equal and tied values, values off, few and many. Other tests judge what the numbers mean; this one
 * says that they stay. */
#include "analysis/statistics/convergence.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/pinned.h"

static FILE *out;

static void say(const char *name, size_t count, const double *numbers) {
  fputs(name, out);
  for (size_t k = 0; k < count; k++)
    if (isnan(numbers[k]))
      fputs(" off", out);
    else
      fprintf(out, " %.12g", fabs(numbers[k]) < 1e-12 ? 0 : numbers[k]); /* rounding */
  fputc('\n', out);
}
#define SAY(name, ...) say(name, sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]){__VA_ARGS__})

/* ---- samples ---- */

enum { MOST = 120, KINDS = 8 };

/* Kinds: equal, two values, whole numbers, uniform, with every third off, skew shares, narrow shares, heavy tail. */
static size_t draw(int kind, size_t n, double values[MOST]) {
  for (size_t k = 0; k < n; k++) {
    const double u = random_draw(17, RANDOM_LATTICE, (uint64_t)kind, k);
    const double of[KINDS] = {0.25,      u < 0.4 ? 0.2 : 0.7, floor(6 * u),   u, k % 3 == 2 ? (double)NAN : u,
                              u * u * u, 0.5 + 0.02 * u,      1 / (1.001 - u)};
    values[k] = of[kind];
  }
  return n;
}

struct drawn {
  int kind;
  size_t n;
};

static void summaries(const char *what, const struct sample_summary *s) {
  SAY(what, (double)s->n, s->mean, s->standard_deviation, s->standard_error, s->half_width, s->low, s->high, s->weak);
}

static double middle(size_t n, const uint32_t *runs, void *context) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    sum += ((const double *)context)[runs[k]];
  return sum / (double)n;
}

static void of_samples(void) {
  static const struct drawn all[] = {{0, 1},  {0, 3}, {1, 2}, {1, 120}, {2, 3},  {2, 41}, {3, 0},
                                     {3, 20}, {4, 7}, {5, 4}, {5, 20},  {6, 41}, {7, 120}};
  double values[MOST];
  for (size_t a = 0; a < sizeof all / sizeof *all; a++) {
    const int kind = all[a].kind;
    const size_t n = draw(kind, all[a].n, values);
    fprintf(out, "== kind %d, n %zu\n", kind, n);
    struct sample_summary summary = sample_summarise(n, values, 0.95);
    summaries("summary", &summary);
    if (kind != 7 && kind != 2) {
      sample_of_share(&summary, 0.95);
      summaries("share", &summary);
    }
    struct sample_moments moments = {0};
    for (size_t k = 0; k < n; k++)
      sample_add(&moments, values[k]);
    summary = sample_summarise_moments(&moments, 0.9);
    summaries("moments", &summary);
    SAY("stop", sample_may_stop(n, values, 0.05, 0.95, 30), sample_may_stop(n, values, 0.3, 0.95, 7),
        sample_may_stop(n, values, 1e3, 0.95, 2));
    if (n > 1 && kind != 4) {
      const struct sample_interval i = sample_jackknife(n, 0.95, middle, values);
      SAY("jackknife", i.estimate, i.standard_error, i.half_width);
    }
    OWNED_BY(scatter_release) struct scatter scatter = {0};
    if (scatter_make(n, values, &scatter, NULL) == STATUS_OK && scatter.n > 0) {
      summaries("scatter", &scatter.mean);
      SAY("shape", (double)scatter.n, scatter.skewness, scatter.dip, scatter.dip_share, scatter.lower_mode,
          scatter.upper_mode, scatter.between, scatter.upper_share, scatter.upper_low, scatter.upper_high,
          scatter_in_steps(scatter.n, scatter.sorted));
      for (size_t q = 0; q < SCATTER_QUANTILES; q++)
        SAY("quantile", scatter_shares[q], scatter.quantile[q].value, scatter.quantile[q].low,
            scatter.quantile[q].high);
      const struct scatter_histogram h = scatter_histogram_of(&scatter, 0);
      SAY("histogram", (double)h.bins, h.from, h.width, (double)h.count[0], (double)h.count[h.bins / 2]);
    }
  }
  for (size_t n = 0; n < 200; n += n < 6 ? 1 : 37) {
    size_t each = 0;
    const size_t groups = sample_groups(n, &each);
    SAY("groups", (double)n, (double)groups, (double)each, sample_student(n, 0.95), sample_student(n, 0.5));
  }
  SAY("needed", (double)scatter_runs_needed(0.1, 0.02), (double)scatter_runs_needed(0.1, 0.5),
      (double)scatter_runs_needed(3, 0.1), (double)scatter_runs_needed(0, 0.1));
  for (size_t n = 3; n < 1500; n = 2 * n + 1)
    SAY("dip", (double)n, scatter_dip_limit(n), scatter_dip_share(n, 0.05), scatter_dip_share(n, 0.01));
}

/* ---- two samples ---- */

static void of_pairs(void) {
  static const struct drawn all[] = {{0, 0}, {0, 4}, {1, 20}, {2, 1}, {4, 2}, {5, 120}, {6, 3}, {7, 41}};
  double a[MOST], b[MOST];
  for (size_t s = 0; s < sizeof all / sizeof *all; s++) {
    const int kind = all[s].kind;
    const size_t n = draw(kind, all[s].n, a);
    struct difference_value first[MOST], second[MOST];
    size_t count[2] = {0, 0};
    draw(3, n, b);
    for (size_t k = 0; k < n; k++) {
      b[k] = 0.7 * a[k] + 0.1 * b[k];
      if (!isnan(a[k]))
        first[count[0]++] = (struct difference_value){(int64_t)k, a[k]};
      if (!isnan(b[k]) && k % 4 != 1)
        second[count[1]++] = (struct difference_value){(int64_t)k + (kind % 2 ? 0 : 500), b[k]};
    }
    const struct difference d = sample_difference(count[0], first, count[1], second, 0.95);
    fprintf(out, "== pairs of kind %d, n %zu\n", kind, n);
    SAY("difference", (double)d.side[0].n, (double)d.side[1].n, (double)d.pairs, d.side[0].mean, d.side[1].mean,
        d.difference, d.half_width);
    for (int paired = 0; paired < 2; paired++) {
      const struct convergence_difference bias = convergence_bias(n, a, b, paired, 0.95);
      SAY("bias", (double)bias.n, bias.value, bias.half_width);
    }
    const struct convergence_correlation c = convergence_correlate(n, a, b, 0.9);
    SAY("correlation", (double)c.n, c.value, c.low, c.high);
  }
  for (double w = 0.01; w < 2; w *= 3)
    SAY("gain", convergence_break_even(w), convergence_gain(0.2, w), convergence_gain(0.99, w),
        convergence_gain(-0.9, w));
}

/* ---- ladders ---- */

static void ranges(const char *name, const struct limit_range *r) {
  SAY(name, r->value, r->low, r->high);
}

static void of_ladders(void) {
  enum { LEVELS = 5, SEEDS = 9 };
  static const struct {
    double order, noise;
    int shape; /* 0: a law, 1: its coarse levels are off, 2: with ends, 3: few seeds */
  } all[] = {{0.5, 0, 0}, {0.5, 0.003, 1}, {1, 0.003, 2}, {2, 0.003, 0}, {1, 0.1, 3}};
  double values[LEVELS][SEEDS];
  for (size_t a = 0; a < sizeof all / sizeof *all; a++) {
    const double order = all[a].order, noise = all[a].noise;
    const int shape = all[a].shape;
    struct limit_ladder ladder = {.levels = LEVELS,
                                  .seeds = shape == 3 ? 3 : SEEDS,
                                  .least = -HUGE_VAL,
                                  .most = HUGE_VAL};
    struct convergence_row rows[LEVELS] = {0};
    size_t place[LEVELS];
    for (size_t l = 0; l < LEVELS; l++) {
      ladder.step[l] = rows[l].step = pow(2, -(double)l);
      ladder.values[l] = values[l];
      place[l] = l;
      for (size_t k = 0; k < SEEDS; k++)
        values[l][k] = 0.3 + 0.2 * pow(ladder.step[l], order) + (shape == 1 && l < 2 ? 0.3 - 0.2 * (double)l : 0) +
                       noise * (random_draw(5, RANDOM_LATTICE, 100 + l, k) - 0.5 +
                                random_draw(5, RANDOM_LATTICE, 0, k) - 0.5);
    }
    if (shape == 2)
      ladder.least = 0.3, ladder.most = 0.6, ladder.order_least = ladder.order_most = order;
    struct limit_law law;
    struct limit_point point = {.step = 0.01};
    assert_true(limit_infer(&ladder, 0.95, &law, 1, &point));
    fprintf(out, "== order %g, noise %g, shape %d\n", order, noise, shape);
    SAY("law", law.verdict, (double)law.dropped, law.fit, law.fit_with);
    ranges("order", &law.order), ranges("limit", &law.limit), ranges("change", &law.change);
    for (size_t l = 0; l < LEVELS; l++)
      ranges("distance", &law.distance[l]);
    if (law.verdict == LIMIT_SEEN)
      ranges("mean", &point.mean), ranges("sample", &point.sample), ranges("away", &point.distance);
    for (size_t l = 0; l < LEVELS; l++) {
      const struct sample_summary m = sample_summarise(ladder.seeds, values[l], 0.95);
      const struct convergence_difference bias = convergence_bias(ladder.seeds, values[l], values[LEVELS - 1], true,
                                                                  0.95);
      rows[l].n = (int64_t)m.n, rows[l].mean = m.mean, rows[l].half_width = m.half_width;
      rows[l].deviation = m.standard_deviation, rows[l].bias = bias.value, rows[l].bias_half_width = bias.half_width;
      rows[l].reference = l == LEVELS - 1;
    }
    convergence_resolve(LEVELS, rows, &law, place, true);
    for (size_t l = 0; l < LEVELS; l++)
      SAY("level", rows[l].distance, rows[l].distance_half_width, rows[l].resolution, rows[l].open);
    struct convergence_limit_row row = {0};
    convergence_limit_fill(&law, &row);
    SAY("row", row.verdict, (double)row.dropped, row.fit, row.fit_with, row.order.low, row.limit.high,
        row.change.value);
  }
}

/* ---- masses ---- */

static void exponents(const char *name, const struct exponent *e) {
  SAY(name, e->method, e->lower, e->upper, (double)e->n, e->beta, e->standard_error, e->cutoff_mass, e->ks_distance,
      e->log_likelihood);
}

static void goodness(const struct pooled_runs *runs, double lower) {
  struct pooled_goodness good = {0};
  struct pooled_rivals rivals = {0};
  if (pooled_goodness(runs, lower, 100, &good, NULL) == STATUS_OK)
    SAY("goodness", (double)good.n, good.distance, good.p, (double)good.draws);
  if (pooled_rivals(runs, lower, &rivals, NULL) == STATUS_OK)
    SAY("rivals", (double)rivals.n, rivals.beta, rivals.cutoff_beta, rivals.cutoff_mass, rivals.cutoff_ratio,
        rivals.cutoff_p, rivals.lognormal_ratio, rivals.lognormal_p, rivals.open_cutoff_p);
}

static void spectra(const struct pooled_runs *runs) {
  static const size_t units[] = {0, 2, 4, 6};
  for (int form = 0; form < 8; form++) {
    const struct pooled_form given = {.cumulative = form & 1,
                                      .size = {.density = form & 2 ? 2700 : 0, .dimensions = form & 4 ? 2 : 3},
                                      .units = form & 4 ? 3 : 0,
                                      .first_run = form & 4 ? units : NULL};
    OWNED struct pooled_bin *bins = NULL;
    size_t count = 0;
    if (pooled_spectrum(runs, &given, &bins, &count, NULL) == STATUS_OK)
      for (size_t b = 0; b < count; b += 10)
        SAY("bin", bins[b].bin, bins[b].lower, bins[b].upper, (double)bins[b].count, bins[b].mass, bins[b].value,
            bins[b].half_width);
    SAY("form", pooled_spectrum_exponent(&given, 1.8), pooled_spectrum_half_width(&given, 0.1));
  }
}

static void of_masses(void) {
  enum { RUNS = 6, EACH = 60 };
  static double masses[RUNS * EACH];
  static struct fragment fragments[EACH];
  static const size_t first[RUNS + 1] = {0, 60, 120, 180, 240, 300, 360};
  for (int law = 0; law < 2; law++) { /* a power law of 1.8 that is cut off, lognormal */
    for (size_t r = 0; r < RUNS; r++) {
      for (size_t k = 0; k < EACH; k++) {
        const double u = random_draw(23, RANDOM_LATTICE, (uint64_t)law + 1, r * EACH + k),
                     power = pow(1 - 0.999 * u, -1 / 0.8);
        masses[r * EACH + k] = 1e-3 * (law == 0 ? 40 * power / (40 + power) : exp(3 * u + u * u));
      }
      qsort(&masses[r * EACH], EACH, sizeof *masses, sample_descending);
    }
    const struct pooled_runs runs = {RUNS, first, masses}, one = {1, first, masses}, none = {0, first, masses};
    fprintf(out, "== law %d\n", law);
    for (int method = 0; method < EXPONENT_METHODS; method++)
      for (int w = 0; w < 2; w++) {
        const double lower = w == 0 ? 1e-3 : 5e-3;
        struct exponent fit;
        const struct exponent_window window = exponent_window_from((enum exponent_method)method, lower, masses[0]);
        if (exponent_fit((enum exponent_method)method, EACH, masses, window, &fit, NULL) == STATUS_OK)
          exponents("fit", &fit);
        int bin = 0, end = 0;
        exponent_bins_inside(window, &bin, &end);
        SAY("inside", bin, end);
        struct pooled_exponent pooled;
        const struct pooled_runs *const of[] = {&runs, &one, &none};
        for (int k = 0; k < (w == 0 ? 3 : 2); k++)
          if (pooled_exponent(of[k], (enum exponent_method)method, lower, 0.95, &pooled, NULL) == STATUS_OK) {
            exponents("pooled", &pooled.fit);
            SAY("over runs", pooled.interval.estimate, pooled.interval.standard_error, pooled.interval.half_width,
                (double)pooled.runs);
          }
        double each[RUNS];
        if (pooled_exponent_of_runs(&runs, (enum exponent_method)method, lower, each, NULL) == STATUS_OK)
          say("each", RUNS, each);
      }
    struct spectrum_bin_row bins[EACH];
    const size_t filled = spectrum_fill(EACH, masses, bins, EACH);
    for (size_t b = 0; b < filled; b += 8)
      SAY("filled", bins[b].bin, (double)bins[b].count, bins[b].mass);
    struct exponent fit;
    if (exponent_fit_bins(filled, bins, 0, (struct exponent_window){1e-3, 0.1}, &fit, NULL) == STATUS_OK)
      exponents("of bins", &fit);
    for (int kind = POWER_LAW_PURE; kind <= POWER_LAW_LOGNORMAL; kind++) {
      struct power_law_group groups[RUNS + 1] = {0}; /* the last one is empty: the rivals have it */
      for (size_t r = 0; r < RUNS; r++) {
        const double upper = kind == POWER_LAW_PURE ? masses[r * EACH] : 0.5;
        groups[r] = power_law_group_of((enum power_law_kind)kind, EACH, &masses[r * EACH], 1.5e-3, upper);
        if (r % 2 == 0)
          SAY("group", groups[r].weight, groups[r].mean, groups[r].span, groups[r].mean_h);
      }
      const struct power_law pure = power_law_fit(RUNS, groups);
      SAY("pure", pure.beta, pure.standard_error, pure.log_likelihood);
      double left[RUNS];
      if (kind == POWER_LAW_PURE) {
        assert_true(power_law_leave_out(RUNS, groups, 1, left));
        say("left out", RUNS, left);
        assert_true(power_law_leave_out(RUNS, groups, 4, left));
        say("left out", 2, left);
        continue;
      }
      const struct power_law_rival rival = power_law_rival_fit((enum power_law_kind)kind, RUNS + 1, groups);
      const double ratio = power_law_rival_ratio(&rival, pure.log_likelihood);
      SAY("rival", rival.beta, rival.standard_error, rival.rate, rival.log_likelihood, ratio,
          power_law_rival_p_value(ratio));
    }
    goodness(&runs, 1.5e-3), goodness(&one, 4e-3), spectra(&runs);

    for (size_t k = 0; k < EACH; k++)
      fragments[k] = (struct fragment){.mass = masses[k], .count = k > 50 ? 1 : (uint32_t)(1 + masses[k] / 1e-3)};
    for (int c = 0; c < 2; c++) {
      struct estimate rows[ESTIMATES_COUNT];
      if (estimates_make(EACH, fragments, c == 0 ? (double)NAN : 4e-3, rows, NULL) == STATUS_OK)
        for (int e = 0; e < ESTIMATES_COUNT; e++) {
          exponents(rows[e].headline ? "headline" : "estimate", &rows[e].fit);
          SAY("of", rows[e].window, rows[e].half_width);
        }
    }
  }
  for (int w = 0; w < ESTIMATES_WINDOWS; w++)
    SAY("window", estimates_window_elements((enum estimates_window)w),
        estimates_window_lower((enum estimates_window)w, 2, NAN),
        estimates_window_lower((enum estimates_window)w, 2, 10));
  for (double mass = 1e-4; mass < 1e5; mass *= 31.7) {
    const struct spectrum_size space = {2700, 3}, plane = {5000, 2}, no = {0, 3};
    SAY("size", spectrum_bin(mass), spectrum_edge(spectrum_bin(mass)), spectrum_size_of(&space, mass),
        spectrum_size_of(&plane, mass), spectrum_size_of(&no, mass), spectrum_size_mass(&space, mass),
        spectrum_size_mass(&plane, mass), spectrum_size_mass(&no, mass));
  }
  for (double beta = -1; beta < 4; beta += 0.5)
    SAY("below", power_law_below(beta, 0.3, 2), power_law_below(beta, 1, HUGE_VAL), power_law_below(beta, 0, 1),
        power_law_below(beta, 1, 1));
  SAY("width", pooled_spectrum_count_hw95(0, 0, 0), pooled_spectrum_count_hw95(1, 3, 9),
      pooled_spectrum_count_hw95(5, 10, 30), pooled_spectrum_count_hw95(5, 10, 20));
  for (int kind = POWER_LAW_CUTOFF; kind <= POWER_LAW_LOGNORMAL; kind++)
    for (double k = -2; k < 3; k += 1.25) {
      double mean[2], covariance[3];
      const double z = power_law_log_normalisation((enum power_law_kind)kind, k, 0.3, 3, mean, covariance);
      SAY("normalisation", z, mean[0], mean[1], covariance[0], covariance[1], covariance[2]);
    }
}

/* ---- shares of inputs ---- */

static void of_inputs(void) {
  enum { RUNS = 3, BLOCKS = 8, INPUTS = 2 };
  static double value[BLOCKS * (INPUTS + 2) * RUNS];
  for (size_t k = 0; k < sizeof value / sizeof *value; k++) {
    const double p = (double)(k / RUNS % (INPUTS + 2)), u = random_draw(3, RANDOM_LATTICE, k / RUNS, 0);
    value[k] = u + 0.4 * p * p + 0.1 * random_draw(3, RANDOM_LATTICE, 7, k % RUNS) +
               0.05 * random_draw(3, RANDOM_LATTICE, k, 9);
  }
  for (size_t seeds = 1; seeds <= RUNS; seeds++)
    for (int same = 0; same < 2; same++) {
      struct sensitivity_index index[INPUTS + 1];
      const struct sensitivity_table table = {INPUTS, (size_t)(seeds == RUNS ? BLOCKS / 2 : BLOCKS), seeds, value, same,
                                              NULL};
      if (sensitivity_sobol(&table, index, NULL) == STATUS_OK)
        for (size_t i = 0; i <= INPUTS; i++)
          SAY("index", index[i].first.estimate, index[i].first.half_width, index[i].total.estimate,
              index[i].total.standard_error, index[i].total.half_width);
    }
}

/* Points of two inputs that do something and one that does not, with 1 to 3 seeds. */
static void of_points(void) {
  enum { POINTS = 40, RUNS = 3, INPUTS = 3 };
  double x[POINTS * INPUTS], value[POINTS * RUNS];
  size_t runs[POINTS], needed;
  const bool named[INPUTS] = {false};
  for (size_t k = 0; k < POINTS * INPUTS; k++)
    x[k] = random_draw(29, RANDOM_LATTICE, k, 0);
  for (size_t seeds = 1; seeds <= RUNS; seeds++)
    for (int same = 0; same < 2; same++) {
      for (size_t j = 0; j < POINTS; j++) {
        runs[j] = seeds;
        for (size_t r = 0; r < seeds; r++)
          value[j * seeds + r] = x[INPUTS * j] + 0.5 * x[INPUTS * j + 1] * x[INPUTS * j + 1] +
                                 0.4 * random_draw(29, RANDOM_LATTICE, same ? 0 : j, 1 + r) +
                                 0.3 * random_draw(29, RANDOM_LATTICE, j, 10 + r);
      }
      struct sensitivity_point found[INPUTS + 1];
      const struct sensitivity_points given = {INPUTS, POINTS, x, named, seeds, runs, value, same};
      assert_int_equal(sensitivity_points(&given, found, &needed, NULL), STATUS_OK);
      for (size_t i = 0; i <= INPUTS; i++)
        SAY("of points", found[i].of_runs.estimate, found[i].of_runs.low, found[i].of_runs.high,
            found[i].of_means.estimate, found[i].of_means.low, found[i].of_means.high);
    }
}

/* ---- nothing, too little, and what is no number ---- */

static void of_nothing(void) {
  const double odd[] = {NAN, -1, 0, HUGE_VAL};
  fprintf(out, "== nothing\n");
  for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
    const double x = odd[k];
    SAY("odd", x, convergence_gain(x, 0.5), convergence_gain(0.5, x), convergence_break_even(x), spectrum_bin(x),
        power_law_rival_p_value(x), sample_student(1, 0.95), pooled_spectrum_count_hw95(3, x, 1));
    SAY("window", estimates_window_lower(ESTIMATES_FROM_5, x, 1), estimates_window_lower(ESTIMATES_FROM_5, 1, x));
  }
  SAY("gain", convergence_gain(1.5, 0.5), convergence_gain(1, 0.5), convergence_gain(-1, 0));
  const struct power_law none = power_law_fit(0, NULL);
  SAY("law", none.beta, none.standard_error, none.log_likelihood);
  const double masses[] = {3, 2.05, 2, 1};
  for (int kind = POWER_LAW_PURE; kind <= POWER_LAW_LOGNORMAL; kind++)
    for (double upper = 0.5; upper < 5; upper += 1.5) {
      const struct power_law_group group = power_law_group_of((enum power_law_kind)kind, 4, masses, 1, upper);
      const struct power_law law = power_law_fit(1, &group);
      SAY("few", group.weight, group.mean, group.mean_h, law.beta, law.standard_error);
    }
  for (int method = 0; method < EXPONENT_METHODS; method++) {
    const struct exponent unknown = exponent_unknown((enum exponent_method)method, (struct exponent_window){1, 2});
    exponents("unknown", &unknown);
    struct exponent fit;
    SAY("status", exponent_fit((enum exponent_method)method, 4, masses, (struct exponent_window){1, 4}, &fit, NULL));
    exponents("three", &fit);
  }
  double values[4][3] = {{0.5, 0.6, 0.4}, {0.4, 0.5, NAN}, {0.35, 0.4, 0.3}, {0.3, 0.35, 0.25}};
  for (int shape = 0; shape < 6; shape++) {
    struct limit_ladder ladder = {.levels = shape == 0 ? 2 : 4, .seeds = shape == 1 ? 2 : 3, .least = 0, .most = 1};
    for (size_t l = 0; l < 4; l++) {
      ladder.step[l] = shape == 2 ? (double)NAN : pow(2, -(double)l);
      ladder.values[l] = values[shape == 3 ? 0 : l];
      if (shape == 4)
        values[l][0] = NAN;
      if (shape == 5)
        values[l][0] = values[l][1] = values[l][2] = 1;
    }
    struct limit_law law;
    assert_true(limit_infer(&ladder, 0.9, &law, 0, NULL));
    SAY("shape", law.verdict, (double)law.dropped, law.limit.value, law.limit.low, law.limit.high,
        law.distance[0].value);
  }
}

TEST(numbers_stay) {
  OWNED char *text = NULL;
  size_t size = 0;
  assert_non_null(out = open_memstream(&text, &size));
  of_samples(), of_pairs(), of_ladders(), of_masses(), of_inputs(), of_points(), of_nothing();
  fclose(out);
  pinned_same("unit/statistics.txt", text, 1e-8);
}

static void part(void *context) {
  ((void (*)(void))(intptr_t)context)();
}

TEST(nothing_is_left) {
  void (*const parts[])(void) = {of_pairs, of_ladders, of_masses, of_inputs, of_points};
  assert_non_null(out = fopen("/dev/null", "w"));
  for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
    pinned_frees("statistics", part, (void *)(intptr_t)parts[k]);
  fclose(out);
}
