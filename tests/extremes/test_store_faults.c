/* The store under kill -9, full disks, missing permissions and readers that keep it open: in each case the committed
 * runs are complete, and the same command computes the rest with the same bits. CLAST_FULL=1 kills ten times as often.
 */
#include <signal.h>
#include <sqlite3.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

#include "db/store/internal.h"
#include "schemas/clock.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

enum { M = 2, K = 2, RUNS = 1500 };

static status fill(const char *path, int64_t runs, struct error *e) {
  struct store *store = NULL;
  status result = store_open_writer(path, &store, NULL, 0, e);
  if (result != STATUS_OK)
    return result;
  result = fixture_populate(store, M, K, runs, true, e);
  status closing = store_close(store, result == STATUS_OK ? e : NULL);
  return result == STATUS_OK ? closing : result;
}

static void line(void *context, const char *text) {
  (void)context;
  print_error("%s\n", text);
}

/* Opens the store as a reader and checks it. Returns the number of runs. */
static double whole(const char *path) {
  struct store *store = NULL;
  OK(store_open_reader(path, &store, &error));
  OK(store_check(store, line, NULL, &error));
  double runs = number(store, "SELECT count(*) FROM run");
  store_close(store, NULL);
  return runs;
}

TEST(killed_writer_loses_at_most_its_batch) {
  char path[64], reference[64];
  int kills = getenv("CLAST_FULL") ? 250 : SANITIZED ? 10 : 25;
  int64_t *added = mmap(NULL, sizeof *added, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  assert_true(added != MAP_FAILED);
  fixture_path(path, "killed");
  double before = 0;
  int in_the_middle = 0;
  for (int i = 0; i < kills; i++) {
    *added = -1;
    pid_t pid = fork();
    if (pid == 0) {
      struct store *store = NULL;
      struct fixture_inputs inputs;
      static struct fixture_run f;
      int64_t point;
      if (store_open_writer(path, &store, NULL, 0, NULL) != STATUS_OK)
        _exit(2);
      int64_t from = (int64_t)before / (M * K);
      *added = (int64_t)before;
      for (int64_t r = from; r < INT64_MAX; r++)
        for (int p = 0; p < M * K; p++) {
          struct scene scene = fixture_scene(&inputs, 6 + p / K, pow(10, 30 + p % K));
          if (r == from && store_add_point(store, 0, &scene, 2, fixture_axes, &point, NULL) != STATUS_OK)
            _exit(3);
          fixture_fill(&f, &scene, p + 1, 0, r, FIXTURE_FRAGMENTS);
          bool new = !store_has_run(store, f.run.identity);
          if (store_add_run(store, &f.run, NULL) != STATUS_OK)
            _exit(4);
          *added += new;
        }
    }
    /* Kills after a random number of further runs, up to three batches, and a short delay; every fifth kill falls into
     * making or opening the store. */
    int64_t enough = (int64_t)(before + 1500 * fixture_random(11, (uint64_t)i));
    double start = clock_s();
    while (i % 5 && *(volatile int64_t *)added < enough && clock_s() - start < 20)
      usleep(200);
    usleep((useconds_t)(8000 * fixture_random(12, (uint64_t)i)));
    kill(pid, SIGKILL);
    int ending;
    waitpid(pid, &ending, 0);
    assert_true(WIFSIGNALED(ending)); /* it did not fail before the kill */
    struct store *store = NULL;
    status result = store_open_reader(path, &store, &error);
    store_close(store, NULL);
    if (result == STATUS_CONTENT || result == STATUS_MISSING) { /* killed before the first commit: empty */
      assert_true(before == 0);
      continue;
    }
    double after = whole(path);
    if (after < before)
      fail_msg("committed runs were lost: %g, then %g", before, after);
    if ((double)*added - after > 500)
      fail_msg("more than a batch was lost: %lld added, %g there", (long long)*added, after);
    in_the_middle += after > before;
    before = after;
  }
  munmap(added, sizeof *added);
  assert_true(in_the_middle >= 3); /* enough kills did happen during writing */
  int64_t runs = (int64_t)before / (M * K) + 50;
  OK(fill(path, runs, &error));
  assert_near(whole(path), (double)(M * K * runs), 0);
  OK(fill(fixture_path(reference, "unkilled"), runs, &error));
  OWNED char *a = dump(path), *b = dump(reference);
  assert_string_equal(a, b);
}

/* A writer meets a full disk; then the same command with enough space. */
static void run_out_of_room(const char *path, void (*narrow)(void), void (*widen)(void)) {
  narrow();
  pid_t pid = fork();
  if (pid == 0) {
    struct error said = {0};
    status result = fill(path, RUNS, &said);
    bool clear = strstr(said.message, "give the same command again") || strstr(said.message, "Free some space");
    if (!clear)
      fprintf(stderr, "said (%d): %s\n", result, said.message);
    _exit(result == STATUS_IO && clear ? 0 : 1);
  }
  int ending;
  waitpid(pid, &ending, 0);
  widen();
  assert_true(WIFEXITED(ending));
  assert_int_equal(WEXITSTATUS(ending), 0);
  double kept = whole(path);
  assert_true(kept >= 500 && kept < M * K * RUNS); /* the disk did become full, after some batches */
  OK(fill(path, RUNS, &error));
  assert_near(whole(path), M * K * RUNS, 0);
}

static struct rlimit wide;
static void narrow_files(void) {
  getrlimit(RLIMIT_FSIZE, &wide);
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &(struct rlimit){.rlim_cur = 3000000, .rlim_max = wide.rlim_max});
}
static void widen_files(void) {
  setrlimit(RLIMIT_FSIZE, &wide);
}

TEST(file_size_limit_loses_nothing_committed) {
  char path[64];
  run_out_of_room(fixture_path(path, "narrow"), narrow_files, widen_files);
}

/* Not even the tables fit. The remaining file must not look like a store that was copied without its -wal file. */
TEST(no_room_for_a_table_leaves_no_file) {
  char path[64];
  struct store *store = NULL;
  fixture_path(path, "no-room");
  narrow_files();
  setrlimit(RLIMIT_FSIZE, &(struct rlimit){.rlim_cur = 40000, .rlim_max = wide.rlim_max});
  const status opened = store_open_writer(path, &store, NULL, 0, &error);
  widen_files();
  assert_int_equal(opened, STATUS_IO);
  assert_null(store);
  assert_int_not_equal(access(path, F_OK), 0);
  OK(fill(path, RUNS, &error));
}

static void copy_file(const char *from, const char *to) {
  char command[256];
  snprintf(command, sizeof command, "cp %s %s", from, to);
  assert_int_equal(system(command), 0);
}

/* A copy without the -wal file is refused, also if the store had runs already when its writer opened it. */
TEST(copies_without_their_log_are_refused) {
  char path[64], copy[64];
  struct store *store = NULL;
  fixture_path(copy, "log-copy");
  OK(fill(fixture_path(path, "log"), 10, &error));
  OK(store_open_writer(path, &store, NULL, 0, &error));
  copy_file(path, copy);
  OK(store_close(store, &error));
  assert_int_equal(store_open_reader(copy, &store, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "has no -wal file"));
  OK(store_open_reader(path, &store, &error));
  OK(store_close(store, &error));
}

static const char disk[] = "test-store-disk";
static void nothing(void) {}
static void enlarge_disk(void) {
  assert_int_equal(mount("tmpfs", disk, "tmpfs", MS_REMOUNT, "size=64m"), 0);
}

TEST(full_disk_loses_nothing_committed) {
  mkdir(disk, 0777);
  if (mount("tmpfs", disk, "tmpfs", 0, "size=5m") != 0) { /* needs root; the test above covers the rest */
    print_message("no right to mount a small disk: skipped\n");
    skip();
  }
  run_out_of_room("test-store-disk/full.db", nothing, enlarge_disk);
  assert_int_equal(umount(disk), 0);
}

TEST(without_permission) {
  char closed[] = "/tmp/clast-store-closed-XXXXXX"; /* the current folder may lie where no other user may go */
  char path[64], fresh[64], copy[64];
  assert_non_null(mkdtemp(closed));
  snprintf(path, sizeof path, "%s/a.db", closed);
  snprintf(fresh, sizeof fresh, "%s/new.db", closed);
  snprintf(copy, sizeof copy, "%s/copy.db", closed);
  OK(fill(path, 3, &error));
  chmod(path, 0444);
  chmod(closed, 0555);
  pid_t pid = fork();
  if (pid == 0) {
    struct store *store = NULL;
    struct error said = {0};
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0))
      _exit(9);
    if (store_open_writer(path, &store, NULL, 0, &said) != STATUS_IO)
      _exit(1);
    if (!strstr(said.message, "permission"))
      _exit(2);
    if (store_open_writer(fresh, &store, NULL, 0, &said) != STATUS_IO)
      _exit(3);
    if (store_open_reader(path, &store, &said) != STATUS_OK)
      _exit(4); /* a finished store reads */
    double runs = 0;
    if (answer_number(store, &runs, &said, "SELECT count(*) FROM run") != STATUS_OK || runs != 12)
      _exit(5);
    if (store_export(store, copy, &said) != STATUS_IO)
      _exit(6);
    store_close(store, NULL);
    _exit(0);
  }
  int ending;
  waitpid(pid, &ending, 0);
  chmod(closed, 0755);
  unlink(path);
  rmdir(closed);
  assert_true(WIFEXITED(ending));
  assert_int_equal(WEXITSTATUS(ending), 0);
}

/* A reader is in the middle of a query all the time: the writer neither waits nor fails, and the reader sees the state
 * at the query's start. */
TEST(reader_never_blocks_the_writer) {
  char path[64];
  struct store *writer = NULL, *reader = NULL;
  OK(fill(fixture_path(path, "stays"), 50, &error));
  OK(store_open_writer(path, &writer, NULL, 0, &error));
  OK(store_open_reader(path, &reader, &error));
  sqlite3_stmt *half = NULL;
  sqlite3_prepare_v2(reader->db, "SELECT run_id FROM run", -1, &half, NULL);
  assert_int_equal(sqlite3_step(half), SQLITE_ROW);
  double start = clock_s();
  OK(fixture_populate(writer, M, K, RUNS, true, &error));
  OK(store_flush(writer, &error));
  double spent = clock_s() - start;
  int seen = 1;
  while (sqlite3_step(half) == SQLITE_ROW)
    seen++;
  assert_int_equal(seen, M * K * 50); /* as it was when the query began */
  sqlite3_reset(half);
  assert_near(number(reader, "SELECT count(*) FROM run"), M * K * RUNS, 0);
  if (spent > 30)
    fail_msg("the writer waited: %g s", spent); /* 6000 runs take half a second; a wait would take 10 s each */
  assert_int_equal(sqlite3_step(half), SQLITE_ROW);
  OK(store_close(writer, &error)); /* leaving WAL mode is impossible now; this is no error */
  sqlite3_finalize(half);
  store_close(reader, NULL);
  assert_near(whole(path), M * K * RUNS, 0);
}

/* After a failed write, the store refuses further runs with an error; the runs of the lost batch do not count as
 * stored. */
TEST(after_a_failure_nothing_is_pretended) {
  char path[64];
  struct store *store = NULL;
  struct fixture_inputs inputs;
  struct scene scene = fixture_scene(&inputs, 6, 1e30);
  static struct fixture_run f;
  int64_t point;
  OK(store_open_writer(fixture_path(path, "failed-write"), &store, NULL, 0, &error));
  OK(store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error));
  OK(store_flush(store, &error));
  fixture_fill(&f, &scene, point, 0, 0, 5);
  OK(store_add_run(store, &f.run, &error));
  assert_true(store_has_run(store, f.run.identity));
  uint8_t first[16];
  memcpy(first, f.run.identity, 16);
  sqlite3_exec(store->db, "PRAGMA max_page_count = 1", NULL, NULL, NULL); /* = as many as there are */
  status result = STATUS_OK;
  for (int r = 1; r < 2000 && result == STATUS_OK; r++) {
    fixture_fill(&f, &scene, point, 0, r, FIXTURE_FRAGMENTS);
    result = store_add_run(store, &f.run, &error);
  }
  assert_int_equal(result, STATUS_IO);
  assert_non_null(strstr(error.message, "disk is full"));
  assert_false(store_has_run(store, first));
  assert_int_equal(store_add_run(store, &f.run, &error), STATUS_IO);
  assert_non_null(strstr(error.message, "earlier write failed"));
  store_close(store, NULL);
  assert_near(whole(path), 0, 0);
}
