/* schemas/results.sql is the schema of a store, every column of it is documented, and the names in our SQL text are
 * those of the field tables. `test_store_schema print` prints the schema: the build target schemas writes the file with
 * it. */
#define CHECK_OWN_MAIN
#include <sqlite3.h>

#include "db/store/schema.h"
#include "db/store/views.h"
#include "tests/support/check.h"
#include "tests/support/store_fixture.h"

#define REMEDY "if that is on purpose: cmake --build --preset release --target schemas, and commit the file"

static sqlite3 *run_text(const char *sql) {
  sqlite3 *db = NULL;
  assert_int_equal(sqlite3_open(":memory:", &db), SQLITE_OK);
  char *message = NULL;
  if (sqlite3_exec(db, sql, NULL, NULL, &message) != SQLITE_OK)
    fail_msg("%s", message);
  return db;
}

static int integer(sqlite3 *db, const char *sql) {
  sqlite3_stmt *statement = NULL;
  if (sqlite3_prepare_v2(db, sql, -1, &statement, NULL) != SQLITE_OK)
    fail_msg("%s: %s", sql, sqlite3_errmsg(db));
  int value = sqlite3_step(statement) == SQLITE_ROW ? sqlite3_column_int(statement, 0) : -1;
  sqlite3_finalize(statement);
  return value;
}

static void write_text(sqlite3 *db, const char *sql, FILE *out) {
  sqlite3_stmt *statement = NULL;
  if (sqlite3_prepare_v2(db, sql, -1, &statement, NULL) != SQLITE_OK)
    fail_msg("%s: %s", sql, sqlite3_errmsg(db));
  while (sqlite3_step(statement) == SQLITE_ROW)
    fprintf(out, "\n%s\n", (const char *)sqlite3_column_text(statement, 0));
  sqlite3_finalize(statement);
}

/* The schema of a new store as one SQL text: pragmas, tables, indexes, views, the rows of column_doc. free() it. */
static char *schema_text(void) {
  char path[64], *text = NULL;
  size_t size = 0;
  struct store *store = NULL;
  sqlite3 *db = NULL;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  OK(store_open_writer(fixture_path(path, "schema"), &store, NULL, 0, &error));
  OK(store_close(store, &error));
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  fprintf(out,
          "-- The store of clast: schema of version %d.\n"
          "-- Made from the tables in db/store/schema.c and the engines' field tables; do not edit: a test "
          "compares.\n"
          "-- Views have, besides, one column per input that some campaign varied (table axis).\n"
          "PRAGMA application_id = %d;\nPRAGMA user_version = %d;\n",
          SCHEMA_VERSION, SCHEMA_APPLICATION_ID, SCHEMA_VERSION);
  write_text(db, "SELECT sql || ';' FROM sqlite_schema WHERE sql IS NOT NULL", out);
  write_text(db,
             "SELECT format('INSERT INTO column_doc VALUES (%Q, %Q, %Q, %Q, %d);', table_name, column_name, unit, "
             "meaning, deterministic) FROM column_doc ORDER BY table_name, column_name",
             out);
  sqlite3_close(db);
  fclose(out);
  return text;
}

TEST(committed_text_is_the_schema) {
  static const char path[] = CLAST_SOURCE_DIR "/schemas/results.sql";
  OWNED char *made = schema_text();
  assert_non_null(made);
  size_t size = strlen(made);
  OWNED char *committed = calloc(1, size + 2);
  FILE *in = fopen(path, "r");
  if (!in)
    fail_msg("schemas/results.sql is missing: " REMEDY);
  size_t got = fread(committed, 1, size + 1, in);
  fclose(in);
  if (got != size || memcmp(made, committed, size) != 0)
    fail_msg("schemas/results.sql is not the schema any more: " REMEDY);
}

TEST(text_makes_the_same_store) {
  OWNED char *sql = schema_text();
  sqlite3 *db = run_text(sql);
  assert_int_equal(integer(db, "ATTACH 'test-store-schema.db' AS real"), -1);
  assert_int_equal(
      integer(db, "SELECT count(*) FROM (SELECT name, sql FROM main.sqlite_schema WHERE sql IS NOT NULL EXCEPT "
                  "SELECT name, sql FROM real.sqlite_schema)"),
      0);
  assert_int_equal(integer(db, "SELECT count(*) FROM real.sqlite_schema WHERE name NOT LIKE 'sqlite_%'"),
                   integer(db, "SELECT count(*) FROM main.sqlite_schema WHERE name NOT LIKE 'sqlite_%'"));
  assert_int_equal(integer(db,
                           "SELECT count(*) FROM (SELECT * FROM main.column_doc EXCEPT SELECT * FROM real.column_doc)"),
                   0);
  assert_int_equal(integer(db, "PRAGMA main.application_id"), integer(db, "PRAGMA real.application_id"));
  assert_int_equal(integer(db, "PRAGMA main.user_version"), integer(db, "PRAGMA real.user_version"));
  sqlite3_close(db);
}

TEST(every_column_is_documented) {
  OWNED char *sql = schema_text();
  sqlite3 *db = run_text(sql);
  sqlite3_stmt *statement = NULL;
  sqlite3_prepare_v2(
      db,
      "SELECT s.name || '.' || c.name FROM sqlite_schema s, pragma_table_xinfo(s.name) c LEFT JOIN column_doc d "
      "ON d.table_name = s.name AND d.column_name = c.name WHERE s.type IN ('table', 'view') AND "
      "ifnull(d.meaning, '') = ''",
      -1, &statement, NULL);
  if (sqlite3_step(statement) == SQLITE_ROW)
    fail_msg("no meaning: %s", (const char *)sqlite3_column_text(statement, 0));
  sqlite3_finalize(statement);
  assert_true(integer(db, "SELECT count(*) FROM column_doc") > 150);
  assert_int_equal(integer(db, "SELECT count(*) FROM column_doc d WHERE NOT EXISTS (SELECT 1 FROM "
                               "pragma_table_xinfo(d.table_name) c WHERE c.name = d.column_name)"),
                   0);
  sqlite3_close(db);
  /* a comment on every column of a table, beside the column */
  for (const char *line = strstr(sql, "CREATE TABLE"), *end; line; line = *end ? end + 1 : NULL) {
    end = line + strcspn(line, "\n");
    if (strncmp(line, "  ", 2) == 0 && strncmp(line, "  PRIMARY KEY", 13) != 0 && line[2] != '(' &&
        !strstr(line, "CREATE VIEW")) {
      const char *comment = strstr(line, " -- ");
      if (!comment || comment > end)
        fail_msg("no comment: %.*s", (int)(end - line), line);
    }
    if (strncmp(end + (*end == '\n'), "CREATE VIEW", 11) == 0)
      break;
  }
}

TEST(every_table_is_strict) {
  OWNED char *sql = schema_text();
  sqlite3 *db = run_text(sql);
  assert_int_equal(
      integer(db, "SELECT count(*) FROM pragma_table_list WHERE type = 'table' AND schema = 'main' AND name NOT "
                  "LIKE 'sqlite_%' AND NOT strict"),
      0);
  assert_int_equal(integer(db, "SELECT count(*) FROM pragma_table_list WHERE name = 'result_dem'"), 1);
  sqlite3_close(db);
}

/* Main results are numbers in every run that counts, and the states that SQL text names are those of outcome_table. */
TEST(names_are_those_of_the_tables) {
  const struct field *row;
  assert_non_null(outcome_main(0));
  for (size_t i = 0; (row = outcome_main(i)); i++) {
    assert_true(i < VIEWS_STATISTICS_MAIN);
    if (!strstr(ask_canned_find("scatter", &error)->sql, row->path))
      fail_msg("db/ask/canned_scatter.sql lacks the main result %s", row->path);
    assert_true(row->kind == FIELD_INTEGER || (row->kind == FIELD_REAL && !(row->flags & FIELD_MAY_BE_OFF)));
  }
  const struct field *states = field_find(&outcome_table, "state", &error);
  assert_string_equal(states->choices[OUTCOME_COMPLETED], "completed");
  assert_string_equal(states->choices[OUTCOME_END_TIME], "end-time");
}

/* All rows of all tables, the results of every engine and module among them. */
TEST(every_column_has_a_name_of_its_own) {
  for (size_t i = 0; i < schema_table_count(); i++) {
    const struct schema_table table = schema_table_at(i);
    OK(schema_check_names(&table, &error));
  }
}

static void differ(const struct field_table *inputs, const struct field_table *results) {
  char input[SCHEMA_NAME_SIZE], result[SCHEMA_NAME_SIZE];
  for (size_t i = 0; i < inputs->count; i++)
    for (size_t k = 0; k < results->count; k++) {
      field_column_name(inputs->rows[i].path, input, sizeof input);
      field_column_name(results->rows[k].path, result, sizeof result);
      if (sqlite3_stricmp(input, result) == 0)
        fail_msg("input %s and result %s would be one column", inputs->rows[i].path, results->rows[k].path);
    }
}

/* An input that a campaign varies has a column beside the results. */
TEST(no_input_has_the_column_of_a_result) {
  for (size_t i = 0; i < engine_count(); i++) {
    differ(engine_at(i)->inputs, &outcome_table);
    differ(engine_at(i)->inputs, engine_at(i)->results);
  }
}

/* SQL treats A and a as the same name: Tillotson's law has both. */
TEST(inputs_that_differ_by_case_get_two_columns) {
  static const char *const paths[] = {"target.material.tillotson.A", "target.material.tillotson.a"};
  const struct field_table *inputs = engine_find("sph", &error)->inputs;
  char path[64];
  struct store *store = NULL;
  sqlite3 *db = NULL;
  OK(store_open_writer(fixture_path(path, "case"), &store, NULL, 0, &error));
  for (size_t i = 0; i < 2; i++)
    OK(store_add_axis(store, field_find(inputs, paths[i], &error), "", &error));
  OK(store_close(store, &error));
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(integer(db, "SELECT count(DISTINCT lower(column_name)) FROM axis"), 2);
  sqlite3_close(db);
}

TEST(one_column_of_two_rows_is_refused) {
  static const struct field rows[] = {{.path = "largest.speed"}, {.path = "mass"}, {.path = "largest_speed"}};
  static const struct field_table fields = {.rows = rows, .count = 3};
  static const struct schema_column columns[] = {{.name = "run_id"}, {.name = "Mass"}};
  const struct schema_table two_rows = {.name = "result_x", .fields = &fields};
  assert_int_equal(schema_check_names(&two_rows, &error), STATUS_INTERNAL);
  assert_non_null(strstr(error.message, "'largest.speed' and 'largest_speed'"));
  assert_non_null(strstr(error.message, "result_x"));
  const struct schema_table row_and_column = {.name = "result_x", .columns = columns, .count = 2, .fields = &fields};
  assert_int_equal(schema_check_names(&row_and_column, &error), STATUS_INTERNAL);
  assert_non_null(strstr(error.message, "'Mass' and 'mass'"));
}

TEST(canned_queries_know_the_real_columns) {
  struct store *store = NULL;
  OK(store_open_reader("test-store-schema.db", &store, &error));
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *canned = ask_canned_at(i);
    const struct query_parameter parameter = {.name = canned->parameters, .value = "1"};
    ANSWER answer = answer_to_user(store, canned->sql, *canned->parameters ? 1 : 0, &parameter, 0, &error);
    while (answer_next(&answer))
      ;
    if (answer_end(&answer) != STATUS_OK)
      fail_msg("%s: %s", canned->name, error.message);
  }
  store_close(store, NULL);
}

int main(int count, char **arguments) {
  if (count == 2 && strcmp(arguments[1], "print") == 0) {
    OWNED char *text = schema_text();
    fputs(text, stdout);
    return 0;
  }
  return check_run(NULL, NULL);
}
