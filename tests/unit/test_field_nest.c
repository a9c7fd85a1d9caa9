/* Tables that contain tables: paths, places, conditions, defaults and order of the rows. */

#include "schemas/rows.h"
#include "tests/support/check.h"

/* Two bodies of one kind, each of a material; a module has inputs in two sections. */
struct rock {
  double strength, grain;
};
struct body {
  int shape;
  double radius;
  bool solid;
  struct rock rock;
};
struct module {
  int draw;
  double step;
};
struct scene {
  bool impact;
  struct body target, projectile;
  struct module module;
  int64_t threads;
};

static const char *const shapes[] = {"sphere", "box", NULL};
static const char *const draws[] = {"ranked", "random", NULL};

#define IN(type, member) .offset = offsetof(struct type, member)
static const struct field rock_rows[] = {
    REAL_OF(rock, strength, strength, "Pa", NAN, 0, 1e9, .flags = FIELD_REQUIRED, .when = "../solid=true",
            .doc = "Strength."),
    REAL_OF(rock, grain, grain, "m", 0.5, 0, 1, .doc = "Grain."),
};
static const struct field_table rocks = FIELD_TABLE(rock_rows, struct rock, "rock", "A rock.");

static const struct field body_rows[] = {
    ROW_OF(body, shape, shape, FIELD_CHOICE, NULL, .choices = shapes, .doc = "Outline."),
    REAL_OF(body, radius, radius, "m", 3, 0, 9, .when = "shape=sphere", .doc = "Radius."),
    ROW_OF(body, solid, solid, FIELD_BOOLEAN, NULL, .number = 1, .maximum = 1, .doc = "Solid."),
    {.path = "rock", IN(body, rock), .nest = &rocks, .flags = FIELD_DERIVED, .doc = "The named rock's unless given."},
};
static const struct field_table bodies = FIELD_TABLE(body_rows, struct body, "body", "A body.");

static const struct field module_rows[] = {
    REAL_OF(module, speed.step, step, "1", 0.1, 0, 1, .when = "/target.solid=true", .doc = "Step."),
    ROW_OF(module, flaws.draw, draw, FIELD_CHOICE, NULL, .number = 1, .choices = draws, .doc = "Draw."),
};
static const struct field_table modules = FIELD_TABLE(module_rows, struct module, "module", "A module.");

static const struct field scene_rows[] = {
    ROW_OF(scene, impact, impact, FIELD_BOOLEAN, NULL, .number = 1, .maximum = 1, .doc = "Impact."),
    {.path = "target", IN(scene, target), .nest = &bodies},
    {.path = "projectile",
     IN(scene, projectile),
     .nest = &bodies,
     .when = "impact=true",
     .own = (const struct field[]){{.path = "radius", .number = 0.25},
                                   {.path = "rock.grain", .number = 0.125, .doc = "Grain of the projectile."},
                                   {.path = "shape", .number = 1, .when = "target.solid=true"},
                                   {0}}},
    {IN(scene, module), .nest = &modules, .only = "!speed"},
    ROW_OF(scene, speed.threads, threads, FIELD_INTEGER, "1", .number = 1, .minimum = 1, .maximum = 64,
           .doc = "Threads."),
    {IN(scene, module), .nest = &modules, .only = "speed"},
};
static const struct field_table nested = FIELD_TABLE(scene_rows, struct scene, "scene", "Two bodies.");

static struct field_table scene;
FIELD_TABLE_AT_START(scene, nested)
static struct field_table alone;
FIELD_TABLE_AT_START(alone, rocks)

static const struct field *row(const char *path) {
  for (size_t i = 0; i < scene.count; i++)
    if (strcmp(scene.rows[i].path, path) == 0)
      return &scene.rows[i];
  fail_msg("no row %s", path);
  return NULL;
}

TEST(rows_stand_in_order_at_their_places) {
  static const struct {
    const char *path;
    size_t offset;
  } expected[] = {
      {"impact", offsetof(struct scene, impact)},
      {"target.shape", offsetof(struct scene, target.shape)},
      {"target.radius", offsetof(struct scene, target.radius)},
      {"target.solid", offsetof(struct scene, target.solid)},
      {"target.rock.strength", offsetof(struct scene, target.rock.strength)},
      {"target.rock.grain", offsetof(struct scene, target.rock.grain)},
      {"projectile.shape", offsetof(struct scene, projectile.shape)},
      {"projectile.radius", offsetof(struct scene, projectile.radius)},
      {"projectile.solid", offsetof(struct scene, projectile.solid)},
      {"projectile.rock.strength", offsetof(struct scene, projectile.rock.strength)},
      {"projectile.rock.grain", offsetof(struct scene, projectile.rock.grain)},
      {"flaws.draw", offsetof(struct scene, module.draw)},
      {"speed.threads", offsetof(struct scene, threads)},
      {"speed.step", offsetof(struct scene, module.step)},
  };
  assert_int_equal(scene.count, sizeof expected / sizeof *expected);
  assert_int_equal(scene.size, sizeof(struct scene));
  assert_string_equal(scene.name, "scene");
  for (size_t i = 0; i < scene.count; i++) {
    assert_string_equal(scene.rows[i].path, expected[i].path);
    assert_int_equal(scene.rows[i].offset, expected[i].offset);
    assert_null(scene.rows[i].nest);
  }
}

TEST(conditions_are_relative_to_the_table_of_their_row) {
  assert_string_equal(row("target.radius")->when, "target.shape=sphere");
  assert_string_equal(row("target.rock.strength")->when, "target.solid=true"); /* ../ */
  assert_string_equal(row("speed.step")->when, "target.solid=true");           /* from the root */
  assert_null(row("target.rock.grain")->when);
  assert_string_equal(row("projectile.radius")->when, "projectile.shape=sphere");
  assert_string_equal(row("projectile.solid")->when, "impact=true"); /* the nest's, also of tables in the table: */
  assert_string_equal(row("projectile.rock.grain")->when, "impact=true");
  assert_string_equal(row("projectile.shape")->when, "target.solid=true"); /* of the nest's own row */

  assert_null(alone.rows[0].when); /* it is about a body, and there is none */

  struct scene object;
  field_defaults(&scene, &object);
  assert_true(field_is_active(&scene, row("target.rock.strength"), &object));
  object.target.solid = false;
  assert_false(field_is_active(&scene, row("target.rock.strength"), &object));
  assert_false(field_is_active(&scene, row("projectile.shape"), &object));
}

TEST(a_nest_changes_its_rows) {
  struct scene object;
  memset(&object, 0, sizeof object);
  field_defaults(&scene, &object);
  assert_true(object.target.radius == 3 && object.projectile.radius == 0.25);
  assert_true(object.target.rock.grain == 0.5 && object.projectile.rock.grain == 0.125);
  assert_true(object.target.shape == 0 && object.projectile.shape == 1 && object.module.draw == 1);
  assert_string_equal(row("projectile.radius")->doc, "Radius.");
  assert_string_equal(row("target.rock.grain")->doc, "Grain. The named rock's unless given.");
  assert_string_equal(row("projectile.rock.grain")->doc, "Grain of the projectile. The named rock's unless given.");
  assert_int_equal(row("target.rock.strength")->flags, FIELD_DERIVED); /* no longer required */
  assert_int_equal(row("target.radius")->flags, 0);
}
