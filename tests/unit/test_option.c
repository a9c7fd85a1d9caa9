/* Option tables: parsing, defaults, ranges, the nearest name, help that mentions every option. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "campaign/commands/commands.h"

struct options {
  bool loud;
  const char *file;
  int64_t slots;
  struct option_list set;
};

static const struct option_row rows[] = {
    {"loud", 'l', OPTION_FLAG, NULL, offsetof(struct options, loud), 0, 0, NULL, "Say more."},
    {"file", 0, OPTION_TEXT, "FILE", offsetof(struct options, file), 0, 0, "out.db", "Where to."},
    {"slots", 'j', OPTION_INTEGER, "N", offsetof(struct options, slots), 1, 64, "2", "How many."},
    {"set", 0, OPTION_LIST, "PATH=VALUE", offsetof(struct options, set), 0, 0, NULL, "Override."},
};
static const struct command command = {
    .name = "test",
    .group = "",
    .arguments = "A [B]",
    .summary = "",
    .doc = "Does a test.",
    .examples = "clast test a",
    .minimum_arguments = 1,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = 4,
    .options_size = sizeof(struct options),
};

static status parse(struct options *options, size_t *count, struct error *error, const char *line) {
  static char text[256], *argv[32];
  static char **arguments;
  int argc = 0;
  bool help = false;
  snprintf(text, sizeof text, "%s", line);
  for (char *word = strtok(text, " "); word; word = strtok(NULL, " "))
    argv[argc++] = word;
  argv[argc] = NULL;
  error->message[0] = '\0';
  return option_parse(&command, argc, argv, options, count, &arguments, &help, error);
}

static void test_values(void **state) {
  (void)state;
  struct options options;
  struct error error;
  size_t count = 0;
  assert_int_equal(parse(&options, &count, &error, "test a"), STATUS_OK);
  assert_int_equal(options.slots, 2);
  assert_string_equal(options.file, "out.db");
  assert_false(options.loud);
  assert_int_equal(options.set.count, 0);
  assert_int_equal(parse(&options, &count, &error, "test -lj 8 a --set x=1 --file=f --set y=-2 b"), STATUS_OK);
  assert_true(options.loud);
  assert_int_equal(options.slots, 8);
  assert_string_equal(options.file, "f");
  assert_int_equal(options.set.count, 2);
  assert_string_equal(options.set.items[1], "y=-2");
  assert_int_equal(count, 2);
}

static void test_refusals(void **state) {
  (void)state;
  static const struct {
    const char *line, *says;
  } cases[] = {
      {"test a --slotz 3", "did you mean --slots?"},
      {"test a --fiel x", "did you mean --file?"},
      {"test a --zzzzzz", "no option --zzzzzz"},
      {"test a -q", "no option -q"},
      {"test a --slots 0", "from 1 to 64"},
      {"test a --slots 65", "from 1 to 64"},
      {"test a --slots 3x", "\"3x\""},
      {"test a --slots 99999999999999999999", "whole number"},
      {"test a --slots", "needs a value"},
      {"test a -j", "needs a value"},
      {"test a --loud=3", "takes no value"},
      {"test a --help=3", "takes no value"},
      {"test", "needs A [B]"},
      {"test a b c", "\"c\""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct options options;
    struct error error;
    size_t count = 0;
    assert_int_equal(parse(&options, &count, &error, cases[i].line), STATUS_USAGE);
    if (!strstr(error.message, cases[i].says))
      fail_msg("%s: \"%s\" lacks \"%s\"", cases[i].line, error.message, cases[i].says);
  }
}

static void test_too_many(void **state) {
  (void)state;
  static char *argv[140];
  static char set[] = "--set", value[] = "a=1", name[] = "test";
  struct options options;
  struct error error;
  size_t count = 0;
  char **arguments = NULL;
  bool help = false;
  argv[0] = name;
  for (int i = 1; i < 131; i += 2)
    argv[i] = set, argv[i + 1] = value;
  assert_int_equal(option_parse(&command, 131, argv, &options, &count, &arguments, &help, &error), STATUS_USAGE);
}

static void test_nearest_name(void **state) {
  (void)state;
  const char *names[] = {"status", "stats", "spectrum"};
  assert_string_equal(option_nearest("stat", 3, names), "stats");
  assert_string_equal(option_nearest("spektrum", 3, names), "spectrum");
  assert_null(option_nearest("elephant", 3, names));
}

/* Of every command of the program: help names each option, has examples that call it, and lines fit a terminal. */
static void test_help_is_whole(void **state) {
  (void)state;
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *each = commands_all()[i];
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    option_help(each, out);
    fclose(out);
    for (size_t k = 0; k < each->option_count; k++) {
      char name[64];
      snprintf(name, sizeof name, "--%s", each->options[k].name);
      if (!strstr(text, name))
        fail_msg("%s: help lacks %s", each->name, name);
    }
    assert_non_null(strstr(each->examples, each->name));
    assert_int_not_equal(strlen(each->doc), 0);
    assert_true(each->options_size <= OPTION_STRUCT_MAXIMUM);
    size_t lines = 0;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++)
      if (strlen(line) > 120)
        fail_msg("%s: help line is %zu wide: %s", each->name, strlen(line), line);
    assert_true(lines > 8);
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_values),       cmocka_unit_test(test_refusals),      cmocka_unit_test(test_too_many),
      cmocka_unit_test(test_nearest_name), cmocka_unit_test(test_help_is_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
