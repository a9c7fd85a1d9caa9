/* Every scene that ships, at its smallest size, and every choice and switch of its inputs: a few steps are computed,
 * reported and freed. No number is judged: under the sanitizers this walks all modules of both engines, in the place of
 * the long pages of verification and validation. */
#include "tests/support/run_case.h"

#include "engine/sph/run/run.h"

/* What makes the scene small, and numbers that turn modules on. */
static const struct {
  const char *scene, *sets[8];
} smallest[] = {
    {"block-impact", {"body.columns=8", "body.rows=5"}},
    {"compression", {"body.columns=5", "body.rows=8"}},
    {"disc-collision", {"body.diameter=6 cm"}},
    {"disc-explosion", {"body.diameter=6 cm"}},
    {"uniaxial", {"body.columns=5", "body.rows=8"}},
    {"basalt-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4"}},
    {"basalt-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4", "fracture.cell=8 mm"}},
    {"colliding-cylinders", {"fidelity.particles=100"}},
    {"disruption", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4"}},
    {"elastic-bar", {"fidelity.particles=150"}},
    {"gabbro-crater",
     {"fidelity.particles=700", "fidelity.fine_spacing=15 mm", "fidelity.fine_radius=10 mm",
      "fidelity.projectile_spacing=0.1"}},
    {"porous-ice", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {"porous-plate", {"fidelity.points=30"}},
    {"porous-target", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {"pumice-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {"solid-ice", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {"tensile-rod", {"fidelity.particles=400", "stretch.grip=4 mm", "stretch.flaw_free=8 mm"}},
};
enum { SMALLEST = sizeof smallest / sizeof *smallest };

static uint64_t walked; /* modules of engine sph that were on in a run */

static bool runs(const struct scene *scene, uint64_t steps, const char *snapshot, struct error *error) {
  union {
    struct dem_results dem;
    struct sph_results sph;
  } results;
  struct outcome outcome;
  struct fragment *fragments = NULL;
  size_t count = 0;
  void *run = NULL;
  bool finished = false;
  if (scene->kind->prepare(scene->inputs, 1, &run, error) != STATUS_OK)
    return false;
  if (scene->kind == &sph_engine)
    for (size_t b = 0; b < ((struct sph_run *)run)->system->body_count; b++)
      walked |= ((struct sph_run *)run)->system->solid[b].modules.word[0];
  assert_int_equal(scene->kind->step(run, steps, &finished, error), STATUS_OK);
  if (snapshot)
    assert_int_equal(scene->kind->write_snapshot(run, snapshot, error), STATUS_OK);
  assert_int_equal(scene->kind->finish(run, &outcome, &results, &fragments, &count, error), STATUS_OK);
  free(fragments);
  scene->kind->free(run);
  return true;
}

static struct scene *small_scene(size_t k) {
  struct scene *scene = NULL;
  struct error error = {0};
  if (scene_load(smallest[k].scene, NULL, &scene, &error))
    fail_msg("%s: %s", smallest[k].scene, error.message);
  for (const char *const *set = smallest[k].sets; *set; set++) {
    char path[100];
    snprintf(path, sizeof path, "%.*s", (int)strcspn(*set, "="), *set);
    if (scene_set_text(scene, path, strchr(*set, '=') + 1, &error))
      fail_msg("%s: %s: %s", smallest[k].scene, *set, error.message);
  }
  return scene;
}

static void every_scene_runs(void **state) {
  (void)state;
  for (size_t k = 0; k < scene_builtin_count(); k++) {
    size_t at = 0;
    while (at < SMALLEST && strcmp(smallest[at].scene, scene_builtin_name(k)) != 0)
      at++;
    if (at == SMALLEST)
      fail_msg("give %s a smallest size", scene_builtin_name(k));
  }
  for (size_t k = 0; k < SMALLEST; k++) {
    struct scene *scene = small_scene(k);
    struct error error = {0};
    if (scene_check(scene, &error))
      fail_msg("%s: %s", smallest[k].scene, error.message);
    if (!runs(scene, 60, "smallest.h5", &error))
      fail_msg("%s: %s", smallest[k].scene, error.message);
    scene_free(scene);
  }
  remove("smallest.h5");
}

static bool chosen(const struct scene *scene, const char *path, const char *text) {
  struct scene *other = scene_copy(scene);
  struct error error = {0};
  bool ran = scene_set_text(other, path, text, NULL) == STATUS_OK && scene_check(other, NULL) == STATUS_OK &&
             runs(other, 5, NULL, &error);
  scene_free(other);
  return ran;
}

/* Choices that a scene refuses, or that have no effect in it, are left out. */
static void every_choice_runs(void **state) {
  (void)state;
  static const char *const switched[] = {"false", "true", NULL};
  size_t ran = 0;
  for (size_t k = 0; k < SMALLEST; k++) {
    struct scene *scene = small_scene(k);
    for (size_t i = 0; i < scene->kind->inputs->count; i++) {
      const struct field *row = &scene->kind->inputs->rows[i];
      const char *const *choices = row->kind == FIELD_CHOICE    ? row->choices
                                   : row->kind == FIELD_BOOLEAN ? switched
                                                                : NULL;
      for (; choices && *choices; choices++)
        ran += chosen(scene, row->path, *choices);
    }
    scene_free(scene);
  }
  print_message("%zu choices of %d scenes\n", ran, SMALLEST);
  assert_true(ran > 500);
  for (size_t m = 0; m < SPH_MODULES; m++)
    if (!(walked >> m & 1))
      fail_msg("module %s was never on", sph_modules_at(m)->name);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_scene_runs), cmocka_unit_test(every_choice_runs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
