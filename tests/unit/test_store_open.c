/* Which stores open, which are refused with which message, which are migrated, and who may write. */
#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "db/ask/ask.h"
#include "db/store/internal.h"
#include "db/store/schema.h"
#include "tests/support/check.h"
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

TEST(foreign_files_are_refused) {
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

TEST(missing_and_unreachable) {
  char path[64];
  refused(fixture_path(path, "absent/x"), STATUS_IO, STATUS_MISSING, "folder");
  mkdir("test-store-folder.db", 0777);
  refused("test-store-folder.db", STATUS_IO, STATUS_IO, "folder");
  struct store *store = NULL;
  assert_int_equal(store_open_reader(fixture_path(path, "absent"), &store, &error), STATUS_MISSING);
  assert_int_not_equal(access(path, F_OK), 0); /* opening a missing store makes no file */
}

TEST(empty_file_is_a_new_store) {
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
TEST(failed_creation_leaves_an_empty_file) {
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

/* Versions 0 to 2 are from before the first release: refused, with the remedy, and not changed. */
TEST(oldest_stores_are_refused) {
  char path[64];
  populated(fixture_path(path, "old"));
  for (int version = 0; version < SCHEMA_OLDEST; version++) {
    static const char *const old[] = {"PRAGMA user_version = 0", "PRAGMA user_version = 1", "PRAGMA user_version = 2"};
    sql(path, old[version]);
    refused(path, STATUS_CONTENT, STATUS_CONTENT, "SELECT document FROM campaign");
  }
}

/* A reader needs every column of the common tables. A writer adds columns and tables that an older program lacked; they
 * are NULL in old runs. */
TEST(missing_columns_are_added_by_a_writer) {
  static const char *const less[] = {"DROP VIEW runs; DROP VIEW points; ALTER TABLE run DROP COLUMN momentum_error; "
                                     "ALTER TABLE result_fake DROP COLUMN "
                                     "hardest",
                                     "DROP TABLE shape_file"};
  for (size_t i = 0; i < 2; i++) {
    char path[64];
    struct store *store = NULL;
    populated(fixture_path(path, "less"));
    sql(path, less[i]);
    assert_int_equal(store_open_reader(path, &store, &error), STATUS_CONTENT);
    assert_non_null(strstr(error.message, "older clast"));
    assert_non_null(strstr(error.message, "clast merge"));
    OK(store_open_writer(path, &store, NULL, 0, &error));
    assert_near(number(store, "SELECT count(*) FROM points WHERE n = 10 AND material_m >= 6"), 4, 0);
    assert_near(number(store, "SELECT count(momentum_error) FROM runs"), i == 0 ? 0 : 40, 0);
    OK(fixture_populate(store, 2, 2, 11, false, &error)); /* and can be written */
    assert_near(number(store, "SELECT count(hardest) FROM runs"), i == 0 ? 4 : 44, 0);
    OK(store_close(store, &error));
    OK(store_open_reader(path, &store, &error));
    assert_near(number(store, "SELECT count(*) FROM column_doc WHERE column_name = 'momentum_error'"), 2, 0);
    if (store_check(store, NULL, NULL, &error) != STATUS_OK && i > 0)
      fail_msg("%s", error.message);
    OK(store_close(store, &error));
  }
}

/* A migration that cannot finish leaves the old store unchanged. */
TEST(failed_migration_changes_nothing) {
  char path[64];
  struct store *store = NULL;
  populated(fixture_path(path, "stuck"));
  sql(path,
      "DROP VIEW points; DROP TABLE point_total; DROP TABLE run; PRAGMA user_version = 3; CREATE TABLE run (odd TEXT)");
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

TEST(second_writer_is_told_who_holds_it) {
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

static struct {
  sqlite3 *db;
  int calls, told, lets_go_after; /* never: below 0 */
} holder;

static bool waits(const char *path, bool tell) {
  assert_non_null(strstr(path, ".db"));
  holder.told += tell;
  if (++holder.calls == holder.lets_go_after)
    assert_int_equal(sqlite3_exec(holder.db, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
  return holder.lets_go_after >= 0 || holder.calls < 5;
}

/* Another program takes the store now, and lets go after some calls of waits(). */
static void held(const char *how, int lets_go_after) {
  holder.calls = holder.told = 0;
  holder.lets_go_after = lets_go_after;
  assert_int_equal(sqlite3_exec(holder.db, how, NULL, NULL, NULL), SQLITE_OK);
}

static int open_twice(const char *name, char *path, struct store **store) {
  populated(fixture_path(path, name));
  store_on_wait(waits);
  if (store)
    OK(store_open_writer(path, store, NULL, 0, &error));
  return sqlite3_open(path, &holder.db);
}

/* Every call that writes or reads waits for another program, wherever in the life of a store it comes. */
TEST(every_call_waits_for_another_program) {
  char path[64], other[64];
  struct store *store = NULL;
  int64_t session = 0, campaign = 0, added = 0, differing = 0;
  populated(fixture_path(other, "source"));
  assert_int_equal(open_twice("waits", path, NULL), SQLITE_OK);
#define WAITED_FOR(how_, call_)                                                                                        \
  held(how_, 5);                                                                                                       \
  OK(call_);                                                                                                           \
  assert_int_equal(holder.calls, 5)
  WAITED_FOR("BEGIN EXCLUSIVE", store_open_reader(path, &store, &error));
  OK(store_close(store, &error));
  WAITED_FOR("BEGIN EXCLUSIVE", store_open_writer(path, &store, NULL, 0, &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_begin_session(store, "{}", &session, &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_add_campaign(store, "c", "name: c", "{}", &campaign, &error));
  OK(store_flush(store, &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_set_session(store, session, campaign, &error));
  OK(store_flush(store, &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_merge(store, other, &added, &differing, &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_end_session(store, session, "finished", &error));
  WAITED_FOR("BEGIN IMMEDIATE", store_close(store, &error));
  sqlite3_close(holder.db);
  store_on_wait(NULL);
}

/* Told once, after a second. A wait that is ended is no fault of the store: the same command goes on. */
TEST(a_wait_that_is_ended_is_a_stop) {
  char path[64];
  struct store *store = NULL;
  assert_int_equal(open_twice("ended", path, NULL), SQLITE_OK);
  held("BEGIN EXCLUSIVE", 130); /* of 1 ms each at first, then of 50 ms */
  OK(store_open_reader(path, &store, &error));
  assert_int_equal(holder.told, 1);
  OK(store_close(store, &error));
  held("BEGIN EXCLUSIVE", -1);
  assert_int_equal(store_open_writer(path, &store, NULL, 0, &error), STATUS_STOPPED);
  assert_non_null(strstr(error.message, "Another program"));
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_STOPPED);
  sqlite3_close(holder.db);
  store_on_wait(NULL);
}

TEST(a_free_store_is_taken_at_once) {
  char path[64];
  struct store *store = NULL;
  assert_int_equal(open_twice("free", path, &store), SQLITE_OK);
  held("BEGIN IMMEDIATE", 0);
  assert_false(store_begin_within(store, 0));
  assert_true(holder.calls <= 1);
  assert_int_equal(sqlite3_exec(holder.db, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
  assert_true(store_begin_within(store, 0));
  assert_int_equal(sqlite3_exec(holder.db, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_BUSY);
  OK(store_flush(store, &error));
  held("BEGIN IMMEDIATE", 0);
  store_hurry(store, 0.2); /* all later waits together */
  assert_int_equal(store_end_session(store, 1, "x", &error), STATUS_STOPPED);
  sqlite3_close(holder.db);
  OK(store_close(store, &error));
  store_on_wait(NULL);
}

TEST(reader_refuses_to_write) {
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

TEST(local_disk_brings_no_warning) {
  char path[64], warning[300] = "left";
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "warning"), &store, warning, sizeof warning, &error));
  assert_string_equal(warning, "");
  OK(store_close(store, &error));
}
