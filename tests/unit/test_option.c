/* Option tables: parsing, defaults, ranges, the nearest name, help that mentions every option. */

#include "campaign/commands/commands.h"
#include "tests/support/check.h"

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
    .text = "a test\n\nDoes a test.\n\nexamples:\nclast test a\n",
    .options = rows,
    .option_count = 4,
    .options_size = sizeof(struct options),
    .has_table = true,
};

static status parse(struct options *options, struct command_line *parsed, struct error *e, const char *line) {
  static char text[256], *argv[32];
  int argc = 0;
  snprintf(text, sizeof text, "%s", line);
  for (char *word = strtok(text, " "); word; word = strtok(NULL, " "))
    argv[argc++] = word;
  argv[argc] = NULL;
  e->message[0] = '\0';
  return option_parse(&command, argc, argv, options, parsed, e);
}

TEST(test_values) {
  struct options options;
  struct command_line line;
  assert_int_equal(parse(&options, &line, &error, "test a"), STATUS_OK);
  assert_int_equal(line.format, TABLE_TEXT);
  assert_int_equal(options.slots, 2);
  assert_string_equal(options.file, "out.db");
  assert_false(options.loud);
  assert_int_equal(options.set.count, 0);
  assert_int_equal(parse(&options, &line, &error, "test -lj 8 a --set x=1 --file=f --set y=-2 --set x=1 b"), STATUS_OK);
  assert_true(options.loud);
  assert_int_equal(options.slots, 8);
  assert_string_equal(options.file, "f");
  assert_int_equal(options.set.count, 2); /* what is given again adds nothing */
  assert_string_equal(options.set.items[1], "y=-2");
  assert_int_equal(line.count, 2);
  assert_int_equal(parse(&options, &line, &error, "test --csv a"), STATUS_OK);
  assert_int_equal(line.format, TABLE_CSV);
  assert_int_equal(parse(&options, &line, &error, "test a -h --nonsense"), STATUS_OK);
  assert_true(line.help);
}

TEST(test_refusals) {
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
      {"test a --json --csv", "exclude each other"},
      {"test a --set x=1 --set y=1 --set x=2", "--set is given twice, as \"x=1\" and \"x=2\": leave one of them out"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct options options;
    struct command_line line;
    assert_int_equal(parse(&options, &line, &error, cases[i].line), STATUS_USAGE);
    if (!strstr(error.message, cases[i].says))
      fail_msg("%s: \"%s\" lacks \"%s\"", cases[i].line, error.message, cases[i].says);
  }
}

TEST(test_too_many) {
  static char *argv[140];
  static char set[] = "--set", value[] = "a=1", name[] = "test";
  struct options options;
  struct command_line line;
  argv[0] = name;
  for (int i = 1; i < 131; i += 2)
    argv[i] = set, argv[i + 1] = value;
  assert_int_equal(option_parse(&command, 131, argv, &options, &line, &error), STATUS_USAGE);
}

TEST(test_nearest_name) {
  const char *names[] = {"status", "stats", "spectrum"};
  assert_string_equal(option_nearest("stat", 3, names), "stats");
  assert_string_equal(option_nearest("spektrum", 3, names), "spectrum");
  assert_null(option_nearest("elephant", 3, names));
}

/* Of every command of the program: help names each option, has examples that call it, and lines fit a terminal. */
TEST(test_help_is_whole) {
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *each = commands_all()[i];
    OWNED char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    help_one(each, out);
    fclose(out);
    const struct option_row *row;
    for (size_t k = 0; (row = option_row(each, k)); k++) {
      char name[64], doc[OPTION_DOC];
      option_doc(each, row, doc);
      if (strlen(doc) < 6 || strlen(doc) > OPTION_DOC - 2)
        fail_msg("%s.txt has no words about %s, or too many", each->name, row->name);
      snprintf(name, sizeof name, "--%s", row->name);
      if (!strstr(text, name))
        fail_msg("%s: help lacks %s", each->name, name);
    }
    int length;
    for (int part = OPTION_SUMMARY; part <= OPTION_EXAMPLES; part++) {
      if (part == OPTION_ROWS) /* not every command has options of its own */
        continue;
      const char *words = option_part(each, (enum option_part)part, &length);
      if (length == 0 || words[length - 1] == '\n' || words[0] == '\n')
        fail_msg("%s.txt: part %d is empty, or has an empty line too much", each->name, part);
    }
    const char *told = option_part(each, OPTION_ROWS, &length), *end = told + length;
    for (; told < end; told += strcspn(told, "\n") + 1) { /* and no words about options that it does not have */
      size_t k = 0;
      while ((row = option_row(each, k)) &&
             (strncmp(told, row->name, strlen(row->name)) != 0 || strncmp(told + strlen(row->name), ": ", 2) != 0))
        k++;
      if (!row && strncmp(told, "  ", 2) != 0)
        fail_msg("%s.txt: no option: %.40s", each->name, told);
    }
    assert_non_null(strstr(option_part(each, OPTION_EXAMPLES, &length), each->name));
    assert_true((each->run != NULL) != (each->ask != NULL));
    assert_true(each->options_size <= OPTION_STRUCT_MAXIMUM);
    size_t lines = 0;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++)
      if (strlen(line) > 100)
        fail_msg("%s: help line is %zu wide: %s", each->name, strlen(line), line);
    assert_true(lines > 8);
  }
}

/* Documents that the build embeds have the form that their readers expect, wherever a writer edited them. */
TEST(test_documents) {
  extern const char references_text[], glossary_text[];
  size_t papers = 0, words = 0;
  (void)state;
  for (const char *entry = references_text; *entry; papers++) {
    const char *end = strstr(entry, "\n}\n"), *year = strstr(entry, "\n  year = {");
    if (!end || *entry != '@' || !year || year > end || strncmp(strchr(entry, '\n') + 1, "  cited = {", 11) != 0)
      fail_msg("references.bib: no entry of the form of the others: %.40s", entry);
    entry = end + 3;
  }
  assert_in_range(papers, 15, 64); /* cite.c has room for 64 */
  for (const char *line = glossary_text; *line; line = strchr(line, '\n') + 1) {
    const bool head = line == glossary_text || strncmp(line - 2, "\n\n", 2) == 0;
    const size_t length = strcspn(line, "\n");
    if (!line[length] || (head && (*line == ' ' || length == 0)) ||
        (!head && length > 0 && strncmp(line, "    ", 4) != 0))
      fail_msg("glossary.txt: a line at the wrong place: %.40s", line);
    words += head;
  }
  assert_in_range(words, 20, 200);
}
