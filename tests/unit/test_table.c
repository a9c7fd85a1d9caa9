/* One set of rows, three formats: they agree, and the hard cells (NaN, quotes, bad UTF-8, many rows) come out right. */

#include "campaign/terminal/table.h"
#include "schemas/csv.h"
#include "schemas/text.h"
#include "tests/support/check.h"

static char *print_rows(enum table_format format, int rows) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  TABLE table = table_new(format, out);
  table_column(table, "name", NULL);
  table_column(table, "speed", "m/s");
  table_column(table, "n", "1");
  for (int i = 0; i < rows; i++) {
    table_text(table, i % 2 ? "plain" : "a \"b\", c");
    table_real(table, i == 1 ? (double)NAN : 0.1 + i);
    table_integer(table, -i);
  }
  assert_int_equal(table_end(table, NULL), STATUS_OK);
  fclose(out);
  return text;
}

TEST(test_csv) {
  OWNED char *text = print_rows(TABLE_CSV, 2);
  assert_string_equal(text, "name,speed,n\n\"a \"\"b\"\", c\",0.1,0\nplain,,-1\n");
}

TEST(test_json) {
  char *text = print_rows(TABLE_JSON, 2);
  assert_string_equal(text, "[\n {\"name\": \"a \\\"b\\\", c\", \"speed\": 0.1, \"n\": 0},\n"
                            " {\"name\": \"plain\", \"speed\": null, \"n\": -1}\n]\n");
  free(text);
  text = print_rows(TABLE_JSON, 0);
  assert_string_equal(text, "[]\n");
  free(text);
}

TEST(test_text) {
  char *text = print_rows(TABLE_TEXT, 2);
  assert_string_equal(text, "name      speed [m/s]   n\n"
                            "a \"b\", c          0.1   0\n"
                            "plain               -  -1\n");
  free(text);
  for (int rows = 499; rows <= 501; rows++) { /* around the number of rows kept for the widths */
    text = print_rows(TABLE_TEXT, rows);
    size_t lines = 0;
    for (char *c = text; *c; c++)
      lines += *c == '\n';
    assert_int_equal(lines, rows + 1);
    free(text);
  }
}

/* The half width stands in the cell of its value, which leaves its range for nobody; a rare column is hidden. */
TEST(test_half_widths) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  TABLE table = table_new(TABLE_BARE, out);
  table_columns(table, (const char *const[]){"share", "hw95", NULL});
  table_range(table, (struct sample_range){.least = 0, .most = 1});
  table_columns(table, (const char *const[]){"any", "hw95", "rare", NULL});
  table_rare(table);
  for (int i = 0; i < 2; i++)
    table_reals(table, 5, (const double[]){0.8, i ? 0.1 : 0.4, 0.8, 0.4, 7});
  assert_int_equal(table_end(table, NULL), STATUS_OK);
  fclose(out);
  assert_string_equal(text, "         share        any\n"
                            "0.8 (0.4 to 1)  0.8 ± 0.4\n"
                            "   0.80 ± 0.10  0.8 ± 0.4\n");
  assert_true(table_hides(table, "rare") && !table_hides(table, "any"));
}

/* The ends of an interval stand in the cell of its value, with the mark; programs see three columns. */
TEST(test_intervals) {
  static const char *const expected[] = {"             value\n0.4 (0.2 to 0.8) !\n         2\xc3\x97"
                                         "10^33\n               -\n",
                                         "value,low,high\n0.42,0.161,0.806\n2e+33,,\n,,\n"};
  for (int programs = 0; programs < 2; programs++) {
    OWNED char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TABLE table = table_new(programs ? TABLE_CSV : TABLE_BARE, out);
    table_interval_columns(table, "value", "low", "high");
    table_rests_on(table, &(struct ask_doubts){.runs = 2, .doubtful = 1});
    table_interval(table, 0.42, 0.161, 0.806);
    table_interval(table, 2e33, NAN, NAN);
    table_interval(table, NAN, NAN, NAN);
    assert_int_equal(table_end(table, NULL), STATUS_OK);
    fclose(out);
    assert_string_equal(text, expected[programs]);
  }
}

/* A table for people cannot control the terminal: neither its cells nor its names and units. */
/* Fourteen values of two rocks, of which the first, with the speed, tells the points apart: the result has its place.
 */
TEST(test_inputs_leave_room_for_results) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  TABLE table = table_new(TABLE_BARE, out);
  for (int c = 0; c < 15; c++) {
    struct ask_column input = {.unit = "1", .factor = 1};
    snprintf(input.name, sizeof input.name, c ? "of_rock_%02d" : "speed", c);
    table_key(table, &input);
  }
  table_columns(table, (const char *const[]){"point_id", "result", NULL});
  for (int i = 0; i < 16; i++) {
    for (int c = 0; c < 15; c++)
      table_real(table, c ? 1.25e30 * c + 1e30 * (i % 2) : 3.5 * (i / 2));
    table_integer(table, i);
    table_real(table, 0.5);
  }
  assert_int_equal(table_end(table, NULL), STATUS_OK);
  fclose(out);
  assert_true(table_hides(table, "of_rock_14") && table_hides(table, "of_rock_13"));
  assert_true(!table_hides(table, "speed") && !table_hides(table, "of_rock_01") && !table_hides(table, "result"));
}

TEST(test_text_is_harmless) {
  static const char *const hostile[] = {"a\x1b[2J\x07", "b\x08\x7f", "\xc2\x9b\x9b\xc3\xa9", "\r\n\t"};
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  TABLE table = table_new(TABLE_TEXT, out);
  for (int i = 0; i < 4; i++)
    table_column(table, hostile[i], hostile[i]);
  for (int i = 0; i < 4; i++)
    table_text(table, hostile[i]);
  assert_int_equal(table_end(table, NULL), STATUS_OK);
  fclose(out);
  size_t lines = 0, letters = 0;
  for (const char *c = text; *c; c++) {
    lines += *c == '\n';
    letters += (unsigned char)*c == 0xc3;
    assert_true(*c == '\n' || ((unsigned char)*c >= ' ' && *c != 127));
    assert_false((unsigned char)*c == 0x9b || (unsigned char)*c == 0xc2);
  }
  assert_int_equal(lines, 2);
  assert_int_equal(letters, 3);
}

/* CSV neither controls the terminal nor runs in a spreadsheet, and our reader gets the texts back. */
TEST(test_csv_is_harmless) {
  static const struct {
    const char *text, *cell;
  } cases[] = {
      {"=HYPERLINK(1)", "'=HYPERLINK(1)"},
      {"+1+1", "'+1+1"},
      {"-2+3", "'-2+3"},
      {"@SUM(1)", "'@SUM(1)"},
      {"\t=1", "\"'\t=1\""},
      {" =1", "\"' =1\""},
      {"\n@x", "\"'\n@x\""},
      {"=a,b", "\"'=a,b\""},
      {"-", "'-"},
      {"-5", "-5"},
      {"+1e-3", "+1e-3"},
      {"a=b", "a=b"},
      {"\x1b]0;x\x07", "\" ]0;x \""},
      {"a\xc2\x9b\x7f|", "a   |"},
      {"\r=1", "\"' =1\""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char *text = NULL, expected[100], wanted[100];
    size_t size = 0;
    OWNED_BY(csv_close) struct csv csv;
    FILE *out = open_memstream(&text, &size);
    TABLE table = table_new(TABLE_CSV, out);
    table_column(table, cases[i].text, NULL);
    table_text(table, cases[i].text);
    assert_int_equal(table_end(table, NULL), STATUS_OK);
    fclose(out);
    snprintf(expected, sizeof expected, "%s\n%s\n", cases[i].cell, cases[i].cell);
    assert_string_equal(text, expected);
    assert_int_equal(csv_text(&csv, "t", text, size, NULL), STATUS_OK);
    assert_int_equal(csv_next(&csv), CSV_NAMES);
    snprintf(wanted, sizeof wanted, "%s", cases[i].text);
    text_make_plain(wanted, "\t\n");
    assert_string_equal(csv.cells[0].text + strspn(csv.cells[0].text, " \t\n"), wanted + strspn(wanted, " \t\n"));
    free(text);
  }
}

TEST(test_numbers_round_trip) {
  static const double numbers[] = {0.1, 1.0 / 3, 1e300, 5e-324, -0.0, 123456789.123456789, 2.0000000000000004};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
    OWNED char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TABLE table = table_new(TABLE_CSV, out);
    table_column(table, "x", NULL);
    table_real(table, numbers[i]);
    assert_int_equal(table_end(table, NULL), STATUS_OK);
    fclose(out);
    double back = strtod(strchr(text, '\n'), NULL);
    assert_memory_equal(&back, &numbers[i], sizeof back);
  }
}

TEST(test_strings) {
  static const struct {
    const char *text, *json;
  } cases[] = {
      {"\xc3\xa9", "\"\xc3\xa9\""},
      {"\xff", "\"\\ufffd\""},
      {"\xc0\xaf", "\"\\ufffd\\ufffd\""},                       /* overlong */
      {"\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\""},            /* a lone surrogate */
      {"\xf4\x90\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\""}, /* beyond U+10FFFF */
      {"a\xe2\x82", "\"a\\ufffd\\ufffd\""},                     /* truncated */
      {"\001\n\t\\", "\"\\u0001\\n\\t\\\\\""},
      {"\x7f\xc2\x9b\xc2\xa0", "\"\\u007f\\u009b\xc2\xa0\""},                     /* a terminal obeys U+009B */
      {"\xe2\x80\xae\xe2\x81\xa6\xe2\x80\xaf", "\"\\u202e\\u2066\xe2\x80\xaf\""}, /* U+202E reverses what follows */
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    text_json_string(cases[i].text, out);
    fclose(out);
    assert_string_equal(text, cases[i].json);
  }
}

TEST(test_full_disk) {
  FILE *out = fopen("/dev/full", "w");
  assert_non_null(out);
  TABLE table = table_new(TABLE_CSV, out);
  table_column(table, "x", NULL);
  for (int i = 0; i < 10000; i++)
    table_integer(table, i);
  assert_true(table_broken(table));
  assert_int_equal(table_end(table, &error), STATUS_IO);
  assert_non_null(strstr(error.message, "No space"));
  fclose(out);
}
