/* The store, fields files and restart files after a power cut. A record of all writes and syncs of the program is cut
 * at many instants; tests/support/disk_record.h has the model of the disk. Pass if after each cut the store opens, its
 * check is clean, and all runs are there that were committed before. CLAST_FULL=1: twenty times as many cuts. */
#include "db/store/internal.h"
#include "schemas/file.h"
#include "tests/support/campaign_play.h"
#include "tests/support/check.h"
#include "tests/support/disk_record.h"
#include "tests/support/store_checks.h"

static const char now_folder[] = "power-now", after_folder[] = "power-after";

/* After operation `op` of the record, the store `path` has at least so many runs; `added`: those not committed yet. */
static struct promise {
  size_t op;
  const char *path;
  int64_t runs;
} promises[10000];
static size_t promise_count;

static void promise(const char *path, int64_t runs) {
  assert_true(promise_count < sizeof promises / sizeof promises[0]);
  promises[promise_count++] = (struct promise){disk.count, path, runs};
}

static int64_t promised(const char *path, size_t op) {
  int64_t runs = -1;
  for (size_t i = 0; i < promise_count && promises[i].op <= op; i++)
    if (strcmp(promises[i].path, path) == 0)
      runs = promises[i].runs;
  return runs;
}

static void begin(void) {
  promise_count = 0;
  disk_begin(now_folder);
}

static void line(void *context, const char *text) {
  (void)context;
  print_error("%s\n", text);
}

/* Goes on with a store that a cut left, as `clast run` does. Returns its number of runs. */
static int64_t runs_after(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_check(store, line, NULL, &error));
  const int64_t runs = (int64_t)number(store, "SELECT count(*) FROM run");
  OK(store_close(store, &error));
  return runs;
}

/* Cuts the record at `cuts` drawn instants and just before and after operations that matter most: syncs and changes of
 * names. `look` judges the folder that a cut left. */
static void cut_everywhere(size_t cuts, void (*look)(size_t op)) {
  struct disk_play play;
  uint64_t draws = 7;
  if (getenv("CLAST_FULL"))
    cuts *= 20;
  size_t critical = 0, seen = 0;
  for (size_t i = 0; i < disk.count; i++)
    critical += disk.ops[i].kind != DISK_WROTE;
  disk_play_begin(&play);
  for (size_t op = 1; op <= disk.count; op++) {
    const bool at_write = disk.ops[op - 1].kind == DISK_WROTE;
    const size_t kind = at_write ? disk.count - critical : critical;
    if (op < disk.count && disk_draw(&draws) % kind >= cuts / 2)
      continue;
    for (enum disk_rest rest = 0; rest < DISK_RESTS; rest++) {
      disk_cut(&play, op, rest, disk_draw(&draws), after_folder);
      look(op);
      seen++;
    }
  }
  disk_play_end(&play);
  print_message("%zu cuts in a record of %zu operations, %zu of them no writes\n", seen, disk.count, critical);
}

static void look_at_stores(size_t op) {
  static const char *const stores[] = {"a.db", "b.db"};
  for (size_t i = 0; i < 2; i++) {
    char path[64];
    snprintf(path, sizeof path, "%s/%s", after_folder, stores[i]);
    const int64_t least = promised(stores[i], op);
    if (access(path, F_OK) != 0 && least < 0)
      continue;
    const int64_t runs = runs_after(path);
    if (runs < least)
      fail_msg("%s, cut after operation %zu: %lld runs were committed, %lld are there", path, op, (long long)least,
               (long long)runs);
  }
}

/* Adds replicates from .. to - 1 of three points, in batches of 16 runs, and notes what is committed. */
static void add_runs(struct store *store, const char *name, int64_t from, int64_t to) {
  struct fixture_inputs inputs;
  static struct fixture_run f;
  int64_t point;
  for (int64_t r = from; r < to; r++)
    for (int p = 0; p < 3; p++) {
      struct scene scene = fixture_scene(&inputs, 6 + p, 1e30);
      OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
      fixture_fill(&f, &scene, point, 0, r, 12);
      OK(store_add_run(store, &f.run, &error));
      if ((3 * r + p) % 16 == 15)
        OK(store_flush(store, &error));
      if (!store->in_batch)
        promise(name, 3 * r + p + 1);
    }
}

/* The writer moves its -wal file into the store every 40 pages, not every 4000, so that a short record has it. */
static struct store *open_store(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  assert_int_equal(sqlite3_exec(store->db, "PRAGMA wal_autocheckpoint = 40", NULL, NULL, NULL), SQLITE_OK);
  return store;
}

/* A store is made, closed, continued, and another one is merged into it. */
TEST(stores_keep_what_is_committed) {
  int64_t added, differing;
  begin();
  struct store *store = open_store("power-now/a.db");
  add_runs(store, "a.db", 0, 40);
  OK(store_close(store, &error));
  promise("a.db", 120);
  store = open_store("power-now/a.db");
  add_runs(store, "a.db", 40, 60);
  OK(store_close(store, &error));
  promise("a.db", 180);
  store = open_store("power-now/b.db");
  add_runs(store, "b.db", 0, 70);
  OK(store_close(store, &error));
  promise("b.db", 210);
  store = open_store("power-now/a.db");
  OK(store_merge(store, "power-now/b.db", &added, &differing, &error));
  promise("a.db", 210);
  OK(store_close(store, &error));
  disk_end();
  assert_int_equal(added, 30);
  cut_everywhere(24, look_at_stores);
}

/* A store that holds a copy of runs is there when its call returns. */
static void look_at_copy(size_t op) {
  const int64_t least = promised("copy.db", op);
  if (least >= 0)
    assert_int_equal(runs_after("power-after/copy.db"), least);
}
TEST(a_copy_is_kept) {
  begin();
  struct store *store = open_store("power-now/a.db");
  add_runs(store, "a.db", 0, 100);
  OK(store_export(store, "power-now/copy.db", &error));
  promise("copy.db", 300);
  OK(store_close(store, &error));
  disk_end();
  cut_everywhere(6, look_at_copy);
}

/* A commit at least every second: what was added longer ago is there. One commit may be under way at the cut. */
TEST(at_most_the_last_second_is_lost) {
  enum { RUNS = 120 };
  static double added[RUNS];
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  static struct fixture_run f;
  int64_t point;
  double slowest = 0;
  begin();
  struct store *store = open_store("power-now/a.db");
  OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
  for (int r = 0; r < RUNS; r++) {
    const double start = clock_s();
    fixture_fill(&f, &scene, point, 0, r, 12);
    OK(store_add_run(store, &f.run, &error));
    added[r] = clock_s();
    usleep(25000);
    OK(store_tick(store, &error));
    slowest = fmax(slowest, clock_s() - start);
  }
  OK(store_close(store, &error));
  disk_end();
  struct disk_play play;
  double largest = 0;
  disk_play_begin(&play);
  for (size_t op = 1; op < disk.count; op++) {
    if (disk.ops[op].kind != DISK_SYNCED)
      continue;
    const double instant = disk.ops[op].time; /* the power goes just before this sync ends: the worst instant */
    disk_cut(&play, op, DISK_REST_LOST, 1, after_folder);
    if (instant < added[0])
      continue;
    const int64_t there = runs_after("power-after/a.db");
    if (there < RUNS)
      largest = fmax(largest, instant - added[there]);
  }
  disk_play_end(&play);
  print_message("at most the last %.2f s were lost; the slowest turn took %.2f s\n", largest, slowest);
  assert_true(largest > 0.5); /* commits did not come more often than every second */
  assert_true(largest < 1 + 2 * slowest);
}

/* The fields file of each run is whole: it has the run's seed. */
static void look_at_fields(size_t op) {
  (void)op;
  if (access("power-after/a.db", F_OK) != 0)
    return;
  runs_after("power-after/a.db"); /* the check lists missing files */
  sqlite3 *db = NULL;
  sqlite3_stmt *rows = NULL;
  assert_int_equal(sqlite3_open("power-after/a.db", &db), SQLITE_OK);
  assert_int_equal(sqlite3_prepare_v2(db, "SELECT fields_path, seed FROM run", -1, &rows, NULL), SQLITE_OK);
  while (sqlite3_step(rows) == SQLITE_ROW) {
    char path[200], text[32] = "";
    snprintf(path, sizeof path, "power-after/%s", sqlite3_column_text(rows, 0));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_true(fgets(text, sizeof text, file) && strtoll(text, NULL, 10) == sqlite3_column_int64(rows, 1));
    fclose(file);
  }
  sqlite3_finalize(rows);
  sqlite3_close(db);
}

TEST(fields_are_kept_before_their_row) {
  struct play play = {.slots = 2};
  struct driver_summary summary;
  struct campaign *campaign = play_campaign(2, 2, 8);
  campaign->keep = CAMPAIGN_KEEP_ALL;
  begin();
  assert_int_equal(play_once(&play, campaign, "power-now/a.db", &summary), STATUS_OK);
  disk_end();
  assert_int_equal(summary.fields_written, 32);
  cut_everywhere(10, look_at_fields);
  campaign_free(campaign);
  free(play.says);
}

static void look_at_restart(size_t op) {
  OWNED unsigned char *bytes = NULL;
  size_t size = 0;
  const int64_t least = promised("restart", op);
  const status code = file_read("power-after/run.restart", "restart file", &bytes, &size, NULL);
  assert_int_equal(code, least < 0 && code != STATUS_OK ? STATUS_MISSING : STATUS_OK);
  if (code == STATUS_OK) {
    assert_int_equal(size, 5000);
    assert_true(bytes[0] >= least && bytes[0] <= 5);
    for (size_t i = 0; i < size; i++)
      assert_int_equal(bytes[i], bytes[0]);
  }
}

/* Each restart file replaces the one before. */
TEST(a_restart_file_is_kept) {
  begin();
  for (int version = 1; version <= 5; version++) {
    unsigned char bytes[5000];
    memset(bytes, version, sizeof bytes);
    OK(file_write("power-now/run.restart", "restart file", bytes, sizeof bytes, &error));
    promise("restart", version);
  }
  disk_end();
  cut_everywhere(200, look_at_restart);
}
