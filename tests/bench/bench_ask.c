/* Speed of interactive queries on a store of 1e5 runs of 100 points with 30 to 300 fragments each. Prints `name value
 * unit`; wall and processor times, the best of three. Targets: statistics over two axes below 1 s, the pooled spectrum
 * of a point below 0.2 s, a comparison below 1 s. Usage: bench_ask [runs [folder]]; with a folder, the store is kept
 * there as bench-ask.db and used again. */
#include <time.h>

#include "analysis/analysis.h"
#include "analysis/statistics/statistics.h"
#include "db/ask/ask.h"
#include "schemas/clock.h"
#include "tests/support/store_fixture.h"

enum { POINTS = 100, LEAST = 30, MOST = 300, REPEATS = 3 };

static struct error error;

static void need(status result) {
  if (result == STATUS_OK)
    return;
  fprintf(stderr, "%s\n", error.message);
  exit(70);
}

static char path[512]; /* of the store */

static void load(int64_t runs) {
  static struct fixture_run f;
  static struct fragment fragments[MOST];
  struct fixture_inputs inputs;
  struct estimate rows[ESTIMATES_COUNT];
  struct store *store = NULL;
  int64_t campaign, session, points[POINTS];
  need(store_open_writer(path, &store, NULL, 0, &error));
  need(store_add_campaign(store, "bench", "name: bench", "{}", &campaign, &error));
  need(store_begin_session(store, "{}", &session, &error));
  for (int p = 0; p < POINTS; p++) {
    struct scene scene = fixture_scene(&inputs, 1 + p / 10, pow(10, 30 + p % 10));
    need(store_add_point(store, campaign, &scene, 2, fixture_axes, &points[p], &error));
  }
  for (int64_t r = 0; r < runs; r++) {
    const int p = (int)(r % POINTS);
    struct scene scene = fixture_scene(&inputs, 1 + p / 10, pow(10, 30 + p % 10));
    const size_t n = LEAST + (size_t)((MOST - LEAST) * fixture_random(3, (uint64_t)r));
    fixture_fill(&f, &scene, points[p], session, r / POINTS, FIXTURE_FRAGMENTS);
    for (size_t i = 0; i < n; i++)
      fragments[i] = (struct fragment){.mass = pow(10, -3 * fixture_random((uint64_t)r, i)), .count = 3};
    qsort(fragments, n, sizeof *fragments, fixture_by_mass);
    f.run.fragments = fragments;
    f.run.fragment_count = n;
    f.outcome.fragment_count = (int64_t)n;
    f.outcome.largest_fraction = fixture_random(7, (uint64_t)r);
    need(estimates_make(n, fragments, 0, rows, &error));
    f.run.estimates = rows;
    f.run.estimate_count = ESTIMATES_COUNT;
    need(store_add_run(store, &f.run, &error));
  }
  need(store_end_session(store, session, "ok", &error));
  need(store_close(store, &error));
}

static void count_rows(struct answer answer, size_t *rows) {
  while (answer_next(&answer))
    ++*rows;
  need(answer_end(&answer));
}

static void stats(struct store *store, size_t *rows) {
  struct ask_group_pooled pooled;
  count_rows(ask_group(store, "m,k", "largest_fraction", &pooled, &error), rows);
}

static void stats_of_one(struct store *store, size_t *rows) {
  struct ask_group_pooled pooled;
  count_rows(ask_group(store, "m", "largest_fraction", &pooled, &error), rows);
}

static void twins(struct store *store, size_t *rows) {
  struct ask_group_twins found;
  need(ask_group_twins(store, &found, &error));
  *rows += 1;
}

static void count_bins(struct store *store, const struct ask_pool_choice *choice, size_t *rows) {
  ASK_POOLS pools = ask_pools(store, choice, NULL, &error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    const struct pooled_form form = ask_pool_form(pool, false, 0);
    struct pooled_bin *bins;
    size_t count;
    need(pooled_spectrum(&pool->data.runs, &form, &bins, &count, &error));
    *rows += count;
    free(bins);
  }
  need(ask_pools_end(&pools));
}

static void spectrum(struct store *store, size_t *rows) {
  count_bins(store, &(struct ask_pool_choice){.point = 17}, rows);
}

static void spectra(struct store *store, size_t *rows) {
  count_bins(store, &(struct ask_pool_choice){0}, rows);
}

static void where(struct store *store, size_t *rows) {
  need(ask_choose(store, &(struct ask_choice){.where = "material_m = 3 AND replicate < 100"}, &error));
  count_bins(store, &(struct ask_pool_choice){0}, rows);
  need(ask_choose(store, &(struct ask_choice){0}, &error));
}

static void compare(struct store *store, size_t *rows) {
  (void)store;
  struct ask_pairs *pairs;
  need(ask_pairs_read(path, path, "largest_fraction", &(struct ask_choice){0}, &pairs, &error));
  for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);)
    ++*rows;
  ask_pairs_free(pairs);
}

static void scatters(struct store *store, size_t *rows) {
  ASK_POOLS pools = ask_pools(store, &(struct ask_pool_choice){0}, "largest_fraction", &error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    struct scatter scatter;
    need(scatter_make(pool->data.runs.count, pool->value, &scatter, &error));
    *rows += scatter.n;
    scatter_release(&scatter);
  }
  need(ask_pools_end(&pools));
}

static double processor_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void measure(struct store *store, const char *name, void (*ask)(struct store *, size_t *)) {
  double best = HUGE_VAL, least = HUGE_VAL;
  size_t rows = 0;
  for (int i = 0; i < REPEATS; i++) {
    const double start = clock_s(), cpu = processor_s();
    rows = 0;
    ask(store, &rows);
    best = fmin(best, clock_s() - start);
    least = fmin(least, processor_s() - cpu);
  }
  printf("ask_%s_ms %.1f ms\nask_%s_cpu_ms %.1f ms\nask_%s_rows %zu 1\n", name, 1e3 * best, name, 1e3 * least, name,
         rows);
  fflush(stdout);
}

int main(int argc, char **argv) {
  const int64_t runs = argc > 1 ? atoll(argv[1]) : 100000;
  snprintf(path, sizeof path, "%s/bench-ask.db", argc > 2 ? argv[2] : ".");
  analysis_init();
  if (argc <= 2 || access(path, F_OK) != 0) {
    unlink(path);
    load(runs);
  }
  struct store *store = NULL;
  const double start = clock_s();
  need(store_open_reader(path, &store, &error));
  printf("ask_open_ms %.1f ms\n", 1e3 * (clock_s() - start));
  measure(store, "stats_two_axes", stats);
  measure(store, "stats_one_axis", stats_of_one);
  measure(store, "stats_twins", twins);
  measure(store, "spectrum_of_a_point", spectrum);
  measure(store, "spectra_where", where);
  measure(store, "spectra_of_all", spectra);
  measure(store, "compare", compare);
  measure(store, "scatter_of_all", scatters);
  store_close(store, NULL);
  if (argc <= 2)
    unlink(path);
  return 0;
}
