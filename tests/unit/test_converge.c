/* Knobs name inputs that exist, ladders are ordered and have their reference, and findings are kept in the store. */

#include <sqlite3.h>

#include "campaign/converge/ladder.h"
#include "campaign/converge/study.h"
#include "db/ask/ask.h"
#include "engine/dem/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/scene/inputs.h"
#include "tests/support/check.h"
#include "tests/support/store_fixture.h"

static struct scene *scene_of(const char *name) {
  struct scene *scene = NULL;
  OK(scene_load(name, NULL, &scene, &error));
  return scene;
}

static const struct knob *knob_of(const char *engine, const char *name) {
  const struct knob *knob = engine_knob(engine_find(engine, &error), name, &error);
  assert_non_null(knob);
  return knob;
}

TEST(every_knob_names_inputs_of_its_engine) {
  size_t count = 0;
  for (size_t i = 0; i < engine_count(); i++) {
    const struct engine_kind *kind = engine_at(i);
    for (const struct knob *knob = kind->knobs; knob && knob->name; knob++) {
      count++;
      for (size_t j = 0; j < KNOB_INPUTS && knob->inputs[j].path; j++) {
        const struct field *row = field_find(kind->inputs, knob->inputs[j].path, &error);
        if (!row || strcmp(row->path, knob->inputs[j].path) != 0)
          fail_msg("knob %s of %s: no input %s", knob->name, kind->name, knob->inputs[j].path);
        struct field_value value;
        for (size_t c = 0; j == 0 && c < KNOB_LEVELS && knob->choices[c]; c++)
          if (field_parse(row, knob->choices[c], &value, &error) != STATUS_OK)
            fail_msg("knob %s of %s: %s", knob->name, kind->name, error.message);
      }
      assert_int_equal((knob->factors[0] > 0) + (knob->choices[0] != NULL), knob->group != KNOB_SETTINGS);
      assert_ptr_equal(engine_knob(kind, knob->name, &error), knob); /* a name is one knob of an engine */
    }
  }
  assert_true(count > 15);
}

/* Every knob of every built-in scene either has a ladder with one reference, decreasing steps and different levels, or
 * states why it has none. */
TEST(ladders_of_all_scenes) {
  size_t made = 0, refused = 0;
  for (size_t s = 0; s < scene_builtin_count(); s++) {
    SCENE scene = scene_of(scene_builtin_name(s));
    for (const struct knob *knob = scene->kind->knobs; knob && knob->name; knob++) {
      struct ladder ladder;
      OWNED char *notes = NULL;
      error = (struct error){0};
      status code = ladder_make(knob, scene, NULL, &ladder, &notes, &error);
      if (code != STATUS_OK) {
        assert_int_equal(code, STATUS_CONTENT);
        assert_true(strlen(error.message) > 10);
        refused++;
        continue;
      }
      size_t references = 0, bases = 0;
      for (size_t l = 0; l < ladder.count; l++) {
        uint8_t one[16], other[16];
        references += ladder.level[l].reference;
        bases += ladder.level[l].base;
        if (l == 0)
          continue;
        scene_identity(ladder.level[l - 1].scene, 1, one);
        scene_identity(ladder.level[l].scene, 1, other);
        assert_true(memcmp(one, other, 16) != 0);
        if (!isnan(ladder.level[l].step))
          assert_true(ladder.level[l].step < ladder.level[l - 1].step);
      }
      assert_int_equal(references, 1);
      assert_int_equal(bases, 1);
      if (knob->group != KNOB_MODEL)
        assert_true(ladder.level[ladder.count - 1].reference);
      made++;
      ladder_clear(&ladder);
    }
  }
  assert_true(made > 50 && refused > 10);
}

static bool is_near(double value, double expected) {
  return fabs(value / expected - 1) < 1e-14;
}

/* A graded body is fine at the point of impact. With more particles all of its spacings get smaller by one factor, so
 * that one law describes the ladder. With the zone alone, the rest gets coarser. The zone keeps its size. */
TEST(graded_bodies_keep_their_zone) {
  SCENE scene = scene_of("solid-ice");
  const struct sph_inputs *own = scene->inputs;
  struct ladder ladder;
  char *notes = NULL;
  OK(ladder_make(knob_of("sph", "particles"), scene, "4000,12000,96000", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 2); /* 4000 are too few for 3.47 spacings in the radius */
  assert_non_null(strstr(notes, "fidelity.particles = 4000 is left out: fidelity.coarsest 4 allows the 3.47 of "));
  for (size_t l = 0; l < 2; l++) {
    const struct sph_inputs *in = ladder.level[l].scene->inputs;
    assert_true(is_near(in->fidelity.fine_spacing, own->fidelity.fine_spacing / (l == 0 ? 1 : 2)));
    assert_true(is_near(in->fidelity.fine_radius, own->fidelity.fine_radius));
  }
  const double far[] = {sph_derived_coarsest_spacing(ladder.level[0].scene->inputs),
                        sph_derived_coarsest_spacing(ladder.level[1].scene->inputs)};
  assert_true(far[0] > 1.9 * far[1] && far[0] < 2.1 * far[1]);
  ladder_clear(&ladder);
  free(notes);

  OK(ladder_make(knob_of("sph", "impact_zone"), scene, "2.5,5,10", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 2);
  assert_non_null(
      strstr(notes, "fidelity.spacings_per_radius = 10 is left out: fidelity.coarsest 4 allows the 10 of "));
  for (size_t l = 0; l < 2; l++) {
    const struct sph_inputs *in = ladder.level[l].scene->inputs;
    assert_true(is_near(in->fidelity.fine_spacing, own->fidelity.fine_spacing * (l == 0 ? 2 : 1)));
    assert_true(is_near(in->fidelity.fine_radius, own->fidelity.fine_radius));
    assert_int_equal(in->fidelity.particles, own->fidelity.particles);
  }
  ladder_clear(&ladder);
  free(notes);

  /* Where the scene gives the spacing of the zone itself, it follows the number of particles. */
  OK(scene_set_text(scene, "fidelity.spacings_per_radius", "off", &error));
  OK(scene_set_text(scene, "fidelity.fine_spacing", "1 mm", &error));
  OK(ladder_make(knob_of("sph", "particles"), scene, "12000,96000", &ladder, &notes, &error));
  const struct sph_inputs *finer = ladder.level[1].scene->inputs;
  assert_true(is_near(finer->fidelity.fine_spacing, 0.5e-3));
  assert_true(is_near(finer->fidelity.fine_radius, 4e-3));
  ladder_clear(&ladder);
  free(notes);
  assert_int_equal(ladder_make(knob_of("sph", "impact_zone"), scene, NULL, &ladder, &notes, &error), STATUS_CONTENT);
  free(notes);
}

/* Finer grains of a block are more grains: its sides stay, to half a grain. */
TEST(blocks_keep_their_sides) {
  static const char *const names[] = {"uniaxial", "compression", "block-impact"};
  for (size_t s = 0; s < sizeof names / sizeof *names; s++) {
    SCENE scene = scene_of(names[s]);
    const struct dem_inputs *own = scene->inputs;
    OWNED_BY(ladder_clear) struct ladder ladder;
    OWNED char *notes = NULL;
    OK(ladder_make(knob_of("dem", "grains"), scene, NULL, &ladder, &notes, &error));
    assert_int_equal(ladder.count, 4);
    for (size_t l = 0; l < ladder.count; l++) {
      const struct dem_inputs *in = ladder.level[l].scene->inputs;
      const double spacing = in->grain.spacing;
      assert_true(fabs((double)in->body.columns * spacing - (double)own->body.columns * own->grain.spacing) <=
                  0.51 * spacing);
      assert_true(fabs((double)in->body.rows * spacing - (double)own->body.rows * own->grain.spacing) <=
                  0.51 * spacing);
    }
    assert_int_equal(((const struct dem_inputs *)ladder.level[0].scene->inputs)->body.columns,
                     (own->body.columns + 1) / 2);
  }
}

TEST(levels_of_ones_own) {
  SCENE scene = scene_of("basalt-sphere");
  struct ladder ladder;
  char *notes = NULL;
  OK(ladder_make(knob_of("sph", "particles"), scene, "3000,1000,93000", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 3);
  assert_string_equal(ladder.level[0].setting, "1000");
  assert_true(ladder.level[2].base && ladder.level[2].reference);
  assert_true(fabs(ladder.level[0].step - 0.1) < 1e-12);
  OK(ladder_add_own(&ladder, scene, &error));
  assert_true(ladder.count == 3 && !ladder.level[2].unasked);
  ladder_clear(&ladder);
  free(notes);

  /* A study adds the scene's own level, though not to run: its error is wanted. Not so of a model. */
  OK(ladder_make(knob_of("sph", "particles"), scene, "1000,3000", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 2);
  OK(ladder_add_own(&ladder, scene, &error));
  assert_true(ladder.count == 3 && ladder.level[2].base && ladder.level[2].unasked);
  assert_true(ladder.level[1].reference && !ladder.level[2].reference && !ladder.level[0].unasked);
  ladder_clear(&ladder);
  free(notes);
  OK(ladder_make(knob_of("sph", "smoothing"), scene, "1,2", &ladder, &notes, &error));
  OK(ladder_add_own(&ladder, scene, &error));
  assert_int_equal(ladder.count, 2);
  ladder_clear(&ladder);
  free(notes);

  /* Inputs that belong to a knob move together: halving the time step halves its other limits. */
  OK(ladder_make(knob_of("sph", "time_step"), scene, NULL, &ladder, &notes, &error));
  struct field_value own, finest;
  const struct field *row = field_find(scene->kind->inputs, "fidelity.damage_step", &error);
  field_get(row, scene->inputs, &own);
  field_get(row, ladder.level[ladder.count - 1].scene->inputs, &finest);
  assert_true(fabs(finest.number / own.number - 0.125) < 1e-3);
  ladder_clear(&ladder);
  free(notes);

  const char *const wrong[] = {"1000", "1000,many", "1000,-3", ""};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    error = (struct error){0};
    assert_true(ladder_make(knob_of("sph", "particles"), scene, wrong[i], &ladder, &notes, &error) != STATUS_OK);
    assert_int_equal(ladder.count, 0);
    free(notes);
  }
  assert_null(engine_knob(engine_find("dem", &error), "particles", &error));
  assert_non_null(strstr(error.message, "grains"));
}

/* Named settings are levels by their work; the others are compared with the one called reference. */
TEST(named_settings_are_levels) {
  char text[8192];
  SCENE scene = NULL;
  const char *builtin = scene_builtin_text("disc-explosion"), *own = strstr(builtin, "\nsettings:");
  assert_non_null(own); /* replaced by those of this test */
  snprintf(text, sizeof text,
           "%.*s\nsettings:\n  reference: {grain.spacing: 8 mm}\n  finest: {grain.spacing: 6 mm}\n"
           "  draft: {grain.spacing: 15 mm, fidelity.time_step: 2 us}\n",
           (int)(own - builtin), builtin);
  OK(scene_parse("disc", text, &scene, &error));
  const struct knob *knob = knob_of("dem", "settings");
  struct ladder ladder;
  char *notes = NULL;
  OK(ladder_make(knob, scene, NULL, &ladder, &notes, &error));
  static const char *const order[] = {"draft", "standard", "finest", "reference"};
  assert_int_equal(ladder.count, 4);
  for (size_t l = 0; l < 4; l++) {
    assert_string_equal(ladder.level[l].setting, order[l]);
    assert_int_equal(ladder.level[l].base, l == 1);
    assert_int_equal(ladder.level[l].reference, l == 3);
  }
  char spacing[64];
  ladder_setting(knob_of("dem", "grains"), ladder.level[3].scene, spacing, sizeof spacing);
  assert_string_equal(spacing, "0.008");
  assert_string_equal(notes, "");
  ladder_clear(&ladder);
  free(notes);
  OK(ladder_make(knob, scene, "finest,standard", &ladder, &notes, &error));
  assert_string_equal(notes, "settings finest take the most work here: the others are compared with them (ref)\n");
  ladder_clear(&ladder);
  free(notes);
  OK(ladder_make(knob, scene, "draft,standard", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 2);
  ladder_clear(&ladder);
  free(notes);
  OK(ladder_turn(knob, scene, "draft", &error));
  ladder_setting(knob_of("dem", "time_step"), scene, spacing, sizeof spacing);
  assert_string_equal(spacing, "2e-6");
  assert_int_equal(ladder_turn(knob, scene, "coarse", &error), STATUS_MISSING);
}

/* The choices of other codes are another model, and no error of the resolution: levels only if the user names them. */
TEST(settings_of_another_model_are_no_levels) {
  SCENE scene = scene_of("basalt-sphere");
  const struct knob *knob = knob_of("sph", "settings");
  struct ladder ladder;
  char *notes = NULL;
  OK(ladder_make(knob, scene, NULL, &ladder, &notes, &error));
  assert_int_equal(ladder.count, 3);
  for (size_t l = 0; l < 3; l++)
    assert_string_equal(ladder.level[l].setting, ((const char *[]){"draft", "standard", "reference"})[l]);
  assert_non_null(strstr(notes, "settings opensph are left out: another model"));
  assert_non_null(strstr(notes, "settings miluphcuda are left out"));
  assert_non_null(strstr(notes, "settings spheral are left out"));
  ladder_clear(&ladder);
  free(notes);
  OK(ladder_make(knob, scene, "opensph,standard", &ladder, &notes, &error));
  assert_int_equal(ladder.count, 2);
  ladder_clear(&ladder);
  free(notes);
}

static double number(struct store *store, const char *sql) {
  double number = NAN;
  assert_int_equal(answer_number(store, &number, &error, "%s", sql), STATUS_OK);
  return number;
}

static int integer(struct store *store, const char *sql) {
  return (int)number(store, sql);
}

TEST(findings_replace_earlier_ones) {
  char path[64];
  struct store *store = NULL;
  SCENE scene = scene_of("disc-explosion");
  OK(store_open_writer(fixture_path(path, "converge"), &store, NULL, 0, &error));
  int64_t point = 0;
  OK(store_add_point(store, 0, scene, 0, NULL, &point, &error));
  struct convergence_row rows[2];
  for (size_t i = 0; i < 2; i++) {
    field_defaults(&convergence_table, &rows[i]);
    strcpy(rows[i].knob, "time_step");
    strcpy(rows[i].quantity, "largest_fraction");
    snprintf(rows[i].setting, sizeof rows[i].setting, "%zu", i);
  }
  struct convergence_limit_row limit;
  field_defaults(&convergence_limit_table, &limit);
  strcpy(limit.knob, "time_step");
  strcpy(limit.quantity, "largest_fraction");
  limit.verdict = LIMIT_NOT_SEEN;
  const int64_t points[2] = {point, point};
  struct store_convergence study = {point, 3, 2, points, rows, &limit};
  OK(store_set_convergence(store, &study, &error));
  OK(store_set_convergence(store, &study, &error));
  assert_int_equal(integer(store, "SELECT count(*) FROM convergence"), 2);
  assert_int_equal(integer(store, "SELECT count(*) FROM convergence_limit WHERE verdict = 'no-limit'"), 1);
  study.count = 1;
  OK(store_set_convergence(store, &study, &error));
  assert_int_equal(integer(store, "SELECT count(*) FROM convergence"), 1);
  strcpy(rows[0].quantity, "dust_fraction"); /* another quantity is kept beside it */
  strcpy(limit.quantity, "dust_fraction");
  OK(store_set_convergence(store, &study, &error));
  assert_int_equal(integer(store, "SELECT count(*) FROM convergence"), 2);
  OK(store_close(store, &error));

  /* A store of an earlier program has no such tables: they are made when it is opened for writing. */
  sqlite3 *db = NULL;
  assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
  assert_int_equal(sqlite3_exec(db, "DROP TABLE convergence; DROP TABLE convergence_limit", NULL, NULL, NULL),
                   SQLITE_OK);
  sqlite3_close(db);
  OK(store_open_writer(path, &store, NULL, 0, &error));
  OK(store_set_convergence(store, &study, &error));
  assert_int_equal(integer(store, "SELECT count(*) FROM convergence"), 1);
  OK(store_close(store, &error));
}

/* Adds a level of a knob, which is the scene studied (`base` 0) or another point. */
static void add_level(struct store *store, int64_t base, int64_t point, const char *knob,
                      const struct convergence_row *level, enum limit_verdict verdict) {
  struct convergence_row row = *level;
  struct convergence_limit_row limit;
  field_defaults(&convergence_limit_table, &limit);
  snprintf(row.knob, sizeof row.knob, "%s", knob);
  snprintf(limit.knob, sizeof limit.knob, "%s", knob);
  strcpy(row.quantity, "largest_fraction");
  strcpy(limit.quantity, "largest_fraction");
  row.base = base == 0;
  limit.verdict = verdict;
  const struct store_convergence study = {base ? base : point, fixture_kind.results_version, 1, &point, &row, &limit};
  OK(store_set_convergence(store, &study, &error));
}

/* The same by its remaining error. */
static void level_of(struct store *store, int64_t base, int64_t point, const char *knob, double resolution, bool open,
                     enum limit_verdict verdict) {
  struct convergence_row row;
  field_defaults(&convergence_table, &row);
  row.resolution = resolution;
  row.open = open;
  add_level(store, base, point, knob, &row, verdict);
}

static void studied(struct store *store, int64_t point, const char *knob, double resolution, bool open,
                    enum limit_verdict verdict) {
  level_of(store, 0, point, knob, resolution, open, verdict);
}

TEST(a_point_has_the_errors_of_its_knobs) {
  char path[64];
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "resolution"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 1, 3, false, &error));
  const int64_t point = integer(store, "SELECT min(point_id) FROM run");
  struct ask_resolution found;
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_NOT_STUDIED);
  studied(store, point, "time_step", 0.01, false, LIMIT_SEEN);
  studied(store, point, "grains", 0.05, false, LIMIT_SEEN);
  studied(store, point, "contact_law", NAN, false, LIMIT_TOO_FEW);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_KNOWN);
  assert_true(fabs(found.half_width - 0.06) < 1e-12);
  assert_string_equal(found.knobs, "grains, time_step"); /* not "contact law": it has no error here */
  OK(ask_resolution(store, 0, "largest_fraction", &found, &error));
  assert_true(fabs(found.half_width - 0.06) < 1e-12 && found.points == 2 && found.studied == 1);
  assert_true(fabs(number(store, "SELECT largest_fraction_resolution FROM points WHERE point_id = 1") - 0.06) < 1e-12);
  assert_int_equal(integer(store, "SELECT count(*) FROM points WHERE largest_fraction_resolution_verdict = "
                                  "'not-studied'"),
                   1);
  studied(store, point, "grains", 0.05, true, LIMIT_TOO_FEW);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_AT_LEAST);
  studied(store, point, "grains", 0.05, true, LIMIT_NOT_SEEN);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_DIVERGES);
  /* Settings whose runs are all equal add nothing. When no setting moved a run, nothing else is told. */
  studied(store, point, "grains", 0.05, false, LIMIT_SEEN);
  studied(store, point, "time_step", 0, true, LIMIT_CONSTANT);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_true(found.verdict == ASK_RESOLUTION_AT_LEAST && found.half_width == 0.05);
  studied(store, point, "grains", 0, true, LIMIT_CONSTANT);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_true(found.verdict == ASK_RESOLUTION_NO_DIFFERENCE && found.half_width == 0);
  OK(ask_resolution(store, point, "dust_fraction", &found, &error));
  assert_int_equal(found.verdict, ASK_RESOLUTION_NOT_STUDIED);
  OK(store_close(store, &error));
}

/* A level of one knob has the errors that the other knobs leave at the scene's own setting. */
TEST(a_level_has_the_errors_of_the_other_knobs) {
  char path[64];
  struct store *store = NULL;
  struct ask_resolution found;
  OK(store_open_writer(fixture_path(path, "level"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 1, 3, false, &error));
  const int64_t point = integer(store, "SELECT min(point_id) FROM run"), finer = point + 1;
  studied(store, point, "grains", 0.05, false, LIMIT_SEEN);
  level_of(store, point, finer, "time_step", 0.01, false, LIMIT_SEEN); /* the scene's own step was not run */
  OK(ask_resolution(store, finer, "largest_fraction", &found, &error));
  assert_true(found.verdict == ASK_RESOLUTION_KNOWN && fabs(found.half_width - 0.06) < 1e-12);
  /* Its own error is not known, and not told as smaller than that of the level. */
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  assert_true(found.verdict == ASK_RESOLUTION_AT_LEAST && fabs(found.half_width - 0.06) < 1e-12);
  /* The levels have the same error, as studies of other knobs change it later, too. */
  studied(store, point, "grains", 0.08, false, LIMIT_SEEN);
  ANSWER levels = ask_convergence_levels(store, point, fixture_kind.results_version, "largest_fraction", true, &error);
  struct convergence_row row;
  assert_true(ask_convergence_next(&levels, &row));
  assert_true(row.base && row.at_least && fabs(row.error - 0.09) < 1e-12);
  assert_true(ask_convergence_next(&levels, &row));
  assert_true(!row.base && !row.at_least && fabs(row.error - 0.09) < 1e-12);
  assert_false(ask_convergence_next(&levels, &row));
  assert_int_equal(answer_end(&levels), STATUS_OK);
  /* No error of a share is larger than its distance from the farther end, by the mean of the runs beside it. */
  studied(store, point, "grains", 3, true, LIMIT_NOT_SEEN);
  OK(ask_resolution(store, finer, "largest_fraction", &found, &error));
  const double mean = number(store, "SELECT largest_fraction_mean FROM points WHERE point_id = 2");
  assert_true(finer == 2 && mean > 0 && mean < 1);
  assert_true(found.verdict == ASK_RESOLUTION_KNOWN && fabs(found.half_width - fmax(mean, 1 - mean)) < 1e-12);
  OK(store_close(store, &error));
}

/* A setting has one error, also where its studies have means of their own: no error of a share is larger than its mean,
 * or 1 less its mean if that is more, by all runs. */
TEST(a_setting_has_one_bound) {
  char path[64];
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "bound"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 1, 3, false, &error));
  const int64_t point = integer(store, "SELECT min(point_id) FROM run");
  struct convergence_row row;
  struct ask_resolution found;
  field_defaults(&convergence_table, &row);
  for (size_t i = 0; i < 3; i++) {
    row.n = (const int64_t[]){4, 8, 3}[i];
    row.mean = (const double[]){0.75, 0.7, 0.4}[i];
    row.resolution = 0.5;
    add_level(store, 0, point, (const char *const[]){"grains", "stop", "time_step"}[i], &row, LIMIT_SEEN);
  }
  OK(store_rank_convergence(store, &error));
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  const double mean = number(store, "SELECT largest_fraction_mean FROM points WHERE point_id = 1");
  assert_true(fabs(found.half_width - fmax(mean, 1 - mean)) < 1e-12);
  ANSWER levels = ask_convergence_levels(store, point, fixture_kind.results_version, "largest_fraction", true, &error);
  for (size_t i = 0; i < 3; i++) {
    assert_true(ask_convergence_next(&levels, &row));
    assert_true(!row.at_least && row.error == found.half_width);
  }
  assert_int_equal(answer_end(&levels), STATUS_OK);
  assert_true(number(store, "SELECT min(error) FROM convergence") == found.half_width);
  assert_true(number(store, "SELECT max(error) FROM convergence") == found.half_width);
  OK(store_close(store, &error));
}

/* The error of a knob that has two studies: of the scene itself, 0.05 with a step of 1 and 8 seeds, and of the scene
 * with another time step, which leaves 0.01. */
static double error_of_two(struct store *store, int64_t point, double resolution, double step, int64_t seeds) {
  struct convergence_row row;
  struct ask_resolution found;
  field_defaults(&convergence_table, &row);
  row.resolution = 0.05, row.step = 1, row.n = 8;
  add_level(store, 0, point, "grains", &row, LIMIT_SEEN);
  row.resolution = resolution, row.step = step, row.n = seeds;
  add_level(store, 0, point + 1, "grains", &row, LIMIT_SEEN);
  level_of(store, point + 1, point, "time_step", 0.01, false, LIMIT_SEEN);
  OK(ask_resolution(store, point, "largest_fraction", &found, &error));
  return found.half_width - 0.01;
}

/* A finer study tells more than the one before it, also if that had a larger error; one as fine only with more seeds.
 */
TEST(a_finer_study_replaces_a_coarser_one) {
  char path[64];
  struct store *store = NULL;
  OK(store_open_writer(fixture_path(path, "finer"), &store, NULL, 0, &error));
  OK(fixture_populate(store, 2, 1, 3, false, &error));
  const int64_t point = integer(store, "SELECT min(point_id) FROM run");
  assert_true(fabs(error_of_two(store, point, 0.02, 0.5, 8) - 0.02) < 1e-12);
  assert_true(fabs(error_of_two(store, point, 0.07, 0.5, 8) - 0.07) < 1e-12);
  assert_true(fabs(error_of_two(store, point, 0.02, 1, 16) - 0.02) < 1e-12);
  assert_true(fabs(error_of_two(store, point, 0.02, 1, 8) - 0.05) < 1e-12);
  assert_true(fabs(error_of_two(store, point, 0.07, 1, 8) - 0.07) < 1e-12);
  assert_true(fabs(error_of_two(store, point, 0.07, 2, 32) - 0.05) < 1e-12); /* coarser */
  OK(store_close(store, &error));
}

/* The reference if it was run, else the finest level that was. */
TEST(reference_of_a_ladder) {
  static struct study_ladder ladder;
  ladder = (struct study_ladder){.levels.count = 4};
  ladder.levels.level[2].reference = true;
  assert_int_equal(study_reference(&ladder), 2);
  ladder.left_out[2] = true;
  assert_int_equal(study_reference(&ladder), 3);
  ladder.left_out[3] = true;
  assert_int_equal(study_reference(&ladder), 1);
  ladder.left_out[0] = ladder.left_out[1] = true;
  assert_int_equal(study_reference(&ladder), 0);
}
