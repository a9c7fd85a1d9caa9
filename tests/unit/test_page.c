/* The data of a page against the store that it is made from: all statistics, a sample of the runs, no names. Also the
 * file that contains the data. */
#include <sqlite3.h>

#include "analysis/report/page.h"
#include "analysis/statistics/statistics.h"
#include "db/ask/ask.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

enum { M = 2, K = 2 };

/* A store of M x K points with this many runs each. */
static struct store *filled(const char *name, int runs, char path[64]) {
  struct store *store = NULL;
  fixture_path(path, name);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(fixture_populate(store, M, K, runs, true, &error));
  OK(store_close(store, &error));
  OK(store_open_reader(path, &store, &error));
  return store;
}

/* The page as SQLite reads its file. */
static sqlite3 *opened(struct ask_page *page) {
  OWNED unsigned char *bytes = NULL;
  size_t size = 0;
  sqlite3 *db = NULL;
  OK(ask_page_file(page, &bytes, &size, &error));
  assert_int_equal(sqlite3_open(":memory:", &db), SQLITE_OK);
  unsigned char *copy = sqlite3_malloc64(size);
  memcpy(copy, bytes, size);
  assert_int_equal(sqlite3_deserialize(db, "main", copy, (sqlite3_int64)size, (sqlite3_int64)size,
                                       SQLITE_DESERIALIZE_FREEONCLOSE),
                   SQLITE_OK);
  return db;
}

static double asked(sqlite3 *db, const char *sql) {
  sqlite3_stmt *statement = NULL;
  assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &statement, NULL), SQLITE_OK);
  assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
  const double value = sqlite3_column_double(statement, 0);
  sqlite3_finalize(statement);
  return value;
}

struct values {
  double value[20000];
  size_t count;
};

/* Mean and interval of a result that the view points does not have are those of all runs of the store. */
static void check_means(struct store *store, sqlite3 *db) {
  static struct values values;
  values.count = 0;
  ANSWER runs = answer_to(store, &error, "SELECT hardest FROM runs WHERE counts AND point_id = 2 ORDER BY replicate");
  while (answer_next(&runs))
    values.value[values.count++] = answer_real(&runs, 0);
  OK(answer_end(&runs));
  const struct sample_summary all = sample_summarise(values.count, values.value, 0.95);
  assert_true(all.n > 10);
  assert_near(asked(db, "SELECT n FROM means WHERE quantity = 'hardest' AND point_id = 2"), (double)all.n, 0);
  assert_near(asked(db, "SELECT mean FROM means WHERE quantity = 'hardest' AND point_id = 2"), all.mean,
              1e-6 * fabs(all.mean));
  assert_near(asked(db, "SELECT hw95 FROM means WHERE quantity = 'hardest' AND point_id = 2"), all.half_width,
              1e-6 * all.half_width);
  /* All runs have the same: the spectrum needs it all the same, to draw lighter fragments as incomplete. */
  const char *const complete = "SELECT count(DISTINCT complete_mass) FROM runs WHERE counts";
  assert_near(number(store, complete), 1, 0);
  assert_near(asked(db, "SELECT count(*) FROM means WHERE quantity = 'complete_mass'"),
              number(store, "SELECT count(*) FROM points"), 0);
}

TEST(test_a_small_store_is_whole) {
  char path[64];
  struct store *store = filled("page-small", 25, path);
  struct ask_page *page = NULL;
  OK(ask_page_make(store, &page, &error));
  sqlite3 *db = opened(page);
  assert_near(asked(db, "SELECT count(*) FROM runs"), number(store, "SELECT count(*) FROM runs WHERE surplus = 0"), 0);
  assert_near(asked(db, "SELECT count(*) FROM points"), number(store, "SELECT count(*) FROM points"), 0);
  assert_near(asked(db, "SELECT count(*) FROM spectra"), number(store, "SELECT count(*) FROM spectra"), 0);
  const char *const mean = "SELECT sum(largest_fraction_mean * point_id) FROM points";
  assert_near(asked(db, mean), number(store, mean), 1e-6 * number(store, mean));
  assert_near(asked(db, "SELECT value FROM fact WHERE name = 'results_left_out'"), 0, 0);
  check_means(store, db);
  /* inputs are exact: an equality condition finds them */
  assert_near(asked(db, "SELECT count(*) FROM runs JOIN axis WHERE column_name = 'material_k' AND material_k = 1e30"),
              number(store, "SELECT count(*) FROM runs WHERE material_k = 1e30 AND surplus = 0"), 0);
  assert_true(asked(db, "SELECT count(*) FROM question") > 5);
  sqlite3_close(db);
  ask_page_free(page);
  store_close(store, NULL);
}

/* A result that is the same in all runs is left out, but not where a campaign asks for it. */
TEST(test_the_quantity_of_a_campaign_is_told) {
  for (int asked_for = 0; asked_for < 2; asked_for++) {
    char path[64];
    store_close(filled("page-quantity", 5, path), NULL);
    struct store *store = NULL;
    struct ask_page *page = NULL;
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "UPDATE result_fake SET hardest = 4", NULL, NULL, NULL), SQLITE_OK);
    if (asked_for)
      assert_int_equal(sqlite3_exec(db, "UPDATE campaign SET plan = '{\"quantity\": \"hardest\"}'", NULL, NULL, NULL),
                       SQLITE_OK);
    sqlite3_close(db);
    OK(store_open_reader(path, &store, &error));
    OK(ask_page_make(store, &page, &error));
    db = opened(page);
    assert_near(asked(db, "SELECT count(*) FROM pragma_table_info('runs') WHERE name = 'hardest'"), asked_for, 0);
    assert_near(asked(db, "SELECT count(*) FROM means WHERE quantity = 'hardest'"), asked_for ? M * K : 0, 0);
    sqlite3_close(db);
    ask_page_free(page);
    store_close(store, NULL);
  }
}

TEST(test_a_large_store_is_thinned) {
  char path[64];
  enum { RUNS = 3000 };
  struct store *store = filled("page-large", RUNS, path);
  struct ask_page *page = NULL;
  OK(ask_page_make(store, &page, &error));
  sqlite3 *db = opened(page);
  const double kept = asked(db, "SELECT count(*) FROM runs");
  assert_true(kept <= ASK_PAGE_RUNS && kept > ASK_PAGE_RUNS - M * K);
  /* the first replicates of every point: a sample that does not depend on results */
  const double replicates = asked(db, "SELECT value FROM fact WHERE name = 'replicates_kept'");
  assert_near(asked(db, "SELECT min(n) FROM (SELECT count(*) AS n FROM runs GROUP BY point_id)"), replicates, 0);
  assert_near(asked(db, "SELECT max(replicate) FROM runs"), replicates - 1, 0);
  check_means(store, db);
  assert_near(asked(db, "SELECT sum(n) FROM points"), number(store, "SELECT sum(n) FROM points"), 0);
  /* With the empty page (1.4 MB) and pictures (up to 0.45 MB as base64) a page of 10 000 runs is below 3 MB. */
  static const unsigned char html[] = "<!-- data -->";
  char file[64];
  size_t size = 0;
  struct page_data data = {0};
  fixture_path(file, "page-large-file");
  OK(ask_page_file(page, &data.bytes, &data.size, &error));
  OK(page_write(file, html, sizeof html - 1, 7, 1, &data, &size, &error));
  assert_true(size > 100000 && size < 1150000);
  free(data.bytes);
  unlink(file);
  sqlite3_close(db);
  ask_page_free(page);
  store_close(store, NULL);
}

/* Point 1: a third of the runs near 0.8, the others near 0.2. Point 2: the runs are spread evenly; half of them have
 * another hardness, which is no main result. */
TEST(test_two_modes_are_told) {
  char path[64];
  struct fixture_inputs inputs;
  OWNED struct fixture_run *f = malloc(sizeof *f);
  struct store *store = NULL;
  fixture_path(path, "page-modes");
  OK(store_open_writer(path, &store, NULL, 0, &error));
  for (int p = 1; p <= 3; p++) { /* point 3: as point 1, but with few runs, which tell no modes */
    int64_t point = 0;
    struct scene scene = fixture_scene(&inputs, p, 1e30);
    OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
    for (int r = 0; r < (p == 3 ? 15 : 60); r++) {
      fixture_fill(f, &scene, point, 0, r, FIXTURE_FRAGMENTS);
      f->outcome.largest_fraction = 0.2 + 0.1 * (r * 7 % 60) / 60.0 + (p != 2 && r % 3 == 0 ? 0.6 : 0);
      f->result.hardest = 10.5 + r / 60.0 + (p == 2 && r % 2 ? 5 : 0);
      OK(store_add_run(store, &f->run, &error));
    }
  }
  OK(store_close(store, &error));
  OK(store_open_reader(path, &store, &error));
  struct ask_page *page = NULL;
  OK(ask_page_make(store, &page, &error));
  sqlite3 *db = opened(page);
  assert_near(asked(db, "SELECT count(*) FROM modes"), 2, 0);
  assert_near(asked(db, "SELECT point_id FROM modes WHERE quantity = 'largest_fraction'"), 1, 0);
  assert_near(asked(db, "SELECT upper_share FROM modes WHERE quantity = 'largest_fraction'"), 1.0 / 3, 1e-12);
  assert_near(asked(db, "SELECT upper_mode - lower_mode FROM modes WHERE quantity = 'largest_fraction'"), 0.6, 0.05);
  assert_near(asked(db, "SELECT point_id FROM modes WHERE quantity = 'hardest'"), 2, 0);
  assert_near(asked(db, "SELECT upper_mode - lower_mode FROM modes WHERE quantity = 'hardest'"), 5, 0.1);
  const double median = asked(db, "SELECT value FROM quantile WHERE point_id = 2 AND share = 0.5");
  assert_true(median > 0.22 && median < 0.28);
  sqlite3_close(db);
  ask_page_free(page);
  store_close(store, NULL);
}

TEST(test_a_page_needs_a_place_for_data) {
  char path[64];
  size_t written = 0;
  fixture_path(path, "page-file");
  static const unsigned char html[] = "<p>empty</p>", with[] = "<p>a</p><!-- data --><p>b</p>";
  struct page_data data = {.bytes = (unsigned char *)"abc", .size = 3};
  assert_int_equal(page_write(path, html, sizeof html - 1, 7, 1, &data, &written, &error), STATUS_CONTENT);
  assert_int_not_equal(access(path, F_OK), 0);
  OK(page_write(path, with, sizeof with - 1, 7, 1, &data, &written, &error));
  char text[400] = "";
  FILE *in = fopen(path, "r");
  assert_non_null(in);
  assert_int_equal(fread(text, 1, sizeof text - 1, in), written);
  fclose(in);
  assert_false(page_is_of_other(path, 7));
  assert_true(page_is_of_other(path, 8));
  /* gzip -9 of "abc" without a time, in base64 */
  assert_string_equal(text, "<p>a</p><script type=\"application/octet-stream\" "
                            "data-of=\"0000000000000007\" class=\"store\">"
                            "H4sIAAAAAAACA0tMSgYAwkEkNQMAAAA=</script>\n<p>b</p>");
  unlink(path);
}
