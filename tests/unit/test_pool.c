/* Pools of runs: by point, by an input, by a condition; their order, labels, fragments and values. */
#include "db/ask/ask.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

enum { RUNS = 3 };

struct seen {
  size_t pools, points, runs, fragments;
  char labels[600];
  double sum; /* of masses, or of values */
};

static void look(struct seen *seen, const struct ask_pool *pool) {
  seen->pools++;
  seen->points += pool->points;
  seen->runs += pool->data.runs.count;
  assert_int_equal(pool->first_run[0], 0);
  assert_int_equal(pool->first_run[pool->points], pool->data.runs.count);
  assert_int_equal(pool->data.point_id, pool->points == 1 ? pool->point[0] : 0);
  snprintf(seen->labels + strlen(seen->labels), sizeof seen->labels - strlen(seen->labels), "%s; ", pool->label);
  for (size_t r = 0; r < pool->data.runs.count; r++) {
    assert_true(pool->data.run_id[r] > 0);
    if (pool->value) {
      seen->sum += pool->value[r];
      assert_true(pool->data.seed[r] >= 1000 && pool->data.seed[r] < 1000 + RUNS);
      continue;
    }
    seen->fragments += pool->data.runs.first[r + 1] - pool->data.runs.first[r];
    for (size_t i = pool->data.runs.first[r]; i < pool->data.runs.first[r + 1]; i++)
      seen->sum += pool->data.runs.masses[i];
  }
}

static status look_at(struct ask_pools pools, struct seen *seen) {
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)
    look(seen, pool);
  return ask_pools_end(&pools);
}

static struct store *fill(char path[64]) {
  struct store *store;
  OK(store_open_writer(fixture_path(path, "pool"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 3, RUNS, true, &error)); /* m: 6, 7; k: 1e30, 1e31, 1e32 */
  OK(store_flush(store, &error));
  return store;
}

TEST(pools_of_runs) {
  char path[64];
  struct store *store = fill(path);
  struct seen all = {0}, by_m = {0}, some = {0}, none = {0}, one = {0}, everything = {0};
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){0}, NULL, &error), &all));
  assert_true(all.pools == 6 && all.points == 6 && all.runs == 6 * RUNS);
  assert_int_equal(all.fragments, 6 * RUNS * FIXTURE_FRAGMENTS);
  assert_near(all.sum, number(store, "SELECT sum(total_mass) FROM run"), 1e-9);

  OK(look_at(ask_pools(store, &(struct ask_pool_choice){.by = "m"}, NULL, &error), &by_m));
  assert_true(by_m.pools == 2 && by_m.points == 6 && by_m.runs == 6 * RUNS);
  assert_string_equal(by_m.labels, "m 6; m 7; ");
  assert_near(by_m.sum, all.sum, 1e-9);
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){.by = ""}, NULL, &error), &everything));
  assert_true(everything.pools == 1 && everything.points == 6);
  assert_string_equal(everything.labels, "all points; ");

  /* A condition leaves runs and points out. */
  OK(ask_choose(store, &(struct ask_choice){.where = "material_k > 5e30 AND replicate = 1"}, &error));
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){.by = "m"}, NULL, &error), &some));
  OK(ask_choose(store, &(struct ask_choice){0}, &error));
  assert_true(some.pools == 2 && some.points == 4 && some.runs == 4);
  assert_near(some.sum, number(store, "SELECT sum(total_mass) FROM runs WHERE material_k > 5e30 AND replicate = 1"),
              1e-9);
  assert_int_equal(ask_choose(store, &(struct ask_choice){.where = "replicate > 99"}, &error), STATUS_USAGE);
  assert_string_equal(error.message, "test-store-pool.db: none of the runs meets --where \"replicate > 99\"");
  OK(ask_choose(store, &(struct ask_choice){.where = "replicate = 0 OR replicate = 2"}, &error));
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){.point = 2}, NULL, &error), &one));
  OK(ask_choose(store, &(struct ask_choice){0}, &error));
  assert_true(one.pools == 1 && one.runs == 2);
  assert_string_equal(one.labels, "m 6, k 10^31 m^-3; ");

  assert_int_equal(ask_choose(store, &(struct ask_choice){.where = "no_such > 1"}, &error), STATUS_USAGE);
  OK(ask_choose(store, &(struct ask_choice){0}, &error));
  assert_int_equal(look_at(ask_pools(store, &(struct ask_pool_choice){.by = "no_such"}, NULL, &error), &none),
                   STATUS_USAGE);
  {
    ASK_POOLS left = ask_pools(store, &(struct ask_pool_choice){0}, NULL, &error); /* leaving it early frees it */
    assert_non_null(ask_pools_next(&left));
  }
  OK(store_close(store, &error));
}

TEST(pools_of_values) {
  char path[64];
  struct store *store = fill(path);
  struct seen by_k = {0}, some = {0};
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){.by = "k"}, "largest_fraction", &error), &by_k));
  assert_true(by_k.pools == 3 && by_k.points == 6 && by_k.runs == 6 * RUNS);
  assert_near(by_k.sum, number(store, "SELECT sum(largest_fraction) FROM run"), 1e-12);
  OK(ask_choose(store, &(struct ask_choice){.where = "material_m > 6.5 AND replicate < 2"}, &error));
  OK(look_at(ask_pools(store, &(struct ask_pool_choice){0}, "hardest", &error), &some));
  OK(ask_choose(store, &(struct ask_choice){0}, &error));
  assert_true(some.pools == 3 && some.runs == 6);
  assert_near(some.sum, 3 * (0 + 0.5), 1e-12);
  assert_int_equal(look_at(ask_pools(store, &(struct ask_pool_choice){0}, "no_such", &error), &some), STATUS_USAGE);
  OK(store_close(store, &error));
}

/* The units of a pool's interval: its runs, or its points. */
static void check_units(struct store *store, const struct ask_pool_choice *choice) {
  ASK_POOLS pools = ask_pools(store, choice, NULL, &error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    const struct pooled_form form = ask_pool_form(pool, true, 0);
    OWNED struct pooled_bin *bins = NULL;
    size_t count;
    OK(pooled_spectrum(&pool->data.runs, &form, &bins, &count, &error));
    assert_near(bins[0].value, FIXTURE_FRAGMENTS, 1e-9);
    assert_int_equal(form.first_run != NULL, pool->points > 1);
  }
  OK(ask_pools_end(&pools));
}

TEST(pools_as_forms) {
  char path[64];
  struct store *store = fill(path);
  check_units(store, &(struct ask_pool_choice){.by = "m"});
  check_units(store, &(struct ask_pool_choice){0});
  OK(store_close(store, &error));
}
