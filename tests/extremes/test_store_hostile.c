/* Stores prepared by an attacker: their contents are only data. Each is refused, the message names the foreign objects,
 * and none of their SQL is run when the store is read, written or merged. */
#define CHECK_OWN_MAIN
#include <sqlite3.h>

#include <sys/stat.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "tests/support/check.h"
#include "tests/support/store_checks.h"

/* Changes a store as any program could. writable_schema lets SQL replace the text of a table, like a binary editor. */
static void change(const char *path, const char *text) {
  sqlite3 *db = NULL;
  char *message = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 0, NULL);
  if (sqlite3_exec(db, text, NULL, NULL, &message) != SQLITE_OK)
    fail_msg("%s: %s", text, message);
  sqlite3_close(db);
}

/* A store of four points and 40 runs. It is filled once; then its bytes are copied. */
static const char *populated(char path[64], const char *name) {
  static struct store_file whole;
  struct store *store = NULL;
  fixture_path(path, name);
  if (whole.bytes) {
    store_file_write(path, &whole);
    return path;
  }
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 2, 10, false, &error));
  OK(store_close(store, &error));
  whole = store_file_read(path);
  return path;
}

static void said(status code, const char *how, const char *name) {
  if (code != STATUS_CONTENT)
    fail_msg("%s: status %d instead of %d: %s", how, code, STATUS_CONTENT, error.message);
  if (!strstr(error.message, name))
    fail_msg("%s does not name %s: %s", how, name, error.message);
}

/* An empty store that merges of this program go into: it takes long to make. */
static struct store *target;

static int make_target(void **state) {
  (void)state;
  char path[64];
  OK(store_open_writer(fixture_path(path, "hostile-target"), &target, NULL, 0, &error));
  return 0;
}

static void target_is_sound(void) {
  OK(store_check(target, NULL, NULL, &error));
  OK(store_close(target, &error));
}

/* Reading, writing and merging all refuse the store and name the foreign object. */
static void refused(const char *path, const char *name) {
  struct store *store = NULL;
  int64_t added = 0, differing = 0;
  error.message[0] = 0;
  said(store_open_reader(path, &store, &error), "a reader", name);
  error.message[0] = 0;
  said(store_open_writer(path, &store, NULL, 0, &error), "a writer", name);
  said(store_merge(target, path, &added, &differing, &error), "merge", name);
  assert_int_equal(added, 0);
}

/* A trigger that deletes every run: a campaign would compute and store nothing. */
TEST(triggers_are_refused) {
  char path[64];
  change(populated(path, "hostile-trigger"),
         "CREATE TRIGGER swallow AFTER INSERT ON run BEGIN DELETE FROM run WHERE run_id = new.run_id; END");
  refused(path, "swallow");
  /* a trigger under the name of a view, recognisable only by its text */
  change(populated(path, "hostile-trigger"),
         "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = 'CREATE TRIGGER points AFTER INSERT ON run BEGIN "
         "DELETE FROM run; END' WHERE name = 'points'");
  refused(path, "points");
}

/* A view of another name is refused. The file's versions of our own views are never run: the reader makes its own. */
TEST(views_are_refused_or_replaced) {
  char path[64];
  struct store *store = NULL;
  change(populated(path, "hostile-view"), "CREATE VIEW more AS SELECT * FROM run");
  refused(path, "more");
  change(populated(path, "hostile-view"),
         "DROP VIEW runs; CREATE VIEW runs AS SELECT 1 AS counts, 0.5 AS largest_fraction, randomblob(100000000) AS x");
  OK(store_open_reader(path, &store, &error));
  assert_near(number(store, "SELECT count(*) FROM runs"), 40, 0);
  OK(store_close(store, &error));
  OK(store_open_writer(path, &store, NULL, 0, &error));
  assert_near(number(store, "SELECT count(*) FROM runs"), 40, 0);
  OK(store_close(store, &error));
  sqlite3 *db = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK); /* other programs see the view that the writer made again */
  assert_int_equal(sqlite3_exec(db, "SELECT run_id, identity FROM runs", NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
}

TEST(virtual_tables_are_refused) {
  char path[64];
  change(populated(path, "hostile-virtual"), "CREATE VIRTUAL TABLE result_x USING fts5(run_id)");
  refused(path, "result_x");
}

/* The text of a table holds a second statement: SQLite reads only the first; a program that executes the text executes
 * both. */
TEST(second_statement_is_never_run) {
  char path[64], victim[64];
  struct store *store = NULL;
  int64_t added = 0, differing = 0;
  populated(victim, "hostile-victim");
  populated(path, "hostile-two");
  change(path, "CREATE TABLE result_x (run_id INTEGER PRIMARY KEY REFERENCES run (run_id), y REAL) STRICT;"
               "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = sql || '; COMMIT; ATTACH "
               "''test-store-hostile-victim.db'' AS v; DELETE FROM v.run; BEGIN' WHERE name = 'result_x'");
  char alone[64]; /* the other statement begins and ends transactions */
  OK(store_open_writer(fixture_path(alone, "hostile-alone"), &store, NULL, 0, &error));
  struct error refusal = {0};
  status merged = store_merge(store, path, &added, &differing, &refusal);
  store_close(store, NULL);
  OK(store_open_reader(victim, &store, &error));
  assert_near(number(store, "SELECT count(*) FROM run"), 40, 0);
  store_close(store, NULL);
  error = refusal;
  said(merged, "merge", "result_x");
  refused(path, "result_x");
}

/* Names of a table, a column and an axis that contain a closing quotation mark. */
TEST(names_are_names) {
  char path[64];
  change(populated(path, "hostile-names"),
         "CREATE TABLE \"result_x\"\" AS y; DROP TABLE run; --\" (run_id INTEGER PRIMARY KEY) STRICT");
  refused(path, "DROP TABLE run");
  change(populated(path, "hostile-names"), "ALTER TABLE result_fake ADD COLUMN \"a\"\", (SELECT 1) AS \"\"b\" REAL");
  refused(path, "result_fake");
  change(populated(path, "hostile-names"),
         "UPDATE axis SET column_name = 'm\", (SELECT scene FROM point) AS \"n' WHERE path = 'material.m'");
  refused(path, "material.m");
  change(populated(path, "hostile-names"), "UPDATE axis SET column_name = 'run_id' WHERE path = 'material.m'");
  refused(path, "material.m");
  change(populated(path, "hostile-names"),
         "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2500) INSERT INTO axis (path, "
         "column_name, meaning) SELECT 'p' || i, 'p' || i, '' FROM n");
  refused(path, "the column of axis");
}

TEST(generated_columns_are_refused) {
  char path[64];
  change(populated(path, "hostile-generated"), "ALTER TABLE run ADD COLUMN made REAL AS (total_mass * 2) VIRTUAL");
  refused(path, "made");
  change(populated(path, "hostile-generated"), "ALTER TABLE run ADD COLUMN late REAL CHECK (late IS NULL)");
  refused(path, "late");
  change(populated(path, "hostile-generated"), "ALTER TABLE run ADD COLUMN filled REAL DEFAULT 7");
  refused(path, "filled");
  /* a rule that no run can satisfy */
  change(populated(path, "hostile-generated"),
         "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, '''completed''', '''nothing''') "
         "WHERE name = 'run'");
  refused(path, "counts");
}

TEST(index_expressions_are_refused) {
  char path[64];
  change(populated(path, "hostile-index"), "CREATE INDEX dear ON run (hex(zeroblob(rank)))");
  refused(path, "dear");
  change(populated(path, "hostile-index"),
         "DROP INDEX run_statistics; CREATE INDEX run_statistics ON run (abs(point_id))");
  refused(path, "run_statistics");
  change(populated(path, "hostile-index"), "CREATE UNIQUE INDEX once ON run (replicate, point_id)");
  refused(path, "once");
}

/* SQLite cannot attach a file of another encoding: a merge from it, and into it, would fail in the middle. */
TEST(utf16_is_refused) {
  char path[64], text[200];
  sqlite3 *db = NULL;
  snprintf(text, sizeof text,
           "PRAGMA encoding = 'UTF-16le'; CREATE TABLE a (b); DROP TABLE a; PRAGMA application_id = %d; PRAGMA "
           "user_version = %d",
           SCHEMA_APPLICATION_ID, SCHEMA_VERSION);
  assert_int_equal(sqlite3_open(fixture_path(path, "hostile-utf16"), &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db, text, NULL, NULL, NULL), SQLITE_OK);
  sqlite3_close(db);
  refused(path, "UTF-16");
}

/* Opening a pipe blocks until another process writes to it. */
TEST(pipes_and_devices_are_no_stores) {
  char pipe[64];
  struct store *store = NULL;
  assert_int_equal(mkfifo(fixture_path(pipe, "hostile-pipe"), 0600), 0);
  const char *const paths[] = {pipe, "/dev/null"};
  for (int i = 0; i < 2; i++) {
    assert_int_equal(store_open_reader(paths[i], &store, &error), STATUS_IO);
    assert_non_null(strstr(error.message, "is a pipe, socket or device"));
    assert_int_equal(store_open_writer(paths[i], &store, NULL, 0, &error), STATUS_IO);
    assert_non_null(strstr(error.message, "is a pipe, socket or device"));
  }
  unlink(pipe);
  /* a pipe beside a store */
  char path[64], beside[80];
  snprintf(beside, sizeof beside, "%s-journal", populated(path, "hostile-beside"));
  assert_int_equal(mkfifo(beside, 0600), 0);
  alarm(60); /* without the check, SQLite waits for a writer */
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_IO);
  assert_non_null(strstr(error.message, "-journal is a folder, link, pipe"));
  assert_int_equal(store_open_writer(path, &store, NULL, 0, &error), STATUS_IO);
  assert_non_null(strstr(error.message, "-journal is a folder, link, pipe"));
  alarm(0);
  unlink(beside);
}

/* The journal of another store is not read into this one; the message says why it cannot be read. */
TEST(journal_of_another_store_is_named) {
  char path[64], other[64], text[300];
  struct store *store = NULL;
  sqlite3 *db = NULL;
  populated(path, "hostile-journal");
  populated(other, "hostile-other");
  assert_int_equal(sqlite3_open(other, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db,
                                "PRAGMA journal_mode = DELETE; PRAGMA cache_size = 2; BEGIN; UPDATE run SET rank = 9; "
                                "UPDATE spectrum SET count = 9; UPDATE point_spectrum SET runs = 9",
                                NULL, NULL, NULL),
                   SQLITE_OK);
  sqlite3_db_cacheflush(db);
  snprintf(text, sizeof text, "cp %s-journal %s-journal", other, path);
  assert_int_equal(system(text), 0);
  sqlite3_close(db);
  assert_int_equal(store_open_reader(path, &store, &error), STATUS_IO);
  assert_non_null(strstr(error.message, "lies beside it"));
  snprintf(text, sizeof text, "%s-journal", path);
  unlink(text);
  OK(store_open_reader(path, &store, &error));
  OK(store_check(store, NULL, NULL, &error));
  OK(store_close(store, &error));
}

/* A journal with the name of a super-journal: SQLite deletes the file of that name after the rollback. */
TEST(journal_deletes_nothing) {
  static const unsigned char magic[8] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
  char path[64], journal[80], victim[64];
  populated(path, "hostile-super");
  fixture_path(victim, "hostile-victim");
  FILE *file = fopen(victim, "w");
  assert_non_null(file);
  assert_true(fputs("to be kept", file) >= 0 && fclose(file) == 0);
  snprintf(journal, sizeof journal, "%s-journal", path);
  file = fopen(journal, "w");
  assert_non_null(file);
  unsigned char bytes[512 + 4] = {0};
  memcpy(bytes, magic, sizeof magic);
  memcpy(bytes + 20, (const unsigned char[]){0, 0, 2, 0, 0, 0, 16}, 7); /* sectors of 512, pages of 4096 bytes */
  memcpy(bytes + 512, (const unsigned char[]){4, 0, 0, 0}, 4);
  fwrite(bytes, 1, sizeof bytes, file);
  unsigned sum = 0, length = (unsigned)strlen(victim);
  for (unsigned i = 0; i < length; i++)
    sum += (unsigned char)victim[i];
  fputs(victim, file);
  fwrite((const unsigned char[]){0, 0, 0, (unsigned char)length, 0, 0, (unsigned char)(sum >> 8), (unsigned char)sum},
         1, 8, file);
  fwrite(magic, 1, sizeof magic, file);
  assert_int_equal(fclose(file), 0);
  refused(path, "-journal");
  assert_int_equal(access(victim, F_OK), 0);
  unlink(journal);
  unlink(victim);
}

static void collect(void *context, const char *text) {
  char *all = context;
  snprintf(all + strlen(all), 8000 - strlen(all), "%.300s\n", text);
}

/* Rows of other types and sizes than the schema says: the file's bytes decide, not its text. */
TEST(huge_and_odd_rows_are_found) {
  static const char *const odd[] = {
      "UPDATE fragment_mass SET masses = (WITH RECURSIVE n (i, t) AS (SELECT 1, 'ä' UNION ALL SELECT i + 1, t || t "
      "FROM "
      "n WHERE i < 22) SELECT max(t) FROM n) WHERE run_id = 3", /* text of 4 MiB, in which length() counts letters */
      "UPDATE fragment_mass SET masses = 7 WHERE run_id = 3",
      "UPDATE point SET scene = NULL WHERE point_id = 2",
      "UPDATE point SET scene = x'ff00', scene_name = NULL, engine = NULL",
      "UPDATE run SET state = NULL, identity = NULL, replicate = 'x' WHERE run_id = 5",
      "UPDATE bin SET lower = NULL",
      "UPDATE spectrum SET bin = 9223372036854775807 WHERE run_id = 4 AND bin = -4",
      "UPDATE spectrum SET bin = 3000000000 WHERE run_id = 4 AND bin = -4", /* does not fit 32 bits */
      "UPDATE spectrum SET count = -5 WHERE run_id = 4 AND bin = -4",
      "UPDATE spectrum SET count = 4000000000 WHERE run_id = 4 AND bin = -4", /* its square does not fit 64 bits */
      "UPDATE point SET scene = (WITH RECURSIVE n (i, t) AS (SELECT 1, '[' UNION ALL SELECT i + 1, t || t FROM n WHERE "
      "i < 21) SELECT max(t) FROM n)" /* a million brackets deep */
  };
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; i++) {
    char path[64], copy[64], sql[2000], found[8000] = "";
    struct store *store = NULL;
    int64_t added = 0, differing = 0, point = 1;
    populated(path, "hostile-rows");
    /* Without STRICT, NOT NULL and CHECK any row can be inserted; afterwards the text is restored. */
    snprintf(
        sql, sizeof sql,
        "CREATE TABLE kept AS SELECT name, sql FROM sqlite_schema WHERE name IN ('fragment_mass', 'point', 'run', "
        "'bin', 'spectrum'); PRAGMA writable_schema = ON; PRAGMA ignore_check_constraints = ON; UPDATE "
        "sqlite_schema SET sql = replace(replace(replace(replace(replace(sql, 'IS NOT NULL', 'NOTNULL'), 'NOT NULL', "
        "''), "
        "'NOTNULL', 'IS NOT NULL'), 'STRICT, WITHOUT', 'WITHOUT'), ') STRICT', ')') WHERE name IN (SELECT name FROM "
        "kept); PRAGMA schema_version = 7000");
    change(path, sql);
    snprintf(sql, sizeof sql,
             "PRAGMA ignore_check_constraints = ON; %s; PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = "
             "(SELECT sql FROM kept WHERE kept.name = sqlite_master.name) WHERE name IN (SELECT name FROM kept); DROP "
             "TABLE kept; PRAGMA schema_version = 9000",
             odd[i]);
    change(path, sql);
    if (store_open_reader(path, &store, &error) == STATUS_OK) {
      if (store_check(store, collect, found, &error) != STATUS_CONTENT)
        fail_msg("%s: not found: %s", odd[i], error.message);
      unlink(fixture_path(copy, "hostile-copy"));
      FILE *nowhere = fopen("/dev/null", "w");
      assert_non_null(nowhere);
      store_export_digests(store, nowhere, &error);
      fclose(nowhere);
      double count = 0;
      answer_number(store, &count, &error, "SELECT count(*) FROM points");
      OK(store_close(store, &error));
    }
    if (store_merge(target, path, &added, &differing, &error) == STATUS_OK || added)
      fail_msg("%s: merged", odd[i]);
    if (store_open_writer(path, &store, NULL, 0, &error) == STATUS_OK) {
      struct fixture_inputs inputs;
      struct scene scene = fixture_scene(&inputs, 6, 1e30);
      store_add_point(store, 0, &scene, 2, fixture_axes, &point, &error);
      store_close(store, NULL);
    }
  }
}

#ifdef __SANITIZE_ADDRESS__ /* the first rounds run under sanitizers, the others without */
enum { FIRST_ROUND = 0, ROUNDS = 20 };
#else
enum { FIRST_ROUND = 20, ROUNDS = 60 };
#endif

/* Noise of 200 bytes near the beginning of three pages. */
static void spoil(const char *path, uint64_t round) {
  FILE *file = fopen(path, "r+b");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  const long pages = ftell(file) / 4096;
  for (uint64_t k = 0; k < 3; k++) {
    const long page = 1 + (long)(fixture_random(round, k) * (double)(pages - 1));
    fseek(file, 4096 * page + (long)(fixture_random(round, 10 + k) * 64), SEEK_SET);
    for (uint64_t i = 0; i < 200; i++)
      fputc((int)(256 * fixture_random(round * 3 + k, 100 + i)), file);
  }
  fclose(file);
}

/* Pages of noise: an error or a problem, never a crash. Rows may go into another store only if check finds nothing
 * because the noise hit no row; these rows are then correct. */
TEST(corrupt_pages_are_errors) {
  char path[64];
  populated(path, "hostile-pages");
  OWNED char *whole = dump(path);
  int found_whole = 0;
  for (uint64_t round = FIRST_ROUND; round < ROUNDS; round++) {
    char found[8000] = "";
    struct store *store = NULL;
    int64_t added = 0, differing = 0;
    populated(path, "hostile-pages");
    spoil(path, round);
    status checked = store_open_reader(path, &store, &error);
    if (checked == STATUS_OK)
      checked = store_check(store, collect, found, &error);
    store_close(store, NULL);
    const status merged = store_merge(target, path, &added, &differing, &error);
    if (merged == STATUS_OK && checked != STATUS_OK)
      fail_msg("round %d: merged in spite of: %s", (int)round, found);
    if (checked == STATUS_OK) {
      OWNED char *text = dump(path);
      assert_string_equal(text, whole);
      found_whole++;
    }
    if (merged != STATUS_OK) {
      assert_int_equal(added, 0);
    } else {
      target_is_sound();
      make_target(NULL);
    }
    if (store_open_writer(path, &store, NULL, 0, &error) == STATUS_OK)
      store_close(store, NULL);
  }
  assert_in_range(found_whole, 0, 10);
}

static void put_16(uint8_t *place, size_t value) {
  place[0] = (uint8_t)(value >> 8);
  place[1] = (uint8_t)value;
}

static void put_32(uint8_t *place, size_t value) {
  put_16(place, value >> 16);
  put_16(place + 2, value & 0xffff);
}

/* An interior page of a table (sqlite.org/fileformat2.html, section 1.6) whose five children are all the page `child`.
 */
static void branch(uint8_t page[4096], size_t child) {
  enum { CELLS = 4, CELL_SIZE = 5, HEADER = 12 };
  memset(page, 0, 4096);
  page[0] = 5;
  put_16(page + 3, CELLS);
  put_16(page + 5, 4096 - CELLS * CELL_SIZE);
  put_32(page + 8, child);
  for (size_t i = 0; i < CELLS; i++) {
    const size_t cell = 4096 - (i + 1) * CELL_SIZE;
    put_16(page + HEADER + 2 * i, cell);
    put_32(page + cell, child);
    page[cell + 4] = (uint8_t)(i + 1); /* the key */
  }
}

/* The table run seems to have 5^16 times its rows: each of 16 levels of pages refers to the next one five times. */
static void runs_without_end(const char *path) {
  enum { LEVELS = 16 };
  int64_t root = 0;
  sqlite3 *db = NULL;
  uint8_t page[4096];
  char text[200];
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  OK(sql_integer(db, "SELECT rootpage FROM sqlite_schema WHERE name = 'run'", 0, &root, &error));
  sqlite3_close(db);
  FILE *file = fopen(path, "r+b");
  fseek(file, 0, SEEK_END);
  const size_t pages = (size_t)ftell(file) / sizeof page;
  for (size_t level = 0; level < LEVELS; level++) {
    branch(page, level + 1 < LEVELS ? pages + level + 2 : (size_t)root);
    assert_int_equal(fwrite(page, sizeof page, 1, file), 1);
  }
  put_32(page, pages + LEVELS);
  fseek(file, 28, SEEK_SET); /* the number of pages, in the header of the file */
  fwrite(page, 4, 1, file);
  fclose(file);
  snprintf(text, sizeof text, "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = %zu WHERE name = 'run'",
           pages + 1);
  change(path, text);
}

/* Pages that refer to each other make a statement endless. The merge ends as soon as the pages have been checked. */
TEST(endless_pages_end_a_merge) {
  char path[64], found[8000] = "";
  struct store *store = NULL;
  int64_t added = 0, differing = 0;
  runs_without_end(populated(path, "hostile-endless"));
  said(store_merge(target, path, &added, &differing, &error), "merge", "is damaged");
  assert_int_equal(added, 0);
  OK(store_open_reader(path, &store, &error));
  assert_int_equal(store_check(store, collect, found, &error), STATUS_CONTENT);
  OK(store_close(store, &error));
}

TEST(the_target_is_sound_at_the_end) {
  target_is_sound();
}

int main(void) {
  return check_run(make_target, NULL);
}
