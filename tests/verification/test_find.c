/* Does the 95 % interval of a crossing hold it, and how many runs does it need? Responses of many forms, searched as
 * `clast find` does. Page: find.md.
 *
 * Quick: 40 searches a law. CLAST_FULL=1: 1000. */
#include <gsl/gsl_cdf.h>

#include "analysis/inference/crossing.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"

enum { MOST_RUNS = 400, GRID = 10, GRID_RUNS = 20, MOST = 1000 };
static const double WITHIN = 0.05;

/* The mean over seeds at the distance u from the crossing, as a share of the range; 0 at u = 0, rising. */
typedef double (*mean_curve)(double u, double width);

static double step(double u, double width) {
  (void)width;
  return u < 0 ? -0.5 : 0.5;
}
static double logistic(double u, double width) {
  return 0.5 * tanh(u / width / 2);
}
static double line(double u, double width) {
  (void)width;
  return u;
}
static double gompertz(double u, double width) {
  return exp(-exp(-u / width)) - exp(-1);
}
/* The slope changes at the crossing, by the factor `width`. */
static double broken(double u, double width) {
  return u * (u < 0 ? 2 / (1 + width) : 2 * width / (1 + width));
}
static double cubic(double u, double width) {
  (void)width;
  return 4 * u * u * u;
}
static double root(double u, double width) {
  (void)width;
  return copysign(0.7 * sqrt(fabs(u)), u);
}
static double asymmetric(double u, double width) {
  return u < 0 ? exp(u) - 1 : 1 - exp(-u / width);
}
static double jump_and_rise(double u, double width) {
  return u < 0 ? -0.3 : 0.7 * (1 - exp(-u / width));
}
/* Nothing breaks below the crossing; then the largest value, which falls to little above the level. */
static double peak(double u, double width) {
  return u < 0 ? -0.1 : 0.03 + 0.8 * exp(-u / width);
}
/* Without a single crossing. */
static double above(double u, double width) {
  return 0.6 + width * u;
}
static double little_above(double u, double width) {
  return 0.2 + width * u;
}
static double bump(double u, double width) {
  return 0.5 - fabs(u) / width;
}
/* Low, then a jump up and a slow fall: two crossings 0.4 apart. */
static double low_high_low(double u, double width) {
  return u < -0.3 ? -0.1 : 0.4 * exp(-(u + 0.3) / width) - 0.1;
}
static double plateau(double u, double width) {
  return fabs(u) < width ? 0 : copysign(fabs(u) - width, u);
}

/* A run about this mean. */
enum noise { NORMAL, SKEWED, LESS, MORE, HEAVY, MODES, QUIET, WITH_HEIGHT };

struct law {
  const char *name;
  mean_curve mean;
  double width;
  enum noise noise;
  double scatter; /* standard deviation, as a share of the range */
  bool share;     /* the share of runs above the level, not the mean */
};

/* The constants of crossing.c were chosen by these. */
static const struct law chosen_by[] = {
    {"step, 0.2 %", step, 0, NORMAL, 0.002, false},
    {"step, 20 %", step, 0, NORMAL, 0.2, false},
    {"logistic 0.02, 0.2 %", logistic, 0.02, NORMAL, 0.002, false},
    {"logistic 0.02, 2 %", logistic, 0.02, NORMAL, 0.02, false},
    {"logistic 0.02, 20 %", logistic, 0.02, NORMAL, 0.2, false},
    {"logistic 0.1, 0.2 %", logistic, 0.1, NORMAL, 0.002, false},
    {"logistic 0.1, 2 %", logistic, 0.1, NORMAL, 0.02, false},
    {"logistic 0.1, 20 %", logistic, 0.1, NORMAL, 0.2, false},
    {"line, 0.2 %", line, 0, NORMAL, 0.002, false},
    {"line, 2 %", line, 0, NORMAL, 0.02, false},
    {"line, 20 %", line, 0, NORMAL, 0.2, false},
    {"two modes, step, share", step, 0, MODES, 0.02, true},
    {"two modes, logistic 0.02, share", logistic, 0.02, MODES, 0.02, true},
    {"two modes, logistic 0.1, share", logistic, 0.1, MODES, 0.02, true},
    {"two modes, line, share", line, 0, MODES, 0.02, true},
    {"two modes, logistic 0.02, mean", logistic, 0.02, MODES, 0.02, false},
    {"two modes, logistic 0.1, mean", logistic, 0.1, MODES, 0.02, false},
};

/* These were not. */
static const struct law others[] = {
    {"Gompertz 0.1, 2 %", gompertz, 0.1, NORMAL, 0.02, false},
    {"Gompertz 0.1, 20 %", gompertz, 0.1, NORMAL, 0.2, false},
    {"slopes 1 : 4, 2 %", broken, 4, NORMAL, 0.02, false},
    {"slopes 1 : 4, 20 %", broken, 4, NORMAL, 0.2, false},
    {"slopes 1 : 9, 0.2 %", broken, 9, NORMAL, 0.002, false},
    {"slopes 1 : 9, 10 %", broken, 9, NORMAL, 0.1, false},
    {"cubic, 2 %", cubic, 0, NORMAL, 0.02, false},
    {"cubic, 10 %", cubic, 0, NORMAL, 0.1, false},
    {"root, 10 %", root, 0, NORMAL, 0.1, false},
    {"asymmetric 0.1, 1 %", asymmetric, 0.1, NORMAL, 0.01, false},
    {"asymmetric 0.1, 10 %", asymmetric, 0.1, NORMAL, 0.1, false},
    {"jump, then rise 0.05, 2 %", jump_and_rise, 0.05, NORMAL, 0.02, false},
    {"jump, then rise 0.05, 10 %", jump_and_rise, 0.05, NORMAL, 0.1, false},
    {"logistic 0.1, skewed 20 %", logistic, 0.1, SKEWED, 0.2, false},
    {"logistic 0.02, skewed 20 %", logistic, 0.02, SKEWED, 0.2, false},
    {"logistic 0.1, less noise there", logistic, 0.1, LESS, 0.2, false},
    {"logistic 0.1, more noise there", logistic, 0.1, MORE, 0.1, false},
    {"logistic 0.1, heavy tails 10 %", logistic, 0.1, HEAVY, 0.1, false},
    {"two modes, Gompertz 0.1, share", gompertz, 0.1, MODES, 0.02, true},
    {"two modes, Gompertz 0.2, mean", gompertz, 0.2, MODES, 0.05, false},
    {"nothing, then a peak, 30 %", peak, 0.1, QUIET, 0.3, false},
};

static const struct law no_single_crossing[] = {
    {"above, 2 %", above, 0.2, NORMAL, 0.02, false},
    {"above, 20 %", above, 0.2, NORMAL, 0.2, false},
    {"above by 0.1, 20 %", little_above, 0.2, NORMAL, 0.2, false},
    {"two crossings 0.2 apart, 2 %", bump, 0.2, NORMAL, 0.02, false},
    {"two crossings 0.6 apart, 20 %", bump, 0.6, NORMAL, 0.2, false},
    {"low, high, low, 60 % of the height", low_high_low, 0.3, WITH_HEIGHT, 0.6, false},
    {"low, high, low, 100 % of the height", low_high_low, 0.3, WITH_HEIGHT, 1, false},
    {"plateau 0.3 wide, 0.2 %", plateau, 0.15, NORMAL, 0.002, false},
    {"plateau 0.3 wide, 2 %", plateau, 0.15, NORMAL, 0.02, false},
    {"plateau 0.6 wide, 10 %", plateau, 0.3, NORMAL, 0.1, false},
};

struct case_of_law { /* of one search */
  const struct law *law;
  double crossing, sign;
  uint64_t seed, draws;
  double x[MOST_RUNS], y[MOST_RUNS];
  size_t runs;
};

static double uniform(struct case_of_law *c) {
  return fmax(random_draw(c->seed, 100, c->draws++, 0), 0x1p-54);
}

static double normal(struct case_of_law *c) {
  return gsl_cdf_ugaussian_Pinv(uniform(c));
}

static void run_at(struct case_of_law *c, double x) {
  const struct law *law = c->law;
  const double u = x - c->crossing, mean = c->sign * law->mean(u, law->width);
  double y = mean;
  switch (law->noise) {
  case NORMAL: y += law->scatter * normal(c); break;
  case SKEWED: y += law->scatter * (-log(uniform(c)) - 1); break;
  case LESS: y += law->scatter * (0.2 + 3 * fabs(u)) * normal(c); break;
  case MORE: y += law->scatter * (0.2 + 2 * exp(-u * u / 0.01)) * normal(c); break;
  case HEAVY: y += law->scatter * normal(c) / sqrt(-log(uniform(c))); break; /* Student, 2 degrees of freedom */
  case QUIET: y += u < 0 ? 0 : law->scatter * (fabs(mean) + 0.1) * normal(c); break;
  case WITH_HEIGHT: y += law->scatter * (mean + 0.15) * normal(c); break;
  case MODES: y = (uniform(c) < 0.5 + mean ? 0.5 : -0.5) + law->scatter * normal(c); break;
  }
  c->x[c->runs] = x;
  c->y[c->runs++] = y;
}

static void begin(struct case_of_law *c, const struct law *law, uint64_t seed) {
  c->law = law;
  c->seed = seed;
  c->draws = 0;
  c->crossing = law->mean == bump || law->mean == low_high_low ? 0.4 + 0.2 * uniform(c) : 0.15 + 0.7 * uniform(c);
  c->sign = uniform(c) < 0.5 ? 1 : -1;
  c->runs = 0;
}

static void find(const struct case_of_law *c, struct crossing *found) {
  const struct crossing_data data = {.n = c->runs,
                                     .x = c->x,
                                     .y = c->y,
                                     .level = 0,
                                     .share = c->law->share ? 0.5 : (double)NAN};
  OK(crossing_find(&data, found, &error));
}

/* As `clast find` does. */
static void search(struct case_of_law *c, double within, struct crossing *found) {
  double place[CROSSING_PLACES];
  c->runs = 0;
  for (int i = 0; i < CROSSING_FIRST; i++)
    for (int r = 0; r < CROSSING_RUNS; r++)
      run_at(c, (double)i / (CROSSING_FIRST - 1));
  for (;;) {
    find(c, found);
    const size_t each = crossing_next(found, c->runs, place);
    if (crossing_is_answer(found, within) || c->runs + each * CROSSING_PLACES > MOST_RUNS)
      return;
    for (int i = 0; i < CROSSING_PLACES; i++)
      for (size_t r = 0; r < each; r++)
        run_at(c, place[i]);
  }
}

/* The usual way: the same number of runs at equal points, a straight line between the two around the level, and the
 * errors of their two means. */
static double interpolate(const struct case_of_law *c, double *half_width) {
  double mean[GRID], standard_error[GRID];
  for (int i = 0; i < GRID; i++) {
    const struct sample_summary s = sample_summarise(GRID_RUNS, c->y + i * GRID_RUNS, 0.95);
    mean[i] = s.mean;
    standard_error[i] = s.standard_error;
  }
  for (int i = 0; i + 1 < GRID; i++)
    if (mean[i] * c->sign <= 0 && mean[i + 1] * c->sign > 0) {
      const double d = mean[i + 1] - mean[i], t = -mean[i] / d;
      *half_width = gsl_cdf_tdist_Pinv(0.975, 2 * GRID_RUNS - 2) *
                    hypot((1 - t) * standard_error[i], t * standard_error[i + 1]) / fabs(d) / (GRID - 1);
      return (i + t) / (GRID - 1);
    }
  *half_width = NAN;
  return NAN;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}
static double median(int n, double *values) {
  qsort(values, (size_t)n, sizeof *values, ascending);
  return values[n / 2];
}

struct tally {
  int n, held, held_same, held_grid, held_line, kinds[6], met;
  double runs[MOST], width[MOST], same[MOST], grid[MOST], straight[MOST], sum, sum_same;
};

static bool holds(const struct crossing *found, double crossing) {
  return found->low <= crossing && crossing <= found->high;
}

static int count(void) {
  const char *seeds = getenv("CLAST_SEEDS");
  const int n = seeds ? atoi(seeds) : getenv("CLAST_FULL") ? MOST : 40;
  return n < 1 ? 1 : n > MOST ? MOST : n;
}

static void tally_law(const struct law *law, uint64_t seed, struct tally *tally) {
  static struct case_of_law c;
  struct crossing found;
  *tally = (struct tally){.n = count()};
  for (int i = 0; i < tally->n; i++) {
    begin(&c, law, seed * 100000 + (uint64_t)i);
    search(&c, WITHIN, &found);
    tally->held += holds(&found, c.crossing);
    tally->kinds[found.kind]++;
    tally->met += found.high - found.low <= WITHIN;
    tally->sum += tally->runs[i] = (double)c.runs;
    tally->width[i] = found.high - found.low;

    c.runs = 0;
    for (int p = 0; p < GRID; p++)
      for (int r = 0; r < GRID_RUNS; r++)
        run_at(&c, p / (GRID - 1.0));
    double half_width;
    const double line_at = interpolate(&c, &half_width);
    tally->held_line += fabs(line_at - c.crossing) <= half_width;
    tally->straight[i] = isnan(half_width) ? 1 : 2 * half_width;
    find(&c, &found);
    tally->held_grid += holds(&found, c.crossing);
    tally->grid[i] = found.high - found.low;

    search(&c, tally->grid[i], &found);
    tally->held_same += holds(&found, c.crossing);
    tally->sum_same += tally->same[i] = (double)c.runs;
  }
}

/* A count of hits that a share p of hits makes in all but one of 1000 tries. */
static int least_hits(int n, double p) {
  return (int)floor(n * p - 3.1 * sqrt(n * p * (1 - p)));
}

static void check(const struct law *laws, size_t n, uint64_t seed, bool judge) {
  struct tally tally;
  int held = 0, all = 0;
  printf("| law | held | other answers | runs | width | equal points: width | runs for that | held | straight lines: "
         "width | held |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (size_t k = 0; k < n; k++) {
    tally_law(&laws[k], seed + k, &tally);
    const int other = tally.n - tally.kinds[CROSSING_FOUND];
    printf("| %s | %.3f | %.3f | %.0f | %.3f | %.3f | %.0f | %.3f | %.3f | %.3f |\n", laws[k].name,
           (double)tally.held / tally.n, (double)other / tally.n, tally.sum / tally.n, median(tally.n, tally.width),
           median(tally.n, tally.grid), tally.sum_same / tally.n, (double)tally.held_same / tally.n,
           median(tally.n, tally.straight), (double)tally.held_line / tally.n);
    held += tally.held;
    all += tally.n;
    if (!judge)
      continue;
    assert_true(tally.n - other >= least_hits(tally.n, 0.95));
    assert_true(tally.held >= least_hits(tally.n, 0.93));
    assert_true(tally.held_same >= least_hits(tally.n, 0.93));
    const struct sample_summary runs = sample_summarise((size_t)tally.n, tally.same, 0.95);
    assert_true(runs.mean <= GRID * GRID_RUNS / 2.0 + (tally.n < MOST ? 3.1 * runs.standard_error : 0));
  }
  assert_true(held >= least_hits(all, 0.93));
}

TEST(laws_that_chose_the_constants) {
  check(chosen_by, sizeof chosen_by / sizeof *chosen_by, 1, true);
}

TEST(laws_that_did_not) {
  check(others, sizeof others / sizeof *others, 101, false);
}

TEST(without_a_single_crossing) {
  struct tally tally;
  printf("| law | crossing | above | below | several | plateau | open | runs |\n|---|---|---|---|---|---|---|---|\n");
  for (size_t k = 0; k < sizeof no_single_crossing / sizeof *no_single_crossing; k++) {
    const struct law *law = &no_single_crossing[k];
    tally_law(law, 201 + k, &tally);
    printf("| %s |", law->name);
    for (int i = 0; i < 6; i++)
      printf(" %.3f |", (double)tally.kinds[i] / tally.n);
    printf(" %.0f |\n", tally.sum / tally.n);
  }
}
