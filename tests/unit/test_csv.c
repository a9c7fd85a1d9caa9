/* The CSV reader and SHA-256: known answers and refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "campaign/document/csv.h"
#include "schemas/sha256.h"

/* Reads `text` (of `size` bytes) and joins cells with '|' and records with '/'; ends with '!' and the reason when a
 * cell cannot be read. */
static const char *joined(const char *text, size_t size) {
  static char out[2048];
  char cell[CSV_CELL];
  struct csv csv = {.text = text, .end = text + size, .line = 1};
  *out = '\0';
  while (csv_record(&csv)) {
    for (bool last = false; !last;) {
      if (!csv_cell(&csv, cell, &last)) {
        strcat(strcat(out, "!"), csv.wrong);
        return out;
      }
      strcat(strcat(out, cell), last ? "/" : "|");
    }
  }
  return out;
}

static void cells(void **state) {
  (void)state;
  static const struct {
    const char *text, *cells;
  } cases[] = {
      {"", ""},
      {"a,b\n1,2\n", "a|b/1|2/"},
      {"a,b\r\n1,2", "a|b/1|2/"},       /* CRLF, no line break at the end */
      {"\n# a note\na\n\n1\n", "a/1/"}, /* empty lines and notes */
      {"\"a,b\",\"say \"\"x\"\"\"\n", "a,b|say \"x\"/"},
      {"\"two\nlines\",2\n", "two\nlines|2/"},
      {" a , b \n", "a|b/"},
      {"\ta\t,b\t\n", "a|b/"},
      {"a,\n,b\n", "a|/|b/"}, /* empty cells */
      {"\"\",x\n", "|x/"},
      {"\"open\n1,2\n", "!a double quote is not closed"},
      {"\"a\"b,c\n", "!text after a closing double quote"},
      {"a\"b,c\n", "a\"b|c/"}, /* a quote inside an unquoted cell is an ordinary character */
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    assert_string_equal(joined(cases[i].text, strlen(cases[i].text)), cases[i].cells);
  assert_string_equal(joined("a\0b\n", 4), "!a NUL byte; is this a text file?");
  char wide[400];
  memset(wide, 'x', sizeof wide);
  assert_string_equal(joined(wide, 255) + 255, "/");
  assert_string_equal(joined(wide, 256), "!a cell of more than 255 bytes");
}

static void lines(void **state) {
  (void)state;
  static const char text[] = "a\n\"1\n2\"\r\n# note\n\n3\n";
  static const int64_t expected[] = {1, 2, 6};
  char cell[CSV_CELL];
  struct csv csv = {.text = text, .end = text + sizeof text - 1, .line = 1};
  bool last;
  for (size_t i = 0; i < 3; i++) {
    assert_true(csv_record(&csv));
    assert_int_equal(csv.line, expected[i]);
    assert_true(csv_cell(&csv, cell, &last));
    assert_true(last);
  }
  assert_false(csv_record(&csv));
}

/* FIPS 180-4's examples, and Python's hashlib (another implementation) for bytes 0, 1, 2, ... of these lengths, around
 * the block size. */
static void sums(void **state) {
  (void)state;
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
    sha256_text(bytes, cases[i].size, text);
    assert_string_equal(text, cases[i].sum);
  }
  sha256_text("abc", 3, text);
  assert_string_equal(text, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(cells), cmocka_unit_test(lines), cmocka_unit_test(sums)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
