/* Does the inferred limit hold the true one? Synthetic ladders of known laws: powers of the step, two errors against
 * each other, plateaus that break. A law is tried with noise of four sizes; 3 to 5 levels that double the particles
 * (step N^-1/3), 3 to 10 seeds that all levels share, correlation 0, 0.5 or 0.9 between levels, and noise that falls
 * with the step or not, are drawn for each ladder.
 *
 * Quick: 8 ladders a row, judged over all powers. CLAST_FULL=1: 250 a row, 1000 a law, each power judged; the table of
 * limits.md. */
#include <gsl/gsl_cdf.h>

#include "analysis/statistics/convergence.h"
#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"
#include "tests/support/run_case.h"

/* POWER: s^p. OPPOSED: s^p - b s^q. BREAKS: s^p from the break on; coarser levels all have the value at the break,
 * which b levels are finer than. All have the limit 0. */
enum form { POWER, OPPOSED, BREAKS };
struct law {
  const char *name;
  enum form form;
  double p, q, b;
  bool held_back; /* tried once, after the method was chosen */
};
static const struct law laws[] = {
    {"s^0.5", POWER, 0.5, 0, 0, false},
    {"s", POWER, 1, 0, 0, false},
    {"s^1.5", POWER, 1.5, 0, 0, false},
    {"s^2", POWER, 2, 0, 0, false},
    {"s - 0.5 s^2", OPPOSED, 1, 2, 0.5, false},
    {"s^0.5 - 0.3 s^1.5", OPPOSED, 0.5, 1.5, 0.3, false},
    {"s - 0.8 s^2", OPPOSED, 1, 2, 0.8, false},
    {"s, breaks at 2 levels", BREAKS, 1, 0, 2, false},
    {"s, breaks at 1 level", BREAKS, 1, 0, 1, false},
    {"s^0.7", POWER, 0.7, 0, 0, true},
    {"s^1.2", POWER, 1.2, 0, 0, true},
    {"s^1.8", POWER, 1.8, 0, 0, true},
    {"s - 0.3 s^1.7", OPPOSED, 1, 1.7, 0.3, true},
    {"s^0.7 - 0.4 s^1.3", OPPOSED, 0.7, 1.3, 0.4, true},
    {"s^0.6, breaks at 2 levels", BREAKS, 0.6, 0, 2, true},
    {"s^2.5", POWER, 2.5, 0, 0, true},
    {"s^3", POWER, 3, 0, 0, true},
};
enum { LAWS = sizeof laws / sizeof laws[0], NOISES = 4, MOST_SEEDS = 10, FINER = 4 };
static const double noises[NOISES] = {0.01, 0.05, 0.2, 0.6}; /* of a run, over the change from 0.5 to 4 times s = 1 */

struct drawing {
  uint64_t row, calls;
};
static double uniform(struct drawing *drawing) {
  return random_draw(drawing->row, RANDOM_RESAMPLE, 34, drawing->calls++) + 0x1p-54;
}
static double normal(struct drawing *drawing) {
  return gsl_cdf_ugaussian_Pinv(uniform(drawing));
}
static size_t whole(struct drawing *drawing, size_t from, size_t to) {
  return from + (size_t)(uniform(drawing) * (double)(to - from + 1));
}

static double step_of(double particles) {
  return pow(particles, -1.0 / 3);
}

static double value_of(const struct law *law, double step, double at_break) {
  const double seen = law->form == BREAKS ? fmin(step, at_break) : step;
  return pow(seen, law->p) - (law->form == OPPOSED ? law->b * pow(step, law->q) : 0);
}

struct sample {
  double values[LIMIT_LEVELS][MOST_SEEDS];
  struct limit_ladder ladder;
  double distance[LIMIT_LEVELS]; /* true mean less the limit, which is 0 */
  double finer_step, finer_mean; /* at FINER times the finest level, with noise of the same seeds */
};

static void draw_sample(const struct law *law, double noise, struct drawing *drawing, struct sample *sample) {
  static const double correlations[] = {0, 0.5, 0.9};
  const size_t levels = whole(drawing, 3, 5), seeds = whole(drawing, 3, MOST_SEEDS);
  const double rho = correlations[whole(drawing, 0, 2)], falls = uniform(drawing) < 0.5 ? 0.5 : 0;
  const double first = levels == 5 ? 0.25 : levels == 3 && uniform(drawing) < 0.5 ? 1 : 0.5;
  const double at_break = step_of(first * pow(2, (double)levels - law->b - 0.5));
  const double deviation = noise * (pow(step_of(0.5), law->p) - pow(step_of(4), law->p));
  double common[MOST_SEEDS];
  *sample = (struct sample){.ladder = {.levels = levels, .seeds = seeds, .least = -HUGE_VAL, .most = HUGE_VAL}};
  for (size_t s = 0; s < seeds; s++)
    common[s] = normal(drawing);
  for (size_t l = 0; l <= levels; l++) {
    const double step = step_of(first * pow(2, (double)l) * (l == levels ? FINER / 2 : 1));
    for (size_t s = 0; s < seeds; s++) {
      const double off = deviation * pow(step, falls) * (sqrt(rho) * common[s] + sqrt(1 - rho) * normal(drawing));
      sample->values[l][s] = value_of(law, step, at_break) + off;
      sample->finer_mean += l == levels ? sample->values[l][s] / (double)seeds : 0;
    }
    sample->finer_step = step;
    if (l < levels) {
      sample->distance[l] = value_of(law, step, at_break);
      sample->ladder.step[l] = step;
      sample->ladder.values[l] = sample->values[l];
    }
  }
}

/* Counts of a law with one noise. */
struct row {
  size_t n, seen, held, predicted, dropped;
  size_t levels, held_levels; /* of all ladders with a limit: distances, and those held */
  double wider;               /* median width over that of the known order */
};

static bool holds(const struct limit_range *range, double value) {
  return range->low <= value && value <= range->high;
}

static struct row try_law(size_t l, size_t noise, size_t n) {
  struct drawing drawing = {.row = l * NOISES + noise};
  struct row row = {.n = n, .wider = NAN};
  OWNED double *wider = malloc(n * sizeof *wider);
  assert_non_null(wider);
  for (size_t i = 0; i < n; i++) {
    struct sample sample;
    struct limit_law law, known;
    struct limit_point finer;
    draw_sample(&laws[l], noises[noise], &drawing, &sample);
    finer.step = sample.finer_step;
    assert_true(limit_infer(&sample.ladder, 0.95, &law, 1, &finer));
    if (law.verdict != LIMIT_SEEN)
      continue;
    row.held += holds(&law.limit, 0);
    row.predicted += holds(&finer.sample, sample.finer_mean);
    row.dropped += law.dropped > 0;
    row.levels += sample.ladder.levels;
    for (size_t k = 0; k < sample.ladder.levels; k++)
      row.held_levels += holds(&law.distance[k], sample.distance[k]);
    sample.ladder.order_least = sample.ladder.order_most = laws[l].p;
    assert_true(limit_infer(&sample.ladder, 0.95, &known, 0, NULL));
    wider[row.seen++] = (law.limit.high - law.limit.low) / (known.limit.high - known.limit.low);
  }
  qsort(wider, row.seen, sizeof *wider, sample_ascending);
  if (row.seen > 0 && laws[l].form == POWER)
    row.wider = wider[row.seen / 2];
  return row;
}

static double share(size_t part, size_t of) {
  return of ? (double)part / (double)of : (double)NAN;
}

/* Sums over noises and laws. */
struct sum {
  size_t n, seen, held, predicted, levels, held_levels;
};

static void add(struct sum *sum, const struct sum *more) {
  sum->n += more->n;
  sum->seen += more->seen;
  sum->held += more->held;
  sum->predicted += more->predicted;
  sum->levels += more->levels;
  sum->held_levels += more->held_levels;
}

/* Pass within four errors of a count. */
static void judge(const char *what, const struct sum *sum, double least_held, double least_predicted,
                  double most_unseen) {
  const double held = share(sum->held, sum->seen), predicted = share(sum->predicted, sum->seen);
  const double unseen = 1 - share(sum->seen, sum->n);
  const double levels = share(sum->held_levels, sum->levels);
  printf("%s: limit held %.3f, distances held %.3f, prediction held %.3f, no limit %.3f of %zu\n", what, held, levels,
         predicted, unseen, sum->n);
  assert_true(held >= least_held - 4 * sqrt(least_held * (1 - least_held) / (double)sum->seen));
  assert_true(levels >= least_held - 4 * sqrt(least_held * (1 - least_held) / (double)sum->seen));
  assert_true(predicted >= least_predicted - 4 * sqrt(least_predicted * (1 - least_predicted) / (double)sum->seen));
  assert_true(unseen <= most_unseen + 4 * sqrt(most_unseen * (1 - most_unseen) / (double)sum->n));
}

TEST(ladders) {
  const size_t n = run_case_full() ? 250 : 8;
  struct sum tuned = {0}, held_back = {0};
  printf(
      "| law | noise | limit held | no limit | false | width | distances held | prediction held | levels dropped |\n");
  for (size_t l = 0; l < LAWS; l++) {
    struct sum of_law = {0};
    for (size_t z = 0; z < NOISES; z++) {
      const struct row row = try_law(l, z, n);
      printf("| %s%s | %g | %.3f | %.3f | %.3f | %.1f | %.3f | %.3f | %.2f |\n", laws[l].name,
             laws[l].held_back ? " (held back)" : "", noises[z], share(row.held, row.seen), 1 - share(row.seen, n),
             share(row.seen - row.held, n), row.wider, share(row.held_levels, row.levels),
             share(row.predicted, row.seen), share(row.dropped, n));
      add(&of_law, &(struct sum){n, row.seen, row.held, row.predicted, row.levels, row.held_levels});
    }
    if (laws[l].form == POWER)
      add(laws[l].held_back ? &held_back : &tuned, &of_law);
    if (laws[l].form == POWER && run_case_full())
      judge(laws[l].name, &of_law, 0.93, 0.9, 0.1);
  }
  judge("powers", &tuned, 0.93, 0.9, 0.1);
  judge("powers that were held back", &held_back, 0.93, 0.9, 0.1);
}

/* ---- known answers ---- */

static struct limit_ladder ladder_of(size_t levels, size_t seeds, double values[][MOST_SEEDS]) {
  struct limit_ladder ladder = {.levels = levels, .seeds = seeds, .least = 0, .most = 1};
  for (size_t l = 0; l < levels; l++) {
    ladder.step[l] = pow(0.5, (double)l);
    ladder.values[l] = values[l];
  }
  return ladder;
}

TEST(exact_levels) {
  double values[4][MOST_SEEDS];
  struct limit_law law, again;
  for (size_t l = 0; l < 4; l++)
    for (size_t s = 0; s < 4; s++)
      values[l][s] = 0.5 - 0.1 * pow(0.5, 1.3 * (double)l) + 0.02 * (double)s; /* a scatter that all levels share */
  struct limit_ladder ladder = ladder_of(4, 4, values);
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_int_equal(law.verdict, LIMIT_SEEN);
  assert_true(holds(&law.order, 1.3) && law.order.high - law.order.low < 0.3);
  assert_true(holds(&law.distance[3], -0.1 * pow(0.5, 3.9)));
  assert_true(law.distance[3].high - law.distance[3].low < 0.01); /* the shared scatter is no error of the distance */
  assert_true(law.limit.high - law.limit.low > 0.03);             /* but of the limit */
  assert_true(limit_infer(&ladder, 0.95, &again, 0, NULL));
  assert_true(again.limit.low == law.limit.low && again.limit.high == law.limit.high);

  /* A coarse level off the law is dropped, with both numbers that say why. */
  for (size_t s = 0; s < 4; s++)
    values[0][s] += 0.1;
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_int_equal(law.verdict, LIMIT_SEEN);
  assert_int_equal(law.dropped, 1);
  assert_true(law.fit >= 0.05 && law.fit_with < 0.05);

  /* Differences that grow, and differences that stay. */
  for (size_t l = 0; l < 4; l++)
    for (size_t s = 0; s < 4; s++)
      values[l][s] = 0.1 + 0.1 * (double)l + 0.01 * (s % 2 ? 1 : -1) * (double)(l + 1) / 4;
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_int_equal(law.verdict, LIMIT_NOT_SEEN);
  assert_true(holds(&law.change, 0.1) && isnan(law.limit.value));
}

/* Two changes that fall faster than the steepest law (a shock between 50 and 400 points), that come back, and that
 * grow. Two errors against each other look like the first, near the step where they turn: so no limit is inferred. */
TEST(changes_that_fall) {
  static const struct {
    double mean[4];
    enum limit_verdict verdict;
  } cases[] = {{{1.9369, 1.9529, 1.956, 1.9561}, LIMIT_FALLING},
               {{1.9361, 1.9529, 1.9561, 1.9553}, LIMIT_FALLING},
               {{1.9529, 1.956, 1.953, 1.957}, LIMIT_NOT_SEEN}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    double values[4][MOST_SEEDS];
    struct limit_law law;
    for (size_t l = 0; l < 4; l++)
      for (size_t s = 0; s < 4; s++)
        values[l][s] = cases[i].mean[l];
    struct limit_ladder ladder = ladder_of(4, 4, values);
    ladder.most = HUGE_VAL;
    assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
    assert_int_equal(law.verdict, cases[i].verdict);
    assert_true(isnan(law.limit.value) && isnan(law.distance[3].value));
  }
}

/* A limit that its range cuts at 0, and the distance to it, are one: no mean is farther from it than its interval says
 * (a share of 0.249 was up to 0.53 from a limit of 0 to 0.138). Shares of dust, 8 seeds. */
TEST(a_distance_ends_where_the_limit_does) {
  double values[3][MOST_SEEDS] = {{0.827, 0.759, 0.824, 0.746, 0.724, 0.868, 0.677, 0.972},
                                  {0.373, 0.595, 0.726, 0.462, 0.724, 0.507, 0.541, 0.774},
                                  {0.313, 0.169, 0.283, 0.162, 0.24, 0.3, 0.241, 0.283}};
  struct limit_law law;
  struct limit_ladder ladder = ladder_of(3, 8, values);
  for (size_t l = 0; l < 3; l++)
    ladder.step[l] = (double[]){0.02, 0.0141, 0.01}[l];
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_SEEN && law.limit.low == 0 && law.limit.high < 0.2);
  for (size_t l = 0; l < 3; l++) {
    const double mean = sample_summarise(8, values[l], 0.95).mean;
    assert_true(law.distance[l].low >= mean - law.limit.high - 1e-12 && law.distance[l].high <= mean + 1e-12);
  }
}

/* Dust falls with the mass of a particle, s^3. With orders up to 2 only two errors against each other agreed with such
 * levels, and their limits were anywhere. */
TEST(levels_that_fall_as_the_mass_of_a_particle) {
  double values[4][MOST_SEEDS];
  struct limit_law law;
  struct limit_ladder ladder = ladder_of(4, 8, values);
  for (size_t l = 0; l < 4; l++) {
    ladder.step[l] = pow(2, -(double)l / 3);
    for (size_t s = 0; s < 8; s++)
      values[l][s] = 0.4 * pow(ladder.step[l], 3) * (1 + 0.05 * sin((double)(7 * l + 3 * s)));
  }
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_SEEN && law.order.high == LIMIT_ORDER_MOST && law.limit.high < 0.05);
}

/* Undamaged mass of a sphere, 1200 to 7200 particles, four seeds: few of them do not exclude that two errors cancel. */
TEST(the_laws_of_one_power_alone) {
  double values[4][MOST_SEEDS] = {{0.895, 0.883139, 0.895833, 0.868223},
                                  {0.914492, 0.931705, 0.905503, 0.910556},
                                  {0.929444, 0.944615, 0.931446, 0.934093},
                                  {0.942148, 0.948561, 0.937769, 0.940116}};
  struct limit_law law;
  struct limit_ladder ladder = ladder_of(4, 4, values);
  for (size_t l = 0; l < 4; l++)
    ladder.step[l] = step_of((double[]){1200, 1800, 3600, 7200}[l]);
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_SEEN && law.limit.low < 0.6);
  assert_true(law.one_power.low > 0.93 && law.one_power.high <= 1 && law.one_power.low >= law.limit.low);
  ladder.levels = 2;
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(isnan(law.one_power.low));
}

TEST(ranges_and_equal_runs) {
  double values[3][MOST_SEEDS];
  struct limit_law law;
  for (size_t l = 0; l < 3; l++)
    for (size_t s = 0; s < 5; s++)
      values[l][s] = 0.02 + 0.01 * sin((double)(7 * l + 3 * s));
  struct limit_ladder ladder = ladder_of(3, 5, values);
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_SEEN && law.limit.low >= 0 && law.limit.high <= 1);
  /* Every law would lead a share beyond 1: no limit is seen. If one that agrees less leads to a share, its interval
   * counts, and not what is left of the others at the end of the range. */
  for (size_t l = 0; l < 3; l++)
    for (size_t s = 0; s < 5; s++)
      values[l][s] = 1.1 - 0.4 * pow(0.5, (double)l) + 0.001 * sin((double)(7 * l + 3 * s));
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_NOT_SEEN && isnan(law.limit.low));
  for (size_t l = 0; l < 3; l++)
    for (size_t s = 0; s < 5; s++)
      values[l][s] = 1 - 0.3 * pow(0.25, (double)l) + 0.04 * sin((double)(7 * l + 3 * s));
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_SEEN && law.limit.high == 1 && law.limit.low < 0.98);
  for (size_t l = 0; l < 3; l++)
    for (size_t s = 0; s < 5; s++)
      values[l][s] = 0;
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_true(law.verdict == LIMIT_CONSTANT && isnan(law.limit.high) && isnan(law.distance[2].value));
  values[0][0] = values[1][1] = values[2][2] = NAN; /* two complete seeds */
  assert_true(limit_infer(&ladder, 0.95, &law, 0, NULL));
  assert_int_equal(law.verdict, LIMIT_TOO_FEW);
}
