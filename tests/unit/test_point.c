/* A point read from a store: its runs in order, without those that do not count; its estimates and picture. */
#include "db/ask/ask.h"
#include "db/store/internal.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

enum { RUNS = 8, FAILED = 3 };

static struct store *fill(char path[64], int64_t *point) {
  struct store *store;
  OK(store_open_writer(fixture_path(path, "point-fragments"), &store, NULL, 0, &error));
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 9, 1e33);
  int64_t campaign, session;
  OK(store_add_campaign(store, "c", "text", "{}", &campaign, &error));
  OK(store_begin_session(store, "{\"command\": [\"clast\", \"run\", \"-j\", \"2\", \"-s\", \"a=8 cm\", \"c.yaml\"]}",
                         &session, &error));
  OK(store_set_session(store, session, campaign, &error));
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, point, &error));
  for (int64_t r = RUNS - 1; r >= 0; r--) { /* added in another order than that of replicates */
    struct fixture_run f;
    struct estimate estimates[ESTIMATES_COUNT];
    fixture_fill(&f, &scene, *point, session, r, FIXTURE_FRAGMENTS);
    for (int i = 0; i < FIXTURE_FRAGMENTS; i++)
      f.fragments[i].count = (uint32_t)(1 + f.fragments[i].mass / 4e-4);
    OK(estimates_make(FIXTURE_FRAGMENTS, f.fragments, 0, estimates, &error));
    f.run.estimates = estimates;
    f.run.estimate_count = ESTIMATES_COUNT;
    if (r == FAILED)
      f.outcome.state = OUTCOME_NOT_FINITE;
    OK(store_add_run(store, &f.run, &error));
  }
  OK(store_flush(store, &error));
  return store;
}

static double number_of(struct store *store, const char *format, ...) {
  char sql[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sql, sizeof sql, format, arguments);
  va_end(arguments);
  return number(store, sql);
}

/* A study of the resolution uses the campaign that made the point, with its inputs. */
TEST(resolution_names_the_campaign) {
  char path[64];
  int64_t id;
  struct store *store = fill(path, &id);
  struct ask_resolution found;
  OK(ask_resolution(store, id, "largest_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_NOT_STUDIED);
  assert_true(isnan(found.half_width));
  assert_string_equal(found.command, ""); /* its file is not here */
  FILE *campaign = fopen("c.yaml", "w");
  assert_non_null(campaign);
  fclose(campaign);
  OK(ask_resolution(store, id, "largest_fraction", &found, &error));
  unlink("c.yaml");
  assert_string_equal(found.command, "-s 'a=8 cm' c.yaml -Q largest_fraction");
  OK(ask_resolution(store, id + 1, "largest_fraction", &found, &error));
  assert_string_equal(found.command, "");
  OK(store_close(store, &error));
}

/* The same statistics from three sources: C from the masses, the views' plain SQL, and the query of spectra. */
TEST(views_and_c_agree) {
  char path[64];
  int64_t id;
  struct store *store = fill(path, &id);
  struct point_data point;
  OK(point_read(store, id, 0, &point, &error));

  double largest[RUNS];
  for (size_t r = 0; r < point.runs.count; r++) {
    double total = 0;
    for (size_t i = point.runs.first[r]; i < point.runs.first[r + 1]; i++)
      total += point.runs.masses[i];
    largest[r] = point.runs.masses[point.runs.first[r]] / total;
  }
  struct sample_summary s = sample_summarise(point.runs.count, largest, 0.95);
  sample_of_share(&s, 0.95);
  assert_near(number(store, "SELECT n FROM points"), (double)s.n, 0);
  assert_near(number(store, "SELECT largest_fraction_mean FROM points"), s.mean, 1e-14);
  assert_near(number(store, "SELECT largest_fraction_sd FROM points"), s.standard_deviation, 1e-14);
  assert_near(number(store, "SELECT largest_fraction_se FROM points"), s.standard_error, 1e-14);
  assert_near(number(store, "SELECT largest_fraction_hw95 FROM points"), s.half_width, 1e-11);
  assert_near(number(store, "SELECT largest_fraction_low95 FROM points"), s.low, 1e-11);
  assert_near(number(store, "SELECT largest_fraction_high95 FROM points"), s.high, 1e-11);
  assert_near(number(store, "SELECT largest_fraction_weak FROM points"), s.weak, 0);

  OWNED struct pooled_bin *bins = NULL;
  size_t count;
  OK(pooled_spectrum(&point.runs, &(struct pooled_form){0}, &bins, &count, &error));
  assert_near(number(store, "SELECT count(*) FROM spectra"), (double)count, 0);
  for (size_t i = 0; i < count; i++) {
    double width = bins[i].upper - bins[i].lower, n = (double)point.runs.count;
    double mean = number_of(store, "SELECT count_mean FROM spectra WHERE bin = %d", bins[i].bin);
    double scatter = number_of(store, "SELECT count_sd FROM spectra WHERE bin = %d", bins[i].bin);
    double squares = number_of(store, "SELECT count_squared FROM point_spectrum WHERE bin = %d", bins[i].bin);
    double hw95 = pooled_spectrum_count_hw95(point.runs.count, (double)bins[i].count, squares);
    assert_near(mean / width, bins[i].value, 1e-13 * bins[i].value);
    assert_near(sample_student(point.runs.count, 0.95) * scatter / sqrt(n) / width, bins[i].half_width,
                1e-13 * bins[i].value);
    assert_near(hw95 / width, bins[i].half_width, 1e-13 * bins[i].value);
    assert_near(number_of(store, "SELECT count_hw95 FROM spectra WHERE bin = %d", bins[i].bin) / width,
                bins[i].half_width, 1e-11 * bins[i].value);
  }
  point_release(&point);
  OK(store_close(store, &error));
}

/* The rows of estimates follow the choice of runs. */
TEST(chosen_runs_have_their_exponents) {
  char path[64];
  int64_t id;
  struct store *store = fill(path, &id);
  struct pooled_exponent all, chosen;
  OK(store_close(store, &error));
  OK(store_open_reader(path, &store, &error));
  OK(point_exponent(store, id, 0, EXPONENT_MASSES, ESTIMATES_FROM_5, 0.95, &all, &error));
  OK(ask_choose(store, &(struct ask_choice){.where = "replicate > 4"}, &error));
  OK(ask_choose_estimates(store, &error));
  OK(point_exponent(store, id, 0, EXPONENT_MASSES, ESTIMATES_FROM_5, 0.95, &chosen, &error));
  assert_true(chosen.fit.beta != all.fit.beta);
  assert_near(number(store, "SELECT beta FROM point_estimate WHERE method = 'masses' AND \"window\" = 'from_5'"),
              chosen.fit.beta, 0);
  OK(store_close(store, &error));
}

/* A point without a window has no exponent of any run. */
TEST(no_window_no_exponents) {
  const size_t first[] = {0, 1, 2};
  const double masses[] = {1, 1};
  double values[] = {7, 7};
  struct point_data point = {.runs = {.count = 2, .first = first, .masses = masses}};
  assert_false(point_window(&point, ESTIMATES_FROM_5) > 0);
  OK(point_exponent_of_runs(&point, EXPONENT_MASSES, ESTIMATES_FROM_5, values, &error));
  assert_true(isnan(values[0]) && isnan(values[1]));
}

TEST(runs_that_count_in_order) {
  char path[64];
  int64_t id;
  struct store *store = fill(path, &id);
  struct point_data point;
  OK(point_read(store, id, 0, &point, &error));
  assert_int_equal(point.results_version, 3);
  assert_int_equal(point.runs.count, RUNS - 1);
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 9, 1e33);
  for (size_t k = 0; k < RUNS - 1; k++) {
    struct fixture_run f;
    fixture_fill(&f, &scene, id, 1, (int64_t)(k < FAILED ? k : k + 1), FIXTURE_FRAGMENTS);
    assert_int_equal(point.runs.first[k + 1] - point.runs.first[k], FIXTURE_FRAGMENTS);
    for (int i = 0; i < FIXTURE_FRAGMENTS; i++)
      assert_true(point.runs.masses[point.runs.first[k] + (size_t)i] == f.fragments[i].mass);
  }
  /* counts above are floor(m/4e-4) + 1: the mean grain is lighter than 4e-4, heavier than half of it */
  assert_true(point.element_mass > 2e-4 && point.element_mass < 4e-4);
  assert_near(point_window(&point, ESTIMATES_FROM_5), 4.5 * point.element_mass, 0);

  struct point_estimate rows[POINT_ESTIMATES], again[POINT_ESTIMATES];
  OK(point_estimates(&point, 0.95, rows, &error));
  OK(point_estimates(&point, 0.95, again, &error));
  for (int i = 0; i < POINT_ESTIMATES; i++) {
    const bool told = isfinite(rows[i].exponent.interval.half_width);
    /* least squares needs every bin filled */
    assert_true(told || rows[i].exponent.fit.method == EXPONENT_LEAST_SQUARES);
    if (!told)
      continue;
    assert_true(rows[i].exponent.interval.standard_error > 0);
    assert_true(rows[i].exponent.interval.half_width == again[i].exponent.interval.half_width);
    /* log m is uniform over three decades: beta is 1 */
    assert_near(rows[i].exponent.fit.beta, 1, 0.05 + 5 * rows[i].exponent.fit.standard_error);
  }
  for (int i = 0; i < POINT_ESTIMATES; i++) { /* the lookup by name finds each */
    static const char *const names[] = {"beta_least_squares_from_2",
                                        "beta_least_squares_from_5",
                                        "beta_least_squares_from_10",
                                        "beta_masses_from_2",
                                        "beta",
                                        "beta_masses_from_10"};
    struct pooled_exponent one;
    enum exponent_method method;
    enum estimates_window window;
    bool is = false;
    OK(estimates_named(names[i], &is, &method, &window, &error));
    assert_true(is);
    OK(point_exponent(store, id, 0, method, window, 0.95, &one, &error));
    assert_int_equal(one.fit.n, rows[i].exponent.fit.n);
    if (isfinite(rows[i].exponent.interval.half_width))
      assert_true(one.fit.beta == rows[i].exponent.fit.beta &&
                  one.interval.half_width == rows[i].exponent.interval.half_width);
    OK(estimates_named(i ? "largest_fraction" : "bet", &is, &method, &window, &error));
    assert_false(is);
    assert_int_equal(estimates_named(i ? "beta_ks_from_2" : "beta_masses", &is, &method, &window, &error),
                     STATUS_USAGE);
  }
  point_release(&point);
  assert_int_equal(point_read_where(store, id, 0, "no_such > 1", &point, &error), STATUS_USAGE);

  OK(point_read(store, id + 7, 0, &point, &error)); /* no such point */
  assert_int_equal(point.runs.count, 0);
  OK(point_estimates(&point, 0.95, rows, &error));
  for (int i = 0; i < POINT_ESTIMATES; i++)
    assert_true(isnan(rows[i].exponent.fit.beta));
  point_release(&point);
  OK(store_close(store, &error));
}

/* Of an exponent the contributions of the runs are compared, seed by seed: their mean is the point's exponent, and
 * Student's interval of their mean is that of the exponent. */
TEST(pairs_of_exponents) {
  char path[64], operand[80];
  int64_t id;
  OWNED_BY(point_release) struct point_data point;
  struct pooled_exponent fit;
  struct ask_pairs *pairs = NULL;
  struct ask_pairs_row row;
  double values[RUNS];
  struct store *store = fill(path, &id);
  OK(point_read(store, id, 0, &point, &error));
  OK(point_exponent(store, id, 0, EXPONENT_MASSES, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW, 0.95, &fit,
                    &error));
  OK(point_exponent_of_runs(&point, EXPONENT_MASSES, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW, values, &error));
  OK(store_close(store, &error));
  snprintf(operand, sizeof operand, "%s:%lld", path, (long long)id);
  OK(ask_pairs_read(operand, operand, "beta", &(struct ask_choice){0}, &pairs, &error));
  assert_true(ask_pairs_next(pairs, &row));
  assert_int_equal(row.difference.side[0].n, point.runs.count);
  assert_int_equal(row.difference.pairs, point.runs.count);
  assert_near(row.difference.side[0].mean, fit.fit.beta, 1e-9);
  assert_true(row.difference.difference == 0 && isnan(row.difference.half_width)); /* of a point with itself */
  struct sample_summary summary = sample_summarise(point.runs.count, values, 0.95);
  assert_near(summary.half_width, fit.interval.half_width, 1e-9);
  ask_pairs_free(pairs);
  assert_int_equal(ask_pairs_read(operand, operand, "beta_none", &(struct ask_choice){0}, &pairs, &error),
                   STATUS_USAGE);
}

static void line(void *context, const char *text) {
  snprintf(context, 4000, "%s", text);
}

/* A store of the time of five methods, continued by this program: half of its runs have rows of `binned` and `ks`, and
 * other ordinals. Estimates are found by method and window, so nothing is mixed, and `check` finds no fault. */
TEST(methods_of_older_stores) {
  char path[64], problem[4000] = "";
  int64_t id;
  struct store *store = fill(path, &id);
  const struct query_canned *canned = ask_canned_find("run-exponents", &error);
  char rows[4096], by_method[4096];
  snprintf(rows, sizeof rows, "SELECT count(*) FROM (%s)", canned->sql);
  snprintf(by_method, sizeof by_method, "SELECT min(n) FROM (%s) WHERE method = 'masses'", canned->sql);
  const double alone = number(store, by_method);
  OK(sql_execute(
      store->db,
      "UPDATE estimate SET ordinal = ordinal + 4 WHERE run_id % 2 AND method <> 'least_squares';"
      "INSERT INTO estimate (run_id, ordinal, \"window\", method, headline, beta) SELECT run_id, ordinal + 3, "
      "\"window\", 'binned', 0, 7 FROM estimate WHERE run_id % 2 AND method = 'least_squares';"
      "INSERT INTO estimate (run_id, ordinal, \"window\", method, headline, beta) SELECT run_id, 6, 'from_2', "
      "'ks', 0, 7 FROM run WHERE run_id % 2; UPDATE run SET digest = NULL",
      "test", &error));
  const double runs = number(store, "SELECT max(run_id) FROM run");
  for (int64_t run = 1; run <= (int64_t)runs; run++)
    fill_digest(store->db, run); /* as the program of that time computed it */
  OK(digest_tables_write(store->db, &store->tables, &error));
  if (store_check(store, line, problem, &error) != STATUS_OK)
    fail_msg("%s", problem);
  assert_near(number(store, rows), 2 * ESTIMATES_WINDOWS + 1 + 3 + 1, 0);
  assert_near(number(store, by_method), alone, 0); /* all runs, of both kinds */
  assert_near(number(store, "SELECT count(*) FROM estimates WHERE method = 'binned' AND beta = 7"),
              3 * number(store, "SELECT count(*) FROM run WHERE run_id % 2"), 0);
  struct point_data point;
  OK(point_read(store, id, 0, &point, &error));
  assert_true(point.element_mass > 2e-4 && point.element_mass < 4e-4);
  point_release(&point);
  OK(store_close(store, &error));
}

enum { MOST_PAIRS = 8 };

/* The pairs of two operands, and what the last call answers. Returns their number; inputs are of the last pair. */
static size_t pairs_of(const char *a, const char *b, status expected, struct ask_pairs_row rows[MOST_PAIRS],
                       char inputs[100]) {
  struct ask_pairs *pairs = NULL;
  size_t count = 0;
  OK(ask_pairs_read(a, b, "hardest", &(struct ask_choice){0}, &pairs, &error));
  while (count < MOST_PAIRS && ask_pairs_next(pairs, &rows[count]))
    snprintf(inputs, 100, "%s", rows[count++].inputs);
  assert_int_equal(ask_pairs_end(pairs, &error), expected);
  ask_pairs_free(pairs);
  return count;
}

/* Points of two stores are paired by their varied inputs; points of one store only are passed over. */
TEST(pairs_of_points) {
  /* In the order of the first store: m = 6 with k = 1e30 and 1e31, then m = 7. The second store has three values of k
   * for each m. */
  static const int64_t same[4][2] = {{1, 1}, {2, 2}, {3, 4}, {4, 5}};
  char a[64], b[64], point[80];
  struct store *store;
  struct ask_pairs_row rows[MOST_PAIRS];
  char text[100];
  OK(store_open_writer(fixture_path(a, "pairs-a"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 2, 4, false, &error)); /* m = 6 and 7, k = 1e30 and 1e31 */
  OK(store_close(store, &error));
  OK(store_open_writer(fixture_path(b, "pairs-b"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 3, 3, 6, false, &error));
  OK(store_close(store, &error));

  assert_int_equal(pairs_of(a, b, STATUS_OK, rows, text), 4);
  assert_string_equal(text, "material.k = 1.0e+31, material.m = 7.0");
  for (size_t i = 0; i < 4; i++) {
    const struct difference *d = &rows[i].difference;
    assert_true(d->side[0].n == 4 && d->side[1].n == 6 && d->pairs == 4); /* seeds 1000 .. 1003 are in both */
    assert_near(d->difference, 0, 1e-15);
    assert_int_equal(rows[i].point[0], same[i][0]);
    assert_int_equal(rows[i].point[1], same[i][1]);
  }
  assert_int_equal(pairs_of(b, a, STATUS_OK, rows, text), 4); /* surplus points on the other side */

  char first[80];
  snprintf(first, sizeof first, "%s:1", a);
  snprintf(point, sizeof point, "%s:9", b); /* m = 8, k = 1e32 against m = 6, k = 1e30: points need not be alike */
  assert_int_equal(pairs_of(first, point, STATUS_OK, rows, text), 1);
  assert_string_equal(text, "");
  assert_true(rows[0].point[0] == 1 && rows[0].point[1] == 9);

  struct ask_pairs *pairs = NULL;
  assert_int_equal(ask_pairs_read(first, b, "hardest", &(struct ask_choice){0}, &pairs, &error),
                   STATUS_USAGE); /* a point with all points */
  assert_null(pairs);
  snprintf(point, sizeof point, "%s:99", b);
  assert_int_equal(ask_pairs_read(first, point, "hardest", &(struct ask_choice){0}, &pairs, &error), STATUS_USAGE);
  snprintf(point, sizeof point, "%s:nobody", b);
  assert_int_equal(ask_pairs_read(a, point, "hardest", &(struct ask_choice){0}, &pairs, &error), STATUS_USAGE);
  snprintf(point, sizeof point, "%s:made-up", b);
  assert_int_equal(pairs_of(a, point, STATUS_OK, rows, text), 4);

  OK(store_open_writer(fixture_path(b, "pairs-c"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 1, 1, 4, false, &error));
  OK(store_close(store, &error));
  OK(store_open_writer(fixture_path(a, "pairs-d"), &store, NULL, 0, &error));
  struct fixture_inputs inputs;
  struct fixture_run f;
  int64_t campaign, session, id;
  OK(store_add_campaign(store, "c", "text", "{}", &campaign, &error));
  OK(store_begin_session(store, "{}", &session, &error));
  struct scene scene = fixture_scene(&inputs, 9, 1e33);
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, &id, &error));
  fixture_fill(&f, &scene, id, session, 0, FIXTURE_FRAGMENTS);
  OK(store_add_run(store, &f.run, &error));
  OK(store_close(store, &error));
  assert_int_equal(pairs_of(a, b, STATUS_USAGE, rows, text), 0); /* no point in common */
  assert_non_null(strstr(error.message, "no two points have the same varied inputs"));
}
