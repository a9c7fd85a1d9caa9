/* Every scene that ships, at its smallest size, and every choice and switch of its inputs: a few steps are computed,
 * reported and freed. Under the sanitizers this walks all modules of both engines, in the place of the long pages of
 * verification and validation.
 *
 * Nothing is judged by its size, but everything by its bits: choices.txt beside this file pins a hash of all that the
 * runs of a scene and a section of its inputs give, and another of what the program says of them, beforehand and in the
 * result `warnings`. Under the sanitizers scenes are left out whose bodies and rules another scene has (again()). A
 * line that changes on purpose is written anew by CLAST_RENEW=1. Where the first hash of a line changes,
 * tests/support/golden.h says what else to do; a new row of results changes no hash while it is off. */
#define CHECK_OWN_MAIN
#include "engine/sph/run/run.h"
#include "tests/support/golden.h"
#include "tests/support/pinned.h"

/* What makes the scene small, and numbers that turn modules on. */
static const struct {
  bool numbers; /* are its numbers tried, too? Other scenes have no more kinds of inputs */
  const char *scene, *sets[8];
} smallest[] = {
    {true, "block-impact", {"body.columns=8", "body.rows=5"}},
    {true, "compression", {"body.columns=5", "body.rows=8"}},
    {true, "disc-collision", {"body.diameter=6 cm"}},
    {true, "disc-explosion", {"body.diameter=6 cm"}},
    {true, "ring-explosion", {"body.diameter=10 cm", "body.wall=2.2 cm", "expansion.rate=500 1/s"}},
    {false, "uniaxial", {"body.columns=5", "body.rows=8"}},
    {false, "basalt-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4"}},
    {true, "basalt-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4", "fracture.cell=8 mm"}},
    {true, "colliding-cylinders", {"fidelity.particles=100"}},
    {false, "disruption", {"fidelity.particles=150", "fidelity.projectile_spacing=0.4"}},
    {false, "elastic-bar", {"fidelity.particles=150"}},
    {true,
     "gabbro-crater",
     {"fidelity.particles=700", "fidelity.fine_spacing=15 mm", "fidelity.fine_radius=10 mm",
      "fidelity.projectile_spacing=0.1"}},
    {false,
     "porous-ice",
     {"fidelity.particles=150", "fidelity.projectile_spacing=0.3", "impact.mass=1 g", "stop.end_time=200 us",
      "fidelity.coarsest=2.5"}},
    {true, "porous-plate", {"fidelity.points=30"}},
    {true, "porous-target", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {false, "pumice-sphere", {"fidelity.particles=150", "fidelity.projectile_spacing=0.3"}},
    {false,
     "solid-ice",
     {"fidelity.particles=150", "fidelity.projectile_spacing=0.3", "impact.mass=1 g", "stop.end_time=200 us",
      "fidelity.coarsest=2.5"}},
    {true, "tensile-rod", {"fidelity.particles=400", "stretch.grip=4 mm", "stretch.flaw_free=8 mm"}},
};
enum { SMALLEST = sizeof smallest / sizeof *smallest };

static uint64_t walked; /* modules of engine sph that were on in a run */

/* Under the sanitizers: graded bodies, pores and an impact are in gabbro-crater, porous-plate and basalt-sphere, too.
 */
static bool again(const char *scene, bool numbers) {
  return SANITIZED && (strcmp(scene, "porous-ice") == 0 || strcmp(scene, "solid-ice") == 0 ||
                       (numbers && strcmp(scene, "porous-target") == 0));
}

/* Under the sanitizers: materials are the same rows with other numbers, and all are tried in basalt-sphere. */
static bool material_again(const char *scene, const char *path) {
  return SANITIZED && strstr(path, "material.name") && strcmp(scene, "basalt-sphere") != 0;
}

/* ---- what is pinned ---- */

enum { PINNED, SAID, HASHES };
static struct {
  FILE *file;
  char *text;
  size_t size;
} heard[HASHES];
static FILE *lines; /* of choices.txt, as this program computes them */
static char *lines_text;
static size_t lines_size;

static void hear(void) {
  for (size_t h = 0; h < HASHES; h++)
    assert_non_null(heard[h].file = open_memstream(&heard[h].text, &heard[h].size));
}

/* Writes the line of what was heard since hear(). */
static void pin(const char *scene, const char *what) {
  fprintf(lines, "%s %s", scene, what);
  for (size_t h = 0; h < HASHES; h++) {
    uint8_t digest[16];
    fclose(heard[h].file);
    blake2s(heard[h].text, heard[h].size, digest);
    fputc(' ', lines);
    for (size_t i = 0; i < 4; i++)
      fprintf(lines, "%02x", digest[i]);
    free(heard[h].text);
  }
  fputc('\n', lines);
}

static void hear_rows(const struct field_table *table, const void *object) {
  for (size_t i = 0; i < table->count; i++) {
    struct field_value value;
    field_get(&table->rows[i], object, &value);
    const bool words = strcmp(table->rows[i].path, "warnings") == 0; /* no bits of a run */
    if (!isnan(value.number))
      fprintf(heard[words ? SAID : PINNED].file, "%s=%a %lld %s\n", table->rows[i].path, value.number,
              (long long)value.integer, value.text);
  }
}

/* Results, fragments and the moving system. */
static void hear_run(const struct engine_kind *kind, void *run, const struct outcome *outcome, const void *results,
                     const struct fragment *fragments, size_t count) {
  hear_rows(&outcome_table, outcome);
  hear_rows(kind->results, results);
  for (size_t i = 0; i < count; i++) {
    const struct fragment *f = &fragments[i];
    fprintf(heard[PINNED].file, "%zu %zu %a %a %a", (size_t)f->first, (size_t)f->count, f->mass, f->moment_of_inertia,
            f->kinetic_energy);
    for (size_t k = 0; k < 3; k++)
      fprintf(heard[PINNED].file, " %a %a %a", f->position[k], f->velocity[k], f->spin[k]);
  }
  size_t size;
  OWNED void *bytes = kind->copy_system(run, &size);
  assert_non_null(bytes);
  fwrite(bytes, 1, size, heard[PINNED].file);
  fprintf(heard[PINNED].file, "%a %a\n", kind->progress(run), kind->time(run));
}

/* What `clast explain` and `clast plan` say before a run. */
static void hear_words(const struct scene *scene) {
  OWNED char *text = scene->kind->describe(scene->inputs, true);
  assert_non_null(text);
  fputs(text, heard[SAID].file);
  condition_before(scene->kind->conditions, scene->inputs, heard[SAID].file);
  fprintf(heard[SAID].file, "%zu %.9g\n", scene->kind->memory(scene->inputs), scene->kind->work(scene->inputs));
}

/* ---- runs ---- */

static bool runs(const struct scene *scene, uint64_t steps, const char *snapshot, struct error *e) {
  union {
    struct dem_results dem;
    struct sph_results sph;
  } results;
  struct outcome outcome;
  OWNED struct fragment *fragments = NULL;
  size_t count = 0;
  void *run = NULL;
  bool finished = false;
  if (scene->kind->prepare(scene->inputs, 1, &run, e) != STATUS_OK)
    return false;
  if (scene->kind == &sph_engine)
    for (size_t b = 0; b < ((struct sph_run *)run)->system->body_count; b++)
      walked |= ((struct sph_run *)run)->system->solid[b].modules.word[0];
  assert_int_equal(scene->kind->step(run, steps, &finished, e), STATUS_OK);
  if (snapshot)
    assert_int_equal(scene->kind->write_snapshot(run, snapshot, e), STATUS_OK);
  assert_int_equal(scene->kind->finish(run, &outcome, &results, &fragments, &count, e), STATUS_OK);
  hear_words(scene);
  hear_run(scene->kind, run, &outcome, &results, fragments, count);
  scene->kind->free(run);
  return true;
}

static struct scene *small_scene(size_t k) {
  struct scene *scene = NULL;
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

TEST(every_scene_runs) {
  for (size_t k = 0; k < scene_builtin_count(); k++) {
    size_t at = 0;
    while (at < SMALLEST && strcmp(smallest[at].scene, scene_builtin_name(k)) != 0)
      at++;
    if (at == SMALLEST)
      fail_msg("give %s a smallest size", scene_builtin_name(k));
  }
  for (size_t k = 0; k < SMALLEST; k++) {
    SCENE scene = small_scene(k);
    if (scene_check(scene, &error))
      fail_msg("%s: %s", smallest[k].scene, error.message);
    hear();
    if (!runs(scene, 400, "smallest.h5", &error))
      fail_msg("%s: %s", smallest[k].scene, error.message);
    pin(smallest[k].scene, "-");
  }
  remove("smallest.h5");
}

static bool chosen(const struct scene *scene, const char *path, const char *text) {
  SCENE other = scene_copy(scene);
  const bool ran = scene_set_text(other, path, text, &error) == STATUS_OK && scene_check(other, &error) == STATUS_OK &&
                   runs(other, 5, NULL, &error);
  if (!ran)
    fprintf(heard[SAID].file, "%s\n", error.message);
  return ran;
}

/* The inputs of a section of a scene share a line: target.material.tillotson, or fidelity. Names of materials have a
 * line of their own, as the sanitizers leave them out. Ends the line of `section` unless `path` is in it, and begins
 * another; NULL: no other. */
static void hear_section(const char *scene, char section[100], const char *path) {
  char next[100] = "";
  snprintf(next, sizeof next, "%s", path ? path : "");
  char *dot = strstr(next, "material.name") ? NULL : strrchr(next, '.');
  if (dot)
    *dot = '\0';
  if (strcmp(section, next) == 0)
    return;
  if (*section)
    pin(scene, section);
  if (*next)
    hear();
  strcpy(section, next);
}

/* Choices that a scene refuses, or that have no effect in it, are left out. */
TEST(every_choice_runs) {
  static const char *const switched[] = {"false", "true", NULL};
  char section[100] = "";
  size_t ran = 0;
  for (size_t k = 0; k < SMALLEST; k++) {
    if (again(smallest[k].scene, false))
      continue;
    SCENE scene = small_scene(k);
    for (size_t i = 0; i < scene->kind->inputs->count; i++) {
      const struct field *row = &scene->kind->inputs->rows[i];
      const char *const *choices = row->kind == FIELD_CHOICE || row->kind == FIELD_TEXT ? row->choices
                                   : row->kind == FIELD_BOOLEAN                         ? switched
                                                                                        : NULL;
      if (!choices || material_again(smallest[k].scene, row->path))
        continue;
      hear_section(smallest[k].scene, section, row->path);
      for (; *choices; choices++)
        ran += chosen(scene, row->path, *choices);
    }
    hear_section(smallest[k].scene, section, NULL);
  }
  print_message("%zu choices of %d scenes\n", ran, SMALLEST);
  assert_true(ran > (SANITIZED ? 300 : 500));
  for (size_t m = 0; m < SPH_MODULES; m++)
    if (!(walked >> m & 1))
      fail_msg("module %s was never on", sph_modules_at(m)->name);
}

static void tell(const struct scene *scene, const char *path, double number) {
  SCENE other = scene_copy(scene);
  const struct field_value value = {.kind = FIELD_REAL, .number = number};
  if (scene_set(other, path, &value, &error) || scene_check(other, &error)) {
    fprintf(heard[SAID].file, "%s\n", error.message);
  } else {
    uint8_t identity[16];
    scene_identity(other, 7, identity);
    fwrite(identity, 1, sizeof identity, heard[PINNED].file);
    hear_words(other);
  }
}

/* Every number that a scene uses: below and above its own value, far off, zero and off. Nothing is run. What the
 * program says of the scene is heard and its identity, or why it is refused. */
TEST(every_number_is_told) {
  char section[100] = "";
  for (size_t k = 0; k < SMALLEST; k++) {
    if (!smallest[k].numbers || again(smallest[k].scene, true))
      continue;
    SCENE scene = small_scene(k);
    const struct field_table *inputs = scene->kind->inputs;
    for (size_t i = 0; i < inputs->count; i++) {
      struct field_value value;
      field_get(&inputs->rows[i], scene->inputs, &value);
      if ((value.kind != FIELD_REAL && value.kind != FIELD_INTEGER) ||
          !field_is_active(inputs, &inputs->rows[i], scene->inputs))
        continue;
      const double own = value.kind == FIELD_INTEGER ? (double)value.integer : value.number;
      const double tried[] = {0.7 * own, 1.4 * own, 40 * own, 0, -1, NAN};
      hear_section(smallest[k].scene, section, inputs->rows[i].path);
      for (size_t t = 0; t < sizeof tried / sizeof *tried; t++)
        tell(scene, inputs->rows[i].path, tried[t]);
    }
    hear_section(smallest[k].scene, section, NULL);
  }
}

/* ---- every input acts ---- */

/* Inputs that rightly change no bit of these small and short runs, in which scenes, and why. */
static const struct {
  const char *path, *scenes, *reason;
} idle[] = {
    {"contact.damping_bonded", "block-impact disc-collision disc-explosion ring-explosion uniaxial",
     "bonded grains do not overlap"},
    {"contact.friction", "block-impact compression disc-collision disc-explosion ring-explosion uniaxial",
     "bounds tangential_damping, which is 0: told before the run"},
    {"fidelity.damage_step", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fidelity.energy_bound",
     "block-impact compression disc-collision disc-explosion ring-explosion uniaxial basalt-sphere colliding-cylinders "
     "disruption "
     "gabbro-crater porous-ice porous-plate porous-target pumice-sphere solid-ice tensile-rod",
     "a bound: it only ends a run"},
    {"fidelity.flaws", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fidelity.threads",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-ice porous-plate porous-target "
     "pumice-sphere solid-ice tensile-rod",
     "the same bits with any number of threads"},
    {"fracture.cap", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fracture.cell", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fracture.crack_radius", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fracture.draw", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fracture.front", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fracture.growth", "colliding-cylinders porous-target", "the body has no flaws: told before the run"},
    {"fragments.damage", "colliding-cylinders elastic-bar porous-plate porous-target pumice-sphere",
     "too little is damaged"},
    {"fragments.dust_mass", "colliding-cylinders elastic-bar porous-plate porous-target", "too little is damaged"},
    {"fragments.layer_width", "colliding-cylinders elastic-bar porous-plate porous-target", "too little is damaged"},
    {"fragments.link_h",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-plate porous-target pumice-sphere "
     "solid-ice tensile-rod",
     "debris has not expanded yet"},
    {"fragments.static_strength", "colliding-cylinders elastic-bar porous-plate porous-target",
     "too little is damaged"},
    {"fragments.veneer", "basalt-sphere colliding-cylinders elastic-bar porous-plate porous-target",
     "too little is damaged"},
    {"loading.residual", "compression", "the run ends before the block fails"},
    {"method.artificial_stress", "porous-plate", "nothing cracks, and nothing is in tension"},
    {"method.crack_surfaces", "porous-plate", "nothing cracks, and nothing is in tension"},
    {"method.negative_energy",
     "basalt-sphere disruption porous-ice porous-plate porous-target pumice-sphere solid-ice tensile-rod",
     "no internal energy is below 0"},
    {"projectile.fracture", "basalt-sphere disruption gabbro-crater porous-target pumice-sphere",
     "another choice is refused, or means the same: auto follows the flaws"},
    {"projectile.material.bulk_modulus",
     "basalt-sphere disruption gabbro-crater porous-ice porous-target pumice-sphere solid-ice",
     "for strength and cracks, which this body has not"},
    {"projectile.material.tension_limit", "disruption gabbro-crater porous-ice pumice-sphere solid-ice",
     "no tension reaches it, and flaws open first"},
    {"projectile.material.tillotson.E_cv", "basalt-sphere disruption porous-ice pumice-sphere",
     "of expanded hot matter, and there is none"},
    {"projectile.material.tillotson.E_iv", "porous-ice solid-ice", "of vapour, and there is none"},
    {"projectile.material.tillotson.alpha", "basalt-sphere disruption porous-ice pumice-sphere",
     "of expanded hot matter, and there is none"},
    {"projectile.material.tillotson.beta", "basalt-sphere disruption porous-ice pumice-sphere",
     "of expanded hot matter, and there is none"},
    {"projectile.turned", "porous-ice pumice-sphere solid-ice", "so small a projectile is one particle"},
    {"stop.least_time", "block-impact disc-collision disc-explosion ring-explosion",
     "the run ends before this rule acts"},
    {"stop.quiet_growth", "colliding-cylinders gabbro-crater porous-ice porous-target pumice-sphere solid-ice",
     "the run ends before this rule acts"},
    {"stop.quiet_time",
     "block-impact disc-collision disc-explosion ring-explosion colliding-cylinders gabbro-crater porous-ice "
     "porous-target solid-ice",
     "the run ends before this rule acts"},
    {"target.depth", "porous-plate", "a least side: it has the same periods of the lattice"},
    {"target.fracture", "basalt-sphere colliding-cylinders porous-target",
     "another choice is refused, or means the same: auto follows the flaws"},
    {"target.height", "porous-plate", "a least side: it has the same periods of the lattice"},
    {"target.lattice", "gabbro-crater", "a graded body has irregular points; cubic is told"},
    {"target.material.bulk_modulus", "colliding-cylinders porous-target", "for cracks, and the body has no flaws"},
    {"target.material.melt_energy", "colliding-cylinders elastic-bar gabbro-crater tensile-rod",
     "the yield stress is off, or nothing gets so hot"},
    {"target.material.tension_limit",
     "basalt-sphere disruption gabbro-crater porous-ice pumice-sphere solid-ice tensile-rod",
     "no tension reaches it, and flaws open first"},
    {"target.material.tillotson.E0", "colliding-cylinders", "rubber has a = b = 0"},
    {"target.material.tillotson.E_cv",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-ice porous-plate porous-target "
     "pumice-sphere solid-ice tensile-rod",
     "of expanded hot matter, and there is none"},
    {"target.material.tillotson.E_iv",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-plate porous-target pumice-sphere "
     "tensile-rod",
     "of vapour, and there is none"},
    {"target.material.tillotson.alpha",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-ice porous-plate porous-target "
     "pumice-sphere solid-ice tensile-rod",
     "of expanded hot matter, and there is none"},
    {"target.material.tillotson.beta",
     "basalt-sphere colliding-cylinders disruption elastic-bar gabbro-crater porous-ice porous-plate porous-target "
     "pumice-sphere solid-ice tensile-rod",
     "of expanded hot matter, and there is none"},
    {"target.turned", "gabbro-crater", "a graded body has irregular points; cubic is told"},
};
enum { IDLE = sizeof idle / sizeof *idle };

/* The bits of a run; NULL: the scene refuses the value. The caller frees them. */
static char *bits_of(struct scene *scene, size_t *size) {
  hear();
  const bool ran = scene_check(scene, &error) == STATUS_OK && runs(scene, 400, NULL, &error);
  for (size_t h = 0; h < HASHES; h++)
    fclose(heard[h].file);
  free(heard[SAID].text);
  *size = heard[PINNED].size;
  if (ran)
    return heard[PINNED].text;
  free(heard[PINNED].text);
  return NULL;
}

struct acting {
  const struct scene *scene;
  const char *own;
  size_t own_size, accepted, other;
};

static void try_value(struct acting *a, const struct field *row, const char *text, double number) {
  SCENE other = scene_copy(a->scene);
  const struct field_value value = {.kind = FIELD_REAL, .number = number};
  size_t size;
  if (a->other == 0 && (text ? scene_set_text(other, row->path, text, &error)
                             : scene_set(other, row->path, &value, &error)) == STATUS_OK) {
    OWNED char *bits = bits_of(other, &size);
    a->accepted += bits != NULL;
    a->other += bits && (size != a->own_size || memcmp(bits, a->own, size) != 0);
  }
}

static void try_values(struct acting *a, const struct field *row) {
  static const char *const switched[] = {"false", "true", NULL};
  struct field_value value;
  field_get(row, a->scene->inputs, &value);
  const char *const *choices = row->kind == FIELD_CHOICE ? row->choices : row->kind == FIELD_BOOLEAN ? switched : NULL;
  const char *own_choice = row->kind == FIELD_BOOLEAN ? switched[value.number != 0] : value.text;
  for (; choices && *choices; choices++)
    if (strcmp(*choices, own_choice) != 0)
      try_value(a, row, *choices, 0);
  if (value.kind != FIELD_REAL && value.kind != FIELD_INTEGER)
    return;
  const double own = value.kind == FIELD_INTEGER ? (double)value.integer : value.number;
  const double tried[] = {0.7 * own,
                          1.4 * own,
                          own == 0 ? 0.01 : (double)NAN,
                          own == 0 || isnan(own) ? 1 : (double)NAN,
                          own == 0 ? 1000 : (double)NAN,
                          isnan(own) ? 1e7 : (double)NAN,
                          0.1 * own,
                          10 * own};
  for (size_t t = 0; t < sizeof tried / sizeof *tried; t++)
    if (isfinite(tried[t]) && tried[t] != own)
      try_value(a, row, NULL, value.kind == FIELD_INTEGER ? ceil(tried[t]) : tried[t]);
}

static bool is_idle(const char *scene, const char *path) {
  const size_t length = strlen(scene);
  for (size_t k = 0; k < IDLE; k++)
    for (const char *at = strcmp(idle[k].path, path) == 0 ? idle[k].scenes : NULL; at; at = strstr(at + 1, scene))
      if (strncmp(at, scene, length) == 0 && (at[length] == ' ' || at[length] == '\0'))
        return true;
  return false;
}

/* An input that a scene takes changes its bits, or is in the list with the reason. Quick form: one scene of each
 * engine; CLAST_FULL=1: all (four minutes). */
TEST(every_input_acts) {
  if (SANITIZED) /* it is about bits; the other tests walk the same code */
    skip();
  size_t wrong = 0, acted = 0;
  for (size_t k = 0; k < SMALLEST; k++) {
    if (!getenv("CLAST_FULL") && strcmp(smallest[k].scene, "block-impact") != 0 &&
        strcmp(smallest[k].scene, "disruption") != 0)
      continue;
    SCENE scene = small_scene(k);
    struct acting a = {.scene = scene};
    OWNED char *own = bits_of(scene, &a.own_size);
    a.own = own;
    for (size_t i = 0; i < scene->kind->inputs->count; i++) {
      const struct field *row = &scene->kind->inputs->rows[i];
      if (!field_is_active(scene->kind->inputs, row, scene->inputs) || is_idle(smallest[k].scene, row->path))
        continue;
      a.accepted = a.other = 0;
      try_values(&a, row);
      acted += a.other;
      if (a.other || !a.accepted)
        continue;
      print_message("%s: %s changes nothing\n", smallest[k].scene, row->path);
      wrong++;
    }
  }
  print_message("%zu inputs act\n", acted);
  assert_int_equal(wrong, 0);
}

static void begin_and_end(void *context) {
  hear();
  assert_true(runs(context, 2, NULL, &error));
  for (size_t h = 0; h < HASHES; h++) {
    fclose(heard[h].file);
    free(heard[h].text);
  }
}

TEST(no_run_leaves_memory) {
  if (SANITIZED) /* they see leaks by themselves, and mallinfo2() knows nothing of their allocator */
    skip();
  for (size_t k = 0; k < SMALLEST; k++) {
    SCENE scene = small_scene(k);
    pinned_frees(smallest[k].scene, begin_and_end, scene);
  }
}

TEST(every_bit_is_pinned) {
  fclose(lines);
  if (SANITIZED)
    pinned_among("extremes/choices.txt", lines_text);
  else
    pinned_same("extremes/choices.txt", lines_text, 0);
  free(lines_text);
}

int main(int count, char **arguments) {
  (void)count;
  if (!golden_start(arguments))
    return 71;
  assert_non_null(lines = open_memstream(&lines_text, &lines_size));
  return check_run(NULL, NULL);
}
