/* The CSV reader and SHA-256: known answers and refusals. */

#include "schemas/csv.h"
#include "schemas/text.h"
#include "tests/support/check.h"

/* Joins the cells of `text` (of `size` bytes) with '|', and ends a record with '/', a remark with '#', and what cannot
 * be read with '!' and the reason. */
static const char *joined(const char *text, size_t size) {
  static char out[4096];
  OWNED_BY(csv_close) struct csv csv;
  enum csv_item item;
  *out = '\0';
  if (csv_text(&csv, "t", text, size, &error) != STATUS_OK)
    return error.message;
  while ((item = csv_next(&csv)) != CSV_END) {
    const size_t count = item == CSV_REMARK ? 1 : item == CSV_WRONG ? 0 : csv.count;
    for (size_t i = 0; i < count; i++)
      text_append(out, sizeof out, "%s%s", i ? "|" : "", csv.cells[i].text);
    text_append(out, sizeof out, "%s%s", item == CSV_REMARK ? "#" : item == CSV_WRONG ? "!" : "/", csv.wrong);
    csv.wrong[0] = '\0';
  }
  return out;
}

TEST(cells) {
  static const struct {
    const char *text, *cells;
  } cases[] = {
      {"", ""},
      {"a,b\n1,2\n", "a|b/1|2/"},
      {"\xEF\xBB\xBF"
       "a,b\r\n1,2",
       "a|b/1|2/"}, /* byte order mark, CRLF, no line break at the end */
      {"a,b\r\n1,2\r", "a|b/1|2/"},
      {"\n# a note\na\n\n1\n", " a note#a/1/"},  /* empty lines and remarks */
      {"# a;b\na,b\n,\n1,2\n", " a;b#a|b/1|2/"}, /* a remark decides nothing; a row of separators is empty */
      {"\"# source: A, 1991\",,\n# 2 g;;\na,b,c\n1,2,3", " source: A, 1991# 2 g#a|b|c/1|2|3/"}, /* by spreadsheets */
      {"\"a,b\",\"say \"\"x\"\"\"\n", "a,b|say \"x\"/"},
      {"\"two\nlines\",2\n", "two\nlines|2/"},
      {" a , b \n", "a|b/"},
      {"\ta\t,b\t\n", "|a|,b|/"}, /* a tab among the names is a separator */
      {"a\tb\n\t2\n", "a|b/|2/"},
      {"a;b\n2,5;214\n", "a|b/2,5|214/"},
      {"\"a;b\",c\n1,2\n", "a;b|c/1|2/"},              /* not in quotes */
      {"sep=;\r\na;b\r\n2,5;214\r\n", "a|b/2,5|214/"}, /* by Excel */
      {"\xEF\xBB\xBFsep=,\n# a\n\n\"a;b\",c;d\n1,2\n", " a#a;b|c;d/1|2/"},
      {"a\nsep=;\n", "a/sep=;/"},
      {"sep=", "sep=/"},
      /* errors of spreadsheets are no remarks */
      {"a,b\n#DIV/0!,2\n#N/A,3\n\"#NAME?\",4\n####,5\n#NV,6\n", "a|b/#DIV/0!|2/#N/A|3/#NAME?|4/####|5/#NV|6/"},
      {"a;b\n#WERT! ;2\n", "a|b/#WERT!|2/"},
      {"####\n## a, b\n###,,\n#NOTE: x\n#N,A\na,b\n", "##### a, b####NOTE: x#N,A#a|b/"},
      {"a,\n,b\n", "a|/|b/"}, /* empty cells */
      {"a,b\n\"\",x\n", "a|b/|x/"},
      {"a,b\n\"\",\n", "a|b/|/"},
      {"a\n\"open\n1,2\n", "a/!a double quote is not closed"},
      {"a,b\n\"a\"b,c\n1,2\n", "a|b/!text after a closing double quote1|2/"},
      {"a\"b,c\n", "a\"b|c/"}, /* a quote inside an unquoted cell is an ordinary character */
      {"a\n1,5\n2\n", "a/!2 cells, but the header has 1; a decimal comma needs semicolons between the cells, or double "
                      "quotes2/"},
      {"a,b\n1\n", "a|b/!1 cells, but the header has 2; a decimal comma needs semicolons between the cells, or double "
                   "quotes"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    assert_string_equal(joined(cases[i].text, strlen(cases[i].text)), cases[i].cells);
  assert_string_equal(joined("a\nb\0\n", 5), "t:2: a NUL byte; is this a text file? Save it as UTF-8");
  char wide[1 + CSV_CELLS + 1];
  memset(wide, ',', sizeof wide);
  wide[0] = 'x';
  assert_string_equal(joined(wide, CSV_CELLS + 1), "!more than 1000 columns");
  assert_string_equal(joined(wide, CSV_CELLS) + CSV_CELLS, "/");
}

TEST(lines) {
  static const char text[] = "a\n\"1\n2\"\r\n# note\n\n3\n";
  static const int64_t expected[] = {1, 2, 4, 6, 7};
  OWNED_BY(csv_close) struct csv csv;
  OK(csv_text(&csv, "t", text, sizeof text - 1, &error));
  for (size_t i = 0; i < 5; i++) {
    assert_true((csv_next(&csv) == CSV_END) == (i == 4));
    assert_int_equal(csv.line, expected[i]);
  }
}

/* A number means one thing, or it is refused. */
TEST(numbers) {
  static const struct {
    const char *text, *last; /* the last cell of the text as a number; "!": refused */
  } cases[] = {
      {"a\n1\n", "1"},
      {"a\n1.5 g\n", "1.5 g"},
      {"a\n\"1,5 g\"\n", "1.5 g"},
      {"a;b\n1;-2,5e3\n", "-2.5e3"},
      {"a;b\n1;1,234\n", "1.234"},
      {"a;b\n1;,5\n", ".5"},
      {"a\n\"1,2345\"\n", "1.2345"},
      {"a\n\"0,234\"\n", "0.234"},
      {"a\n\"1,234\"\n", "!"}, /* a fraction, or a thousand */
      {"a\n\"1,234.5\"\n", "!"},
      {"a;b\n1;1.234,5\n", "!"},
      {"a;b\n1;1,234,567\n", "!"},
      {"a\tb\n1\t2,5\n", "!"},
      {"a;b\n1;2.5\n1;2,5\n", "!"}, /* two marks in one file */
      {"a;b\n1;2,5\n1;3\n1;2.5\n", "!"},
      {"a\nup, down\n", "!"},
      {"a\noff\n", "off"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED_BY(csv_close) struct csv csv;
    enum csv_item item;
    bool good = true;
    char last[40] = "";
    OK(csv_text(&csv, "t", cases[i].text, strlen(cases[i].text), &error));
    while ((item = csv_next(&csv)) != CSV_END) {
      if (item == CSV_NAMES)
        continue;
      good = item == CSV_RECORD && csv_number(&csv, &csv.cells[csv.count - 1]);
      snprintf(last, sizeof last, "%s", csv.cells[csv.count - 1].text);
    }
    assert_string_equal(good ? last : "!", cases[i].last);
    assert_true(good || csv.wrong[0]);
  }
}

TEST(units) {
  static const char *const cases[][3] = {{"mass (g)", "mass", "g"},
                                         {"threshold.angle [deg]", "threshold.angle", "deg"},
                                         {"a(m)", "a", "m"},
                                         {"a ( 1/m^3)", "a", "1/m^3"},
                                         {"mass", "mass", ""},
                                         {"", "", ""},
                                         {"a (b) [m]", "a (b)", "m"},
                                         {"a)", "a)", ""}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char name[40];
    snprintf(name, sizeof name, "%s", cases[i][0]);
    assert_string_equal(csv_take_unit(name), cases[i][2]);
    assert_string_equal(name, cases[i][1]);
  }
}

/* FIPS 180-4's examples, and Python's hashlib (another implementation) for bytes 0, 1, 2, ... of these lengths, around
 * the block size. */
TEST(sums) {
  static const struct {
    size_t size;
    const char *sum;
  } cases[] = {
      {0, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {1, "6e340b9cffb37a989ca544e6bb780a2c78901d3fb33738768511a30617afa01d"},
      {55, "463eb28e72f82e0a96c0a4cc53690c571281131f672aa229e0d45ae59b598b59"},
      {56, "da2ae4d6b36748f2a318f23e7ab1dfdf45acdc9d049bd80e59de82a60895f562"},
      {63, "29af2686fd53374a36b0846694cc342177e428d1647515f078784d69cdb9e488"},
      {64, "fdeab9acf3710362bd2658cdc9a29e8f9c757fcf9811603a8c447cd1d9151108"},
      {65, "4bfd2c8b6f1eec7a2afeb48b934ee4b2694182027e6d0fc075074f2fabb31781"},
      {119, "da18797ed7c3a777f0847f429724a2d8cd5138e6ed2895c3fa1a6d39d18f7ec6"},
      {120, "f52b23db1fbb6ded89ef42a23ce0c8922c45f25c50b568a93bf1c075420bbb7c"},
      {128, "471fb943aa23c511f6f72f8d1652d9c880cfa392ad80503120547703e56a2be5"},
      {1000, "a8af099bf2e878609558dbf69d8f88f4a31040a8cf84b549a0cfa912f12ffc3f"},
      {1024, "785b0751fc2c53dc14a4ce3d800e69ef9ce1009eb327ccf458afe09c242c26c9"},
  };
  unsigned char bytes[1024];
  char text[65];
  for (size_t i = 0; i < sizeof bytes; i++)
    bytes[i] = (unsigned char)i;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    text_sha256(bytes, cases[i].size, text);
    assert_string_equal(text, cases[i].sum);
  }
  text_sha256("abc", 3, text);
  assert_string_equal(text, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}
