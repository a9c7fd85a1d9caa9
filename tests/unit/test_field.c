/* Field tables: defaults, finding, conditions, setting and parsing with their messages, JSON, identity, bytes. */

#include "schemas/rows.h"
#include "schemas/text.h"
#include "tests/support/check.h"

struct thing {
  double length, limit, angle;
  int64_t count, memory;
  bool broken;
  int law, mode;
  char name[FIELD_TEXT_SIZE];
  double needed;
  int unlisted; /* by no row */
};

static const char *const laws[] = {"weak", "strong", "off", NULL};
static const char *const modes[] = {"plain", "fancy", NULL};
static const struct field rows[] = {
    REAL_OF(thing, body.length, length, "m", 0.4, 0, HUGE_VAL, .flags = FIELD_ABOVE_MINIMUM, .doc = "How long it is.",
            .source = "a paper, eq. 3"),
    ROW_OF(thing, law, law, FIELD_CHOICE, NULL, .number = 1, .choices = laws, .choice_docs = "soft\nhard\nnone",
           .doc = "Which law."),
    REAL_OF(thing, body.limit, limit, "1", NAN, 0, 1, .flags = FIELD_MAY_BE_OFF | FIELD_BELOW_MAXIMUM, .doc = "Limit."),
    ROW_OF(thing, body.count, count, FIELD_INTEGER, "1", .number = 7, .minimum = 1, .maximum = 1e6, .doc = "How many."),
    ROW_OF(thing, memory, memory, FIELD_INTEGER, "B", .number = 1024, .minimum = 0, .maximum = HUGE_VAL,
           .doc = "Memory."),
    REAL_OF(thing, law_of.angle, angle, "rad", 0.5, -4, 4, .when = "law=weak|strong", .doc = "Angle."),
    ROW_OF(thing, broken, broken, FIELD_BOOLEAN, NULL, .number = 1, .doc = "Broken."),
    ROW_OF(thing, mode, mode, FIELD_CHOICE, NULL, .number = 0, .choices = modes, .when = "broken=true", .doc = "Mode."),
    ROW_OF(thing, name, name, FIELD_TEXT, NULL, .text = "none", .when = "mode=fancy", .doc = "Name."),
    REAL_OF(thing, other.length, needed, "m", 0, -HUGE_VAL, HUGE_VAL, .flags = FIELD_REQUIRED, .doc = "Needed."),
};
static const struct field_table table = FIELD_TABLE(rows, struct thing, "thing", "A thing for tests.");
enum { ROWS = sizeof rows / sizeof rows[0] };

static const struct field *row(const char *path) {
  const struct field *found = field_find(&table, path, NULL);
  assert_non_null(found);
  return found;
}

TEST(defaults_fill_everything) {
  struct thing thing;
  memset(&thing, 0xAA, sizeof thing);
  field_defaults(&table, &thing);
  assert_true(thing.length == 0.4 && field_is_off(thing.limit) && thing.count == 7 && thing.memory == 1024);
  assert_true(thing.broken && thing.law == 1 && thing.mode == 0 && thing.angle == 0.5);
  assert_string_equal(thing.name, "none");
  assert_true(isnan(thing.needed));
  thing.unlisted = 7;
  field_defaults(&table, &thing);
  assert_int_equal(thing.unlisted, 7); /* a member without a row is not changed */
}

TEST(finds_by_suffix) {
  assert_ptr_equal(field_find(&table, "body.count", &error), &rows[3]);
  assert_ptr_equal(field_find(&table, "count", &error), &rows[3]);
  assert_ptr_equal(field_find(&table, "angle", &error), &rows[5]);
  assert_null(field_find(&table, "length", &error));
  assert_string_equal(error.message, "'length' is ambiguous in the thing: it may be 'body.length', 'other.length'");
  assert_null(field_find(&table, "ount", &error)); /* a suffix begins at a dot */
  assert_null(field_find(&table, "body.cuont", &error));
  assert_string_equal(error.message, "the thing has no 'body.cuont'; did you mean 'body.count'?");
  assert_null(field_find(&table, "machine.length", &error)); /* the last word has no fault: not a short word near */
  assert_string_equal(error.message,
                      "the thing has no 'machine.length'; did you mean 'body.length' or 'other.length'?");
  assert_null(field_find(&table, "body.side", &error)); /* nothing in the section is near */
  assert_string_equal(error.message, "the thing has no 'body.side'; known in 'body' are length, limit, count");
  assert_null(field_find(&table, "limt", &error));
  assert_string_equal(error.message, "the thing has no 'limt'; did you mean 'body.limit'?");
  assert_null(field_find(&table, "zzzzzz", &error));
  assert_string_equal(error.message, "the thing has no 'zzzzzz'; 'clast explain' lists what it has");
  assert_int_equal(error.status, STATUS_CONTENT);
  assert_null(field_find(&table, "", &error));
}

TEST(distances_count_slips) {
  assert_int_equal(text_distance("kitten", 6, "sitting"), 3);
  assert_int_equal(text_distance("kittens of a litter", 6, "sitting"), 3); /* only `length` bytes are read */
  assert_int_equal(text_distance("", 0, "abc"), 3);
  assert_int_equal(text_distance("abc", 3, "abc"), 0);
  assert_int_equal(text_distance("simulate", 8, "simualte"), 1); /* a swap of two letters counts as one error */
  char lengthy[400];
  memset(lengthy, 'a', sizeof lengthy);
  lengthy[399] = 0;
  assert_true(text_distance(lengthy, 399, "a") == SIZE_MAX);
}

/* A stream that makes a text: right after each flush and at the end, however long. */
TEST(texts_grow) {
  enum { LINES = 3000 };
  char *text, line[32];
  size_t size;
  FILE *out = text_open_sized(&text, &size);
  assert_non_null(out);
  assert_int_equal(fflush(out), 0);
  assert_true(size == 0 && *text == '\0');
  for (int i = 0; i < LINES; i++) {
    fprintf(out, "line %08d\n", i);
    if (i % 1000 == 0)
      assert_int_equal(fflush(out), 0);
    if (i == 1000)
      assert_int_equal(size, 14 * 1001);
    assert_int_equal(ftell(out), 14 * (i + 1));
  }
  assert_ptr_equal(text_close(out, &text), text);
  assert_int_equal(size, 14 * LINES);
  assert_int_equal(strlen(text), size);
  for (int i = 0; i < LINES; i++) {
    snprintf(line, sizeof line, "line %08d\n", i);
    assert_memory_equal(text + 14 * (size_t)i, line, 14);
  }
  free(text);
  out = text_open_sized(&text, &size);
  assert_string_equal(text_close(out, &text), "");
  free(text);
}

/* How many slips a word may have, by its number of letters, and the guess that follows: `near` has as many slips as are
 * allowed, `far` one more. A name that shares no letter with the word is no guess, however short both are. */
TEST(guesses_by_length) {
  static const struct {
    const char *typed, *near, *far;
    size_t limit;
  } cases[] = {
      {"a", "a", "b", 0},
      {"ab", "ax", "xy", 1},
      {"abc", "abx", "axy", 1},
      {"abcd", "abxy", "axyz", 2},
      {"abcde", "abcxy", "abxyz", 2},
      {"abcdef", "abcdxy", "abcxyz", 2},
      {"abcdefg", "abcdexy", "abcdxyz", 2},
      {"abcdefgh", "abcdefxy", "abcdexyz", 2},
      {"abcdefghi", "abcdefxyz", "abcdewxyz", 3},
      {"abcdefghijkl", "abcdefghwxyz", "abcdefgvwxyz", 4},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    assert_int_equal(text_distance_limit(strlen(cases[i].typed)), cases[i].limit);
    struct text_guess guess = text_guess(cases[i].typed);
    text_guess_offer(&guess, cases[i].far);
    assert_null(guess.nearest);
    text_guess_offer(&guess, cases[i].near);
    assert_ptr_equal(guess.nearest, cases[i].near);
  }
  struct text_guess guess = text_guess("abcd");
  text_guess_offer(&guess, "xy"); /* four slips */
  text_guess_offer(&guess, "bc"); /* two, as many as it has letters */
  assert_null(guess.nearest);
  guess = text_guess("strain");
  const char *far = "threshold.strxyn", *part = "threshold.strian", *whole = "strein";
  text_guess_offer_part(&guess, far + 10, far); /* as many slips as are allowed */
  assert_ptr_equal(guess.nearest, far);
  text_guess_offer_part(&guess, part + 10, part);
  assert_ptr_equal(guess.nearest, part);
  text_guess_offer(&guess, whole); /* as near, and a whole name */
  assert_ptr_equal(guess.nearest, whole);
  text_guess_offer(&guess, "streen");
  assert_ptr_equal(guess.nearest, whole);
}

TEST(conditions_chain) {
  struct thing thing;
  char why[200];
  field_defaults(&table, &thing);
  assert_true(field_is_active(&table, row("angle"), &thing));
  thing.law = 2;
  assert_false(field_is_active(&table, row("angle"), &thing));
  field_describe_inactive(&table, row("angle"), &thing, why, sizeof why);
  assert_string_equal(why, "used only when law is weak or strong; here it is off");
  assert_false(field_is_active(&table, row("name"), &thing));
  thing.mode = 1;
  assert_true(field_is_active(&table, row("name"), &thing));
  thing.broken = false; /* mode itself is inactive now, whatever it holds */
  assert_false(field_is_active(&table, row("name"), &thing));
  field_describe_inactive(&table, row("name"), &thing, why, sizeof why);
  assert_string_equal(why, "used only when broken is true; here it is false");
  field_describe_inactive(&table, row("body.count"), &thing, why, sizeof why);
  assert_string_equal(why, "");
  static const struct field circular[] = {
      ROW_OF(thing, a, broken, FIELD_BOOLEAN, NULL, .when = "b=false"),
      ROW_OF(thing, b, broken, FIELD_BOOLEAN, NULL, .when = "a=false"),
  };
  const struct field_table round = FIELD_TABLE(circular, struct thing, "round", "");
  assert_false(field_is_active(&round, &circular[0], &thing)); /* ends */
}

TEST(parses_or_says_why) {
  static const struct {
    const char *path, *text, *shown, *message; /* either `shown` or `message` */
  } cases[] = {
      {"body.length", "40 cm", "0.4 m", NULL},
      {"body.length", "0", NULL, "body.length: expected above 0 m, got 0 m"},
      {"body.length", "-3 km", NULL, "body.length: expected above 0 km, got -3 km"},
      {"body.length", "3 s", NULL, "body.length: expected a length such as m, got a time (s)"},
      {"body.length", "off", NULL, "body.length: cannot be switched off"},
      {"body.limit", "off", "off", NULL},
      {"body.limit", "3 %", "0.03", NULL},
      {"body.limit", "1", NULL, "body.limit: expected at least 0 and below 1, or off, got 1"},
      {"body.limit", "no", NULL, "body.limit: expected a number, or off, got 'no'"},
      {"body.limit", "nan", NULL, "body.limit: expected a finite number, or off, got 'nan'"},
      {"body.count", "12", "12", NULL},
      {"body.count", "1e3", "1000", NULL},
      {"body.count", "1.5", NULL, "body.count: expected a whole number, got 1.5"},
      {"body.count", "0", NULL, "body.count: expected at least 1 and at most 1e6, got 0"},
      {"body.count", "many", NULL, "body.count: expected a number, got 'many'"},
      {"body.count", "99999999999999999999", NULL, "body.count: expected a whole number, got 1e20"},
      {"memory", "2 GiB", "2147483648 B", NULL},
      {"body.length", "3", NULL, "body.length: 3 has no unit; write '3 cm' or '3 m'"},
      {"body.length", " 3e-2 ", NULL, "body.length: 3e-2 has no unit; write '3e-2 cm' or '3e-2 m'"},
      {"law_of.angle", "4", NULL, "law_of.angle: 4 has no unit; write '4 deg' or '4 rad'"},
      {"memory", "9", NULL, "memory: 9 has no unit; write '9 MiB' or '9 B'"},
      {"memory", "9007199254740993 B", "9007199254740993 B", NULL}, /* beyond 2^53: no double in between */
      {"memory", "3 m", NULL, "memory: expected an amount of memory such as B, got a length (m)"},
      {"broken", "true", "true", NULL},
      {"broken", "yes", NULL, "broken: expected true or false, got 'yes'"},
      {"law", "weak", "weak", NULL},
      {"law", "off", "off", NULL},
      {"law", "strng", NULL, "law: expected weak, strong or off, got 'strng'; did you mean 'strong'?"},
      {"law", "./my-law.yaml", NULL, "law: expected weak, strong or off, got './my-law.yaml'"},
      {"law", "", NULL, "law: expected weak, strong or off, got ''"},
      {"name", "Ida", "Ida", NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct field_value value;
    char shown[400];
    status code = field_parse(row(cases[i].path), cases[i].text, &value, &error);
    if (cases[i].message) {
      assert_int_equal(code, STATUS_CONTENT);
      assert_string_equal(error.message, cases[i].message);
    } else {
      if (code)
        fail_msg("%s: %s", cases[i].text, error.message);
      field_print(row(cases[i].path), &value, shown, sizeof shown);
      assert_string_equal(shown, cases[i].shown);
      struct field_value again; /* the printed text reads back as the same value */
      OK(field_parse(row(cases[i].path), shown, &again, &error));
      assert_memory_equal(&again, &value, sizeof value);
    }
  }
  char lengthy[FIELD_TEXT_SIZE + 1];
  memset(lengthy, 'x', sizeof lengthy);
  lengthy[FIELD_TEXT_SIZE] = 0;
  struct field_value value;
  assert_int_equal(field_parse(row("name"), lengthy, &value, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "name: expected at most 255 bytes of text, got 256");
  OK(field_parse(row("name"), lengthy + 1, &value, &error));
}

/* For most people a strain of 5 means 5 %, for a program 500 %. */
TEST(percentages_are_written_as_such) {
  const struct field strain =
      {.path = "strain", .kind = FIELD_REAL, .unit = "1", .minimum = 1e-9, .maximum = 1e3, .flags = FIELD_PERCENT};
  static const struct {
    const char *text, *shown;
    double number;
  } cases[] = {{"3 %", "3 %", 0.03},         {"7%", "7 %", 0.07},
               {"0.1 %", "0.1 %", 0.001},    {"1e-7 %", "1e-7 %", 1e-9},
               {"1e5 %", "100000 %", 1000},  {"14.285714285714285 %", "14.285714285714285 %", 1.0 / 7},
               {"123.5 %", "123.5 %", 1.235}};
  struct field_value value, again;
  char shown[64];
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OK(field_parse(&strain, cases[i].text, &value, &error));
    assert_true(value.number == cases[i].number);
    field_print(&strain, &value, shown, sizeof shown);
    assert_string_equal(shown, cases[i].shown);
    OK(field_parse(&strain, shown, &again, &error));
    assert_true(again.number == value.number);
  }
  assert_int_equal(field_parse(&strain, "5", &value, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "strain: 5 is a percentage or a fraction; write '5 %' or '500 %'");
  OK(field_parse_si(&strain, "5", &value, &error)); /* of a store */
  assert_true(value.number == 5);
  assert_int_equal(field_parse(&strain, "2000000 %", &value, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "strain: expected at least 1e-7 and at most 100000 %, got 2e6 %");
}

TEST(sets_what_suits) {
  struct thing thing;
  field_defaults(&table, &thing);
  struct field_value value = {.kind = FIELD_INTEGER, .integer = 3};
  OK(field_set(row("body.length"), &thing, &value, &error));
  assert_true(thing.length == 3);
  value = (struct field_value){.kind = FIELD_REAL, .number = 12};
  OK(field_set(row("body.count"), &thing, &value, &error));
  assert_int_equal(thing.count, 12);
  value.number = 12.5;
  assert_int_equal(field_set(row("body.count"), &thing, &value, &error), STATUS_CONTENT);
  assert_int_equal(thing.count, 12);
  value.number = NAN;
  assert_int_equal(field_set(row("body.length"), &thing, &value, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "body.length: expected above 0 m, got a number that is not finite");
  value.number = HUGE_VAL;
  assert_int_equal(field_set(row("body.length"), &thing, &value, &error), STATUS_CONTENT);
  assert_int_equal(field_set(row("body.count"), &thing, &value, &error), STATUS_CONTENT);
  value.number = -0.0;
  OK(field_set(row("law_of.angle"), &thing, &value, &error));
  assert_false(signbit(thing.angle)); /* -0 and 0 are the same input, hence the same run */
  value = (struct field_value){.kind = FIELD_TEXT, .text = "weak"};
  OK(field_set(row("law"), &thing, &value, &error));
  assert_int_equal(thing.law, 0);
  value = (struct field_value){.kind = FIELD_CHOICE, .number = 2};
  OK(field_set(row("law"), &thing, &value, &error));
  assert_int_equal(thing.law, 2);
  value.number = 3;
  assert_int_equal(field_set(row("law"), &thing, &value, &error), STATUS_CONTENT);
  value = (struct field_value){.kind = FIELD_TEXT, .text = "5"};
  assert_int_equal(field_set(row("body.length"), &thing, &value, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "body.length: expected a number, got text");
}

TEST(json_and_identity) {
  struct thing thing;
  field_defaults(&table, &thing);
  thing.needed = -1.5e-7;
  thing.mode = 1;
  strcpy(thing.name, "a \"b\"\n\\c");
  char *text = field_json(&table, &thing);
  assert_string_equal(text,
                      "{\"body\":{\"length\":0.4,\"limit\":\"off\",\"count\":7},\"law\":\"strong\",\"memory\":1024,"
                      "\"law_of\":{\"angle\":0.5},\"broken\":true,\"mode\":\"fancy\",\"name\":\"a \\\"b\\\"\\n\\\\c\","
                      "\"other\":{\"length\":-1.5e-7}}");
  free(text);
  text = field_identity(&table, &thing);
  assert_string_equal(text, "body.count=7\nbody.length=0x1.999999999999ap-2\nbody.limit=off\nbroken=true\nlaw=strong\n"
                            "law_of.angle=0x1p-1\nmemory=1024\nmode=fancy\nname=a \"b\"\\n\\\\c\n"
                            "other.length=-0x1.421f5f40d8376p-23\n");
  free(text);
  thing.broken = false;
  thing.law = 2;
  text = field_identity(&table, &thing); /* inactive inputs are not part of it */
  assert_null(strstr(text, "name="));
  assert_null(strstr(text, "mode="));
  assert_null(strstr(text, "angle="));
  free(text);
  text = field_json(&table, &thing);
  assert_string_equal(text, "{\"body\":{\"length\":0.4,\"limit\":\"off\",\"count\":7},\"law\":\"off\",\"memory\":1024,"
                            "\"broken\":false,\"other\":{\"length\":-1.5e-7}}");
  free(text);
}

/* An input that came later is left out of the identity while it has the value that runs had before it, whatever its
 * default is today. */
TEST(absent_values_leave_the_identity) {
  static const struct field later[] = {
      REAL_OF(thing, angle, angle, "rad", 2, 0, 9, .absent = "0"),
      ROW_OF(thing, broken, broken, FIELD_BOOLEAN, NULL, .number = 1, .maximum = 1, .absent = "false"),
      ROW_OF(thing, count, count, FIELD_INTEGER, "1", .number = 2, .maximum = 9, .absent = "1"),
      ROW_OF(thing, law, law, FIELD_CHOICE, NULL, .number = 1, .choices = laws, .absent = "off"),
      REAL_OF(thing, limit, limit, "1", 0, 0, 0, .flags = FIELD_MAY_BE_OFF, .absent = "off"),
      ROW_OF(thing, name, name, FIELD_TEXT, NULL, .text = "new", .absent = ""),
  };
  const struct field_table six = FIELD_TABLE(later, struct thing, "later", "");
  struct thing thing;
  field_defaults(&six, &thing);
  char *text = field_identity(&six, &thing);
  assert_string_equal(text, "angle=0x1p+1\nbroken=true\ncount=2\nlaw=strong\nlimit=0x0p+0\nname=new\n");
  free(text);
  for (size_t i = 0; i < six.count; i++) {
    struct field_value value;
    assert_int_equal(field_parse_si(&later[i], later[i].absent, &value, NULL), STATUS_OK);
    field_set_unchecked(&later[i], &thing, &value);
  }
  text = field_identity(&six, &thing);
  assert_string_equal(text, "");
  free(text);
}

/* Both bodies have the same inputs, so those of the projectile are called so. */
TEST(labels_tell_bodies_apart) {
  char label[80];
  field_label_path("target.material.name", label, sizeof label);
  assert_string_equal(label, "material name");
  field_label_path("projectile.material.name", label, sizeof label);
  assert_string_equal(label, "projectile material name");
  field_label_path("projectile.radius", label, sizeof label);
  assert_string_equal(label, "projectile radius");
  const struct field row = {.path = "projectile.material.density", .label = "density"};
  field_label(&row, label, sizeof label);
  assert_string_equal(label, "projectile density");
}

TEST(explains) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(field_explain(&table, "body.length", false, out), 1);
  assert_int_equal(field_explain(&table, "law", false, out), 1); /* a word, not a prefix of letters */
  assert_int_equal(field_explain(&table, "law_of.angle", false, out), 1);
  fclose(out);
  assert_string_equal(text,
                      "body.length: real in m, above 0 m; default 0.4 m\n"
                      "    How long it is.\n"
                      "    Source: a paper, eq. 3\n"
                      "law: choice; default strong\n"
                      "    Which law.\n"
                      "      weak: soft\n"
                      "      strong: hard\n"
                      "      off: none\n"
                      "law_of.angle: real in deg, at least -229.183 and at most 229.183 deg; default 28.6479 deg\n"
                      "    Angle.\n"
                      "    Only when law is weak or strong\n");
  free(text);
  out = open_memstream(&text, &size);
  assert_int_equal(field_explain(&table, "", false, out), ROWS);
  assert_int_equal(field_explain(&table, "body", false, out), 3);
  assert_int_equal(field_explain(&table, "nothing", false, out), 0);
  fclose(out);
  free(text);
}

static void random_thing(uint64_t *word, struct thing *thing) {
  field_defaults(&table, thing);
  for (size_t i = 0; i < ROWS; i++) {
    *word ^= *word << 13;
    *word ^= *word >> 7;
    *word ^= *word << 17;
    struct field_value value = {.kind = rows[i].kind, .number = (double)(*word % 2)};
    memcpy(&value.integer, word, 8);
    if (rows[i].kind == FIELD_REAL)
      memcpy(&value.number, word, 8);
    size_t length = rows[i].kind == FIELD_TEXT ? *word % FIELD_TEXT_SIZE : 0;
    for (size_t k = 0; k < length; k++)
      value.text[k] = (char)(1 + (*word >> k % 56) % 255);
    field_set_unchecked(&rows[i], thing, &value);
  }
}

TEST(bytes_round_trip) {
  uint64_t word = 88172645463325252u;
  for (int i = 0; i < 2000; i++) {
    struct thing thing, back;
    random_thing(&word, &thing);
    size_t size = field_encoded_size(&table, &thing);
    OWNED uint8_t *bytes = malloc(size), *again = malloc(size);
    assert_int_equal(field_encode(&table, &thing, bytes), size);
    assert_int_equal(field_decode(&table, bytes, size, &back), size);
    assert_int_equal(field_encoded_size(&table, &back), size);
    field_encode(&table, &back, again);
    assert_memory_equal(bytes, again, size);
    assert_true(memcmp(&thing.length, &back.length, 8) == 0 && thing.count == back.count && thing.law == back.law);
    assert_string_equal(thing.name, back.name);
    for (size_t cut = 0; cut < size; cut += 1 + cut / 8)
      assert_int_equal(field_decode(&table, bytes, cut, &back), 0);
  }
}

TEST(bytes_are_pinned_and_guarded) {
  struct pair {
    double x;
    int law;
    bool b;
    char name[FIELD_TEXT_SIZE];
  } pair, back;
  const struct field few[] = {
      REAL_OF(pair, x, x, NULL, 0, 0, 0),
      ROW_OF(pair, law, law, FIELD_CHOICE, NULL, .choices = laws),
      ROW_OF(pair, b, b, FIELD_BOOLEAN, NULL),
      ROW_OF(pair, name, name, FIELD_TEXT, NULL),
  };
  struct field changed[4];
  struct field_table small = {.rows = few, .count = 4, .size = sizeof pair, .name = "pair"};
  memset(&pair, 0, sizeof pair);
  pair.x = -2;
  pair.law = 2;
  pair.b = true;
  strcpy(pair.name, "hi");
  uint8_t bytes[64];
  size_t size = field_encode(&small, &pair, bytes);
  assert_true(text_hash(TEXT_HASH_START, "a", 1) == UINT64_C(0xaf63dc4c8601ec8c)); /* a published known answer */
  /* FNV-1a 64 of the rows' names, kinds and choices, each closed by 0xff (computed by an independent program). */
  static const uint8_t expected[] = {0xbb, 0xae, 0x80, 0xc7, 0x0f, 0x69, 0x70, 0x70, /* table */
                                     0,    0,    0,    0,    0,    0,    0,    0xc0, 2, 0, 1, 2, 'h', 'i'};
  assert_int_equal(size, sizeof expected);
  assert_memory_equal(bytes + 8, expected + 8, size - 8);
  assert_memory_equal(bytes, expected, 8);
  /* Another name, kind, order or choice is refused. */
  for (int change = 0; change < 4; change++) {
    memcpy(changed, few, sizeof few);
    if (change == 0)
      changed[0].path = "y";
    if (change == 1)
      changed[0].kind = FIELD_INTEGER;
    if (change == 2)
      changed[1] = few[2], changed[2] = few[1];
    if (change == 3)
      changed[1].choices = modes;
    struct field_table other = small;
    other.rows = changed;
    assert_int_equal(field_decode(&other, bytes, size, &back), 0);
  }
  bytes[16] = 3; /* no such choice */
  assert_int_equal(field_decode(&small, bytes, size, &back), 0);
  bytes[16] = 2;
  bytes[18] = 2; /* no such truth */
  assert_int_equal(field_decode(&small, bytes, size, &back), 0);
  bytes[18] = 1;
  assert_int_equal(field_decode(&small, bytes, size, &back), size);
  assert_string_equal(back.name, "hi");
}
