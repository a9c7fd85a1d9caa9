/* Documents: the exact text of each kind of error, with line, column and caret; several errors of one file in one
 * report, sorted; parts, trees and values. */
#include "tests/support/document_thing.h"

static int differs(const char *text, size_t size, const char *expected) {
  struct thing thing;
  OWNED char *report = report_of(text, size, &thing);
  int wrong = strcmp(report ? report : "", expected ? expected : "") != 0;
  if (wrong)
    print_error("--- of\n%s\n--- came\n%s\n--- expected\n%s\n", text, report ? report : "(no error)",
                expected ? expected : "(no error)");
  return wrong;
}

TEST(good_documents_are_read) {
  struct thing thing;
  char *report = report_text(
      "# comment\nshape: block\nblock: {height: 12 mm}\nbody:\n  length: \"30 cm\"\n  limit: off\n  count: 1e1\n"
      "memory: 2 KiB\nbroken: False\ncontact: {law: off}\nname: 'o''k'\nnote: [any, {thing: 1}]\n",
      &thing);
  if (report)
    print_error("%s\n", report);
  assert_null(report);
  assert_true(thing.shape == 1 && thing.needed == 0.012 && thing.length == 0.3 && field_is_off(thing.limit));
  assert_true(thing.count == 10 && thing.memory == 2048 && !thing.broken && thing.law == 2);
  assert_string_equal(thing.name, "o'k");
  report = report_text(
      "%YAML 1.2\n--- # start\n{\"body\": {\"length\": 1.5 m, \"limit\": -1e30}, name: 007, broken: true}\n...\n",
      &thing);
  if (report)
    print_error("%s\n", report);
  assert_null(report);
  assert_true(thing.length == 1.5 && thing.limit == -1e30);
  assert_string_equal(thing.name, "007"); /* as written */
  report = report_text("\xEF\xBB\xBF"
                       "contact: &c {speed: 3 km/h}\r\nbody: {length: &l 0, limit: *l}\r\n",
                       &thing);
  if (report)
    print_error("%s\n", report);
  assert_null(report);
  assert_true(thing.limit == 0);
}

TEST(each_error_says_this) {
  static const struct {
    const char *text, *report;
  } cases[] = {
      {"shape: dics\n", "a.yaml:1:8: error: shape: expected disc or block, got 'dics'; did you mean 'disc'?\n"
                        "  shape: dics\n"
                        "         ^~~~"},
      {"body:\n  lenght: 3\n", "a.yaml:2:3: error: body.lenght: unknown key; did you mean 'length'?\n"
                               "    lenght: 3\n"
                               "    ^~~~~~"},
      {"body:\n  zzzzzz: 3\n", "a.yaml:2:3: error: body.zzzzzz: unknown key; known here are length, limit, count\n"
                               "    zzzzzz: 3\n"
                               "    ^~~~~~"},
      {"bodi: {length: 3}\n", "a.yaml:1:1: error: bodi: unknown key; did you mean 'body'?\n"
                              "  bodi: {length: 3}\n"
                              "  ^~~~"},
      {"length: 3\n", "a.yaml:1:1: error: length: unknown key; did you mean 'body.length'?\n"
                      "  length: 3\n"
                      "  ^~~~~~"},
      {"body.length: 3\n",
       "a.yaml:1:1: error: body.length: a path with dots; nest it: write 'body:' and the rest indented below it\n"
       "  body.length: 3\n"
       "  ^~~~~~~~~~~"},
      {"<<: {a: 1}\n", "a.yaml:1:1: error: <<: merge keys are not part of YAML 1.2; write the keys out\n"
                       "  <<: {a: 1}\n"
                       "  ^~"},
      {"body: {length: 11 m}\n", "a.yaml:1:16: error: body.length: expected at least 0 and at most 10 m, got 11 m\n"
                                 "  body: {length: 11 m}\n"
                                 "                 ^~~~"},
      {"body: {length: 3 s}\n", "a.yaml:1:16: error: body.length: expected a length such as m, got a time (s)\n"
                                "  body: {length: 3 s}\n"
                                "                 ^~~"},
      {"contact: {speed: 5 kph}\n", "a.yaml:1:18: error: contact.speed: unknown unit 'kph'; did you mean 'km/h'?\n"
                                    "  contact: {speed: 5 kph}\n"
                                    "                   ^~~~~"},
      {"body: {length: .nan}\n",
       "a.yaml:1:16: error: body.length: expected a finite number in m, such as '5 m', got '.nan'\n"
       "  body: {length: .nan}\n"
       "                 ^~~~"},
      {"body: {length: -.inf}\n",
       "a.yaml:1:16: error: body.length: expected a finite number in m, such as '5 m', got '-.inf'\n"
       "  body: {length: -.inf}\n"
       "                 ^~~~~"},
      {"body: {length: 0x2}\n", "a.yaml:1:16: error: body.length: expected a decimal number, got '0x2'\n"
                                "  body: {length: 0x2}\n"
                                "                 ^~~"},
      {"body: {length: off}\n", "a.yaml:1:16: error: body.length: cannot be switched off\n"
                                "  body: {length: off}\n"
                                "                 ^~~"},
      {"body: {length: }\n", "a.yaml:1:8: error: body.length: expected at least 0 and at most 10 m, got nothing\n"
                             "  body: {length: }\n"
                             "         ^~~~~~"},
      {"body: {length: [1, 2]}\n", "a.yaml:1:16: error: body.length: expected at least 0 and at most 10 m, got a list\n"
                                   "  body: {length: [1, 2]}\n"
                                   "                 ^~~~~~"},
      {"body: {count: 2.5}\n", "a.yaml:1:15: error: body.count: expected a whole number, got 2.5\n"
                               "  body: {count: 2.5}\n"
                               "                ^~~"},
      {"body: {count: \"2\"}\n",
       "a.yaml:1:15: error: body.count: expected a whole number, got a text in quotes; remove the quotes\n"
       "  body: {count: \"2\"}\n"
       "                ^~~"},
      {"broken: yes\n", "a.yaml:1:9: error: broken: expected true or false, got 'yes'\n"
                        "  broken: yes\n"
                        "          ^~~"},
      {"broken: 'true'\n",
       "a.yaml:1:9: error: broken: expected true or false, got a text in quotes; remove the quotes\n"
       "  broken: 'true'\n"
       "          ^~~~~~"},
      {"name: ~\n", "a.yaml:1:7: error: name: expected text, got nothing\n"
                    "  name: ~\n"
                    "        ^"},
      {"body: 3\n",
       "a.yaml:1:7: error: body: expected keys and values below it (length, limit, count), got a single value\n"
       "  body: 3\n"
       "        ^"},
      {"body:\nname: x\n",
       "a.yaml:1:1: error: body: expected keys and values below it (length, limit, count), got nothing\n"
       "  body:\n"
       "  ^~~~"},
      {"shape: block\n", "a.yaml:1:1: error: block.height: is missing and has no default; Height of the block.\n"
                         "  shape: block\n"
                         "  ^"},
      {"name: a\nshape: block\nblock: {}\n",
       "a.yaml:3:8: error: block.height: is missing and has no default; Height of the block.\n"
       "  block: {}\n"
       "         ^"},
      {"block: {height: 3 m}\n", "a.yaml:1:9: error: block.height: has no effect: it is used only when shape is block; "
                                 "here it is disc; remove one or change the other\n"
                                 "  block: {height: 3 m}\n"
                                 "          ^~~~~~"},
      /* No message about height: its effect is unknown while the shape is wrong. */
      {"shape: blokc\nblock: {height: 3 m}\n",
       "a.yaml:1:8: error: shape: expected disc or block, got 'blokc'; did you mean 'block'?\n"
       "  shape: blokc\n"
       "         ^~~~~"},
      {"name: a\nname: b\n", "a.yaml:2:1: error: name: given twice; the first is in line 1; remove one\n"
                             "  name: b\n"
                             "  ^~~~"},
      {"body: {count: 3, \"count\": 4}\n",
       "a.yaml:1:18: error: body.count: given twice; the first is in line 1; remove one\n"
       "  body: {count: 3, \"count\": 4}\n"
       "                   ^~~~~~~"},
      {"name: a\n---\nname: b\n", "a.yaml:2:1: error: a second document starts here; one file holds one document\n"
                                  "  ---\n"
                                  "  ^~~"},
      {"body:\n\tlength: 3\n", "a.yaml:2:1: error: a tab as indentation; YAML wants spaces\n"
                               "  \tlength: 3\n"
                               "  ^"},
      {"name: \x01\n", "a.yaml:1:7: error: a control character (first byte 0x01); remove it\n"
                       "  name: ?\n"
                       "        ^"},
      {"name: \"\\e[31m\"\n", "a.yaml:1:7: error: name: text with an escaped control character (0x1b); remove it\n"
                              "  name: \"\\e[31m\"\n"
                              "        ^~~~~~~~"},
      {"name: \"a\\0b\"\n", "a.yaml:1:7: error: name: text with an escaped control character (0x00); remove it\n"
                            "  name: \"a\\0b\"\n"
                            "        ^~~~~~"},
      {"name: caf\xE9\n", "a.yaml:1:10: error: invalid UTF-8 (byte 0xe9); save the file as UTF-8\n"
                          "  name: caf?\n"
                          "           ^"},
      {"name: *nowhere\n", "a.yaml:1:7: error: name: alias '*nowhere' has no anchor '&nowhere' before it\n"
                           "  name: *nowhere\n"
                           "        ^~~~~~~~"},
      {"note: &a [1, *a]\n", "a.yaml:1:14: error: note[1]: alias '*a' is inside what it refers to\n"
                             "  note: &a [1, *a]\n"
                             "               ^~"},
      {"name: !!str x\n", "a.yaml:1:13: error: name: a tag; write the value without '!'\n"
                          "  name: !!str x\n"
                          "              ^"},
      {"%YAML 1.1\n---\nname: x\n", "a.yaml:1:1: error: expected YAML 1.2, got a %YAML 1.1 line; remove it\n"
                                    "  %YAML 1.1\n"
                                    "  ^"},
      {"? [a, b]\n: c\n", "a.yaml:1:3: error: expected a word as key, got a list\n"
                          "  ? [a, b]\n"
                          "    ^~~~~~"},
      {"- a\n- b\n", "a.yaml:1:1: error: expected keys and values, such as 'name: first', got a list\n"
                     "  - a\n"
                     "  ^"},
      {"just words\n", "a.yaml:1:1: error: expected keys and values, such as 'name: first', got a single value\n"
                       "  just words\n"
                       "  ^~~~~~~~~~"},
      {"", "a.yaml:1:1: error: the document is empty; expected keys and values, such as 'name: first'"},
      {"# only a comment\n",
       "a.yaml:1:1: error: the document is empty; expected keys and values, such as 'name: first'\n"
       "  # only a comment\n"
       "  ^"},
      {"a: [1, 2\n", "a.yaml:2:1: error: no valid YAML: a '[' without its ']'"},
      {"a: b: c\n", "a.yaml:1:5: error: no valid YAML: a value with ': ' in it needs quotes\n"
                    "  a: b: c\n"
                    "      ^"},
      {"name: \"abc\n", "a.yaml:1:8: error: no valid YAML: a '\"' without its second '\"'\n"
                        "  name: \"abc\n"
                        "         ^"},
      {"a: 'b' c\n", "a.yaml:1:8: error: no valid YAML: invalid trailing content after single-quoted scalar\n"
                     "  a: 'b' c\n"
                     "         ^"},
      {"a: @b\n", "a.yaml:1:4: error: no valid YAML: plain scalar cannot start with '@'\n"
                  "  a: @b\n"
                  "     ^"},
      /* Columns count characters, not bytes; tabs inside a line stay tabs above the caret. */
      {"body: {'\xC3\xA9\xE2\x82\xAC': 1}\n",
       "a.yaml:1:8: error: body.\xC3\xA9\xE2\x82\xAC: unknown key; known here are length, limit, count\n"
       "  body: {'\xC3\xA9\xE2\x82\xAC': 1}\n"
       "         ^~~~"},
      {"note: ['\xC3\xA9\xE2\x82\xAC', *a]\n", "a.yaml:1:14: error: note[1]: alias '*a' has no anchor '&a' before it\n"
                                               "  note: ['\xC3\xA9\xE2\x82\xAC', *a]\n"
                                               "               ^~"},
      {"'\xC3\xA9\xC3\xA9': 1\nname:\t[\xC3\xA9]\n", "a.yaml:1:1: error: \xC3\xA9\xC3\xA9: unknown key; known here are "
                                                     "shape, body, memory, broken, contact, name, block, note\n"
                                                     "  '\xC3\xA9\xC3\xA9': 1\n"
                                                     "  ^~~~\n"
                                                     "a.yaml:2:7: error: name: expected text, got a list\n"
                                                     "  name:\t[\xC3\xA9]\n"
                                                     "       \t^~~"},
  };
  int wrong = 0;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    wrong += differs(cases[i].text, strlen(cases[i].text), cases[i].report);
  wrong += differs("name: a\0b\n", 10,
                   "a.yaml:1:8: error: a NUL byte: this is not text; save the file as UTF-8\n"
                   "  name: a?b\n"
                   "         ^");
  wrong +=
      differs("SQLite format 3\0b\n", 18,
              "a.yaml:1:1: error: this is a store (an SQLite database); a document is expected, such as a campaign\n"
              "  SQLite format 3?b\n"
              "  ^~~~~~~~~~~~~~~");
  assert_int_equal(wrong, 0);
}

/* All errors of the file, in the order of its lines, whichever check found them. */
TEST(all_errors_in_one_go) {
  const char *text = "shape: dsic\nbody:\n  length: 3 kg\n  cuont: 3\n  limit: \"12 %\"\nbroken: no\nbroken: "
                     "off\ncontact: {law: off, speed: 3 m/s}\nnmae: x\n";
  assert_int_equal(differs(text, strlen(text),
                           "a.yaml:1:8: error: shape: expected disc or block, got 'dsic'; did you mean 'disc'?\n"
                           "  shape: dsic\n"
                           "         ^~~~\n"
                           "a.yaml:3:11: error: body.length: expected a length such as m, got a mass (kg)\n"
                           "    length: 3 kg\n"
                           "            ^~~~\n"
                           "a.yaml:4:3: error: body.cuont: unknown key; did you mean 'count'?\n"
                           "    cuont: 3\n"
                           "    ^~~~~\n"
                           "a.yaml:6:9: error: broken: expected true or false, got 'no'\n"
                           "  broken: no\n"
                           "          ^~\n"
                           "a.yaml:7:1: error: broken: given twice; the first is in line 6; remove one\n"
                           "  broken: off\n"
                           "  ^~~~~~\n"
                           "a.yaml:8:21: error: contact.speed: has no effect: it is used only when contact.law is weak "
                           "or strong; here it is off; remove one or change the other\n"
                           "  contact: {law: off, speed: 3 m/s}\n"
                           "                      ^~~~~\n"
                           "a.yaml:9:1: error: nmae: unknown key; did you mean 'name'?\n"
                           "  nmae: x\n"
                           "  ^~~~"),
                   0);
}

TEST(long_lines_and_many_errors_stay_readable) {
  char text[6000] = "name: x\n";
  struct thing thing;
  size_t used = strlen(text);
  for (int i = 0; i < 300; i++)
    used += (size_t)sprintf(text + used, "wrong_%d: 1\n", i);
  char *report = report_of(text, used, &thing);
  struct error whole;
  assert_true(strlen(report) < sizeof whole.message); /* the report fits into an error's message without being cut */
  assert_non_null(strstr(report, "a.yaml:2:1: error: wrong_0: unknown key"));
  const char *last = strrchr(report, '\n');
  int more = 0, shown = 0;
  assert_int_equal(sscanf(last, "\na.yaml: error: and %d more; correct the ones above first", &more), 1);
  for (const char *at = report; (at = strstr(at, "unknown key")); at++)
    shown++;
  assert_int_equal(shown + more, 300);
  assert_true(shown > 20);
  free(report);
  used = (size_t)sprintf(text, "note: [");
  for (int i = 0; i < 500; i++)
    used += (size_t)sprintf(text + used, "%d, ", i);
  used += (size_t)sprintf(text + used, "*gone");
  for (int i = 0; i < 500; i++)
    used += (size_t)sprintf(text + used, ", %d", i);
  sprintf(text + used, "]\n");
  report = report_of(text, strlen(text), &thing);
  assert_string_equal(
      report, "a.yaml:1:2398: error: note[500]: alias '*gone' has no anchor '&gone' before it\n"
              "  ...89, 490, 491, 492, 493, 494, 495, 496, 497, 498, 499, *gone, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1...\n"
              "                                                           ^~~~~");
  free(report);
}

/* A table read from a part of a document: paths are those of the document. */
TEST(parts_have_whole_paths) {
  struct document *document;
  struct thing thing;
  struct field_value value;
  const char
      *text = "part:\n  body: {lenght: 1, count: x}\n  shape: block\n  contact: {law: off, speed: 1 m/s}\nlist: [1, "
              "[2 s]]\nother: 3\n",
      *report;
  assert_int_equal(document_parse("a.yaml", text, strlen(text), &document, NULL), STATUS_OK);
  document_node *root = document_root(document);
  field_defaults(&table, &thing);
  assert_false(document_read(document_key(root, "part"), &table, NULL, &thing));
  assert_false(document_read(document_key(root, "other"), &table, NULL, &thing));
  document_node *item = document_item(document_item(document_key(root, "list"), 1, NULL), 0, NULL);
  assert_false(document_value(item, &rows[1], &value));
  document_finish(document, &report);
  assert_string_equal(report,
                      "a.yaml:2:3: error: part.block.height: is missing and has no default; Height of the block.\n"
                      "    body: {lenght: 1, count: x}\n"
                      "    ^\n"
                      "a.yaml:2:10: error: part.body.lenght: unknown key; did you mean 'length'?\n"
                      "    body: {lenght: 1, count: x}\n"
                      "           ^~~~~~\n"
                      "a.yaml:2:28: error: part.body.count: expected a number, got 'x'\n"
                      "    body: {lenght: 1, count: x}\n"
                      "                             ^\n"
                      "a.yaml:4:23: error: part.contact.speed: has no effect: it is used only when contact.law is weak "
                      "or strong; here it is off; remove one or change the other\n"
                      "    contact: {law: off, speed: 1 m/s}\n"
                      "                        ^~~~~\n"
                      "a.yaml:5:12: error: list[1][0]: expected a length such as m, got a time (s)\n"
                      "  list: [1, [2 s]]\n"
                      "             ^~~\n"
                      "a.yaml:6:8: error: other: expected keys and values, got a single value\n"
                      "  other: 3\n"
                      "         ^");
  document_free(document);
}

TEST(trees_are_walked) {
  struct document *document;
  const char *text = "vary:\n  a.b: [1, 2 m]\n  c: {from: 1, too: 2}\nset: 3\nextra: 4\n", *key, *report;
  assert_int_equal(document_parse("a.yaml", text, strlen(text), &document, NULL), STATUS_OK);
  document_node *root = document_root(document), *vary = document_key(root, "vary");
  assert_int_equal(document_kind(root), DOCUMENT_MAPPING);
  assert_int_equal(document_count(vary), 2);
  document_node *list = document_item(vary, 0, &key);
  assert_string_equal(key, "a.b");
  assert_int_equal(document_kind(list), DOCUMENT_SEQUENCE);
  assert_null(document_scalar(list));
  assert_string_equal(document_scalar(document_item(list, 1, &key)), "2 m");
  assert_null(key);
  assert_null(document_item(list, 2, NULL));
  assert_null(document_key(root, "nothing"));
  assert_null(document_key(list, "nothing"));
  document_node *range = document_item(vary, 1, NULL);
  document_key(range, "from");
  document_unknown_keys(range, "vary.c", (const char *const[]){"from", "to", NULL});
  document_key(root, "set");
  document_unknown_keys(root, "", (const char *const[]){"vary", "set", NULL});
  document_report(document_key(root, "set"), "set", "is %d", 3);
  assert_int_equal(document_finish(document, &report), STATUS_CONTENT);
  assert_string_equal(report, "a.yaml:3:16: error: vary.c.too: unknown key; did you mean 'to'?\n"
                              "    c: {from: 1, too: 2}\n"
                              "                 ^~~\n"
                              "a.yaml:4:6: error: set: is 3\n"
                              "  set: 3\n"
                              "       ^\n"
                              "a.yaml:5:1: error: extra: unknown key; known here are vary, set\n"
                              "  extra: 4\n"
                              "  ^~~~~");
  document_free(document);
}

/* Values added by the caller are read like those of the file; the text of the changed document contains them. */
TEST(values_are_put) {
  static const char text[] = "# a comment\nbody: {length: 2 m, count: 5}\nname: 'a: b'\nset:\n  x: [1 %, off]\n";
  struct document *document = NULL, *again = NULL;
  const char *report = NULL;
  OK(document_parse("a.yaml", text, strlen(text), &document, &error));
  OWNED char *unchanged = document_change_text(document);
  assert_string_equal(unchanged, text);
  OK(document_change_put(document, (const char *const[]){"body", "count"}, "6", "command line", &error));
  OK(document_change_put(document, (const char *const[]){"set", "y.z"}, "#3", "command line", &error));
  OK(document_change_put(document, (const char *const[]){"new", "a"}, "5 km/s", "command line", &error));
  assert_int_equal(document_change_put(document, (const char *const[]){"name", "a"}, "1", "command line", &error),
                   STATUS_CONTENT);
  assert_string_equal(document_scalar(document_key(document_key(document_root(document), "body"), "count")), "6");
  OWNED char *changed = document_change_text(document);
  assert_string_equal(changed, "# as read, with values of the command line; comments are left out\n"
                               "body: {length: 2 m, count: 6}\nname: \"a: b\"\nset: {x: [1 %, off], y.z: \"#3\"}\n"
                               "new: {a: 5 km/s}\n");
  OK(document_parse("b.yaml", changed, strlen(changed), &again, &error));
  assert_string_equal(document_scalar(document_key(document_key(document_root(again), "set"), "y.z")), "#3");
  document_free(again);
  /* an error about such a value names the command line instead of a place in the file, and is a usage error */
  document_report(document_key(document_key(document_root(document), "new"), "a"), "new.a", "is wrong");
  assert_int_equal(document_finish(document, &report), STATUS_USAGE);
  assert_string_equal(report, "command line: error: new.a: is wrong");
  document_report(document_key(document_root(document), "name"), "name", "is wrong, too");
  assert_int_equal(document_finish(document, &report), STATUS_CONTENT);
  document_free(document);
}
