/* Measured spectra: the contents of files, refusals, and distances with known answers. */
#include <unistd.h>

#include "analysis/statistics/statistics.h"
#include "tests/support/check.h"

static const struct spectrum_size no_size = {0, 3};
static const char path[] = "test-measured.csv";

static status read_text(const char *text, const struct spectrum_size *size, struct measured *out) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  const status code = measured_read(path, size, out, &error);
  unlink(path);
  return code;
}

static void near(double a, double b) {
  assert_true(fabs(a - b) <= 1e-12 * fabs(b));
}

TEST(the_three_kinds) {
  struct measured m;
  assert_int_equal(read_text("\xef\xbb\xbf# source: a paper (1991)\r\n# complete from: 2 g\r\nname;mass (g)\r\n"
                             "a;5\r\nb;1.5\r\n\r\nc;7\r\n",
                             &no_size, &m),
                   STATUS_OK);
  assert_true(m.single && m.n == 3 && m.above[0] == 3 && m.above[2] == 1);
  near(m.mass[0], 0.0015);
  near(m.mass[2], 0.007);
  near(m.complete, 0.002);
  assert_string_equal(m.source, "a paper (1991)");
  measured_release(&m);

  assert_int_equal(read_text("mass (kg),count\n1,10\n4,1\n2,5\n", &no_size, &m), STATUS_OK);
  assert_true(!m.single && m.n == 3 && m.above[0] == 16 && m.above[1] == 6 && m.above[2] == 1);
  OWNED struct pooled_bin *bins = NULL;
  size_t count;
  OK(measured_bins(&m, &(struct pooled_form){0}, 0, &bins, &count, &error));
  assert_int_equal(count, 2); /* the last class has no upper end */
  assert_true(bins[0].value == 10 && bins[1].value == 2.5 && isnan(bins[0].half_width));
  measured_release(&m);

  /* Sizes: a sphere of 1 cm and 6/pi g/cm^3 weighs 1 g. The density of the file overrides that of the caller.
   * Its remarks have decimal commas. */
  assert_int_equal(read_text("# density: 1,909859317102744 g/cm^3\n# complete from: 1,0 cm\n"
                             "size (mm)\tcumulative\n10\t7\n20\t2\n",
                             &(struct spectrum_size){1, 3}, &m),
                   STATUS_OK);
  near(m.mass[0], 0.001);
  near(m.mass[1], 0.008);
  near(m.complete, 0.001);
  assert_true(m.above[0] == 7 && m.above[1] == 2);
  measured_release(&m);
  assert_int_equal(read_text("# density: 2.7 g/cm^3\n# complete from: 0.1 g\nsize (mm), count\n2, 214\n4, 58\n",
                             &(struct spectrum_size){1, 3}, &m),
                   STATUS_OK);
  near(m.complete, 1e-4);
  measured_release(&m);
}

/* The masses of a two-dimensional scene are per metre of depth; those of bodies are told. */
TEST(two_dimensions) {
  static const struct spectrum_size flat = {0, 2};
  struct measured m;
  assert_int_equal(read_text("# complete from: 1 g/m\nmass (g/m), retained (kg/m)\n2,1\n4,3\n", &flat, &m), STATUS_OK);
  assert_true(m.n == 2 && m.weighed && m.above[0] == 4 && !m.bodies);
  near(m.mass[0], 0.002);
  near(m.complete, 0.001);
  measured_release(&m);
  assert_int_equal(read_text("mass (g)\n2\n4\n", &flat, &m), STATUS_OK);
  assert_true(m.n == 2 && m.bodies);
  measured_release(&m);
  assert_int_equal(read_text("mass (kg/m)\n2\n4\n", &no_size, &m), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "kg/m"));
}

TEST(bad_files) {
  static const struct {
    const char *text, *says;
  } bad[] = {
      {"weight (g)\n1\n", ":1: no such column"},
      {"name,id\n1,2\n", ":1: the first line names the columns"},
      {"mass (mm)\n1\n", ":2: expected a mass above 0, not '1 mm'"},
      {"mass (stone)\n3\n", ":2: expected a mass above 0, not '3 stone': unknown unit 'stone'; known are"},
      {"# density: 1 g/cm^3\nsize (foot)\n3\n", ":3: expected a size above 0, not '3 foot': unknown unit"},
      {"mass (g)\n1\nx\n", ":3: expected a mass"},
      {"mass (g)\n-1\n", ":2: expected a mass"},
      {"mass (g)\nnan\n", ":2: expected a mass"},
      {"mass (g),count\n1\n", ":2: 1 cells, but the header has 2"},
      {"mass (g),count\n1,-3\n", ":2: expected a number of fragments"},
      {"mass (g),count\n1,inf\n", ":2: expected a number of fragments"},
      {"mass (g),cumulative\n1,3\n2,5\n", ":2: 'cumulative' is smaller here than on line 3, which has a larger mass"},
      {"# density: 2700 kg/m^3\nsieve size (mm); passing (%)\n4; 8\n8; 47\n6; 60\n",
       ":5: 'passing' is larger here than on line 4, which has a larger size"},
      {"mass (g),count\n1,0\n", "there is no fragment in it"},
      {"mass (g),count\n1,1.7e308\n2,1.7e308\n", "more fragments than a number can hold"},
      {"# density: 1 g/cm^3\nsize (m)\n1e-200\n", "no fragment has the mass of '1e-200 m'"},
      {"# density: 1 g/cm^3\nsize (m)\n1e200\n", "no fragment has the mass of '1e200 m'"},
      {"size (mm)\n1\n", "sizes need a density"},
      {"# density: heavy\nsize (mm)\n1\n", ":1: the density needs a number"},
      {"# complete from: 1 km\nmass (g)\n1\n", ":1: expected a mass"},
      {"# density: 1 g/cm^3\n# complete from: 1 s\nsize (mm)\n1\n", ":2: expected a size"},
      {"", "there is no row"},
      /* A file means one thing. */
      {"mass\n94\n31\n", ":2: a number without a unit"},
      {"# complete from: 1\nmass (g)\n1\n", "a number without a unit"},
      {"# complete from: 1,500 g\nmass (g)\n1\n", ":1: '1,500 g': it may be a decimal comma"},
      {"# density: 2.7\nsize (mm)\n1\n", ":1: the density needs a number and a unit"},
      {"mass (kg)\n1,5\n2,5\n", ":2: 2 cells, but the header has 1"},
      {"mass (kg)\n\"1,500\"\n", ":2: '1,500': it may be a decimal comma"},
      {"mass (kg),speed (m/s)\n1,2\n", ":1: no such column"},
      {"mass (g),mass (kg)\n1,2\n", ":1: two columns say the same"},
      {"# density: 2.7 g/cm^3\nsize (mm),mass (g)\n100,1200\n200,300\n", ":2: a mass beside a size"},
      {"mass (g),size (mm)\n100,1200\n", ":1: a mass beside a size"},
      {"mass (g),count (%)\n100,12\n", ":1: a number of fragments has no unit"},
      {"mass (g),count\n100,12 g\n", ":2: expected a number of fragments"},
      {"number,mass (g)\n1,94\n2,31\n3,12\n", "column 'number' is 1, 2, 3"},
      {"mass (g),retained\n1,5\n", ":2: a number without a unit"},
      {"mass (g),retained (mm)\n1,5\n", ":2: expected a mass of fragments"},
      {"mass (g),retained (%)\n1,50\n2,61\n", "111 % of the mass"},
      {"mass (g),passing (g)\n1,50\n", ":2: the mass that passes is given in %"},
      {"mass (g),passing (%)\n1,50\n2,101\n", ":3: expected a share from 0 to 100 %"},
      {"mass (g),passing (%)\n1,50\n2,40\n", "it counts from its mass downwards"},
      {"mass (g),passing (%)\n1,100\n", "there is no fragment"},
      {"mass (g)\n", "there is no row"},
      {"mass (g);count\n1;1.234\n", ":2: a number of fragments, or a separator of thousands; not '1.234'"},
      {"# density: 2.7 g/cm^3\n# density: 3 g/cm^3\nsize (mm)\n1\n", ":2: another density"},
  };
  struct measured m;
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    assert_int_equal(read_text(bad[i].text, &no_size, &m), STATUS_CONTENT);
    if (!strstr(error.message, bad[i].says))
      fail_msg("%s: %s", bad[i].text, error.message);
    assert_null(m.mass);
  }
  assert_int_equal(measured_read("no-such.csv", &no_size, &m, &error), STATUS_MISSING);
  assert_int_equal(measured_read(".", &no_size, &m, &error), STATUS_IO);
}

/* What laboratories write: the same masses or numbers in several forms. */
TEST(forms_of_laboratories) {
  static const struct {
    const char *text;
    bool single, weighed;
    double mass[3], above[3];
  } cases[] = {
      {"mass (g);count\n2,5;214\n4,5;58\n150,5;3\n", false, false, {0.0025, 0.0045, 0.1505}, {275, 61, 3}},
      {"mass (g),count\n\"2,5\",214\n\"4,5\",58\n\"150,5\",3\n", false, false, {0.0025, 0.0045, 0.1505}, {275, 61, 3}},
      {"mass [kg]\tnumber of fragments\n1\t3\n2\t2\n4\t1\n", false, false, {1, 2, 4}, {6, 3, 1}},
      {"mass (kg),N(>m)\n1,6\n2,3\n4,1\n", false, false, {1, 2, 4}, {6, 3, 1}},
      {"mass (kg);name\n\"1,5\";a\n\"2,5\";b\n3;c\n", true, false, {1.5, 2.5, 3}, {3, 2, 1}},
      {"name,mass\na,1 kg\nb,2000 g\nc,4 kg\n", true, false, {1, 2, 4}, {3, 2, 1}},
      {"mass (kg),retained (g)\n1,1200\n2,300\n4,500\n", false, true, {1, 2, 4}, {2, 0.8, 0.5}},
      {"mass (kg),Mass_Retained (%)\n4,25\n2,25\n1,50\n", false, true, {1, 2, 4}, {1, 0.5, 0.25}},
      {"mass (kg),% retained\n4,25\n2,25\npan,50\n", false, true, {0, 2, 4}, {1, 0.5, 0.25}},
      {"mass (kg),Cumulative % Passing\n4,100\n2,75\n1,50\n", false, true, {1, 2, 4}, {0.5, 0.25, 0}},
      {"mass (kg),passing [1]\n4,1\n2,0.75\n1,0.5\n", false, true, {1, 2, 4}, {0.5, 0.25, 0}},
      {"mass (kg),cumulative retained (kg)\n4,1\n2,2\n1,6\n", false, true, {1, 2, 4}, {6, 2, 1}},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED_BY(measured_release) struct measured m;
    if (read_text(cases[i].text, &no_size, &m) != STATUS_OK)
      fail_msg("%s: %s", cases[i].text, error.message);
    assert_true(m.single == cases[i].single && m.weighed == cases[i].weighed && m.n == 3);
    for (size_t k = 0; k < 3; k++) {
      near(m.mass[k], cases[i].mass[k]);
      near(m.above[k] + 1, cases[i].above[k] + 1);
    }
  }
}

/* Runs of masses 4, 3, 2, 1. */
static void one_to_four(size_t runs, size_t *first, double *masses) {
  for (size_t i = 0; i < 4 * runs; i++)
    masses[i] = (double)(4 - i % 4);
  for (size_t r = 0; r <= runs; r++)
    first[r] = 4 * r;
}

/* A sieve table compares shares of mass. Runs of masses 1, 2, 3, 4: shares of the mass from 1, 2, 3, 4 kg on are 1,
 * 0.9, 0.7, 0.4. */
TEST(sieves) {
  enum { RUNS = MATCH_RUNS };
  size_t first[RUNS + 1];
  double masses[4 * RUNS];
  one_to_four(RUNS, first, masses);
  const struct pooled_runs runs = {RUNS, first, masses};
  struct measured m;
  struct measured_match match;
  assert_int_equal(read_text("mass (kg),retained (%)\n1,10\n2,20\n3,50\n4,20\n", &no_size, &m), STATUS_OK);
  OK(measured_compare(&m, &runs, 1, &match, &error));
  near(match.distance, 0.2); /* from 4 kg on 0.2 instead of 0.4 */
  near(match.from, 1);
  near(match.share + 1, 1);
  near(match.simulated, 4);
  assert_true(isnan(match.fragments) && isnan(match.log_likelihood));
  OK(measured_compare(&m, &runs, 2, &match, &error));
  near(match.distance, 4 / 9.0 - 2 / 9.0);
  OK(measured_compare(&m, &runs, 3.5, &match, &error)); /* one class has no shape */
  assert_true(match.from == 4 && isnan(match.distance) && isnan(match.share));
  struct pooled_bin *bins;
  size_t count;
  /* 20 kg in all: 4 kg from 2 to 3 kg are 4 ln(3/2) fragments, as if each decade had the same mass. */
  OK(measured_bins(&m, &(struct pooled_form){0}, 20, &bins, &count, &error));
  assert_int_equal(count, 3);
  near(bins[1].value, 4 * log(1.5));
  assert_true(bins[1].lower == 2 && bins[1].upper == 3);
  free(bins);
  OK(measured_bins(&m, &(struct pooled_form){.cumulative = true}, 20, &bins, &count, &error));
  assert_int_equal(count, 4);
  near(bins[3].value, 1); /* 4 kg from 4 kg on */
  near(bins[2].value, 1 + 10 * log(4 / 3.0));
  free(bins);
  measured_release(&m);
  /* Shares of all mass, also of what passes the finest sieve: 80 % of 10 kg are 8 kg from 4 kg on. */
  assert_int_equal(read_text("mass (kg),passing (%)\n1,20\n4,20\n", &no_size, &m), STATUS_OK);
  OK(measured_bins(&m, &(struct pooled_form){.cumulative = true}, 10, &bins, &count, &error));
  near(bins[1].value, 2);
  free(bins);
  measured_release(&m);
  /* Masses of classes need no other mass. */
  assert_int_equal(read_text("mass (kg),retained (kg)\n1,1\n4,8\n", &no_size, &m), STATUS_OK);
  OK(measured_bins(&m, &(struct pooled_form){.cumulative = true}, 10, &bins, &count, &error));
  near(bins[1].value, 2);
  free(bins);
  measured_release(&m);
}

/* The bins of single fragments hold all of the axis from the complete mass to the heaviest: so many fragments per kg
 * are in the list. */
TEST(empty_bins_count) {
  OWNED_BY(measured_release) struct measured m;
  OWNED struct pooled_bin *bins = NULL;
  size_t count;
  assert_int_equal(read_text("# complete from: 3 kg\nmass (kg)\n4.4\n5.9\n5.91\n16\n", &no_size, &m), STATUS_OK);
  OK(measured_bins(&m, &(struct pooled_form){0}, 0, &bins, &count, &error));
  assert_int_equal(count, 3);
  near(bins[0].lower, 3);
  for (size_t b = 0; b < count; b++) {
    assert_true(b == 0 || bins[b].lower == bins[b - 1].upper);
    near(bins[b].value * (bins[b].upper - bins[b].lower), (double)bins[b].count);
  }
  assert_true(bins[1].count == 2 && bins[2].upper > 16);
}

/* Runs of masses 1, 2, 3, 4; measured 2.5 and 4, or the same numbers at thresholds. */
TEST(distances) {
  enum { RUNS = MATCH_RUNS };
  size_t first[RUNS + 1];
  double masses[4 * RUNS];
  one_to_four(RUNS, first, masses);
  const struct pooled_runs runs = {RUNS, first, masses};
  struct measured_match match;
  double mass[3] = {2.5, 4, 9}, above[3] = {3, 2, 2};
  struct measured m = {.single = true, .n = 2, .mass = mass, .above = (double[]){2, 1}};

  /* From 2.5 kg, which is the first one, on: pooled 3 and 4. Share above 2.5: 1 and 1/2. */
  OK(measured_compare(&m, &runs, NAN, &match, &error));
  near(match.from, 2.5);
  near(match.distance, 0.5);
  near(match.fragments, 2);
  near(match.simulated, 2);
  near(match.share + 1, 1);            /* no run differs from the others at all */
  for (size_t n = 1; n <= RUNS; n++) { /* a share of few runs says nothing */
    OK(measured_compare(&m, &(struct pooled_runs){n, first, masses}, NAN, &match, &error));
    assert_true(n < RUNS ? isnan(match.share) : match.share == 0);
  }

  /* From 1 kg: shares of 1, 3/4, 1/2, 1/4 at 1, 2, 3, 4; measured 1, 1, 1/2, 1/2. Greatest just below 2.5 */
  OK(measured_compare(&m, &runs, 1, &match, &error));
  near(match.from, 1);
  near(match.distance, 0.5);
  near(match.simulated, 4);
  OK(measured_compare(&m, &runs, 3.5, &match, &error)); /* a 4 each, which has no shape */
  assert_true(isnan(match.distance) && isnan(match.share));
  near(match.fragments, 1);

  /* Thresholds 2.5, 4 and 9 from 3 on: the first that counts is 4. */
  m = (struct measured){.n = 3, .mass = mass, .above = above};
  OK(measured_compare(&m, &runs, 3, &match, &error));
  near(match.from, 4);
  near(match.distance, 1); /* measured: two above 9, simulated none */
  /* Two classes, 4..9 and from 9, half a fragment added to each: two fragments in the last, of one of each run. */
  near(match.log_likelihood, 2 * log(0.5 / (RUNS + 1)));
  OK(measured_compare(&m, &runs, 2, &match, &error));
  near(match.from, 2.5);
  near(match.log_likelihood, log((RUNS + 0.5) / (2 * RUNS + 1.5)) + 2 * log(0.5 / (2 * RUNS + 1.5)));
  OK(measured_compare(&m, &runs, 10, &match, &error));
  assert_true(isnan(match.distance) && match.fragments == 0);
  /* No simulated fragment is so heavy: no number of runs is needed beside those of a shape. */
  OK(measured_compare(&m, &runs, 5, &match, &error));
  assert_true(match.simulated == 0 && match.judged == 0);
  assert_int_equal(match.needed, MATCH_RUNS);
}

/* One experiment that is a run like the others: its distance is as large as that of a share of the runs which is
 * uniform in 0..1, so its mean is a half. */
TEST(a_run_among_runs) {
  enum { RUNS = 21, EACH = 30, CASES = 40 };
  static double masses[RUNS * EACH];
  size_t first[RUNS + 1];
  double mass[EACH], above[EACH], mean = 0;
  uint64_t state_of_draw = 12345;
  for (int c = 0; c < CASES; c++) {
    for (size_t r = 0; r <= RUNS; r++)
      first[r] = r * EACH;
    for (size_t i = 0; i < RUNS * EACH; i++) {
      state_of_draw = state_of_draw * 6364136223846793005u + 1442695040888963407u;
      masses[i] = 1 / (1 - (double)(state_of_draw >> 11) * 0x1p-53);
    }
    memcpy(mass, masses + (RUNS - 1) * EACH, sizeof mass);
    qsort(mass, EACH, sizeof *mass, sample_ascending);
    for (int i = 0; i < EACH; i++)
      above[i] = EACH - i;
    struct measured_match match;
    assert_int_equal(measured_compare(&(struct measured){.single = true, .n = EACH, .mass = mass, .above = above},
                                      &(struct pooled_runs){RUNS - 1, first, masses}, 1, &match, &error),
                     STATUS_OK);
    mean += match.share / CASES;
  }
  assert_true(fabs(mean - 0.5) < 4 * sqrt(1 / 12.0 / CASES));
}

/* Runs of three fragments beside a specimen of 30: their own distances are chance, those of ten runs together are not.
 * A specimen of the same law has shares that are uniform in 0..1; one of a steeper law, N ~ m^-2 for m^-1, differs. */
TEST(a_specimen_with_more_fragments_than_a_run) {
  enum { RUNS = 80, EACH = 3, MEASURED = 30, CASES = 60 };
  static double masses[RUNS * EACH];
  size_t first[RUNS + 1];
  double mass[MEASURED], above[MEASURED], mean[2] = {0, 0};
  int differ[2] = {0, 0};
  uint64_t state_of_draw = 54321;
  for (size_t r = 0; r <= RUNS; r++)
    first[r] = r * EACH;
  for (int i = 0; i < MEASURED; i++)
    above[i] = MEASURED - i;
  for (int c = 0; c < 2 * CASES; c++) {
    const int steeper = c % 2;
    for (size_t i = 0; i < RUNS * EACH + MEASURED; i++) {
      state_of_draw = state_of_draw * 6364136223846793005u + 1442695040888963407u;
      const double one = 1 / (1 - (double)(state_of_draw >> 11) * 0x1p-53);
      if (i < RUNS * EACH)
        masses[i] = one;
      else
        mass[i - RUNS * EACH] = steeper ? sqrt(one) : one;
    }
    qsort(mass, MEASURED, sizeof *mass, sample_ascending);
    const struct measured m = {.single = true, .n = MEASURED, .mass = mass, .above = above};
    struct measured_match match;
    OK(measured_compare(&m, &(struct pooled_runs){RUNS, first, masses}, 1, &match, &error));
    assert_true(match.together == 10 && match.needed == 40);
    mean[steeper] += match.share / CASES;
    differ[steeper] += match.share < 0.05;
    OK(measured_compare(&m, &(struct pooled_runs){39, first, masses}, 1, &match, &error));
    assert_true(isnan(match.share) && match.judged == 39); /* too few to draw ten from */
  }
  assert_true(fabs(mean[0] - 0.5) < 4 * sqrt(1 / 12.0 / CASES));
  assert_true(differ[0] <= 8); /* 3 of 60 expected */
  assert_true(differ[1] >= CASES / 2);
}

/* A count from a stranger's file that no number of runs reaches gives no verdict. Runs of 1.6 specimens are not joined:
 * a draw with more fragments than the specimen is nearer by chance. */
TEST(runs_are_joined_with_care) {
  enum { RUNS = 40 };
  size_t first[RUNS + 1];
  double masses[4 * RUNS];
  one_to_four(RUNS, first, masses);
  const struct pooled_runs runs = {RUNS, first, masses};
  struct measured_match match;
  static const double counts[] = {6.4, 8, 40, 44, 0x1p63, 1e19, 1e300};
  static const size_t together[] = {1, 2, 10, 1, 1, 1, 1};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    const struct measured m = {.n = 2, .mass = (double[]){1, 3}, .above = (double[]){counts[i], 2}};
    OK(measured_compare(&m, &runs, 1, &match, &error));
    assert_int_equal(match.together, together[i]);
    assert_true(isnan(match.share) == (i > 2) && match.needed >= MATCH_RUNS);
  }
}
