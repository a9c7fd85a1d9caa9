/* Speed of the store on 1e5 runs with 30 non-empty bins each, 100 points, against the promises of the design. Prints
 * `name value unit`; times are the best of several. Usage: bench_store [runs [folder]]. */
#include <time.h>

#include "analysis/statistics/statistics.h"
#include "db/ask/ask.h"
#include "schemas/clock.h"
#include "tests/support/store_fixture.h"

enum { POINTS = 100, BINS = 30, REPEATS = 5, VARIANTS = 64 };

static struct error error;

static void need(status result) {
  if (result == STATUS_OK)
    return;
  fprintf(stderr, "%s\n", error.message);
  exit(result);
}

/* Two fragments in each of 30 bins. */
static void fill(struct fixture_run *f, const struct scene *scene, int variant) {
  fixture_fill(f, scene, 0, 0, variant, FIXTURE_FRAGMENTS);
  for (int i = 0; i < FIXTURE_FRAGMENTS; i++)
    f->fragments[i].mass = pow(10, -0.1 * (i / 2) - 0.01 - 0.08 * fixture_random((uint64_t)i, (uint64_t)variant));
}

static double processor(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds spent in the store: adding, committing, closing. Successive runs belong to different points, the hardest
 * order for the sums. */
static double load(const char *path, int64_t runs, size_t estimates, double *cpu) {
  static struct fixture_run variants[VARIANTS];
  struct fixture_inputs inputs;
  struct store *store = NULL;
  int64_t points[POINTS];
  struct estimate rows[ESTIMATES_COUNT];
  unlink(path);
  double start = clock_s();
  need(store_open_writer(path, &store, NULL, 0, &error));
  for (int p = 0; p < POINTS; p++) {
    struct scene scene = fixture_scene(&inputs, 1 + p / 10, pow(10, 30 + p % 10));
    need(store_add_point(store, 0, &scene, 2, fixture_axes, &points[p], &error));
  }
  double spent = clock_s() - start;
  struct scene scene = fixture_scene(&inputs, 1, 1e30);
  for (int v = 0; v < VARIANTS; v++)
    fill(&variants[v], &scene, v);
  need(estimates_make(FIXTURE_FRAGMENTS, variants[0].fragments, 0, rows, &error));
  *cpu = processor();
  for (int64_t r = 0; r < runs; r++) {
    struct fixture_run *f = &variants[r % VARIANTS];
    f->run.point_id = points[r % POINTS];
    f->run.replicate = r / POINTS;
    f->run.seed = (uint64_t)f->run.replicate;
    f->run.estimates = rows;
    f->run.estimate_count = estimates;
    f->outcome.largest_fraction = fixture_random(7, (uint64_t)r);
    for (int i = 0; i < 2; i++) {
      double word = fixture_random((uint64_t)r, (uint64_t)i);
      memcpy(f->run.identity + 8 * i, &word, sizeof word);
    }
    start = clock_s();
    need(store_add_run(store, &f->run, &error));
    spent += clock_s() - start;
  }
  start = clock_s();
  need(store_close(store, &error));
  *cpu = processor() - *cpu;
  return spent + clock_s() - start;
}

static void ask(struct store *store, const char *name, const char *sql, int rows_expected) {
  double best = HUGE_VAL;
  for (int i = 0; i < REPEATS; i++) {
    int rows = 0;
    double start = clock_s();
    ANSWER answer = answer_to(store, &error, "%s", sql);
    while (answer_next(&answer))
      rows++;
    need(answer_end(&answer));
    best = fmin(best, clock_s() - start);
    if (rows != rows_expected) {
      fprintf(stderr, "%s: %d rows instead of %d\n", name, rows, rows_expected);
      exit(1);
    }
  }
  printf("%s %.2f ms\n", name, 1e3 * best);
}

/* The data of `clast report`. */
static void page(struct store *store) {
  struct ask_page *page = NULL;
  unsigned char *bytes = NULL;
  size_t size = 0;
  const double start = processor();
  need(ask_page_make(store, &page, &error));
  need(ask_page_file(page, &bytes, &size, &error));
  printf("store_page_cpu_s %.2f s\n", processor() - start);
  printf("store_page_bytes %zu B\n", size);
  ask_page_free(page);
  free(bytes);
}

int main(int argc, char **argv) {
  int64_t runs = argc > 1 ? atoll(argv[1]) : 100000;
  char path[512], copy[600];
  snprintf(path, sizeof path, "%s/bench-store.db", argc > 2 ? argv[2] : ".");
  snprintf(copy, sizeof copy, "%s.estimates", path);
  double cpu = 0, least = HUGE_VAL;
  double seconds = load(copy, runs / 4, ESTIMATES_COUNT, &cpu);
  printf("store_load_with_estimates_runs_per_s %.0f 1/s\n", (double)(runs / 4) / seconds);
  printf("store_load_with_estimates_cpu_us_per_run %.1f us\n", 1e6 * cpu / (double)(runs / 4));
  unlink(copy);
  seconds = HUGE_VAL;
  for (int i = 0; i < 2; i++) {
    seconds = fmin(seconds, load(path, runs, 0, &cpu));
    least = fmin(least, cpu);
  }
  printf("store_load_runs_per_s %.0f 1/s\n", (double)runs / seconds);
  printf("store_load_cpu_us_per_run %.1f us\n", 1e6 * least / (double)runs);

  struct store *store = NULL;
  double start = clock_s();
  need(store_open_reader(path, &store, &error));
  printf("store_open_reader_ms %.2f ms\n", 1e3 * (clock_s() - start));
  double bytes = 0;
  need(answer_number(store, &bytes, &error, "SELECT page_count * page_size FROM pragma_page_count, pragma_page_size"));
  printf("store_bytes_per_run %.0f B\n", bytes / (double)runs);
  ask(store, "store_point_stats_ms", ask_canned_find("point-stats", NULL)->sql, POINTS);
  ask(store, "store_points_view_ms", "SELECT * FROM points", POINTS);
  ask(store, "store_spectrum_one_ms",
      "SELECT lower, upper, count, mass, density, count_sd FROM spectra WHERE point_id = 17", BINS);
  ask(store, "store_spectrum_all_ms", "SELECT * FROM spectra", POINTS * BINS);
  ask(store, "store_spectrum_one_from_runs_ms",
      "SELECT bin, sum(count) FROM run JOIN spectrum USING (run_id) WHERE point_id = 17 GROUP BY bin", BINS);
  ask(store, "store_runs_of_point_ms", "SELECT count(*) FROM runs WHERE point_id = 17", 1);
  page(store);
  store_close(store, NULL);
  start = clock_s();
  need(store_open_writer(path, &store, NULL, 0, &error));
  printf("store_resume_open_ms %.2f ms\n", 1e3 * (clock_s() - start));
  need(store_close(store, &error));
  unlink(path);
  return 0;
}
