/* Queries of a store: views against numbers computed here, reading statements only, grouping, canned queries, our
 * aggregates. */
#define CHECK_OWN_MAIN
#include <gsl/gsl_cdf.h>

#include "analysis/statistics/statistics.h"
#include "db/store/internal.h"
#include "db/store/views.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

enum { M = 3, K = 2, RUNS = 25 };

static struct store *reader(void) {
  static const char path[] = "test-store-query.db";
  struct store *store = NULL;
  if (access(path, F_OK) != 0) {
    OK(store_open_writer(path, &store, NULL, 0, &error));
    OK(fixture_populate(store, M, K, RUNS, true, &error));
    OK(store_close(store, &error));
  }
  OK(store_open_reader(path, &store, &error));
  return store;
}

static int forget(void **state) {
  (void)state;
  char path[64];
  fixture_path(path, "query");
  return 0;
}

struct rows {
  char text[16384];
  size_t count, columns;
};

/* Reads a whole answer as text. */
static status keep(struct answer answer, struct rows *rows) {
  memset(rows, 0, sizeof *rows);
  rows->columns = answer_count(&answer);
  for (size_t i = 0; i < rows->columns; i++)
    text_append(rows->text, sizeof rows->text, "%s%s", i ? "," : "", answer_name(&answer, i));
  text_append(rows->text, sizeof rows->text, "\n");
  for (; answer_next(&answer); rows->count++) {
    for (size_t i = 0; i < rows->columns; i++)
      if (answer_value(&answer, i).kind == QUERY_TEXT)
        text_append(rows->text, sizeof rows->text, "%s%s", i ? "," : "", answer_text(&answer, i));
      else
        text_append(rows->text, sizeof rows->text, "%s%.6g", i ? "," : "", answer_real(&answer, i));
    text_append(rows->text, sizeof rows->text, "\n");
  }
  return answer_end(&answer);
}

static status ask(struct store *store, const char *sql, struct rows *rows) {
  return keep(answer_to_user(store, sql, 0, NULL, 5, &error), rows);
}

/* The values of one quantity of the runs of a point, computed again. */
static double two_pass(double (*value)(const struct fixture_run *), int m, int k_first, int k_count, double *sd) {
  static struct fixture_run f;
  struct fixture_inputs inputs;
  double mean = 0, squares = 0;
  for (int pass = 0; pass < 2; pass++)
    for (int k = k_first; k < k_first + k_count; k++)
      for (int r = 0; r < RUNS; r++) {
        struct scene scene = fixture_scene(&inputs, m, pow(10, 30 + k));
        fixture_fill(&f, &scene, 0, 0, r, FIXTURE_FRAGMENTS);
        if (pass == 0)
          mean += value(&f) / (RUNS * k_count);
        else
          squares += (value(&f) - mean) * (value(&f) - mean);
      }
  *sd = sqrt(squares / (RUNS * k_count - 1));
  return mean;
}

static double largest(const struct fixture_run *f) {
  return f->outcome.largest_fraction;
}

TEST(points_have_mean_scatter_and_interval) {
  struct store *store = reader();
  double sd, mean = two_pass(largest, 7, 1, 1, &sd);
  char sql[300];
  const char *const columns[] = {"largest_fraction_mean", "largest_fraction_sd", "largest_fraction_se",
                                 "largest_fraction_hw95"};
  const double share = 1 + SAMPLE_SKEW * sd / fmin(mean, 1 - mean); /* RUNS are not above SAMPLE_SKEW_RUNS */
  const double expected[] = {mean, sd, sd / sqrt(RUNS), share * sd / sqrt(RUNS) * gsl_cdf_tdist_Pinv(0.975, RUNS - 1)};
  for (size_t i = 0; i < 4; i++) {
    snprintf(sql, sizeof sql, "SELECT %s FROM points WHERE material_m = 7 AND material_k = 1e31", columns[i]);
    assert_near(number(store, sql), expected[i], 1e-6 * expected[i] * (i == 3) + 1e-13); /* t within 5e-6; sums of 25 */
  }
  assert_near(number(store, "SELECT count(*) FROM points WHERE n = 25 AND failed = 0 AND results_version = 3"), M * K,
              0);
  store_close(store, NULL);
}

/* The quantile of Student's t in plain SQL against that in C, which is GSL's: exact to ten degrees, then within 5e-6
 * (the first term left out of Cornish & Fisher's expansion). */
TEST(student_is_students) {
  struct store *store = reader();
  for (int degrees = 1; degrees <= 300; degrees += degrees < 40 ? 1 : 37) {
    char *sql = NULL, number_text[16];
    size_t size = 0;
    FILE *out = open_memstream(&sql, &size);
    snprintf(number_text, sizeof number_text, "%d", degrees);
    fputs("SELECT ", out);
    views_statistics_student(number_text, out);
    fclose(out);
    double expected = sample_student((size_t)degrees + 1, 0.95);
    assert_near(expected, gsl_cdf_tdist_Pinv(0.975, degrees), 0);
    assert_near(number(store, sql), expected, degrees <= 10 ? 1e-11 * expected : 5e-6);
    free(sql);
  }
  store_close(store, NULL);
}

/* The interval of a mean in plain SQL against that in C, of shares and of results that end elsewhere or nowhere. */
TEST(interval_is_that_in_c) {
  enum { RANGES = 4 };
  static const struct sample_range ranges[RANGES] = {{-HUGE_VAL, HUGE_VAL, false},
                                                     {0, 1, true},
                                                     {0, HUGE_VAL, false},
                                                     {-0.25, 1.125, false}};
  struct store *store = reader();
  static const double means[] = {0, 1e-9, 0.02, 0.3, 0.5, 0.97, 1}, deviations[] = {0, 1e-16, 0.003, 0.02, 0.06, 0.3};
  static const size_t numbers[] = {1, 2, 3, 5, 10, 19, 20, 25, 26, 39, 40, 200};
  for (size_t i = 0; i < 7 * 6 * 12 * RANGES; i++) {
    const double mean = means[i % 7], deviation = deviations[i / 7 % 6];
    const size_t n = numbers[i / 42 % 12];
    const struct sample_range *range = &ranges[i / 504];
    OWNED char *sql = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&sql, &size);
    fputs("SELECT format('%.17g,%.17g,%.17g,%d,%s', coalesce(q_hw95, 'nan'), q_low95, q_high95, q_weak, "
          "typeof(q_hw95) || typeof(q_low95) || typeof(q_high95)) FROM (SELECT 0",
          out);
    views_statistics_columns(0, "q", "d", "n", range, out);
    fputs(" FROM (SELECT *, ", out);
    views_statistics_half_width(0, "n", "t", range, out);
    fprintf(out, " FROM (SELECT %.17g AS m0, %s%.17g%s AS d0, NULL AS e0, NULL AS v0, %zu AS n, %.17g AS t)))", mean,
            n > 1 ? "" : "nullif(", deviation, n > 1 ? "" : ", 0) * NULL", n, n > 1 ? sample_student(n, 0.95) : 0);
    fclose(out);
    struct rows rows = {.count = 0};
    OK(ask(store, sql, &rows));
    struct sample_moments moments = {n, mean, deviation * deviation * ((double)n - 1), 1};
    struct sample_summary s = sample_summarise_moments(&moments, 0.95);
    sample_in_range(&s, range, 0.95);
    assert_true(!isfinite(s.half_width) || (s.low >= range->least && s.high <= range->most));
    double half = NAN, low = NAN, high = NAN;
    int weak = 0;
    char types[64] = "", expected[64];
    assert_int_equal(sscanf(strchr(rows.text, '\n') + 1, "%lf,%lf,%lf,%d,%63[a-z]", &half, &low, &high, &weak, types),
                     5);
    snprintf(expected, sizeof expected, "%s%s%s", isnan(s.half_width) ? "null" : "real", isnan(s.low) ? "null" : "real",
             isnan(s.high) ? "null" : "real");
    assert_string_equal(types, expected);
    assert_true(isnan(s.half_width) || fabs(half / s.half_width - 1) < 1e-11);
    assert_true(isnan(s.low) || (fabs(low - s.low) < 1e-11 && fabs(high - s.high) < 1e-11));
    assert_int_equal(weak, s.weak);
  }
  store_close(store, NULL);
}

TEST(spread_of_equal_values_is_zero) {
  struct store *store = reader(); /* every run has FIXTURE_FRAGMENTS fragments */
  assert_near(number(store, "SELECT max(fragment_count_sd) FROM points"), 0, 0);
  assert_near(number(store, "SELECT count(fragment_count_hw95) FROM points"), 0, 0); /* no +- 0 */
  assert_near(number(store, "SELECT min(fragment_count_mean) FROM points"), FIXTURE_FRAGMENTS, 0);
  store_close(store, NULL);
}

/* Deviations whose squares no double holds: SQL has no standard deviation and no interval of them. */
TEST(squares_beyond_double_are_withheld) {
  static const char *const factors[] = {"1e-170", "1e170", "1"};
  char path[64];
  for (size_t k = 0; k < 3; k++) {
    struct store *store = NULL;
    sqlite3 *db = NULL;
    char sql[128];
    OK(store_open_writer(fixture_path(path, "ends"), &store, NULL, 0, &error));
    OK(fixture_populate(store, 2, 2, 3, false, &error));
    OK(store_close(store, &error));
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    snprintf(sql, sizeof sql, "UPDATE run SET mean_fragment_mass = (1 + 0.1 * replicate) * %s", factors[k]);
    assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    OK(store_open_reader(path, &store, &error));
    assert_near(number(store, "SELECT count(mean_fragment_mass_mean) FROM points"), 4, 0);
    assert_near(number(store, "SELECT count(mean_fragment_mass_sd) FROM points"), k < 2 ? 0 : 4, 0);
    assert_near(number(store, "SELECT count(mean_fragment_mass_hw95) FROM points"), k < 2 ? 0 : 4, 0);
    store_close(store, NULL);
  }
  fixture_path(path, "ends");
}

/* Exponents of runs that differ by 1e-9 scatter by 1e-9: nothing cancels. */
TEST(scatter_of_exponents) {
  char path[64];
  struct store *store = NULL;
  sqlite3 *db = NULL;
  struct rows rows;
  OK(store_open_writer(fixture_path(path, "near"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 1, 1, 3, false, &error));
  OK(store_close(store, &error));
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db,
                                "UPDATE estimate SET beta = 2 + 1e-9 * (SELECT replicate FROM run r WHERE r.run_id = "
                                "estimate.run_id), standard_error = 0.1",
                                NULL, NULL, NULL),
                   SQLITE_OK);
  sqlite3_close(db);
  OK(store_open_reader(path, &store, &error));
  OK(ask(store, ask_canned_find("run-exponents", NULL)->sql, &rows));
  assert_true(rows.count > 0);
  if (!strstr(rows.text, ",3,2,1e-09,0.1\n"))
    fail_msg("%s", rows.text);
  store_close(store, NULL);
  fixture_path(path, "near");
}

TEST(spectra_are_densities) {
  struct store *store = reader();
  assert_near(number(store, "SELECT sum(density * (upper - lower)) FROM spectra WHERE point_id = 3"), 1, 1e-12);
  assert_near(number(store, "SELECT sum(count) FROM spectra WHERE point_id = 3"), RUNS * FIXTURE_FRAGMENTS, 0);
  assert_near(number(store, "SELECT lower FROM spectra WHERE bin = -20"), 1e-2, 0);
  /* scatter of one bin between runs, two-pass, runs without the bin included as zeros */
  double expected = number(store,
                           "WITH c AS (SELECT ifnull(s.count, 0) AS x FROM run r LEFT JOIN spectrum s ON s.run_id = "
                           "r.run_id AND s.bin = -15 WHERE r.point_id = 2) SELECT sqrt(sum((x - m) * (x - m)) / 24) "
                           "FROM c, (SELECT avg(x) AS m FROM c)");
  assert_true(expected > 0);
  assert_near(number(store, "SELECT count_sd FROM spectra WHERE point_id = 2 AND bin = -15"), expected, 1e-12);
  store_close(store, NULL);
}

/* Points are the units of a group that pools over an input; the runs are the units of a point. */
TEST(groups_say_what_they_pool) {
  struct ask_group_pooled pooled;
  struct store *store = reader();
  struct rows rows = {.count = 0};
  OK(keep(ask_group(store, "m", "hardest, largest_fraction", &pooled, &error), &rows));
  assert_int_equal(rows.count, M);
  assert_string_equal(pooled.inputs, "material.k");
  assert_false(pooled.single);
  double sd, first = two_pass(largest, 6, 0, 1, &sd), second = two_pass(largest, 6, 1, 1, &sd);
  double scatter = fabs(first - second) / sqrt(2); /* of the means of two points */
  assert_true(scatter > 1e-3);
  const double mean = (first + second) / 2;
  static struct fixture_run f;
  struct fixture_inputs inputs;
  struct sample_of_seed values[2][2 * RUNS];
  for (int i = 0; i < 2 * RUNS; i++) {
    struct scene scene = fixture_scene(&inputs, 6, i < RUNS ? 1e30 : 1e31);
    fixture_fill(&f, &scene, 0, 0, i % RUNS, FIXTURE_FRAGMENTS);
    values[0][i] = (struct sample_of_seed){i % RUNS, f.result.hardest};
    values[1][i] = (struct sample_of_seed){i % RUNS, largest(&f)};
  }
  struct sample_crossed of[2];
  for (int i = 0; i < 2; i++)
    assert_true(sample_crossed(2, (const size_t[]){0, RUNS, 2 * RUNS}, values[i], &of[i]));
  const double se = of[0].deviation / sqrt(of[0].units), wide = se * sample_student(RUNS, 0.95);
  assert_true(se > 0.1); /* the mean of `hardest` is 6 at every point: no scatter of points, but that of the seeds */
  assert_near(of[0].units, RUNS, 1e-9);
  char expected[200];
  snprintf(expected, sizeof expected,
           "\n6,fake,3,2,50,0,0,0,6,0,%.6g,%.6g,%.6g,%.6g,nan,nan,not-studied,%.6g,%.6g,%.6g,", se, wide, 6 - wide,
           6 + wide, mean, scatter, of[1].deviation / sqrt(of[1].units));
  if (!strstr(rows.text, expected))
    fail_msg("%s not in %s", expected, rows.text);
  assert_non_null(
      strstr(rows.text,
             "material_m,engine,results_version,points,n,failed,censored,excluded,hardest_mean,hardest_sd,hardest_se,"
             "hardest_hw95,hardest_low95,hardest_high95,hardest_weak,hardest_resolution,"
             "hardest_resolution_verdict,largest_fraction_mean"));
  OK(keep(ask_group(store, "material.k,m", NULL, &pooled, &error), &rows));
  assert_int_equal(rows.count, M * K);
  assert_string_equal(pooled.inputs, "");
  assert_true(pooled.single);
  assert_false(pooled.lacks_seeds);
  OK(keep(ask_group(store, "", "broken_count", &pooled, &error), &rows));
  assert_int_equal(rows.count, 1);
  assert_false(pooled.lacks_seeds);
  assert_string_equal(pooled.inputs, "material.k, material.m");
  assert_int_equal(keep(ask_group(store, "q", NULL, &pooled, &error), &rows), STATUS_USAGE);
  assert_non_null(strstr(error.message, "material.m"));
  assert_int_equal(keep(ask_group(store, "m", "fraction", &pooled, &error), &rows), STATUS_USAGE);
  assert_non_null(strstr(error.message, "ambiguous"));
  assert_non_null(strstr(error.message, "largest_fraction, second_fraction"));
  assert_int_equal(keep(ask_group(store, "m", "largest_fracton", &pooled, &error), &rows), STATUS_USAGE);
  assert_string_equal(error.message, "Quantity 'largest_fracton' is unknown; did you mean 'largest_fraction'?");
  store_close(store, NULL);
}

TEST(only_reading_is_allowed) {
  struct store *store = reader();
  struct rows rows;
  const char *const refused[] = {"DELETE FROM run",
                                 "UPDATE run SET seed = 1",
                                 "DROP TABLE run",
                                 "INSERT INTO axis VALUES "
                                 "(1,2,3,4)",
                                 "ATTACH 'x.db' AS x",
                                 "PRAGMA query_only = OFF",
                                 "PRAGMA journal_mode = WAL",
                                 "BEGIN",
                                 "CREATE TEMP TABLE t (a)",
                                 "VACUUM INTO 'y.db'",
                                 "SELECT load_extension('x')",
                                 "SELECT 1; SELECT 2",
                                 "SELECT 1; DELETE FROM run",
                                 "",
                                 " -- nothing",
                                 "SELECT nothing",
                                 "SELECT * FROM nowhere",
                                 "SELEKT",
                                 "SELECT :a",
                                 "UPDATE sqlite_master SET name = 'x'"};
  for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++)
    if (ask(store, refused[i], &rows) != STATUS_USAGE)
      fail_msg("not refused: %s (%s)", refused[i], error.message);
  assert_int_not_equal(access("x.db", F_OK), 0);
  OK(ask(store, "SELECT value FROM json_each('[1,2]') -- comment", &rows));
  OK(ask(store, "PRAGMA table_info(run)", &rows));
  OK(ask(store, "SELECT 1;", &rows));
  OK(ask(store, "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 5) SELECT sum(i) FROM n",
         &rows));
  assert_string_equal(rows.text, "sum(i)\n15\n");
  OK(ask(store, "SELECT run_id FROM run WHERE run_id < 0", &rows)); /* names also without rows */
  assert_string_equal(rows.text, "run_id\n");
  store_close(store, NULL);
}

TEST(time_limit_stops) {
  struct store *store = reader();
  struct rows rows;
  assert_int_equal(keep(answer_to_user(store,
                                       "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) "
                                       "FROM n",
                                       0, NULL, 0.05, &error),
                        &rows),
                   STATUS_STOPPED);
  assert_near(number(store, "SELECT count(*) FROM run"), M * K * RUNS, 0); /* and the next query works */
  /* An answer that is over takes no limit from the next one, also where it is ended twice. */
  struct answer over = answer_to_user(store, "SELECT 1", 0, NULL, 0.05, &error);
  OK(answer_end(&over));
  struct answer next = answer_to_user(store,
                                      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 20000000) "
                                      "SELECT max(i) FROM n",
                                      0, NULL, 0.05, &error);
  OK(answer_end(&over));
  assert_int_equal(keep(next, &rows), STATUS_STOPPED);
  store_close(store, NULL);
}

TEST(every_canned_query_runs) {
  struct store *store = reader();
  struct rows rows = {.count = 0};
  assert_true(ask_canned_count() >= 10);
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *canned = ask_canned_at(i);
    const struct query_parameter parameter = {.name = canned->parameters, .value = "1"};
    if (strcmp(canned->name, "run-exponents") == 0)
      continue; /* needs analysis' columns: see test_store_schema */
    status result = keep(answer_to_user(store, canned->sql, *canned->parameters ? 1 : 0, &parameter, 0, &error), &rows);
    if (result != STATUS_OK)
      fail_msg("%s: %s", canned->name, error.message);
    if (rows.count == 0 && strcmp(canned->name, "failures") != 0 && strcmp(canned->name, "censored") != 0 &&
        strcmp(canned->name, "exponents") != 0)
      fail_msg("%s gave nothing", canned->name);
  }
  /* the documented query gives what the view gives */
  OK(ask(store, ask_canned_find("point-stats", NULL)->sql, &rows));
  char first[200];
  snprintf(first, sizeof first, "\n1,3,25,%.6g,%.6g,%.6g\n",
           number(store, "SELECT largest_fraction_mean FROM points WHERE point_id = 1"),
           number(store, "SELECT largest_fraction_sd FROM points WHERE point_id = 1"),
           number(store, "SELECT largest_fraction_se FROM points WHERE point_id = 1"));
  if (!strstr(rows.text, first))
    fail_msg("%s not in %s", first, rows.text);
  assert_null(ask_canned_find("nonsense", &error));
  assert_non_null(strstr(error.message, "point-stats"));
  store_close(store, NULL);
}

TEST(our_aggregates) {
  struct store *store = reader();
  struct rows rows;
  assert_int_equal(ask(store, "SELECT median(1)", &rows), STATUS_USAGE); /* not before they are registered */
  OK(ask_register_functions(store, &error));
  assert_near(number(store, "SELECT stdev(value) FROM json_each('[2,4,4,4,5,5,7,9]')"), sqrt(32.0 / 7), 1e-14);
  assert_near(number(store, "SELECT median(value) FROM json_each('[5,1,4,2]')"), 3, 0);
  assert_near(number(store, "SELECT median(value) FROM json_each('[5,1,4]')"), 4, 0);
  assert_near(number(store, "SELECT mean(value) = avg(value) FROM json_each('[0.1,0.7,0.3,11,1e9]')"), 1, 0);
  assert_near(number(store, "SELECT mean(value) FROM json_each('[1.6e308,1.7e308]')"), 1.65e308, 1e294);
  assert_near(number(store, "SELECT mean(NULL) IS NULL AND stdev(value) > 0 FROM json_each('[1e-170,2e-170]')"), 1, 0);
  assert_near(number(store, "SELECT stdev(1) IS NULL AND median(NULL) IS NULL"), 1, 0);
  store_close(store, NULL);
}

TEST(parameters_are_bound) {
  struct store *store = reader();
  const struct query_parameter two[] = {{"a", "3"}, {"b", "0.5"}};
  const struct query_parameter text = {"a", "x'; DROP"}, seed = {"a", "9007199254740993"}; /* no double has it */
  struct rows rows;
  OK(keep(answer_to_user(store, "SELECT :a * :b AS x", 2, two, 0, &error), &rows));
  assert_string_equal(rows.text, "x\n1.5\n");
  OK(keep(answer_to_user(store, "SELECT typeof(:a) = 'text' AS x", 1, &text, 0, &error), &rows));
  assert_string_equal(rows.text, "x\n1\n");
  OK(keep(answer_to_user(store, "SELECT :a = 9007199254740993 AS x", 1, &seed, 0, &error), &rows));
  assert_string_equal(rows.text, "x\n1\n");
  assert_int_equal(keep(answer_to_user(store, "SELECT :a", 2, two, 0, &error), &rows), STATUS_USAGE);
  store_close(store, NULL);
}

/* Answers nest, may be left early, and say nothing after their end. No statement stays open. */
TEST(answers_close_themselves) {
  struct store *store = reader();
  {
    ANSWER points = answer_to(store, &error, "SELECT point_id FROM point ORDER BY point_id");
    double runs = 0;
    assert_true(answer_next(&points));
    OK(answer_number(store, &runs, &error, "SELECT count(*) FROM run WHERE point_id = %lld",
                     (long long)answer_integer(&points, 0)));
    assert_near(runs, RUNS, 0);
    assert_true(answer_next(&points));
    assert_int_equal(answer_integer(&points, 0), 2);
  }
  ANSWER one = answer_to(store, &error, "SELECT NULL, 2, 0.5, 'text', x'0102'");
  assert_true(answer_next(&one));
  assert_true(isnan(answer_real(&one, 0)) && answer_integer(&one, 0) == 0 && !*answer_text(&one, 0));
  assert_true(answer_real(&one, 1) == 2 && answer_integer(&one, 1) == 2 && answer_real(&one, 2) == 0.5);
  assert_true(answer_integer(&one, 2) == 0 && isnan(answer_real(&one, 3)));
  assert_string_equal(answer_text(&one, 3), "text");
  assert_int_equal(answer_value(&one, 4).size, 2);
  assert_false(answer_next(&one));
  assert_false(answer_next(&one));
  OK(answer_end(&one));
  const void *masses;
  size_t n;
  ANSWER blob = answer_to(store, &error, "SELECT x'0102'");
  assert_true(answer_next(&blob) && !answer_masses(&blob, 0, "run 7", &masses, &n));
  assert_int_equal(answer_end(&blob), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "run 7"));
  assert_null(sqlite3_next_stmt(store->db, NULL));
  store_close(store, NULL);
}

/* A program without the row fidelity.grains computes a campaign; then the program with it computes the same one again:
 * other identities, the same seeds. Points that differ in a value, or share no seed, are no twins. */
TEST(the_same_seeds_are_seen) {
  char path[64];
  struct store *store = NULL;
  struct ask_group_twins twins;
  struct fixture_inputs inputs;
  struct fixture_run f;
  int64_t campaign, session, older, newer;
  const struct field_table fewer = {.rows = fixture_input_rows,
                                    .count = sizeof fixture_input_rows / sizeof *fixture_input_rows - 1,
                                    .size = sizeof inputs,
                                    .name = "fake scene",
                                    .doc = "A scene for tests."};
  struct engine_kind before = fixture_kind;
  before.inputs = &fewer;
  OK(store_open_writer(fixture_path(path, "twins"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 2, 3, false, &error)); /* points 1 to 4 */
  OK(ask_group_twins(store, &twins, &error));
  assert_int_equal(twins.pairs, 0);

  OK(store_add_campaign(store, "older", "name: older", "{}", &campaign, &error));
  OK(store_begin_session(store, "{}", &session, &error));
  struct scene scene = fixture_scene(&inputs, 6, 1e31);
  scene.kind = &before;
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, &older, &error));
  fixture_fill(&f, &scene, older, session, 7, FIXTURE_FRAGMENTS); /* a seed of its own */
  OK(store_add_run(store, &f.run, &error));
  OK(store_flush(store, &error));
  OK(ask_group_twins(store, &twins, &error));
  assert_int_equal(twins.pairs, 0);

  fixture_fill(&f, &scene, older, session, 1, FIXTURE_FRAGMENTS);
  OK(store_add_run(store, &f.run, &error));
  OK(store_flush(store, &error));
  newer = (int64_t)number(store, "SELECT point_id FROM points WHERE material_m = 6 AND material_k = 1e31 ORDER BY 1");
  assert_int_not_equal(newer, older);
  OK(ask_group_twins(store, &twins, &error));
  assert_int_equal(twins.pairs, 1);
  assert_int_equal(twins.point[0], newer); /* stored first here */
  assert_int_equal(twins.point[1], older);
  assert_string_equal(twins.input, "fidelity.grains");
  for (int side = 0; side < 2; side++) { /* runs that no statistics count are no twins */
    OK(store_set_prefix(store, twins.point[side], 0, &error));
    struct ask_group_twins none;
    OK(ask_group_twins(store, &none, &error));
    assert_int_equal(none.pairs, 0);
    OK(store_set_prefix(store, twins.point[side], 100, &error));
  }

  scene = fixture_scene(&inputs, 6, 1e31); /* another value: a separate point */
  inputs.grains = 50;
  OK(store_add_point(store, campaign, &scene, 2, fixture_axes, &newer, &error));
  fixture_fill(&f, &scene, newer, session, 0, FIXTURE_FRAGMENTS);
  OK(store_add_run(store, &f.run, &error));
  OK(store_flush(store, &error));
  OK(ask_group_twins(store, &twins, &error));
  assert_int_equal(twins.pairs, 1);
  OK(store_close(store, &error));
  fixture_path(path, "twins");
}

int main(void) {
  return check_run(forget, NULL);
}
