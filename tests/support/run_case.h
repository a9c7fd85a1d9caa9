/* Runs a built-in scene of any engine, with a few overrides, in a test. Any error fails the test. */
#pragma once

#include "engine/dem/dem.h"
#include "engine/scene.h"
#include "engine/sph/sph.h"
#include "tests/support/check.h"

#define UNUSED __attribute__((unused))

union run_case_inputs {
  struct dem_inputs dem;
  struct sph_inputs sph;
};

/* `overrides`: "path=text" items, closed by NULL; NULL for none. */
UNUSED static union run_case_inputs run_case(const char *scene_name, const char *const *overrides) {
  SCENE scene = NULL;
  union run_case_inputs inputs;
  if (scene_load(scene_name, NULL, &scene, &error))
    fail_msg("%s: %s", scene_name, error.message);
  for (size_t k = 0; overrides && overrides[k]; k++) {
    char path[100];
    const char *text = strchr(overrides[k], '=');
    snprintf(path, sizeof path, "%.*s", (int)(text - overrides[k]), overrides[k]);
    if (scene_set_text(scene, path, text + 1, &error))
      fail_msg("%s: %s", overrides[k], error.message);
  }
  if (scene_check(scene, &error))
    fail_msg("%s: %s", scene_name, error.message);
  memcpy(&inputs, scene->inputs, scene->kind->inputs->size);
  return inputs;
}
#define DEM_CASE(name, ...) run_case(name, (const char *const[]){__VA_ARGS__, NULL}).dem
#define SPH_CASE(name, ...) run_case(name, (const char *const[]){__VA_ARGS__, NULL}).sph

/* Everything that a run reports. */
struct ran {
  struct outcome outcome;
  union {
    struct dem_results dem;
    struct sph_results sph;
  } results;
  struct fragment *fragments; /* owned by the test */
  size_t count;
};

/* Runs to the end, `chunk` steps at a time; 0: chunks of 1 to 23 steps. */
UNUSED static struct ran run_case_end(const struct engine_kind *kind, void *run, uint64_t chunk) {
  struct ran ran = {0};
  bool finished = false;
  for (uint64_t k = 1; !finished; k = k * 7 % 23 + 1)
    if (kind->step(run, chunk ? chunk : k, &finished, &error))
      fail_msg("step: %s", error.message);
  if (kind->finish(run, &ran.outcome, &ran.results, &ran.fragments, &ran.count, &error))
    fail_msg("finish: %s", error.message);
  return ran;
}

UNUSED static struct ran run_case_run(const struct engine_kind *kind, const void *inputs, uint64_t seed) {
  void *run = NULL;
  if (kind->prepare(inputs, seed, &run, &error))
    fail_msg("prepare: %s", error.message);
  struct ran ran = run_case_end(kind, run, 1000);
  kind->free(run);
  return ran;
}

UNUSED static void run_case_same_rows(const struct field_table *table, const void *a, const void *b) {
  uint8_t bytes[2][8192];
  size_t size = field_encode(table, a, bytes[0]); /* row by row: padding is not compared */
  assert_true(size < sizeof bytes[0] && size == field_encode(table, b, bytes[1]));
  assert_memory_equal(bytes[0], bytes[1], size);
}

/* Fails unless both results are equal bit by bit; frees the fragments of `b`. */
UNUSED static void run_case_same(const struct engine_kind *kind, const struct ran *a, struct ran b) {
  run_case_same_rows(&outcome_table, &a->outcome, &b.outcome);
  run_case_same_rows(kind->results, &a->results, &b.results);
  assert_int_equal(a->count, b.count);
  assert_memory_equal(a->fragments, b.fragments, b.count * sizeof *b.fragments);
  free(b.fragments);
}

UNUSED static bool run_case_full(void) {
  const char *full = getenv("CLAST_FULL");
  return full && strcmp(full, "1") == 0;
}

/* Number of seeds: CLAST_SEEDS, or the default of the quick or long form. */
UNUSED static size_t run_case_seeds(size_t quick, size_t full) {
  const char *asked = getenv("CLAST_SEEDS");
  size_t n = asked ? strtoul(asked, NULL, 10) : 0;
  return n > 0 && n <= 1000 ? n : run_case_full() ? full : quick;
}
