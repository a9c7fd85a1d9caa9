/* Texts made of parts stay in their arrays, end behind a whole character, and show no more digits than people read. */

#include "schemas/text.h"
#include "tests/support/check.h"

/* What does not fit is cut, whatever is appended later, and the bytes behind the array stay as they are. */
TEST(test_append_stays_in_its_array) {
  char text[8] = "", behind[8] = "behind!";
  assert_true(text_append(text, sizeof text, "%s", "1234567"));
  assert_false(text_append(text, sizeof text, "%.3f", 1e308));
  assert_string_equal(text, "1234567");
  text[0] = '\0';
  assert_false(text_append(text, sizeof text, "%.3f", 1e308));
  assert_int_equal(strlen(text), 7);
  assert_false(text_append(text, sizeof text, "\xc2\xb1%.3f", 1e308));
  assert_int_equal(strlen(text), 7);
  assert_true(text_append(text, sizeof text, "%s", ""));
  assert_string_equal(behind, "behind!");
}

/* Characters of 2, 3 and 4 bytes are cut as a whole; a character that fits stays. */
TEST(test_append_cuts_whole_characters) {
  static const char *const characters[] = {"\xc2\xb1", "\xe2\x94\x81", "\xf0\x9f\x98\x80"};
  for (size_t i = 0; i < 3; i++) {
    const size_t length = strlen(characters[i]);
    for (size_t size = 4; size <= 4 + length; size++) {
      char text[16] = "abc";
      const int fits = text_append(text, size, "%s", characters[i]);
      assert_int_equal(fits, size == 4 + length);
      assert_int_equal(strlen(text), fits ? 3 + length : 3);
    }
  }
}

TEST(test_fixed_has_few_digits) {
  static const struct {
    double number;
    const char *text;
  } cases[] = {{0.2014, "0.201"}, {-1, "-1.000"},    {1e6, "1000000.000"}, {1e308, "1e+308"},
               {-1e77, "-1e+77"}, {INFINITY, "inf"}, {-INFINITY, "-inf"},  {NAN, "nan"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[40] = "";
    text_append_fixed(text, sizeof text, cases[i].number, 3);
    assert_string_equal(text[0] == '-' && isnan(cases[i].number) ? text + 1 : text, cases[i].text);
  }
}

TEST(test_percent) {
  static const struct {
    double share;
    const char *text;
  } cases[] = {{1.234e-4, "0.012 %"}, {0.05, "5 %"}, {0.994, "99 %"}, {0.996, "100 %"}, {1, "100 %"}, {2.5, "250 %"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    assert_string_equal(text_percent(cases[i].share, (char[TEXT_PERCENT]){0}), cases[i].text);
}

static void assert_wrapped(const char *text, size_t width, const char *lines) {
  OWNED char *wrapped = NULL;
  size_t size;
  FILE *out = open_memstream(&wrapped, &size);
  text_wrap(text, 0, 0, width, out);
  fclose(out);
  assert_string_equal(wrapped, lines);
}

TEST(test_wrap_keeps_numbers_and_commands) {
  assert_wrapped("the last at (4 660 000 Pa)", 18, "the last at\n(4 660 000 Pa)\n");
  assert_wrapped("next: (`clast run a.yaml`), then go", 20, "next:\n(`clast run a.yaml`),\nthen go\n");
  assert_wrapped("as `clast\n    run a.yaml` says", 20, "as\n`clast run a.yaml`\nsays\n");
  assert_wrapped("`a b` `c d` an odd ` of one", 9, "`a b`\n`c d` an\nodd ` of\none\n");
}

TEST(test_hexadecimal) {
  char text[9] = "--------";
  text_hex("\x00\x7f\x80\xff", 4, text);
  assert_string_equal(text, "007f80ff");
  text_hex(NULL, 0, text);
  assert_string_equal(text, "");
}

TEST(test_numbers_for_people) {
  const char *const cases[][2] = {{"E 5e+08 Pa, 1e-06 s", "E 5\xc3\x97"
                                                          "10^8 Pa, 10^-6 s"},
                                  {"3.8e+06 steps, 1e+03 grains of 1.1e+03", "3 800 000 steps, 1000 grains of 1100"},
                                  {"5e34 1/m^3, 0.5, c_p 4593 m/s; 5e+04", "5e34 m^-3, 0.5, c_p 4593 m/s; 50 000"},
                                  {"k 5e+33 1/m^3; 2 1/s, in 1/s", "k 5\xc3\x97"
                                                                   "10^33 m^-3; 2 s^-1, in 1/s"},
                                  {"", ""}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED char *text = text_people(cases[i][0]);
    assert_string_equal(text, cases[i][1]);
  }
}
