/* Ejecta over their speed: bins, a power law, the table of a store, its means, merging, damage, and stores of
 * version 4. */
#include <sqlite3.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "schemas/rows.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

static void near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%s: got %.12g, expected %.12g", what, got, want);
}

/* ---- bins ---- */

TEST(sums_by_hand) {
  static const double speed[] = {0, 1e-9, 1, 1.2, 9.9, 10, 1e9, NAN, INFINITY};
  struct ejecta e = {.bin = {{0, 0}}};
  for (int i = 0; i < 9; i++)
    ejecta_add(&e, speed[i], 1 << i, 10 << i);
  assert_true(e.bin[0].mass == 3 && e.bin[0].momentum == 30);                         /* slower than all bins */
  assert_true(e.bin[-EJECTA_FIRST].mass == 12 && e.bin[-EJECTA_FIRST + 1].mass == 0); /* 1 to 1.26 m/s */
  assert_true(e.bin[-EJECTA_FIRST + 9].mass == 16 && e.bin[-EJECTA_FIRST + 10].mass == 32);
  assert_true(e.bin[EJECTA_BINS - 1].mass == 64); /* faster than all */
  ejecta_sum(&e);
  assert_true(e.bin[0].mass == 127 && e.bin[0].momentum == 1270);
  assert_true(e.bin[-EJECTA_FIRST].mass == 124 && e.bin[-EJECTA_FIRST + 1].mass == 112);
  assert_true(e.bin[-EJECTA_FIRST + 10].momentum == 960);
}

/* M(>v) = M (v/v0)^-s with s = 3 mu and mu = 0.55, that of dense rock and water, made of particles of one mass: each
 * edge has the law's mass within one particle, and two decades have its slope. */
TEST(a_power_law) {
  enum { N = 1000000 };
  const double slope = 3 * 0.55, slowest = 0.5;
  struct ejecta e = {.bin = {{0, 0}}};
  for (int i = 0; i < N; i++)
    ejecta_add(&e, slowest * pow((i + 0.5) / N, -1 / slope), 2, 0);
  ejecta_sum(&e);
  near(e.bin[0].mass, 2.0 * N, 0, "all of it");
  for (int bin = 0; bin <= 30; bin++)
    if (fabs(e.bin[bin - EJECTA_FIRST].mass - 2.0 * N * pow(bins_edge(bin) / slowest, -slope)) > 2)
      fail_msg("mass above %g m/s", bins_edge(bin));
  /* 160 particles are left above 100 m/s: half a particle is 0.3 % of them, or 0.0007 in a slope over two decades */
  near(log10(e.bin[-EJECTA_FIRST].mass / e.bin[20 - EJECTA_FIRST].mass) / 2, slope, 0.0005, "slope");
}

/* ---- a store ---- */

struct thrown {
  struct fixture_result fixture;
  double momentum;
  struct ejecta ejecta;
};
static const struct field rows[] = {
    REAL_OF(thrown, ejecta.momentum, momentum, "kg m/s", 0, 0, HUGE_VAL, .flags = FIELD_MAY_BE_OFF,
            .doc = "Momentum of the ejecta."),
};
static const struct field_table results = FIELD_TABLE(rows, struct thrown, "thrown result", "A result for tests.");
static const struct engine_kind kind = {.name = "thrown",
                                        .doc = "Made-up numbers.",
                                        .results_version = 1,
                                        .inputs = &fixture_inputs_table,
                                        .results = &results,
                                        .ejecta = offsetof(struct thrown, ejecta)};

/* Replicate r throws out (r + 1) kg at 2 m/s with 2 (r + 1) kg m/s, and 1 kg at 20 m/s with 5 kg m/s. */
static struct thrown thrown_by(int64_t replicate) {
  struct thrown result = {.momentum = 2 * (double)(replicate + 1) + 5};
  ejecta_add(&result.ejecta, 2, (double)(replicate + 1), 2 * (double)(replicate + 1));
  ejecta_add(&result.ejecta, 20, 1, 5);
  return result;
}

enum { FROM = 3 - EJECTA_FIRST, TO = 13 - EJECTA_FIRST }; /* the bins of 2 and 20 m/s */

/* Runs from..to - 1 of two points. The last run of the second point is of a program that stored no speeds. */
static void add_runs(const char *path, int64_t from, int64_t to) {
  struct store *store = NULL;
  struct fixture_inputs inputs;
  OWNED struct fixture_run *f = malloc(sizeof *f);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  for (int p = 0; p < 2; p++) {
    struct scene scene = fixture_scene(&inputs, 6 + p, 1e30);
    int64_t point = 0;
    scene.kind = &kind;
    OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
    for (int64_t r = from; r < to; r++) {
      struct thrown result = thrown_by(r);
      fixture_fill(f, &scene, point, 0, r, FIXTURE_FRAGMENTS);
      if (p == 1 && r == 3)
        result.ejecta = (struct ejecta){.bin = {{0, 0}}};
      f->run.result = &result;
      OK(store_add_run(store, &f->run, &error));
    }
  }
  OK(store_close(store, &error));
}

static void change(const char *path, const char *text) {
  sqlite3 *db = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db, text, NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
}

/* By hand: runs throw out 2, 3, 4 (and 5) kg; mean 3 and s = 1 of three runs, 3.5 and sqrt(5/3) of four. Student's t of
 * 2 and 3 degrees of freedom: 4.302653 and 3.182446. */
static void expect_means(const char *path, const char *by) {
  struct store *store = NULL;
  OWNED struct ask_ejecta *ejecta = malloc(sizeof *ejecta);
  int pool_count = 0;
  OK(store_open_reader(path, &store, &error));
  ASK_POOLS pools = ask_ejecta_pools(store, &(struct ask_pool_choice){.by = by}, &error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    OK(ask_ejecta(store, pool, ejecta, &error));
    if (ejecta->count == 0) /* a point of another engine */
      continue;
    const struct ask_ejecta_row *all = &ejecta->row[0], *fast = &ejecta->row[ejecta->count - 1];
    assert_int_equal(ejecta->count, TO - FROM + 1);
    assert_true(all->speed == bins_edge(3) && fast->speed == bins_edge(13));
    assert_true(fast->mass.mean == 1 && fast->momentum.mean == 5 && isnan(fast->mass.half_width));
    assert_int_equal(ejecta->without, pool_count == 1 || by);
    /* Points are the sample: 3.5 and 3 kg. Three seeds are common: (1.5 + 0 + 0.5) / sqrt(4 3 3 2) from them. */
    if (by) {
      near(all->mass.mean, 3.25, 1e-12, "mass of points");
      near(all->mass.half_width, sample_student_of(1.75998007, 0.95) * sqrt(0.25 * 0.25 + 2 / sqrt(72)), 1e-7,
           "its interval");
    } else if (pool_count == 0) {
      near(all->mass.mean, 3.5, 1e-12, "mass");
      near(all->mass.half_width, 3.182446 * sqrt(5.0 / 3) / 2, 1e-6, "its interval");
      near(all->momentum.mean, 10, 1e-12, "momentum");
    } else {
      near(all->mass.mean, 3, 1e-12, "mass");
      near(all->mass.half_width, 4.302653 / sqrt(3), 1e-6, "its interval");
    }
    for (size_t i = 1; i < ejecta->count; i++) /* nothing is between 2.51 and 19.95 m/s */
      assert_true(ejecta->row[i].mass.mean == 1);
    pool_count++;
  }
  OK(ask_pools_end(&pools));
  assert_int_equal(pool_count, by ? 1 : 2);
  OK(store_close(store, &error));
}

TEST(means_of_a_store) {
  char path[64], half[64], other[64];
  struct store *store = NULL;
  add_runs(fixture_path(path, "ejecta"), 0, 4);
  expect_means(path, NULL);
  expect_means(path, "material.k");
  OK(store_open_reader(path, &store, &error));
  assert_near(number(store, "SELECT count(*) FROM ejecta"), 14, 0);
  assert_near(number(store, "SELECT sum(momentum) FROM ejecta WHERE run_id = 2"), 9, 0);
  assert_near(number(store, "SELECT count(*) FROM column_doc WHERE table_name = 'ejecta'"), 5, 0);
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));

  /* merged from two halves, the same bits */
  int64_t added = 0, differing = 0;
  add_runs(fixture_path(half, "ejecta-half"), 0, 2);
  add_runs(fixture_path(other, "ejecta-other"), 2, 4);
  OK(store_open_writer(half, &store, NULL, 0, &error));
  OK(store_merge(store, other, &added, &differing, &error));
  assert_true(added == 4 && differing == 0);
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));
  expect_means(half, NULL);
  OWNED char *one = dump(path), *two = dump(half);
  assert_string_equal(one, two);

  /* damage is seen, and merged into no store */
  change(other, "UPDATE ejecta SET mass = mass + 1e-9 WHERE run_id = 1 AND bin = 3");
  OK(store_open_reader(other, &store, &error));
  assert_int_equal(store_check(store, NULL, NULL, &error), STATUS_CONTENT);
  OK(store_close(store, &error));
  OK(store_open_writer(fixture_path(half, "ejecta-half"), &store, NULL, 0, &error));
  assert_int_equal(store_merge(store, other, &added, &differing, &error), STATUS_CONTENT);
  store_close(store, NULL);
}

/* A store of version 4 has no such table. It is read as it is, keeps all its runs when it is written, and a row that
 * was lost before is still seen: bringing it forward gives no digest anew. */
TEST(version_4_is_brought_forward) {
  static const char older[] = "DROP TABLE ejecta; DELETE FROM column_doc WHERE table_name = 'ejecta'; "
                              "PRAGMA user_version = 4";
  for (int lost = 0; lost < 2; lost++) {
    char path[64], other[64];
    struct store *store = NULL;
    OK(store_open_writer(fixture_path(path, "version4"), &store, NULL, 0, &error));
    OK(fixture_populate(store, 2, 2, 10, false, &error));
    OK(store_close(store, &error));
    change(path, older);
    OWNED char *before = dump(path);
    if (lost)
      change(path, "DELETE FROM axis WHERE path = 'material.k'");
    OK(store_open_reader(path, &store, &error));
    assert_int_equal(store_check(store, NULL, NULL, &error), lost ? STATUS_CONTENT : STATUS_OK);
    assert_near(number(store, "SELECT count(*) FROM points WHERE n = 10"), 4, 0);
    OK(store_close(store, &error));
    /* into a new store, and forward */
    int64_t added = 0, differing = 0;
    OK(store_open_writer(fixture_path(other, "version5"), &store, NULL, 0, &error));
    OK(store_merge(store, path, &added, &differing, &error));
    assert_true(added == 40 && differing == 0);
    OK(store_close(store, &error));
    OK(store_open_writer(path, &store, NULL, 0, &error));
    assert_near(number(store, "PRAGMA user_version"), SCHEMA_VERSION, 0);
    assert_near(number(store, "SELECT count(*) FROM ejecta"), 0, 0);
    assert_int_equal(store_check(store, NULL, NULL, &error), lost ? STATUS_CONTENT : STATUS_OK);
    OK(store_close(store, &error));
    OWNED char *after = dump(path), *merged = dump(other);
    assert_string_equal(before, after);
    assert_string_equal(before, merged);
    if (lost)
      continue;
    add_runs(path, 0, 4); /* and takes runs with ejecta */
    expect_means(path, NULL);
  }
}
