/* Documents from unknown sources: valid and invalid UTF-8, adversarial sizes, and files that are no documents. */
#include "tests/support/document_thing.h"

/* RFC 3629: what is UTF-8 and what is not, one byte sequence at a time in the place of a name's last letters. */
TEST(utf8_is_judged_strictly) {
  static const struct {
    const char *bytes;
    bool good;
  } cases[] = {
      {"\xC2\xA2", true},
      {"\xE2\x82\xAC", true},
      {"\xF0\x9F\x8C\x8D", true},
      {"\xF4\x8F\xBF\xBD", true},
      {"\xC0\xAF", false},
      {"\xC1\xBF", false},
      {"\xE0\x80\xAF", false},
      {"\xF0\x80\x80\xAF", false}, /* overlong */
      {"\xED\xA0\x80", false},
      {"\xF4\x90\x80\x80", false},
      {"\xF5\x80\x80\x80", false}, /* surrogate; beyond U+10FFFF */
      {"\xC2 ", false},
      {"\xE2\x82 ", false},
      {"\x80", false},
      {"\xFF", false}, /* cut short; stray */
      {"\xC2\x85", false},
      {"\xE2\x80\xA8", false},
      {"\xEF\xBB\xBF", false},
      {"\xEF\xBF\xBF", false}, /* characters not allowed in text */
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[64];
    struct thing thing;
    snprintf(text, sizeof text, "name: a%sb\n", cases[i].bytes);
    OWNED char *report = report_text(text, &thing);
    if ((report == NULL) != cases[i].good)
      fail_msg("case %zu: %s", i, report ? report : "accepted");
    if (report)
      assert_non_null(strstr(report, "a.yaml:1:8: error: "));
  }
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Adversarial sizes give an error message, and soon. */
TEST(limits_hold) {
  struct thing thing;
  double start = seconds();
  size_t size = (4 << 20) + 1;
  OWNED char *text = malloc(size + 1);
  memset(text, ' ', size);
  text[size] = 0;
  char *report = report_of(text, size, &thing);
  assert_string_equal(report, "a.yaml: error: larger than 4 MiB; no input of clast is that large");
  free(report);
  memcpy(text, "note: ", 6);
  memset(text + 6, '[', size - 7);
  report = report_of(text, size - 1, &thing);
  assert_non_null(strstr(report, "a.yaml:1:38: error: nested more than 32 deep\n"));
  free(report);
  size_t used = 0; /* a mapping that is nested by indentation */
  for (size_t i = 0; i < 100; i++) {
    memset(text + used, ' ', i);
    used += i + (size_t)sprintf(text + used + i, "k:\n");
  }
  report = report_of(text, used, &thing);
  assert_non_null(strstr(report, "a.yaml:33:33: error: nested more than 32 deep\n"));
  free(report);
  used = (size_t)sprintf(text, "note:\n- &a0 [x]\n");
  for (int i = 1; i < 25; i++)
    used += (size_t)sprintf(text + used, "- &a%d [*a%d, *a%d]\n", i, i - 1, i - 1);
  report = report_of(text, used, &thing);
  assert_non_null(strstr(report, "more than 1048576 values, aliases counted as often as used; use less"));
  free(report);
  used = (size_t)sprintf(text, "note: ["); /* one value too many, where it would also be too deep */
  for (int i = 3 + 30; i < 1 << 20; i++)
    used += (size_t)sprintf(text + used, "x,");
  memset(text + used, '[', 31);
  report = report_of(text, used + 31, &thing);
  assert_non_null(strstr(report, "more than 1048576 values, aliases counted as often as used; use less"));
  free(report);
  used = (size_t)sprintf(text, "note:\n");
  for (int i = 0; i < 1001; i++)
    used += (size_t)sprintf(text + used, "- &a%d x\n", i);
  report = report_of(text, used, &thing);
  assert_non_null(strstr(report, "a.yaml:1002:4: error: more than 1000 anchors\n"));
  free(report);
  used = 0; /* the same key again and again; many different unknown ones */
  while (used < size - 40)
    used += (size_t)sprintf(text + used, used % 2 ? "k: 1\n" : "k%zu: 1\n", used);
  report = report_of(text, used, &thing);
  assert_non_null(strstr(report, "more; correct the ones above first"));
  free(report);
  /* About 1 s of CPU without sanitizers, 5 s with: a limit of 60 s distinguishes a quadratic search (hours) from a busy
   * machine. */
  assert_true(seconds() - start < 60);
}

TEST(files_that_are_none) {
  struct document *document = (struct document *)&document;
  assert_int_equal(document_open("no_such_file.yaml", &document, &error), STATUS_MISSING);
  assert_null(document);
  assert_string_equal(error.message, "no_such_file.yaml: there is no such file");
  assert_int_equal(document_open(".", &document, &error), STATUS_IO);
  assert_string_equal(error.message, ".: is a folder; name a file in it");
  assert_int_equal(document_open("/dev/zero", &document, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "/dev/zero: error: larger than 4 MiB; no input of clast is that large");
  char path[] = "test_document_XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0);
  assert_int_equal(write(file, "name: x\nbody: {length: 3 s}\n", 28), 28);
  close(file);
  OK(document_open(path, &document, &error));
  assert_string_equal(document_text(document), "name: x\nbody: {length: 3 s}\n");
  document_free(document);
  if (geteuid() != 0) { /* root can read every file */
    chmod(path, 0);
    assert_int_equal(document_open(path, &document, &error), STATUS_IO);
  }
  unlink(path);
  document_free(NULL);
}
