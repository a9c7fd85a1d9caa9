/* Which stores open, which are refused with which message, which are migrated, and who may write. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "db/ask/campaign.h"
#include "db/ask/columns.h"
#include "db/store/internal.h"
#include "db/store/schema.h"
#include "tests/support/store_checks.h"

static void populated(const char *path) {
  struct store *store = NULL;
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 2, 10, false, &error));
  OK(store_close(store, &error));
}

static void sql(const char *path, const char *text) {
  sqlite3 *db = NULL;
  char *message = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  if (sqlite3_exec(db, text, NULL, NULL, &message) != SQLITE_OK)
    fail_msg("%s", message);
  sqlite3_close(db);
}

static long long size_of(const char *path) {
  struct stat file;
  return stat(path, &file) == 0 ? (long long)file.st_size : -1;
}

/* Both ways of opening refuse with this status and this word, and leave the file unchanged. */
static void refused(const char *path, status writing, status reading, const char *word) {
  struct store *store = NULL;
  long long before = size_of(path);
  error.message[0] = 0;
  if (store_open_writer(path, &store, NULL, 0, &error) != writing || store)
    fail_msg("writer: %d %s", error.status, error.message);
  if (writing != STATUS_OK && !strstr(error.message, word))
    fail_msg("writer said: %s", error.message);
  error.message[0] = 0;
  if (store_open_reader(path, &store, &error) != reading || store)
    fail_msg("reader: %d %s", error.status, error.message);
  if (reading == STATUS_CONTENT && !strstr(error.message, word))
    fail_msg("reader said: %s", error.message);
  assert_true(strstr(error.message, path) != NULL);
  assert_true(size_of(path) == before);
}

static void foreign_files_are_refused(void **state) {
  (void)state;
  char path[64];
  fixture_path(path, "text");
  FILE *out = fopen(path, "w");
  for (int i = 0; i < 500; i++)
    fputs("name: not a database, but a campaign\n", out);
  fclose(out);
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "no SQLite database");

  sql(fixture_path(path, "other"), "CREATE TABLE song (title TEXT); INSERT INTO song VALUES ('x')");
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "another program");
  sql(fixture_path(path, "gpkg"), "PRAGMA application_id = 1196444487; CREATE TABLE t (a)");
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "0x47504b47");

  populated(fixture_path(path, "newer"));
  sql(path, "PRAGMA user_version = 99");
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "newer clast");

  populated(fixture_path(path, "short"));
  assert_int_equal(truncate(path, size_of(path) / 2 / 4096 * 4096), 0);
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "cut short");
  populated(fixture_path(path, "stump"));
  assert_int_equal(truncate(path, 57), 0);
  refused(path, STATUS_CONTENT, STATUS_CONTENT, "damaged");
}

static void missing_and_unreachable(void **state) {
  (void)state;
  char path[64];
  refused(fixture_path(path, "absent/x"), STATUS_IO, STATUS_MISSING, "folder");
  mkdir("test-store-folder.db", 0777);
  refused("test-store-folder.db", STATUS_IO, STATUS_IO, "folder");
  struct store *store = NULL;
  assert_int_equal(store_open_reader(fixture_path(path, "absent"), &store, &error), STATUS_MISSING);
  assert_int_not_equal(access(path, F_OK), 0); /* opening a missing store makes no file */
}

static void empty_file_is_a_new_store(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  FILE *out = fopen(fixture_path(path, "empty"), "w");
  fclose(out);
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "empty"));
  populated(path);
  OK(store_open_reader(path, &store, &error));
  assert_near(number(store, "SELECT count(*) FROM run"), 40, 0);
  store_close(store, NULL);
}

/* A file without a table is an empty file, not an incomplete copy. */
static void failed_creation_leaves_an_empty_file(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  struct rlimit wide;
  getrlimit(RLIMIT_FSIZE, &wide);
  signal(SIGXFSZ, SIG_IGN);
  fclose(fopen(fixture_path(path, "no-room"), "w"));
  setrlimit(RLIMIT_FSIZE, &(struct rlimit){.rlim_cur = 20000, .rlim_max = wide.rlim_max});
  const status made = store_open_writer(path, &store, NULL, 0, &error);
  setrlimit(RLIMIT_FSIZE, &wide);
  assert_int_equal(made, STATUS_IO);
  assert_int_equal(size_of(path), 0);
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "is empty"));
  populated(path);
}

/* Version 0: no running sums, no bin edges, views of another shape; later columns are absent. */
static void old_store_is_brought_forward(void **state) {
  (void)state;
  char path[64], backup[80];
  struct store *store = NULL;
  populated(fixture_path(path, "old"));
  OK(store_open_reader(path, &store, &error));
  double mass = number(store, "SELECT sum(mass) FROM point_spectrum"),
         rows = number(store, "SELECT count(*) FROM point_spectrum");
  store_close(store, NULL);
  sql(path, "DROP VIEW runs; DROP VIEW points; DROP VIEW spectra; DROP VIEW estimates;"
            "DROP TABLE point_total; DROP TABLE point_spectrum; DROP TABLE bin; DROP TABLE holder;"
            "ALTER TABLE run DROP COLUMN digest; ALTER TABLE point DROP COLUMN digest;"
            "ALTER TABLE result_fake DROP COLUMN hardest; ALTER TABLE run DROP COLUMN momentum_error;"
            "CREATE VIEW runs AS SELECT 1; PRAGMA user_version = 0");
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "older"));
  OK(store_open_writer(path, &store, NULL, 0, &error));
  assert_near(number(store, "PRAGMA user_version"), SCHEMA_VERSION, 0);
  assert_near(number(store, "SELECT count(*) FROM point_spectrum"), rows, 0);
  assert_near(number(store, "SELECT sum(mass) FROM point_spectrum"), mass, 1e-12 * mass);
  assert_near(number(store, "SELECT count(*) FROM points WHERE n = 10 AND material_m >= 6"), 4, 0);
  assert_near(number(store, "SELECT momentum_error IS NULL FROM runs LIMIT 1"), 1, 0);
  OK(fixture_populate(store, 2, 2, 11, false, &error)); /* and can be written */
  assert_near(number(store, "SELECT count(hardest) FROM runs"), 4, 0);
  assert_near(number(store, "SELECT count(momentum_error) FROM runs"), 4, 0);
  OK(store_close(store, &error));
  snprintf(backup, sizeof backup, "%s.version0", path);
  sqlite3 *db = NULL;
  sqlite3_open(backup, &db);
  assert_int_equal(sqlite3_exec(db, "SELECT 1 FROM run; SELECT * FROM runs", NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
  assert_true(size_of(backup) > 10000);
  OK(store_open_reader(path, &store, &error));
  if (store_check(store, NULL, NULL, &error) != STATUS_OK)
    fail_msg("%s", error.message);
  store_close(store, NULL);
}

/* Version 1: no digests. A reader opens it unchanged; a writer adds them, equal to those of new runs. */
static void digests_are_added(void **state) {
  (void)state;
  static const char columns[] = "ALTER TABLE run DROP COLUMN digest; ALTER TABLE point DROP COLUMN digest; PRAGMA "
                                "user_version = 1";
  char path[64], other[64];
  struct store *store = NULL;
  populated(fixture_path(path, "undigested"));
  populated(fixture_path(other, "digested"));
  sql(path, columns);
  OK(store_open_reader(path, &store, &error));
  assert_near(number(store, "SELECT count(*) FROM points"), 4, 0);
  OK(store_check(store, NULL, NULL, &error));
  store_close(store, NULL);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_close(store, &error));
  assert_true(size_of("test-store-undigested.db.version1") > 10000);
  sqlite3 *db = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  sql(path, "PRAGMA quick_check");
  assert_int_equal(sqlite3_exec(db, "ATTACH 'test-store-digested.db' AS other", NULL, NULL, NULL), SQLITE_OK);
  sqlite3_stmt *same = NULL;
  sqlite3_prepare_v2(db,
                     "SELECT (SELECT count(*) FROM main.run a JOIN other.run b USING (identity) WHERE a.digest = "
                     "b.digest), (SELECT count(*) FROM main.point a JOIN other.point b USING (hash) WHERE a.digest = "
                     "b.digest)",
                     -1, &same, NULL);
  assert_int_equal(sqlite3_step(same), SQLITE_ROW);
  assert_int_equal(sqlite3_column_int(same, 0), 40);
  assert_int_equal(sqlite3_column_int(same, 1), 4);
  sqlite3_finalize(same);
  sqlite3_close(db);
  /* A source without digests is merged, and its runs get digests. */
  int64_t added = 0, differing = 0;
  sql(other, columns);
  unlink(fixture_path(path, "undigested"));
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_merge(store, other, &added, &differing, &error));
  assert_int_equal(added, 40);
  assert_near(number(store, "SELECT count(digest) FROM run"), 40, 0);
  assert_near(number(store, "SELECT count(digest) FROM point"), 4, 0);
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));
}

/* Version 2: no campaign in sessions, no document unit on axes. A reader opens it unchanged. */
static void sessions_get_their_campaign(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  struct ask_column axes[4];
  size_t count = 0;
  populated(fixture_path(path, "sessions"));
  sql(path, "ALTER TABLE session DROP COLUMN campaign_id; ALTER TABLE axis DROP COLUMN written_unit; "
            "PRAGMA user_version = 2");
  OK(store_open_reader(path, &store, &error));
  ANSWER progress = ask_campaign_progress(store, false, &error);
  assert_true(answer_next(&progress));
  OK(answer_end(&progress));
  OK(ask_columns_axes(store, true, 4, axes, &count, &error));
  assert_int_equal(count, 2);
  assert_string_equal(axes[1].unit, "1");
  OK(store_close(store, &error));
  OK(store_open_writer(path, &store, NULL, 0, &error));
  assert_near(number(store, "PRAGMA user_version"), SCHEMA_VERSION, 0);
  assert_near(number(store, "SELECT count(*) FROM session WHERE campaign_id = 1"), 1, 0);
  OK(store_add_axis(store, &fixture_input_rows[0], "%", &error));
  OK(ask_columns_axes(store, true, 4, axes, &count, &error));
  assert_string_equal(axes[1].name, "material_m");
  assert_string_equal(axes[1].unit, "%");
  assert_near(axes[1].factor, 0.01, 0);
  OK(store_add_axis(store, &fixture_input_rows[0], "km/s", &error)); /* not a unit of this input: refused */
  OK(ask_columns_axes(store, true, 4, axes, &count, &error));
  assert_string_equal(axes[1].unit, "1");
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));
}

/* Stores of earlier programs have a table of the fragments' motion: an empty one is removed, rows are kept. */
static void table_of_motion_goes_when_it_is_empty(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  for (int filled = 0; filled < 2; filled++) {
    populated(fixture_path(path, "motion"));
    sql(path, "CREATE TABLE fragment_motion (run_id INTEGER PRIMARY KEY REFERENCES run (run_id), motion BLOB NOT NULL) "
              "STRICT; INSERT INTO column_doc VALUES ('fragment_motion', 'motion', NULL, 'motion', 0)");
    if (filled)
      sql(path, "INSERT INTO fragment_motion VALUES (1, x'00')");
    OK(store_open_reader(path, &store, &error)); /* the version is the same: a reader may continue */
    OK(store_close(store, &error));
    OK(store_open_writer(path, &store, NULL, 0, &error));
    assert_near(number(store, "SELECT count(*) FROM sqlite_schema WHERE name = 'fragment_motion'"), filled, 0);
    assert_near(number(store, "SELECT count(*) FROM column_doc WHERE table_name = 'fragment_motion'"), filled, 0);
    OK(store_check(store, NULL, NULL, &error));
    OK(store_close(store, &error));
  }
}

/* A migration that cannot finish leaves the old store unchanged. */
static void failed_migration_changes_nothing(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  populated(fixture_path(path, "stuck"));
  sql(path,
      "DROP VIEW points; DROP TABLE point_total; DROP TABLE run; PRAGMA user_version = 0; CREATE TABLE run (odd TEXT)");
  assert_int_not_equal(store_open_writer(path, &store, NULL, 0, &error), STATUS_OK);
  assert_null(store);
  sqlite3 *db = NULL;
  sqlite3_open(path, &db);
  assert_int_equal(sqlite3_exec(db, "SELECT odd FROM run", NULL, NULL, NULL), SQLITE_OK);
  assert_int_not_equal(sqlite3_exec(db, "SELECT 1 FROM point_total", NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
}

/* A child that holds the store until its pipe is closed; *pid of it. */
static int hold(const char *path, pid_t *pid) {
  int ready[2], end[2];
  assert_int_equal(pipe(ready), 0);
  assert_int_equal(pipe(end), 0);
  *pid = fork();
  if (*pid == 0) {
    struct store *store = NULL;
    char byte = store_open_writer(path, &store, NULL, 0, &error) == STATUS_OK ? 'y' : 'n';
    close(end[1]);
    if (write(ready[1], &byte, 1) != 1 || read(end[0], &byte, 1) < 0)
      _exit(1);
    store_close(store, NULL);
    _exit(0);
  }
  char byte = 0;
  close(ready[1]);
  close(end[0]);
  assert_int_equal(read(ready[0], &byte, 1), 1);
  assert_int_equal(byte, 'y');
  close(ready[0]);
  return end[1];
}

static void second_writer_is_told_who_holds_it(void **state) {
  (void)state;
  char path[64], word[64], host[200] = "";
  struct store *store = NULL;
  pid_t pid;
  populated(fixture_path(path, "held"));
  int end = hold(path, &pid);
  assert_int_equal(store_open_writer(path, &store, NULL, 0, &error), STATUS_IO);
  snprintf(word, sizeof word, "process %d", (int)pid);
  gethostname(host, sizeof host - 1);
  if (!strstr(error.message, word) || !strstr(error.message, host))
    fail_msg("said: %s", error.message);
  OK(store_open_reader(path, &store, &error)); /* readers are not affected */
  assert_near(number(store, "SELECT count(*) FROM run"), 40, 0);
  store_close(store, NULL);
  close(end);
  waitpid(pid, NULL, 0);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_close(store, &error));
  /* the lock ends with its holder, however the holder ends, and a child of the holder does not keep it */
  end = hold(path, &pid);
  kill(pid, SIGKILL);
  waitpid(pid, NULL, 0);
  close(end);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_close(store, &error));
}

static void another_programs_lock_is_named_as_such(void **state) {
  (void)state;
  char path[64];
  populated(fixture_path(path, "browser"));
  sqlite3 *db = NULL;
  sqlite3_open(path, &db);
  assert_int_equal(sqlite3_exec(db, "BEGIN EXCLUSIVE", NULL, NULL, NULL), SQLITE_OK);
  if (getenv("CLAST_FULL")) { /* the writer waits 10 s before it gives up */
    struct store *store = NULL;
    assert_int_equal(store_open_writer(path, &store, NULL, 0, &error), STATUS_IO);
    assert_non_null(strstr(error.message, "Another program"));
  }
  sqlite3_close(db);
}

static void reader_refuses_to_write(void **state) {
  (void)state;
  char path[64];
  struct store *store = NULL;
  populated(fixture_path(path, "reader"));
  OK(store_open_reader(path, &store, &error));
  assert_int_equal(store_end_session(store, 1, "x", &error), STATUS_INTERNAL);
  assert_int_equal(sqlite3_exec(store->db, "DELETE FROM run", NULL, NULL, NULL), SQLITE_READONLY);
  assert_int_equal(sqlite3_exec(store->db, "PRAGMA query_only = OFF; DELETE FROM run", NULL, NULL, NULL),
                   SQLITE_READONLY);
  OK(store_close(store, &error));
  OK(store_close(NULL, &error));
}

static void local_disk_brings_no_warning(void **state) {
  (void)state;
  char path[64], warning[300] = "left";
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "warning"), &store, warning, sizeof warning, &error));
  assert_string_equal(warning, "");
  OK(store_close(store, &error));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(foreign_files_are_refused),
      cmocka_unit_test(missing_and_unreachable),
      cmocka_unit_test(empty_file_is_a_new_store),
      cmocka_unit_test(failed_creation_leaves_an_empty_file),
      cmocka_unit_test(old_store_is_brought_forward),
      cmocka_unit_test(digests_are_added),
      cmocka_unit_test(sessions_get_their_campaign),
      cmocka_unit_test(table_of_motion_goes_when_it_is_empty),
      cmocka_unit_test(failed_migration_changes_nothing),
      cmocka_unit_test(second_writer_is_told_who_holds_it),
      cmocka_unit_test(another_programs_lock_is_named_as_such),
      cmocka_unit_test(reader_refuses_to_write),
      cmocka_unit_test(local_disk_brings_no_warning),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
