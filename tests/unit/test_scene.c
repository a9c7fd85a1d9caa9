/* Scenes: built-in documents, reading with the engine's table, overrides, checks, identity; the hash behind it against
 * known answers. The registry is replaced by a tiny engine of this test: scene.c is compiled in here. */
#include <unistd.h>

#define engine_find tiny_find
#include "engine/scene.h"

#include "engine/scene.c" /* with engine_find replaced */
#include "schemas/rows.h"
#include "tests/support/check.h"
#undef engine_find

struct tiny {
  int kind;
  double speed, size;
  int64_t count;
};
static const char *const kinds[] = {"ball", "block", NULL};
static const struct field rows[] = {
    ROW_OF(tiny, kind, kind, FIELD_CHOICE, NULL, .choices = kinds, .doc = "Kind."),
    REAL_OF(tiny, impact.speed, speed, "m/s", 10, 0, 1e6, .doc = "Speed."),
    REAL_OF(tiny, ball.size, size, "m", 1, 0, 10, .when = "kind=ball", .doc = "Size."),
    ROW_OF(tiny, fidelity.count, count, FIELD_INTEGER, "1", .number = 5, .minimum = 1, .maximum = 1e9, .doc = "Count."),
};
static const struct field_table inputs = FIELD_TABLE(rows, struct tiny, "tiny scene", "A tiny engine.");

static status check(const void *object, struct error *e) {
  const struct tiny *tiny = object;
  if (tiny->count > 100 && tiny->speed > 100)
    return status_fail(e, STATUS_CONTENT, "fidelity.count: too much at this impact.speed");
  return STATUS_OK;
}
static const struct engine_kind tiny = {.name = "tiny", .results_version = 3, .inputs = &inputs, .check = check};
static const struct engine_kind tiny_next = {.name = "tiny", .results_version = 4, .inputs = &inputs, .check = check};

const struct engine_kind *tiny_find(const char *name, struct error *e) {
  if (strcmp(name, "tiny") == 0)
    return &tiny;
  status_fail(e, STATUS_CONTENT, "there is no engine '%.60s'; known are: tiny", name);
  return NULL;
}

static struct scene *parsed(const char *text) {
  struct scene *scene = NULL;
  OK(scene_parse("t", text, &scene, &error));
  return scene;
}

TEST(reads_and_fills_defaults) {
  SCENE scene = parsed("engine: tiny\nname: mine\nsource: a paper\nkind: ball\nball: {size: 3 cm}\n");
  const struct tiny *values = scene->inputs;
  assert_ptr_equal(scene->kind, &tiny);
  assert_true(values->speed == 10 && values->size == 0.03 && values->count == 5);
  assert_true(scene->given[0] && !scene->given[1] && scene->given[2] && !scene->given[3]);
  assert_string_equal(scene->name, "mine");
  OWNED char *json = scene_json(scene);
  assert_string_equal(json, "{\"engine\":\"tiny\",\"name\":\"mine\",\"kind\":\"ball\",\"impact\":{\"speed\":10},"
                            "\"ball\":{\"size\":0.03},\"fidelity\":{\"count\":5}}");
  SCENE again = NULL; /* resolved JSON is itself a scene document: a stored scene can be run again */
  assert_int_equal(scene_parse_json("t", json, &again, NULL), STATUS_OK);
  uint8_t one[16], two[16];
  scene_identity(scene, 7, one);
  scene_identity(again, 7, two);
  assert_memory_equal(one, two, 16);
  scene_free(NULL);
}

TEST(named_settings_give_inputs) {
  struct scene *scene = parsed("engine: tiny\nkind: ball\nball: {size: 3 cm}\nsettings:\n  draft: {ball.size: 5 cm}\n");
  const struct tiny *values = scene->inputs;
  OK(scene_settings_use(scene, "standard", &error));
  assert_true(values->size == 0.03);
  struct scene *copy = scene_copy(scene);
  OK(scene_settings_use(copy, "draft", &error));
  assert_true(values->size == 0.03 && ((const struct tiny *)copy->inputs)->size == 0.05);
  assert_false(copy->overridden[2]); /* as if it were in the document */
  assert_int_equal(scene_settings_use(copy, "drat", &error), STATUS_MISSING);
  assert_non_null(strstr(error.message, "standard, draft"));
  scene_free(copy);
  scene_free(scene);

  static const char *const wrong[] = {"5",
                                      "{standard: {ball.size: 5 cm}}",
                                      "{Draft: {ball.size: 5 cm}}",
                                      "{a: 5}",
                                      "{a: {ball.sise: 5 cm}}",
                                      "{a: {ball.size: 5 kg}}",
                                      "{a: {ball.size: [1]}}"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    char text[256];
    snprintf(text, sizeof text, "engine: tiny\nkind: ball\nball: {size: 3 cm}\nsettings: %s\n", wrong[i]);
    if (scene_parse("t", text, &scene, &error) != STATUS_CONTENT || !strstr(error.message, "settings"))
      fail_msg("%s: %s", wrong[i], error.message);
  }
}

TEST(errors_come_together) {
  struct scene *scene = NULL;
  assert_int_equal(scene_parse("t", "engine: tiny\nimpact: {speed: 3 m}\nball: {sise: 3}\n", &scene, &error),
                   STATUS_CONTENT);
  assert_null(scene);
  assert_string_equal(error.message, "t:2:17: error: impact.speed: expected a speed such as m/s, got a length (m)\n"
                                     "  impact: {speed: 3 m}\n"
                                     "                  ^~~\n"
                                     "t:3:8: error: ball.sise: unknown key; did you mean 'size'?\n"
                                     "  ball: {sise: 3}\n"
                                     "         ^~~~");
  assert_int_equal(scene_parse("t", "kind: ball\n", &scene, &error), STATUS_CONTENT);
  assert_string_equal(error.message,
                      "t:1:1: error: engine: is missing; say which engine runs this scene, such as 'engine: dem'\n"
                      "  kind: ball\n"
                      "  ^");
  assert_int_equal(scene_parse("t", "like: basalt\n", &scene, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "looks like the file of a material"));
  assert_int_equal(scene_parse("t", "material: tuff\n", &scene, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "engine: is missing: this looks like the file of a material"));
  assert_int_equal(scene_parse("t", "name: a\nscene: disruption@draft\nseeds: 3\n", &scene, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "this looks like a campaign of the scene disruption@draft. `clast explain "
                                        "disruption@draft` explains the scene"));
  assert_int_equal(scene_parse("t", "engine: [tiny]\n", &scene, &error), STATUS_CONTENT);
  assert_int_equal(scene_parse("t", "engine: sph\n", &scene, &error), STATUS_CONTENT);
  assert_string_equal(error.message, "t:1:9: error: engine: there is no engine 'sph'; known are: tiny\n"
                                     "  engine: sph\n"
                                     "          ^~~");
  assert_int_equal(scene_parse("t", "engine: tiny\nname: [a]\n", &scene, &error), STATUS_CONTENT);
}

TEST(overrides_are_checked) {
  struct scene *scene = parsed("engine: tiny\nkind: ball\nball: {size: 3 cm}\n"), *copy = scene_copy(scene);
  OK(scene_set_text(copy, "speed", "1 km/s", &error));
  assert_true(((struct tiny *)copy->inputs)->speed == 1000);
  assert_true(((struct tiny *)scene->inputs)->speed == 10); /* the original scene is unchanged */
  assert_int_equal(scene_set_text(copy, "speed", "1 km", &error), STATUS_CONTENT);
  assert_string_equal(error.message, "impact.speed: expected a speed such as m/s, got a length (km)");
  assert_int_equal(scene_set_text(copy, "sped", "1", &error), STATUS_CONTENT);
  assert_string_equal(error.message, "the tiny scene has no 'sped'; did you mean 'impact.speed'?");
  OK(scene_check(copy, &error));
  const struct field_value many = {.kind = FIELD_INTEGER, .integer = 1000};
  OK(scene_set(copy, "fidelity.count", &many, &error));
  assert_int_equal(scene_check(copy, &error), STATUS_CONTENT); /* a condition across fields: the engine's own message */
  assert_string_equal(error.message, "fidelity.count: too much at this impact.speed");
  scene_free(copy);
  copy = scene_copy(scene);
  OK(scene_set_text(copy, "kind", "block", &error));
  assert_int_equal(scene_check(copy, &error),
                   STATUS_OK); /* the document's ball.size has no effect now: as if it had not been there */
  struct scene *block = parsed("engine: tiny\nkind: block\n");
  uint8_t one[16], two[16];
  scene_identity(copy, 1, one);
  scene_identity(block, 1, two);
  assert_memory_equal(one, two, 16);
  assert_memory_equal(copy->inputs, block->inputs, sizeof(struct tiny));
  scene_free(block);
  scene_free(copy);
  copy = scene_copy(scene);
  OK(scene_set_text(copy, "ball.size", "4 cm", &error));
  OK(scene_set_text(copy, "kind", "block", &error));
  assert_int_equal(scene_check(copy, &error), STATUS_CONTENT); /* an override of an inactive input is an error */
  assert_string_equal(
      error.message,
      "ball.size: has no effect: it is used only when kind is ball; here it is block; remove one or change the other");
  scene_free(copy);
  scene_free(scene);
}

TEST(identity_is_pinned) {
  uint8_t one[16], two[16];
  SCENE scene = parsed("engine: tiny\nball: {size: 50 mm}\n");
  scene_identity(scene, 42, one);
  /* hashlib.blake2s(b"engine=tiny\nresults_version=3\nseed=42\nball.size=0x1.999999999999ap-5\nfidelity.count=5\n"
   *                 b"impact.speed=0x1.4p+3\nkind=ball\n", digest_size=16). Stored runs are found by this identity. */
  static const uint8_t expected[16] = {0x3a, 0x6a, 0xd2, 0xb2, 0xe5, 0x91, 0x51, 0x3c,
                                       0x14, 0x3e, 0xba, 0x1d, 0x74, 0xce, 0x39, 0x34};
  assert_memory_equal(one, expected, 16);
  scene_identity(scene, 43, two);
  assert_memory_not_equal(one, two, 16);
  scene->kind = &tiny_next;
  scene_identity(scene, 42, two);
  assert_memory_not_equal(one, two, 16);
  scene->kind = &tiny;
  SCENE same = parsed("name: other\nkind: ball\nengine: tiny\nfidelity: {count: 5.0}\nball: {size: 0.05 m}\n");
  scene_identity(same, 42, two);
  assert_memory_equal(one, two, 16); /* order, spelling, name and given defaults do not matter */
  ((struct tiny *)same->inputs)->size = nextafter(0.05, 1);
  scene_identity(same, 42, two);
  assert_memory_not_equal(one, two, 16);
  ((struct tiny *)same->inputs)->kind = 1;
  ((struct tiny *)scene->inputs)->kind = 1;
  scene_identity(scene, 42, one);
  scene_identity(same, 42, two);
  assert_memory_equal(one, two, 16); /* the size is inactive now */
}

TEST(hash_has_known_answers) {
  /* RFC 7693's algorithm at 16 bytes of digest; answers of Python's hashlib.blake2s(x, digest_size=16), an independent
   * implementation, for bytes 0, 1, 2, ... of these lengths: around the block size and through carries. */
  static const struct {
    size_t size;
    const char *digest;
  } cases[] = {{0, "64550d6ffe2c0a01a14aba1eade0200c"},   {1, "9f31f3ec588c6064a8e1f9051aeab90a"},
               {3, "c41561edb251df8f3c9523524d60a707"},   {63, "4006430a2d313751a9ece24fccb52de5"},
               {64, "dc66ca8f03865801b0ffe06ed8a1a90e"},  {65, "399d3e92ccfcedcdde9bf4c2be14cf8c"},
               {127, "5d3541be0ce9b6d8f9315862ac0198c5"}, {128, "7a3b3fa888b60095e7b305efcf3c3dbc"},
               {129, "dd6146fb0f48a29aa4c813fe75d15941"}, {255, "b504e782a6ba7a75eca305c265cf3633"},
               {256, "f34aabb6e38ab8c17272d90d82e9f56d"}, {1000, "0b94973a96dc199cfbc1ec1e06615c99"},
               {1024, "50dd8cb7e196b8030f7aaba8f6107aba"}};
  uint8_t bytes[1024], digest[16];
  char text[33];
  for (size_t i = 0; i < sizeof bytes; i++)
    bytes[i] = (uint8_t)i;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    blake2s(bytes, cases[i].size, digest);
    for (int k = 0; k < 16; k++)
      snprintf(text + 2 * k, 3, "%02x", digest[k]);
    assert_string_equal(text, cases[i].digest);
  }
}

TEST(files_and_names) {
  struct scene *scene = NULL;
  assert_int_equal(scene_load("no-such-scene", NULL, &scene, &error), STATUS_MISSING);
  assert_non_null(strstr(error.message, "there is no built-in scene 'no-such-scene'"));
  assert_int_equal(scene_load("no-such-scene.yaml", NULL, &scene, &error), STATUS_MISSING);
  assert_string_equal(error.message, "no-such-scene.yaml: there is no such file");
  assert_int_equal(scene_load("./no-such-scene", "here", &scene, &error), STATUS_MISSING);
  assert_string_equal(error.message, "here/no-such-scene: there is no such file");
  char path[] = "test_scene_XXXXXX.yaml";
  int file = mkstemps(path, 5);
  assert_true(file >= 0);
  assert_int_equal(write(file, "engine: tiny\n", 13), 13);
  close(file);
  OK(scene_load(path, ".", &scene, &error));
  assert_int_equal(strlen(scene->name), strlen(path) - 5); /* the file's own name, without its ending */
  scene_free(scene);
  OK(scene_load(path, NULL, &scene, &error));
  scene_free(scene);
  unlink(path);
  for (size_t i = 0; i < scene_builtin_count(); i++) {
    const char *text = scene_builtin_text(scene_builtin_name(i));
    assert_non_null(strstr(text, "engine:"));
    char near[100]; /* the error names the scene that was meant */
    snprintf(near, sizeof near, "%sx", scene_builtin_name(i));
    assert_int_equal(scene_load(near, NULL, &scene, &error), STATUS_MISSING);
    assert_non_null(strstr(error.message, scene_builtin_name(i)));
    if (i)
      assert_true(strcmp(scene_builtin_name(i - 1), scene_builtin_name(i)) < 0);
  }
  assert_null(scene_builtin_name(scene_builtin_count()));
}
