/* Does the 95 % interval of a mean hold it, for results between 0 and 1 and for others? Laws of many forms, and
 * exploding discs. A sample counts against a law when its interval misses the mean and is not called weak.
 *
 * Quick: 1000 samples a row, 100 discs. CLAST_FULL=1: 20 000 samples, 300 discs. */
#include <gsl/gsl_cdf.h>

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "tests/support/check.h"
#include "tests/support/run_case.h"

/* JUDGED: coverage of 0.92, or nine of ten misses are weak. BELL: also few false marks, and not much wider than
 * Student. DEVIATES: printed, not judged; the page says why. UNBOUNDED: not cut at 1, Student's interval, printed. */
enum role { JUDGED, BELL, DEVIATES, UNBOUNDED };
enum form { NORMAL, UNIFORM, BETA, LOGNORMAL, MIXTURE, LOGIT_NORMAL, GAMMA, BINOMIAL, DISCS };
struct law {
  enum role role;
  enum form form;
  double a, b, share, scatter; /* numbers of the form: see quantile_of() */
};

/* The value of the law below which a share u of all values is. */
static double quantile_of(const struct law *law, double u) {
  switch (law->form) {
  case NORMAL: return law->a + law->b * gsl_cdf_ugaussian_Pinv(u);
  case UNIFORM: return law->a + (law->b - law->a) * u;
  case BETA: return gsl_cdf_beta_Pinv(u, law->a, law->b);
  case LOGNORMAL: return law->a * exp(law->b * gsl_cdf_ugaussian_Pinv(u));
  case LOGIT_NORMAL: return 1 / (1 + exp(-law->a - law->b * gsl_cdf_ugaussian_Pinv(u)));
  case GAMMA: return gsl_cdf_gamma_Pinv(u, law->a, law->b);
  case MIXTURE: /* a share of the runs about b, the others about a */
    return u < law->share ? law->b + law->scatter * gsl_cdf_ugaussian_Pinv(u / law->share)
                          : law->a + law->scatter * gsl_cdf_ugaussian_Pinv((u - law->share) / (1 - law->share));
  case BINOMIAL: { /* of b parts, each is in with probability a */
    unsigned k = 0;
    while (gsl_cdf_binomial_P(k, law->a, (unsigned)law->b) < u)
      k++;
    return k / law->b;
  }
  case DISCS: break;
  }
  return NAN;
}

static const char *const forms[] = {"normal",       "uniform", "beta",     "lognormal", "mixture",
                                    "logit-normal", "gamma",   "binomial", "discs"};

/* The rules were chosen by these. */
static const struct law chosen_by[] = {
    {JUDGED, DISCS, 900, 0.1, 0, 0},
    {JUDGED, MIXTURE, 0.9, 0.1, 0.1, 0.02},
    {JUDGED, MIXTURE, 0.1, 0.9, 0.1, 0.02},
    {JUDGED, MIXTURE, 0.3, 0.9, 0.1, 0.02},
    {JUDGED, MIXTURE, 0.9, 0.1, 0.1, 0},
    {JUDGED, MIXTURE, 1, 0.4, 0.1, 0.01},
    {JUDGED, BETA, 0.5, 0.5, 0, 0},
    {JUDGED, BETA, 2, 5, 0, 0},
    {JUDGED, BETA, 0.5, 5, 0, 0},
    {JUDGED, BETA, 8, 1, 0, 0},
    {JUDGED, BETA, 20, 0.5, 0, 0},
    {JUDGED, BETA, 0.3, 3, 0, 0},
    {JUDGED, BETA, 0.1, 0.9, 0, 0},
    {JUDGED, LOGNORMAL, 0.03, 1, 0, 0},
    {JUDGED, LOGNORMAL, 0.1, 1, 0, 0},
    {JUDGED, LOGNORMAL, 0.3, 1, 0, 0},
    {JUDGED, LOGNORMAL, 1, 1, 0, 0},
    {JUDGED, LOGNORMAL, 0.1, 0.5, 0, 0},
    {BELL, NORMAL, 0.5, 0.1, 0, 0},
    {BELL, NORMAL, 0.5, 0.05, 0, 0},
    {BELL, NORMAL, 0.6, 0.15, 0, 0},
    {BELL, NORMAL, 0.3, 0.1, 0, 0},
    {BELL, UNIFORM, 0, 1, 0, 0},
    {BELL, UNIFORM, 0.2, 0.6, 0, 0},
};
/* These were tried afterwards. */
static const struct law held_back[] = {
    {JUDGED, DISCS, 700, 0.1, 0, 0},         {JUDGED, DISCS, 2000, 0.1, 0, 0},
    {JUDGED, MIXTURE, 0.95, 0.6, 0.2, 0.02}, {JUDGED, MIXTURE, 0.02, 0.5, 0.15, 0.01},
    {JUDGED, MIXTURE, 0.3, 0.7, 0.5, 0.05},  {JUDGED, BETA, 5, 0.8, 0, 0},
    {JUDGED, BETA, 0.7, 0.3, 0, 0},          {JUDGED, BETA, 1, 30, 0, 0},
    {JUDGED, LOGIT_NORMAL, 2, 1, 0, 0},      {JUDGED, LOGIT_NORMAL, -4, 1, 0, 0},
    {JUDGED, LOGIT_NORMAL, -1, 1.5, 0, 0},   {JUDGED, GAMMA, 0.5, 0.2, 0, 0},
    {JUDGED, GAMMA, 3, 0.02, 0, 0},          {JUDGED, BINOMIAL, 0.05, 20, 0, 0},
    {BELL, NORMAL, 0.45, 0.12, 0, 0},        {BELL, BETA, 4, 4, 0, 0},
    {BELL, UNIFORM, 0.3, 0.9, 0, 0},
};
static const struct law others[] = {
    {DEVIATES, MIXTURE, 0.2, 0.8, 0.1, 0.03}, {DEVIATES, MIXTURE, 0.5, 0.1, 0.1, 0.02},
    {DEVIATES, LOGNORMAL, 0.2, 1, 0, 0},      {DEVIATES, NORMAL, 0.35, 0.02, 0, 0},
    {DEVIATES, NORMAL, 0.8, 0.05, 0, 0},      {DEVIATES, NORMAL, 0.8, 0.1, 0, 0},
    {DEVIATES, UNIFORM, 0, 0.3, 0, 0},        {UNBOUNDED, NORMAL, 0.5, 0.1, 0, 0},
    {UNBOUNDED, GAMMA, 1, 1, 0, 0},           {UNBOUNDED, LOGNORMAL, 1, 0.5, 0, 0},
    {UNBOUNDED, LOGNORMAL, 1, 1, 0, 0},       {UNBOUNDED, LOGNORMAL, 1, 1.5, 0, 0},
    {UNBOUNDED, MIXTURE, 0, 1, 0.1, 0.03},
};

enum { MOST = 20000, SIZES = 5 };
static const size_t sizes[SIZES] = {3, 5, 10, 20, 50};
static double population[MOST];

/* M_1/M of discs of 67 grains, some of which break: energy in J/m. */
static size_t explode(const struct law *law) {
  char energy[64], diameter[64];
  const size_t discs = run_case_full() ? 300 : 100;
  snprintf(energy, sizeof energy, "charge.energy=%g J/m", law->a);
  snprintf(diameter, sizeof diameter, "body.diameter=%g m", law->b);
  const struct dem_inputs inputs = DEM_CASE("disc-explosion", energy, diameter, "stop.end_time=2 ms");
  for (size_t r = 0; r < discs; r++) {
    const struct ran ran = run_case_run(&dem_engine, &inputs, r + 1);
    population[r] = ran.outcome.largest_fraction;
    free(ran.fragments);
  }
  return discs;
}

static size_t fill(const struct law *law) {
  if (law->form == DISCS)
    return explode(law);
  for (size_t i = 0; i < MOST; i++) {
    const double value = quantile_of(law, ((double)i + 0.5) / MOST);
    population[i] = law->role == UNBOUNDED ? value : fmin(fmax(value, 0), 1);
  }
  return MOST;
}

/* One row: coverage of Student's interval and of ours, which of our misses are weak, weak samples, width over
 * Student's. */
static void judge(const struct law *law, const char *name, size_t count, double truth, size_t n) {
  const size_t samples = run_case_full() ? 20000 : 1000;
  size_t student = 0, held = 0, warned = 0, weak = 0;
  double width = 0, width_of_student = 0, drawn[50];
  for (size_t s = 0; s < samples; s++) {
    for (size_t i = 0; i < n; i++)
      drawn[i] = population[(size_t)(random_draw(61, n, s, i) * (double)count)];
    struct sample_summary summary = sample_summarise(n, drawn, 0.95);
    student += summary.low <= truth && truth <= summary.high;
    const bool all_equal = isnan(summary.half_width);
    width_of_student += all_equal ? 0 : summary.half_width;
    if (law->role != UNBOUNDED)
      sample_of_share(&summary, 0.95);
    width += all_equal ? 0 : summary.half_width;
    const bool hit = summary.low <= truth && truth <= summary.high;
    held += hit;
    weak += summary.weak;
    warned += !hit && summary.weak;
    assert_true(law->role == UNBOUNDED || (summary.low >= 0 && summary.high <= 1));
  }
  const double all = (double)samples, misses = all - (double)held, coverage = (double)held / all;
  const double caught = misses > 0 ? (double)warned / misses : 1, false_marks = (double)weak / all;
  printf("%-32s %3zu  %.3f  %.3f  %.2f  %.2f  %.2f\n", name, n, (double)student / all, coverage, caught, false_marks,
         width / width_of_student);
  if (n < 5 || law->role == DEVIATES || law->role == UNBOUNDED)
    return;
  const double room = 4 * sqrt(0.92 * 0.08 / all), room_of_caught = 4 * sqrt(0.9 * 0.1 / fmax(misses, 1));
  if (coverage < 0.92 - room && caught < 0.9 - room_of_caught)
    fail_msg("%s, %zu runs: coverage %.3f, and %.2f of the misses are weak", name, n, coverage, caught);
  if (law->role == BELL && (false_marks > 0.1 + 4 * sqrt(0.1 * 0.9 / all) || width > 1.3 * width_of_student))
    fail_msg("%s, %zu runs: %.2f weak, %.2f times Student's width", name, n, false_marks, width / width_of_student);
}

static void study(size_t laws, const struct law *law) {
  printf("%-32s %3s  %s  %s  %s  %s  %s\n", "", "n", "Student", "here", "caught", "weak", "width");
  for (size_t l = 0; l < laws; l++) {
    char name[64];
    snprintf(name, sizeof name, law[l].form == MIXTURE ? "%s %g, %g (%g), +- %g" : "%s %g, %g", forms[law[l].form],
             law[l].a, law[l].b, law[l].share, law[l].scatter);
    const size_t count = fill(&law[l]);
    double truth = 0;
    for (size_t i = 0; i < count; i++)
      truth += population[i] / (double)count;
    for (int k = 0; k < SIZES; k++)
      judge(&law[l], name, count, truth, sizes[k]);
  }
}

TEST(laws_that_the_rules_were_chosen_by) {
  study(sizeof chosen_by / sizeof chosen_by[0], chosen_by);
}

TEST(laws_that_were_held_back) {
  study(sizeof held_back / sizeof held_back[0], held_back);
}

TEST(other_laws) {
  study(sizeof others / sizeof others[0], others);
}

/* n equal shares: the bound of what may be unseen, 1 - 0.05^(1/n), on the side where there is room. */
TEST(equal_values_bound_the_mean) {
  double x[30];
  for (int i = 0; i < 30; i++)
    x[i] = 1;
  struct sample_summary s = sample_summarise(30, x, 0.95);
  assert_true(isnan(s.half_width) && isnan(s.low) && isnan(s.high));
  sample_of_share(&s, 0.95);
  assert_true(isnan(s.half_width) && s.high == 1 && fabs(s.low - pow(0.05, 1.0 / 30)) < 1e-15 && !s.weak);
  for (int i = 0; i < 30; i++)
    x[i] = 0.3; /* its sum over 30 rounds */
  s = sample_summarise(30, x, 0.95);
  sample_of_share(&s, 0.95);
  assert_true(isnan(s.half_width) && fabs(s.low - 0.3 * pow(0.05, 1.0 / 30)) < 1e-14);
  assert_true(fabs(s.high - 1 + 0.7 * pow(0.05, 1.0 / 30)) < 1e-14);
  s = sample_summarise(1, x, 0.95);
  sample_of_share(&s, 0.95);
  assert_true(isnan(s.low) && isnan(s.high));
}
